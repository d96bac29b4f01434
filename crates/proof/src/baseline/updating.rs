//! Parameter updating: the file's own quantities moved until the model fits.

use jointscope_diagnosis::{Fit, Hypothesis, Observation};
use jointscope_fixture::{Fixture, Nature, Spread};
use serde::Serialize;

/// Times by which stated tolerances are widened for updating that may move everything.
pub const WIDER: f64 = 30.0;
/// Relative deviation that widening ends at: a quantity that may be anything.
const WIDEST: f64 = 0.5;
/// χ² per degree of freedom up to which a model counts as fitting: the diagnosis' own bound for noise from
/// coherence.
const FITS: f64 = 1.2;

/// A fixture updated to a recording.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Updated {
    /// The fixture with the quantities that were "identified".
    pub fixture: Fixture,
    /// χ² per degree of freedom.
    pub chi2_per_dof: f64,
}

impl Updated {
    /// The best of a fit from afar and one from nearby, under tolerances `wider` than stated; `None` where
    /// the fixture predicts nothing.
    pub(crate) fn of(believed: &Fixture, wider: f64, observation: &Observation) -> Option<Self> {
        let start = Hypothesis::nominal(&widened(believed, wider), false);
        let fits = [true, false].into_iter().filter_map(|far| Fit::of(&start, observation, far));
        let best = fits.min_by(|a, b| a.objective.total_cmp(&b.objective))?;
        let chi2_per_dof = best.chi2_per_dof(observation);
        Some(Updated { fixture: best.hypothesis.to_fixture().ok()?, chi2_per_dof })
    }

    /// Whether what is left is no more than noise.
    pub fn fits(&self) -> bool {
        self.chi2_per_dof < FITS
    }
}

fn widened(believed: &Fixture, wider: f64) -> Fixture {
    let mut fixture = believed.clone();
    let stated = fixture.quantities();
    for (entry, stated) in fixture.quantities_mut().into_iter().zip(&stated) {
        // What is exact stays so, and what is unknown is free already.
        let Some(std) = stated.std.filter(|std| *std > 0.0) else { continue };
        let is_place = stated.nature == Nature::Abscissa;
        let most = if is_place { f64::INFINITY } else { WIDEST * stated.value.abs() };
        entry.quantity.spread = Spread::Stated((wider * std).min(most.max(std)));
    }
    fixture
}
