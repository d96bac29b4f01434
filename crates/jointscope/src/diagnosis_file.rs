//! The contents of `diagnosis.json`.

use crate::file::{Quantity, value, with_sentence};
use jointscope_diagnosis::{
    Departure, Diagnosis, EndErrors, Finding, FrfMismatch, HeldOut, Hypothesis, LawFit, LineEstimate,
    Location, ModeChange, ModelError, RecordEnd, Tried, Variation, Verdict,
};
use jointscope_findings::by_model;
use jointscope_frf::noise::NoiseSource;
use jointscope_spectra::FrfPair;
use jointscope_wording::{Remarks, Says};
use serde::{Serialize, Serializer};
use serde_json::Value;
use std::collections::BTreeMap;

/// The contents of `diagnosis.json`: verdict, mismatch, findings with intervals and alternatives, errors of
/// the three models, and beyond the contract where the tolerances ended, where each FRF's noise came from,
/// and what every place leaves unexplained. SI units; what is not finite is `null`.
pub fn diagnosis_file(diagnosis: &Diagnosis) -> Value {
    let (chi2_per_dof, p_value) = diagnosis.refitted;
    value(DiagnosisFile {
        verdict: diagnosis.verdict,
        says: diagnosis.says(),
        mismatch: Mismatch { chi2_per_dof, p_value, frfs: &diagnosis.mismatch },
        findings: diagnosis.findings.iter().map(finding).collect(),
        fit: Errors {
            nrmse: diagnosis.nrmse(),
            held_out: diagnosis.held_out.as_ref(),
            chi2_per_dof: diagnosis.chi2_per_dof(),
            residual_correlation: diagnosis.residual_correlation,
            residuals_are_white: diagnosis.is_white(),
        },
        refitted: quantities(&diagnosis.stated[0]),
        repaired: quantities(&diagnosis.stated[1]),
        locations: diagnosis.locations.iter().map(Place::of).collect(),
        best_place: diagnosis.best_place().map(MeasuredPlace::of),
        recording: Recorded::of(diagnosis),
        unnamed: diagnosis.is_unnamed(),
        error_at_ends: diagnosis.end_errors(&diagnosis.search.repaired),
        farthest_quantity: diagnosis
            .farthest_quantity()
            .map(|(path, deviations)| FarthestQuantity { path, deviations }),
        swapped_points: diagnosis.swapped_points(),
        remarks: diagnosis.remarks(),
        model_error: ModelErrors::of(diagnosis),
        departures: &diagnosis.departures,
        tried: &diagnosis.tried,
        stopped: &diagnosis.stopped,
        contradictory: &diagnosis.contradictory,
        early_end: diagnosis.early_end,
        sensors_taken_off: diagnosis
            .sensors_off
            .iter()
            .map(|sensor| SensorOff { place: sensor.place.to_string(), mass: sensor.value(0) })
            .collect(),
        drift: diagnosis.drift.as_ref().map(|drift| with_sentence(drift, drift.says())),
        modes: diagnosis.baseline.as_ref().map(|baseline| baseline.modes.as_slice()),
    })
}

#[derive(Serialize)]
struct DiagnosisFile<'a> {
    verdict: Verdict,
    says: String,
    mismatch: Mismatch<'a>,
    findings: Vec<Value>,
    fit: Errors<'a>,
    refitted: Vec<Quantity<'a>>,
    repaired: Vec<Quantity<'a>>,
    locations: Vec<Place<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    best_place: Option<MeasuredPlace<'a>>,
    recording: Recorded<'a>,
    /// Whether no finding is likelier than something that is not listed.
    unnamed: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    error_at_ends: Option<EndErrors>,
    #[serde(skip_serializing_if = "Option::is_none")]
    #[serde(rename = "bent")]
    farthest_quantity: Option<FarthestQuantity<'a>>,
    swapped_points: Vec<[&'a str; 2]>,
    remarks: Vec<String>,
    model_error: ModelErrors,
    departures: &'a [Departure],
    tried: &'a [Tried],
    /// What the search did not come to within its limit.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    stopped: &'a [&'static str],
    /// Bands, Hz, left out since their lines contradict all others.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    contradictory: &'a [(f64, f64)],
    /// Where records ended, where the structure still rang.
    #[serde(skip_serializing_if = "Option::is_none")]
    early_end: Option<RecordEnd>,
    /// Stated sensors whose mass was taken off the FRFs.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    sensors_taken_off: Vec<SensorOff>,
    /// How the structure changed from reference to reference.
    #[serde(skip_serializing_if = "Option::is_none")]
    drift: Option<Value>,
    /// The modes then and now, with a baseline.
    #[serde(skip_serializing_if = "Option::is_none")]
    modes: Option<&'a [ModeChange]>,
}

