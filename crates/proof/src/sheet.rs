//! Lines of scores: shares of cases and figures beside their targets, as text and as JSON, alike for every
//! route.

use crate::{CaseLine, Share};
use serde::{Serialize, Serializer};
use std::fmt::{self, Display, Formatter};

/// What a figure should be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(into = "String")]
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
        self.overlaps([value; 2])
    }

    /// Whether an interval holds a value that is what it should be.
    fn overlaps(self, [low, high]: [f64; 2]) -> bool {
        match self {
            Target::AtLeast(least) => high >= least,
            Target::AtMost(most) => low <= most,
            Target::Within(least, most) => high >= least && low <= most,
        }
    }
}

impl Display for Target {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Target::AtLeast(least) => write!(f, "≥ {least}"),
            Target::AtMost(most) => write!(f, "≤ {most}"),
            Target::Within(least, most) => write!(f, "{least} to {most}"),
        }
    }
}

impl From<Target> for String {
    fn from(target: Target) -> Self {
        target.to_string()
    }
}

/// Key in `proof.json`, what is counted or measured, in words, and what it should be.
pub(crate) type Line = (&'static str, &'static str, Option<Target>);

/// A share of cases with its target.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Rate {
    /// Key in `proof.json`.
    #[serde(skip)]
    pub key: &'static str,
    /// How many of how many.
    #[serde(flatten)]
    pub share: Share,
    /// What is counted, in words.
    pub what: &'static str,
    /// What it should be.
    pub target: Option<Target>,
    /// Whether it is; `None` where there is no target or nothing was counted.
    pub met: Option<bool>,
}

/// Whether a share is what it should be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TargetStatus {
    /// It is what it should be.
    Met,
    /// It is not, but its interval holds the target.
    WithinChance,
    /// It is not.
    Missed,
}

impl TargetStatus {
    /// The status in words.
    pub fn says(self) -> &'static str {
        match self {
            TargetStatus::Met => "met",
            TargetStatus::WithinChance => "missed, within chance",
            TargetStatus::Missed => "missed",
        }
    }
}

impl Rate {
    /// The lines of a sheet, each with its share by its key.
    pub(crate) fn all(lines: &[Line], share: impl Fn(&str) -> Share) -> Vec<Rate> {
        let rate = |&(key, what, target): &Line| {
            let share = share(key);
            let met = target.zip(share.value()).map(|(target, value)| target.is_met(value));
            Rate { key, share, what, target, met }
        };
        lines.iter().map(rate).collect()
    }

    /// Whether it is what it should be; `None` where it has none or nothing was counted.
    pub fn status(&self) -> Option<TargetStatus> {
        Some(match (self.met?, self.target?.overlaps(self.share.interval())) {
            (true, _) => TargetStatus::Met,
            (false, true) => TargetStatus::WithinChance,
            (false, false) => TargetStatus::Missed,
        })
    }
}

/// A figure that is no share.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ScoredFigure {
    /// Key in `proof.json`.
    #[serde(skip)]
    pub key: &'static str,
    /// Its value; `None` where no case decides it.
    pub value: Option<f64>,
    /// Number of cases or intervals behind it.
    #[serde(rename = "of")]
    pub from: usize,
    /// What it is, in words.
    pub what: &'static str,
    /// What it should be.
    pub target: Option<Target>,
    /// Whether it is; `None` where there is no target or no case decides it.
    pub met: Option<bool>,
}

impl ScoredFigure {
    /// The lines of a sheet, each with its value by its key, and the number of cases behind it.
    pub(crate) fn all(lines: &[Line], value: impl Fn(&str) -> (Option<f64>, usize)) -> Vec<ScoredFigure> {
        let figure = |&(key, what, target): &Line| {
            let (value, from) = value(key);
            let met = target.zip(value).map(|(target, value)| target.is_met(value));
            ScoredFigure { key, value, from, what, target, met }
        };
        lines.iter().map(figure).collect()
    }
}

/// Number of cases in which as much was hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct RoleCount {
    /// How much was hidden.
    #[serde(skip)]
    pub role: &'static str,
    /// Number of cases.
    pub cases: usize,
    /// In how many of them it shows, where that is counted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub visible: Option<usize>,
    /// In how many of them it is asked for, where that is counted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub asked: Option<usize>,
}

/// Scores that every route has.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Sheet {
    /// Number of cases by what was hidden.
    #[serde(serialize_with = "by_key")]
    pub roles: Vec<RoleCount>,
    /// Shares with targets.
    #[serde(serialize_with = "by_key")]
    pub rates: Vec<Rate>,
    /// Other figures.
    #[serde(serialize_with = "by_key")]
    pub figures: Vec<ScoredFigure>,
    /// Every case.
    #[serde(rename = "cases")]
    pub lines: Vec<CaseLine>,
}

impl Sheet {
    /// The rate of a key.
    pub fn rate(&self, key: &str) -> Option<&Rate> {
        self.rates.iter().find(|rate| rate.key == key)
    }

    /// The figure of a key.
    pub fn figure(&self, key: &str) -> Option<&ScoredFigure> {
        self.figures.iter().find(|figure| figure.key == key)
    }
}

impl Display for Sheet {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for RoleCount { role, cases, visible, asked } in &self.roles {
            match (visible, asked) {
                (Some(visible), _) if *role != "null" => writeln!(f, "  {role:<8} {cases}, {visible} show")?,
                (_, Some(asked)) if *asked > 0 => writeln!(f, "  {role:<8} {cases}, {asked} asked for")?,
                _ => writeln!(f, "  {role:<8} {cases}")?,
            }
        }
        writeln!(f, "\nshares (95 % binomial interval), target:")?;
        for rate in &self.rates {
            let status = rate.status().map_or("", TargetStatus::says);
            write_line(f, rate.what, &counted(rate.share), rate.target, status)?;
        }
        writeln!(f, "\nfigures, target:")?;
        for ScoredFigure { what, value, from, target, met, .. } in &self.figures {
            let shown = value.map_or_else(|| "no case".to_owned(), |value| format!("{value:.3} of {from}"));
            let status = met.map_or("", |met| if met { "met" } else { "missed" });
            write_line(f, what, &shown, *target, status)?;
        }
        Ok(())
    }
}

fn write_line(
    f: &mut Formatter<'_>,
    what: &str,
    shown: &str,
    target: Option<Target>,
    status: &str,
) -> fmt::Result {
    let target = target.map_or_else(String::new, String::from);
    let line = format!("  {what:<60} {shown:<36} {target:<14} {status}");
    writeln!(f, "{}", line.trim_end())
}

/// A share with its interval, for a table.
pub(crate) fn counted(share: Share) -> String {
    let Some(value) = share.value() else { return "no case".to_owned() };
    let [low, high] = share.interval();
    format!("{:>4} of {:<4} {value:.3} ({low:.3} to {high:.3})", share.of, share.all)
}

/// What stands in a file under a key of its own.
pub(crate) trait Keyed {
    /// The key.
    fn key(&self) -> &str;
}

impl Keyed for Rate {
    fn key(&self) -> &str {
        self.key
    }
}

impl Keyed for ScoredFigure {
    fn key(&self) -> &str {
        self.key
    }
}

impl Keyed for RoleCount {
    fn key(&self) -> &str {
        self.role
    }
}

/// A list as a map by its entries' keys.
pub(crate) fn by_key<T: Keyed + Serialize, S: Serializer>(
    list: &[T],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(list.iter().map(|entry| (entry.key(), entry)))
}
