//! What a model lets one expect of a recording: modes that it may hold besides those it shows, and modes too
//! low to be told from a mass line.

use crate::basis::Pole;
use crate::matching::Pairing;
use crate::modelled::ModelledModes;
use crate::poles::ModelledMode;
use crate::recorded::RecordedModes;
use crate::shapes::Shapes;
use jointscope_fixture::Fixture;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Modes of a model, in the band of a recording or a little below it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Expected {
    /// All of them.
    pub all: Vec<Pole>,
    /// Those that the recording, as far as it is told, has not.
    pub unpaired: Vec<Pole>,
}

impl RecordedModes {
    /// The modes that a fixture has in the band or a little below it; none where it cannot be modelled.
    pub fn expected_by(&self, fixture: &Fixture) -> Expected {
        let Some(modelled) = ModelledModes::of(fixture, self) else { return Expected::default() };
        let pairing = Pairing::of(self, &modelled);
        let of_band = || modelled.modes.iter().enumerate().filter(|(_, m)| m.pole.omega < TAU * self.band.1);
        let alone = of_band().filter(|(index, _)| pairing.pairs.iter().all(|(_, m)| m != index));
        Expected {
            all: of_band().map(|(_, mode)| mode.pole).collect(),
            unpaired: alone.map(|(_, mode)| mode.pole).collect(),
        }
    }

    /// Beside the fixture by itself. Its modes that are too low to be told from a mass line are a part of
    /// that, with the errors of their shapes, and count for all hypotheses: one with a mode just below the
    /// band must not gain by it. Where its modes out of the band need as many residual terms as the
    /// recording's free fit took, that many are no sign of anything else.
    pub fn beside(mut self, fixture: &Fixture) -> Self {
        let Some(modelled) = ModelledModes::of(fixture, &self) else { return self };
        self.excess_residual_terms &= !modelled.needs_last_term();
        self.low = self.shared_by_low_modes(fixture, &modelled.modes).unwrap_or_default();
        self
    }

    /// Covariance of mass lines by the errors of the shapes of a fixture's low modes; `None` where it has no
    /// such modes, or they have no shapes.
    fn shared_by_low_modes(&self, fixture: &Fixture, modes: &[ModelledMode]) -> Option<Vec<f64>> {
        let is_low = |mode: &&ModelledMode| mode.pole.omega <= TAU * self.resolved_from;
        let low: Vec<Complex64> = modes.iter().filter(is_low).map(|mode| mode.pole.lambda()).collect();
        if low.is_empty() {
            return None;
        }
        let shapes = Shapes::of(fixture, self, &low)?;
        let frfs = self.frfs();
        let shared = |e: usize| (0..low.len()).map(|m| shapes.shared(m, e / frfs, e % frfs)).sum();
        Some((0..frfs * frfs).map(shared).collect())
    }
}
