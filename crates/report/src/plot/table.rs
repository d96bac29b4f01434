//! The curves of a plot as rows of numbers.

use super::data::check;
use super::{Plot, Style};
use crate::error::PageError;

impl Plot {
    /// The curves over each abscissa: a row of headings with SI units, then a row a line; a gap is empty.
    pub(crate) fn curves(&self) -> Result<Vec<Vec<Vec<String>>>, PageError> {
        check(self)?;
        let of_table = |(table, abscissa): (usize, &Vec<f64>)| {
            let members: Vec<_> = self.series.iter().filter(|series| series.table == table).collect();
            let mut head = vec![headed(&self.x.label, &self.x.unit)];
            for series in &members {
                match series.style {
                    Style::Band => {
                        let end = |end: &str| headed(&format!("{}, {end}", series.label), &self.y.unit);
                        head.extend([end("low"), end("high")]);
                    }
                    _ => head.push(headed(&series.label, &self.y.unit)),
                }
            }
            let row = |line: usize| {
                let edges = members.iter().flat_map(|series| series.edges()).map(|edge| edge[line]);
                std::iter::once(abscissa[line]).chain(edges).map(number).collect()
            };
            let rows = (0..abscissa.len()).map(row);
            (!members.is_empty()).then(|| std::iter::once(head).chain(rows).collect())
        };
        Ok(self.tables.iter().enumerate().filter_map(of_table).collect())
    }
}

fn headed(label: &str, unit: &str) -> String {
    if unit.is_empty() || unit == "1" { label.to_owned() } else { format!("{label} [{unit}]") }
}

/// A number that reads back as itself, in its shorter spelling; nothing for what is not finite.
fn number(value: f64) -> String {
    if !value.is_finite() {
        return String::new();
    }
    let (plain, scientific) = (format!("{value}"), format!("{value:e}"));
    if plain.len() <= scientific.len() + 2 { plain } else { scientific }
}
