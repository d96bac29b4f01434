//! `diagnosis.json` of stepped sines at several levels, with what each level says.

use crate::file::{value, with_sentence};
use jointscope_findings::{HeldOut, Verdict, by_model};
use jointscope_nonlinear::{LevelFinding, LevelResult, SteppedDiagnosis, TriedForm};
use jointscope_spectra::Dof;
use jointscope_wording::{Remarks, Says};
use serde::Serialize;
use serde_json::Value;

/// The contents of `diagnosis.json` for stepped-sine FRFs at several levels: as [`crate::diagnosis_file`],
/// and beyond the contract the table `levels` and every law `tried`. Errors are root mean squares over the
/// levels.
pub(crate) fn stepped_file(diagnosis: &SteppedDiagnosis) -> Value {
    let [nominal, refitted, repaired, stiffness_of_its_own_a_level] = diagnosis.nrmse;
    let holds: Vec<String> =
        diagnosis.levels.iter().filter(|level| level.explained).map(|level| level.held.to_string()).collect();
    let finding = |finding: &LevelFinding| {
        let mut entry = with_sentence(finding, finding.says());
        entry["holds_at"] = value(&holds);
        entry
    };
    value(SteppedFile {
        verdict: diagnosis.verdict,
        says: diagnosis.says(),
        mismatch: Mismatch {
            chi2_per_dof: diagnosis.chi2_per_dof[1],
            p_value: diagnosis.change.0,
            ratio_of_variances: diagnosis.change.1,
            frfs: [],
        },
        findings: diagnosis.findings.iter().map(finding).collect(),
        fit: Errors {
            nrmse: RelativeErrors { nominal, refitted, repaired, stiffness_of_its_own_a_level },
            held_out: diagnosis.held_out.as_ref(),
            chi2_per_dof: diagnosis.chi2_per_dof,
        },
        levels: &diagnosis.levels,
        levels_explained: (!diagnosis.findings.is_empty())
            .then_some([diagnosis.holds, diagnosis.levels.len()]),
        place: Place { joint: &diagnosis.place.0, dof: diagnosis.place.1 },
        tried: &diagnosis.tried,
        band: diagnosis.band,
        remarks: diagnosis.remarks(),
    })
}

#[derive(Serialize)]
struct SteppedFile<'a> {
    verdict: Verdict,
    says: String,
    mismatch: Mismatch,
    findings: Vec<Value>,
    fit: Errors<'a>,
    levels: &'a [LevelResult],
    levels_explained: Option<[usize; 2]>,
    place: Place<'a>,
    tried: &'a [TriedForm],
    band: (f64, f64),
    remarks: Vec<String>,
}

#[derive(Serialize)]
struct Mismatch {
    chi2_per_dof: Option<f64>,
    p_value: f64,
    ratio_of_variances: f64,
    frfs: [(); 0],
}

#[derive(Serialize)]
struct Errors<'a> {
    nrmse: RelativeErrors,
    held_out: Option<&'a HeldOut>,
    #[serde(serialize_with = "by_model")]
    chi2_per_dof: [Option<f64>; 3],
}

#[derive(Serialize)]
struct RelativeErrors {
    nominal: f64,
    refitted: f64,
    repaired: f64,
    stiffness_of_its_own_a_level: f64,
}

#[derive(Serialize)]
struct Place<'a> {
    joint: &'a str,
    dof: Dof,
}
