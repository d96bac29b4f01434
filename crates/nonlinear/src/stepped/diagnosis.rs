//! The whole answer: what changes from level to level, what it is, where, up to which level, how sure.

use super::judge::{Fitted, Form, fitted};
use super::level::{Held, SteppedLevel};
use super::model::{Change, Subject};
use super::naming::{Judged, named_law};
use super::resonance::{Resonance, resonance};
use super::seat::seats;
use crate::distribution::f_tail;
use crate::{CHANGED, Estimate, SteppedError, Verdict};
use jointscope_fixture::{Effect, Fixture};
use jointscope_spectra::Dof;
use std::f64::consts::TAU;

/// What one level shows.
#[derive(Debug, Clone, PartialEq)]
pub struct LevelResult {
    /// What was held.
    pub held: Held,
    /// The resonance by itself, no fixture needed.
    pub resonance: Resonance,
    /// Amplitude of the joint's relative motion at the peak, m or rad.
    pub motion: f64,
    /// Stiffness across the joint beyond the fixture's, N/m or N·m/rad, and its standard deviation.
    pub stiffness: (f64, Option<f64>),
    /// Loss stiffness (imaginary part) beyond the fixture's, and its standard deviation.
    pub loss: (f64, Option<f64>),
    /// Relative error of the FRFs: fixture as stated, refitted, repaired, and with a complex stiffness of its own.
    pub nrmse: [f64; 4],
}

/// A form tried at a component of a joint.
#[derive(Debug, Clone, PartialEq)]
pub struct Tried {
    /// The joint.
    pub joint: String,
    /// Which component of d.
    pub dof: Dof,
    /// Names of the effects, `linear` for none.
    pub form: &'static str,
    /// Root mean square over the levels of the relative errors.
    pub nrmse: f64,
    /// Share of the change with level that it explains, 0 to 1.
    pub share: f64,
}

/// A law that the levels need.
#[derive(Debug, Clone, PartialEq)]
pub struct LevelFinding {
    /// Kind, joint, dof and parameters.
    pub effect: Effect,
    /// Parameters with their uncertainty.
    pub estimates: Vec<Estimate>,
    /// Probability of kind, joint and dof together.
    pub probability: f64,
    /// Other names for it, the most probable first.
    pub alternatives: Vec<(Effect, f64)>,
    /// Share of the change with level that the laws found explain over the range.
    pub share: f64,
    /// Relative motions of the joint over the range, m or rad.
    pub motions: (f64, f64),
}

/// The diagnosis of stepped-sine FRFs at several levels.
#[derive(Debug, Clone, PartialEq)]
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
    pub tried: Vec<Tried>,
    /// The laws found, the strongest first.
    pub findings: Vec<LevelFinding>,
    /// Levels, from the lowest, over which the laws found hold; 0 without laws.
    pub holds: usize,
    /// Relative errors of the levels left out of the fit one by one, refitted and repaired; those over which the laws hold.
    pub left_out: Option<[f64; 2]>,
    /// Lines in use, Hz.
    pub band: (f64, f64),
    /// Root-mean-square relative errors over the levels: as stated, refitted, repaired, each level with a stiffness of its own.
    pub nrmse: [f64; 4],
    /// The fixture with the joint's stiffness refitted, and the same with the laws found.
    pub fixtures: [Fixture; 2],
    /// What of the refit the fixture file has no place for, in sentences.
    pub unplaced: Vec<String>,
}

/// Share of the change with level from which a law leaves nothing worth a word.
const ALL: f64 = 0.95;
/// Half-power widths about the resonances that are used.
const WIDTHS: f64 = 10.0;

