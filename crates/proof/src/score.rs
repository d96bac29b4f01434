//! The scores: shares with binomial intervals beside their targets.

use crate::confusion::Confusion;
use crate::coverage::Coverage;
use crate::detection::Detection;
use crate::reliability::Reliability;
use crate::statistics::median;
use crate::{Judged, Name, PLAIN, Role, Share};
use jointscope_diagnosis::Verdict;

/// What a figure should be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// This or more.
    AtLeast(f64),
    /// This or less.
    AtMost(f64),
    /// Neither less than the first nor more than the second.
    Within(f64, f64),
}

impl Target {
    /// Whether a figure is what it should be.
    pub fn is_met(self, value: f64) -> bool {
        match self {
            Target::AtLeast(least) => value >= least,
            Target::AtMost(most) => value <= most,
            Target::Within(least, most) => (least..=most).contains(&value),
        }
    }
}

/// A share of cases with its target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rate {
    /// Key in `proof.json`.
    pub key: &'static str,
    /// What is counted, in words.
    pub what: &'static str,
    /// How many of how many.
    pub share: Share,
    /// What it should be.
    pub target: Option<Target>,
}

/// How a share stands to its target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// It is what it should be.
    Met,
    /// It is not, but its interval holds the target.
    WithinChance,
    /// It is not.
    Missed,
}

impl Standing {
    /// The standing in words.
    pub fn says(self) -> &'static str {
        match self {
            Standing::Met => "met",
            Standing::WithinChance => "missed, within chance",
            Standing::Missed => "missed",
        }
    }
}

impl Rate {
    /// How it stands to its target; `None` where it has none or nothing was counted.
    pub fn standing(&self) -> Option<Standing> {
        let (target, value) = (self.target?, self.share.value()?);
        let [low, high] = self.share.interval();
        let within = match target {
            Target::AtLeast(least) => high >= least,
            Target::AtMost(most) => low <= most,
            Target::Within(least, most) => high >= least && low <= most,
        };
        Some(match (target.is_met(value), within) {
            (true, _) => Standing::Met,
            (false, true) => Standing::WithinChance,
            (false, false) => Standing::Missed,
        })
    }
}

/// A figure that is no share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// Key in `proof.json`.
    pub key: &'static str,
    /// What it is, in words.
    pub what: &'static str,
    /// Its value; `None` where no case decides it.
    pub value: Option<f64>,
    /// Number of cases or intervals behind it.
    pub from: usize,
    /// What it should be.
    pub target: Option<Target>,
}

/// The same share of cases that were always there and of fresh ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comparison {
    /// Key of the rate.
    pub key: &'static str,
    /// Cases of the seed.
    pub old: Share,
    /// Cases of the text.
    pub fresh: Share,
    /// Probability of a difference as large were both drawn alike.
    pub probability: f64,
}

/// A difference less probable than this is no chance.
pub const CHANCE: f64 = 0.01;

/// All scores of a set of judged cases.
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    /// Number of cases by [`Role`], and how many of them show.
    pub cases: Vec<(Role, usize, usize)>,
    /// Shares with targets.
    pub rates: Vec<Rate>,
    /// Other figures.
    pub figures: Vec<Figure>,
    /// Stated probabilities against how often they were right.
    pub reliability: Reliability,
    /// Which kinds were taken for which.
    pub confusion: Confusion,
    /// Share of effects found by their size.
    pub detection: Detection,
    /// Stated intervals against the truth.
    pub coverage: Coverage,
    /// Verdicts by role.
    pub verdicts: Vec<(Role, Vec<(&'static str, usize)>)>,
    /// Old against fresh cases; empty where none are fresh.
    pub comparisons: Vec<Comparison>,
}

/// Stated probability that counts as certain.
const CERTAIN: f64 = 0.95;
/// Stated probability at which a wrong name is a fault.
const CLAIMED: f64 = 0.9;
/// Probability below which the log score does not fall.
const LEAST: f64 = 1e-3;

impl Score {
    /// Scores judged cases.
    pub fn of(judged: &[Judged]) -> Self {
        let all: Vec<&Judged> = judged.iter().collect();
        let (fresh, old): (Vec<&Judged>, Vec<&Judged>) = all.iter().partition(|judged| judged.truth.fresh);
        let comparisons = if fresh.is_empty() || old.is_empty() {
            Vec::new()
        } else {
            let pairs = rates(&old).into_iter().zip(rates(&fresh));
            pairs
                .map(|(old, fresh)| Comparison {
                    key: old.key,
                    old: old.share,
                    fresh: fresh.share,
                    probability: old.share.agreement(fresh.share),
                })
                .collect()
        };
        let of_role = |role: Role| all.iter().copied().filter(move |judged| judged.truth.role == role);
        let cases = Role::ALL.map(|role| {
            (role, of_role(role).count(), of_role(role).filter(|judged| judged.is_visible()).count())
        });
        let verdicts = Role::ALL.map(|role| (role, verdicts(of_role(role))));
        Score {
            cases: cases.to_vec(),
            rates: rates(&all),
            figures: figures(&all),
            reliability: Reliability::of(visible(&all, Role::Single)),
            confusion: Confusion::of(all.iter().copied()),
            detection: Detection::of(all.iter().copied()),
            coverage: intervals(&all),
            verdicts: verdicts.to_vec(),
            comparisons,
        }
    }

    /// The rate of a key.
    pub fn rate(&self, key: &str) -> Option<&Rate> {
        self.rates.iter().find(|rate| rate.key == key)
    }

    /// The figure of a key.
    pub fn figure(&self, key: &str) -> Option<&Figure> {
        self.figures.iter().find(|figure| figure.key == key)
    }
}

fn visible<'a>(all: &'a [&Judged], role: Role) -> impl Iterator<Item = &'a Judged> + Clone {
    all.iter().copied().filter(move |judged| judged.truth.role == role && judged.is_visible())
}

