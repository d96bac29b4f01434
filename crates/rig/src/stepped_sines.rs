//! Stepped sines on a structure one of whose joints depends on amplitude: FRFs at levels of held force or
//! held response.

use crate::effects::linear_part;
use crate::random::normal_pair;
use crate::strikes::across;
use crate::{Row, Structure, StructureError};
use jointscope_fixture::{Dof, Effect, EffectKind, Fixture, Place};
use jointscope_linalg::LuWorkspace;
use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;
use rand::Rng;
use std::f64::consts::TAU;

/// What the controller of a stepped-sine test holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control {
    /// Amplitude of the exciting force, N.
    Force,
    /// Amplitude of the acceleration of the driving point (of the first response, without one), m/s².
    Response,
}

/// A stepped-sine test. The steady motion is a Fourier series in the joint's relative motion alone, which
/// bears the only force that is not linear; it is found by Newton's method, the force taken from its course
/// over a settled period.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteppedSines {
    /// What is held.
    pub control: Control,
    /// Harmonics of the relative motion besides its mean.
    pub harmonics: usize,
    /// Noise of real and of imaginary part of every FRF value, relative to the FRF's largest of its level.
    pub noise: f64,
}

/// Instants of a period at which the joint's force is taken.
const INSTANTS: usize = 512;
/// Newton steps on a line, at the most.
const STEPS: usize = 60;
/// Change of the motion, relative to its amplitude, at which a line has settled.
const SETTLED: f64 = 1e-10;
/// Frequency at which statics are read, as a share of the line's: a free structure has none at 0 Hz.
const STATIC: f64 = 1e-3;

impl SteppedSines {
    /// The FRFs of `pairs`, which share a reference, at each of the `levels` (N or m/s²): first harmonic of
    /// the acceleration over the force. Lines are stepped upwards, each from the motion of the last.
    ///
    /// # Errors
    /// A fixture that cannot be built, more than one effect that depends on amplitude, or a line on which no
    /// steady motion is found.
    pub fn record(
        &self,
        fixture: &Fixture,
        pairs: &[FrfPair],
        levels: &[f64],
        lines: &SpectralLines,
        rng: &mut impl Rng,
    ) -> Result<Vec<FrfSet>, StructureError> {
        let shaken = Shaken::of(fixture, pairs, self.harmonics)?;
        let compliances: Vec<Compliances> =
            lines.omegas().map(|omega| shaken.compliances(omega)).collect::<Result<_, _>>()?;
        let watched = pairs.iter().position(|pair| pair.response == pair.reference).unwrap_or(0);
        let level = |&held: &f64| {
            let mut motion = vec![0.0; 2 * self.harmonics + 1];
            let mut values = vec![Complex64::ZERO; pairs.len() * lines.len()];
            for (line, (omega, at)) in lines.omegas().zip(&compliances).enumerate() {
                let held = match self.control {
                    Control::Force => Drive::Force(held),
                    Control::Response => Drive::Response { watched, displacement: -held / (omega * omega) },
                };
                let (force, borne) = shaken
                    .settled(at, held, &mut motion)
                    .ok_or(StructureError::Unsettled { frequency: lines.hz()[line] })?;
                for (frf, (from_force, from_joint)) in at.responses.iter().enumerate() {
                    let response = from_force * force - from_joint * borne;
                    values[frf * lines.len() + line] = -omega * omega * response / force;
                }
            }
            for frf in values.chunks_exact_mut(lines.len()) {
                let most = frf.iter().fold(0.0, |most: f64, v| v.norm().max(most));
                for value in frf {
                    let (re, im) = normal_pair(rng);
                    *value += self.noise * most * Complex64::new(re, im);
                }
            }
            Ok(FrfSet::new(lines.clone(), FrfForm::Accelerance, pairs.to_vec(), values)?)
        };
        levels.iter().map(level).collect()
    }
}

/// What is prescribed on a line: a force, or the displacement of a response.
enum Drive {
    Force(f64),
    Response { watched: usize, displacement: f64 },
}

