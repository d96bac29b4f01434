//! What is read of a `diagnosis.json`, and what it says of an effect.

use crate::numbers::short;
use jointscope_fixture::Effect;
use serde::Deserialize;
use std::collections::BTreeMap;

/// What is read of a `diagnosis.json`.
#[derive(Deserialize)]
pub(super) struct DiagnosisEntry {
    pub(super) verdict: String,
    pub(super) findings: Vec<FindingEntry>,
    #[serde(default)]
    pub(super) unnamed: bool,
    #[serde(default)]
    pub(super) recording: BandEntry,
    #[serde(default)]
    pub(super) band: Option<(f64, f64)>,
}

#[derive(Default, Deserialize)]
pub(super) struct BandEntry {
    #[serde(default)]
    pub(super) from: Option<f64>,
    #[serde(default)]
    pub(super) to: Option<f64>,
}

#[derive(Deserialize)]
pub(super) struct FindingEntry {
    pub(super) kind: String,
    pub(super) place: String,
    #[serde(default)]
    pub(super) dof: Option<String>,
    #[serde(default)]
    pub(super) parameters: BTreeMap<String, ParameterEntry>,
    #[serde(default)]
    pub(super) probability: Option<f64>,
}

#[derive(Deserialize)]
pub(super) struct ParameterEntry {
    #[serde(default)]
    pub(super) value: Option<f64>,
    #[serde(default)]
    pub(super) std: Option<f64>,
}

impl DiagnosisEntry {
    /// The recording's band, Hz.
    pub(super) fn band(&self) -> Option<(f64, f64)> {
        let band = self.recording.from.zip(self.recording.to).or(self.band)?;
        let (from, to) = (band.0.max(1e-3 * band.1), band.1);
        (from > 0.0 && from < to).then_some((from, to))
    }
}

/// An effect with its size, uncertainty and probability, or that it was stated.
pub(super) fn says(findings: &[FindingEntry], effect: &Effect) -> String {
    let dof = effect.dof.map(|dof| dof.name());
    let finding = findings.iter().find(|finding| {
        finding.kind == effect.kind.name()
            && finding.place == effect.place.to_string()
            && finding.dof.as_deref() == dof
    });
    let parameters = effect.kind.spec().parameters.iter().enumerate().map(|(index, spec)| {
        let std = finding.and_then(|finding| finding.parameters.get(spec.name)).and_then(|p| p.std);
        let std = std.map_or(String::new(), |std| format!(" ± {}", short(std)));
        format!("{} = {}{std} {}", spec.name, short(effect.value(index)), spec.unit_in(effect.dof))
            .trim_end()
            .to_owned()
    });
    let origin = match finding.map(|finding| finding.probability) {
        Some(Some(probability)) => format!("found, probability {probability:.2}"),
        Some(None) => "found".to_owned(),
        None => "stated in the fixture".to_owned(),
    };
    let kind = effect.kind.name().replace('_', " ");
    let dof = dof.map_or(String::new(), |dof| format!(", {dof}"));
    let parameters = parameters.collect::<Vec<_>>().join(", ");
    format!("{kind} of {}{dof} ({parameters}; {origin})", effect.place)
}
