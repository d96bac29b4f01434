//! What a section is made of besides plots: headline, key figures, tables.

use crate::error::PageError;
use crate::format::{NOT_DETERMINED, QuantityText};
use crate::html::{push_element, push_escaped};
use crate::unit::typeset;

/// How a statement is meant to be taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    /// As it should be.
    Ok,
    /// To be looked at.
    Attention,
    /// Not usable as it is.
    Problem,
}

impl Tone {
    pub(crate) fn class(self) -> &'static str {
        match self {
            Tone::Ok => "ok",
            Tone::Attention => "attention",
            Tone::Problem => "problem",
        }
    }

    /// The tone in one character, so that it does not hang on the colour alone.
    fn sign(self) -> &'static str {
        match self {
            Tone::Ok => "✓",
            Tone::Attention => "!",
            Tone::Problem => "✕",
        }
    }
}

/// The headline of a page: what came out, in one sentence, and how to take it.
#[derive(Debug, Clone)]
pub struct Verdict {
    tone: Tone,
    headline: String,
    details: Vec<String>,
}

impl Verdict {
    /// A headline in the given tone.
    pub fn new(tone: Tone, headline: impl Into<String>) -> Self {
        Self { tone, headline: headline.into(), details: Vec::new() }
    }

    /// A headline for a result that is as it should be.
    pub fn ok(headline: impl Into<String>) -> Self {
        Self::new(Tone::Ok, headline)
    }

    /// A headline for a result that needs a look.
    pub fn attention(headline: impl Into<String>) -> Self {
        Self::new(Tone::Attention, headline)
    }

    /// A headline for a result that cannot be used as it is.
    pub fn problem(headline: impl Into<String>) -> Self {
        Self::new(Tone::Problem, headline)
    }

    /// A sentence below the headline.
    pub fn detail(mut self, sentence: impl Into<String>) -> Self {
        self.details.push(sentence.into());
        self
    }

    pub(crate) fn write(&self, html: &mut String) {
        html.push_str(&format!(
            "<div class=\"verdict {}\"><span class=\"sign\" aria-hidden=\"true\">{}</span><div>",
            self.tone.class(),
            self.tone.sign()
        ));
        push_element(html, "p", "headline", &self.headline);
        for detail in &self.details {
            push_element(html, "p", "", detail);
        }
        html.push_str("</div></div>\n");
    }
}

/// A key figure: label, value with uncertainty and unit, and a note.
#[derive(Debug, Clone)]
pub struct Card {
    label: String,
    value: QuantityText,
    note: Option<String>,
    tone: Option<Tone>,
}

impl Card {
    /// A quantity in SI with its standard deviation; see [`quantity`](crate::format::quantity) for how it is printed.
    pub fn quantity(label: impl Into<String>, value: f64, std: impl Into<Option<f64>>, unit: &str) -> Self {
        Self { label: label.into(), value: QuantityText::new(value, std, unit), note: None, tone: None }
    }

    /// A figure that is no quantity, such as `412 of 644 lines`.
    pub fn text(label: impl Into<String>, text: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            value: QuantityText { number: text.into(), unit: String::new(), note: None },
            note: None,
            tone: None,
        }
    }

    /// A line below the figure, such as the nominal value.
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.note = Some(note.into());
        self
    }

    /// Marks the card at its edge.
    pub fn tone(mut self, tone: Tone) -> Self {
        self.tone = Some(tone);
        self
    }

    pub(crate) fn write(&self, html: &mut String) {
        let class = match self.tone {
            Some(tone) => format!("card {}", tone.class()),
            None => "card".to_owned(),
        };
        html.push_str(&format!("<div class=\"{class}\">"));
        push_element(html, "dt", "", &self.label);
        html.push_str("<dd><span class=\"figure\">");
        push_escaped(html, &self.value.number);
        if !self.value.unit.is_empty() {
            html.push(' ');
            push_element(html, "span", "unit", &self.value.unit);
        }
        html.push_str("</span>");
        if let Some(note) = self.value.note {
            push_element(html, "span", "note", note);
        }
        if let Some(note) = &self.note {
            push_element(html, "span", "note", note);
        }
        html.push_str("</dd></div>");
    }
}

/// A cell of a [`Table`]: words or a number, and where they lead.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cell {
    text: String,
    file: Option<String>,
}

impl Cell {
    /// Text that leads to a file beside the page, named by its path from there.
    pub fn link(text: impl Into<String>, file: impl Into<String>) -> Self {
        Cell { text: text.into(), file: Some(file.into()) }
    }

    fn write(&self, html: &mut String, class: &str) {
        let Some(file) = &self.file else { return push_element(html, "td", class, &self.text) };
        html.push_str(&format!("<td class=\"{class}\"><a href=\"./"));
        push_escaped(html, file);
        html.push_str("\">");
        push_escaped(html, &self.text);
        html.push_str("</a></td>");
    }
}

