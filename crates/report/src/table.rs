//! Tables: one row per item, one column per question asked of it.

use maud::{Markup, Render, html};

use crate::format::{NOT_DETERMINED, fixed};
use crate::tone::Tone;
use crate::unit::typeset;

/// χ² from which on the shade of a [heat map](Table::shaded) is full: from there on it is all the same how
/// bad it is.
const FULL: f64 = 100.0;
/// Strength of the full shade, %: the numbers stay readable on it.
const STRONGEST: f64 = 70.0;

/// What stands between backticks is what one types.
pub(crate) fn with_commands(text: &str) -> Markup {
    html! { @for (at, part) in text.split('`').enumerate() { @if at % 2 == 1 { code { (part) } } @else { (part) } } }
}

/// What a cell shows.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Cell {
    Text(String),
    /// Text that leads to a file beside the page, named by its path from there.
    Link(String, String),
    /// A number on a shade of so many per cent.
    Shaded(String, f64),
}

impl Cell {
    fn text(&self) -> &str {
        match self {
            Cell::Text(text) | Cell::Link(text, _) | Cell::Shaded(text, _) => text,
        }
    }

    /// χ² per value (or per degree of freedom), shaded from 1, which is noise; a dash where there is none.
    pub(crate) fn misfit(chi2: Option<f64>) -> Self {
        let Some(chi2) = chi2.filter(|chi2| chi2.is_finite()) else { return "–".into() };
        Cell::Shaded(short(chi2), STRONGEST * (chi2.max(1.0).ln() / FULL.ln()).min(1.0))
    }

    /// A share from 0 to 1 as per cent, shaded by it.
    pub(crate) fn share(share: f64) -> Self {
        if !share.is_finite() {
            return "–".into();
        }
        Cell::Shaded(fixed(100.0 * share, 1), STRONGEST * share.clamp(0.0, 1.0))
    }

    /// A count shaded by its share of `all`; what is zero is left empty.
    pub(crate) fn count(count: f64, all: f64) -> Self {
        if count > 0.0 {
            Cell::Shaded(fixed(count, 0), STRONGEST * (count / all).min(1.0))
        } else {
            "".into()
        }
    }
}

/// Short enough for twelve columns: 1.02, 37.4, 374, 3.7k.
fn short(value: f64) -> String {
    match value {
        v if v < 10.0 => format!("{v:.2}"),
        v if v < 100.0 => format!("{v:.1}"),
        v if v < 1e4 => format!("{v:.0}"),
        v if v < 1e6 => format!("{:.0}k", v / 1e3),
        v => format!("{v:.0e}"),
    }
}

impl<T: Into<String>> From<T> for Cell {
    fn from(text: T) -> Self {
        Cell::Text(text.into())
    }
}

