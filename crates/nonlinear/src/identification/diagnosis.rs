//! The whole answer: does anything change with amplitude, what is it, where, how strong, how sure.

use super::candidates::seats;
use super::fit::Fit;
use super::homogeneity::{CHANGED, Homogeneity, homogeneity};
use super::judge::{Judgement, Step};
use super::parameters::{Parameters, Tolerance};
use super::records::{Record, held_out, records};
use super::search::{Search, Span};
use super::spectra::Transform;
use crate::{DiagnoseError, ForceStateError, ForceStateMap};
use jointscope_fixture::{BodyKind, Dof, Effect, Fixture, ParameterSpec};
use jointscope_hits::Hit;
use jointscope_lumped::StateSpace;
use jointscope_spectra::Channel;

/// What a diagnosis of hits concludes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// FRFs do not change with the strength of the hits: a linear diagnosis applies.
    Homogeneous,
    /// The laws found explain how the responses change with strength.
    Explained,
    /// The laws found are needed, and something is left.
    PartlyExplained,
    /// Responses change with strength in a way that no law known here accounts for.
    Unexplained,
}

/// A parameter of a law, SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Name and range.
    pub parameter: ParameterSpec,
    /// Its unit, by the degree of freedom.
    pub unit: &'static str,
    /// The value.
    pub value: f64,
    /// One standard deviation; `None` where the hits do not determine it.
    pub std: Option<f64>,
    /// 95 % interval.
    pub interval: Option<[f64; 2]>,
}

/// A law that the hits need.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// Kind, joint, dof and parameters.
    pub effect: Effect,
    /// Parameters with their uncertainty.
    pub estimates: Vec<Estimate>,
    /// Probability of kind, joint and dof together.
    pub probability: f64,
    /// Other names for it, the most probable first.
    pub alternatives: Vec<(Effect, f64)>,
    /// What χ² and priors lose without it.
    pub gain: f64,
    /// Largest relative motion d of its joint under the hits, m or rad.
    pub reach: f64,
}

/// A fixture and how well it follows the recorded responses.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelFit {
    /// The fixture at its fitted quantities.
    pub fixture: Fixture,
    /// √(Σ|simulated − recorded|²/Σ|recorded|²) over all hits in the band.
    pub nrmse: f64,
    /// χ² per degree of freedom.
    pub chi2_per_dof: f64,
    /// Quantities that could move, and where each ended in its standard deviations.
    pub tolerances: Vec<(Tolerance, f64)>,
}

/// Hits that no fit saw.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldOut {
    /// Their numbers.
    pub hits: Vec<u32>,
    /// Error of the refitted linear fixture there.
    pub nrmse_refitted: f64,
    /// Error of the repaired one.
    pub nrmse_repaired: f64,
}

/// Component of a joint and the largest motion that the hits drive it to.
#[derive(Debug, Clone, PartialEq)]
pub struct Reach {
    /// The joint.
    pub joint: String,
    /// Which component of d.
    pub dof: Dof,
    /// The linear fixture's largest d, m or rad.
    pub motion: f64,
    /// The joint's own force there, N or N·m.
    pub force: f64,
}

/// What to use of the hits.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NonlinearOptions {
    /// Band that is compared, Hz; chosen from hammer and fixture without.
    pub band: Option<(f64, f64)>,
    /// Take the fixture's bare numbers as exact.
    pub exact: bool,
}

/// The diagnosis of a joint from hits of several strengths.
#[derive(Debug, Clone, PartialEq)]
pub struct NonlinearDiagnosis {
    /// What it comes to.
    pub verdict: Verdict,
    /// Whether FRFs change with the strength of the hits.
    pub homogeneity: Homogeneity,
    /// The laws found, the strongest first.
    pub findings: Vec<Finding>,
    /// The file's fixture, the refitted one without laws, the repaired one; `None` where nothing changes with amplitude.
    pub models: Option<[ModelFit; 3]>,
    /// The judgement on hits that no fit saw.
    pub held_out: Option<HeldOut>,
    /// How far the hits drive each joint.
    pub reach: Vec<Reach>,
    /// Force–state maps under the strongest hit, of the joints with a law, or of all where no law was found; for each that cannot be drawn, why.
    pub maps: Vec<Result<ForceStateMap, ForceStateError>>,
    /// Band that was compared, Hz.
    pub band: (f64, f64),
    /// Time after the blow, s, up to which the shortest of the hits was followed, where not all were to their end: later the motion depends on
    /// more than the force is known to.
    pub followed: Option<f64>,
}

