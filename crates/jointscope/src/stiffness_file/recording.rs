//! The recording that a joint was found from.

use crate::file::value;
use jointscope_decomposition::Analysis;
use jointscope_spectra::FrfPair;
use serde::Serialize;
use serde_json::{Map, Value};

/// Which FRFs of the recording were used, and how well they are known.
#[derive(Serialize)]
pub(super) struct UsedRecording<'a> {
    used: Vec<&'a FrfPair>,
    unused: &'a [FrfPair],
    noise_from: Map<String, Value>,
    reference_points: ReferencePoints<'a>,
    rigid_motion_chi2_per_dof: Option<f64>,
    noisy_lines: usize,
    tolerances_not_followed: &'a [String],
}

#[derive(Serialize)]
struct ReferencePoints<'a> {
    responding: &'a str,
    loaded: &'a str,
}

impl<'a> UsedRecording<'a> {
    pub(super) fn of(analysis: &'a Analysis) -> Self {
        let (plan, pairs) = (&analysis.plan, analysis.frfs.pairs());
        let noise = pairs.iter().zip(&analysis.noise).map(|(pair, source)| (pair.to_string(), value(source)));
        UsedRecording {
            used: plan.layout.channels.iter().map(|(index, ..)| &pairs[*index]).collect(),
            unused: &plan.unused,
            noise_from: noise.collect(),
            reference_points: ReferencePoints { responding: &plan.responding.2, loaded: &plan.loaded.2 },
            rigid_motion_chi2_per_dof: analysis.spectrum.h41.rigidity(),
            noisy_lines: analysis.noisy_lines(),
            tolerances_not_followed: &analysis.lost_tolerances,
        }
    }
}
