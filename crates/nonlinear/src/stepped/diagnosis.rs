//! The whole answer: what changes from level to level, what it is, where, up to which level, how sure.

use super::forms::{Fitted, fitted};
use super::level::{Held, SteppedLevel};
use super::location::locations;
use super::naming::{Judged, LevelFinding, TriedForm, named_law};
use super::pooled::noisy;
use super::problem::{Change, Level, Problem};
use super::resonance::{Resonance, resonance};
use crate::settings::homogeneity::CHANGED;
use crate::settings::levels::{ABOUT_PEAK, FEWEST_LINES, LEAST_RATIO, SCATTER_DOUBT, WIDTHS};
use crate::{NonlinearOptions, SteppedError};
use jointscope_findings::{HeldOut, Verdict};
use jointscope_fixture::{Fixture, QuantityKey, QuantityOwner};
use jointscope_inference::{each_used_up, fisher_above};
use jointscope_spectra::{Channel, Dof, in_sentence};
use serde::{Serialize, Serializer};
use std::f64::consts::TAU;

/// What one level shows.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LevelResult {
    /// What was held.
    pub held: Held,
    /// The resonance by itself, no fixture needed.
    #[serde(flatten)]
    pub resonance: Resonance,
    /// Amplitude of the joint's relative motion at the peak, m or rad.
    #[serde(rename = "relative_motion")]
    pub motion: f64,
    /// Stiffness across the joint beyond the fixture's, N/m or N·m/rad, and its standard deviation.
    #[serde(rename = "stiffness_beyond_the_fixture", serialize_with = "jointscope_findings::with_std")]
    pub stiffness: (f64, Option<f64>),
    /// Loss stiffness (imaginary part) beyond the fixture's, and its standard deviation.
    #[serde(rename = "loss_stiffness_beyond_the_fixture", serialize_with = "jointscope_findings::with_std")]
    pub loss: (f64, Option<f64>),
    /// Relative error of the FRFs: fixture as stated, refitted, repaired, and with a complex stiffness of its
    /// own.
    #[serde(serialize_with = "by_model")]
    pub nrmse: [f64; 4],
    /// Whether the laws found hold at this level.
    pub explained: bool,
}

fn by_model<S: Serializer>(values: &[f64; 4], serializer: S) -> Result<S::Ok, S::Error> {
    let names = ["nominal", "refitted", "repaired", "stiffness_of_its_own"];
    serializer.collect_map(names.into_iter().zip(values))
}

/// The diagnosis of stepped-sine FRFs at several levels.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SteppedDiagnosis {
    /// What it comes to.
    pub verdict: Verdict,
    /// By level, ascending.
    pub levels: Vec<LevelResult>,
    /// The joint and component to which stiffness and motion belong.
    pub place: (String, Dof),
    /// Probability that levels of a linear structure differ as much, and the ratio of variances.
    pub change: (f64, f64),
    /// Everything tried on all levels, the best first.
    pub tried: Vec<TriedForm>,
    /// The laws found, the strongest first.
    pub findings: Vec<LevelFinding>,
    /// Levels, from the lowest, over which the laws found hold; 0 without laws.
    pub holds: usize,
    /// The levels over which the laws hold, left out of the fit one by one.
    pub held_out: Option<HeldOut>,
    /// The response at which the held amplitude is taken to be, where responses were held and no driving point
    /// tells which.
    pub held_at: Option<Channel>,
    /// Lines in use, Hz.
    pub band: (f64, f64),
    /// Root-mean-square relative errors over the levels: as stated, refitted, repaired, each level with a
    /// stiffness of its own.
    pub nrmse: [f64; 4],
    /// χ² per degree of freedom over all levels: as stated, refitted, repaired; `None` where it is not
    /// finite.
    pub chi2_per_dof: [Option<f64>; 3],
    /// The fixture with the joint's stiffness refitted, and the same with the laws found.
    pub fixtures: [Fixture; 2],
    /// What of the refit the fixture file has no place for, in sentences.
    pub unplaced: Vec<String>,
}

