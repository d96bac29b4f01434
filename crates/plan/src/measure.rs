//! What may be measured next.

use jointscope_fixture::{Effect, EffectKind, Fixture, Place, Quantity};
use jointscope_spectra::FrfPair;
use serde::Serialize;
use std::fmt;

/// A measurement that has not been made.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Measure {
    /// One more FRF of the structure as it is.
    Frf {
        /// The FRF.
        frf: FrfPair,
    },
    /// Several more FRFs of the structure as it is.
    Frfs {
        /// The FRFs.
        frfs: Vec<FrfPair>,
    },
    /// The hammer at one more point, with all sensors where they are.
    HammerAt {
        /// Where the hammer strikes.
        point: String,
        /// What that records.
        frfs: Vec<FrfPair>,
    },
    /// A sensor at one more point, with all hammer points as they are.
    SensorAt {
        /// Where the sensor sits.
        point: String,
        /// What that records.
        frfs: Vec<FrfPair>,
    },
    /// The same FRFs again, with so many times the averages in all.
    Averages {
        /// Averages in all, as a multiple of those at present.
        times: u32,
    },
    /// The same FRFs of the structure with a known mass fixed to it.
    AddedMass {
        /// The mass, kg.
        mass: f64,
        /// Its standard deviation, kg.
        mass_std: f64,
        /// The body that carries it.
        body: String,
        /// Where on the body, m.
        x: f64,
        /// Standard deviation of that, m.
        x_std: f64,
    },
    /// The same FRFs of the structure off its supports, hung freely.
    HungFreely,
    /// One quantity of the fixture by itself, on scales or with a calliper.
    Quantity {
        /// Its path in the fixture file.
        path: String,
        /// Standard deviation of what is measured, in `unit`.
        std: f64,
        /// Its unit.
        unit: &'static str,
    },
}

impl Measure {
    /// The structure that is measured, where that is not the one which `fixture` describes; `None` where it
    /// is, or cannot be.
    pub fn changed(&self, fixture: &Fixture) -> Option<Fixture> {
        match self {
            Measure::AddedMass { mass, mass_std, body, x, x_std } => {
                let mut known =
                    Effect::new(EffectKind::AddedMass, Place::Body(body.clone()), None, &[*x, *mass]);
                let both = [Quantity::with_std(*x, *x_std), Quantity::with_std(*mass, *mass_std)];
                known.parameters.splice(..2, both);
                let mut physics = fixture.physics().to_vec();
                physics.push(known);
                fixture.clone().with_physics(physics).ok()
            }
            Measure::HungFreely => {
                let mut value = fixture.to_value();
                value.as_object_mut()?.shift_remove("supports");
                Fixture::from_value(&value).ok()
            }
            _ => None,
        }
    }

    /// Whether another structure is measured.
    pub(crate) fn changes_the_structure(&self) -> bool {
        matches!(self, Measure::AddedMass { .. } | Measure::HungFreely)
    }

    /// The FRFs that it records of the structure as it is.
    pub fn frfs(&self) -> Vec<FrfPair> {
        match self {
            Measure::Frf { frf } => vec![frf.clone()],
            Measure::Frfs { frfs } | Measure::HammerAt { frfs, .. } | Measure::SensorAt { frfs, .. } => {
                frfs.clone()
            }
            _ => Vec::new(),
        }
    }

    /// How much work it is, in FRFs that are to be recorded; `present` were. What is weighed or measured with
    /// a calliper counts as one.
    pub(crate) fn effort(&self, present: usize) -> f64 {
        match self {
            Measure::Frf { .. } | Measure::Quantity { .. } => 1.0,
            Measure::Frfs { frfs } | Measure::HammerAt { frfs, .. } | Measure::SensorAt { frfs, .. } => {
                frfs.len() as f64
            }
            Measure::Averages { times } => present as f64 * (f64::from(*times) - 1.0),
            // And the change.
            Measure::AddedMass { .. } | Measure::HungFreely => present as f64 + 1.0,
        }
    }
}

/// As in `plan.json`: `frf 2/1`, `added mass 0.05 kg on B at 0.11`, `weigh bodies/A/mass to 0.0002 kg`.
impl fmt::Display for Measure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Measure::Frf { frf } => write!(f, "frf {frf}"),
            Measure::Frfs { frfs } => {
                let all: Vec<String> = frfs.iter().map(ToString::to_string).collect();
                write!(f, "frfs {}", all.join(" "))
            }
            Measure::HammerAt { point, .. } => write!(f, "hammer at {point}"),
            Measure::SensorAt { point, .. } => write!(f, "sensor at {point}"),
            Measure::Averages { times } => write!(f, "averages times {times}"),
            Measure::AddedMass { mass, body, x, .. } => {
                write!(f, "added mass {mass} kg on {body} at {}", rounded(*x))
            }
            Measure::HungFreely => f.write_str("hung freely"),
            Measure::Quantity { path, std, unit } => {
                let verb = if *unit == "kg" { "weigh" } else { "measure" };
                write!(f, "{verb} {path} to {} {unit}", two_digits(*std))
            }
        }
    }
}

/// To a tenth of a millimetre.
fn rounded(x: f64) -> f64 {
    (1e4 * x).round() / 1e4
}

/// To two significant digits.
pub(crate) fn two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}
