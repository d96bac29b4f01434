//! What the answers cost in time: kept apart from the scores, which are the same on every machine.

use crate::statistics::{median, quantile};
use serde_json::{Value, json};
use std::fmt;

/// Seconds of one core for an answer: median, 95 % quantile, longest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Timing {
    /// Half of the answers took less.
    pub median: f64,
    /// Nineteen of twenty took no longer.
    pub most: f64,
    /// The longest.
    pub longest: f64,
}

impl Timing {
    /// Summarises the seconds of all answers; zeros of none.
    pub fn of(seconds: &[f64]) -> Self {
        let at = |q| quantile(seconds, q).unwrap_or(0.0);
        Timing { median: median(seconds).unwrap_or(0.0), most: at(0.95), longest: at(1.0) }
    }

    /// The seconds as JSON.
    pub fn to_value(&self) -> Value {
        json!({ "seconds_a_case": { "median": self.median, "quantile_95": self.most, "longest": self.longest } })
    }
}

impl fmt::Display for Timing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Timing { median, most, longest } = self;
        write!(f, "seconds a case on one core: median {median:.2}, 95 % {most:.2}, longest {longest:.2}")
    }
}
