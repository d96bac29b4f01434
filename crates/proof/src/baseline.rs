//! Two ways of dealing with a fixture that disagrees with its recording, without asking what was left out:
//! what the diagnosis is compared with.
//!
//! * **Parameter updating**: the quantities that the file states are moved until the model fits, once within
//!   their stated tolerances and once within [`WIDER`] times those, so that they can take up what is missing.
//! * **Nearest signature**: of all effects at all places in a few sizes, simulated in the refitted fixture,
//!   the one whose change of the FRFs looks most like the misfit.

mod lookup;
mod methods;
mod updating;

pub use lookup::Lookup;
pub use methods::{Method, Methods};
pub use updating::{Updated, WIDER};

use crate::Case;
use crate::workers::on_workers;
use jointscope_diagnosis::Observation;
use serde::Serialize;

/// What the two make of a case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Baseline {
    /// Quantities moved within their tolerances.
    #[serde(rename = "within_tolerances")]
    pub within: Updated,
    /// Quantities moved within wide bounds.
    pub freed: Updated,
    /// The nearest signature; `None` where what is left within the tolerances is no more than noise.
    #[serde(rename = "nearest_signature")]
    pub nearest: Option<Lookup>,
}

impl Baseline {
    /// Of a case; `None` where its fixture predicts nothing.
    pub fn of(case: &Case) -> Option<Self> {
        let observation = Observation::new(&case.recorded, |_| true).ok()?;
        let within = Updated::of(&case.believed, 1.0, &observation)?;
        // From the file as it is, and from what updating within tolerances led to, as somebody would go on.
        let starts = [&case.believed, &within.fixture];
        let freed = starts.into_iter().filter_map(|start| Updated::of(start, WIDER, &observation));
        let freed = freed.min_by(|a, b| a.chi2_per_dof.total_cmp(&b.chi2_per_dof))?;
        let nearest = if within.fits() { None } else { Lookup::of(&within.fixture, &observation) };
        Some(Baseline { within, freed, nearest })
    }

    /// Of all cases, on `threads` workers.
    pub fn all(cases: &[Case], threads: usize, progress: impl Fn(usize) + Sync) -> Vec<Option<Self>> {
        on_workers(cases, threads, progress, Baseline::of).into_iter().map(Option::flatten).collect()
    }
}
