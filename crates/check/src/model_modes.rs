//! The model's natural frequencies and damping ratios, supports, dashpots and effects included.

use crate::Figure;
use crate::figure::deviations;
use jointscope_fixture::{Damping, Fixture, Quantity, RatiosOf};
use jointscope_linalg::complex_eigenvalues;
use jointscope_lumped::{Assembly, LumpedError, StateSpace};
use num_complex::Complex64;
use serde::Serialize;
use std::f64::consts::TAU;

/// One vibration mode of the model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ModelMode {
    /// Undamped natural frequency |λ|/2π.
    pub frequency: Figure,
    /// Damping ratio −Re λ/|λ|.
    pub damping_ratio: f64,
    /// Whether the assembly moves as rigid on its supports in it.
    pub on_supports: bool,
}

/// The modes of the model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelModes {
    /// Number of modes as rigid at 0 Hz: 2 of a free assembly, fewer on supports.
    pub rigid: usize,
    /// Modes above 0 Hz, ascending.
    pub modes: Vec<ModelMode>,
    /// Frequency up to which they were looked for, Hz.
    pub to: f64,
}

/// Frequency up to which modes are looked for without a recording, Hz, the factor by which it grows where there is no mode, and where that ends.
const TO: f64 = 2000.0;
const FARTHER: f64 = 4.0;
const FARTHEST: f64 = 1e6;
/// Modes that are listed at the most.
const LISTED: usize = 20;
/// Beyond the last line of a recording modes matter as well.
const BEYOND: f64 = 1.2;
/// Share of the highest frequency below which a pole is at zero: rounding of a double one is the root of the machine's.
const ZERO: f64 = 1e-6;
/// Relative distance of natural frequencies with and without effects up to which a mode is the same one.
const SAME: f64 = 0.1;

impl ModelModes {
    /// The modes up to beyond `highest` (Hz), or up to where there are some.
    pub(crate) fn of(fixture: &Fixture, highest: Option<f64>) -> Result<Self, LumpedError> {
        let mut to = highest.map_or(TO, |highest| BEYOND * highest);
        let (mut rigid, mut found) = poles(fixture, to)?;
        while found.is_empty() && to < FARTHEST {
            to *= FARTHER;
            (rigid, found) = poles(fixture, to)?;
        }
        found.truncate(LISTED);
        let nominal: Vec<f64> = found.iter().map(|pole| pole.norm() / TAU).collect();
        let std = deviations(fixture, &nominal, |moved| {
            let (_, moved) = poles(moved, to).ok()?;
            let hz: Vec<f64> = moved.iter().take(nominal.len()).map(|pole| pole.norm() / TAU).collect();
            (hz.len() == nominal.len()).then_some(hz)
        });
        let suspended = on_supports(fixture, to);
        let soft = |k: usize| suspended.iter().any(|hz| (hz / nominal[k] - 1.0).abs() < SAME);
        let modes = found.iter().zip(std).enumerate().map(|(k, (pole, std))| ModelMode {
            frequency: Figure { value: nominal[k], std, unit: "Hz" },
            damping_ratio: (-pole.re / pole.norm()).max(0.0),
            on_supports: soft(k),
        });
        Ok(ModelModes { rigid, modes: modes.collect(), to })
    }

    /// The first natural frequency in which the assembly bends, Hz.
    pub fn first_elastic(&self) -> Option<f64> {
        self.modes.iter().find(|mode| !mode.on_supports).map(|mode| mode.frequency.value)
    }

    /// The highest natural frequency at which the assembly moves as rigid on its supports, Hz; zero where it is free.
    pub fn highest_on_supports(&self) -> f64 {
        self.modes.iter().filter(|mode| mode.on_supports).map(|mode| mode.frequency.value).fold(0.0, f64::max)
    }
}

/// Number of modes at zero, and the oscillating poles up to `highest` (Hz), rad/s, ascending.
fn poles(fixture: &Fixture, highest: f64) -> Result<(usize, Vec<Complex64>), LumpedError> {
    let space = StateSpace::new(fixture, highest)?;
    let (size, coordinates) = (space.states(), space.coordinates());
    // Displacements times the highest frequency: all elements are then of its order, and eigenvalues as exact as they can be.
    let omega = TAU * highest;
    let scale = |i: usize| if i < coordinates { omega } else { 1.0 };
    let matrix: Vec<Complex64> = space
        .matrix()
        .iter()
        .enumerate()
        .map(|(at, element)| Complex64::from(element * scale(at / size) / scale(at % size)))
        .collect();
    let mut all = complex_eigenvalues(size, &matrix)?;
    all.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    let zero = ZERO * omega;
    let rigid = all.iter().filter(|pole| pole.norm() <= zero).count().div_ceil(2);
    let oscillating = |pole: &Complex64| pole.norm() > zero && pole.im > zero && pole.norm() <= omega;
    all.retain(oscillating);
    Ok((rigid, all))
}

