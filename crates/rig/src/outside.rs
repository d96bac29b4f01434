//! Physics that no effect of a fixture file describes: what a diagnosis must not give a wrong name to.

use crate::random::{choice, log_uniform, sign, uniform};
use crate::{Instrument, Law, Row, Station, Structure, StructureError, read};
use jointscope_fixture::{BodyKind, Effect, EffectKind, Fixture, Joint, JointLaw, Place};
use jointscope_spectra::{Channel, FrfForm, FrfPair, FrfSet, SpectralLines};
use rand::Rng;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

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
}

/// The kinds of [`Outside`], in the order in which [`Outside::draw`] counts them.
const KINDS: [&str; 5] = ["inerter", "drift", "bypass", "gyroscope", "springpot"];

/// Branches of spring and dashpot in series that make a springpot, from 1 Hz to 10 kHz.
const BRANCHES: usize = 17;

impl Outside {
    /// Number of kinds.
    pub const KINDS: usize = KINDS.len();

    /// A random one of kind `kind` (counted modulo [`Outside::KINDS`]); `None` where the fixture has no place for it or `recorded` has
    /// one reference only. Whether it shows is for the caller to judge: sizes run over two decades.
    pub fn draw(rng: &mut impl Rng, fixture: &Fixture, kind: usize, recorded: &[FrfPair]) -> Option<Self> {
        let joint = choice(rng, fixture.joints())?;
        let stiffness = transverse_stiffness(fixture, joint);
        let name = joint.name.clone();
        Some(match KINDS[kind % KINDS.len()] {
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
                let turns = |kind: &BodyKind| !matches!(kind, BodyKind::Rigid(rigid) if !rigid.rotates);
                let turning: Vec<_> =
                    fixture.points().iter().filter(|p| turns(&fixture.bodies()[p.body].kind)).collect();
                let point = choice(rng, &turning)?;
                let arm = 0.03 * mass(&fixture.bodies()[point.body].kind);
                let coupling = sign(rng) * arm * TAU * log_uniform(rng, 3.0, 100.0);
                Outside::Gyroscope { point: point.name.clone(), coupling }
            }
            _ => Outside::Springpot {
                joint: name,
                stiffness: stiffness * log_uniform(rng, 0.003, 0.3),
                order: uniform(rng, 0.25, 0.75),
            },
        })
    }

    /// Its kind in a word.
    pub fn kind(&self) -> &'static str {
        KINDS[match self {
            Outside::Inerter { .. } => 0,
            Outside::Drift { .. } => 1,
            Outside::Bypass { .. } => 2,
            Outside::Gyroscope { .. } => 3,
            Outside::Springpot { .. } => 4,
        }]
    }

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
        if let Outside::Drift { joint, reference, factor } = self {
            let before = crate::frfs(fixture, pairs, lines, instrument)?;
            let mut physics = fixture.physics().to_vec();
            let place = Place::Joint(joint.clone());
            physics.push(Effect::new(EffectKind::StiffnessChange, place, None, &[*factor]));
            let after = crate::frfs(&fixture.clone().with_physics(physics)?, pairs, lines, instrument)?;
            let mut values = Vec::with_capacity(before.all_values().len());
            for (index, pair) in pairs.iter().enumerate() {
                let struck = if pair.reference.point == *reference { &after } else { &before };
                values.extend_from_slice(struck.values(index));
            }
            return Ok(FrfSet::new(lines.clone(), FrfForm::Accelerance, pairs.to_vec(), values)?);
        }
        let effects = match instrument {
            Instrument::Perfect => &[],
            Instrument::AsDescribed => fixture.physics(),
        };
        read(&self.built_into(fixture)?, effects, pairs, lines)
    }

    fn built_into(&self, fixture: &Fixture) -> Result<Structure, StructureError> {
        let plain = Structure::of(fixture)?;
        let station = |name: &str| -> Result<Station, StructureError> {
            Ok(Station {
                y: plain.motion(&Channel::transverse(name))?.clone(),
                theta: plain.motion(&Channel::rotational(name))?.clone(),
            })
        };
        // The motion of one place relative to what another, reaching over to it, carries along.
        let relative = |from: &str, to: &str| -> Result<Row, StructureError> {
            let x = |name: &str| fixture.point(name).map_or(0.0, |p| p.x.value);
            let [translation, _] = station(to)?.relative_to(&station(from)?, x(to) - x(from));
            Ok(translation)
        };
        let across = |name: &str| -> Result<Row, StructureError> {
            let joint =
                fixture.joint(name).ok_or_else(|| StructureError::UnknownPoint(format!("joint {name}")))?;
            relative(&fixture.points()[joint.from].name, &fixture.points()[joint.to].name)
        };
        let mut assembly = plain.assembly().clone();
        match self {
            Outside::Inerter { joint, inertance } => assembly.inertia(&across(joint)?, *inertance),
            Outside::Drift { .. } => {}
            Outside::Bypass { from, to, stiffness } => {
                assembly.spring(&relative(from, to)?, *stiffness, Law::ELASTIC);
            }
            Outside::Gyroscope { point, coupling } => {
                let Station { y, theta } = station(point)?;
                assembly.dashpots(&[y, theta], &[0.0, *coupling, -*coupling, 0.0]);
            }
            Outside::Springpot { joint, stiffness, order } => {
                let relative = across(joint)?;
                let (slowest, fastest) = (TAU.ln(), (TAU * 1e4).ln());
                let spacing = (fastest - slowest) / (BRANCHES - 1) as f64;
                // ∫ ν^α·s/(s + ν) dν/ν over all rates ν is s^α·π/sin(πα): a sum over branches of rate ν, a spring for the
                // slower ones, a dashpot for the faster ones.
                let unit = stiffness * (TAU * 100.0).powf(-order) * (PI * order).sin() / PI;
                let (slower, faster) = ((slowest - 0.5 * spacing).exp(), (fastest + 0.5 * spacing).exp());
                assembly.spring(&relative, unit * slower.powf(*order) / order, Law::ELASTIC);
                assembly.dashpot(&relative, unit * faster.powf(order - 1.0) / (1.0 - order));
                for branch in 0..BRANCHES {
                    let rate = (slowest + spacing * branch as f64).exp();
                    let spring = unit * spacing * rate.powf(*order);
                    let dashpot = Row::coordinate(assembly.coordinate());
                    assembly.spring(&relative.minus(&dashpot), spring, Law::ELASTIC);
                    assembly.dashpot(&dashpot, spring / rate);
                }
            }
        }
        let points: Vec<(String, Station)> = fixture
            .points()
            .iter()
            .map(|point| Ok((point.name.clone(), station(&point.name)?)))
            .collect::<Result<_, StructureError>>()?;
        Ok(Structure::new(assembly, points))
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
