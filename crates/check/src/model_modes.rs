//! The model's natural frequencies and damping ratios, supports, dashpots and effects included.

use crate::Figure;
use crate::figure::deviations;
use crate::has_dashpots;
use crate::over_time::nearest_over_time;
use crate::settings::model_modes::{
    BEYOND_BAND, EXTENSION, FOLLOWED_SHARE, HIGHEST_HZ, LAST_HZ, MOST_LISTED, SAME_FREQUENCY, ZERO_POLE,
};
use jointscope_fixture::{Damping, Fixture, Quantity, RatiosOf};
use jointscope_linalg::complex_eigenvalues;
use jointscope_lumped::{Assembly, LumpedError, StateSpace};
use num_complex::Complex64;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
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
    /// Kinds of the fixture's effects that are known by frequency only: the modes are those with a joint's own
    /// mass at its ends, and without the losses.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub by_frequency_only: Vec<&'static str>,
}

impl ModelModes {
    /// The modes up to beyond `highest` (Hz), or up to where there are some.
    pub(crate) fn of(fixture: &Fixture, highest: Option<f64>) -> Result<Self, LumpedError> {
        let (modes, by_frequency_only) =
            nearest_over_time(fixture, |nearest| Self::over_time(nearest, highest))?;
        Ok(ModelModes { by_frequency_only, ..modes })
    }

    /// As [`ModelModes::of`] of a fixture that has a form over time.
    fn over_time(fixture: &Fixture, highest: Option<f64>) -> Result<Self, LumpedError> {
        let mut to = highest.map_or(HIGHEST_HZ, |highest| BEYOND_BAND * highest);
        let stands = Some(fixture).filter(|fixture| is_held(fixture)).and_then(as_it_stands);
        let mut poles = Poles::of(fixture, stands.as_ref(), to)?;
        while poles.up_to(to).is_empty() && to < LAST_HZ {
            to *= EXTENSION;
            poles = Poles::of(fixture, stands.as_ref(), to)?;
        }
        let (rigid, mut found) = (poles.rigid, poles.up_to(to));
        found.truncate(MOST_LISTED);
        let nominal: Vec<f64> = found.iter().map(|pole| pole.norm() / TAU).collect();
        let std = deviations(fixture, &nominal, &BTreeSet::new(), |moved| {
            let moved =
                Poles::of(moved, stands.as_ref().map(|stands| moved_alike(stands, moved)).as_ref(), to)
                    .ok()?;
            // Where a mode came or went below, the one of the same place in the row is another.
            let same = (moved.rigid, moved.overdamped) == (poles.rigid, poles.overdamped);
            same.then(|| moved.oscillating.iter().map(|pole| pole.norm() / TAU).collect())
        });
        let suspended = on_supports(fixture, to);
        let soft = |k: usize| suspended.iter().any(|hz| (hz / nominal[k] - 1.0).abs() < SAME_FREQUENCY);
        let modes = found.iter().zip(std).enumerate().map(|(k, (pole, std))| ModelMode {
            frequency: Figure { value: nominal[k], std, unit: "Hz" },
            damping_ratio: (-pole.re / pole.norm()).max(0.0),
            on_supports: soft(k),
        });
        Ok(ModelModes { rigid, modes: modes.collect(), to, by_frequency_only: Vec::new() })
    }

    /// What of the fixture is not in these modes as it stands, in a sentence without a full stop; `None` where all
    /// is.
    pub fn nearness(&self) -> Option<String> {
        (!self.by_frequency_only.is_empty()).then(|| {
            format!(
                "{} known by frequency only: the modes are near ones, of half a joint's own mass at each of its ends and without such losses",
                self.by_frequency_only.iter().map(|kind| format!("`{kind}`")).collect::<Vec<_>>().join(" and ")
                    + if self.by_frequency_only.len() == 1 { " is" } else { " are" }
            )
        })
    }

    /// The first natural frequency in which the assembly bends, Hz.
    pub(crate) fn first_elastic(&self) -> Option<f64> {
        self.modes.iter().find(|mode| !mode.on_supports).map(|mode| mode.frequency.value)
    }

    /// The highest natural frequency at which the assembly moves as rigid on its supports, Hz; zero where it
    /// is free.
    pub(crate) fn highest_on_supports(&self) -> f64 {
        self.modes.iter().filter(|mode| mode.on_supports).map(|mode| mode.frequency.value).fold(0.0, f64::max)
    }
}

/// The poles of a model.
struct Poles {
    /// Number of modes at zero.
    rigid: usize,
    /// Number of real poles away from zero, up to a little beyond the highest frequency.
    overdamped: usize,
    /// The oscillating ones of positive frequency, up to as far, rad/s, ascending.
    oscillating: Vec<Complex64>,
}