/// The linear structure and what acts across its joint.
struct Shaken {
    structure: Structure,
    effect: Option<Effect>,
    motion: Row,
    force: Row,
    responses: Vec<Row>,
    harmonics: usize,
}

/// Receptances on one line of excitation.
struct Compliances {
    /// Of d by a force across the joint, at 0, ω, 2ω, …
    own: Vec<Complex64>,
    /// Of d by the exciting force, at ω.
    across: Complex64,
    /// Of every response by the exciting force and by a force across the joint, at ω.
    responses: Vec<(Complex64, Complex64)>,
}

impl Shaken {
    fn of(fixture: &Fixture, pairs: &[FrfPair], harmonics: usize) -> Result<Self, StructureError> {
        let (plain, bent) = linear_part(fixture)?;
        if let [_, second, ..] = bent.as_slice() {
            return Err(StructureError::Nonlinear {
                kind: second.kind.name(),
                place: second.place.to_string(),
            });
        }
        let structure = Structure::of(&plain)?;
        let effect = bent.into_iter().next();
        let motion = match effect.as_ref().map(|e| (&e.place, e.dof)) {
            Some((Place::Joint(joint), dof)) => {
                across(&structure, &plain, joint, dof.unwrap_or(Dof::Translation))?
            }
            _ => Row::coordinate(0),
        };
        let reference = pairs.first().map(|pair| &pair.reference);
        let force = reference.map_or_else(|| Ok(Row::coordinate(0)), |c| structure.motion(c).cloned())?;
        let responses =
            pairs.iter().map(|p| structure.motion(&p.response).cloned()).collect::<Result<_, _>>()?;
        Ok(Shaken { structure, effect, motion, force, responses, harmonics })
    }

    fn compliances(&self, omega: f64) -> Result<Compliances, StructureError> {
        let assembly = self.structure.assembly();
        let order = assembly.order();
        let mut lu = LuWorkspace::new();
        let mut at = |omega: f64| -> Result<[Vec<Complex64>; 2], StructureError> {
            lu.factorize(order, |into| assembly.dynamic_stiffness(Complex64::new(0.0, omega), into))
                .map_err(|_| StructureError::Singular { frequency: omega / TAU })?;
            Ok([&self.motion, &self.force].map(|row| {
                let mut motions = vec![Complex64::ZERO; order];
                row.terms().iter().for_each(|&(i, value)| motions[i] += value);
                lu.solve_in_place(&mut motions);
                motions
            }))
        };
        let [by_joint, by_force] = at(omega)?;
        let responses = self.responses.iter().map(|row| (read(row, &by_force), read(row, &by_joint)));
        let across = read(&self.motion, &by_force);
        let mut own = vec![Complex64::from(read(&self.motion, &at(STATIC * omega)?[0]).re)];
        own.push(read(&self.motion, &by_joint));
        for harmonic in 2..=self.harmonics {
            own.push(read(&self.motion, &at(harmonic as f64 * omega)?[0]));
        }
        Ok(Compliances { own, across, responses: responses.collect() })
    }

