//! What a change does to the modes of a structure, against what differs from one test of it to the next.

use crate::Hypothesis;
use crate::modal::judgement::ModalJudgement;
use crate::settings::ModalSettings;
use jointscope_model_error::{ModelledMode, ModelledModes};
use std::f64::consts::SQRT_2;

impl ModalJudgement {
    /// Whether some mode of the model `now` differs from what it was `then` by more than a test that is repeated
    /// may show it: another frequency, damping ratio or residues, or a mode more or fewer.
    pub(crate) fn is_beyond_repetition(
        &self,
        settings: &ModalSettings,
        [then, now]: [&Hypothesis; 2],
    ) -> bool {
        let modes = |hypothesis: &Hypothesis| {
            ModelledModes::of(&hypothesis.to_fixture().ok()?, &self.features.recorded)
        };
        let (Some(then), Some(now)) = (modes(then), modes(now)) else { return false };
        let differs = |(was, is): (&ModelledMode, &ModelledMode)| is_beyond(settings, was, is);
        then.modes.len() != now.modes.len() || then.modes.iter().zip(&now.modes).any(differs)
    }
}

fn is_beyond(settings: &ModalSettings, was: &ModelledMode, is: &ModelledMode) -> bool {
    let (usual, (times, _)) = (settings.repeated, settings.adequate);
    let ratio = |is: f64, was: f64| (is / was).ln().abs();
    let both = was.residues.iter().zip(&is.residues);
    let apart: f64 = both.map(|(was, is)| (is - was).norm_sqr()).sum();
    let size: f64 = was.residues.iter().map(|a| a.norm_sqr()).sum();
    // Of a response's shape and of a reference's.
    let residues = SQRT_2 * usual.shape.max(usual.gain);
    ratio(is.pole.omega, was.pole.omega) > times * usual.frequency
        || ratio(is.pole.damping_ratio, was.pole.damping_ratio) > times * usual.damping
        || apart.sqrt() > times * residues * size.sqrt()
}
