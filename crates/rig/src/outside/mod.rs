//! Physics that no effect of a fixture file describes: what a diagnosis must not give a wrong name to.

mod reading;
mod structure;

use crate::physical::FIRST_TO_SECOND;
use crate::random::{choice, log_uniform, sign, uniform};
use jointscope_fixture::{Body, BodyKind, Effect, EffectKind, Fixture, Joint, JointLaw, Place};
use jointscope_spectra::FrfPair;
use rand::Rng;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A piece of physics outside the vocabulary of fixture files, with its place and size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Outside {
    /// A force proportional to the relative acceleration across a joint: the inertance (kg) of a flywheel on a rack.
    Inerter {
        /// The joint.
        joint: String,
        /// Inertance, kg.
        inertance: f64,
    },
    /// A joint that changed between two positions of the hammer: FRFs of one reference are those of a joint whose
    /// stiffness is another.
    Drift {
        /// The joint.
        joint: String,
        /// The reference that was struck after the change.
        reference: String,
        /// The stiffness then, relative to the stiffness before.
        factor: f64,
    },
    /// A second load path: a spring (N/m) that reaches from one body past the joint to another.
    Bypass {
        /// The point whose body carries the spring's arm.
        from: String,
        /// The point it presses on.
        to: String,
        /// Its stiffness, N/m.
        stiffness: f64,
    },
    /// A rotor within a body: a force on its transverse motion proportional to its rotation rate, and the opposite moment.
    Gyroscope {
        /// The point about which it couples.
        point: String,
        /// The coupling, N·s/rad.
        coupling: f64,
    },
    /// A force across a joint proportional to (iω)^order of the relative translation, between a spring and a dashpot.
    Springpot {
        /// The joint.
        joint: String,
        /// Magnitude of its dynamic stiffness at 100 Hz, N/m.
        stiffness: f64,
        /// Order of the derivative, between 0 and 1.
        order: f64,
    },
    /// A sensor that also reads motion across the plane, of a structure that a tilted hammer drives that way too. Across the plane the joints
    /// have another stiffness, hence other resonances.
    CrossAxis {
        /// The point whose response's sensor it is.
        response: String,
        /// Transverse sensitivity of the sensor times the share of the blow across the plane.
        coupling: f64,
        /// Stiffness of the joints across the plane over that within.
        ratio: f64,
    },
    /// The second free-free bending mode of a block whose first is known.
    SecondBending {
        /// The block.
        body: String,
        /// Its frequency, Hz; the first lies at 0.363 times this.
        frequency: f64,
        /// Damping ratio of both.
        damping_ratio: f64,
    },
    /// A taut cable from a body to ground, which resonates like a string.
    Cable {
        /// The body.
        body: String,
        /// Where it is tied, m.
        x: f64,
        /// Its mass, kg.
        mass: f64,
        /// Its first resonance with both ends held, Hz; the others are multiples of it.
        frequency: f64,
        /// Damping ratio of each.
        damping_ratio: f64,
    },
    /// A response recorded by a device whose sample clock runs at another rate: its frequency axis is scaled.
    ClockError {
        /// The point whose response it is.
        response: String,
        /// Relative error of the rate; the true one is higher where positive.
        rate: f64,
    },
    /// Supports that do not stand on firm ground but on a table on springs.
    BaseMotion {
        /// The table's mass, kg.
        mass: f64,
        /// Its natural frequency with nothing on it, Hz.
        frequency: f64,
        /// Its damping ratio.
        damping_ratio: f64,
    },
}

/// The kinds that [`Outside::draw`] counts, in their order: what a seed stands for must not change when a kind is added.
const COUNTED: [&str; 5] = ["inerter", "drift", "bypass", "gyroscope", "springpot"];

impl Outside {
    /// Number of kinds that [`Outside::draw`] counts.
    pub const KINDS: usize = COUNTED.len();
    /// Kinds that no effect of a fixture file is: those of [`Outside::draw`] but a bypass and a springpot, which files have names for, and more.
    pub const UNLISTED: [&str; 8] = [
        "cross_axis",
        "inerter",
        "clock_error",
        "second_bending",
        "cable",
        "drift",
        "base_motion",
        "gyroscope",
    ];

