use crate::diagnosis_file::named;
use jointscope_nonlinear::{
    Finding, ForceState, ForceStateError, ForceStateMap, ModelFit, MotionSource, NonlinearDiagnosis,
};
use serde_json::{Map, Value, json};

/// The contents of `diagnosis.json` for a test by hits of several strengths: as [`crate::diagnosis_file`], errors being those of the response
/// histories, and beyond the contract the test of homogeneity, how far the hits drive each joint,
/// and what the force–state maps say.
pub fn nonlinear_file(diagnosis: &NonlinearDiagnosis) -> Value {
    let homogeneity = &diagnosis.homogeneity;
    let refitted = diagnosis.models.as_ref().map(|[_, refitted, _]| refitted);
    let mut root = Map::new();
    root.insert("verdict".into(), json!(diagnosis.verdict.name()));
    root.insert("says".into(), json!(diagnosis.says()));
    root.insert(
        "mismatch".into(),
        json!({"chi2_per_dof": refitted.map(|m| m.chi2_per_dof), "p_value": homogeneity.p_value, "frfs": []}),
    );
    root.insert("findings".into(), diagnosis.findings.iter().map(finding).collect());
    root.insert("fit".into(), fit(diagnosis));
    root.insert("refitted".into(), tolerances(refitted));
    root.insert("repaired".into(), tolerances(diagnosis.models.as_ref().map(|[.., repaired]| repaired)));
    root.insert(
        "homogeneity".into(),
        json!({
            "p_value": homogeneity.p_value,
            "variance_ratio": homogeneity.ratio,
            "most_in_band": [homogeneity.band.0, homogeneity.band.1],
            "noise_from_repeats": homogeneity.from_repeats,
            "levels": homogeneity.levels.iter().map(|(peak, hits)| json!({"peak_force": peak, "hits": hits})).collect::<Value>(),
        }),
    );
    let reach = diagnosis.reach.iter().map(|r| {
        json!({"joint": r.joint, "dof": r.dof.name(), "largest_relative_motion": r.motion, "force_of_the_joint": r.force})
    });
    root.insert("reach".into(), reach.collect());
    root.insert("force_state".into(), diagnosis.maps.iter().map(force_state).collect());
    root.insert("band".into(), json!([diagnosis.band.0, diagnosis.band.1]));
    root.insert("remarks".into(), json!(diagnosis.remarks()));
    Value::Object(root)
}

fn force_state(map: &Result<ForceStateMap, ForceStateError>) -> Value {
    let map = match map {
        Ok(map) => map,
        Err(why) => return json!({"not_drawn": why.to_string()}),
    };
    let source = |source: MotionSource| match source {
        MotionSource::Sensors => "sensors",
        MotionSource::Momentum => "momentum",
        MotionSource::Model => "model",
    };
    let component =
        |c: &ForceState| json!({"dof": c.dof.name(), "explained": c.explained(), "dashpot": c.dashpot()});
    json!({
        "joint": map.joint,
        "hit": map.hit,
        "band": [map.band.0, map.band.1],
        "force_from_bodies": map.weighed,
        "motion_from": map.sources.iter().map(|(body, s)| (body.clone(), json!(source(*s)))).collect::<Map<_, _>>(),
        "components": map.components.iter().map(component).collect::<Value>(),
    })
}

fn finding(finding: &Finding) -> Value {
    let parameters = finding.estimates.iter().map(|e| {
        let value = json!({"value": e.value, "std": e.std, "ci95": e.interval, "unit": e.unit});
        (e.parameter.name.to_owned(), value)
    });
    let Finding { effect, probability, gain, alternatives, .. } = finding;
    let mut entry = named(effect, parameters, *probability, finding.says(), alternatives);
    entry.insert("gain_chi2".into(), json!(gain));
    entry.insert("largest_relative_motion".into(), json!(finding.reach));
    Value::Object(entry)
}

fn fit(diagnosis: &NonlinearDiagnosis) -> Value {
    let Some(models) = &diagnosis.models else { return Value::Null };
    let three = |of: &dyn Fn(&ModelFit) -> f64| json!({"nominal": of(&models[0]), "refitted": of(&models[1]), "repaired": of(&models[2])});
    let held_out = diagnosis.held_out.as_ref().map(|held| {
        json!({
            "what": held.hits.iter().map(|hit| format!("hit {hit}")).collect::<Vec<_>>(),
            "nrmse_refitted": held.nrmse_refitted,
            "nrmse_repaired": held.nrmse_repaired,
        })
    });
    json!({"nrmse": three(&|m| m.nrmse), "held_out": held_out, "chi2_per_dof": three(&|m| m.chi2_per_dof)})
}

fn tolerances(model: Option<&ModelFit>) -> Value {
    let Some(model) = model else { return json!([]) };
    let quantity = |(tolerance, departure): &(jointscope_nonlinear::Tolerance, f64)| {
        json!({
            "path": tolerance.path,
            "nominal": tolerance.nominal,
            "std": tolerance.std,
            "departure": tolerance.std.map(|_| departure),
        })
    };
    model.tolerances.iter().map(quantity).collect()
}
