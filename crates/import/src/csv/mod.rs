//! Tables in text: frequency beside real and imaginary part, or magnitude and phase, of one FRF or of many.
//!
//! * Fields are parted by `;`, tabs, commas or blanks; a decimal comma is known where something else parts
//!   the fields. Lines that start with `#` or `%` and lines before the header are passed.
//! * The header names the columns: `frequency`, `frequency_hz`, `f [Hz]`, `omega [rad/s]`; `4/1 real`,
//!   `4/1 imag`, `4/1 magnitude`, `4/1 phase [deg]`, `4/1 coherence`, `H(4:+z/1:+z) re`. A column's unit
//!   stands in brackets behind its name, or in a line of units below the header.
//! * A file of one FRF may leave the pair away (`frequency,real,imag`); a [`ColumnMap`] says which FRF it is.

mod columns;
mod header;
mod rows;
mod table;

use std::collections::BTreeSet;

use jointscope_uff::{Dataset58, UffFile};
use num_complex::Complex64;

use crate::function::{Values, function};
use crate::{ChannelPair, ColumnMap, ImportError};
use header::{Column, Part};
use rows::Rows;
use table::Table;

/// Reads the FRFs of a table.
pub(crate) fn read(
    bytes: &[u8],
    name: &str,
    map: &ColumnMap,
    used: &mut BTreeSet<usize>,
) -> Result<UffFile, ImportError> {
    let table = Table::of(&Rows::of(bytes)?)?;
    let columns = columns::columns(&table)?;
    let Some(frequency) = columns.iter().find(|column| column.part == Part::Frequency) else {
        return Err(ImportError::NoTable { why: "no column is named `frequency`".into() });
    };
    if let Some(second) = columns.iter().filter(|column| column.part == Part::Frequency).nth(1) {
        return Err(table.column_error(
            second.index,
            "a second column of frequencies: put functions on other lines into a file of their own",
        ));
    }
    let frequencies = table.values(frequency.index)?;
    let groups = groups(&table, &columns, name, map, used)?;
    let mut file = UffFile::default();
    for group in &groups {
        file.datasets.extend(group.datasets(&table, (&frequencies, &frequency.unit), name)?);
    }
    if file.datasets.is_empty() {
        return Err(ImportError::NoTable { why: "no column is part of an FRF".into() });
    }
    Ok(file)
}

/// The columns of one FRF.
struct Group<'c> {
    pair: ChannelPair,
    /// Unit that the analyst states.
    unit: Option<String>,
    columns: Vec<&'c Column>,
}

/// Columns by their FRF, in the order of their first.
fn groups<'c>(
    table: &Table,
    columns: &'c [Column],
    name: &str,
    map: &ColumnMap,
    used: &mut BTreeSet<usize>,
) -> Result<Vec<Group<'c>>, ImportError> {
    let mut groups: Vec<Group> = Vec::new();
    for column in columns.iter().filter(|column| column.part != Part::Frequency) {
        let header = &table.headers[column.index];
        let by_name = map.of_name(header).or_else(|| map.of_name(&column.stem));
        let entry = match (&column.pair, by_name) {
            (_, Some(entry)) => Some(entry),
            (Some(pair), None) => map.of_pair(pair),
            (None, None) if column.stem.is_empty() => map.of_file(name),
            _ => None,
        };
        let (pair, unit) = match (entry, &column.pair) {
            (Some((at, entry)), _) => {
                used.insert(at);
                (entry.pair.clone(), entry.unit.clone())
            }
            (None, Some(pair)) => (pair.clone(), None),
            (None, None) => {
                let example =
                    if column.stem.is_empty() { String::new() } else { format!("{}=", column.stem) };
                let problem = format!(
                    "the header does not say which FRF this is; name it such as `4/1 {}`, or say it with `--columns \"{example}4/1\"`",
                    column.part.name()
                );
                return Err(table.column_error(column.index, problem));
            }
        };
        match groups.iter_mut().find(|group| group.pair == pair) {
            Some(group) => {
                if group.columns.iter().any(|other| other.part == column.part) {
                    return Err(table
                        .column_error(column.index, format!("a second {} of {pair}", column.part.name())));
                }
                group.columns.push(column);
            }
            None => groups.push(Group { pair, unit, columns: vec![column] }),
        }
    }
    Ok(groups)
}

impl Group<'_> {
    fn part(&self, part: Part) -> Option<&Column> {
        self.columns.iter().find(|column| column.part == part).copied()
    }

    fn datasets(
        &self,
        table: &Table,
        frequencies: (&[f64], &str),
        name: &str,
    ) -> Result<Vec<Dataset58>, ImportError> {
        let mut datasets = Vec::new();
        let cartesian = (self.part(Part::Real), self.part(Part::Imaginary));
        let polar = (self.part(Part::Magnitude), self.part(Part::Phase));
        let values = match (cartesian, polar) {
            ((Some(real), Some(imaginary)), _) => {
                self.same_unit(table, real, imaginary)?;
                let (re, im) = (table.values(real.index)?, table.values(imaginary.index)?);
                Some((real, re.into_iter().zip(im).map(|(re, im)| Complex64::new(re, im)).collect()))
            }
            (_, (Some(magnitude), Some(phase))) => {
                let radians = phase.radians(table)?;
                let (r, phi) = (table.values(magnitude.index)?, table.values(phase.index)?);
                let polar = |(r, phi): (f64, f64)| Complex64::from_polar(r, phi * radians);
                // A negative magnitude is a real part, or decibels.
                if let Some(row) = r.iter().position(|r| *r < 0.0) {
                    return Err(table.field_error(
                        row,
                        magnitude.index,
                        "a magnitude below zero; if these are decibels, export linear values",
                    ));
                }
                Some((magnitude, r.into_iter().zip(phi).map(polar).collect()))
            }
            _ => None,
        };
        if let Some((first, values)) = values {
            let unit = self.unit.as_deref().unwrap_or(&first.unit);
            datasets.push(function(&self.pair, frequencies, unit, name, Values::Frf(values)));
        } else if let Some(lone) = self.columns.iter().find(|column| column.part != Part::Coherence) {
            let partner = match lone.part {
                Part::Real => Part::Imaginary,
                Part::Imaginary => Part::Real,
                Part::Magnitude => Part::Phase,
                _ => Part::Magnitude,
            };
            let problem = format!(
                "{} has no column `{}` beside this one; an FRF needs both",
                self.pair,
                partner.name()
            );
            return Err(table.column_error(lone.index, problem));
        }
        if let Some(coherence) = self.part(Part::Coherence) {
            let values = Values::Coherence(table.values(coherence.index)?);
            datasets.push(function(&self.pair, frequencies, "", name, values));
        }
        Ok(datasets)
    }

    fn same_unit(&self, table: &Table, first: &Column, second: &Column) -> Result<(), ImportError> {
        match first.unit == second.unit || second.unit.is_empty() {
            true => Ok(()),
            false => Err(table.column_error(
                second.index,
                format!("in `{}`, but the other part of {} in `{}`", second.unit, self.pair, first.unit),
            )),
        }
    }
}
