//! Everything that is not a proportional part of the free assembly, as a change V Δ(s) Vᵀ of low rank.

use crate::Station;
use crate::joint::JointDynamics;
use jointscope_fixture::{Dof, Effect, EffectKind, Fixture, Place};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// The dynamic stiffness that one thing adds through one station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum PointLaw {
    /// k + s c.
    Spring { stiffness: f64, damping: f64 },
    /// s² m.
    Mass(f64),
    /// A mass on a spring: s² m (ω_a² + 2ζω_a s)/(s² + 2ζω_a s + ω_a²).
    Resonator { mass: f64, omega: f64, ratio: f64 },
}

impl PointLaw {
    pub fn at(&self, s: Complex64) -> Complex64 {
        match *self {
            PointLaw::Spring { stiffness, damping } => stiffness + s * damping,
            PointLaw::Mass(mass) => s * s * mass,
            PointLaw::Resonator { mass, omega, ratio } => {
                let spring = omega * omega + s * (2.0 * ratio * omega);
                s * s * mass * spring / (s * s + spring)
            }
        }
    }
}

/// One term of Δ, by the indices of its stations in the list of [`Terms`].
#[derive(Debug, Clone)]
pub(crate) enum Term {
    /// A rank-one change at one station.
    Point { station: usize, law: PointLaw },
    /// What a joint is beyond its part in the modes; the four stations are (y, θ) at its ends.
    Joint { acting: usize, in_the_modes: usize, joint: Box<JointDynamics> },
}

/// All terms with the stations they act through.
#[derive(Debug, Clone, Default)]
pub(crate) struct Terms {
    pub stations: Vec<TermStation>,
    pub terms: Vec<Term>,
}

/// A station, with or without the bending coordinates of blocks in its motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TermStation {
    pub station: Station,
    /// What is subtracted because the modes hold it already acts on the rigid coordinates alone.
    pub rigid_only: bool,
}

impl Terms {
    pub fn of(fixture: &Fixture, flexible: &[bool]) -> Self {
        let mut all = Terms::default();
        for support in fixture.supports() {
            let (body, x) = fixture.support_place(support);
            let springs = [
                (Dof::Translation, support.stiffness.value, support.damping),
                (
                    Dof::Rotation,
                    support.rotational_stiffness.map_or(0.0, |q| q.value),
                    support.rotational_damping,
                ),
            ];
            for (dof, stiffness, damping) in springs {
                let damping = damping.map_or(0.0, |q| q.value);
                if stiffness != 0.0 || damping != 0.0 {
                    all.point(Station { body, x, dof }, PointLaw::Spring { stiffness, damping });
                }
            }
        }
        for joint in fixture.joints() {
            let dynamics = JointDynamics::new(fixture, joint);
            let ends = [joint.from, joint.to].map(|p| &fixture.points()[p]);
            let bends = ends.iter().any(|p| flexible[p.body]);
            if !dynamics.is_altered() && !bends {
                continue;
            }
            let stations = ends.map(|p| Station::both(p.body, p.x.value)).concat();
            let acting = all.push_stations(&stations, false);
            // Without bending coordinates both sets of stations are the same.
            let in_the_modes = if bends { all.push_stations(&stations, true) } else { acting };
            all.terms.push(Term::Joint { acting, in_the_modes, joint: Box::new(dynamics) });
        }
        fixture.physics().iter().for_each(|effect| all.effect(fixture, effect));
        all
    }

    fn effect(&mut self, fixture: &Fixture, effect: &Effect) {
        let Place::Body(name) = &effect.place else { return };
        let Some(body) = fixture.bodies().iter().position(|b| b.name == *name) else { return };
        let law = match effect.kind {
            EffectKind::AddedMass => PointLaw::Mass(effect.value(1)),
            EffectKind::Support => PointLaw::Spring { stiffness: effect.value(1), damping: effect.value(2) },
            EffectKind::AttachedResonator => PointLaw::Resonator {
                mass: effect.value(1),
                omega: TAU * effect.value(2),
                ratio: effect.value(3),
            },
            _ => return,
        };
        self.point(Station::transverse(body, effect.value(0)), law);
    }

    fn point(&mut self, station: Station, law: PointLaw) {
        let station = self.push_stations(&[station], false);
        self.terms.push(Term::Point { station, law });
    }

    fn push_stations(&mut self, stations: &[Station], rigid_only: bool) -> usize {
        let first = self.stations.len();
        self.stations.extend(stations.iter().map(|&station| TermStation { station, rigid_only }));
        first
    }

    /// Writes Δ(s), order × order row-major, over `delta`.
    pub fn write(&self, s: Complex64, delta: &mut [Complex64]) {
        let order = self.stations.len();
        delta.fill(Complex64::ZERO);
        for term in &self.terms {
            match term {
                Term::Point { station, law } => delta[station * order + station] += law.at(s),
                Term::Joint { acting, in_the_modes, joint } => {
                    let (with, without) = (joint.at(s), joint.in_the_modes());
                    for i in 0..4 {
                        for j in 0..4 {
                            delta[(acting + i) * order + acting + j] += with.at(i, j);
                            delta[(in_the_modes + i) * order + in_the_modes + j] -= without.at(i, j);
                        }
                    }
                }
            }
        }
    }
}