/// χ² per degree of freedom, and error relative to the responses, above which a second law is looked for.
const SEEK_MORE: (f64, f64) = (3.0, 0.05);
/// Multiple of the highest elastic frequency up to which a force–state map goes.
const HARMONIC: f64 = 3.5;
/// Laws at the most.
const MOST_LAWS: usize = 2;
/// Share of what is left of χ² beyond noise that the first law, and a further one, must explain to be named: a fit caught in a false minimum
/// explains a part, and no name should be given for it.
const WORTH: [f64; 2] = [0.75, 0.1];

impl NonlinearDiagnosis {
    /// Diagnoses `hits` against `fixture`.
    ///
    /// # Errors
    /// Hits that cannot be used (see [`DiagnoseError`]), above all hits that are all alike.
    pub fn of(fixture: &Fixture, hits: &[Hit], options: &NonlinearOptions) -> Result<Self, DiagnoseError> {
        let all = records(fixture, hits)?;
        let elastic = elastic_band(fixture, &all)?;
        let band = options.band.unwrap_or((0.0, default_highest(fixture, &all, elastic.1)));
        let homogeneity = homogeneity(&all, band.1);
        let references: Vec<&Record> = all.iter().collect();
        let found = seats(fixture, &references, 2.0 * band.1);
        let reach = found
            .iter()
            .map(|s| Reach {
                joint: s.joint.clone(),
                dof: s.dof,
                motion: s.reach,
                force: s.stiffness * s.reach,
            })
            .collect();
        let mut diagnosis = NonlinearDiagnosis {
            verdict: Verdict::Homogeneous,
            homogeneity,
            findings: Vec::new(),
            models: None,
            held_out: None,
            reach,
            maps: Vec::new(),
            band,
            followed: None,
        };
        if diagnosis.homogeneity.p_value >= CHANGED {
            return Ok(diagnosis);
        }
        diagnosis.search(fixture, &all, elastic, options)?;
        diagnosis.map(&all, elastic);
        Ok(diagnosis)
    }

    fn map(&mut self, all: &[Record], elastic: (f64, f64)) {
        let strongest = all.iter().max_by(|a, b| a.hit.peak_force().total_cmp(&b.hit.peak_force()));
        let (Some([.., repaired]), Some(record)) = (&self.models, strongest) else { return };
        let mut joints: Vec<String> = self.findings.iter().map(|f| f.effect.place.to_string()).collect();
        if joints.is_empty() {
            joints = repaired.fixture.joints().iter().map(|j| j.name.clone()).collect();
        }
        joints.dedup();
        // Harmonics of the motion, as far as the sampling goes.
        let highest = (HARMONIC * elastic.1).max(self.band.1).min(0.45 / record.hit.interval());
        let band = (0.5 * elastic.0, highest);
        let map = |joint: &String| ForceStateMap::of(&repaired.fixture, joint, &record.hit, band);
        self.maps = joints.iter().map(map).collect();
    }