impl SteppedDiagnosis {
    /// Diagnoses FRFs at two or more levels against `fixture`, on the lines about their strongest resonance
    /// within the band.
    ///
    /// # Errors
    /// See [`SteppedError`].
    pub fn of(
        fixture: &Fixture,
        levels: &[SteppedLevel],
        options: &NonlinearOptions,
    ) -> Result<Self, SteppedError> {
        check(levels)?;
        let (levels, band) = about_the_resonance(&with_noise(levels), options.band)?;
        let resonances = resonances(&levels)?;
        let linear = one_stiffness_for_all(fixture, &levels)?;
        let closest = linear.iter().min_by(|a, b| a.0.own_errors().total_cmp(&b.0.own_errors()));
        let change =
            closest.map(|(problem, linear)| changed(problem, linear)).ok_or(SteppedError::NoJoint)?;
        // What does not change is not searched for a law.
        let changes = change.0 < CHANGED;
        let judged: Vec<Judged> =
            each_used_up(linear, |(problem, linear)| Judged::of(problem, linear, changes));
        let best = judged.iter().min_by(|a, b| a.best().nrmse.total_cmp(&b.best().nrmse));
        let best = best.ok_or(SteppedError::NoJoint)?;
        let named = if changes { named_law(&judged) } else { None };
        let named = named.as_ref();
        let Judged { problem, linear, .. } = named.map_or(best, |n| &judged[n.index]);
        let repaired = named.map_or(linear, |n| &n.fit);
        let models = [&Change::default(), &linear.change, &repaired.change];
        let holds = named.map_or(0, |n| n.count);
        let rows = of_levels(problem, &resonances, models, holds);
        let omega = TAU * resonances[0].frequency.0;
        let (refitted, unplaced) = placed(fixture, problem, &linear.change, omega);
        let with_laws = named.map(|n| with_laws(fixture, problem, &n.fit.change, omega));
        let by_fixture = (fixture, options.exact);
        Ok(SteppedDiagnosis {
            verdict: verdict(changes, named.map(|n| n.explains_all(levels.len()))),
            place: (problem.joint.clone(), problem.dof),
            nrmse: over_levels(&rows),
            levels: rows,
            change,
            tried: tried(&judged),
            findings: named.map_or_else(Vec::new, |n| n.findings(&judged, by_fixture)),
            holds,
            held_out: named.and_then(|n| n.held_out()),
            held_at: levels[0].held_at(),
            band,
            chi2_per_dof: chi2_per_dof(problem, models),
            fixtures: [refitted.clone(), with_laws.unwrap_or(refitted)],
            unplaced,
        })
    }
}

/// The levels with their noise, read from all lines before most are cut away.
fn with_noise(levels: &[SteppedLevel]) -> Vec<SteppedLevel> {
    levels.iter().map(|level| SteppedLevel { frfs: noisy(&level.frfs), ..level.clone() }).collect()
}

fn resonances(levels: &[SteppedLevel]) -> Result<Vec<Resonance>, SteppedError> {
    let no_resonance = |level: &SteppedLevel| SteppedError::NoResonance(level.held.to_string());
    levels.iter().map(|level| resonance(level).ok_or_else(|| no_resonance(level))).collect()
}

/// By location, the fit of one complex stiffness for all levels.
fn one_stiffness_for_all(
    fixture: &Fixture,
    levels: &[SteppedLevel],
) -> Result<Vec<(Problem, Fitted)>, SteppedError> {
    let measured: Vec<&SteppedLevel> = levels.iter().collect();
    let linear = |location| {
        let problem = Problem::new(location, &measured)?;
        let linear = fitted(&problem, &[])?;
        Some((problem, linear))
    };
    Ok(locations(fixture, &measured)?.into_iter().filter_map(linear).collect())
}

fn verdict(changes: bool, explains_all: Option<bool>) -> Verdict {
    match explains_all {
        _ if !changes => Verdict::Consistent,
        None => Verdict::Unexplained,
        Some(true) => Verdict::Explained,
        Some(false) => Verdict::PartlyExplained,
    }
}

