//! δ(s): what an effect makes of the one scalar a line through which it acts.

use crate::SignalFilter;
use crate::effects::{Action, Change, action};
use crate::point_law::{PointLaw, relaxed};
use jointscope_fixture::{Effect, Fixture};
use num_complex::Complex64;

/// δ(s) of an effect, in the unit of its place: nothing missing is zero, but of what is in series it is
/// infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Delta {
    /// The dynamic stiffness of a component, or of a spring in series with a joint.
    Stiffness(PointLaw),
    /// factor − 1, of a joint's elastic stiffness.
    Factor(f64),
    /// iη, of a joint's elastic stiffness.
    Loss(f64),
    /// ratio·sτ/(1 + sτ), of a joint's elastic stiffness.
    Relaxation {
        /// Rise of the stiffness from slow to fast motions, relative.
        ratio: f64,
        /// τ, s.
        time: f64,
    },
    /// g e^{−sτ} − 1, of a channel's signal.
    Signal {
        /// g.
        gain: f64,
        /// τ, s.
        delay: f64,
    },
    /// A filter's value less one, of a channel's signal.
    Filtered(SignalFilter),
    /// dx of a sensor or an impact, m.
    Offset(f64),
}

impl Delta {
    /// δ of an effect of `fixture`; `None` of one that changes more than a scalar a line, and of a sensor's
    /// mass, whose δ depends on the FRF.
    pub fn of(fixture: &Fixture, effect: &Effect) -> Option<Self> {
        match action(fixture, effect)? {
            Action::Through { law, .. } => Some(Delta::Stiffness(law)),
            Action::OnJoint { joint, change } => {
                Delta::of_joint(fixture.joint_length(&fixture.joints()[joint]), change)
            }
            Action::Offset { dx, .. } => Some(Delta::Offset(dx)),
            Action::Signal { gain, delay, .. } => Some(Delta::Signal { gain, delay }),
            Action::Filtered { filter, .. } => Some(Delta::Filtered(filter)),
            Action::Bending { .. }
            | Action::OnBeam { .. }
            | Action::SensorLoad { .. }
            | Action::Window { .. }
            | Action::Amplitude => None,
        }
    }

    fn of_joint(length: f64, change: Change) -> Option<Self> {
        let spring = |stiffness, damping| Delta::Stiffness(PointLaw::Spring { stiffness, damping });
        match change {
            Change::Factor(factor) => Some(Delta::Factor(factor)),
            Change::Loss(loss) => Some(Delta::Loss(loss)),
            Change::Relaxation { ratio, time } => Some(Delta::Relaxation { ratio, time }),
            // Spread over the joint, shear gives way as a spring at one end does.
            Change::Shear { stiffness, .. } => Some(spring(stiffness / length, 0.0)),
            Change::Interface(interface) => Some(spring(interface.stiffness, interface.damping)),
            Change::Mass(_) | Change::Length(_) => None,
        }
    }

