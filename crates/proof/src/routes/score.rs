//! The scores of a route: shares, figures, sizes against the truth, and every case in a line.

use crate::statistics::median;
use crate::{Figure, Rate, Share};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// The scores of one route.
#[derive(Debug, Clone, PartialEq)]
pub struct RouteScore {
    /// Key in `proof.json`.
    pub key: &'static str,
    /// Where its recordings come from, in words.
    pub what: &'static str,
    /// Number of cases by what was hidden, and how many of them were asked for.
    pub cases: Vec<(&'static str, usize, usize)>,
    /// Shares with targets.
    pub rates: Vec<Rate>,
    /// Other figures.
    pub figures: Vec<Figure>,
    /// Sizes found against the true ones.
    pub sizes: Vec<SizeScore>,
    /// Every case.
    pub lines: Vec<CaseLine>,
}

/// How well the sizes of one parameter were found.
#[derive(Debug, Clone, PartialEq)]
pub struct SizeScore {
    /// The parameter.
    pub what: String,
    /// Sizes within 10 % of the truth.
    pub within: Share,
    /// Median of the error's magnitude, relative.
    pub median: f64,
    /// Stated 95 % intervals that hold the truth, of all sizes found.
    pub held: Share,
}

/// A case in a line.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseLine {
    /// Its number.
    pub index: usize,
    /// What was hidden.
    pub hidden: String,
    /// How strongly it shows, in words; empty of nulls.
    pub size: String,
    /// The verdict.
    pub verdict: String,
    /// What was found, with its probability.
    pub found: String,
    /// What went wrong.
    pub faults: Vec<String>,
    /// Whether there is an answer, and with it a page.
    pub answered: bool,
    /// Whether something was to be found, or nothing, and not neither.
    pub asked: bool,
    /// What else an account of it tells, a line each.
    pub details: Vec<String>,
    /// The case as JSON.
    pub value: Value,
}

/// Relative error within which a size is right.
const RIGHT: f64 = 0.1;

/// A size that was found beside the true one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Size {
    pub what: String,
    pub truth: f64,
    pub found: f64,
    pub interval: Option<[f64; 2]>,
}

impl Size {
    /// Relative error.
    pub fn error(&self) -> f64 {
        self.found / self.truth - 1.0
    }

    /// Whether the size is right within 10 %.
    pub fn is_right(&self) -> bool {
        self.error().abs() <= RIGHT
    }

    /// The size as JSON.
    pub fn to_value(&self) -> Value {
        json!({ "what": self.what, "true": self.truth, "found": self.found, "ci95": self.interval })
    }

    /// Whether a stated interval holds the truth.
    pub fn is_held(&self) -> bool {
        self.interval.is_some_and(|[low, high]| (low..=high).contains(&self.truth))
    }
}

impl SizeScore {
    /// Sizes by parameter, in the order of their names.
    pub(crate) fn all(sizes: &[Size]) -> Vec<SizeScore> {
        let mut by_name: BTreeMap<&str, Vec<&Size>> = BTreeMap::new();
        for size in sizes {
            by_name.entry(&size.what).or_default().push(size);
        }
        let score = |(what, sizes): (&str, Vec<&Size>)| {
            let errors: Vec<f64> = sizes.iter().map(|size| size.error().abs()).collect();
            SizeScore {
                what: what.to_owned(),
                within: Share::count(&sizes, |size| size.is_right()),
                median: median(&errors).unwrap_or(0.0),
                held: Share::count(&sizes, |size| size.is_held()),
            }
        };
        by_name.into_iter().map(score).collect()
    }
}

impl RouteScore {
    /// The rate of a key.
    pub fn rate(&self, key: &str) -> Option<&Rate> {
        self.rates.iter().find(|rate| rate.key == key)
    }

    /// The figure of a key.
    pub fn figure(&self, key: &str) -> Option<&Figure> {
        self.figures.iter().find(|figure| figure.key == key)
    }
}