/// What each level shows; the laws found hold at so many, from the lowest.
fn of_levels(
    problem: &Problem,
    resonances: &[Resonance],
    models: [&Change; 3],
    holds: usize,
) -> Vec<LevelResult> {
    let levels = problem.levels.iter().zip(resonances.iter().copied()).enumerate();
    levels.map(|(index, of_one)| of_level(problem, of_one, models, index < holds)).collect()
}

/// What one level shows, and how far the three models are from it.
fn of_level(
    problem: &Problem,
    (level, resonance): (&Level, Resonance),
    models: [&Change; 3],
    explained: bool,
) -> LevelResult {
    let deviations = problem.delta_deviations(level);
    let std = |k: usize| deviations.as_ref().map(|std| std[k]);
    let [nominal, refitted, repaired] = models.map(|change| problem.error(level, change));
    LevelResult {
        held: level.measured.held,
        resonance,
        motion: level.motion(),
        stiffness: (level.delta.re, std(0)),
        loss: (level.delta.im, std(1)),
        nrmse: [nominal, refitted, repaired, problem.own_error(level)],
        explained,
    }
}

/// Root mean square of the levels' errors, by model.
fn over_levels(levels: &[LevelResult]) -> [f64; 4] {
    let squares = |k: usize| levels.iter().map(|level| level.nrmse[k].powi(2)).sum::<f64>();
    [0, 1, 2, 3].map(|k| (squares(k) / levels.len() as f64).sqrt())
}

/// χ² per degree of freedom that the models leave, where the noise is known.
fn chi2_per_dof(problem: &Problem, models: [&Change; 3]) -> [Option<f64>; 3] {
    let by_noise = problem.by_noise();
    models.map(|change| {
        let fitted = if *change == Change::default() { 0 } else { change.parameters().len() };
        by_noise.as_ref()?.chi2_per_dof(change, fitted)
    })
}

/// Everything tried at all locations, the best first.
fn tried(judged: &[Judged]) -> Vec<TriedForm> {
    let mut tried: Vec<TriedForm> = judged.iter().flat_map(Judged::tried).collect();
    tried.sort_by(|a, b| a.nrmse.total_cmp(&b.nrmse));
    tried
}

/// Refuses levels from which nothing follows.
fn check(levels: &[SteppedLevel]) -> Result<(), SteppedError> {
    let [first, .., last] = levels else { return Err(SteppedError::OneLevel) };
    if let Some(other) =
        levels.iter().find(|l| std::mem::discriminant(&l.held) != std::mem::discriminant(&first.held))
    {
        return Err(SteppedError::Mixed { first: first.held.to_string(), second: other.held.to_string() });
    }
    let amplitudes = || levels.iter().map(|level| level.held.amplitude());
    let (least, most) = (amplitudes().fold(f64::INFINITY, f64::min), amplitudes().fold(0.0, f64::max));
    if most < LEAST_RATIO * least {
        return Err(SteppedError::Alike { first: first.held.to_string(), last: last.held.to_string() });
    }
    Ok(())
}

/// The lines about the strongest resonance of the lowest level, wide enough for all levels.
fn about_the_resonance(
    levels: &[SteppedLevel],
    band: Option<(f64, f64)>,
) -> Result<(Vec<SteppedLevel>, (f64, f64)), SteppedError> {
    let (from, to) = band.unwrap_or((0.0, f64::INFINITY));
    let too_few = |level: &SteppedLevel| SteppedError::TooFewLines(level.held.to_string());
    let cut = |levels: &[SteppedLevel], from: f64, to: f64| {
        levels
            .iter()
            .map(|l| {
                l.within(from, to).filter(|l| l.frfs.lines().len() >= FEWEST_LINES).ok_or_else(|| too_few(l))
            })
            .collect::<Result<Vec<_>, _>>()
    };
    let within = cut(levels, from, to)?;
    let (top, _) = within[0].peak();
    let near = cut(&within, ABOUT_PEAK.0 * top, ABOUT_PEAK.1 * top)?;
    let peaks: Vec<(f64, f64)> = near.iter().map(SteppedLevel::peak).collect();
    let width = WIDTHS * peaks.iter().fold(0.0, |most: f64, p| p.1.max(most));
    let lowest = peaks.iter().fold(top, |least: f64, p| p.0.min(least)) - width;
    let highest = peaks.iter().fold(top, |most: f64, p| p.0.max(most)) + width;
    let used = cut(&near, lowest, highest)?;
    let hz = || used.iter().flat_map(|l| l.frfs.lines().hz().iter().copied());
    let ends = (hz().fold(f64::INFINITY, f64::min), hz().fold(0.0, f64::max));
    Ok((used, ends))
}

