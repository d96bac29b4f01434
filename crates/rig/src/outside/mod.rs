//! Physics that no effect of a fixture file describes: what a diagnosis must not give a wrong name to.

mod drawn;
mod reading;
mod structure;

use crate::physical::FIRST_TO_SECOND;
use jointscope_fixture::{Effect, EffectKind, Place};
use serde::{Deserialize, Serialize};

/// A piece of physics outside the vocabulary of fixture files, with its place and size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Outside {
    /// A force proportional to the relative acceleration across a joint: the inertance (kg) of a flywheel on
    /// a rack.
    Inerter {
        /// The joint.
        joint: String,
        /// Inertance, kg.
        inertance: f64,
    },
    /// A joint that changed between two positions of the hammer: FRFs of one reference are those of a joint
    /// whose stiffness is another.
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
    /// A rotor within a body: a force on its transverse motion proportional to its rotation rate, and the
    /// opposite moment.
    Gyroscope {
        /// The point about which it couples.
        point: String,
        /// The coupling, N·s/rad.
        coupling: f64,
    },
    /// A force across a joint proportional to (iω)^order of the relative translation, between a spring and a
    /// dashpot.
    Springpot {
        /// The joint.
        joint: String,
        /// Magnitude of its dynamic stiffness at 100 Hz, N/m.
        stiffness: f64,
        /// Order of the derivative, between 0 and 1.
        order: f64,
    },
    /// A sensor that also reads motion across the plane, of a structure that a tilted hammer drives that way
    /// too. Across the plane the joints have another stiffness, hence other resonances.
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

impl Outside {
    /// What an analyst knows of it and states, as effects: of a second bending mode the first, of all else
    /// nothing.
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
