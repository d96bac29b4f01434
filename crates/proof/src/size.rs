//! Sizes found beside the true ones.

use crate::statistics::middle;
use crate::{Found, Share};
use jointscope_fixture::Effect;
use serde::Serialize;
use std::collections::BTreeMap;

/// A size that was found beside the true one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Size {
    /// The parameter.
    pub what: String,
    /// The true value.
    #[serde(rename = "true")]
    pub truth: f64,
    /// The value found.
    pub found: f64,
    /// Its 95 % interval, where one is stated.
    #[serde(rename = "ci95")]
    pub interval: Option<[f64; 2]>,
}

/// Relative error within which a size is right.
const RIGHT: f64 = 0.1;

impl Size {
    /// The parameters of what was hidden beside those of a finding of the same kind; `before` their names.
    /// What is zero has no relative error, nor has an abscissa.
    pub(crate) fn of_each(hidden: &Effect, found: &Found, before: &str) -> Vec<Size> {
        let parameters = hidden.kind.spec().parameters.iter().enumerate();
        let size = |(index, parameter): (usize, &jointscope_fixture::ParameterSpec)| Size {
            what: format!("{before}{}", parameter.name),
            truth: hidden.value(index),
            found: found.effect.value(index),
            interval: found.intervals.get(index).copied().flatten(),
        };
        let sized = parameters.filter(|(index, spec)| hidden.value(*index) != 0.0 && spec.name != "x");
        sized.map(size).collect()
    }

    /// Relative error.
    pub(crate) fn error(&self) -> f64 {
        self.found / self.truth - 1.0
    }

    /// Whether the size is right within 10 %.
    pub(crate) fn is_right(&self) -> bool {
        self.error().abs() <= RIGHT
    }

    /// Whether the interval holds the truth; one that is not stated does not.
    pub(crate) fn is_held(&self) -> bool {
        self.interval.is_some_and(|[low, high]| (low..=high).contains(&self.truth))
    }

    /// How far off it is, in words.
    pub(crate) fn says(&self) -> String {
        let held = if self.is_held() { "" } else { ", not in its interval" };
        format!("{}: {:+.2} % off{held}", self.what, 100.0 * self.error())
    }
}

/// How well the sizes of one parameter were found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SizeScore {
    /// The parameter.
    pub what: String,
    /// Median of the error's magnitude, relative.
    #[serde(rename = "median_error")]
    pub median: f64,
    /// Sizes within 10 % of the truth.
    #[serde(rename = "within_10_percent")]
    pub within: Share,
    /// Stated 95 % intervals that hold the truth, of all sizes found.
    #[serde(rename = "held_by_ci95")]
    pub held: Share,
}

impl SizeScore {
    /// Sizes by parameter, in the order of their names.
    pub(crate) fn all(sizes: &[Size]) -> Vec<SizeScore> {
        let mut by_name: BTreeMap<&str, Vec<&Size>> = BTreeMap::new();
        for size in sizes {
            by_name.entry(&size.what).or_default().push(size);
        }
        let score = |(what, sizes): (&str, Vec<&Size>)| SizeScore {
            what: what.to_owned(),
            median: middle(sizes.iter().map(|size| size.error().abs())).0.unwrap_or(0.0),
            within: Share::count(&sizes, |size| size.is_right()),
            held: Share::count(&sizes, |size| size.is_held()),
        };
        by_name.into_iter().map(score).collect()
    }
}
