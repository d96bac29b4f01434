//! From which size on effects are found, and which kind is taken for which.

use std::collections::BTreeSet;

use jointscope_proof::{Confusion, Detection, NOTHING, Smallest};

use crate::format::significant;
use crate::plot::{Axis, Plot, Role};
use crate::section::{Block, Section};
use crate::table::{Cell, Table};
use crate::unit::typeset;

/// Ends of the drawn curve, Δχ², the second at the least.
const DRAWN: [f64; 2] = [1.0, 1e4];
/// Points of the drawn curve.
const POINTS: usize = 120;

pub(super) fn section(detection: &Detection) -> Section {
    let section = Section::new("Detection against size").paragraph(
        "The size of an effect is what it costs a fit that does without it, quantities moved within their tolerances: Δχ², in units of the \
         noise. Chance alone makes a few.",
    );
    let section = match plot(detection) {
        Some(plot) => section.plot(plot),
        None => section,
    };
    section.with(smallest(detection))
}

fn plot(detection: &Detection) -> Option<Plot> {
    let shown: Vec<_> =
        detection.classes.iter().filter_map(|class| Some((class, class.size?.max(DRAWN[0])))).collect();
    let sizes: Vec<f64> = shown.iter().map(|(_, size)| *size).collect();
    // Two classes below the first drawn size would share an abscissa.
    if sizes.is_empty() || sizes.windows(2).any(|w| w[0] >= w[1]) {
        return None;
    }
    let bound = |side: usize| shown.iter().map(move |(class, _)| class.named.interval()[side]);
    let mut plot = Plot::new(
        "Share of single effects that are found",
        Axis::logarithmic("Δχ² of the hidden effect", ""),
        Axis::linear("share", ""),
    )
    .over(&sizes)
    .band("95 % interval of the share named", Role::Uncertainty, bound(0), bound(1))
    .points("named: kind, place and dof", Role::Estimate, shown.iter().map(|(class, _)| class.named.value()))
    .points(
        "noticed: something is amiss",
        Role::Reference,
        shown.iter().map(|(class, _)| class.noticed.value()),
    )
    .height(300)
    .alone();
    if detection.curve.is_some() {
        let end = sizes.iter().copied().fold(DRAWN[1], f64::max);
        let step = (end / DRAWN[0]).ln() / (POINTS - 1) as f64;
        let sizes: Vec<f64> = (0..POINTS).map(|i| DRAWN[0] * (step * i as f64).exp()).collect();
        let shares: Vec<Option<f64>> = sizes.iter().map(|size| detection.share_at(*size)).collect();
        plot = plot.over(sizes).line("fitted course, named", Role::Estimate, shares);
    }
    Some(plot.caption(match (detection.half_named_from, detection.sure_from) {
        (Some(half), Some(sure)) => format!(
            "Half of the effects are named from Δχ² = {half:.0}, nineteen of twenty from {sure:.0}. Points: classes of size, at their median."
        ),
        _ => "Points: classes of size, at their median.".to_owned(),
    }))
}

fn smallest(detection: &Detection) -> impl Into<Block> {
    let bound = |s: &Smallest| {
        format!("{} {} {}", if s.is_upper { "≤" } else { "≥" }, significant(s.value, 2), typeset(s.unit))
    };
    Table::of(&detection.smallest)
        .words("kind", |s| s.name().replace('_', " "))
        .words("parameter", |s| s.parameter.replace('_', " "))
        .words("is found from", |s| bound(s))
        .words("over the cases", |s| {
            format!("{} to {}", significant(s.range[0], 2), significant(s.range[1], 2))
        })
        .numbers("cases", "", |s| s.cases.to_string())
        .caption("The smallest effect of each kind that is named in nineteen of twenty cases")
        .footnote(
            "By the Cramér–Rao bound of the hidden parameter, which counts what tolerances can imitate: √Δχ² standard deviations. Where ≤ stands a \
             softer spring or a lower frequency is the stronger effect. Median and range over assemblies, places and tests.",
        )
}

/// Which kind was taken for which.
pub(super) fn confusion(confusion: &Confusion) -> Section {
    let kinds: BTreeSet<&str> =
        confusion.0.iter().flat_map(|(hidden, found)| found.keys().chain([hidden])).copied().collect();
    let name = |kind: &str| kind.replace('_', " ");
    let kinds: Vec<&str> = kinds.into_iter().filter(|kind| *kind != NOTHING).chain([NOTHING]).collect();
    let count = |hidden: &str, found: &str| confusion.count(hidden, found) as f64;
    let rows = kinds.iter().filter(|kind| confusion.0.contains_key(**kind));
    let map = Table::of(rows).names("hidden, found:", |hidden| name(hidden));
    let map = kinds.iter().fold(map, |map, found| {
        map.shaded(name(found), |hidden| {
            Cell::count(count(hidden, found), kinds.iter().map(|found| count(hidden, found)).sum())
        })
    });
    Section::new("Which kind was taken for which").with(
        map.footnote("Nulls and single effects that show, by the strongest finding. A kind beside the diagonal may fit as well as the hidden one."),
    )
}