/// Natural frequencies (Hz) of the modes whose strain energy is in the supports, effects left aside.
fn on_supports(fixture: &Fixture, highest: f64) -> Vec<f64> {
    if fixture.supports().is_empty() {
        return Vec::new();
    }
    let ratios = Damping::ModalRatios { ratios: vec![Quantity::bare(0.01)], of: RatiosOf::AsItStands };
    let held = fixture.clone().with_damping(ratios).ok().and_then(|held| Assembly::new(&held, highest).ok());
    let Some(held) = held else { return Vec::new() };
    let hz = held.natural_frequencies_hz();
    let suspended = (0..hz.len()).filter(|r| hz[*r] > 0.0 && !held.elastic_modes().contains(r));
    suspended.map(|r| hz[r]).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn two_masses_on_a_spring_have_one_rigid_mode_and_one_at_the_closed_form() {
        let fixture = Fixture::from_json(
            r#"{ "bodies": { "A": { "mass": {"value": 2.0, "std": 0.02}, "rotates": false }, "B": { "mass": {"value": 3.0, "std": 0}, "rotates": false } },
              "points": { "1": { "body": "A", "x": {"value": 0, "std": 0} }, "2": { "body": "B", "x": {"value": 0.1, "std": 0} } },
              "joints": { "J": { "from": "1", "to": "2", "stiffness": [[{"value": 5e6, "std": 1e5}, {"value": 0, "std": 0}], [{"value": 0, "std": 0}, {"value": 0, "std": 0}]] } },
              "damping": { "modal_ratios": [{"value": 0.02, "std": 0}] } }"#,
        );
        let modes = ModelModes::of(&fixture.unwrap(), None).unwrap();
        let hz = (5e6f64 * 5.0 / 6.0).sqrt() / TAU;
        assert_eq!((modes.rigid, modes.modes.len()), (1, 1));
        let mode = modes.modes[0];
        assert!((mode.frequency.value / hz - 1.0).abs() < 1e-9 && (mode.damping_ratio - 0.02).abs() < 1e-9);
        // d ln f = ½ d ln k − ½ (m_B/(m_A + m_B)) d ln m_A.
        let std = hz * ((0.5f64 * 0.02).powi(2) + (0.5f64 * 0.6 * 0.01).powi(2)).sqrt();
        assert!((mode.frequency.std.unwrap() / std - 1.0).abs() < 0.02, "{mode:?} {std}");
    }

    #[test]
    fn a_free_beams_modes_are_those_of_the_closed_form_and_a_soft_suspension_is_told_apart() {
        let beam = |more: &str| {
            let text = format!(
                r#"{{ "bodies": {{ "S": {{ "beam": {{ "from": 0, "to": 0.5, "youngs_modulus": 2.1e11, "second_moment": 7.2e-10, "mass_per_length": 1.8 }} }} }},
                  "points": {{ "1": {{ "body": "S", "x": 0 }}, "2": {{ "body": "S", "x": 0.5 }} }}, {more} "damping": {{ "modal_ratios": [0.002] }} }}"#
            );
            ModelModes::of(&Fixture::from_json(&text).unwrap(), None).unwrap()
        };
        let free = beam("");
        let first = 4.730_040_745f64.powi(2) / (TAU * 0.25) * (2.1e11f64 * 7.2e-10 / 1.8).sqrt();
        assert_eq!(free.rigid, 2);
        assert!((free.first_elastic().unwrap() / first - 1.0).abs() < 1e-4, "{free:?} {first}");
        let hung = beam(
            r#""supports": { "left": { "point": "1", "stiffness": 50 }, "right": { "point": "2", "stiffness": 50 } },"#,
        );
        assert_eq!((hung.rigid, hung.modes.iter().filter(|mode| mode.on_supports).count()), (0, 2));
        assert!((hung.first_elastic().unwrap() / first - 1.0).abs() < 1e-3);
    }
}
