use jointscope_diagnosis::{
    Diagnosis, Estimate, Finding, Hypothesis, LawFit, LawParameter, LineEstimate, Location,
};
use jointscope_fixture::Effect;
use jointscope_frf::noise::NoiseSource;
use serde_json::{Map, Value, json};

/// The contents of `diagnosis.json`: verdict, mismatch, findings with intervals and alternatives, errors of the three models, and beyond the
/// contract where the tolerances ended, where each FRF's noise came from, and what every place leaves unexplained. SI units; what is not
/// finite is `null`.
pub fn diagnosis_file(diagnosis: &Diagnosis) -> Value {
    let mut root = Map::new();
    root.insert("verdict".into(), json!(diagnosis.verdict.name()));
    root.insert("says".into(), json!(diagnosis.says()));
    root.insert("mismatch".into(), mismatch(diagnosis));
    root.insert("findings".into(), diagnosis.findings.iter().map(finding).collect());
    root.insert("fit".into(), fit(diagnosis));
    root.insert("refitted".into(), tolerances(&diagnosis.search.refitted.hypothesis));
    root.insert("repaired".into(), tolerances(&diagnosis.search.repaired.hypothesis));
    root.insert("locations".into(), diagnosis.locations.iter().map(location).collect());
    if let Some(best) = diagnosis.locations.first().filter(|_| diagnosis.is_unnamed()) {
        root.insert("best_place".into(), with_delta(best));
    }
    root.insert("recording".into(), recording(diagnosis));
    root.insert("remarks".into(), json!(diagnosis.remarks()));
    Value::Object(root)
}

fn mismatch(diagnosis: &Diagnosis) -> Value {
    let band = |&(from, to, share): &(f64, f64, f64)| json!({"from": from, "to": to, "share": share});
    let frfs = diagnosis.mismatch.iter().map(|of| {
        json!({
            "frf": of.frf.to_string(),
            "nrmse": of.nrmse,
            "bands": of.bands.iter().map(band).collect::<Value>(),
        })
    });
    let (chi2_per_dof, p_value) = diagnosis.refitted;
    json!({"chi2_per_dof": chi2_per_dof, "p_value": p_value, "frfs": frfs.collect::<Value>()})
}

/// `kind`, `place` and, for the kinds that have one, `dof`.
fn name(effect: &Effect) -> Map<String, Value> {
    let mut entry = Map::new();
    entry.insert("kind".into(), json!(effect.kind.name()));
    entry.insert("place".into(), json!(effect.place.to_string()));
    if let Some(dof) = effect.dof {
        entry.insert("dof".into(), json!(dof.name()));
    }
    entry
}

/// What an entry of `findings` holds whatever the law: names, parameters, probability, sentence, alternatives.
pub(crate) fn named(
    effect: &Effect,
    parameters: impl Iterator<Item = (String, Value)>,
    probability: f64,
    says: String,
    alternatives: &[(Effect, f64)],
) -> Map<String, Value> {
    let mut entry = name(effect);
    entry.insert("parameters".into(), Value::Object(parameters.collect()));
    entry.insert("probability".into(), json!(probability));
    entry.insert("says".into(), json!(says));
    let alternatives = alternatives.iter().map(|(effect, probability)| {
        let mut entry = name(effect);
        entry.insert("probability".into(), json!(probability));
        Value::Object(entry)
    });
    entry.insert("alternatives".into(), alternatives.collect());
    entry
}

fn finding(finding: &Finding) -> Value {
    let parameters = finding.estimates.iter().map(|e: &Estimate| {
        let value = json!({"value": e.value, "std": e.std, "ci95": e.interval, "unit": e.unit});
        (e.parameter.name.to_owned(), value)
    });
    let Finding { effect, probability, gain, alternatives, .. } = finding;
    let mut entry = named(effect, parameters, *probability, finding.says(), alternatives);
    entry.insert("gain_chi2".into(), json!(gain));
    if let Some(measured) = &finding.measured {
        entry.insert("measured".into(), with_delta(measured));
    }
    Value::Object(entry)
}

fn fit(diagnosis: &Diagnosis) -> Value {
    let three = |[nominal, refitted, repaired]: [f64; 3]| json!({"nominal": nominal, "refitted": refitted, "repaired": repaired});
    let held_out = diagnosis.held_out.as_ref().map(|held_out| {
        json!({
            "what": held_out.what,
            "nrmse_refitted": held_out.nrmse_refitted,
            "nrmse_repaired": held_out.nrmse_repaired,
            "same_findings": held_out.same_findings,
        })
    });
    json!({
        "nrmse": three(diagnosis.nrmse()),
        "held_out": held_out,
        "chi2_per_dof": three(diagnosis.chi2_per_dof()),
        "residual_correlation": diagnosis.residual_correlation,
    })
}

/// Where the quantities that may move ended, in their units and in standard deviations of their priors.
fn tolerances(hypothesis: &Hypothesis) -> Value {
    let quantity = |(index, tolerance): (usize, &jointscope_diagnosis::Tolerance)| {
        json!({
            "path": tolerance.path,
            "nominal": tolerance.nominal,
            "std": tolerance.std,
            "value": hypothesis.ended_at(index),
            "departure": tolerance.std.map(|_| hypothesis.departure(index)),
            "unit": tolerance.unit(),
        })
    };
    hypothesis.tolerances().iter().enumerate().map(quantity).collect()
}

fn location(location: &Location) -> Value {
    let band = |&(from, to, chi2): &(f64, f64, f64)| json!({"from": from, "to": to, "chi2_per_dof": chi2});
    json!({
        "place": location.site.says(),
        "chi2_per_dof": location.chi2_per_dof,
        "degrees": location.degrees,
        "p_value": location.p_value,
        "bands": location.bands.iter().map(band).collect::<Value>(),
    })
}

/// A place with the δ(ω) measured there and the laws tried on it.
fn with_delta(of: &Location) -> Value {
    let line =
        |d: &LineEstimate| json!({"frequency": d.frequency, "value": [d.value.re, d.value.im], "std": d.std});
    let parameter =
        |p: &LawParameter| (p.name.to_owned(), json!({"value": p.value, "std": p.std, "unit": p.unit}));
    let law = |law: &LawFit| {
        json!({
            "law": law.name,
            "formula": law.formula,
            "parameters": Value::Object(law.parameters.iter().map(parameter).collect()),
            "chi2_per_dof": law.chi2_per_dof,
        })
    };
    let mut entry = location(of);
    entry["unit"] = json!(of.site.unit());
    entry["laws"] = of.laws.iter().map(law).collect();
    entry["delta"] = of.delta.iter().map(line).collect();
    entry
}

fn recording(diagnosis: &Diagnosis) -> Value {
    let observation = &diagnosis.observation;
    let hz = observation.lines().hz();
    let frfs: Vec<String> = observation.pairs().iter().map(ToString::to_string).collect();
    let source = |(frf, source): (&String, &NoiseSource)| {
        let source = match source {
            NoiseSource::Coherence => "coherence and averages",
            NoiseSource::Scatter => "scatter over the lines",
        };
        (frf.clone(), json!(source))
    };
    json!({
        "frfs": frfs,
        "lines": hz.len(),
        "from": hz.first(),
        "to": hz.last(),
        "values_in_use": observation.degrees(),
        "noise_from": Value::Object(frfs.iter().zip(observation.noise()).map(source).collect()),
    })
}
