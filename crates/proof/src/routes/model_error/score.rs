//! Scores of cases whose model is a little wrong everywhere.

use super::Erring;
use super::judged::LIKELY;
use crate::case_line::{errors, is_worse};
use crate::routes::RouteScore;
use crate::sheet::Line;
use crate::sheet::Target::{AtLeast, AtMost, Within};
use crate::size::{Size, SizeScore};
use crate::statistics::middle;
use crate::{CaseLine, Figure, Judged, Rate, RoleCount, Share, Sheet};
use serde_json::json;

const RATES: [Line; 11] = [
    ("single_right", "single effects: named first, nothing untrue beside it", Some(AtLeast(0.9))),
    ("single_first", "single effects: named first", None),
    ("single_missed", "single effects: no name at all", None),
    ("untrue_claimed", "an untrue name with 0.9 or more", Some(AtMost(0.0))),
    ("untrue_likely", "an untrue name with 0.5 or more", None),
    ("null_untrue", "nulls and gaps: an untrue name with 0.5 or more", Some(AtMost(0.02))),
    ("null_alone", "nulls: nothing named", None),
    ("gap_named", "gaps: something named", None),
    ("sizes", "sizes found within 10 % of the truth", Some(AtLeast(0.9))),
    ("coverage", "95 % intervals that hold the true size", Some(Within(0.92, 0.98))),
    ("unseen_worse", "FRFs at points nobody measured: repaired worse than refitted", Some(AtMost(0.01))),
];

const FIGURES: [Line; 2] = [
    ("unseen_ratio", "right names: median error refitted over repaired at unmeasured points", None),
    ("unseen_repaired", "the same: median error repaired, %", None),
];

/// A route as its scores name it.
pub(in crate::routes) struct Route {
    /// Key in `proof.json`.
    pub key: &'static str,
    /// Where its recordings come from, in words.
    pub what: &'static str,
}

/// Scores the cases of a route.
pub(in crate::routes) fn score<T: Erring>(route: Route, judged: &[Judged<T>]) -> RouteScore {
    let sizes: Vec<Size> = judged.iter().filter_map(Judged::found_size).collect();
    let kind = |case: &&Judged<T>| match (case.truth.concealed(), case.truth.is_gap()) {
        (Some(_), _) => "single",
        (None, true) => "gap",
        (None, false) => "null",
    };
    let roles = ["null", "gap", "single"].map(|role| RoleCount {
        role,
        cases: judged.iter().filter(|case| kind(case) == role).count(),
        visible: None,
        asked: (role == "single").then(|| judged.iter().filter(|case| case.is_asked()).count()),
    });
    let roles = roles.into_iter().filter(|count| count.role != "gap" || count.cases > 0);
    RouteScore {
        key: route.key,
        what: route.what,
        sheet: Sheet {
            roles: roles.collect(),
            rates: Rate::all(&RATES, |key| share(judged, &sizes, key)),
            figures: Figure::all(&FIGURES, |key| {
                let unseen = judged.iter().filter(|case| case.is_right()).filter_map(|c| c.evidence.unseen);
                match key {
                    "unseen_ratio" => middle(unseen.map(|[refitted, repaired]| refitted / repaired)),
                    _ => middle(unseen.map(|[_, repaired]| 100.0 * repaired)),
                }
            }),
            lines: judged.iter().map(line).collect(),
        },
        sizes: SizeScore::all(&sizes),
    }
}

/// The share of a key of [`RATES`].
fn share<T: Erring>(judged: &[Judged<T>], sizes: &[Size], key: &str) -> Share {
    let asked = || judged.iter().filter(|case| case.is_asked());
    let empty = |gap: bool| {
        judged.iter().filter(move |case| case.truth.concealed().is_none() && case.truth.is_gap() == gap)
    };
    match key {
        "single_right" => Share::count(asked(), Judged::is_right),
        "single_first" => Share::count(asked(), Judged::is_first),
        "single_missed" => Share::count(asked(), |case| case.findings().is_empty()),
        "untrue_claimed" => Share::count(judged, |case| case.is_untrue_from(0.9)),
        "untrue_likely" => Share::count(judged, |case| case.is_untrue_from(LIKELY)),
        "null_untrue" => Share::count(empty(false).chain(empty(true)), |case| case.is_untrue_from(LIKELY)),
        "null_alone" => Share::count(empty(false), |case| case.answer.is_ok() && case.findings().is_empty()),
        "gap_named" => Share::count(empty(true), |case| !case.findings().is_empty()),
        "sizes" => Share::count(sizes, Size::is_right),
        "coverage" => Share::count(sizes, Size::is_held),
        _ => Share::count(judged.iter().filter_map(|case| case.evidence.unseen), is_worse),
    }
}

fn line<T: Erring>(case: &Judged<T>) -> CaseLine {
    let mut line = case.line_of(case.errors(), |found| case.is_in_it(found));
    let evidence = &case.evidence;
    let size = case.found_size();
    line.asked = case.truth.concealed().is_none() || case.is_asked() || !case.findings().is_empty();
    line.value["visible"] = json!(case.is_asked());
    line.value["sizes"] = json!(size.iter().collect::<Vec<_>>());
    line.details.push(format!(
        "objective: refitted {:.1}, repaired {:.1}, true {:.1}",
        evidence.refitted, evidence.repaired, evidence.truth
    ));
    line.details.extend(size.iter().map(Size::says));
    line.details.extend(errors("FRFs at unmeasured points", evidence.unseen));
    line
}
