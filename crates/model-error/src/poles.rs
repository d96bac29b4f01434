//! The poles of a model by the secant method from nearby, and residues by a contour about each.
//!
//! The FRFs are analytic functions of the complex frequency, effects and measuring chain included, so nothing
//! here knows what an effect does.

use crate::basis::Pole;
use crate::outline::grid;
use crate::recorded::RecordedModes;
use crate::settings::poles::{
    ABOUT_RESONANCE, APART_IN_DECAY, APART_IN_FREQUENCY, CONTOUR_POINTS, FARTHEST_ABOVE, FARTHEST_BELOW,
    HINTED_AT, LAST_STEP, LEAST_APART_IN_DECAY, LEAST_RADIUS, MOST_DISTANCE, MOST_STEPS, NARROWEST_RATIO,
    PEAK_STEP, RADIUS_OF_DECAY, SAME_POLE, SINGLE_POLE_WITHIN, UNDAMPED_RATIO, WELL_INSIDE, WIDE_CONTOUR,
};
use jointscope_fixture::{Effect, Fixture};
use jointscope_lumped::{ContinuedFrfs, Instrument, ModelledTest};
use jointscope_spectra::{FrfSet, SpectralLines};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// One mode of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelledMode {
    /// Natural frequency and damping ratio.
    pub pole: Pole,
    /// Residue in each FRF of the recording, as [`RecordedMode::residues`](crate::RecordedMode::residues).
    pub residues: Vec<Complex64>,
}

/// Number of modes that a fixture has within the lines of FRFs, as far as they make peaks; `None` where it
/// cannot be modelled.
///
/// A mode that is weak in all FRFs and close to a stronger one makes none and is not counted.
pub fn modes_within(fixture: &Fixture, frfs: &FrfSet) -> Option<usize> {
    let hz = frfs.lines().hz();
    let (low, high) = (hz[0], hz[hz.len() - 1]);
    let test = ModelledTest::new(fixture, frfs.pairs(), high, Instrument::AsRecorded).ok()?;
    let found = peaking(&test, &grid(low, high, 0)?, frfs.pairs().len());
    Some(found.iter().filter(|pole| (TAU * low..=TAU * high).contains(&pole.norm())).count())
}

/// The poles in and near the band of a recording (from half its lowest line to 1.6 times its highest), rad/s,
/// ascending: from the peaks of the FRFs over a grid of frequencies, close by where effects resonate by
/// themselves, and from the recording's own modes.
pub(crate) fn poles(test: &ModelledTest, fixture: &Fixture, recorded: &RecordedModes) -> Vec<Complex64> {
    let mut all = peaking(test, &recorded.outline.grid, recorded.frfs());
    let (low, high) = (FARTHEST_BELOW * recorded.lowest, FARTHEST_ABOVE * recorded.band.1);
    let near = |about: &SpectralLines| about.hz()[0] < high && about.hz().iter().any(|hz| *hz > low);
    for about in fixture.effects().filter_map(about_own_resonance).filter(near) {
        peaking(test, &about, recorded.frfs()).into_iter().for_each(|pole| add(&mut all, pole));
    }
    // A narrow mode that is weak in all FRFs may lie between two frequencies of the grid: then a recorded one
    // shows where to look.
    let mut frfs = test.continued();
    for guess in recorded.modes.iter().map(|mode| mode.pole.lambda()) {
        if all.iter().all(|pole| (pole - guess).norm() > HINTED_AT * guess.norm())
            && let Some((pole, _)) = followed(&mut frfs, guess + apart(guess), guess, recorded.frfs())
        {
            add(&mut all, pole);
        }
    }
    ascending(&mut all);
    all.retain(|pole| pole.norm() >= TAU * low && pole.norm() <= TAU * high);
    all
}

