//! The scores of cases of hits.

use super::{StruckJudged, StruckRole};
use crate::case::describe;
use crate::routes::score::{CaseLine, RouteScore, Size, SizeScore};
use crate::seal::Sealable;
use crate::statistics::{median, quantile};
use crate::{Figure, Name, Rate, Share, Target};
use serde_json::json;

/// Probability below which it is not told how small it is.
const LEAST: f64 = 1e-12;

/// Scores cases of hits.
pub(crate) fn score(judged: &[StruckJudged]) -> RouteScore {
    let of_role = |role: StruckRole| judged.iter().filter(move |case| case.truth.role == role);
    let asked = |role: StruckRole| if role == StruckRole::Law { of_role(role).count() } else { 0 };
    let sizes: Vec<Size> = judged.iter().flat_map(StruckJudged::sizes).collect();
    RouteScore {
        key: "struck",
        what: "hits over time on joints that may depend on amplitude",
        cases: StruckRole::ALL.map(|role| (role.name(), of_role(role).count(), asked(role))).to_vec(),
        rates: rates(judged, &sizes),
        figures: figures(judged),
        sizes: SizeScore::all(&sizes),
        lines: judged.iter().map(line).collect(),
    }
}

fn rates(judged: &[StruckJudged], sizes: &[Size]) -> Vec<Rate> {
    use Target::{AtLeast, AtMost, Within};
    let of_role = |role: StruckRole| judged.iter().filter(move |case| case.truth.role == role);
    let rate = |key, what, share, target| Rate { key, what, share, target };
    let worse = |[refitted, repaired]: [f64; 2]| repaired > refitted;
    let consistent = of_role(StruckRole::Linear).filter_map(StruckJudged::is_linearly_consistent);
    vec![
        rate(
            "linear_alarm",
            "linear structures called non-linear",
            Share::count(of_role(StruckRole::Linear), StruckJudged::is_noticed),
            Some(AtMost(0.01)),
        ),
        rate(
            "linear_consistent",
            "linear structures: fixture called consistent with the hits' FRFs",
            Share::count(consistent, |consistent| consistent),
            Some(AtLeast(0.95)),
        ),
        rate(
            "law_noticed",
            "laws: FRFs said to change with strength",
            Share::count(of_role(StruckRole::Law), StruckJudged::is_noticed),
            None,
        ),
        rate(
            "law_named",
            "laws: kind, joint and dof right, and no other law",
            Share::count(of_role(StruckRole::Law), StruckJudged::is_named),
            Some(AtLeast(0.95)),
        ),
        rate(
            "law_wrong",
            "laws: a law named that is not there",
            Share::count(of_role(StruckRole::Law), StruckJudged::has_extra),
            Some(AtMost(0.02)),
        ),
        rate(
            "idle_named",
            "laws that the hits do not exercise: a law named",
            Share::count(of_role(StruckRole::Idle), |case| !case.found().is_empty()),
            Some(AtMost(0.0)),
        ),
        rate(
            "sizes",
            "sizes within 10 % of the truth",
            Share::count(sizes, Size::is_right),
            Some(AtLeast(0.95)),
        ),
        rate(
            "coverage",
            "95 % intervals that hold the true size",
            Share::count(sizes, Size::is_held),
            Some(Within(0.92, 0.98)),
        ),
        rate(
            "held_out_worse",
            "hits held out: repaired worse than refitted",
            Share::count(held_out(judged.iter()), worse),
            Some(AtMost(0.01)),
        ),
    ]
}

fn figures(judged: &[StruckJudged]) -> Vec<Figure> {
    let named = judged.iter().filter(|case| case.is_named());
    let ratios: Vec<f64> = held_out(named).map(|[refitted, repaired]| refitted / repaired).collect();
    let figure = |key, what, value, target| Figure { key, what, value, from: ratios.len(), target };
    vec![
        figure(
            "held_out_ratio",
            "hits held out, right names: median error refitted over repaired",
            median(&ratios),
            Some(Target::AtLeast(10.0)),
        ),
        figure("held_out_least", "the same: the least", quantile(&ratios, 0.0), None),
    ]
}

fn held_out<'a>(judged: impl Iterator<Item = &'a StruckJudged>) -> impl Iterator<Item = [f64; 2]> {
    judged.filter_map(|case| case.answer.as_ref().ok()?.held_out)
}

fn line(case: &StruckJudged) -> CaseLine {
    let told = case.found().iter().map(|found| {
        let mark = if case.is_hidden(found) { "= " } else { "" };
        format!("{mark}{} ({:.2})", Name::of(&found.effect), found.probability)
    });
    let told: Vec<String> = told.collect();
    let mut details: Vec<String> = Vec::new();
    for found in case.found() {
        details.push(format!("  p={:.3} {}", found.probability, describe(&found.effect)));
        details.extend(
            found.alternatives.iter().map(|(effect, p)| format!("    or p={p:.3} {}", describe(effect))),
        );
    }
    let (mut verdict, mut size) = (String::new(), String::new());
    match &case.answer {
        Err(why) => verdict.push_str(&format!("no answer: {why}")),
        Ok(answer) => {
            verdict.push_str(&answer.verdict.name().replace('_', " "));
            size = match answer.p_value {
                p if p < LEAST => format!("p < {LEAST:.0e}"),
                p => format!("p = {p:.0e}"),
            };
            if let Some([stated, refitted, repaired]) = answer.chi2_per_dof {
                details.push(format!("χ² per degree of freedom: {stated:.3e} stated, {refitted:.3e} refitted, {repaired:.3e} repaired"));
            }
            if let Some([refitted, repaired]) = answer.held_out {
                details
                    .push(format!("hits held out: error {refitted:.2e} refitted, {repaired:.2e} repaired"));
            }
            if let Some(linear) = &answer.linear {
                verdict.push_str(&format!("; FRFs {}", linear.verdict.name().replace('_', " ")));
                let names = linear
                    .findings
                    .iter()
                    .map(|f| format!("  FRFs: p={:.3} {}", f.probability, describe(&f.effect)));
                details.extend(names);
                details.push(format!(
                    "FRFs: χ² per degree of freedom {:.3} refitted, {:.3} repaired",
                    linear.chi2_per_dof[1], linear.chi2_per_dof[2]
                ));
            }
        }
    }
    for size in case.sizes() {
        let held = if size.is_held() { "" } else { ", not in its interval" };
        details.push(format!("{}: {:+.2} % off{held}", size.what, 100.0 * size.error()));
    }
    let faults = case.faults();
    CaseLine {
        index: case.truth.index,
        hidden: case.truth.hidden(),
        size,
        value: json!({
            "truth": case.truth.to_value(),
            "verdict": case.answer.as_ref().map(|answer| answer.verdict.name()).ok(),
            "p_value": case.answer.as_ref().map(|answer| answer.p_value).ok(),
            "found": case.found().iter().map(|found| json!({
                "name": Name::of(&found.effect).to_string(), "probability": found.probability, "true": case.is_hidden(found),
            })).collect::<Vec<_>>(),
            "linear_verdict": case.answer.iter().filter_map(|answer| answer.linear.as_ref()).map(|l| l.verdict.name()).next(),
            "faults": faults,
            "sizes": case.sizes().iter().map(Size::to_value).collect::<Vec<_>>(),
            "held_out": case.answer.iter().filter_map(|answer| answer.held_out).next(),
        }),
        verdict,
        found: if told.is_empty() { "nothing".to_owned() } else { told.join(", ") },
        answered: case.answer.is_ok(),
        asked: true,
        faults,
        details,
    }
}
