//! The whole answer: does anything change with amplitude, what is it, where, how strong, how sure.

use super::homogeneity::{Homogeneity, homogeneity};
use super::hypothesis::Hypothesis;
use super::judge::{HitFinding, Judged, Judgement, ModelFit};
use super::laws::Laws;
use super::locations::{JointLocation, locations};
use super::records::{Record, held_out, records};
use super::search::Search;
use crate::settings::band::{BEYOND_BAND, BEYOND_ELASTIC, FORCE_ENDS, SAMPLING_ENDS};
use crate::settings::homogeneity::CHANGED;
use crate::settings::map::{FROM_LOWEST, HARMONIC, SAMPLED_SHARE};
use crate::spectra::Compared;
use crate::{DiagnoseError, ForceStateError, ForceStateMap, SimulationError};
use jointscope_findings::{HeldOut, Verdict};
use jointscope_fixture::{BodyKind, Dof, Fixture};
use jointscope_hits::{Fourier, Hit};
use jointscope_lumped::{Assembly, StateSpace};
use serde::Serialize;

/// Component of a joint and the largest motion that the hits drive it to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reach {
    /// The joint.
    pub joint: String,
    /// Which component of d.
    pub dof: Dof,
    /// The linear fixture's largest d, m or rad.
    #[serde(rename = "largest_relative_motion")]
    pub motion: f64,
    /// The joint's own force there, N or N·m.
    #[serde(rename = "force_of_the_joint")]
    pub force: f64,
}

/// What to use of the hits.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NonlinearOptions {
    /// Band that is compared, Hz; chosen from hammer and fixture without.
    pub band: Option<(f64, f64)>,
    /// Bands of hits to leave out, Hz; levels come without them.
    pub exclude: Vec<(f64, f64)>,
    /// Take the fixture's bare numbers as exact.
    pub exact: bool,
}

/// The diagnosis of a joint from hits of several strengths.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct NonlinearDiagnosis {
    /// What it comes to.
    pub verdict: Verdict,
    /// Whether FRFs change with the strength of the hits.
    pub homogeneity: Homogeneity,
    /// The laws found, the strongest first.
    pub findings: Vec<HitFinding>,
    /// The file's fixture, the refitted one without laws, the repaired one; `None` where nothing changes with
    /// amplitude.
    pub models: Option<[ModelFit; 3]>,
    /// The judgement on hits that no fit saw.
    pub held_out: Option<HeldOut>,
    /// How far the hits drive each joint.
    pub reach: Vec<Reach>,
    /// Force–state maps under the strongest hit, of the joints with a law, or of all where no law was found;
    /// for each that cannot be drawn, why.
    pub maps: Vec<Result<ForceStateMap, ForceStateError>>,
    /// Band that was compared, Hz.
    pub band: (f64, f64),
    /// Time after the blow, s, up to which the shortest of the hits was followed, where not all were to their
    /// end: later the motion depends on more than the force is known to.
    pub followed: Option<f64>,
}

impl NonlinearDiagnosis {
    /// Diagnoses `hits` against `fixture`.
    ///
    /// # Errors
    /// Hits that cannot be used (see [`DiagnoseError`]), above all hits that are all alike.
    pub fn of(fixture: &Fixture, hits: &[Hit], options: &NonlinearOptions) -> Result<Self, DiagnoseError> {
        let all = records(fixture, hits)?;
        let elastic = elastic_band(fixture, &all)?;
        let band = options.band.unwrap_or((0.0, default_highest(fixture, &all, elastic.1)));
        let lines = Compared { band, exclude: &options.exclude };
        let references: Vec<&Record> = all.iter().collect();
        let reach = |location: JointLocation| Reach {
            joint: location.joint,
            dof: location.dof,
            motion: location.reach,
            force: location.stiffness * location.reach,
        };
        let mut diagnosis = NonlinearDiagnosis {
            verdict: Verdict::Consistent,
            homogeneity: homogeneity(&all, lines),
            findings: Vec::new(),
            models: None,
            held_out: None,
            reach: locations(fixture, &references, BEYOND_BAND * band.1).into_iter().map(reach).collect(),
            maps: Vec::new(),
            band,
            followed: None,
        };
        if diagnosis.homogeneity.p_value >= CHANGED {
            return Ok(diagnosis);
        }
        let judged = judged(fixture, &all, (lines, elastic), options.exact).ok_or(DiagnoseError::NoMotion)?;
        diagnosis.maps = maps(&judged, &all, (lines, elastic));
        let Judged { verdict, findings, models, held_out, followed } = judged;
        Ok(NonlinearDiagnosis { verdict, findings, models: Some(models), held_out, followed, ..diagnosis })
    }
}

