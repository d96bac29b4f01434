//! The columns of a table, with units from their names or from the line below.

use super::header::{Column, Part, column};
use super::table::Table;
use crate::ImportError;

impl Column {
    /// Radians in one of a phase's unit.
    pub(super) fn radians(&self, table: &Table) -> Result<f64, ImportError> {
        match self.unit.to_lowercase().as_str() {
            "deg" | "degree" | "degrees" | "°" => Ok(std::f64::consts::PI / 180.0),
            "rad" | "radian" | "radians" => Ok(1.0),
            "" => Err(table.column_error(
                self.index,
                "the unit of the phase is not stated; write `phase [deg]` or `phase [rad]`",
            )),
            other => Err(table.column_error(
                self.index,
                format!("`{other}` is no unit of a phase; write `phase [deg]` or `phase [rad]`"),
            )),
        }
    }
}

/// Every column of a table.
pub(super) fn columns(table: &Table) -> Result<Vec<Column>, ImportError> {
    let mut columns = Vec::with_capacity(table.headers.len());
    for (index, header) in table.headers.iter().enumerate() {
        let Some(mut column) = column(index, header) else {
            let time = ["time", "t", "zeit"]
                .contains(&header.trim_matches(['[', 's', ']', ' ', '(', ')']).to_lowercase().as_str());
            return Err(table.column_error(index, match time {
                true => "a column of times: a table holds FRFs; export time histories as UFF (dataset 58)".to_owned(),
                false => "is neither `frequency` nor `real`, `imag`, `magnitude`, `phase` or `coherence` of an FRF; name it so, such as `4/1 real`, or take the column out".to_owned(),
            }));
        };
        let below = table.units.get(index).map_or("", String::as_str);
        if column.unit.is_empty() && !matches!(below, "-" | "1") {
            column.unit = below.to_owned();
        }
        if column.part == Part::Magnitude && column.unit.to_lowercase().starts_with("db") {
            return Err(table.column_error(index, "decibels: export the linear magnitude with its unit"));
        }
        if column.part == Part::Frequency && column.unit.is_empty() {
            if header.to_lowercase().contains("omega") {
                return Err(table.column_error(index, "the unit is not stated; write `omega [rad/s]`"));
            }
            column.unit = "Hz".to_owned();
        }
        columns.push(column);
    }
    Ok(columns)
}
