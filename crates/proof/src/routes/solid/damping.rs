//! The solid's damping, as fixture files mean it: the viscous matrix of the assembly without its effects.
//!
//! A twin damps its modes by ratios, whatever they look like. The ratios that a fixture states are those of
//! the massless strip held firmly; where a layer yields, the same matrix makes other ratios of the new modes.

use super::twin::{MESH, Shown, twin};
use crate::GenerationError;
use crate::hammer_test::recorded_lines;
use jointscope_fem::ModeKind;
use jointscope_fixture::{Effect, EffectKind, Fixture};
use jointscope_linalg::LuWorkspace;
use jointscope_rig::{Instrument, StructureError, frfs};
use jointscope_spectra::{FrfPair, SpectralLines};
use num_complex::Complex64;
use serde_json::json;
use std::f64::consts::TAU;

/// Transverse modes of the lumped fixture.
const MODES: usize = 2;
/// Share of a frequency between the lines from which its pole is taken.
const APART: f64 = 0.01;
/// Rounds of taking it, each about the last.
const ROUNDS: usize = 3;

/// `solid` with the damping ratios that the lumped fixture's viscous matrix gives the modes of strip and
/// layers. `None` where a pole is not found.
pub(super) fn as_without(
    solid: Fixture,
    shown: &Shown,
    lumped: &Fixture,
    besides: &[Effect],
) -> Result<Option<Fixture>, GenerationError> {
    let of_the_strip = |effect: &&Effect| {
        let kinds = [EffectKind::JointMass, EffectKind::InterfaceCompliance, EffectKind::ShearDeformation];
        kinds.contains(&effect.kind)
    };
    let effects: Vec<Effect> = lumped.physics().iter().chain(besides).filter(of_the_strip).cloned().collect();
    if effects.is_empty() {
        return Ok(Some(solid));
    }
    let lumped = lumped.clone().with_physics(effects).map_err(StructureError::from)?;
    let lines = recorded_lines()?;
    let twin = twin(&solid, shown, &MESH, lines.hz()[lines.len() - 1])?;
    let modes = twin.frequencies().into_iter().zip(&twin.kinds);
    let own = modes.filter(|(_, kind)| **kind == ModeKind::Transverse).map(|(hz, _)| hz).take(MODES);
    let mut ratios = Vec::with_capacity(MODES);
    for hz in own {
        let Some(ratio) = ratio(&lumped, hz)? else { return Ok(None) };
        ratios.push(ratio);
    }
    let mut value = solid.to_value();
    value["damping"] = json!({ "modal_ratios": ratios });
    Ok(Some(Fixture::from_value(&value).map_err(StructureError::from)?))
}

/// Damping ratio of the mode about a frequency (Hz).
fn ratio(lumped: &Fixture, near: f64) -> Result<Option<f64>, GenerationError> {
    let mut centre = near;
    let mut found = None;
    for _ in 0..ROUNDS {
        let Some(pole) = pole(lumped, centre)? else { return Ok(None) };
        centre = pole.norm() / TAU;
        let ratio = -pole.re / pole.norm();
        let is_about = (centre / near - 1.0).abs() < 0.05 && ratio > 0.0 && ratio < 0.1;
        if !is_about {
            return Ok(None);
        }
        found = Some(ratio);
    }
    Ok(found)
}

/// The pole p of H(s) = (b₀ + b₁ s)/(s − p), which an FRF is near a resonance, from three lines: H s = p
/// H + b₀ + b₁ s.
fn pole(lumped: &Fixture, hz: f64) -> Result<Option<Complex64>, GenerationError> {
    let lines = SpectralLines::new(vec![(1.0 - APART) * hz, hz, (1.0 + APART) * hz])?;
    let set = frfs(lumped, &[FrfPair::transverse("4", "1")], &lines, Instrument::Perfect)?;
    let rows: Vec<(Complex64, Complex64)> =
        lines.omegas().map(|omega| Complex64::new(0.0, omega)).zip(set.values(0).iter().copied()).collect();
    let (scale, size) = (TAU * hz, rows[1].1.norm());
    let mut lu = LuWorkspace::new();
    let solved = lu.factorize(3, |matrix| {
        for (row, (s, h)) in rows.iter().enumerate() {
            // s/scale and H/size, both near one.
            matrix[3 * row..3 * row + 3].copy_from_slice(&[h / size, Complex64::ONE, s / scale]);
        }
    });
    let mut unknown: Vec<Complex64> = rows.iter().map(|(s, h)| h * s / (size * scale)).collect();
    Ok(solved.is_ok().then(|| {
        lu.solve_in_place(&mut unknown);
        unknown[0] * scale
    }))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic)]
mod tests {
    use super::*;
    use crate::Plan;
    use crate::generate::Draw;
    use crate::routes::solid::SolidTruth;

    #[test]
    fn a_pole_has_the_ratio_that_the_fixture_states_where_nothing_is_left_out() {
        let (_, truth) = SolidTruth::draw(Draw::of(&Plan::default(), "solid", 1, 1)).unwrap();
        let jointscope_fixture::Damping::ModalRatios { ratios: stated, .. } = truth.lumped.damping() else {
            panic!("ratios")
        };
        let structure = jointscope_rig::Structure::of(&truth.lumped).unwrap();
        let modes = structure.natural_frequencies().unwrap();
        for (hz, stated) in modes[2..].iter().zip(stated) {
            let ratio = ratio(&truth.lumped, 1.003 * hz).unwrap().unwrap();
            assert!((ratio / stated.value - 1.0).abs() < 1e-3, "{ratio} at {hz} Hz, stated {}", stated.value);
        }
    }
}
