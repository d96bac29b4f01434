//! The scores of solid cases.

use super::SolidJudged;
use super::judged::are_the_same;
use crate::case::describe;
use crate::routes::score::{CaseLine, RouteScore, Size, SizeScore};
use crate::seal::Sealable;
use crate::statistics::median;
use crate::{Figure, Found, Name, Rate, Role, Share, Target};
use jointscope_diagnosis::Verdict;
use jointscope_fixture::{Effect, EffectKind};
use serde_json::json;

/// Stated probability at which a wrong name is a fault.
const CLAIMED: f64 = 0.9;

/// Scores solid cases.
pub(crate) fn score(judged: &[SolidJudged]) -> RouteScore {
    let of_role = |role: Role| judged.iter().filter(move |case| case.truth.role == role);
    let cases = [Role::Null, Role::Single, Role::Double].map(|role| {
        (role.name(), of_role(role).count(), of_role(role).filter(|case| case.is_visible()).count())
    });
    let sizes: Vec<Size> = judged.iter().filter(|case| case.is_visible()).flat_map(sizes).collect();
    RouteScore {
        key: "solid",
        what: "recordings of the finite-element twin of two solid blocks on a strip",
        cases: cases.to_vec(),
        rates: rates(judged, &sizes),
        figures: figures(judged),
        sizes: SizeScore::all(&sizes),
        lines: judged.iter().map(line).collect(),
    }
}

fn rates(judged: &[SolidJudged], sizes: &[Size]) -> Vec<Rate> {
    use Target::{AtLeast, AtMost, Within};
    let of_role = |role: Role| judged.iter().filter(move |case| case.truth.role == role);
    let visible = |role: Role| of_role(role).filter(|case| case.is_visible());
    let rate = |key, what, share, target| Rate { key, what, share, target };
    let worse = |[refitted, repaired]: [f64; 2]| repaired > refitted;
    let consistent =
        |case: &SolidJudged| case.answer.as_ref().is_ok_and(|answer| answer.verdict == Verdict::Consistent);
    let claimed = |case: &SolidJudged| {
        let wrong = |found: &&Found| found.probability >= CLAIMED && !case.is_true(&found.effect);
        case.answer.iter().flat_map(|answer| &answer.findings).any(|found| wrong(&found))
    };
    vec![
        rate(
            "nulls_consistent",
            "nulls called consistent",
            Share::count(of_role(Role::Null), consistent),
            Some(AtLeast(0.99)),
        ),
        rate(
            "null_finding",
            "nulls with a finding: false alarms",
            Share::count(of_role(Role::Null), |case| !case.found().is_empty()),
            Some(AtMost(0.01)),
        ),
        rate(
            "single_kind",
            "single effects: kind right",
            Share::count(visible(Role::Single), SolidJudged::has_kind),
            Some(AtLeast(0.97)),
        ),
        rate(
            "single_place",
            "single effects: kind, place and dof right",
            Share::count(visible(Role::Single), SolidJudged::is_named),
            Some(AtLeast(0.97)),
        ),
        rate(
            "single_extra",
            "single effects: an extra finding",
            Share::count(visible(Role::Single), SolidJudged::has_extra),
            Some(AtMost(0.05)),
        ),
        rate(
            "double_both",
            "two effects: both right",
            Share::count(visible(Role::Double), SolidJudged::is_named),
            Some(AtLeast(0.85)),
        ),
        rate(
            "wrong_name",
            "a name with 0.9 or more that is not in the solid",
            Share::count(judged, claimed),
            Some(AtMost(0.02)),
        ),
        rate(
            "sizes",
            "sizes found within 10 % of the closed form",
            Share::count(sizes, Size::is_right),
            None,
        ),
        rate(
            "coverage",
            "95 % intervals that hold the closed form",
            Share::count(sizes, Size::is_held),
            Some(Within(0.92, 0.98)),
        ),
        rate(
            "unseen_worse",
            "FRFs at points nobody measured: repaired worse than refitted",
            Share::count(judged.iter().filter_map(|case| case.evidence.unseen), worse),
            Some(AtMost(0.01)),
        ),
    ]
}

fn figures(judged: &[SolidJudged]) -> Vec<Figure> {
    let shown = || judged.iter().filter(|case| case.is_visible());
    let ratio = |[refitted, repaired]: [f64; 2]| refitted / repaired;
    let unseen: Vec<[f64; 2]> = shown().filter_map(|case| case.evidence.unseen).collect();
    let ratios: Vec<f64> = unseen.iter().copied().map(ratio).collect();
    let repaired: Vec<f64> = unseen.iter().map(|errors| 100.0 * errors[1]).collect();
    let held: Vec<f64> = shown().filter_map(|case| case.answer.as_ref().ok()?.held_out).map(ratio).collect();
    let figure = |key, what, values: &[f64], target| Figure {
        key,
        what,
        value: median(values),
        from: values.len(),
        target,
    };
    vec![
        figure("held_out_ratio", "held-out lines: median error refitted over repaired", &held, None),
        figure(
            "unseen_ratio",
            "FRFs at points nobody measured: median error refitted over repaired",
            &ratios,
            Some(Target::AtLeast(10.0)),
        ),
        figure("unseen_repaired", "the same: median error repaired, %", &repaired, None),
    ]
}