/// A sensor and its mass, kg.
#[derive(Serialize)]
struct SensorOff {
    place: String,
    mass: f64,
}

/// Error of the repaired model, and of the refitted one; zero where the noise explains what is left.
#[derive(Serialize)]
struct ModelErrors {
    #[serde(flatten)]
    repaired: ModelError,
    refitted: ModelError,
    #[serde(skip_serializing_if = "Option::is_none")]
    baseline: Option<ModelError>,
    /// What of it the fixture states.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    stated: BTreeMap<&'static str, f64>,
}

impl ModelErrors {
    fn of(diagnosis: &Diagnosis) -> Self {
        let [refitted, repaired] = diagnosis.model_error.unwrap_or_default();
        let stated = diagnosis.baseline_error.as_ref().unwrap_or(&repaired).stated.by_key().collect();
        ModelErrors { repaired, refitted, baseline: diagnosis.baseline_error, stated }
    }
}

/// The quantity that the refit without effects took farthest from what is stated, beyond belief.
#[derive(Serialize)]
struct FarthestQuantity<'a> {
    path: &'a str,
    deviations: f64,
}

#[derive(Serialize)]
struct Mismatch<'a> {
    chi2_per_dof: f64,
    p_value: f64,
    frfs: &'a [FrfMismatch],
}

#[derive(Serialize)]
struct Errors<'a> {
    #[serde(serialize_with = "by_model")]
    nrmse: [f64; 3],
    held_out: Option<&'a HeldOut>,
    #[serde(serialize_with = "by_model")]
    chi2_per_dof: [f64; 3],
    residual_correlation: f64,
    residuals_are_white: bool,
}

fn finding(finding: &Finding) -> Value {
    let mut entry = with_sentence(finding, finding.says());
    entry["doubtful"] = Value::Bool(finding.is_doubtful());
    if let Some(measured) = &finding.evidence.measured {
        entry["measured"] = value(MeasuredPlace::of(measured));
    }
    entry
}

fn quantities(hypothesis: &Hypothesis) -> Vec<Quantity<'_>> {
    let all = hypothesis.tolerances().iter().enumerate().map(|(index, tolerance)| {
        Quantity::of(&tolerance.quantity, hypothesis.ended_at(index), hypothesis.deviations(index))
    });
    all.collect()
}

#[derive(Serialize)]
struct Place<'a> {
    place: String,
    #[serde(flatten)]
    left: &'a Location,
}

impl<'a> Place<'a> {
    fn of(location: &'a Location) -> Self {
        Place { place: location.site.says(), left: location }
    }
}

/// A place with the δ(ω) measured there and the laws tried on it.
#[derive(Serialize)]
struct MeasuredPlace<'a> {
    #[serde(flatten)]
    place: Place<'a>,
    unit: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    variation: Option<Variation>,
    laws: &'a [LawFit],
    delta: &'a [LineEstimate],
}

impl<'a> MeasuredPlace<'a> {
    fn of(location: &'a Location) -> Self {
        MeasuredPlace {
            place: Place::of(location),
            unit: location.site.unit(),
            variation: location.variation(),
            laws: &location.laws,
            delta: &location.delta,
        }
    }
}

/// What the diagnosis rests on.
#[derive(Serialize)]
struct Recorded<'a> {
    frfs: &'a [FrfPair],
    lines: usize,
    from: Option<f64>,
    to: Option<f64>,
    values_in_use: usize,
    #[serde(serialize_with = "by_frf")]
    noise_from: (&'a [FrfPair], &'a [NoiseSource]),
}

impl<'a> Recorded<'a> {
    fn of(diagnosis: &'a Diagnosis) -> Self {
        let observation = &diagnosis.observation;
        let hz = observation.lines().hz();
        Recorded {
            frfs: observation.pairs(),
            lines: hz.len(),
            from: hz.first().copied(),
            to: hz.last().copied(),
            values_in_use: observation.degrees(),
            noise_from: (observation.pairs(), observation.noise()),
        }
    }
}

/// One entry an FRF.
pub(crate) fn by_frf<T: Serialize, S: Serializer>(
    (pairs, values): &(&[FrfPair], &[T]),
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(pairs.iter().zip(*values))
}
