//! K, C, structural damping and mass of a fixture's joint, its effects included.

use crate::JointAtFrequency;
use jointscope_beam::Matrix4;
use jointscope_comparison::Matrix;
use jointscope_fixture::{
    Damping, Dof, Effect, EffectKind as Kind, Fixture, FixtureError, Joint, Place, Quantity,
};
use jointscope_lumped::{Delta, JointElement};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Where a joint does not depend on frequency: its derivative with respect to s is read here, rad/s, without
/// cancellation since it is imaginary.
const NEAR_ZERO: f64 = 1e-6;
/// Share of the stiffness that inertia makes where the mass is read.
const INERTIA: f64 = 1e-2;

/// A joint's constant matrices.
pub(crate) struct Matrices {
    pub length: f64,
    pub stiffness: Matrix,
    pub damping: Matrix,
    pub structural: Matrix,
    pub mass: Option<Matrix4>,
    /// Where K and C are read, Hz, if they depend on frequency.
    pub read_at: Option<f64>,
}

/// A joint of a fixture without mass, with and without losses that do not depend on frequency.
pub(crate) struct RepairedJoint<'a> {
    joint: &'a Joint,
    effects: Vec<&'a Effect>,
    with_losses: JointElement,
    without: JointElement,
    fixture: &'a Fixture,
}

impl<'a> RepairedJoint<'a> {
    pub(crate) fn new(fixture: &'a Fixture, joint: &'a Joint) -> Result<Self, FixtureError> {
        let effects: Vec<&Effect> = fixture.physics().iter().filter(|e| is_on(fixture, joint, e)).collect();
        let kept = |keep: &dyn Fn(&Effect) -> bool| -> Vec<Effect> {
            effects.iter().filter(|effect| keep(effect)).map(|effect| (*effect).clone()).collect()
        };
        let massless = fixture.clone().with_physics(kept(&|e| e.kind != Kind::JointMass))?;
        let lossless = kept(&|e| !matches!(e.kind, Kind::JointMass | Kind::LossFactor));
        let lossless = fixture.clone().with_physics(lossless)?.with_damping(Damping::Undamped)?;
        Ok(RepairedJoint {
            with_losses: JointElement::new(&massless, joint),
            without: JointElement::new(&lossless, joint),
            joint,
            effects,
            fixture,
        })
    }

    /// Whether constant matrices hold at one frequency only.
    pub(crate) fn depends_on_frequency(&self) -> bool {
        self.effects.iter().any(|effect| match effect.kind {
            Kind::Relaxation | Kind::Springpot => true,
            Kind::InterfaceCompliance | Kind::Footing => effect.value(1) != 0.0,
            _ => false,
        })
    }

    /// The matrices; those that depend on frequency at `frequency`, Hz.
    pub(crate) fn matrices(&self, frequency: f64) -> Result<Matrices, FixtureError> {
        let read_at = self.depends_on_frequency().then_some(frequency);
        let omega = read_at.map_or(NEAR_ZERO, |hz| TAU * hz);
        let (stiffness, damping, structural) = self.at(omega);
        let length = self.without.length();
        Ok(Matrices { length, stiffness, damping, structural, mass: self.mass()?, read_at })
    }

    /// K and C on lines.
    pub(crate) fn lines(&self, hz: impl Iterator<Item = f64>) -> Vec<JointAtFrequency> {
        hz.map(|frequency| {
            let (stiffness, damping, _) = self.at(TAU * frequency);
            JointAtFrequency { frequency, stiffness, damping }
        })
        .collect()
    }

    /// K, C and the structural part of K at `omega` above zero.
    fn at(&self, omega: f64) -> (Matrix, Matrix, Matrix) {
        let s = Complex64::new(0.0, omega);
        let far_end = |element: &JointElement| {
            let columns = [element.column(s, 2), element.column(s, 3)];
            move |i: usize, j: usize| columns[j.max(i)][2 + i.min(j)]
        };
        let (with, without) = (far_end(&self.with_losses), far_end(&self.without));
        let matrix = |of: &dyn Fn(usize, usize) -> f64| [[of(0, 0), of(0, 1)], [of(1, 0), of(1, 1)]];
        let mut stiffness = matrix(&|i, j| with(i, j).re);
        let mut damping = matrix(&|i, j| without(i, j).im / omega);
        let structural = matrix(&|i, j| with(i, j).im - without(i, j).im);
        let beside = |e: &&&Effect| matches!(e.kind, Kind::ParallelStiffness | Kind::Springpot);
        for effect in self.effects.iter().filter(beside) {
            let Some(delta) = Delta::of(self.fixture, effect) else { continue };
            let i = usize::from(effect.dof == Some(Dof::Rotation));
            let value = delta.at(s);
            stiffness[i][i] += value.re;
            damping[i][i] += value.im / omega;
        }
        (stiffness, damping, structural)
    }

    /// Mass on both ends: half the second derivative of the dynamic stiffness with respect to s, at rest,
    /// with what is elastic alone.
    fn mass(&self) -> Result<Option<Matrix4>, FixtureError> {
        let total: f64 =
            self.effects.iter().filter(|e| e.kind == Kind::JointMass).map(|effect| effect.value(0)).sum();
        if total == 0.0 {
            return Ok(None);
        }
        let elastic = |effect: &&&Effect| {
            !matches!(
                effect.kind,
                Kind::LossFactor | Kind::Relaxation | Kind::ParallelStiffness | Kind::Springpot
            )
        };
        let undamped = |effect: &&Effect| {
            let mut effect = (*effect).clone();
            if matches!(effect.kind, Kind::InterfaceCompliance | Kind::Footing) {
                effect.parameters[1] = Quantity::bare(0.0);
            }
            effect
        };
        let physics: Vec<Effect> = self.effects.iter().filter(elastic).map(undamped).collect();
        let fixture = self.fixture.clone().with_physics(physics)?.with_damping(Damping::Undamped)?;
        let element = JointElement::new(&fixture, self.joint);
        let rest = element.column(Complex64::ZERO, 2);
        let delta = (INERTIA * rest[2].re.abs() / total.abs()).sqrt();
        // A joint's own dashpots are odd in s and drop out.
        let second = |delta: f64, i: usize, j: usize| {
            let at = |s: f64| element.column(Complex64::new(s, 0.0), j)[i].re;
            0.5 * (at(delta) + at(-delta) - 2.0 * at(0.0)) / (delta * delta)
        };
        // Extrapolated, so that the next term of the series drops out too.
        let mass = |i: usize, j: usize| (4.0 * second(0.5 * delta, i, j) - second(delta, i, j)) / 3.0;
        Ok(Some(std::array::from_fn(|i| std::array::from_fn(|j| mass(i.min(j), i.max(j))))))
    }
}

/// Whether an effect is part of a joint, or between it and what it is fixed to.
pub(crate) fn is_on(fixture: &Fixture, joint: &Joint, effect: &Effect) -> bool {
    match &effect.place {
        Place::Joint(name) => *name == joint.name && !effect.kind.is_nonlinear(),
        Place::Point(name) => {
            effect.kind == Kind::InterfaceCompliance
                && [joint.from, joint.to].iter().any(|end| fixture.points()[*end].name == *name)
        }
        _ => false,
    }
}
