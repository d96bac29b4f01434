//! Scores of cases that are judged by the names given.

use super::Nameable;
use super::judged::LIKELY;
use crate::case_line::{errors, is_worse};
use crate::sheet::Line;
use crate::sheet::Target::{AtLeast, AtMost, Within};
use crate::size::{Size, SizeScore};
use crate::statistics::middle;
use crate::{CaseLine, Judged, Rate, Role, RoleCount, ScoredFigure, Share, Sheet};
use serde_json::json;

/// Shares where a model is a little wrong everywhere.
pub(in crate::routes) const WRONG_EVERYWHERE: &[Line] = &[
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

/// Shares of lumped cases that hide one effect or nothing.
pub(in crate::routes) const ONE_OR_NONE: &[Line] = &[
    ("single_alone", "single effects: named first and alone", Some(AtLeast(0.97))),
    ("single_own", "the same, by its own name or one that is exactly the same thing", None),
    ("single_missed", "single effects: no name at all", None),
    ("null_named", "nulls: something named", Some(AtMost(0.01))),
    ("untrue_claimed", "an untrue name with 0.9 or more", Some(AtMost(0.0))),
    ("untrue_likely", "an untrue name with 0.5 or more", Some(AtMost(0.02))),
    ("sizes", "sizes found within 10 % of the truth", None),
    ("coverage", "95 % intervals that hold the true size", Some(Within(0.92, 0.98))),
    ("unseen_worse", "FRFs at points nobody measured: repaired worse than refitted", Some(AtMost(0.01))),
];

/// Shares of physics that no effect is.
pub(in crate::routes) const UNLISTED: &[Line] = &[
    ("untrue_claimed", "an untrue name with 0.9 or more", Some(AtMost(0.0))),
    ("untrue_likely", "an untrue name with 0.5 or more", Some(AtMost(0.02))),
    ("imitated", "a name with 0.9 or more that is in it or fits as well as the truth", None),
    ("noticed", "it shows: noticed, and no name given", None),
    ("unnoticed", "it shows: called consistent", None),
    ("unseen_worse", "FRFs at points nobody measured: repaired worse than refitted", Some(AtMost(0.01))),
];

const FIGURES: [Line; 2] = [
    ("unseen_ratio", "right names: median error refitted over repaired at unmeasured points", None),
    ("unseen_repaired", "the same: median error repaired, %", None),
];

/// Scores the cases of a route.
pub(in crate::routes) fn score<T: Nameable>(rates: &[Line], judged: &[Judged<T>]) -> (Sheet, Vec<SizeScore>) {
    let sizes: Vec<Size> = judged.iter().filter_map(|case| case.found_size()).collect();
    let of_role = |role: &'static str| judged.iter().filter(move |case| role_of(case) == role);
    let roles = ["null", "gap", "single", "outside"].map(|role| RoleCount {
        role,
        cases: of_role(role).count(),
        visible: (role == "outside").then(|| of_role(role).filter(|case| case.is_visible()).count()),
        asked: (role == "single").then(|| of_role(role).filter(|case| case.is_asked()).count()),
    });
    let roles = roles.into_iter().filter(|count| matches!(count.role, "null" | "single") || count.cases > 0);
    let sheet = Sheet {
        roles: roles.collect(),
        rates: Rate::all(rates, |key| share(judged, &sizes, key)),
        figures: ScoredFigure::all(&FIGURES, |key| {
            let unseen = judged.iter().filter(|case| case.is_right()).filter_map(|c| c.fits.unseen);
            match key {
                "unseen_ratio" => middle(unseen.map(|[refitted, repaired]| refitted / repaired)),
                _ => middle(unseen.map(|[_, repaired]| 100.0 * repaired)),
            }
        }),
        lines: judged.iter().map(line).collect(),
    };
    (sheet, SizeScore::all(&sizes))
}

/// How much was hidden in a case, as its scores name it.
fn role_of<T: Nameable>(case: &Judged<T>) -> &'static str {
    match (case.truth.concealed(), case.truth.role()) {
        (Some(_), _) => "single",
        (None, Role::Outside) => "outside",
        (None, _) if case.truth.is_gap() => "gap",
        (None, _) => "null",
    }
}

/// The share of a key among a route's.
fn share<T: Nameable>(judged: &[Judged<T>], sizes: &[Size], key: &str) -> Share {
    let all = || judged.iter();
    let asked = || all().filter(|case| case.is_asked());
    let of_role = |role: &'static str| all().filter(move |case| role_of(case) == role);
    let shown = || of_role("outside").filter(|case| case.is_visible());
    let is_claimed = |case: &Judged<T>| case.claims().next().is_some();
    match key {
        "single_right" => Share::count(asked(), Judged::is_right),
        "single_first" => Share::count(asked(), Judged::is_first),
        "single_alone" => Share::count(asked(), Judged::is_alone),
        "single_own" => Share::count(asked(), Judged::is_its_own),
        "single_missed" => Share::count(asked(), |case| case.findings().is_empty()),
        "untrue_claimed" => Share::count(all(), |case| case.is_untrue_from(0.9)),
        "untrue_likely" => Share::count(all(), |case| case.is_untrue_from(LIKELY)),
        "null_untrue" => {
            Share::count(of_role("null").chain(of_role("gap")), |case| case.is_untrue_from(LIKELY))
        }
        "null_alone" => {
            Share::count(of_role("null"), |case| case.answer.is_ok() && case.findings().is_empty())
        }
        "null_named" => Share::count(of_role("null"), |case| !case.findings().is_empty()),
        "gap_named" => Share::count(of_role("gap"), |case| !case.findings().is_empty()),
        "imitated" => Share::count(of_role("outside"), |case| is_claimed(case) && !case.is_untrue_from(0.9)),
        "noticed" => Share::count(shown(), |case| case.is_noticed() && case.findings().is_empty()),
        "unnoticed" => Share::count(shown(), |case| case.is_consistent()),
        "sizes" => Share::count(sizes, Size::is_right),
        "coverage" => Share::count(sizes, Size::is_held),
        _ => Share::count(judged.iter().filter_map(|case| case.fits.unseen), is_worse),
    }
}

fn line<T: Nameable>(case: &Judged<T>) -> CaseLine {
    let mut line = case.line_of(case.errors(), |found| case.is_in_it(found));
    let fits = &case.fits;
    let size = case.found_size();
    line.asked = case.truth.concealed().is_none() || case.is_asked() || !case.findings().is_empty();
    line.value["visible"] = json!(case.is_asked() || (role_of(case) == "outside" && case.is_visible()));
    line.value["sizes"] = json!(size.iter().collect::<Vec<_>>());
    line.details.push(format!(
        "objective: refitted {:.1}, repaired {:.1}, true {:.1}",
        fits.refitted, fits.repaired, fits.truth
    ));
    line.details.extend(size.iter().map(Size::says));
    line.details.extend(errors("FRFs at unmeasured points", fits.unseen));
    line
}
