//! What a fit may move: quantities of the fixture within their tolerances, and the laws of the joints.

use crate::RestoringLaw;
use jointscope_fixture::{Dof, Effect, Fixture, FixtureError};

/// A quantity of the fixture that may move.
#[derive(Debug, Clone, PartialEq)]
pub struct Tolerance {
    /// Path in the file.
    pub path: String,
    /// The stated value.
    pub nominal: f64,
    /// One standard deviation; `None` where it is free.
    pub std: Option<f64>,
    index: usize,
    scale: f64,
}

/// An amplitude-dependent law at a joint.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Law {
    pub joint: String,
    pub dof: Dof,
    pub law: RestoringLaw,
    /// Unit of a cubic stiffness, whose sign is free.
    scale: f64,
}

/// A point in the space of a fit: coordinates in standard deviations (tenths of the value where it is free), then those of the laws (logarithms;
/// a cubic stiffness in units of where it started).
#[derive(Debug, Clone)]
pub(crate) struct Parameters {
    fixture: Fixture,
    pub tolerances: Vec<Tolerance>,
    pub laws: Vec<Law>,
    pub coordinates: Vec<f64>,
}

impl Law {
    pub fn new(joint: &str, dof: Dof, law: RestoringLaw) -> Self {
        let scale = match law {
            RestoringLaw::Cubic { stiffness3 } => stiffness3.abs().max(f64::MIN_POSITIVE),
            _ => 1.0,
        };
        Law { joint: joint.to_owned(), dof, law, scale }
    }

    /// Kind, joint and dof.
    pub fn is_named_as(&self, other: &Law) -> bool {
        self.joint == other.joint
            && self.dof == other.dof
            && std::mem::discriminant(&self.law) == std::mem::discriminant(&other.law)
    }

    /// Whether no parameter differs by more than a part `by`.
    pub fn is_like(&self, other: &Law, by: f64) -> bool {
        let pairs = |law: &Law| law.effect().parameters.iter().map(|q| q.value).collect::<Vec<f64>>();
        let (own, theirs) = (pairs(self), pairs(other));
        self.is_named_as(other)
            && own.iter().zip(&theirs).all(|(a, b)| (a - b).abs() <= by * a.abs().max(b.abs()))
    }

    pub fn effect(&self) -> Effect {
        self.law.to_effect(&self.joint, self.dof)
    }

    fn coordinates(&self) -> Vec<f64> {
        match self.law {
            RestoringLaw::Cubic { stiffness3 } => vec![stiffness3 / self.scale],
            RestoringLaw::Friction { slip_force, stiffness } => vec![slip_force.ln(), stiffness.ln()],
            RestoringLaw::Gap { clearance, stiffness } => vec![clearance.ln(), stiffness.ln()],
        }
    }

    fn at(&self, coordinates: &[f64]) -> Law {
        let exp = |i: usize| coordinates.get(i).copied().unwrap_or(0.0).clamp(-200.0, 200.0).exp();
        let law = match self.law {
            RestoringLaw::Cubic { .. } => {
                let value = coordinates.first().copied().unwrap_or(0.0) * self.scale;
                // The file wants a cubic stiffness that is not zero.
                RestoringLaw::Cubic { stiffness3: if value == 0.0 { 1e-12 * self.scale } else { value } }
            }
            RestoringLaw::Friction { .. } => RestoringLaw::Friction { slip_force: exp(0), stiffness: exp(1) },
            RestoringLaw::Gap { .. } => RestoringLaw::Gap { clearance: exp(0), stiffness: exp(1) },
        };
        Law { law, ..self.clone() }
    }

    /// Derivative of each parameter with respect to its coordinate, in the order of the effect's parameters.
    pub fn slopes(&self) -> Vec<f64> {
        match self.law {
            RestoringLaw::Cubic { .. } => vec![self.scale],
            RestoringLaw::Friction { slip_force, stiffness } => vec![slip_force, stiffness],
            RestoringLaw::Gap { clearance, stiffness } => vec![clearance, stiffness],
        }
    }

    pub fn parameters(&self) -> usize {
        self.coordinates().len()
    }
}

