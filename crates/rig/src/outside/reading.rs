//! What channels read of a structure with physics that no effect describes.

use super::Outside;
use crate::{Instrument, StructureError, frfs, read};
use jointscope_fixture::{Effect, EffectKind, Fixture, Place};
use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;

impl Outside {
    /// Noise-free accelerances of the assembly that `fixture` describes with this physics in it.
    ///
    /// # Errors
    /// As [`crate::frfs`]; [`StructureError::UnknownPoint`] for a place that the fixture does not have.
    pub fn frfs(
        &self,
        fixture: &Fixture,
        pairs: &[FrfPair],
        lines: &SpectralLines,
        instrument: Instrument,
    ) -> Result<FrfSet, StructureError> {
        let plain = || frfs(fixture, pairs, lines, instrument);
        let stiffer = |factor: f64, joint: Option<&str>| {
            let joints = fixture.joints().iter().filter(|known| joint.is_none_or(|name| known.name == name));
            let mut physics = fixture.physics().to_vec();
            physics.extend(joints.map(|joint| {
                let place = Place::Joint(joint.name.clone());
                Effect::new(EffectKind::StiffnessChange, place, None, &[factor])
            }));
            frfs(&fixture.clone().with_physics(physics)?, pairs, lines, instrument)
        };
        match self {
            Outside::Drift { joint, reference, factor } => {
                let (before, after) = (plain()?, stiffer(*factor, Some(joint))?);
                by_frf(&before, |index, pair| {
                    let struck = if pair.reference.point == *reference { &after } else { &before };
                    struck.values(index).to_vec()
                })
            }
            Outside::CrossAxis { response, coupling, ratio } if !instrument.is_perfect() => {
                let (within, across) = (plain()?, stiffer(*ratio, None)?);
                by_frf(&within, |index, pair| {
                    let share = if pair.response.point == *response { *coupling } else { 0.0 };
                    let both = within.values(index).iter().zip(across.values(index));
                    both.map(|(within, across)| within + share * across).collect()
                })
            }
            Outside::ClockError { response, rate } if !instrument.is_perfect() => {
                // A motion y(t) sampled at (1 + ε) times the rate that is believed is taken for y(t/(1 + ε)).
                let scale = 1.0 + rate;
                let scaled = SpectralLines::new(lines.hz().iter().map(|hz| scale * hz).collect())?;
                let (right, wrong) = (plain()?, frfs(fixture, pairs, &scaled, instrument)?);
                by_frf(&right, |index, pair| match pair.response.point == *response {
                    true => wrong.values(index).iter().map(|value| scale * value).collect(),
                    false => right.values(index).to_vec(),
                })
            }
            Outside::CrossAxis { .. } | Outside::ClockError { .. } => plain(),
            _ => read(&self.structure(fixture)?, instrument.effects(fixture), pairs, lines),
        }
    }
}

/// The set with other values, FRF after FRF.
fn by_frf(
    set: &FrfSet,
    values: impl Fn(usize, &FrfPair) -> Vec<Complex64>,
) -> Result<FrfSet, StructureError> {
    let all = set.pairs().iter().enumerate().flat_map(|(index, pair)| values(index, pair)).collect();
    Ok(FrfSet::new(set.lines().clone(), FrfForm::Accelerance, set.pairs().to_vec(), all)?)
}