    /// A random one of kind `kind` (counted modulo [`Outside::KINDS`]); `None` where the fixture has no place for it or `recorded` has
    /// one reference only. Whether it shows is for the caller to judge: sizes run over two decades.
    pub fn draw(rng: &mut impl Rng, fixture: &Fixture, kind: usize, recorded: &[FrfPair]) -> Option<Self> {
        Self::draw_kind(rng, fixture, COUNTED[kind % COUNTED.len()], recorded)
    }

    /// A random one of the kind of this name; `None` as of [`Outside::draw`], and of a kind that there is not.
    pub fn draw_kind(
        rng: &mut impl Rng,
        fixture: &Fixture,
        kind: &str,
        recorded: &[FrfPair],
    ) -> Option<Self> {
        let joint = choice(rng, fixture.joints())?;
        let stiffness = transverse_stiffness(fixture, joint);
        let name = joint.name.clone();
        Some(match kind {
            "inerter" => {
                let masses = fixture.bodies().iter().map(|body| mass(&body.kind));
                let lightest = masses.fold(f64::INFINITY, f64::min);
                Outside::Inerter { joint: name, inertance: lightest * log_uniform(rng, 0.003, 0.3) }
            }
            "drift" => {
                let last = &recorded.last()?.reference;
                if recorded.iter().all(|pair| pair.reference == *last) {
                    return None;
                }
                let factor = (sign(rng) * log_uniform(rng, 0.005, 0.2)).exp();
                Outside::Drift { joint: name, reference: last.point.clone(), factor }
            }
            "bypass" => {
                let points = fixture.points();
                Outside::Bypass {
                    from: points.first()?.name.clone(),
                    to: points.last()?.name.clone(),
                    stiffness: stiffness * log_uniform(rng, 0.0003, 0.1),
                }
            }
            "gyroscope" => {
                let turning: Vec<_> =
                    fixture.points().iter().filter(|p| fixture.bodies()[p.body].kind.rotates()).collect();
                let point = choice(rng, &turning)?;
                let arm = 0.03 * mass(&fixture.bodies()[point.body].kind);
                let coupling = sign(rng) * arm * TAU * log_uniform(rng, 3.0, 100.0);
                Outside::Gyroscope { point: point.name.clone(), coupling }
            }
            "springpot" => Outside::Springpot {
                joint: name,
                stiffness: stiffness * log_uniform(rng, 0.003, 0.3),
                order: uniform(rng, 0.25, 0.75),
            },
            "cross_axis" => Outside::CrossAxis {
                response: choice(rng, recorded)?.response.point.clone(),
                coupling: sign(rng) * log_uniform(rng, 3e-4, 0.1),
                ratio: (sign(rng) * log_uniform(rng, 0.3, 3.0)).exp(),
            },
            "second_bending" => {
                let blocks: Vec<&Body> = fixture
                    .bodies()
                    .iter()
                    .filter(|body| matches!(body.kind, BodyKind::Rigid(_)) && body.kind.rotates())
                    .collect();
                Outside::SecondBending {
                    body: choice(rng, &blocks)?.name.clone(),
                    frequency: log_uniform(rng, 700.0, 15e3),
                    damping_ratio: log_uniform(rng, 0.002, 0.01),
                }
            }
            "cable" => {
                let on = choice(rng, fixture.points())?;
                let body = &fixture.bodies()[on.body];
                Outside::Cable {
                    body: body.name.clone(),
                    x: on.x.value,
                    mass: mass(&body.kind) * log_uniform(rng, 3e-4, 0.03),
                    frequency: log_uniform(rng, 15.0, 250.0),
                    damping_ratio: log_uniform(rng, 0.01, 0.05),
                }
            }
            "clock_error" => Outside::ClockError {
                response: choice(rng, recorded)?.response.point.clone(),
                rate: sign(rng) * log_uniform(rng, 1e-6, 3e-3),
            },
            "base_motion" => {
                fixture.supports().first()?;
                let whole: f64 = fixture.bodies().iter().map(|body| mass(&body.kind)).sum();
                Outside::BaseMotion {
                    mass: whole * log_uniform(rng, 1.0, 100.0),
                    frequency: log_uniform(rng, 3.0, 50.0),
                    damping_ratio: log_uniform(rng, 0.01, 0.1),
                }
            }
            _ => return None,
        })
    }

