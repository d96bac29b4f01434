//! A section: a heading and what stands below it, in the order in which it was added.

use crate::drawing::Svg;
use crate::elements::{Card, Table};
use crate::error::PageError;
use crate::heat_map::HeatMap;
use crate::html::{push_element, push_escaped};
use crate::plot::{ColumnPool, Plot, PlotData, write_figure};

#[derive(Debug, Clone)]
enum Block {
    Paragraph(String),
    Cards(Vec<Card>),
    Table(Table),
    HeatMap(HeatMap),
    Notes(Vec<String>),
    Warnings(Vec<String>),
    Command(String),
    Drawing { svg: Svg, caption: String },
    Plots { columns: usize, plots: Vec<Plot> },
}

/// A part of a [`Page`](crate::Page) under a heading of its own, which is also its anchor.
#[derive(Debug, Clone)]
pub struct Section {
    pub(crate) heading: String,
    blocks: Vec<Block>,
}

impl Section {
    /// A section with nothing below its heading yet.
    pub fn new(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), blocks: Vec::new() }
    }

    fn with(mut self, block: Block) -> Self {
        self.blocks.push(block);
        self
    }

    /// A paragraph of plain text.
    pub fn paragraph(self, text: impl Into<String>) -> Self {
        self.with(Block::Paragraph(text.into()))
    }

    /// Key figures side by side.
    pub fn cards(self, cards: impl IntoIterator<Item = Card>) -> Self {
        self.with(Block::Cards(cards.into_iter().collect()))
    }

    /// A table.
    pub fn table(self, table: Table) -> Self {
        self.with(Block::Table(table))
    }

    /// A map of numbers by row and column.
    pub fn heat_map(self, map: HeatMap) -> Self {
        self.with(Block::HeatMap(map))
    }

    /// A list of remarks; nothing where there are none.
    pub fn notes<T: Into<String>>(self, notes: impl IntoIterator<Item = T>) -> Self {
        self.with(Block::Notes(notes.into_iter().map(Into::into).collect()))
    }

    /// A list of what the reader should mind; nothing where there is none.
    pub fn warnings<T: Into<String>>(self, warnings: impl IntoIterator<Item = T>) -> Self {
        self.with(Block::Warnings(warnings.into_iter().map(Into::into).collect()))
    }

    /// A command line, as typed.
    pub fn command(self, line: impl Into<String>) -> Self {
        self.with(Block::Command(line.into()))
    }

    /// A drawing with its caption, such as [`FixtureDrawing::to_svg`](crate::FixtureDrawing::to_svg).
    pub fn drawing(self, svg: Svg, caption: impl Into<String>) -> Self {
        self.with(Block::Drawing { svg, caption: caption.into() })
    }

    /// One plot over the full width.
    pub fn plot(self, plot: Plot) -> Self {
        self.plots(1, [plot])
    }

    /// Plots in rows of so many `columns`, 1 to 4; a narrow window shows fewer side by side.
    pub fn plots(self, columns: usize, plots: impl IntoIterator<Item = Plot>) -> Self {
        self.with(Block::Plots { columns: columns.clamp(1, 4), plots: plots.into_iter().collect() })
    }

    pub(crate) fn write(
        &self,
        html: &mut String,
        anchor: &str,
        pool: &mut ColumnPool,
        drawn: &mut Vec<PlotData>,
    ) -> Result<(), PageError> {
        html.push_str(&format!("<section id=\"{anchor}\">\n"));
        push_element(html, "h2", "", &self.heading);
        html.push('\n');
        for block in &self.blocks {
            write_block(block, html, pool, drawn)?;
        }
        html.push_str("</section>\n");
        Ok(())
    }
}

fn write_block(
    block: &Block,
    html: &mut String,
    pool: &mut ColumnPool,
    drawn: &mut Vec<PlotData>,
) -> Result<(), PageError> {
    match block {
        Block::Paragraph(text) => push_element(html, "p", "", text),
        Block::Cards(cards) => {
            html.push_str("<dl class=\"cards\">");
            for card in cards {
                card.write(html);
            }
            html.push_str("</dl>");
        }
        Block::Table(table) => table.write(html)?,
        Block::HeatMap(map) => map.write(html)?,
        Block::Notes(notes) => push_list(html, "notes", notes),
        Block::Warnings(warnings) => push_list(html, "notes warnings", warnings),
        Block::Command(line) => push_element(html, "pre", "command", line),
        Block::Drawing { svg, caption } => {
            html.push_str("<figure class=\"sketch\">");
            html.push_str(svg.as_str());
            push_element(html, "figcaption", "", caption);
            html.push_str("</figure>");
        }
        Block::Plots { columns, plots } => {
            html.push_str(&format!("<div class=\"plots columns-{columns}\">\n"));
            for plot in plots {
                let data = PlotData::new(plot, pool)?;
                write_figure(html, drawn.len(), plot, &data);
                drawn.push(data);
            }
            html.push_str("</div>");
        }
    }
    html.push('\n');
    Ok(())
}

fn push_list(html: &mut String, class: &str, items: &[String]) {
    if items.is_empty() {
        return;
    }
    html.push_str(&format!("<ul class=\"{class}\">"));
    for item in items {
        html.push_str("<li>");
        push_escaped(html, item);
        html.push_str("</li>");
    }
    html.push_str("</ul>");
}