impl Poles {
    /// Of a fixture; `stands` is the same with its supports in its modes, where that has all that moves it.
    fn of(fixture: &Fixture, stands: Option<&Fixture>, highest: f64) -> Result<Self, LumpedError> {
        match stands {
            Some(stands) => held(fixture, stands, highest),
            None => in_time(fixture, highest),
        }
    }

    /// The oscillating ones up to `highest` (Hz).
    fn up_to(&self, highest: f64) -> Vec<Complex64> {
        self.oscillating.iter().copied().take_while(|pole| pole.norm() <= TAU * highest).collect()
    }
}

/// The poles of an assembly on supports that has neither effects nor dashpots: from its matrices, for a clamp
/// that is put on a few free modes is softer than it is, and its frequencies far too high. Damping is small:
/// each mode has its own share of it.
fn held(fixture: &Fixture, stands: &Fixture, highest: f64) -> Result<Poles, LumpedError> {
    let (stands, free) = (Assembly::new(stands, highest)?, Assembly::new(fixture, highest)?);
    let n = stands.order();
    if free.order() != n {
        return in_time(fixture, highest);
    }
    let viscous = free.viscous_damping();
    let structural = match fixture.damping() {
        Damping::LossFactor(factor) => factor.value,
        _ => 0.0,
    };
    let square = |matrix: &[f64], shape: &[f64]| -> f64 {
        let row = |i: usize| -> f64 { (0..n).map(|j| matrix[i * n + j] * shape[j]).sum() };
        (0..n).map(|i| shape[i] * row(i)).sum()
    };
    let limit = TAU * FOLLOWED_SHARE * highest;
    let mut poles = Poles { rigid: 0, overdamped: 0, oscillating: Vec::new() };
    for (r, &eigenvalue) in stands.modes().eigenvalues().iter().enumerate() {
        let omega = eigenvalue.max(0.0).sqrt();
        if omega <= ZERO_POLE * TAU * highest {
            poles.rigid += 1;
            continue;
        }
        if omega > limit {
            break;
        }
        let shape = stands.modes().shape(r);
        let lost = square(&viscous, shape) + structural * square(free.stiffness(), shape) / omega;
        let ratio = 0.5 * lost / omega;
        if ratio < 1.0 {
            poles.oscillating.push(omega * Complex64::new(-ratio, (1.0 - ratio * ratio).sqrt()));
        } else {
            poles.overdamped += 2;
        }
    }
    Ok(poles)
}

/// The poles of the equations of motion over time.
fn in_time(fixture: &Fixture, highest: f64) -> Result<Poles, LumpedError> {
    let space = StateSpace::new(fixture, highest)?;
    let (size, coordinates) = (space.states(), space.coordinates());
    // Displacements times the highest frequency: all elements are then of its order, and eigenvalues as exact
    // as they can be.
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
    let zero = ZERO_POLE * omega;
    let rigid = all.iter().filter(|pole| pole.norm() <= zero).count().div_ceil(2);
    all.retain(|pole| pole.norm() > zero && pole.norm() <= FOLLOWED_SHARE * omega);
    let overdamped = all.iter().filter(|pole| pole.im.abs() <= zero).count();
    all.retain(|pole| pole.im > zero);
    Ok(Poles { rigid, overdamped, oscillating: all })
}

/// Whether an assembly is on supports and has neither effects nor dashpots.
fn is_held(fixture: &Fixture) -> bool {
    !fixture.supports().is_empty() && fixture.physics().is_empty() && !has_dashpots(fixture)
}

/// The fixture with its supports in its modes.
fn as_it_stands(fixture: &Fixture) -> Option<Fixture> {
    let ratios = Damping::ModalRatios { ratios: vec![Quantity::bare(0.01)], of: RatiosOf::AsItStands };
    fixture.clone().with_damping(ratios).ok()
}

/// `stands` with the numbers of `moved`: what is moved a little beyond the end of its beam would be refused
/// if it were stated so.
fn moved_alike(stands: &Fixture, moved: &Fixture) -> Fixture {
    let values: BTreeMap<String, f64> =
        moved.uncertain_quantities(false).into_iter().map(|(_, q)| (q.path.to_string(), q.value)).collect();
    let mut alike = stands.clone();
    let quantities = stands.uncertain_quantities(false).into_iter();
    alike
        .set_quantities(quantities.filter_map(|(index, q)| Some((index, *values.get(&q.path.to_string())?))));
    alike
}

