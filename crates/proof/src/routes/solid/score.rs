//! The scores of solid cases.

use super::SolidJudged;
use super::judged::are_the_same;
use crate::case_line::{errors, is_worse};
use crate::sheet::Line;
use crate::sheet::Target::{AtLeast, AtMost, Within};
use crate::size::{Size, SizeScore};
use crate::statistics::middle;
use crate::{CaseLine, Found, Judgeable, Name, Rate, Role, RoleCount, ScoredFigure, Share, Sheet};
use jointscope_fixture::{Effect, EffectKind};
use serde_json::json;

const RATES: [Line; 10] = [
    ("nulls_consistent", "nulls called consistent", Some(AtLeast(0.99))),
    ("null_finding", "nulls with a finding: false alarms", Some(AtMost(0.01))),
    ("single_kind", "single effects: kind right", Some(AtLeast(0.97))),
    ("single_place", "single effects: kind, place and dof right", Some(AtLeast(0.97))),
    ("single_extra", "single effects: an extra finding", Some(AtMost(0.05))),
    ("double_both", "two effects: both right", Some(AtLeast(0.85))),
    ("wrong_name", "a name with 0.9 or more that is not in the solid", Some(AtMost(0.02))),
    ("sizes", "sizes found within 10 % of the closed form", None),
    ("coverage", "95 % intervals that hold the closed form", Some(Within(0.92, 0.98))),
    ("unseen_worse", "FRFs at points nobody measured: repaired worse than refitted", Some(AtMost(0.01))),
];

const UNSEEN: &str = "FRFs at points nobody measured: median error refitted over repaired";
const FIGURES: [Line; 3] = [
    ("held_out_ratio", "held-out lines: median error refitted over repaired", None),
    ("unseen_ratio", UNSEEN, Some(AtLeast(10.0))),
    ("unseen_repaired", "the same: median error repaired, %", None),
];

/// Scores solid cases.
pub(crate) fn score(judged: &[SolidJudged]) -> (Sheet, Vec<SizeScore>) {
    let shown = || judged.iter().filter(|case| case.is_visible());
    let sizes: Vec<Size> = shown().flat_map(sizes).collect();
    let roles = [Role::Null, Role::Single, Role::Double].map(|role| RoleCount {
        role: role.name(),
        cases: judged.iter().filter(|case| case.truth.role == role).count(),
        visible: None,
        asked: Some(shown().filter(|case| case.truth.role == role).count()),
    });
    let sheet = Sheet {
        roles: roles.to_vec(),
        rates: Rate::all(&RATES, |key| share(judged, &sizes, key)),
        figures: ScoredFigure::all(&FIGURES, |key| {
            let ratio = |[refitted, repaired]: [f64; 2]| refitted / repaired;
            let unseen = shown().filter_map(|case| case.fits.unseen);
            match key {
                "held_out_ratio" => middle(shown().filter_map(|case| case.held_out()).map(ratio)),
                "unseen_ratio" => middle(unseen.map(ratio)),
                "unseen_repaired" => middle(unseen.map(|[_, repaired]| 100.0 * repaired)),
                _ => (None, 0),
            }
        }),
        lines: judged.iter().map(line).collect(),
    };
    (sheet, SizeScore::all(&sizes))
}

/// The share of a key of [`RATES`].
fn share(judged: &[SolidJudged], sizes: &[Size], key: &str) -> Share {
    let of_role = |role: Role| judged.iter().filter(move |case| case.truth.role == role);
    let visible = |role: Role| of_role(role).filter(|case| case.is_visible());
    match key {
        "nulls_consistent" => Share::count(of_role(Role::Null), SolidJudged::is_consistent),
        "null_finding" => Share::count(of_role(Role::Null), |case| !case.findings().is_empty()),
        "single_kind" => Share::count(visible(Role::Single), SolidJudged::has_kind),
        "single_place" => Share::count(visible(Role::Single), SolidJudged::is_named),
        "single_extra" => Share::count(visible(Role::Single), SolidJudged::has_extra),
        "double_both" => Share::count(visible(Role::Double), SolidJudged::is_named),
        "wrong_name" => Share::count(judged, |case| case.claims().any(|found| !case.is_true(&found.effect))),
        "sizes" => Share::count(sizes, Size::is_right),
        "coverage" => Share::count(sizes, Size::is_held),
        "unseen_worse" => Share::count(judged.iter().filter_map(|case| case.fits.unseen), is_worse),
        _ => Share::default(),
    }
}

/// Sizes of hidden effects that were found.
fn sizes(case: &SolidJudged) -> Vec<Size> {
    let mut all = Vec::new();
    for hidden in case.truth.effects() {
        let mut own = case.findings().iter().filter(|found| are_the_same(hidden, &found.effect));
        let Some(found) = own.next() else { continue };
        if Name::of(hidden) != Name::of(&found.effect) {
            all.push(across(hidden, found, case));
            continue;
        }
        let dof = hidden.dof.map_or_else(String::new, |dof| format!(" in {}", dof.name()));
        // The solid's layers have no dashpot, its strips no rotary inertia of a name.
        all.extend(Size::of_each(hidden, found, &format!("{}{dof}: ", hidden.kind.name())));
    }
    all
}

/// A spring across the strip by another name: k = κGA/L.
fn across(hidden: &Effect, found: &Found, case: &SolidJudged) -> Size {
    let lumped = &case.truth.lumped;
    let length = lumped.joints().first().map_or(1.0, |joint| lumped.joint_length(joint));
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
    let mut line = case.line_of(case.faults(), |found| case.is_true(&found.effect));
    let (fits, sizes) = (&case.fits, sizes(case));
    line.details.push(format!(
        "objective: refitted {:.1}, repaired {:.1}, fit from the closed form {:.1}, the solid's own FRFs {:.1}",
        fits.refitted,
        fits.repaired,
        fits.lumped.unwrap_or(0.0),
        fits.truth
    ));
    line.details.extend(sizes.iter().map(Size::says));
    line.details.extend(errors("FRFs at other points", fits.unseen));
    line.value["sizes"] = json!(sizes);
    line
}
