//! Stated probabilities against how often they were right.

use crate::{Judged, Share};
use serde::Serialize;
use std::fmt::{self, Display, Formatter};

/// Edges of the bins of stated probability.
const EDGES: [f64; 9] = [0.0, 0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 1.0];

/// Names whose stated probabilities lie close together.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Bin {
    /// From this probability on.
    pub from: f64,
    /// Up to this one.
    pub to: f64,
    /// Mean of what was stated.
    pub stated: f64,
    /// Names that were the hidden effect's own.
    #[serde(rename = "true_name")]
    pub true_names: Share,
    /// Names that count as right: true, or as good a fit.
    pub acceptable: Share,
}

/// All names that were stated for single effects, alternatives included, by their probability.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Reliability(pub Vec<Bin>);

impl Reliability {
    /// Collects the names of the cases' findings.
    pub(crate) fn of<'a>(judged: impl Iterator<Item = &'a Judged>) -> Self {
        let mut bins: Vec<Bin> =
            EDGES.windows(2).map(|edge| Bin { from: edge[0], to: edge[1], ..Bin::default() }).collect();
        for judged in judged {
            let hidden = judged.hidden();
            for (name, probability) in judged.findings().iter().flat_map(|found| found.names()) {
                let last = bins.len() - 1;
                let index = bins.iter().position(|bin| probability < bin.to).unwrap_or(last);
                let bin = &mut bins[index];
                bin.stated += probability;
                for (share, right) in [
                    (&mut bin.true_names, hidden.contains(&name)),
                    (&mut bin.acceptable, judged.accepts(&name)),
                ] {
                    share.all += 1;
                    share.of += usize::from(right);
                }
            }
        }
        for bin in &mut bins {
            bin.stated /= bin.true_names.all.max(1) as f64;
        }
        Reliability(bins)
    }
}

impl Display for Reliability {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let what = "number, mean stated, share that is the hidden name, share acceptable";
        writeln!(f, "\nstated probabilities of names: {what}:")?;
        for Bin { from, to, stated, true_names, acceptable } in &self.0 {
            if let (Some(own), Some(acceptable)) = (true_names.value(), acceptable.value()) {
                let count = true_names.all;
                writeln!(f, "  {from:.2} to {to:.2} {count:>5}  {stated:.3}  {own:.3}  {acceptable:.3}")?;
            }
        }
        Ok(())
    }
}
