use crate::diagnosis_file::named;
use jointscope_nonlinear::{Held, LevelFinding, LevelResult, SteppedDiagnosis};
use serde_json::{Value, json};

/// The contents of `diagnosis.json` for stepped-sine FRFs at several levels: as [`crate::diagnosis_file`], and beyond the contract the table
/// `levels` and every law `tried`. Errors are root mean squares over the levels.
pub fn stepped_file(diagnosis: &SteppedDiagnosis) -> Value {
    let [nominal, refitted, repaired, own] = diagnosis.nrmse;
    let [chi2_nominal, chi2_refitted, chi2_repaired] = diagnosis.chi2_per_dof;
    let count = diagnosis.levels.len();
    json!({
        "verdict": diagnosis.verdict.name(),
        "says": diagnosis.says(),
        "mismatch": { "chi2_per_dof": chi2_refitted, "p_value": diagnosis.change.0, "ratio_of_variances": diagnosis.change.1, "frfs": [] },
        "findings": diagnosis.findings.iter().map(|f| finding(f, diagnosis)).collect::<Value>(),
        "fit": {
            "nrmse": {"nominal": nominal, "refitted": refitted, "repaired": repaired, "stiffness_of_its_own_a_level": own},
            "held_out": diagnosis.left_out.map(|[refitted, repaired]| json!({
                "what": diagnosis.levels.iter().take(diagnosis.holds).map(|l| format!("level {}", l.held)).collect::<Value>(),
                "nrmse_refitted": refitted,
                "nrmse_repaired": repaired,
            })),
            "chi2_per_dof": {"nominal": chi2_nominal, "refitted": chi2_refitted, "repaired": chi2_repaired},
        },
        "levels": diagnosis.levels.iter().enumerate().map(|(i, l)| level(l, i < diagnosis.holds)).collect::<Value>(),
        "levels_explained": if diagnosis.findings.is_empty() { json!(null) } else { json!([diagnosis.holds, count]) },
        "place": {"joint": diagnosis.place.0, "dof": diagnosis.place.1.name()},
        "tried": diagnosis.tried.iter().map(|t| json!({
            "kind": t.form, "place": t.joint, "dof": t.dof.name(), "nrmse": t.nrmse, "share_explained": t.share,
        })).collect::<Value>(),
        "band": [diagnosis.band.0, diagnosis.band.1],
        "remarks": diagnosis.remarks(),
    })
}

fn level(of: &LevelResult, explained: bool) -> Value {
    let (quantity, unit) = match of.held {
        Held::Force(_) => ("force", "N"),
        Held::Response(_) => ("response", "m/s^2"),
    };
    let value = |(value, std): (f64, f64)| json!({"value": value, "std": std});
    let known = |(value, std): (f64, Option<f64>)| json!({"value": value, "std": std});
    let [nominal, refitted, repaired, own] = of.nrmse;
    json!({
        "held": {"quantity": quantity, "amplitude": of.held.amplitude(), "unit": unit},
        "frequency": value(of.resonance.frequency),
        "damping_ratio": value(of.resonance.damping_ratio),
        "nrmse_of_one_mode": of.resonance.nrmse,
        "relative_motion": of.motion,
        "stiffness_beyond_the_fixture": known(of.stiffness),
        "loss_stiffness_beyond_the_fixture": known(of.loss),
        "nrmse": {"nominal": nominal, "refitted": refitted, "repaired": repaired, "stiffness_of_its_own": own},
        "explained": explained,
    })
}

fn finding(of: &LevelFinding, diagnosis: &SteppedDiagnosis) -> Value {
    let parameters = of.estimates.iter().map(|e| {
        (
            e.parameter.name.to_owned(),
            json!({"value": e.value, "std": e.std, "ci95": e.interval, "unit": e.unit}),
        )
    });
    let mut entry = named(&of.effect, parameters, of.probability, of.says(), &of.alternatives);
    entry.insert("share_explained".into(), json!(of.share));
    entry.insert("relative_motions".into(), json!([of.motions.0, of.motions.1]));
    let holds = diagnosis.levels.iter().take(diagnosis.holds).map(|l| l.held.to_string());
    entry.insert("holds_at".into(), holds.collect());
    Value::Object(entry)
}