impl Parameters {
    /// The fixture as stated. Points that no joint, support or channel uses stay where they are.
    pub fn nominal(fixture: &Fixture, exact: bool, channels: &[String]) -> Self {
        let quantities = if exact { fixture.quantities_exact() } else { fixture.quantities() };
        let used = |path: &str| {
            let Some(name) = path.strip_prefix("points/").and_then(|p| p.strip_suffix("/x")) else {
                return true;
            };
            let joined = fixture.joints().iter().flat_map(|j| [j.from, j.to]);
            channels.iter().any(|c| c == name)
                || joined.into_iter().any(|p| fixture.points()[p].name == name)
                || fixture.supports().iter().any(|s| {
                    matches!(s.place, jointscope_fixture::SupportPlace::Point(p) if fixture.points()[p].name == name)
                })
        };
        let mut tolerances: Vec<Tolerance> = Vec::new();
        for (index, quantity) in quantities.iter().enumerate() {
            let std = match quantity.std {
                Some(std) if std <= 0.0 => continue,
                std => std,
            };
            // Young's modulus and second moment enter as a product: one carries the deviation of both.
            if let Some(beam) = quantity.path.strip_suffix("second_moment")
                && let Some(modulus) =
                    tolerances.iter_mut().find(|t| t.path == format!("{beam}youngs_modulus"))
            {
                let relative = |std: f64, value: f64| std / value.abs();
                modulus.std = modulus.std.zip(std).map(|(a, b)| {
                    modulus.nominal.abs() * relative(a, modulus.nominal).hypot(relative(b, quantity.value))
                });
                modulus.scale = scale(modulus.nominal, modulus.std);
                continue;
            }
            if used(&quantity.path) {
                let (path, nominal) = (quantity.path.clone(), quantity.value);
                tolerances.push(Tolerance { path, nominal, std, index, scale: scale(nominal, std) });
            }
        }
        let coordinates = vec![0.0; tolerances.len()];
        Parameters { fixture: fixture.clone(), tolerances, laws: Vec::new(), coordinates }
    }

    pub fn with(&self, law: Law) -> Self {
        let mut more = self.clone();
        more.coordinates.extend(law.coordinates());
        more.laws.push(law);
        more
    }

    /// The same quantities without any law.
    pub fn without_laws(&self) -> Self {
        let mut less = self.clone();
        less.coordinates.truncate(less.tolerances.len());
        less.laws.clear();
        less
    }

    /// The laws at the present coordinates.
    pub fn laws(&self) -> Vec<Law> {
        let mut at = self.tolerances.len();
        let law = |law: &Law| {
            let count = law.parameters();
            at += count;
            law.at(&self.coordinates[at - count..at])
        };
        self.laws.iter().map(law).collect()
    }

    /// Where the coordinates of law `index` begin.
    pub fn first_of(&self, index: usize) -> usize {
        self.tolerances.len() + self.laws[..index].iter().map(Law::parameters).sum::<usize>()
    }

    /// Precision of the prior of coordinate `index`.
    pub fn prior(&self, index: usize) -> f64 {
        f64::from(self.tolerances.get(index).is_some_and(|t| t.std.is_some()))
    }

    /// Σ (departure/std)².
    pub fn penalty(&self) -> f64 {
        (0..self.tolerances.len()).map(|i| self.prior(i) * self.coordinates[i].powi(2)).sum()
    }

    /// Step of coordinate `index` for a difference quotient.
    pub fn step(&self, index: usize) -> f64 {
        match self.tolerances.get(index) {
            Some(tolerance) => {
                // A step of 2e-5 of a size is felt by no phase, and is far above rounding.
                let relative = 2e-5 * tolerance.nominal.abs() / tolerance.scale;
                let damping = tolerance.path.starts_with("damping") || tolerance.path.contains("/damping");
                let place = tolerance.path.ends_with("/x") || tolerance.path.ends_with("x_cg");
                match (damping, place) {
                    (true, _) => 0.02,
                    (_, true) => 2e-6 / tolerance.scale,
                    _ => relative.clamp(1e-6, 0.1),
                }
            }
            None => 1e-3,
        }
    }

    pub fn moved(&self, index: usize, step: f64) -> Self {
        let mut moved = self.clone();
        moved.coordinates[index] += step;
        moved
    }

    /// Moved by `step`; damping stops at zero.
    pub fn stepped(&self, step: &[f64]) -> Self {
        let mut next = self.clone();
        for (i, step) in step.iter().enumerate() {
            let longest = if i < self.tolerances.len() { LONGEST } else { LONGEST_OF_LAW };
            next.coordinates[i] += step.clamp(-longest, longest);
            if let Some(tolerance) = self.tolerances.get(i)
                && tolerance.path.contains("damping")
                && tolerance.nominal > 0.0
            {
                next.coordinates[i] = next.coordinates[i].max(-tolerance.nominal / tolerance.scale);
            }
        }
        next
    }

    /// The fixture at these coordinates, the laws in its physics.
    pub fn to_fixture(&self) -> Result<Fixture, FixtureError> {
        let mut fixture = self.fixture.clone();
        let mut quantities = fixture.quantities_mut();
        for (tolerance, coordinate) in self.tolerances.iter().zip(&self.coordinates) {
            quantities[tolerance.index].quantity.value = tolerance.nominal + coordinate * tolerance.scale;
        }
        let mut physics = self.fixture.physics().to_vec();
        physics.extend(self.laws().iter().map(Law::effect));
        fixture.with_physics(physics)
    }
}

/// Longest step of a coordinate: beyond it a linearised model says nothing.
const LONGEST: f64 = 4.0;
/// The same of a law's, a logarithm or a part of where it began: a spring that no longer slips, or never touches, would not find back.
const LONGEST_OF_LAW: f64 = 0.4;

fn scale(nominal: f64, std: Option<f64>) -> f64 {
    std.unwrap_or(if nominal != 0.0 { 0.1 * nominal.abs() } else { 1.0 })
}