/// Frequencies about the one at which an effect resonates by itself, half a resonance's width from one to the
/// next: a light resonator's peak falls between two of any other grid.
fn about_own_resonance(effect: &Effect) -> Option<SpectralLines> {
    let parameters = effect.kind.spec().parameters;
    let value = |name: &str| Some(effect.value(parameters.iter().position(|p| p.name == name)?));
    let (hz, ratio) = (value("frequency")?, value("damping_ratio")?);
    let step = ratio.clamp(NARROWEST_RATIO, ABOUT_RESONANCE / 2.0);
    let count = (ABOUT_RESONANCE / step).ceil() as i32;
    let lines = (-count..=count).map(|k| hz * (step * f64::from(k)).exp());
    SpectralLines::new(lines.collect()).ok()
}

/// The poles that peaks of the FRFs over a grid of frequencies lead to, ascending.
fn peaking(test: &ModelledTest, grid: &SpectralLines, count: usize) -> Vec<Complex64> {
    let Ok(values) = test.accelerances(grid) else { return Vec::new() };
    let hz = grid.hz();
    let peaks = |k: usize| {
        let peak = |frf: &[Complex64]| {
            let size = |k: usize| frf[k].norm_sqr();
            size(k) > size(k - 1) && size(k) >= size(k + 1)
        };
        values.chunks_exact(hz.len()).any(peak)
    };
    let mut frfs = test.continued();
    let mut all: Vec<Complex64> = Vec::new();
    for k in (1..hz.len() - 1).filter(|&k| peaks(k)) {
        let guess = Complex64::new(0.0, TAU * hz[k]);
        let step = Complex64::new(0.0, PEAK_STEP * TAU * (hz[k + 1] - hz[k]));
        // From the peak a mode that is weak in all FRFs leads to a stronger one; from where a single pole
        // would make it, to itself.
        let about = [k - 1, k, k + 1].map(|k| (Complex64::new(0.0, TAU * hz[k]), k));
        let single = single_pole(about, values.chunks_exact(hz.len()));
        let near =
            |pole: &Complex64| (pole - guess).norm() < SINGLE_POLE_WITHIN * TAU * (hz[k + 1] - hz[k - 1]);
        let single = single.filter(near).map(|pole| (pole + apart(pole), pole));
        for (before, at) in [(guess + step, guess)].into_iter().chain(single) {
            if let Some((pole, _)) = followed(&mut frfs, before, at, count) {
                add(&mut all, pole);
            }
        }
    }
    ascending(&mut all);
    all
}

/// The pole p of c + r/(s − p), c and r of each FRF its own, through the values at three points (s, index):
/// from two of the differences the constant is gone, and from their quotient the residue. FRFs that change
/// most count most.
fn single_pole<'a>(
    [(s1, k1), (s2, k2), (s3, k3)]: [(Complex64, usize); 3],
    frfs: impl Iterator<Item = &'a [Complex64]>,
) -> Option<Complex64> {
    let (mut above, mut below) = (Complex64::ZERO, 0.0);
    for frf in frfs {
        let [first, second] = [(frf[k1] - frf[k2]) / (s2 - s1), (frf[k2] - frf[k3]) / (s3 - s2)];
        above += first * second.conj();
        below += second.norm_sqr();
    }
    // (s₃ − p)/(s₁ − p)
    let quotient = above / below;
    let pole = (quotient * s1 - s3) / (quotient - 1.0);
    (pole.is_finite() && pole.im > 0.0).then_some(pole)
}

/// Adds a pole that is not there yet.
fn add(all: &mut Vec<Complex64>, pole: Complex64) {
    if all.iter().all(|other| (pole - other).norm() > SAME_POLE * pole.norm()) {
        all.push(pole);
    }
}

fn ascending(all: &mut [Complex64]) {
    all.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
}

/// Where the secant method starts beside a pole's guess.
fn apart(guess: Complex64) -> Complex64 {
    let decay = APART_IN_DECAY * guess.re.abs() + LEAST_APART_IN_DECAY * guess.norm();
    Complex64::new(-decay, APART_IN_FREQUENCY * guess.norm())
}

/// Growth, as a share of the pole, that rounding makes of no damping at all.
const ROUNDING: f64 = 1e-9;

/// Whether a mode at this pole dies away, or at least does not grow beyond rounding: a suspension may have no
/// damping at all.
fn is_damped(pole: Complex64) -> bool {
    pole.im > 0.0 && pole.re <= ROUNDING * pole.norm()
}