/// Natural frequencies (Hz) of the modes whose strain energy is in the supports, effects left aside.
fn on_supports(fixture: &Fixture, highest: f64) -> Vec<f64> {
    if fixture.supports().is_empty() {
        return Vec::new();
    }
    let held = as_it_stands(fixture).and_then(|held| Assembly::new(&held, highest).ok());
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

    /// A beam whose left end is clamped, of EI and mass per length as stated.
    fn cantilever(length: f64, stiffness: f64, mass: f64, damping: &str) -> Fixture {
        let clamp = 1e5 * stiffness;
        let text = format!(
            r#"{{ "bodies": {{ "S": {{ "beam": {{ "from": 0, "to": {length}, "youngs_modulus": {{"value": 2.07e11, "std": 2e9}}, "second_moment": {}, "mass_per_length": {mass} }} }} }},
              "points": {{ "1": {{ "body": "S", "x": {} }}, "2": {{ "body": "S", "x": {length} }} }},
              "supports": {{ "clamp": {{ "body": "S", "x": 0, "stiffness": {}, "rotational_stiffness": {} }} }} {damping} }}"#,
            stiffness / 2.07e11,
            0.5 * length,
            clamp / length.powi(3),
            clamp / length
        );
        Fixture::from_json(&text).unwrap()
    }

    #[test]
    fn a_clamped_beam_has_every_mode_of_the_closed_form_however_it_is_damped() {
        // Roots of cos x · cosh x = −1.
        let roots = [1.875_104_068_7_f64, 4.694_091_133_0, 7.854_757_438_2, 10.995_540_734_9];
        let damped = [
            (r#", "damping": { "modal_ratios": [0.003] }"#, None),
            ("", Some(0.0)),
            (r#", "damping": { "loss_factor": 0.004 }"#, Some(0.002)),
        ];
        for [length, width, height] in
            [[0.5, 0.04, 0.006], [1.0, 0.03, 0.003], [0.3, 0.02, 0.002], [2.0, 0.1, 0.05]]
        {
            let (stiffness, mass) = (2.07e11 * width * f64::powi(height, 3) / 12.0, 7850.0 * width * height);
            for (damping, ratio) in damped {
                let modes =
                    ModelModes::of(&cantilever(length, stiffness, mass, damping), Some(2000.0)).unwrap();
                assert_eq!(modes.rigid, 0, "{length} m, {damping}");
                for (r, mode) in modes.modes.iter().enumerate().take(4) {
                    let hz = f64::powi(roots[r] / length, 2) * (stiffness / mass).sqrt() / TAU;
                    let error = mode.frequency.value / hz - 1.0;
                    // A clamp of a hundred thousand times the beam gives way to the shear force, which grows
                    // as the cube.
                    let allowed = 1e-4 + roots[r].powi(3) / 2e5;
                    assert!(
                        error.abs() < allowed,
                        "{length} m, {damping}, mode {}: off by {error:.1e}",
                        r + 1
                    );
                    // d ln f = ½ d ln E, of which the deviation is that of 2/207; lengths are known to their
                    // digits.
                    let std = mode.frequency.std.unwrap() / hz;
                    assert!((0.5 * 2.0 / 207.0..0.02).contains(&std), "{mode:?}");
                    assert!(
                        ratio.is_none_or(|ratio: f64| (mode.damping_ratio - ratio).abs() < 1e-5),
                        "{mode:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_mode_that_goes_where_a_number_is_moved_leaves_no_deviation_rather_than_a_wrong_one() {
        // A dashpot of which the deviation makes the mode on the support creep: the mode of the joint is then
        // first in the row.
        let modes = |std: f64| {
            let text = format!(
                r#"{{ "bodies": {{ "A": {{ "mass": {{"value": 2, "std": 0}}, "rotates": false }}, "B": {{ "mass": {{"value": 3, "std": 0}}, "rotates": false }} }},
                  "points": {{ "1": {{ "body": "A", "x": 0 }}, "2": {{ "body": "B", "x": 0.1 }} }},
                  "joints": {{ "J": {{ "from": "1", "to": "2", "stiffness": [[5e6, 0], [0, 0]] }} }},
                  "supports": {{ "S": {{ "point": "1", "stiffness": 1e4, "damping": {{"value": 350, "std": {std}}} }} }} }}"#
            );
            ModelModes::of(&Fixture::from_json(&text).unwrap(), None).unwrap().modes
        };
        let (small, large) = (modes(10.0), modes(200.0));
        assert!(small.len() == 2 && small.iter().all(|mode| mode.frequency.std.is_some()), "{small:?}");
        assert!(large.len() == 2 && large.iter().all(|mode| mode.frequency.std.is_none()), "{large:?}");
    }
}