    /// The exciting force's first harmonic and that of the joint's, once d has settled; d's harmonics are
    /// written over `motion`.
    fn settled(
        &self,
        at: &Compliances,
        drive: Drive,
        motion: &mut Vec<f64>,
    ) -> Option<(Complex64, Complex64)> {
        let driven = |borne: Complex64| match drive {
            Drive::Force(force) => Complex64::from(force),
            Drive::Response { watched, displacement } => {
                let (from_force, from_joint) = at.responses[watched];
                (displacement + from_joint * borne) / from_force
            }
        };
        // d as the force and the joint's own force on a given d make it, less that d.
        let open = |d: &[f64]| -> Vec<f64> {
            let borne = self.borne(d);
            let mut open = vec![at.own[0].re * -borne[0].re - d[0]];
            for harmonic in 1..=self.harmonics {
                let driven = if harmonic == 1 { at.across * driven(borne[1]) } else { Complex64::ZERO };
                let made = driven - at.own[harmonic] * borne[harmonic];
                open.extend([made.re - d[2 * harmonic - 1], made.im - d[2 * harmonic]]);
            }
            open
        };
        let size = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        if self.effect.is_none() || size(motion) == 0.0 {
            let start = at.across * driven(Complex64::ZERO);
            (motion[1], motion[2]) = (start.re, start.im);
        }
        let mut left = open(motion);
        for _ in 0..STEPS {
            let amplitude = size(motion);
            if size(&left) <= SETTLED * amplitude {
                break;
            }
            let mut lu = LuWorkspace::new();
            let slope = slope(&open, motion, &left, 1e-6 * amplitude);
            lu.factorize(motion.len(), |into| into.copy_from_slice(&slope)).ok()?;
            let mut step: Vec<Complex64> = left.iter().map(|v| Complex64::from(-v)).collect();
            lu.solve_in_place(&mut step);
            let mut share = 1.0;
            let (to, after) = loop {
                let to: Vec<f64> = motion.iter().zip(&step).map(|(d, s)| d + share * s.re).collect();
                let after = open(&to);
                if size(&after) < size(&left) || share < 1e-3 {
                    break (to, after);
                }
                share *= 0.5;
            };
            (*motion, left) = (to, after);
        }
        let borne = self.borne(motion)[1];
        // A kink between two instants leaves a step's last digits open.
        (size(&left) <= 1e-6 * size(motion)).then(|| (driven(borne), borne))
    }

    /// Mean and harmonics of the joint's force under the motion of these harmonics, over a settled period.
    fn borne(&self, d: &[f64]) -> Vec<Complex64> {
        let mut harmonics = vec![Complex64::ZERO; self.harmonics + 1];
        let Some(effect) = &self.effect else { return harmonics };
        let turn = Complex64::from_polar(1.0, TAU / INSTANTS as f64);
        let instant = |i: usize| turn.powu(i as u32);
        let motion = |e: Complex64| {
            let mut power = Complex64::ONE;
            (1..=self.harmonics).fold(d[0], |sum, h| {
                power *= e;
                sum + (Complex64::new(d[2 * h - 1], d[2 * h]) * power).re
            })
        };
        let points: Vec<Complex64> = (0..INSTANTS).map(instant).collect();
        let course: Vec<f64> = points.iter().map(|e| motion(*e)).collect();
        let (first, second) = (effect.value(0), effect.value(1.min(effect.parameters.len() - 1)));
        let mut before = course[0];
        let mut stuck = second * (course[0] - d[0]);
        let mut force = |now: f64| match effect.kind {
            EffectKind::CubicStiffness => first * now.powi(3),
            EffectKind::Gap => second * (now - first).max(0.0),
            _ => {
                stuck = (stuck + second * (now - before)).clamp(-first, first);
                before = now;
                stuck
            }
        };
        course.iter().for_each(|now| {
            force(*now);
        });
        for (now, e) in course.iter().zip(&points) {
            let value = force(*now) / INSTANTS as f64;
            let mut power = Complex64::ONE;
            for (h, sum) in harmonics.iter_mut().enumerate() {
                *sum += if h == 0 { value.into() } else { 2.0 * value * power.conj() };
                power *= e;
            }
        }
        harmonics
    }
}

fn read(row: &Row, motions: &[Complex64]) -> Complex64 {
    row.terms().iter().map(|&(i, value)| motions[i] * value).sum()
}