/// The pole that the secant method leads to from two points, and the FRFs' values on the way there.
fn followed(
    frfs: &mut ContinuedFrfs,
    mut before: Complex64,
    mut at: Complex64,
    count: usize,
) -> Option<(Complex64, Vec<Complex64>)> {
    let guess = at;
    let mut values = vec![Complex64::ZERO; count];
    if !frfs.at(before, &mut values) {
        return None;
    }
    // The sum of all FRFs in which those that see the mode most weigh most.
    let weights: Vec<Complex64> = values.iter().map(|v| v.conj()).collect();
    let inverse = |frfs: &mut ContinuedFrfs, s: Complex64, values: &mut [Complex64]| -> Complex64 {
        match frfs.at(s, values) {
            true => values.iter().zip(&weights).map(|(v, w)| v * w).sum::<Complex64>().inv(),
            false => Complex64::ZERO,
        }
    };
    let mut earlier = inverse(frfs, before, &mut values);
    for _ in 0..MOST_STEPS {
        let now = inverse(frfs, at, &mut values);
        if now == Complex64::ZERO {
            return is_damped(at).then_some((at, values));
        }
        if now == earlier {
            return None;
        }
        let next = at - now * (at - before) / (now - earlier);
        if !next.is_finite() || (next - guess).norm() > MOST_DISTANCE * guess.norm() {
            return None;
        }
        (before, earlier) = (at, now);
        at = next;
        if (at - before).norm() <= (LAST_STEP * radius(at)).min(SAME_POLE * at.norm()) {
            return is_damped(at).then_some((at, values));
        }
    }
    None
}

/// Radius of the contour about a pole.
fn radius(pole: Complex64) -> f64 {
    (RADIUS_OF_DECAY * pole.re.abs()).max(LEAST_RADIUS * pole.norm())
}

/// Pole and residues near `guess`.
pub(crate) fn mode(frfs: &mut ContinuedFrfs, guess: Complex64, count: usize) -> Option<ModelledMode> {
    let (near, mut values) = followed(frfs, guess + apart(guess), guess, count)?;
    mode_about(frfs, (near, count), &mut values)
}

/// The same where the pole is so near that a contour about `guess` holds it: for steps of a difference. Two
/// contours take less than half of what the secant method does.
pub(crate) fn mode_beside(frfs: &mut ContinuedFrfs, guess: Complex64, count: usize) -> Option<ModelledMode> {
    let mut values = Vec::new();
    let wide = WIDE_CONTOUR * radius(guess);
    let off = Contour::about(frfs, (guess, wide), count, &mut values)?.off();
    // What others make of the first contour goes with the fourth power of its radius.
    if off.norm() > WELL_INSIDE * wide || !is_damped(guess + off) {
        return mode(frfs, guess, count);
    }
    mode_about(frfs, (guess + off, count), &mut values)
}

/// Pole and residues by a contour about a place next to the pole.
fn mode_about(
    frfs: &mut ContinuedFrfs,
    (near, count): (Complex64, usize),
    values: &mut Vec<Complex64>,
) -> Option<ModelledMode> {
    let contour = Contour::about(frfs, (near, radius(near)), count, values)?;
    // The secant method's last steps come and go with rounding, and what a pole is off by is left of its
    // resonance on lines. The contour tells it to every digit.
    let off = contour.off();
    let at = if off.norm() <= radius(near) { near + off } else { near };
    // Of s²A/((s − λ)(s − λ̄)) the residue at λ is λ²A/(λ − λ̄).
    let factor = Complex64::new(0.0, 2.0 * at.im) / (at * at);
    let residues = contour.residues.iter().map(|residue| residue * factor).collect();
    let mut pole = Pole::of(at);
    pole.damping_ratio = pole.damping_ratio.max(UNDAMPED_RATIO);
    Some(ModelledMode { pole, residues })
}

/// What a circle about a place says of the pole in it.
struct Contour {
    /// Of each FRF, r of r/(s − λ).
    residues: Vec<Complex64>,
    /// First moments about the centre.
    moments: Vec<Complex64>,
}