    fn search(
        &mut self,
        fixture: &Fixture,
        all: &[Record],
        elastic: (f64, f64),
        options: &NonlinearOptions,
    ) -> Result<(), DiagnoseError> {
        let held = held_out(all);
        let training = all.iter().enumerate().filter(|(i, _)| !held.contains(i)).map(|(_, r)| r);
        let search = Search::new(training.collect(), self.band, elastic);
        let channels: Vec<String> = all
            .iter()
            .flat_map(|r| r.readings.iter().map(|(c, _)| c).chain([r.struck()]))
            .map(|c: &Channel| c.point.clone())
            .collect();
        let nominal = Parameters::nominal(fixture, options.exact, &channels);
        let unmoved = || DiagnoseError::NoMotion;
        let refitted = search.refitted(&nominal).ok_or_else(unmoved)?;
        let mut steps: Vec<Step> = Vec::new();
        let mut best = refitted.clone();
        let mut span = Span::default();
        let mut whole = search.view(&span);
        for count in 0..MOST_LAWS {
            let enough = || {
                best.chi2 / whole.degrees() < SEEK_MORE.0
                    || whole.nrmse(&best.parameters).is_none_or(|e| e < SEEK_MORE.1)
            };
            if count > 0 && enough() {
                break;
            }
            let base = if count == 0 { nominal.clone() } else { best.parameters.clone() };
            let model = base.to_fixture().unwrap_or_else(|_| fixture.clone());
            let (names, followed) = search.names(&model, &base);
            let Some(first) = names.first() else { break };
            // What is not followed counts for neither.
            whole = search.view(&followed);
            let before = Fit::of(&whole, &best.parameters, 1).ok_or_else(unmoved)?;
            let excess = |fit: &Fit| (fit.objective - whole.degrees()).max(0.0);
            let worth = WORTH[count.min(1)];
            if excess(&first.fit) > (1.0 - worth) * excess(&before)
                || first.fit.objective + 30.0 > before.objective
            {
                break;
            }
            best = first.fit.clone();
            let gain = before.objective - best.objective;
            steps.push(Step { names, gain });
            span = followed;
        }
        let judgement = Judgement { all, held: &held, search: &search, span: &span, band: self.band };
        let judged = judgement.of([&nominal, &refitted.parameters], &best, &steps).ok_or_else(unmoved)?;
        self.verdict = judged.verdict;
        self.findings = judged.findings;
        self.models = Some(judged.models);
        self.held_out = judged.held_out;
        self.followed = judged.followed;
        Ok(())
    }
}

/// Lowest and highest elastic frequency of the fixture's bodies and joints within half the sampling rate, Hz.
fn elastic_band(fixture: &Fixture, records: &[Record]) -> Result<(f64, f64), DiagnoseError> {
    let nyquist = records.iter().map(|r| 0.5 / r.hit.interval()).fold(f64::INFINITY, f64::min);
    StateSpace::new(fixture, nyquist).map_err(crate::SimulationError::from)?;
    let plain = jointscope_lumped::Assembly::new(fixture, nyquist).map_err(crate::SimulationError::from)?;
    let all = plain.natural_frequencies_hz();
    let elastic: Vec<f64> = all.into_iter().filter(|f| *f > 0.0 && *f < nyquist).collect();
    match (elastic.first(), elastic.last()) {
        (Some(first), Some(last)) => Ok((*first, *last)),
        _ => Err(DiagnoseError::NoElasticMotion { highest: nyquist }),
    }
}

/// Share of its largest line at which a force's spectrum ends.
const FORCE_ENDS: f64 = 0.03;

/// Where the hammer's force, the sensors' sampling or the fixture's own motions end.
fn default_highest(fixture: &Fixture, records: &[Record], elastic: f64) -> f64 {
    let mut highest = f64::INFINITY;
    for record in records {
        let force = record.hit.force();
        let nyquist = 0.5 / record.hit.interval();
        let lines = Transform::new(force.len()).of(&mut force.to_vec());
        let most = lines.iter().map(|l| l.norm()).fold(0.0, f64::max);
        let end = lines.iter().position(|l| l.norm() < FORCE_ENDS * most).unwrap_or(lines.len());
        highest = highest.min(nyquist * (end as f64 / lines.len() as f64)).min(0.8 * nyquist);
    }
    let rigid = fixture.bodies().iter().all(|b| matches!(b.kind, BodyKind::Rigid(_)));
    if rigid { highest.min(2.0 * elastic).max(elastic.min(highest)) } else { highest }
}