    /// What an analyst knows of it and states, as effects: of a second bending mode the first, of all else nothing.
    pub fn known(&self) -> Vec<Effect> {
        match self {
            Outside::SecondBending { body, frequency, damping_ratio } => {
                let values = [FIRST_TO_SECOND * frequency, *damping_ratio];
                vec![Effect::new(EffectKind::BodyFlexibility, Place::Body(body.clone()), None, &values)]
            }
            _ => Vec::new(),
        }
    }

    /// Its kind in a word.
    pub fn kind(&self) -> &'static str {
        match self {
            Outside::Inerter { .. } => "inerter",
            Outside::Drift { .. } => "drift",
            Outside::Bypass { .. } => "bypass",
            Outside::Gyroscope { .. } => "gyroscope",
            Outside::Springpot { .. } => "springpot",
            Outside::CrossAxis { .. } => "cross_axis",
            Outside::SecondBending { .. } => "second_bending",
            Outside::Cable { .. } => "cable",
            Outside::ClockError { .. } => "clock_error",
            Outside::BaseMotion { .. } => "base_motion",
        }
    }
}

impl std::fmt::Display for Outside {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Outside::Inerter { joint, inertance } => {
                write!(f, "inerter of {inertance:.3e} kg across {joint}")
            }
            Outside::Drift { joint, reference, factor } => {
                write!(f, "{joint} stiffer by a factor {factor:.4} when reference {reference} was struck")
            }
            Outside::Bypass { from, to, stiffness } => {
                write!(f, "spring of {stiffness:.3e} N/m from the body of {from} past the joint to {to}")
            }
            Outside::Gyroscope { point, coupling } => {
                write!(f, "gyroscopic coupling of {coupling:.3e} N*s/rad at {point}")
            }
            Outside::Springpot { joint, stiffness, order } => {
                write!(f, "springpot of order {order:.2} across {joint}, {stiffness:.3e} N/m at 100 Hz")
            }
            Outside::CrossAxis { response, coupling, ratio } => write!(
                f,
                "sensor of response {response} reads {coupling:.2e} of the motion across, where the joints are {ratio:.2} times as stiff"
            ),
            Outside::SecondBending { body, frequency, .. } => {
                write!(f, "second bending mode of {body} at {frequency:.0} Hz")
            }
            Outside::Cable { body, x, mass, frequency, .. } => {
                write!(
                    f,
                    "cable of {mass:.2e} kg on {body} at {x:.4} m, resonating at multiples of {frequency:.1} Hz"
                )
            }
            Outside::ClockError { response, rate } => {
                write!(f, "sample clock of response {response} off by {rate:.2e}")
            }
            Outside::BaseMotion { mass, frequency, .. } => {
                write!(f, "supports on a table of {mass:.2e} kg that bounces at {frequency:.1} Hz")
            }
        }
    }
}

fn mass(body: &BodyKind) -> f64 {
    match body {
        BodyKind::Rigid(rigid) => rigid.mass.value,
        BodyKind::Beam(beam) => beam.mass_per_length.value * (beam.to.value - beam.from.value),
    }
}

/// Transverse stiffness of a joint at its far end, its rotation held, N/m.
fn transverse_stiffness(fixture: &Fixture, joint: &Joint) -> f64 {
    match &joint.law {
        JointLaw::Stiffness { stiffness, .. } => stiffness[0].value,
        JointLaw::Beam { youngs_modulus, second_moment } => {
            12.0 * youngs_modulus.value * second_moment.value / fixture.joint_length(joint).powi(3)
        }
    }
}