impl Contour {
    /// About a centre, with this radius.
    fn about(
        frfs: &mut ContinuedFrfs,
        (centre, radius): (Complex64, f64),
        count: usize,
        values: &mut Vec<Complex64>,
    ) -> Option<Self> {
        let steps: [Complex64; CONTOUR_POINTS] = std::array::from_fn(|point| {
            Complex64::from_polar(radius, TAU * (point as f64 + 0.5) / CONTOUR_POINTS as f64)
        });
        values.resize(count * CONTOUR_POINTS, Complex64::ZERO);
        if !frfs.at_each(&steps.map(|step| centre + step), values) {
            return None;
        }
        let (mut residues, mut moments) = (vec![Complex64::ZERO; count], vec![Complex64::ZERO; count]);
        for (step, values) in steps.iter().zip(values.chunks_exact(count)) {
            for ((residue, moment), value) in residues.iter_mut().zip(&mut moments).zip(values) {
                let share = value * step / CONTOUR_POINTS as f64;
                *residue += share;
                *moment += share * step;
            }
        }
        Some(Contour { residues, moments })
    }

    /// The pole's place from the centre: of r/(s − λ) the first moment over the residue, to the fourth power
    /// of that distance as a share of the radius.
    fn off(&self) -> Complex64 {
        let size: f64 = self.residues.iter().map(Complex64::norm_sqr).sum();
        self.residues.iter().zip(&self.moments).map(|(r, m)| r.conj() * m).sum::<Complex64>() / size
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use jointscope_spectra::FrfPair;

    #[test]
    fn a_mode_is_the_same_to_nine_digits_from_wherever_it_is_looked_for() {
        // A heavy strip between blocks on soft springs: what features of a fit are compared by must not jump
        // as a guess moves.
        let fixture = Fixture::from_json(
            r#"{ "bodies": { "A": { "mass": 0.75, "inertia": 3.2e-4, "x_cg": -0.03 }, "B": { "mass": 0.75, "inertia": 3.2e-4, "x_cg": 0.07 } },
                 "points": { "1": { "body": "A", "x": -0.055 }, "2": { "body": "A", "x": 0 }, "3": { "body": "B", "x": 0.04 }, "4": { "body": "B", "x": 0.095 } },
                 "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2.1e11, "second_moment": 7.3e-10 } } },
                 "supports": { "SA": { "body": "A", "x": -0.03, "stiffness": 240, "damping": 0.6 }, "SB": { "body": "B", "x": 0.07, "stiffness": 280, "damping": 0.6 } },
                 "damping": { "modal_ratios": [0.004, 0.006] },
                 "physics": [{ "kind": "joint_mass", "place": "J", "mass": 0.077 }] }"#,
        )
        .unwrap();
        let pairs = [("4", "1"), ("3", "1"), ("4", "3")].map(|(o, i)| FrfPair::transverse(o, i));
        let test = ModelledTest::new(&fixture, &pairs, 2000.0, Instrument::AsRecorded).unwrap();
        let mut frfs = test.continued();
        let found = peaking(&test, &grid(300.0, 2000.0, 0).unwrap(), pairs.len());
        assert!(!found.is_empty());
        for pole in found {
            let first = mode(&mut frfs, pole, pairs.len()).unwrap();
            for k in 1..40 {
                let guess = pole * (1.0 + 1.3e-5 * f64::from(k));
                // Of a few steps a contour about the guess holds the pole, of others it does not.
                let found = if k % 2 == 0 { mode } else { mode_beside };
                let other = found(&mut frfs, guess, pairs.len()).unwrap();
                assert!((other.pole.omega / first.pole.omega - 1.0).abs() < 1e-13, "guess {k}");
                assert!(
                    (other.pole.damping_ratio / first.pole.damping_ratio - 1.0).abs() < 1e-10,
                    "guess {k}"
                );
                for (a, b) in other.residues.iter().zip(&first.residues) {
                    assert!((a / b - 1.0).norm() < 1e-9, "guess {k}: {a} against {b}");
                }
            }
        }
    }
}
