//! The scores of the laboratory's cases.

use crate::case_line::is_worse;
use crate::confusion::Confusion;
use crate::coverage::Coverage;
use crate::detection::Detection;
use crate::reliability::Reliability;
use crate::sheet::Target::{AtLeast, AtMost, Within};
use crate::sheet::{Keyed, Line, by_key};
use crate::statistics::middle;
use crate::{Judged, Name, PLAIN, Rate, Role, RoleCount, ScoredFigure, Share, Sheet};
use jointscope_diagnosis::Verdict;
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};
use std::ops::Deref;

/// The same share of cases that were always there and of fresh ones.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FreshComparison {
    /// Key of the rate.
    #[serde(skip)]
    pub key: &'static str,
    /// Cases of the seed.
    pub old: Share,
    /// Cases of the text.
    pub fresh: Share,
    /// Probability of a difference as large were both drawn alike.
    pub probability: f64,
    /// Whether the difference may be chance: the probability is [`CHANCE`] or more.
    pub agree: bool,
}

impl Keyed for FreshComparison {
    fn key(&self) -> &str {
        self.key
    }
}

/// A difference less probable than this is no chance.
pub const CHANCE: f64 = 0.01;

/// Verdicts with the number of cases.
pub type VerdictCounts = Vec<(&'static str, usize)>;

/// All scores of a set of judged cases.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Score {
    /// Shares, figures and every case.
    #[serde(flatten)]
    pub sheet: Sheet,
    /// Stated probabilities against how often they were right.
    pub reliability: Reliability,
    /// Which kinds were taken for which.
    pub confusion: Confusion,
    /// Share of effects found by their size.
    pub detection: Detection,
    /// Stated intervals against the truth.
    #[serde(rename = "coverage_by_level")]
    pub coverage: Coverage,
    /// Verdicts by role.
    #[serde(serialize_with = "by_role")]
    pub verdicts: Vec<(Role, VerdictCounts)>,
    /// Old against fresh cases; empty where none are fresh.
    #[serde(rename = "old_and_fresh", serialize_with = "by_key")]
    pub comparisons: Vec<FreshComparison>,
}

fn by_role<S: Serializer>(verdicts: &[(Role, VerdictCounts)], serializer: S) -> Result<S::Ok, S::Error> {
    let counts = |(role, given): &(Role, VerdictCounts)| {
        (role.name(), given.iter().copied().collect::<BTreeMap<_, _>>())
    };
    serializer.collect_map(verdicts.iter().map(counts))
}

/// Stated probability that counts as certain.
const CERTAIN: f64 = 0.95;
/// Probability below which the log score does not fall.
const LEAST: f64 = 1e-3;

const RATES: [Line; 15] = [
    ("nulls_consistent", "nulls called consistent", Some(AtLeast(0.99))),
    ("null_finding", "nulls with a finding: false alarms", Some(AtMost(0.01))),
    ("single_kind", "single effects: kind right", Some(AtLeast(0.97))),
    ("single_place", "single effects: kind, place and dof right", Some(AtLeast(0.97))),
    ("single_elsewhere", "single effects of the right kind: at another place or dof", None),
    ("single_extra", "single effects: an extra finding", Some(AtMost(0.05))),
    ("single_certain", "plain single effects with one acceptable name: 0.95 on it", Some(AtLeast(0.9))),
    ("coverage", "95 % intervals that hold the true parameter", Some(Within(0.92, 0.98))),
    ("double_both", "two effects: both right", Some(AtLeast(0.85))),
    ("held_out_worse", "held-out lines: repaired worse than refitted", Some(AtMost(0.01))),
    ("unseen_worse", "unmeasured FRFs: repaired worse than refitted", Some(AtMost(0.01))),
    ("outside_wrong_name", "unknown physics: a wrong name with 0.9 or more", Some(AtMost(0.0))),
    ("false_minimum", "right names, or rightly none, fitted short of their minimum", None),
    ("outside_abstains", "unknown physics that shows: noticed, and no name given", None),
    ("outside_named", "unknown physics: any name with 0.9 or more", None),
];