fn verdicts<'a>(judged: impl Iterator<Item = &'a Judged>) -> Vec<(&'static str, usize)> {
    let words = [Verdict::Consistent, Verdict::Explained, Verdict::PartlyExplained, Verdict::Unexplained];
    let mut counts: Vec<(&'static str, usize)> = words.iter().map(|verdict| (verdict.name(), 0)).collect();
    counts.push(("no answer", 0));
    for judged in judged {
        let word = judged.answer.as_ref().map_or("no answer", |answer| answer.verdict.name());
        counts.iter_mut().filter(|(name, _)| *name == word).for_each(|(_, count)| *count += 1);
    }
    counts
}

fn rates(all: &[&Judged]) -> Vec<Rate> {
    use Target::{AtLeast, AtMost, Within};
    let of_role = |role: Role| all.iter().copied().filter(move |judged| judged.truth.role == role);
    let rate = |key, what, share, target| Rate { key, what, share, target: Some(target) };
    let consistent =
        |judged: &Judged| judged.answer.as_ref().is_ok_and(|answer| answer.verdict == Verdict::Consistent);
    let worse = |errors: [f64; 2]| errors[1] > errors[0];
    vec![
        rate(
            "nulls_consistent",
            "nulls called consistent",
            Share::count(of_role(Role::Null), consistent),
            AtLeast(0.99),
        ),
        rate(
            "null_finding",
            "nulls with a finding: false alarms",
            Share::count(of_role(Role::Null), |judged| !judged.found().is_empty()),
            AtMost(0.01),
        ),
        rate(
            "single_kind",
            "single effects: kind right",
            Share::count(visible(all, Role::Single), Judged::has_kind),
            AtLeast(0.97),
        ),
        rate(
            "single_place",
            "single effects: kind, place and dof right",
            Share::count(visible(all, Role::Single), Judged::is_named),
            AtLeast(0.97),
        ),
        Rate {
            key: "single_elsewhere",
            what: "single effects of the right kind: at another place or dof",
            share: Share::count(visible(all, Role::Single).filter(|judged| judged.has_kind()), |judged| {
                !judged.is_named()
            }),
            target: None,
        },
        rate(
            "single_extra",
            "single effects: an extra finding",
            Share::count(visible(all, Role::Single), |judged| judged.found().len() > 1),
            AtMost(0.05),
        ),
        rate(
            "single_certain",
            "plain single effects with one acceptable name: 0.95 on it",
            Share::count(plain(all), |judged| judged.hidden().iter().all(|n| judged.stated(n) >= CERTAIN)),
            AtLeast(0.9),
        ),
        rate(
            "coverage",
            "95 % intervals that hold the true parameter",
            intervals(all).share(),
            Within(0.92, 0.98),
        ),
        rate(
            "double_both",
            "two effects: both right",
            Share::count(visible(all, Role::Double), Judged::all_found),
            AtLeast(0.85),
        ),
        rate(
            "held_out_worse",
            "held-out lines: repaired worse than refitted",
            Share::count(held_out(all.iter().copied()), worse),
            AtMost(0.01),
        ),
        rate(
            "unseen_worse",
            "unmeasured FRFs: repaired worse than refitted",
            Share::count(unseen(all.iter().copied()), worse),
            AtMost(0.01),
        ),
        rate(
            "outside_wrong_name",
            "unknown physics: a wrong name with 0.9 or more",
            Share::count(of_role(Role::Outside), |judged| claimed(judged) && !judged.cannot_be_told()),
            AtMost(0.0),
        ),
        Rate {
            key: "false_minimum",
            what: "right names, or rightly none, fitted short of their minimum",
            share: Share::count(right_names(all), Judged::stopped_short),
            target: None,
        },
        Rate {
            key: "outside_abstains",
            what: "unknown physics that shows: noticed, and no name given",
            share: Share::count(visible(all, Role::Outside), |judged| {
                judged.is_noticed() && judged.found().is_empty()
            }),
            target: None,
        },
        Rate {
            key: "outside_named",
            what: "unknown physics: any name with 0.9 or more",
            share: Share::count(of_role(Role::Outside), claimed),
            target: None,
        },
    ]
}

fn figures(all: &[&Judged]) -> Vec<Figure> {
    let helped = || visible(all, Role::Single).chain(visible(all, Role::Double));
    let ratio = |errors: [f64; 2]| errors[0] / errors[1];
    let held_out: Vec<f64> = held_out(helped()).map(ratio).collect();
    let unseen: Vec<f64> = unseen(helped()).map(ratio).collect();
    let widths = intervals(all).widths();
    let places = place_errors(all);
    let logs: Vec<f64> = visible(all, Role::Single)
        .map(|judged| {
            let stated = judged.hidden().iter().map(|name| judged.stated(name)).fold(1.0, f64::min);
            stated.max(LEAST).ln()
        })
        .collect();
    let mean =
        |values: &[f64]| (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64);
    let figure = |key, what, value, from, target| Figure { key, what, value, from, target };
    vec![
        figure(
            "interval_width",
            "95 % intervals: median width over the Cramér–Rao bound's",
            median(&widths),
            widths.len(),
            Some(Target::AtMost(1.5)),
        ),
        figure(
            "place_error",
            "right names with an abscissa: median error of the place in mm",
            median(&places).map(|metres| 1e3 * metres),
            places.len(),
            None,
        ),
        figure("log_score", "mean log of the probability of the true name", mean(&logs), logs.len(), None),
        figure(
            "held_out_ratio",
            "held-out lines: median error refitted over repaired",
            median(&held_out),
            held_out.len(),
            Some(Target::AtLeast(10.0)),
        ),
        figure(
            "unseen_ratio",
            "unmeasured FRFs: median error refitted over repaired",
            median(&unseen),
            unseen.len(),
            Some(Target::AtLeast(10.0)),
        ),
    ]
}

fn intervals(all: &[&Judged]) -> Coverage {
    Coverage::of(visible(all, Role::Single).chain(visible(all, Role::Double)))
}

/// Distances between found and true abscissae of effects that were found under their own names, m.
fn place_errors(all: &[&Judged]) -> Vec<f64> {
    let mut errors = Vec::new();
    for judged in visible(all, Role::Single).chain(visible(all, Role::Double)) {
        for hidden in judged.truth.effects() {
            let Some(x) = hidden.kind.spec().parameters.iter().position(|spec| spec.name == "x") else {
                continue;
            };
            let findings = judged.answer.iter().flat_map(|answer| &answer.findings);
            let own = findings.filter(|found| Name::of(&found.effect) == Name::of(hidden));
            errors.extend(own.map(|found| (found.effect.value(x) - hidden.value(x)).abs()));
        }
    }
    errors
}

/// Single effects that weigh at least [`PLAIN`] and of whose stated names only the true one is acceptable.
fn plain<'a>(all: &'a [&Judged]) -> impl Iterator<Item = &'a Judged> {
    visible(all, Role::Single).filter(|judged| {
        let other = |name: &Name| !judged.hidden().contains(name) && judged.accepts(name);
        judged.size() >= PLAIN && !judged.evidence.others.keys().any(other)
    })
}

/// Answers that name what was hidden and nothing else.
fn right_names<'a>(all: &'a [&Judged]) -> impl Iterator<Item = &'a Judged> {
    all.iter().copied().filter(|judged| {
        let (mut hidden, mut found) = (judged.hidden(), judged.found());
        hidden.sort();
        found.sort();
        judged.answer.is_ok() && judged.truth.role != Role::Outside && hidden == found
    })
}

fn claimed(judged: &Judged) -> bool {
    judged.answer.as_ref().is_ok_and(|answer| answer.findings.iter().any(|f| f.probability >= CLAIMED))
}

fn held_out<'a>(judged: impl Iterator<Item = &'a Judged>) -> impl Iterator<Item = [f64; 2]> {
    judged.filter_map(|judged| judged.answer.as_ref().ok()?.held_out)
}

fn unseen<'a>(judged: impl Iterator<Item = &'a Judged>) -> impl Iterator<Item = [f64; 2]> {
    judged.filter_map(|judged| judged.evidence.unseen)
}