impl SteppedDiagnosis {
    /// Diagnoses FRFs at two or more levels against `fixture`, on the lines about their strongest resonance within `band` (Hz).
    ///
    /// # Errors
    /// See [`SteppedError`].
    pub fn of(
        fixture: &Fixture,
        levels: &[SteppedLevel],
        band: Option<(f64, f64)>,
    ) -> Result<Self, SteppedError> {
        let (levels, band) = about_the_resonance(levels, band)?;
        let resonances = levels
            .iter()
            .map(|level| {
                resonance(level).ok_or_else(|| SteppedError::NoResonance { level: level.held.to_string() })
            })
            .collect::<Result<Vec<_>, _>>()?;
        let all = seats(fixture, &levels)?;
        let subjects: Vec<Subject> = all.into_iter().filter_map(|seat| Subject::new(seat, &levels)).collect();
        let linear: Vec<Option<Fitted>> = subjects.iter().map(|s| fitted(s, Form::Linear)).collect();
        let judged: Vec<Judged> = subjects
            .iter()
            .zip(linear)
            .filter_map(|(subject, linear)| Some(Judged::of(subject, linear?)))
            .collect();
        let best = judged.iter().min_by(|a, b| a.best().nrmse.total_cmp(&b.best().nrmse));
        let best = best.ok_or(SteppedError::NoJoint)?;
        let change = changed(best.subject, &best.linear);
        let mut verdict = Verdict::Homogeneous;
        let mut named = None;
        if change.0 < CHANGED {
            named = named_law(&judged);
            verdict = match &named {
                None => Verdict::Unexplained,
                Some(n) if n.count == levels.len() && n.share >= ALL => Verdict::Explained,
                Some(_) => Verdict::PartlyExplained,
            };
        }
        let subject = named.as_ref().map_or(best.subject, |n| judged[n.index].subject);
        let base = named.as_ref().map_or(&best.linear, |n| &judged[n.index].linear);
        let repaired = named.as_ref().map_or(base, |n| &n.fit);
        let stated = Change { log_gain: 0.0, base: 0.0.into(), laws: Vec::new() };
        let rows = (0..levels.len()).map(|l| {
            let (delta, std) = (subject.free.1[l], subject.deviation(l));
            LevelResult {
                held: levels[l].held,
                resonance: resonances[l],
                motion: subject.motion(l),
                stiffness: (delta.re, std.map(|s| s[0])),
                loss: (delta.im, std.map(|s| s[1])),
                nrmse: [
                    subject.error_of(l, &stated),
                    subject.error_of(l, &base.change),
                    subject.error_of(l, &repaired.change),
                    subject.free_error(l),
                ],
            }
        });
        let rows: Vec<LevelResult> = rows.collect();
        let mean =
            |k: usize| (rows.iter().map(|r| r.nrmse[k].powi(2)).sum::<f64>() / rows.len() as f64).sqrt();
        let nrmse = [mean(0), mean(1), mean(2), mean(3)];
        let mut tried: Vec<Tried> = judged.iter().flat_map(Judged::tried).collect();
        tried.sort_by(|a, b| a.nrmse.total_cmp(&b.nrmse));
        let omega = TAU * resonances[0].frequency.0;
        let (refitted, unplaced) = placed(fixture, subject, &base.change, omega);
        let repaired_fixture = match &named {
            None => refitted.clone(),
            Some(n) => with_laws(fixture, subject, &n.fit.change, omega),
        };
        let findings = named.as_ref().map_or_else(Vec::new, |n| n.findings(&judged));
        let left_out = named.as_ref().and_then(|n| n.left_out());
        Ok(SteppedDiagnosis {
            verdict,
            place: (subject.seat.joint.clone(), subject.dof()),
            levels: rows,
            change,
            tried,
            findings,
            holds: named.as_ref().map_or(0, |n| n.count),
            left_out,
            band,
            nrmse,
            fixtures: [refitted, repaired_fixture],
            unplaced,
        })
    }
}

