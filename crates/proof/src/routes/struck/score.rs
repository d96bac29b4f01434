//! The scores of cases of hits.

use super::{StruckJudged, StruckRole};
use crate::case_line::{errors, in_full, is_worse, marked, named};
use crate::name::describe;
use crate::sealable::Sealable;
use crate::sheet::Line;
use crate::sheet::Target::{AtLeast, AtMost, Within};
use crate::size::{Size, SizeScore};
use crate::statistics::{middle, quantile};
use crate::{CaseLine, Found, Rate, RoleCount, ScoredFigure, Share, Sheet};
use serde_json::json;

/// Probability below which it is not told how small it is.
const LEAST: f64 = 1e-12;

const RATES: [Line; 9] = [
    ("linear_alarm", "linear structures called non-linear", Some(AtMost(0.01))),
    (
        "linear_consistent",
        "linear structures: fixture called consistent with the hits' FRFs",
        Some(AtLeast(0.95)),
    ),
    ("law_noticed", "laws: FRFs said to change with strength", None),
    ("law_named", "laws: kind, joint and dof right, and no other law", Some(AtLeast(0.95))),
    ("law_wrong", "laws: a law named that is not there", Some(AtMost(0.02))),
    ("idle_named", "laws that the hits do not exercise: a law named", Some(AtMost(0.0))),
    ("sizes", "sizes within 10 % of the truth", Some(AtLeast(0.95))),
    ("coverage", "95 % intervals that hold the true size", Some(Within(0.92, 0.98))),
    ("held_out_worse", "hits held out: repaired worse than refitted", Some(AtMost(0.01))),
];

const HELD_OUT: &str = "hits held out, right names: median error refitted over repaired";
const FIGURES: [Line; 2] =
    [("held_out_ratio", HELD_OUT, Some(AtLeast(10.0))), ("held_out_least", "the same: the least", None)];

/// Scores cases of hits.
pub(crate) fn score(judged: &[StruckJudged]) -> (Sheet, Vec<SizeScore>) {
    let sizes: Vec<Size> = judged.iter().flat_map(StruckJudged::sizes).collect();
    let roles = StruckRole::ALL.map(|role| {
        let cases = judged.iter().filter(|case| case.truth.role == role).count();
        let asked = if role == StruckRole::Law { cases } else { 0 };
        RoleCount { role: role.name(), cases, visible: None, asked: Some(asked) }
    });
    let named = judged.iter().filter(|case| case.is_named());
    let ratios: Vec<f64> = held_out(named).map(|[refitted, repaired]| refitted / repaired).collect();
    let sheet = Sheet {
        roles: roles.to_vec(),
        rates: Rate::all(&RATES, |key| share(judged, &sizes, key)),
        figures: ScoredFigure::all(&FIGURES, |key| match key {
            "held_out_ratio" => middle(ratios.iter().copied()),
            "held_out_least" => (quantile(&ratios, 0.0), ratios.len()),
            _ => (None, 0),
        }),
        lines: judged.iter().map(line).collect(),
    };
    (sheet, SizeScore::all(&sizes))
}

/// The share of a key of [`RATES`].
fn share(judged: &[StruckJudged], sizes: &[Size], key: &str) -> Share {
    let of_role = |role: StruckRole| judged.iter().filter(move |case| case.truth.role == role);
    match key {
        "linear_alarm" => Share::count(of_role(StruckRole::Linear), StruckJudged::is_noticed),
        "linear_consistent" => {
            let consistent = of_role(StruckRole::Linear).filter_map(StruckJudged::is_linearly_consistent);
            Share::count(consistent, |consistent| consistent)
        }
        "law_noticed" => Share::count(of_role(StruckRole::Law), StruckJudged::is_noticed),
        "law_named" => Share::count(of_role(StruckRole::Law), StruckJudged::is_named),
        "law_wrong" => Share::count(of_role(StruckRole::Law), StruckJudged::has_extra),
        "idle_named" => Share::count(of_role(StruckRole::Idle), |case| !case.findings().is_empty()),
        "sizes" => Share::count(sizes, Size::is_right),
        "coverage" => Share::count(sizes, Size::is_held),
        "held_out_worse" => Share::count(held_out(judged.iter()), is_worse),
        _ => Share::default(),
    }
}

fn held_out<'a>(judged: impl Iterator<Item = &'a StruckJudged>) -> impl Iterator<Item = [f64; 2]> {
    judged.filter_map(|case| case.answer.as_ref().ok()?.held_out)
}

fn line(case: &StruckJudged) -> CaseLine {
    let is_hidden = |found: &Found| case.is_hidden(found);
    let answer = case.answer.as_ref().ok();
    let linear = answer.and_then(|answer| answer.linear.as_ref());
    let mut details = in_full(case.findings());
    if let Some([stated, refitted, repaired]) = answer.and_then(|answer| answer.chi2_per_dof) {
        details.push(format!(
            "χ² per degree of freedom: {stated:.3e} stated, {refitted:.3e} refitted, {repaired:.3e} repaired"
        ));
    }
    details.extend(errors("hits held out", answer.and_then(|answer| answer.held_out)));
    if let Some(linear) = linear {
        let names = linear.findings.iter();
        details.extend(names.map(|f| format!("  FRFs: p={:.3} {}", f.probability, describe(&f.effect))));
        let [_, refitted, repaired] = linear.chi2_per_dof;
        details
            .push(format!("FRFs: χ² per degree of freedom {refitted:.3} refitted, {repaired:.3} repaired"));
    }
    let sizes = case.sizes();
    details.extend(sizes.iter().map(Size::says));
    let says = |name: &str| name.replace('_', " ");
    let of_frfs = linear.map_or_else(String::new, |l| format!("; FRFs {}", says(l.verdict.name())));
    let faults = case.faults();
    CaseLine {
        index: case.truth.index,
        role: String::new(),
        hidden: case.truth.hidden(),
        size: answer.map_or_else(String::new, |answer| match answer.p_value {
            Some(p) if p < LEAST => format!("p < {LEAST:.0e}"),
            Some(p) => format!("p = {p:.0e}"),
            None => "not judged".to_owned(),
        }),
        verdict: match &case.answer {
            Ok(answer) => format!("{}{of_frfs}", says(answer.verdict.name())),
            Err(why) => format!("no answer: {why}"),
        },
        found: marked(case.findings(), |found| if case.is_hidden(found) { "= " } else { "" }),
        answered: answer.is_some(),
        asked: true,
        details,
        value: json!({
            "truth": case.truth.to_value(),
            "verdict": answer.map(|answer| answer.verdict.name()),
            "p_value": answer.map(|answer| answer.p_value),
            "found": named(case.findings(), is_hidden),
            "linear_verdict": linear.map(|linear| linear.verdict.name()),
            "faults": faults,
            "sizes": sizes,
            "held_out": answer.and_then(|answer| answer.held_out),
        }),
        faults,
    }
}
