//! Hammer hits over time on a structure whose joints depend on amplitude.

use crate::effects::linear_part;
use crate::random::{log_uniform, normal, uniform};
use crate::{Assembly, Row, Station, Structure, StructureError};
use jointscope_fixture::{Dof, Effect, EffectKind, Fixture, Place};
use jointscope_hits::{Hit, MeasuredMotion, Response};
use jointscope_linalg::{Cholesky, dot};
use jointscope_spectra::Channel;
use rand::Rng;
use serde::{Deserialize, Serialize};
use std::f64::consts::LN_2;

/// How a structure is struck and recorded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StrikeTest {
    /// Samples a second.
    pub rate: f64,
    /// Samples of a record.
    pub samples: usize,
    /// Steps of the integration within a sample.
    pub steps: usize,
    /// Length of the blow at half of its peak, s. It rises and falls as a Gaussian: records are samples
    /// without a filter, and whatever of a blow lies above half of the sampling rate would be folded into
    /// force and responses differently. Of a Gaussian of 0.5 ms a tenth is left at 1.6 kHz, where the band in
    /// use ends, and 1e-9 at the 4.8 kHz that 6.4 kHz fold onto it; a sin² of that length has 2e-3 there,
    /// more than a hundredth of what it has at 1.6 kHz.
    pub pulse: f64,
    /// Peak forces, N; each hit's varies by some per cent.
    pub levels: Vec<f64>,
    /// Hits of each level at each point.
    pub hits: usize,
    /// White noise of each response, relative to its rms.
    pub noise_response: f64,
    /// White noise of the force, relative to its rms.
    pub noise_force: f64,
}

/// Lengths of a blow from where it begins, 1.5e-11 of its peak, to the peak.
const ONSET: f64 = 3.0;

/// An amplitude-dependent force on a motion.
struct Element {
    effect: Effect,
    motion: Vec<f64>,
    /// M⁻¹ times the motion.
    pull: Vec<f64>,
}

/// ü = −M⁻¹(K u + C u̇) + M⁻¹ t F − Σ pull·g.
pub(crate) struct Equations {
    n: usize,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    push: Vec<f64>,
    elements: Vec<Element>,
}

impl StrikeTest {
    /// Strikes the structure of `fixture`, its effects included, at each of `struck` and records
    /// accelerations at `read`.
    ///
    /// # Errors
    /// A fixture that cannot be built, points that it does not have.
    pub fn record(
        &self,
        fixture: &Fixture,
        struck: &[Channel],
        read: &[Channel],
        rng: &mut impl Rng,
    ) -> Result<Vec<Hit>, StructureError> {
        let mut hits = Vec::new();
        for level in &self.levels {
            for channel in struck {
                let (equations, readings) = build(fixture, channel, read)?;
                for _ in 0..self.hits {
                    let peak = level * uniform(rng, 0.9, 1.1);
                    let start = uniform(rng, 0.009, 0.011);
                    let number = hits.len() as u32 + 1;
                    hits.push(self.strike(
                        &equations,
                        &readings,
                        channel,
                        read,
                        (number, peak, start),
                        rng,
                    )?);
                }
            }
        }
        Ok(hits)
    }

    /// A blow of peak 1 that is not felt before `t` = 0.
    fn blow(&self, t: f64) -> f64 {
        (-4.0 * LN_2 * (t / self.pulse - ONSET).powi(2)).exp()
    }

    fn strike(
        &self,
        equations: &Equations,
        readings: &[Vec<f64>],
        struck: &Channel,
        read: &[Channel],
        (number, peak, start): (u32, f64, f64),
        rng: &mut impl Rng,
    ) -> Result<Hit, StructureError> {
        let force = |t: f64| peak * self.blow(t - start);
        let step = 1.0 / (self.rate * self.steps as f64);
        let mut state = equations.rest();
        let mut work = std::array::from_fn(|_| equations.rest());
        let mut acceleration = vec![0.0; equations.n];
        let mut forces = Vec::with_capacity(self.samples);
        let mut responses = vec![Vec::with_capacity(self.samples); readings.len()];
        for sample in 0..self.samples {
            let now = sample as f64 / self.rate;
            forces.push(force(now));
            equations.acceleration(&state, force(now), &mut acceleration);
            for (history, row) in responses.iter_mut().zip(readings) {
                history.push(dot(row, &acceleration));
            }
            for i in 0..self.steps {
                equations.advance(&mut state, &mut work, now + i as f64 * step, step, &force);
            }
        }
        add_noise(&mut forces, self.noise_force, rng);
        responses.iter_mut().for_each(|values| add_noise(values, self.noise_response, rng));
        let responses = read.iter().zip(responses);
        let responses = responses
            .map(|(c, values)| Response::new(c.clone(), MeasuredMotion::Acceleration, values))
            .collect();
        Hit::new(number, 1.0 / self.rate, 0.0, struck.clone(), forces, responses).map_err(|_| {
            StructureError::Impossible { what: "a motion", value: f64::INFINITY, needed: "a finite one" }
        })
    }
}