/// The lines about the strongest resonance of the lowest level, wide enough for all levels.
fn about_the_resonance(
    levels: &[SteppedLevel],
    band: Option<(f64, f64)>,
) -> Result<(Vec<SteppedLevel>, (f64, f64)), SteppedError> {
    let (from, to) = band.unwrap_or((0.0, f64::INFINITY));
    let too_few = |level: &SteppedLevel| SteppedError::TooFewLines { level: level.held.to_string() };
    let cut = |levels: &[SteppedLevel], from: f64, to: f64| {
        levels
            .iter()
            .map(|l| l.within(from, to).filter(|l| l.frfs.lines().len() >= 8).ok_or_else(|| too_few(l)))
            .collect::<Result<Vec<_>, _>>()
    };
    let within = cut(levels, from, to)?;
    if within.len() < 2 {
        return Err(SteppedError::OneLevel);
    }
    let (top, _) = within[0].peak();
    let near = cut(&within, 0.85 * top, 1.15 * top)?;
    let peaks: Vec<(f64, f64)> = near.iter().map(SteppedLevel::peak).collect();
    let width = WIDTHS * peaks.iter().fold(0.0, |most: f64, p| p.1.max(most));
    let lowest = peaks.iter().fold(top, |least: f64, p| p.0.min(least)) - width;
    let highest = peaks.iter().fold(top, |most: f64, p| p.0.max(most)) + width;
    let used = cut(&near, lowest, highest)?;
    let hz = || used.iter().flat_map(|l| l.frfs.lines().hz().iter().copied());
    let ends = (hz().fold(f64::INFINITY, f64::min), hz().fold(0.0, f64::max));
    Ok((used, ends))
}

/// Probability that one complex stiffness for all levels leaves as much more than one a level by chance, and the ratio of variances.
fn changed(subject: &Subject, linear: &Fitted) -> (f64, f64) {
    let count = subject.levels.len();
    let factors: Vec<f64> = (0..count).map(|l| subject.free_error(l).max(1e-12).recip()).collect();
    let Some((_, common)) = subject.fitted(&linear.change, Some(&factors)) else { return (1.0, 1.0) };
    // By the weights each level's own fit leaves 1.
    let own = count as f64;
    let more = 2.0 * (count - 1) as f64;
    let left = subject.count() as f64 - 2.0 * own - 1.0;
    let ratio = ((common - own) / more) / (own / left);
    (f_tail(ratio, more, left), ratio)
}

/// The fixture with the base stiffness and loss of a change in its joint's file entries; and what has no entry.
fn placed(fixture: &Fixture, subject: &Subject, change: &Change, omega: f64) -> (Fixture, Vec<String>) {
    let mut refitted = fixture.clone();
    let (joint, dof) = (&subject.seat.joint, subject.dof());
    let index = usize::from(dof == Dof::Rotation);
    let (mut stiff, mut damped) = (false, false);
    for entry in refitted.quantities_mut() {
        if entry.path == format!("joints/{joint}/stiffness/{index}/{index}") {
            entry.quantity.value += change.base.re;
            stiff = true;
        } else if entry.path == format!("joints/{joint}/damping/{index}/{index}") {
            let value = entry.quantity.value + change.base.im / omega;
            damped = value >= 0.0;
            entry.quantity.value = value.max(0.0);
        }
    }
    let unit = if dof == Dof::Rotation { "N*m/rad" } else { "N/m" };
    let mut unplaced = Vec::new();
    if !stiff {
        unplaced.push(format!(
            "The levels ask for {:.4e} {unit} more in {} of joint {joint} than its beam has; refitted.json and repaired.json cannot state that of a beam and leave it out.",
            change.base.re, dof.name()
        ));
    }
    if !damped {
        unplaced.push(format!(
            "The levels ask for a loss stiffness of {:.4e} {unit} in {} of joint {joint} beyond the fixture's damping at {:.2} Hz; the joint states no `damping` that could take it, so the written fixtures leave it out.",
            change.base.im, dof.name(), omega / TAU
        ));
    }
    (refitted, unplaced)
}

fn with_laws(fixture: &Fixture, subject: &Subject, change: &Change, omega: f64) -> Fixture {
    let (base, _) = placed(fixture, subject, change, omega);
    let mut physics = base.physics().to_vec();
    physics.extend(change.laws.iter().map(|law| law.to_effect(&subject.seat.joint, subject.dof())));
    base.clone().with_physics(physics).unwrap_or(base)
}
