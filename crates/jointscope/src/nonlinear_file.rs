//! `diagnosis.json` of hits of several strengths, where a joint may have a law of amplitude.

use crate::file::{Quantity, value, with_sentence};
use jointscope_diagnosis::Departure;
use jointscope_findings::{HeldOut, Verdict, by_model};
use jointscope_nonlinear::{
    FittedQuantity, ForceStateError, ForceStateMap, Homogeneity, ModelFit, NonlinearDiagnosis, Reach,
};
use jointscope_wording::{Remarks, Says};
use serde::Serialize;
use serde_json::Value;

/// The contents of `diagnosis.json` for a test by hits of several strengths: as [`crate::diagnosis_file`],
/// errors being those of the response histories, and beyond the contract the test of homogeneity, how far the
/// hits drive each joint, and what the force–state maps say.
pub(crate) fn nonlinear_file(diagnosis: &NonlinearDiagnosis) -> Value {
    let models = diagnosis.models.as_ref();
    value(NonlinearFile {
        verdict: diagnosis.verdict,
        says: diagnosis.says(),
        mismatch: Mismatch {
            chi2_per_dof: models.map(|[_, refitted, _]| refitted.chi2_per_dof),
            p_value: diagnosis.homogeneity.p_value,
            frfs: [],
        },
        findings: diagnosis.findings.iter().map(|finding| with_sentence(finding, finding.says())).collect(),
        fit: models.map(|models| Errors {
            nrmse: models.each_ref().map(|model| model.nrmse),
            held_out: diagnosis.held_out.as_ref(),
            chi2_per_dof: models.each_ref().map(|model| model.chi2_per_dof),
        }),
        refitted: models.map_or_else(Vec::new, |[_, refitted, _]| quantities(refitted)),
        repaired: models.map_or_else(Vec::new, |[.., repaired]| quantities(repaired)),
        departures: models.map_or_else(Vec::new, departures),
        homogeneity: &diagnosis.homogeneity,
        reach: &diagnosis.reach,
        force_state: diagnosis.maps.iter().map(Map::of).collect(),
        band: diagnosis.band,
        remarks: diagnosis.remarks(),
    })
}

#[derive(Serialize)]
struct NonlinearFile<'a> {
    verdict: Verdict,
    says: String,
    mismatch: Mismatch,
    findings: Vec<Value>,
    fit: Option<Errors<'a>>,
    refitted: Vec<Quantity<'a>>,
    repaired: Vec<Quantity<'a>>,
    departures: Vec<Departure>,
    homogeneity: &'a Homogeneity,
    reach: &'a [Reach],
    force_state: Vec<Map<'a>>,
    band: (f64, f64),
    remarks: Vec<String>,
}

#[derive(Serialize)]
struct Mismatch {
    chi2_per_dof: Option<f64>,
    p_value: f64,
    frfs: [(); 0],
}

#[derive(Serialize)]
struct Errors<'a> {
    #[serde(serialize_with = "by_model")]
    nrmse: [f64; 3],
    held_out: Option<&'a HeldOut>,
    #[serde(serialize_with = "by_model")]
    chi2_per_dof: [f64; 3],
}

fn quantities(model: &ModelFit) -> Vec<Quantity<'_>> {
    let all = model.quantities.iter();
    all.map(|quantity| Quantity::of(&quantity.stated, quantity.value, quantity.deviations)).collect()
}

/// What the repaired model still asks of the stated quantities.
fn departures([_, refitted, repaired]: &[ModelFit; 3]) -> Vec<Departure> {
    let refitted = |path: &str| refitted.quantities.iter().find(|quantity| quantity.stated.path == path);
    let departure = |FittedQuantity { stated, value, deviations, .. }: &FittedQuantity| {
        Some(Departure {
            path: stated.path.clone(),
            stated: stated.value,
            std: stated.std?,
            refitted: refitted(&stated.path)?.value,
            repaired: *value,
            deviations: *deviations,
        })
    };
    repaired.departed().into_iter().filter_map(departure).collect()
}

/// A force–state map, or why it cannot be drawn.
#[derive(Serialize)]
#[serde(untagged)]
enum Map<'a> {
    Drawn(&'a ForceStateMap),
    NotDrawn { not_drawn: String },
}

impl<'a> Map<'a> {
    fn of(map: &'a Result<ForceStateMap, ForceStateError>) -> Self {
        match map {
            Ok(map) => Map::Drawn(map),
            Err(why) => Map::NotDrawn { not_drawn: why.to_string() },
        }
    }
}