const FIGURES: [Line; 5] = [
    ("interval_width", "95 % intervals: median width over the Cramér–Rao bound's", Some(AtMost(1.5))),
    ("place_error", "right names with an abscissa: median error of the place in mm", None),
    ("log_score", "mean log of the probability of the true name", None),
    ("held_out_ratio", "held-out lines: median error refitted over repaired", Some(AtLeast(10.0))),
    ("unseen_ratio", "unmeasured FRFs: median error refitted over repaired", Some(AtLeast(10.0))),
];

impl Score {
    /// Scores judged cases.
    pub fn of(judged: &[Judged]) -> Self {
        let all: Vec<&Judged> = judged.iter().collect();
        let (fresh, old): (Vec<&Judged>, Vec<&Judged>) = all.iter().partition(|judged| judged.truth.fresh);
        let compared = |&(key, ..): &Line| {
            let (old, fresh) = (share(&old, key), share(&fresh, key));
            let probability = old.agreement(fresh);
            FreshComparison { key, old, fresh, probability, agree: probability >= CHANCE }
        };
        let both = !fresh.is_empty() && !old.is_empty();
        let roles = Role::ALL.map(|role| RoleCount {
            role: role.name(),
            cases: of_role(&all, role).count(),
            visible: Some(visible(&all, role).count()),
            asked: None,
        });
        Score {
            sheet: Sheet {
                roles: roles.to_vec(),
                rates: Rate::all(&RATES, |key| share(&all, key)),
                figures: ScoredFigure::all(&FIGURES, |key| figure(&all, key)),
                lines: judged.iter().map(Judged::line).collect(),
            },
            reliability: Reliability::of(visible(&all, Role::Single)),
            confusion: Confusion::of(judged.iter()),
            detection: Detection::of(judged.iter()),
            coverage: intervals(&all),
            verdicts: Role::ALL.map(|role| (role, verdicts(of_role(&all, role)))).to_vec(),
            comparisons: if both { RATES.iter().map(compared).collect() } else { Vec::new() },
        }
    }
}

impl Deref for Score {
    type Target = Sheet;

    fn deref(&self) -> &Sheet {
        &self.sheet
    }
}

fn of_role<'a>(all: &'a [&Judged], role: Role) -> impl Iterator<Item = &'a Judged> + Clone {
    all.iter().copied().filter(move |judged| judged.truth.role == role)
}

fn visible<'a>(all: &'a [&Judged], role: Role) -> impl Iterator<Item = &'a Judged> + Clone {
    of_role(all, role).filter(|judged| judged.is_visible())
}

/// Single and double effects that show.
fn shown<'a>(all: &'a [&Judged]) -> impl Iterator<Item = &'a Judged> + Clone {
    visible(all, Role::Single).chain(visible(all, Role::Double))
}

fn verdicts<'a>(judged: impl Iterator<Item = &'a Judged>) -> VerdictCounts {
    let words = [Verdict::Consistent, Verdict::Explained, Verdict::PartlyExplained, Verdict::Unexplained];
    let mut counts: VerdictCounts = words.iter().map(|verdict| (verdict.name(), 0)).collect();
    counts.push(("no answer", 0));
    for judged in judged {
        let word = judged.answer.as_ref().map_or("no answer", |answer| answer.verdict.name());
        counts.iter_mut().filter(|(name, _)| *name == word).for_each(|(_, count)| *count += 1);
    }
    counts
}

/// The share of a key of [`RATES`].
fn share(all: &[&Judged], key: &str) -> Share {
    let singles = || visible(all, Role::Single);
    match key {
        "nulls_consistent" => Share::count(of_role(all, Role::Null), |judged| judged.is_consistent()),
        "null_finding" => Share::count(of_role(all, Role::Null), |judged| !judged.findings().is_empty()),
        "single_kind" => Share::count(singles(), |judged| judged.has_kind()),
        "single_place" => Share::count(singles(), |judged| judged.is_named()),
        "single_elsewhere" => {
            Share::count(singles().filter(|judged| judged.has_kind()), |judged| !judged.is_named())
        }
        "single_extra" => Share::count(singles(), |judged| judged.findings().len() > 1),
        "single_certain" => {
            Share::count(plain(all), |judged| judged.hidden().iter().all(|n| judged.stated(n) >= CERTAIN))
        }
        "coverage" => intervals(all).share(),
        "double_both" => Share::count(visible(all, Role::Double), Judged::all_found),
        "held_out_worse" => Share::count(all.iter().filter_map(|judged| judged.held_out()), is_worse),
        "unseen_worse" => Share::count(all.iter().filter_map(|judged| judged.fits.unseen), is_worse),
        "outside_wrong_name" => Share::count(of_role(all, Role::Outside), Judged::claims_wrongly),
        "false_minimum" => {
            let right = all.iter().filter(|judged| judged.names_all_and_nothing_else());
            Share::count(right, |judged| judged.stopped_short())
        }
        "outside_abstains" => Share::count(visible(all, Role::Outside), |judged| {
            judged.is_noticed() && judged.findings().is_empty()
        }),
        "outside_named" => {
            Share::count(of_role(all, Role::Outside), |judged| judged.claims().next().is_some())
        }
        _ => Share::default(),
    }
}