impl<T: Into<String>> From<T> for Cell {
    fn from(text: T) -> Self {
        Cell { text: text.into(), file: None }
    }
}

/// A column of a [`Table`].
#[derive(Debug, Clone)]
pub struct Column {
    heading: String,
    unit: String,
    numbers: bool,
}

impl Column {
    /// A column of words, aligned left.
    pub fn text(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), unit: String::new(), numbers: false }
    }

    /// A column of numbers, aligned right, with its unit (empty for a pure number) in the header.
    pub fn numbers(heading: impl Into<String>, unit: &str) -> Self {
        Self { heading: heading.into(), unit: typeset(unit), numbers: true }
    }
}

/// A table with units in its header.
///
/// ```
/// use jointscope_report::{Column, Scale, Table, format::in_column};
/// let scale = Scale::for_values([3.32e6, 3.31e6], "N/m");
/// let table = Table::new([Column::text("relation"), Column::numbers("k₁₁", scale.unit())])
///     .row(["exact".to_owned(), in_column(3.32e6, 2e4, &scale)])
///     .row(["paper".to_owned(), in_column(3.31e6, 2e4, &scale)])
///     .footnote("± one standard deviation");
/// # let _ = table;
/// ```
#[derive(Debug, Clone)]
pub struct Table {
    caption: Option<String>,
    columns: Vec<Column>,
    rows: Vec<(Vec<Cell>, Option<Tone>)>,
    footnotes: Vec<String>,
}

impl Table {
    /// A table without rows.
    pub fn new(columns: impl IntoIterator<Item = Column>) -> Self {
        Self {
            caption: None,
            columns: columns.into_iter().collect(),
            rows: Vec::new(),
            footnotes: Vec::new(),
        }
    }

    /// A sentence above the table.
    pub fn caption(mut self, caption: impl Into<String>) -> Self {
        self.caption = Some(caption.into());
        self
    }

    /// A row with one cell per column; checked when the page is rendered.
    pub fn row<T: Into<Cell>>(mut self, cells: impl IntoIterator<Item = T>) -> Self {
        self.rows.push((cells.into_iter().map(Into::into).collect(), None));
        self
    }

    /// A row that is marked at its edge.
    pub fn marked_row<T: Into<Cell>>(mut self, tone: Tone, cells: impl IntoIterator<Item = T>) -> Self {
        self.rows.push((cells.into_iter().map(Into::into).collect(), Some(tone)));
        self
    }

    /// A line below the table.
    pub fn footnote(mut self, footnote: impl Into<String>) -> Self {
        self.footnotes.push(footnote.into());
        self
    }

    pub(crate) fn write(&self, html: &mut String) -> Result<(), PageError> {
        html.push_str("<div class=\"table\"><table>");
        if let Some(caption) = &self.caption {
            push_element(html, "caption", "", caption);
        }
        html.push_str("<thead><tr>");
        for column in &self.columns {
            html.push_str(if column.numbers {
                "<th scope=\"col\" class=\"number\">"
            } else {
                "<th scope=\"col\">"
            });
            push_escaped(html, &column.heading);
            if !column.unit.is_empty() {
                html.push(' ');
                push_element(html, "span", "unit", &column.unit);
            }
            html.push_str("</th>");
        }
        html.push_str("</tr></thead>\n<tbody>\n");
        for (row, (cells, tone)) in self.rows.iter().enumerate() {
            self.write_row(html, row, cells, *tone)?;
        }
        html.push_str("</tbody></table>");
        for footnote in &self.footnotes {
            push_element(html, "p", "footnote", footnote);
        }
        html.push_str("</div>\n");
        Ok(())
    }

    fn write_row(
        &self,
        html: &mut String,
        row: usize,
        cells: &[Cell],
        tone: Option<Tone>,
    ) -> Result<(), PageError> {
        if cells.len() != self.columns.len() {
            let first = self.columns.first().map(|column| column.heading.clone());
            return Err(PageError::RowLength {
                table: self.caption.clone().or(first).unwrap_or_default(),
                row,
                expected: self.columns.len(),
                got: cells.len(),
            });
        }
        match tone {
            Some(tone) => html.push_str(&format!("<tr class=\"{}\">", tone.class())),
            None => html.push_str("<tr>"),
        }
        for (column, cell) in self.columns.iter().zip(cells) {
            let class = match (column.numbers, cell.text.as_str()) {
                (true, NOT_DETERMINED) => "number undetermined",
                (true, _) => "number",
                (false, _) => "",
            };
            cell.write(html, class);
        }
        html.push_str("</tr>\n");
        Ok(())
    }
}
