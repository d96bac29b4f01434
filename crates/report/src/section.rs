//! A section: a heading and what stands below it, in the order in which it was added; and the verdict above
//! all of them.

use maud::{Markup, Render, html};

use crate::drawing::Drawing;
use crate::error::PageError;
use crate::format::QuantityText;
use crate::plot::{Plot, PlotBook};
use crate::table::{Table, TableText, with_commands};
use crate::tone::Tone;
use crate::unit::Scale;

/// What came out: how to take it, in one sentence, and what is to be said besides.
#[derive(Debug, Clone)]
pub(crate) struct Verdict {
    pub tone: Tone,
    pub headline: String,
    pub details: Vec<String>,
}

impl Render for Verdict {
    fn render(&self) -> Markup {
        html! {
            div class={ "verdict " (self.tone.class()) } {
                span.sign aria-hidden="true" { (self.tone.sign()) }
                div {
                    p.headline { (self.headline) }
                    @for detail in &self.details { p { (with_commands(detail)) } }
                }
            }
        }
    }
}

/// A key figure: label, value with uncertainty and unit, and a note.
#[derive(Debug, Clone)]
pub(crate) struct Card {
    label: String,
    value: QuantityText,
    note: Option<String>,
    tone: Option<Tone>,
}

impl Card {
    /// A quantity in SI with its standard deviation; see [`quantity`](crate::format::quantity) for how it is
    /// printed.
    pub(crate) fn quantity(
        label: impl Into<String>,
        value: f64,
        std: impl Into<Option<f64>>,
        unit: &str,
    ) -> Self {
        Self { label: label.into(), value: QuantityText::new(value, std, unit), note: None, tone: None }
    }

    /// The same in a given unit, that of its note.
    pub(crate) fn quantity_in(
        label: impl Into<String>,
        value: f64,
        std: impl Into<Option<f64>>,
        scale: &Scale,
    ) -> Self {
        Self { label: label.into(), value: QuantityText::on(value, std, scale), note: None, tone: None }
    }

    /// A figure that is no quantity, such as `412 of 644 lines`.
    pub(crate) fn text(label: impl Into<String>, text: impl Into<String>) -> Self {
        let value = QuantityText { number: text.into(), unit: String::new(), note: None };
        Self { label: label.into(), value, note: None, tone: None }
    }

    /// A line below the figure, such as the nominal value.
    pub(crate) fn note(self, note: impl Into<String>) -> Self {
        Self { note: Some(note.into()), ..self }
    }

    /// Marks the card at its edge.
    pub(crate) fn tone(self, tone: Option<Tone>) -> Self {
        Self { tone, ..self }
    }
}

impl Render for Card {
    fn render(&self) -> Markup {
        html! {
            div class={ "card" @if let Some(tone) = self.tone { " " (tone.class()) } } {
                dt { (self.label) }
                dd {
                    span.figure {
                        (self.value.number)
                        @if !self.value.unit.is_empty() { " " span.unit { (self.value.unit) } }
                    }
                    @if let Some(note) = self.value.note { span.note { (note) } }
                    @if let Some(note) = &self.note { span.note { (note) } }
                }
            }
        }
    }
}

/// One of the things below a heading.
#[derive(Clone)]
pub(crate) enum Block {
    Markup(Markup),
    Table(TableText),
    /// An SVG image with its caption.
    Drawing(Drawing, String),
    /// In rows of so many; numbered and checked when the page is rendered.
    Plots(usize, Vec<Plot>),
}

impl From<Markup> for Block {
    fn from(markup: Markup) -> Self {
        Block::Markup(markup)
    }
}

impl<T> From<Table<T>> for Block {
    fn from(table: Table<T>) -> Self {
        Block::Table(table.into())
    }
}

/// A part of a [`Page`](crate::page::Page) under a heading of its own, which is also its anchor.
#[derive(Clone)]
pub(crate) struct Section {
    pub heading: String,
    blocks: Vec<Block>,
}

impl Section {
    /// A section with nothing below its heading yet.
    pub(crate) fn new(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), blocks: Vec::new() }
    }

    /// A [`Table`], or markup.
    pub(crate) fn with(mut self, part: impl Into<Block>) -> Self {
        self.blocks.push(part.into());
        self
    }

    /// What stands below the heading.
    pub(crate) fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// A paragraph of plain text.
    pub(crate) fn paragraph(self, text: impl AsRef<str>) -> Self {
        self.with(html! { p { (with_commands(text.as_ref())) } })
    }

    /// Key figures side by side.
    pub(crate) fn cards(self, cards: impl IntoIterator<Item = Card>) -> Self {
        self.with(html! { dl.cards { @for card in cards { (card) } } })
    }

    /// A list of remarks; nothing where there are none.
    pub(crate) fn notes(self, notes: impl IntoIterator<Item: AsRef<str>>) -> Self {
        self.list("notes", notes)
    }

    /// A list of what the reader should mind; nothing where there is none.
    pub(crate) fn warnings(self, warnings: impl IntoIterator<Item: AsRef<str>>) -> Self {
        self.list("notes warnings", warnings)
    }

    fn list(self, class: &str, items: impl IntoIterator<Item: AsRef<str>>) -> Self {
        let mut items = items.into_iter().peekable();
        if items.peek().is_none() {
            return self;
        }
        self.with(html! { ul class=(class) { @for item in items { li { (with_commands(item.as_ref())) } } } })
    }

    /// A command line, as typed.
    pub(crate) fn command(self, line: &str) -> Self {
        self.with(html! { pre.command { (line) } })
    }

    /// An SVG image with its caption.
    pub(crate) fn drawing(mut self, svg: impl Into<Drawing>, caption: impl Into<String>) -> Self {
        self.blocks.push(Block::Drawing(svg.into(), caption.into()));
        self
    }

    /// One plot over the full width.
    pub(crate) fn plot(self, plot: Plot) -> Self {
        self.plots(1, [plot])
    }

    /// Plots in rows of so many `columns`, 1 to 4, where there are any; a narrow window shows fewer side by
    /// side.
    pub(crate) fn plots(mut self, columns: usize, plots: impl IntoIterator<Item = Plot>) -> Self {
        let plots: Vec<Plot> = plots.into_iter().collect();
        if !plots.is_empty() {
            self.blocks.push(Block::Plots(columns.clamp(1, 4), plots));
        }
        self
    }

    pub(crate) fn render(&self, anchor: &str, book: &mut PlotBook) -> Result<Markup, PageError> {
        let mut blocks = Vec::with_capacity(self.blocks.len());
        for block in &self.blocks {
            blocks.push(match block {
                Block::Markup(markup) => markup.clone(),
                Block::Table(table) => table.render(),
                Block::Drawing(Drawing { wide, narrow }, caption) => html! {
                    figure.sketch { (wide) @if let Some(narrow) = narrow { (narrow) } figcaption { (caption) } }
                },
                Block::Plots(columns, plots) => {
                    let figures = plots.iter().map(|plot| book.figure(plot)).collect::<Result<Vec<_>, _>>()?;
                    html! { div class={ "plots columns-" (columns) } { @for figure in &figures { (figure) } } }
                }
            });
        }
        Ok(html! { section id=(anchor) { h2 { (self.heading) } @for block in &blocks { "\n" (block) } } })
    }
}