/// Lines that are compared, and lowest and highest elastic frequency, Hz.
type Bands<'a> = (Compared<'a>, (f64, f64));

/// Searches for effects on the hits that are not held out, one after the other, and judges them; `None` for a
/// fixture without a finite motion.
fn judged(fixture: &Fixture, all: &[Record], (lines, elastic): Bands, exact: bool) -> Option<Judged> {
    let held = held_out(all);
    let training = all.iter().enumerate().filter(|(i, _)| !held.contains(i)).map(|(_, r)| r);
    let search = Search::new(training.collect(), lines, elastic);
    let channels = all.iter().flat_map(|r| r.readings.iter().map(|(c, _)| c).chain([r.struck()]));
    let points: Vec<String> = channels.map(|channel| channel.point.clone()).collect();
    let nominal = Hypothesis::nominal(fixture, exact, &points);
    let refitted = search.refitted(&nominal)?;
    let Laws { best, steps, span, .. } = Laws::found(&search, fixture, &nominal, &refitted)?;
    let judgement = Judgement { all, held: &held, search: &search, span: &span };
    judgement.of([&nominal, &refitted.hypothesis], &best, &steps)
}

/// Force–state maps under the strongest hit.
fn maps(
    judged: &Judged,
    all: &[Record],
    (lines, elastic): Bands,
) -> Vec<Result<ForceStateMap, ForceStateError>> {
    let strongest = all.iter().max_by(|a, b| a.hit.peak_force().total_cmp(&b.hit.peak_force()));
    let [.., repaired] = &judged.models;
    let mut joints: Vec<String> = judged.findings.iter().map(|f| f.effect.place.to_string()).collect();
    if joints.is_empty() {
        joints = repaired.fixture.joints().iter().map(|j| j.name.clone()).collect();
    }
    joints.dedup();
    let of_record = |record: &Record| {
        // Harmonics of the motion, as far as the sampling goes.
        let highest = (HARMONIC * elastic.1).max(lines.band.1).min(SAMPLED_SHARE / record.hit.interval());
        let band = (FROM_LOWEST * elastic.0, highest);
        let map = |joint: &String| ForceStateMap::of(&repaired.fixture, joint, &record.hit, band);
        joints.iter().map(map).collect()
    };
    strongest.map_or(Vec::new(), of_record)
}

/// Lowest and highest elastic frequency of the fixture's bodies and joints within half the sampling rate, Hz.
fn elastic_band(fixture: &Fixture, records: &[Record]) -> Result<(f64, f64), DiagnoseError> {
    let nyquist = records.iter().map(|r| 0.5 / r.hit.interval()).fold(f64::INFINITY, f64::min);
    StateSpace::new(fixture, nyquist).map_err(SimulationError::from)?;
    let plain = Assembly::new(fixture, nyquist).map_err(SimulationError::from)?;
    let all = plain.natural_frequencies_hz();
    let elastic: Vec<f64> = all.into_iter().filter(|f| *f > 0.0 && *f < nyquist).collect();
    match (elastic.first(), elastic.last()) {
        (Some(first), Some(last)) => Ok((*first, *last)),
        _ => Err(DiagnoseError::NoElasticMotion(nyquist)),
    }
}

/// Where the hammer's force, the sensors' sampling or the fixture's own motions end.
fn default_highest(fixture: &Fixture, records: &[Record], elastic: f64) -> f64 {
    let mut highest = f64::INFINITY;
    for record in records {
        let force = record.hit.force();
        let nyquist = 0.5 / record.hit.interval();
        let lines = Fourier::new(force.len()).lines(&mut force.to_vec());
        let most = lines.iter().map(|l| l.norm()).fold(0.0, f64::max);
        let end = lines.iter().position(|l| l.norm() < FORCE_ENDS * most).unwrap_or(lines.len());
        highest = highest.min(nyquist * (end as f64 / lines.len() as f64)).min(SAMPLING_ENDS * nyquist);
    }
    let rigid = fixture.bodies().iter().all(|b| matches!(b.kind, BodyKind::Rigid(_)));
    if rigid { highest.min(BEYOND_ELASTIC * elastic).max(elastic.min(highest)) } else { highest }
}