/// Largest relative motion of a joint's component when the structure without its amplitude-dependent effects
/// is struck at `struck`, m or rad.
///
/// # Errors
/// As [`StrikeTest::record`].
pub fn reach(
    fixture: &Fixture,
    (joint, dof): (&str, Dof),
    struck: &Channel,
    test: &StrikeTest,
    peak: f64,
) -> Result<f64, StructureError> {
    let (fixture, _) = linear_part(fixture)?;
    let (equations, _) = build(&fixture, struck, &[])?;
    let structure = Structure::of(&fixture)?;
    let motion = dense(&across(&structure, &fixture, joint, dof)?, equations.n);
    let force = |t: f64| peak * test.blow(t);
    let step = 1.0 / (test.rate * test.steps as f64);
    let mut state = equations.rest();
    let mut work = std::array::from_fn(|_| equations.rest());
    let mut most: f64 = 0.0;
    for i in 0..test.samples * test.steps / 4 {
        equations.advance(&mut state, &mut work, i as f64 * step, step, &force);
        most = most.max(dot(&motion, &state[..equations.n]).abs());
    }
    Ok(most)
}

/// A random amplitude-dependent effect on a joint's component that is driven to `reach` and has stiffness
/// `stiffness` there: strong enough to matter at that motion, exercised by it.
pub fn random_law(
    rng: &mut impl Rng,
    kind: EffectKind,
    joint: &str,
    dof: Dof,
    stiffness: f64,
    reach: f64,
) -> Effect {
    let place = Place::Joint(joint.to_owned());
    let values = match kind {
        EffectKind::CubicStiffness => vec![log_uniform(rng, 0.05, 1.0) * stiffness / (reach * reach)],
        EffectKind::Friction => {
            let spring = log_uniform(rng, 0.05, 0.6) * stiffness;
            vec![spring * reach * log_uniform(rng, 0.05, 0.4), spring]
        }
        _ => vec![reach * uniform(rng, 0.1, 0.5), log_uniform(rng, 0.1, 1.0) * stiffness],
    };
    Effect::new(kind, place, Some(dof), &values)
}

pub(crate) fn build(
    fixture: &Fixture,
    struck: &Channel,
    read: &[Channel],
) -> Result<(Equations, Vec<Vec<f64>>), StructureError> {
    let (plain, bent) = linear_part(fixture)?;
    let structure = Structure::of(&plain)?;
    let assembly: &Assembly = structure.assembly();
    let n = assembly.order();
    let mass = Cholesky::of(n, &assembly.mass_matrix()).ok_or(StructureError::Impossible {
        what: "a mass matrix",
        value: 0.0,
        needed: "mass on every coordinate",
    })?;
    let mass = mass.inverse();
    let pulled = |row: &[f64]| -> Vec<f64> { mass.chunks_exact(n).map(|line| dot(line, row)).collect() };
    let times = |matrix: &[f64]| -> Vec<f64> {
        (0..n * n).map(|e| (0..n).map(|k| mass[(e / n) * n + k] * matrix[k * n + e % n]).sum()).collect()
    };
    let mut elements = Vec::new();
    for effect in bent {
        let Place::Joint(joint) = &effect.place else { continue };
        let motion = dense(&across(&structure, &plain, joint, effect.dof.unwrap_or(Dof::Translation))?, n);
        elements.push(Element { pull: pulled(&motion), motion, effect });
    }
    let equations = Equations {
        n,
        stiffness: times(&assembly.stiffness_matrix()),
        damping: times(&assembly.damping_matrix()),
        push: pulled(&dense(structure.motion(struck)?, n)),
        elements,
    };
    let readings =
        read.iter().map(|c| Ok(dense(structure.motion(c)?, n))).collect::<Result<_, StructureError>>()?;
    Ok((equations, readings))
}

