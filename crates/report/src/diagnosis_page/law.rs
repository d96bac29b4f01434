//! The laws over frequency by which a measured δ(ω) is named.

use std::f64::consts::TAU;

use jointscope_diagnosis::{Finding, Site};
use jointscope_fixture::{EffectKind, Fixture};
use num_complex::Complex64;

/// What a finding's parameters make of δ at a line (Hz), in the unit of its site, and the formula; `None` where its law is not one scalar.
pub(super) struct Law {
    pub formula: &'static str,
    kind: EffectKind,
    values: Vec<f64>,
    /// Length of the joint, m, where a distributed compliance is taken at its end.
    length: f64,
}

impl Law {
    pub(super) fn of(finding: &Finding, site: &Site, fixture: &Fixture) -> Option<Self> {
        let kind = finding.effect.kind;
        let formula = kind.spec().words.law?;
        let length = match site {
            Site::Series { joint, .. } => fixture.joint(joint).map_or(f64::NAN, |j| fixture.joint_length(j)),
            _ => f64::NAN,
        };
        let values = finding.effect.parameters.iter().map(|p| p.value).collect();
        Some(Law { formula, kind, values, length })
    }

    /// δ at a line.
    pub(super) fn at(&self, hz: f64) -> Complex64 {
        let omega = TAU * hz;
        let value = |index: usize| self.values.get(index).copied().unwrap_or(0.0);
        let i = Complex64::I;
        match self.kind {
            EffectKind::AddedMass => Complex64::from(-omega * omega * value(1)),
            EffectKind::Support => value(1) + i * omega * value(2),
            EffectKind::Bypass => value(2) + i * omega * value(3),
            EffectKind::AttachedResonator => {
                let own = TAU * value(2);
                let spring = own * own + 2.0 * i * value(3) * own * omega;
                -omega * omega * value(1) * spring / (spring - omega * omega)
            }
            EffectKind::InterfaceCompliance => value(0) + i * omega * value(1),
            EffectKind::ShearDeformation => Complex64::from(value(0) / self.length),
            EffectKind::ChannelGain | EffectKind::StiffnessChange => Complex64::from(value(0) - 1.0),
            EffectKind::ChannelDelay => (-i * omega * value(0)).exp() - 1.0,
            EffectKind::ChannelHighpass => i * hz / (i * hz + value(0)) - 1.0,
            EffectKind::ChannelResonance => {
                let own = value(0) * value(0);
                own / (own - hz * hz + 2.0 * i * value(1) * value(0) * hz) - 1.0
            }
            EffectKind::PointOffset => Complex64::from(value(0)),
            EffectKind::LossFactor => i * value(0),
            EffectKind::Springpot => value(0) * (i * omega).powf(value(1)),
            EffectKind::Relaxation => value(0) * i * omega * value(1) / (1.0 + i * omega * value(1)),
            _ => Complex64::new(f64::NAN, f64::NAN),
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use jointscope_diagnosis::Evidence;
    use jointscope_fixture::{Effect, Place};

    fn law(kind: EffectKind, values: &[f64]) -> Law {
        let fixture =
            Fixture::from_json(r#"{ "bodies": { "A": { "mass": 2.0, "rotates": false } }, "points": { "1": { "body": "A", "x": 0 } } }"#).unwrap();
        let effect = Effect::new(kind, Place::Body("A".into()), None, values);
        let finding = Finding {
            effect,
            estimates: Vec::new(),
            probability: 1.0,
            alternatives: Vec::new(),
            evidence: Evidence { gain: 0.0, elsewhere: Vec::new(), measured: None },
        };
        Law::of(&finding, &Site::Body { body: "A".into(), x: 0.0 }, &fixture).unwrap()
    }

    #[test]
    fn a_resonator_is_a_mass_far_below_its_frequency_and_a_spring_far_above() {
        let resonator = law(EffectKind::AttachedResonator, &[0.0, 0.02, 300.0, 0.0]);
        let mass = law(EffectKind::AddedMass, &[0.0, 0.02]);
        assert!((resonator.at(3.0) / mass.at(3.0) - 1.0).norm() < 1e-3);
        let spring = 0.02 * (TAU * 300.0).powi(2);
        assert!((resonator.at(3e4) / spring - 1.0).norm() < 1e-3);
    }

    #[test]
    fn every_law_of_the_table_of_effects_can_be_drawn() {
        for kind in EffectKind::ALL.into_iter().filter(|kind| kind.spec().words.law.is_some()) {
            let values = vec![0.5; kind.spec().parameters.len()];
            let mut law = law(kind, &values);
            law.length = 0.1;
            assert!(law.at(50.0).is_finite(), "{}", kind.name());
        }
    }

    #[test]
    fn a_high_pass_takes_away_what_lies_below_it_and_a_resonance_what_lies_above() {
        let highpass = law(EffectKind::ChannelHighpass, &[1.0]);
        assert!((highpass.at(1e-4) + 1.0).norm() < 1e-3 && highpass.at(1e4).norm() < 1e-3);
        let resonance = law(EffectKind::ChannelResonance, &[1000.0, 0.01]);
        assert!(resonance.at(1.0).norm() < 1e-4 && (resonance.at(1e6) + 1.0).norm() < 1e-5);
    }

    #[test]
    fn a_slow_relaxation_is_a_loss_and_a_fast_one_a_stiffness() {
        let relaxation = law(EffectKind::Relaxation, &[0.3, 1e-3]);
        assert!((relaxation.at(1e5) - 0.3).norm() < 1e-3);
        assert!(relaxation.at(1.0).im > 10.0 * relaxation.at(1.0).re);
    }
}
