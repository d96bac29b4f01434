//! The column EXP: a user's own `stiffness.json` of one of the paper's examples.

use crate::paper::{Elements, STIFFNESS};
use serde_json::Value;

/// A user's own decomposition of one of the paper's examples, for the column EXP.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The example.
    pub example: &'static str,
    /// Magnitudes of the averaged stiffness, SI.
    pub stiffness: Elements,
    /// Magnitudes of the averaged damping, SI.
    pub damping: Elements,
    /// The relation they were found by; the tables are of `paper`.
    pub relation: String,
}

/// Why a decomposition cannot stand in the tables.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeasuredError {
    /// There is no such example.
    #[error("the tables have no example `{name}` (they have {known})")]
    Example {
        /// The name given.
        name: String,
        /// The names there are.
        known: String,
    },
    /// The file is no stiffness.json.
    #[error(
        "`average` holds no 2×2 matrices of stiffness and damping; make the file with `jointscope decompose`"
    )]
    NoAverage,
}

impl Measured {
    /// From the contents of a `stiffness.json`.
    ///
    /// # Errors
    /// See [`MeasuredError`].
    pub fn of(example: &str, file: &Value) -> Result<Self, MeasuredError> {
        let known =
            STIFFNESS.iter().find(|row| row.example == example).ok_or_else(|| MeasuredError::Example {
                name: example.to_owned(),
                known: STIFFNESS.map(|row| row.example).join(", "),
            })?;
        let elements = |key: &str| -> Option<Elements> {
            let element = |i: usize, j: usize| file["average"][key][i][j].as_f64().map(f64::abs);
            Some([element(0, 0)?, element(0, 1)?, element(1, 0)?, element(1, 1)?])
        };
        let (Some(stiffness), Some(damping)) = (elements("stiffness"), elements("damping")) else {
            return Err(MeasuredError::NoAverage);
        };
        let relation = file["relation"].as_str().unwrap_or("unknown").to_owned();
        Ok(Measured { example: known.example, stiffness, damping, relation })
    }
}