    /// Its value at s = iω (or decay + iω).
    pub fn at(&self, s: Complex64) -> Complex64 {
        match *self {
            Delta::Stiffness(law) => law.at(s),
            Delta::Factor(factor) => Complex64::from(factor - 1.0),
            Delta::Loss(loss) => Complex64::new(0.0, loss),
            Delta::Relaxation { ratio, time } => relaxed(s, time) * ratio,
            Delta::Signal { gain, delay } => gain * (-s * delay).exp() - 1.0,
            Delta::Filtered(filter) => filter.at(s) - 1.0,
            Delta::Offset(dx) => Complex64::from(dx),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_fixture::{Dof, EffectKind as Kind, Place};
    use std::f64::consts::TAU;

    const BLOCKS: &str = r#"{
      "bodies": { "A": { "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }, "B": { "mass": 1.2, "inertia": 9.9e-4, "x_cg": 0.095 } },
      "points": { "2": { "body": "A", "x": 0 }, "3": { "body": "B", "x": 0.06 } },
      "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 } } } }"#;

    /// δ at a line (Hz) of an effect of this kind, at a place that such effects have.
    fn delta(kind: Kind, values: &[f64], hz: f64) -> Option<Complex64> {
        let fixture = Fixture::from_json(BLOCKS).unwrap();
        let place = match kind {
            Kind::AddedMass | Kind::Support | Kind::AttachedResonator | Kind::BodyFlexibility => {
                Place::Body("A".into())
            }
            Kind::Bypass => Place::Between("A".into(), "B".into()),
            Kind::InterfaceCompliance | Kind::PointOffset => Place::Point("2".into()),
            Kind::ChannelGain | Kind::ChannelDelay | Kind::ChannelHighpass | Kind::ChannelResonance => {
                Place::Response("3".into())
            }
            _ => Place::Joint("J".into()),
        };
        let dof = (kind == Kind::InterfaceCompliance).then_some(Dof::Translation);
        let effect = Effect::new(kind, place, dof, values);
        Some(Delta::of(&fixture, &effect)?.at(Complex64::new(0.0, TAU * hz)))
    }

    #[test]
    fn every_law_of_the_table_of_effects_has_its_values() {
        // Of the formulas in the table at 50 Hz, evaluated in another program.
        let expected: [(Kind, &[f64], f64, f64); 15] = [
            (Kind::AddedMass, &[0.0, 0.02], -1973.9208802178719, 0.0),
            (Kind::Support, &[0.0, 3e4, 5.0], 3e4, 1570.7963267948967),
            (Kind::Bypass, &[0.0, 0.1, 3e4, 5.0], 3e4, 1570.7963267948967),
            (Kind::AttachedResonator, &[0.0, 0.02, 80.0, 0.03], -3234.4810587740467, 77.57293406499538),
            (Kind::InterfaceCompliance, &[2e6, 7.0, 0.0], 2e6, 2199.1148575128555),
            (Kind::ShearDeformation, &[6e4, 0.0], 1e6, 0.0),
            (Kind::StiffnessChange, &[0.7], -0.3, 0.0),
            (Kind::LossFactor, &[0.05], 0.0, 0.05),
            (Kind::Relaxation, &[0.4, 1e-3], 0.035932064941489865, 0.11437531501874215),
            (Kind::Springpot, &[1e3, 0.3], 5000.642940835807, 2547.954842190507),
            (Kind::PointOffset, &[0.003], 0.003, 0.0),
            (Kind::ChannelGain, &[0.8], -0.2, 0.0),
            (Kind::ChannelDelay, &[2e-4], -0.001973271571728441, -0.06279051952931337),
            (Kind::ChannelHighpass, &[4.0], -0.006359300476947549, 0.0794912559618442),
            (Kind::ChannelResonance, &[900.0, 0.02], 0.0030909909769123445, -0.0022359923018680397),
        ];
        for (kind, values, re, im) in expected {
            let (found, expected) = (delta(kind, values, 50.0).unwrap(), Complex64::new(re, im));
            assert!((found - expected).norm() < 1e-12 * expected.norm(), "{}: {found}", kind.name());
        }
        let tabled = Kind::ALL.into_iter().filter(|kind| kind.spec().words.law.is_some());
        let mut here = expected.map(|(kind, ..)| kind);
        here.sort_unstable();
        assert_eq!(tabled.collect::<Vec<_>>(), here);
    }

    #[test]
    fn what_changes_more_than_a_scalar_a_line_has_none() {
        assert!(delta(Kind::BodyFlexibility, &[300.0, 0.01], 50.0).is_none());
        assert!(delta(Kind::JointMass, &[0.1], 50.0).is_none());
    }

    #[test]
    fn a_resonator_is_a_mass_far_below_its_frequency_and_a_spring_far_above() {
        let resonator = |hz| delta(Kind::AttachedResonator, &[0.0, 0.02, 300.0, 0.0], hz).unwrap();
        let mass = delta(Kind::AddedMass, &[0.0, 0.02], 3.0).unwrap();
        assert!((resonator(3.0) / mass - 1.0).norm() < 1e-3);
        let spring = 0.02 * (TAU * 300.0).powi(2);
        assert!((resonator(3e4) / spring - 1.0).norm() < 1e-3);
    }

    #[test]
    fn a_high_pass_takes_away_what_lies_below_it_and_a_resonance_what_lies_above() {
        let highpass = |hz| delta(Kind::ChannelHighpass, &[1.0], hz).unwrap();
        assert!((highpass(1e-4) + 1.0).norm() < 1e-3 && highpass(1e4).norm() < 1e-3);
        let resonance = |hz| delta(Kind::ChannelResonance, &[1000.0, 0.01], hz).unwrap();
        assert!(resonance(1.0).norm() < 1e-4 && (resonance(1e6) + 1.0).norm() < 1e-5);
    }

    #[test]
    fn a_slow_relaxation_is_a_loss_and_a_fast_one_a_stiffness() {
        let relaxation = |hz| delta(Kind::Relaxation, &[0.3, 1e-3], hz).unwrap();
        assert!((relaxation(1e5) - 0.3).norm() < 1e-3);
        assert!(relaxation(1.0).im > 10.0 * relaxation(1.0).re);
    }
}