impl Render for Cell {
    fn render(&self) -> Markup {
        match self {
            Cell::Text(text) | Cell::Shaded(text, _) => html! { (text) },
            Cell::Link(text, file) => html! { a href={ "./" (file) } { (text) } },
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Words,
    Numbers,
    /// Names the row.
    Name,
    Shaded,
}

/// A table with units in its header, made of the items of its rows: every column says what it shows of each.
///
/// ```ignore
/// Table::of(&joints).words("joint", |joint| &joint.name).numbers("k₁₁", "MN/m", |joint| fixed(joint.k, 3))
/// ```
#[derive(Debug, Clone)]
pub(crate) struct Table<T> {
    items: Vec<T>,
    text: TableText,
}

/// What stands in a table, its items apart.
#[derive(Debug, Clone, Default)]
pub(crate) struct TableText {
    /// Kind, heading and typeset unit.
    columns: Vec<(Kind, String, String)>,
    rows: Vec<Vec<Cell>>,
    marks: Vec<Option<Tone>>,
    caption: String,
    footnotes: Vec<String>,
}

impl<T> Table<T> {
    /// A row per item, without columns.
    pub(crate) fn of(items: impl IntoIterator<Item = T>) -> Self {
        let items: Vec<T> = items.into_iter().collect();
        let (rows, marks) = (vec![Vec::new(); items.len()], vec![None; items.len()]);
        Self { items, text: TableText { rows, marks, ..TableText::default() } }
    }

    fn column<C: Into<Cell>>(mut self, kind: Kind, head: (String, &str), cell: impl Fn(&T) -> C) -> Self {
        self.text.columns.push((kind, head.0, typeset(head.1)));
        self.text.rows.iter_mut().zip(&self.items).for_each(|(row, item)| row.push(cell(item).into()));
        self
    }

    /// A column of words, aligned left.
    pub(crate) fn words<C: Into<Cell>>(self, heading: impl Into<String>, cell: impl Fn(&T) -> C) -> Self {
        self.column(Kind::Words, (heading.into(), ""), cell)
    }

    /// A column of numbers, aligned right, with its unit (empty for a pure number) in the header.
    pub(crate) fn numbers<C: Into<Cell>>(
        self,
        heading: impl Into<String>,
        unit: &str,
        cell: impl Fn(&T) -> C,
    ) -> Self {
        self.column(Kind::Numbers, (heading.into(), unit), cell)
    }

    /// A column that names the rows of a heat map.
    pub(crate) fn names<C: Into<Cell>>(self, heading: impl Into<String>, cell: impl Fn(&T) -> C) -> Self {
        self.column(Kind::Name, (heading.into(), ""), cell)
    }

    /// A column of a heat map.
    pub(crate) fn shaded(self, heading: impl Into<String>, cell: impl Fn(&T) -> Cell) -> Self {
        self.column(Kind::Shaded, (heading.into(), ""), cell)
    }

    /// Marks rows at their edge.
    pub(crate) fn marked(mut self, tone: impl Fn(&T) -> Option<Tone>) -> Self {
        self.text.marks = self.items.iter().map(tone).collect();
        self
    }

    /// A sentence above the table.
    pub(crate) fn caption(mut self, caption: impl Into<String>) -> Self {
        self.text.caption = caption.into();
        self
    }

    /// A line below the table.
    pub(crate) fn footnote(mut self, footnote: impl Into<String>) -> Self {
        self.text.footnotes.push(footnote.into());
        self
    }
}

impl<T> From<Table<T>> for TableText {
    fn from(table: Table<T>) -> Self {
        table.text
    }
}

impl<T> Render for Table<T> {
    fn render(&self) -> Markup {
        self.text.render()
    }
}

impl TableText {
    /// A row of headings and rows of cells, for a file: see [`csv`](crate::report).
    pub(crate) fn cells(&self) -> (Vec<TableColumn<'_>>, Vec<Vec<&str>>) {
        let columns = self.columns.iter();
        let heads = columns.map(|(kind, heading, unit)| TableColumn {
            heading,
            unit,
            is_number: matches!(kind, Kind::Numbers | Kind::Shaded),
        });
        (heads.collect(), self.rows.iter().map(|row| row.iter().map(Cell::text).collect()).collect())
    }
}

/// What a column shows.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TableColumn<'a> {
    pub heading: &'a str,
    /// Typeset; empty for words and pure numbers.
    pub unit: &'a str,
    /// Whether its cells are numbers as far as they can be.
    pub is_number: bool,
}

impl Render for TableText {
    fn render(&self) -> Markup {
        let heat = self.columns.iter().any(|(kind, ..)| *kind == Kind::Shaded).then_some("heat");
        html! {
            div.table {
                table class=[heat] {
                    @if !self.caption.is_empty() { caption { span { (self.caption) } } }
                    thead {
                        tr {
                            @for (kind, heading, unit) in &self.columns {
                                th scope="col" class=[(*kind == Kind::Numbers).then_some("number")] {
                                    (heading)
                                    @if !unit.is_empty() { " " span.unit { (unit) } }
                                }
                            }
                        }
                    }
                    tbody {
                        @for (row, mark) in self.rows.iter().zip(&self.marks) {
                            "\n"
                            tr class=[mark.map(Tone::class)] {
                                @for ((kind, ..), cell) in self.columns.iter().zip(row) { (in_place(*kind, cell)) }
                            }
                        }
                    }
                }
                @for footnote in &self.footnotes { p.footnote { (with_commands(footnote)) } }
            }
        }
    }
}

fn in_place(kind: Kind, cell: &Cell) -> Markup {
    let class = match (kind, cell) {
        // In steps of five per cent, which the style sheet has.
        (_, Cell::Shaded(_, share)) => Some(format!("shade-{:.0}", share / 5.0)),
        (Kind::Numbers, Cell::Text(text)) if text == NOT_DETERMINED => Some("number undetermined".to_owned()),
        (Kind::Numbers, _) => Some("number".to_owned()),
        _ => None,
    };
    html! {
        @if kind == Kind::Name { th scope="row" { (cell) } }
        @else { td class=[class] { (cell) } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(rows: &[(&str, [Option<f64>; 2])], cell: impl Fn(&[Option<f64>; 2], usize) -> Cell) -> String {
        let table = Table::of(rows).names("FRF", |row| row.0);
        let table = table.shaded("low", |row| cell(&row.1, 0)).shaded("high", |row| cell(&row.1, 1));
        table.render().into_string()
    }

    #[test]
    fn noise_is_not_shaded_and_what_is_far_above_it_is() {
        let html = map(&[("<4/1>", [Some(0.9), Some(1e5)])], |row, column| Cell::misfit(row[column]));
        assert!(html.contains("shade-0\">0.90<") && html.contains("shade-14\">100k<"), "{html}");
        assert!(html.contains("&lt;4/1&gt;"));
    }

    #[test]
    fn counts_are_shaded_by_their_share_of_the_row() {
        let rows = [("a", [Some(3.0), Some(1.0)]), ("b", [Some(0.0), Some(2.0)])];
        let html = map(&rows, |row, column| {
            Cell::count(row[column].unwrap_or(0.0), row.iter().flatten().sum::<f64>())
        });
        for part in ["shade-10\">3<", "shade-4\">1<", "<td></td>", "shade-14\">2<"] {
            assert!(html.contains(part), "{part} in {html}");
        }
    }

    #[test]
    fn what_a_footnote_says_to_type_is_set_as_that() {
        let table = Table::of([1.0]).names("FRF", |_| "4/1").footnote("`jointscope decompose` <anew>");
        let html = table.render().into_string();
        assert!(html.contains("<code>jointscope decompose</code> &lt;anew&gt;"), "{html}");
    }

    #[test]
    fn what_is_not_known_is_a_dash() {
        let html = map(&[("4/1", [None, Some(f64::NAN)])], |row, column| Cell::misfit(row[column]));
        assert_eq!(html.matches("<td>–</td>").count(), 2);
    }
}