/// Sizes of hidden effects that were found.
fn sizes(case: &SolidJudged) -> Vec<Size> {
    let Ok(answer) = &case.answer else { return Vec::new() };
    let mut all = Vec::new();
    for hidden in case.truth.effects() {
        let Some(found) = answer.findings.iter().find(|found| are_the_same(hidden, &found.effect)) else {
            continue;
        };
        if Name::of(hidden) != Name::of(&found.effect) {
            all.push(across(hidden, found, case));
            continue;
        }
        for (index, parameter) in hidden.kind.spec().parameters.iter().enumerate() {
            // The solid's layers have no dashpot, its strips no rotary inertia of a name; an abscissa has no relative error.
            if hidden.value(index) == 0.0 || parameter.name == "x" {
                continue;
            }
            let dof = hidden.dof.map_or_else(String::new, |dof| format!(" in {}", dof.name()));
            all.push(Size {
                what: format!("{}{dof}: {}", hidden.kind.name(), parameter.name),
                truth: hidden.value(index),
                found: found.effect.value(index),
                interval: found.intervals.get(index).copied().flatten(),
            });
        }
    }
    all
}

/// A spring across the strip by another name: k = κGA/L.
fn across(hidden: &Effect, found: &Found, case: &SolidJudged) -> Size {
    let length =
        case.truth.lumped.joints().first().map_or(1.0, |joint| case.truth.lumped.joint_length(joint));
    let over = |effect: &Effect| if effect.kind == EffectKind::ShearDeformation { length } else { 1.0 };
    let by = over(&found.effect);
    Size {
        what: "a spring across the strip by another name: stiffness".to_owned(),
        truth: hidden.value(0) / over(hidden),
        found: found.effect.value(0) / by,
        interval: found.intervals.first().copied().flatten().map(|ends| ends.map(|end| end / by)),
    }
}

fn line(case: &SolidJudged) -> CaseLine {
    let findings: Vec<&Found> = case.answer.iter().flat_map(|answer| &answer.findings).collect();
    let told = findings.iter().map(|found| {
        let name = Name::of(&found.effect);
        let hidden = case.truth.effects().iter().any(|effect| Name::of(effect) == name);
        let mark = match (hidden, case.is_true(&found.effect)) {
            (true, _) => "= ",
            (false, true) => "≈ ",
            (false, false) => "",
        };
        format!("{mark}{name} ({:.2})", found.probability)
    });
    let told: Vec<String> = told.collect();
    let evidence = &case.evidence;
    let mut details: Vec<String> = Vec::new();
    for found in &findings {
        details.push(format!("  p={:.3} {}", found.probability, describe(&found.effect)));
        let others = found.alternatives.iter();
        details.extend(others.map(|(effect, p)| format!("    or p={p:.3} {}", describe(effect))));
    }
    details.push(format!(
        "objective: refitted {:.1}, repaired {:.1}, fit from the closed form {:.1}, the solid's own FRFs {:.1}",
        evidence.refitted, evidence.repaired, evidence.lumped, evidence.truth
    ));
    for size in sizes(case) {
        details.push(format!(
            "{}: {:+.2} % off{}",
            size.what,
            100.0 * size.error(),
            if size.is_held() { "" } else { ", not in its interval" }
        ));
    }
    if let Some([refitted, repaired]) = evidence.unseen {
        details.push(format!("FRFs at other points: error {refitted:.2e} refitted, {repaired:.2e} repaired"));
    }
    let verdict = match &case.answer {
        Ok(answer) => answer.verdict.name().replace('_', " "),
        Err(why) => format!("no answer: {why}"),
    };
    let faults = case.faults();
    CaseLine {
        index: case.truth.index,
        hidden: case.truth.hidden(),
        size: if case.truth.role == Role::Null { String::new() } else { format!("{:.0}", case.size()) },
        value: json!({
            "truth": case.truth.to_value(),
            "verdict": case.answer.as_ref().map(|answer| answer.verdict.name()).ok(),
            "found": findings.iter().map(|found| json!({
                "name": Name::of(&found.effect).to_string(), "probability": found.probability,
                "true": case.is_true(&found.effect),
            })).collect::<Vec<_>>(),
            "visible": case.is_visible(),
            "faults": faults,
            "objectives": {
                "refitted": evidence.refitted, "repaired": evidence.repaired, "lumped": evidence.lumped,
                "truth": evidence.truth, "without": evidence.without,
            },
            "sizes": sizes(case).iter().map(Size::to_value).collect::<Vec<_>>(),
            "unseen": evidence.unseen,
        }),
        verdict,
        found: if told.is_empty() { "nothing".to_owned() } else { told.join(", ") },
        answered: case.answer.is_ok(),
        asked: case.truth.role == Role::Null || case.is_visible() || !told.is_empty(),
        faults,
        details,
    }
}