pub(crate) fn across(
    structure: &Structure,
    fixture: &Fixture,
    joint: &str,
    dof: Dof,
) -> Result<Row, StructureError> {
    let joint = fixture.joint(joint).ok_or_else(|| StructureError::UnknownPoint(format!("joint {joint}")))?;
    let station = |point: usize| -> Result<Station, StructureError> {
        let name = &fixture.points()[point].name;
        let y = structure.motion(&Channel::transverse(name.clone()))?.clone();
        Ok(Station { y, theta: structure.motion(&Channel::rotational(name.clone()))?.clone() })
    };
    let [y, theta] = station(joint.to)?.relative_to(&station(joint.from)?, fixture.joint_length(joint));
    Ok(if dof == Dof::Rotation { theta } else { y })
}

/// Motion, velocity and what each friction element bears, one after the other.
pub(crate) type State = Vec<f64>;

impl Equations {
    pub(crate) fn rest(&self) -> State {
        vec![0.0; 2 * self.n + self.elements.len()]
    }

    pub(crate) fn acceleration(&self, state: &[f64], force: f64, into: &mut [f64]) {
        let n = self.n;
        let (motion, rest) = state.split_at(n);
        let (velocity, borne) = rest.split_at(n);
        for (i, a) in into.iter_mut().enumerate() {
            *a = self.push[i] * force
                - dot(&self.stiffness[i * n..(i + 1) * n], motion)
                - dot(&self.damping[i * n..(i + 1) * n], velocity);
        }
        for (element, borne) in self.elements.iter().zip(borne) {
            let d = dot(&element.motion, motion);
            let value = |index| element.effect.value(index);
            let g = match element.effect.kind {
                EffectKind::CubicStiffness => value(0) * d * d * d,
                EffectKind::Gap => value(1) * (d - value(0)).max(0.0),
                _ => borne.clamp(-value(0), value(0)),
            };
            into.iter_mut().zip(&element.pull).for_each(|(a, p)| *a -= p * g);
        }
    }

    fn rates(&self, state: &[f64], force: f64, into: &mut [f64]) {
        let n = self.n;
        into[..n].copy_from_slice(&state[n..2 * n]);
        let (accelerations, springs) = into[n..].split_at_mut(n);
        self.acceleration(state, force, accelerations);
        for ((element, borne), rate) in self.elements.iter().zip(&state[2 * n..]).zip(springs) {
            let speed = dot(&element.motion, &state[n..2 * n]);
            let slips = element.effect.kind != EffectKind::Friction
                || (borne.abs() >= element.effect.value(0) && borne * speed > 0.0);
            *rate = if slips { 0.0 } else { element.effect.value(1) * speed };
        }
    }

    /// One step of the classical method of Runge and Kutta.
    pub(crate) fn advance(
        &self,
        state: &mut State,
        work: &mut [State; 5],
        time: f64,
        step: f64,
        force: &impl Fn(f64) -> f64,
    ) {
        let [k1, k2, k3, k4, at] = work;
        let moved = |at: &mut State, from: &State, by: &State, step: f64| {
            at.iter_mut().zip(from.iter().zip(by)).for_each(|(to, (x, k))| *to = x + step * k);
        };
        let (middle, end) = (force(time + 0.5 * step), force(time + step));
        self.rates(state, force(time), k1);
        moved(at, state, k1, 0.5 * step);
        self.rates(at, middle, k2);
        moved(at, state, k2, 0.5 * step);
        self.rates(at, middle, k3);
        moved(at, state, k3, step);
        self.rates(at, end, k4);
        for i in 0..state.len() {
            state[i] += step / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        }
        for (element, borne) in self.elements.iter().zip(&mut state[2 * self.n..]) {
            if element.effect.kind == EffectKind::Friction {
                *borne = borne.clamp(-element.effect.value(0), element.effect.value(0));
            }
        }
    }
}

fn dense(row: &Row, n: usize) -> Vec<f64> {
    let mut all = vec![0.0; n];
    row.terms().iter().for_each(|&(i, value)| all[i] += value);
    all
}

fn add_noise(values: &mut [f64], relative: f64, rng: &mut impl Rng) {
    let rms = (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt();
    values.iter_mut().for_each(|value| *value += relative * rms * normal(rng));
}