/// The figure of a key of [`FIGURES`], and how many it is of.
fn figure(all: &[&Judged], key: &str) -> (Option<f64>, usize) {
    let ratio = |[refitted, repaired]: [f64; 2]| refitted / repaired;
    match key {
        "interval_width" => middle(intervals(all).widths().into_iter()),
        "place_error" => middle(place_errors(all).into_iter().map(|metres| 1e3 * metres)),
        "log_score" => {
            let logs = visible(all, Role::Single).map(|judged| {
                let stated = judged.hidden().iter().map(|name| judged.stated(name)).fold(1.0, f64::min);
                stated.max(LEAST).ln()
            });
            let count = logs.clone().count();
            ((count > 0).then(|| logs.sum::<f64>() / count as f64), count)
        }
        "held_out_ratio" => middle(shown(all).filter_map(Judged::held_out).map(ratio)),
        "unseen_ratio" => middle(shown(all).filter_map(|judged| judged.fits.unseen).map(ratio)),
        _ => (None, 0),
    }
}

fn intervals(all: &[&Judged]) -> Coverage {
    Coverage::of(shown(all))
}

/// Distances between found and true abscissae of effects that were found under their own names, m.
fn place_errors(all: &[&Judged]) -> Vec<f64> {
    let mut errors = Vec::new();
    for judged in shown(all) {
        for hidden in judged.truth.effects() {
            let Some(x) = hidden.kind.spec().parameters.iter().position(|spec| spec.name == "x") else {
                continue;
            };
            let own = judged.findings().iter().filter(|found| Name::of(&found.effect) == Name::of(hidden));
            errors.extend(own.map(|found| (found.effect.value(x) - hidden.value(x)).abs()));
        }
    }
    errors
}

/// Single effects that weigh at least [`PLAIN`] and of whose stated names only the true one is acceptable.
fn plain<'a>(all: &'a [&Judged]) -> impl Iterator<Item = &'a Judged> {
    visible(all, Role::Single).filter(|judged| {
        let other = |name: &Name| !judged.hidden().contains(name) && judged.accepts(name);
        judged.size() >= PLAIN && !judged.fits.others.keys().any(other)
    })
}

impl Display for Score {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "cases, and those whose hidden physics shows:\n{}", self.sheet)?;
        write!(f, "{}", self.detection)?;
        writeln!(f, "\nintervals of a level that hold the true parameter:")?;
        for (level, held) in self.coverage.by_level() {
            writeln!(f, "  {level:<6} {}", held.briefly())?;
        }
        write!(f, "{}{}\nverdicts:\n", self.reliability, self.confusion)?;
        for (role, verdicts) in &self.verdicts {
            let given = verdicts.iter().filter(|(_, count)| *count > 0);
            let given: Vec<String> = given.map(|(name, count)| format!("{name} {count}")).collect();
            writeln!(f, "  {:<8} {}", role.name(), given.join(", "))?;
        }
        if !self.comparisons.is_empty() {
            writeln!(f, "\nold and fresh cases, probability of a difference as large by chance:")?;
        }
        for FreshComparison { key, old, fresh, probability, agree } in &self.comparisons {
            let word = if *agree { "agree" } else { "differ" };
            let (old, fresh) = ([old.of, old.all], [fresh.of, fresh.all]);
            let (of, of_fresh) =
                (format!("{:>4} of {:<4}", old[0], old[1]), format!("{:>4} of {:<4}", fresh[0], fresh[1]));
            writeln!(f, "  {key:<20} {of} {of_fresh} {probability:.3} {word}")?;
        }
        Ok(())
    }
}
