//! The scores of a route beside the laboratory's.

use crate::Sheet;
use crate::sheet::{Keyed, by_key, counted};
use crate::size::SizeScore;
use serde::Serialize;
use std::fmt::{self, Display, Formatter};
use std::ops::Deref;

/// The scores of one route.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RouteScore {
    /// Key in `proof.json`.
    #[serde(skip)]
    pub key: &'static str,
    /// Where its recordings come from, in words.
    pub what: &'static str,
    /// Shares, figures and every case.
    #[serde(flatten)]
    pub sheet: Sheet,
    /// Sizes found against the true ones.
    pub sizes: Vec<SizeScore>,
}

impl Deref for RouteScore {
    type Target = Sheet;

    fn deref(&self) -> &Sheet {
        &self.sheet
    }
}

impl Keyed for RouteScore {
    fn key(&self) -> &str {
        self.key
    }
}

impl Display for RouteScore {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}\n{}", self.key, self.what, self.sheet)?;
        if !self.sizes.is_empty() {
            writeln!(f, "\nsizes found: median error, within 10 %, 95 % intervals that hold the truth")?;
        }
        for SizeScore { what, median, within, held } in &self.sizes {
            let (median, within, held) = (100.0 * median, counted(*within), counted(*held));
            writeln!(f, "  {what:<60} {median:>6.2} %  {within}  {held}")?;
        }
        Ok(())
    }
}

/// The scores of the routes beside the laboratory's FRFs that have any case.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[serde(transparent)]
pub struct RouteScores(#[serde(serialize_with = "by_key")] pub Vec<RouteScore>);

impl Display for RouteScores {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|score| write!(f, "\n{score}"))
    }
}