/// Probability that one complex stiffness for all levels leaves as much more than one a level by chance, and
/// the ratio of variances. Values are weighed by their own noise, of which only the variation over lines and
/// FRFs counts: its size is that of what the levels' own stiffnesses leave.
fn changed(problem: &Problem, linear: &Fitted) -> (f64, f64) {
    let by_noise = problem.by_noise();
    let problem = by_noise.as_ref().unwrap_or(problem);
    let count = problem.levels.len();
    let Some((_, common)) = problem.fitted(&linear.change) else { return (1.0, 1.0) };
    let own: f64 = problem.levels.iter().map(|level| problem.own_error(level).powi(2)).sum();
    let more = 2.0 * (count - 1) as f64;
    let left = problem.count() as f64 - 2.0 * count as f64 - 1.0;
    let ratio = ((common - own) / more) / (own / left) / SCATTER_DOUBT;
    (fisher_above(ratio, more, left), ratio)
}

/// The fixture with the base stiffness and loss of a change in its joint's file entries; and what has no
/// entry.
fn placed(fixture: &Fixture, problem: &Problem, change: &Change, omega: f64) -> (Fixture, Vec<String>) {
    let mut refitted = fixture.clone();
    let (joint, dof) = (&problem.joint, problem.dof);
    let owner = fixture.joints().iter().position(|j| j.name == *joint).map(QuantityOwner::Joint);
    let index = usize::from(dof == Dof::Rotation);
    let (mut stiff, mut damped) = (false, false);
    for entry in refitted.quantities_mut().into_iter().filter(|entry| Some(entry.owner) == owner) {
        if entry.key == QuantityKey::JointStiffness(index, index) {
            entry.quantity.value += change.base.re;
            stiff = true;
        } else if entry.key == QuantityKey::JointDamping(index, index) {
            let value = entry.quantity.value + change.base.im / omega;
            damped = value >= 0.0;
            entry.quantity.value = value.max(0.0);
        }
    }
    let unit = if dof == Dof::Rotation { "N·m/rad" } else { "N/m" };
    let mut unplaced = Vec::new();
    if !stiff {
        unplaced.push(format!(
            "The levels ask for {} {unit} more in {} of joint {joint} than its beam has; refitted.json and repaired.json cannot state that of a beam and leave it out.",
            four_digits(change.base.re), dof.name()
        ));
    }
    if !damped {
        unplaced.push(format!(
            "The levels ask for a loss stiffness of {} {unit} in {} of joint {joint} beyond the fixture's damping at {} Hz; the joint states no `damping` that could take it, so the written fixtures leave it out.",
            four_digits(change.base.im), dof.name(), in_sentence(omega / TAU)
        ));
    }
    (refitted, unplaced)
}

/// A stiffness of four significant digits.
fn four_digits(value: f64) -> String {
    let decimals = 3.0 - value.abs().max(f64::MIN_POSITIVE).log10().floor();
    format!("{value:.*}", decimals.clamp(0.0, 9.0) as usize)
}

fn with_laws(fixture: &Fixture, problem: &Problem, change: &Change, omega: f64) -> Fixture {
    let (base, _) = placed(fixture, problem, change, omega);
    let mut physics = base.physics().to_vec();
    physics.extend(change.laws.iter().map(|law| law.to_effect(&problem.joint, problem.dof)));
    base.clone().with_physics(physics).unwrap_or(base)
}