/// Derivatives of a function that is `before` at a point, by differences with this step, row-major.
fn slope(of: &dyn Fn(&[f64]) -> Vec<f64>, at: &[f64], before: &[f64], step: f64) -> Vec<Complex64> {
    let n = at.len();
    let mut matrix = vec![Complex64::ZERO; n * n];
    for column in 0..n {
        let mut moved = at.to_vec();
        moved[column] += step;
        for (row, (after, before)) in of(&moved).iter().zip(before).enumerate() {
            matrix[row * n + column] = ((after - before) / step).into();
        }
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strikes::build;
    use jointscope_samples::{two_blocks_damped, with};
    use jointscope_spectra::Channel;

    fn bent(kind: &str, parameters: &str) -> Fixture {
        let effect = format!(r#"{{ "kind": "{kind}", "place": "J", "dof": "rotation", {parameters} }}"#);
        let file = with(&two_blocks_damped(&[0.02]), &format!(r#""physics": [{effect}]"#));
        Fixture::from_json(&file).unwrap()
    }

    /// First harmonic of the acceleration at 4 over a force of `force` N at 4, by integrating the equations
    /// of motion until they are steady.
    fn integrated(fixture: &Fixture, force: f64, hz: f64) -> Complex64 {
        let channel = Channel::transverse("4");
        let (equations, readings) = build(fixture, &channel, std::slice::from_ref(&channel)).unwrap();
        let (steps, periods) = (1500, 120);
        let step = 1.0 / hz / steps as f64;
        let mut state = equations.rest();
        let mut work = std::array::from_fn(|_| equations.rest());
        // A force from rest leaves a free structure drifting: it begins at its extreme, whose impulse is none
        // over a period.
        let push = |t: f64| force * (TAU * hz * t).cos();
        let mut sum = Complex64::ZERO;
        let mut acceleration = vec![0.0; readings[0].len()];
        for i in 0..periods * steps {
            if i >= (periods - 1) * steps {
                equations.acceleration(&state, push(i as f64 * step), &mut acceleration);
                let value: f64 = readings[0].iter().zip(&acceleration).map(|(r, a)| r * a).sum();
                let phase = TAU * (i % steps) as f64 / steps as f64;
                sum += value * Complex64::from_polar(2.0 / steps as f64, -phase);
            }
            equations.advance(&mut state, &mut work, i as f64 * step, step, &push);
        }
        sum / force
    }

    #[test]
    fn steady_sines_are_those_of_the_equations_of_motion_integrated_until_steady() {
        let laws = [
            ("cubic_stiffness", r#""stiffness3": 6e8"#),
            ("friction", r#""slip_force": 0.1, "stiffness": 500"#),
            ("gap", r#""clearance": 1e-4, "stiffness": 300"#),
        ];
        let pairs = [FrfPair::transverse("4", "4")];
        for (kind, parameters) in laws {
            let fixture = bent(kind, parameters);
            let hz = vec![242.0, 250.0, 258.0];
            let lines = SpectralLines::new(hz.clone()).unwrap();
            let test = SteppedSines { control: Control::Force, harmonics: 9, noise: 0.0 };
            let found = test.record(&fixture, &pairs, &[10.0], &lines, &mut crate::generator(1)).unwrap();
            let plain = bent(kind, parameters).with_physics(Vec::new()).unwrap();
            let linear = test.record(&plain, &pairs, &[10.0], &lines, &mut crate::generator(1)).unwrap();
            for (line, hz) in hz.iter().enumerate() {
                let expected = integrated(&fixture, 10.0, *hz);
                let (found, linear) = (found[0].values(0)[line], linear[0].values(0)[line]);
                println!("{kind} {hz} Hz: {found} {expected}, linear {linear}");
                assert!((found - expected).norm() < 1e-3 * expected.norm(), "{kind} at {hz} Hz");
                assert!((found - linear).norm() > 0.02 * linear.norm(), "{kind} at {hz} Hz is not exercised");
            }
        }
    }

    #[test]
    fn a_held_response_is_the_response_to_the_force_that_holds_it() {
        let fixture = bent("friction", r#""slip_force": 0.1, "stiffness": 500"#);
        let lines = SpectralLines::new(vec![250.0]).unwrap();
        let pairs = [FrfPair::transverse("1", "4"), FrfPair::transverse("4", "4")];
        let record = |control, level: f64| {
            let test = SteppedSines { control, harmonics: 9, noise: 0.0 };
            test.record(&fixture, &pairs, &[level], &lines, &mut crate::generator(1)).unwrap()
        };
        let by_force = &record(Control::Force, 10.0)[0];
        let by_response = &record(Control::Response, 10.0 * by_force.values(1)[0].norm())[0];
        for frf in 0..2 {
            let (a, b) = (by_force.values(frf)[0], by_response.values(frf)[0]);
            assert!((a - b).norm() < 1e-5 * a.norm(), "{a} {b}");
        }
    }
}
