//! The whole answer: does anything change with amplitude, what is it, where, how strong, how sure.

use super::candidates::seats;
use super::fit::Fit;
use super::homogeneity::{CHANGED, Homogeneity, homogeneity};
use super::misfit::{Focus, View};
use super::parameters::{Law, Parameters, Tolerance};
use super::records::{Record, held_out, records};
use super::search::{Named, Search};
use super::spectra::Transform;
use crate::{DiagnoseError, ForceStateError, ForceStateMap, RestoringLaw};
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
}

/// χ² per degree of freedom above which a model leaves something unexplained.
const LEFT_OVER: f64 = 1.5;
/// χ² per degree of freedom, and error relative to the responses, above which a second law is looked for.
const SEEK_MORE: (f64, f64) = (3.0, 0.05);
/// How much finer the last fit steps than the search.
const FINER: usize = 2;
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
        let whole = search.whole();
        let degrees = whole.degrees();
        let mut steps: Vec<Vec<Named>> = Vec::new();
        let mut best = refitted.clone();
        for count in 0..MOST_LAWS {
            let enough = || {
                best.chi2 / degrees < SEEK_MORE.0
                    || whole.nrmse(&best.parameters).is_none_or(|e| e < SEEK_MORE.1)
            };
            if count > 0 && enough() {
                break;
            }
            let base = if count == 0 { nominal.clone() } else { best.parameters.clone() };
            let model = base.to_fixture().unwrap_or_else(|_| fixture.clone());
            let names = search.names(&model, &base);
            let Some(first) = names.first() else { break };
            let excess = |fit: &Fit| (fit.objective - degrees).max(0.0);
            let worth = WORTH[count.min(1)];
            if excess(&first.fit) > (1.0 - worth) * excess(&best)
                || first.fit.objective + 30.0 > best.objective
            {
                break;
            }
            best = first.fit.clone();
            steps.push(names);
        }
        self.judge(fixture, all, &held, &search, [&refitted, &best], &steps, &nominal).ok_or_else(unmoved)
    }

    #[allow(clippy::too_many_arguments)]
    fn judge(
        &mut self,
        fixture: &Fixture,
        all: &[Record],
        held: &[usize],
        search: &Search,
        [refitted, best]: [&Fit; 2],
        steps: &[Vec<Named>],
        nominal: &Parameters,
    ) -> Option<()> {
        let focus = Focus { decay: 0.0, band: self.band, within: search.within(), halvings: 4 };
        if !held.is_empty() {
            let unseen = View::new(held.iter().map(|&i| &all[i]), &focus);
            self.held_out = Some(HeldOut {
                hits: held.iter().map(|&i| all[i].hit.number()).collect(),
                nrmse_refitted: unseen.nrmse(&refitted.parameters)?,
                nrmse_repaired: unseen.nrmse(&best.parameters)?,
            });
        }
        // Names were chosen without the hits held out; quantities are then those that all hits give.
        // They are read from steps finer than the search needs: what steps leave of bias must not exceed what noise leaves of doubt.
        let fine = Focus { within: FINER * focus.within, ..focus };
        let everything = View::new(all.iter(), &fine);
        let degrees = everything.degrees();
        let refitted = Fit::of(&everything, &refitted.parameters, 1)?;
        let repaired =
            if steps.is_empty() { refitted.clone() } else { Fit::of(&everything, &best.parameters, 2)? };
        let model = |parameters: &Parameters, chi2: f64| {
            Some(ModelFit {
                fixture: parameters.to_fixture().ok()?,
                nrmse: everything.nrmse(parameters)?,
                chi2_per_dof: chi2 / degrees,
                tolerances: parameters
                    .tolerances
                    .iter()
                    .cloned()
                    .zip(parameters.coordinates.iter().copied())
                    .collect(),
            })
        };
        self.models = Some([
            model(nominal, everything.chi2(nominal)?)?,
            model(&refitted.parameters, refitted.chi2)?,
            model(&repaired.parameters, repaired.chi2)?,
        ]);
        let chi2_per_dof = repaired.chi2 / degrees;
        self.findings = findings(&repaired, &refitted, steps, chi2_per_dof, fixture, all, self.band);
        self.verdict = match (self.findings.is_empty(), chi2_per_dof < LEFT_OVER) {
            (true, _) => Verdict::Unexplained,
            (false, true) => Verdict::Explained,
            (false, false) => Verdict::PartlyExplained,
        };
        Some(())
    }
}

fn findings(
    repaired: &Fit,
    refitted: &Fit,
    steps: &[Vec<Named>],
    chi2_per_dof: f64,
    fixture: &Fixture,
    all: &[Record],
    band: (f64, f64),
) -> Vec<Finding> {
    let parameters = &repaired.parameters;
    let covariance = repaired.covariance(chi2_per_dof.max(1.0));
    let n = parameters.coordinates.len();
    let model = parameters.to_fixture().unwrap_or_else(|_| fixture.clone());
    let references: Vec<&Record> = all.iter().collect();
    let reached = seats(&model, &references, 2.0 * band.1);
    let mut before = refitted.objective;
    let laws = parameters.laws();
    let mut findings = Vec::new();
    for (index, (law, names)) in laws.iter().zip(steps).enumerate() {
        let first = parameters.first_of(index);
        let deviation = |k: usize| covariance[(first + k) * n + first + k].max(0.0).sqrt();
        let (probability, alternatives) = probabilities(names, chi2_per_dof);
        let gain = (before - names[0].fit.objective).max(0.0);
        before = names[0].fit.objective;
        findings.push(Finding {
            estimates: estimates(law, &(0..law.parameters()).map(deviation).collect::<Vec<_>>()),
            effect: law.effect(),
            probability,
            alternatives,
            gain,
            reach: reached.iter().find(|s| s.joint == law.joint && s.dof == law.dof).map_or(0.0, |s| s.reach),
        });
    }
    findings
}

/// Relative deviation that steps and sampling leave in a parameter beside noise, as measured on the simulated laboratory.
const INEXACT: f64 = 5e-3;
/// Deviation of a logarithm beyond which a parameter is not determined.
const VAGUE: f64 = 1.5;

fn estimates(law: &Law, deviations: &[f64]) -> Vec<Estimate> {
    let effect = law.effect();
    let specs = effect.kind.spec().parameters;
    let rows = specs.iter().zip(deviations).zip(law.slopes()).enumerate();
    rows.map(|(place, ((parameter, deviation), slope))| {
        let value = effect.value(place);
        let logarithm = !matches!(law.law, RestoringLaw::Cubic { .. });
        let slope_of_one = if logarithm { 1.0 } else { value.abs() / slope.abs() };
        let deviation = deviation.hypot(INEXACT * slope_of_one);
        let known = deviation.is_finite() && (!logarithm || deviation < VAGUE);
        let interval = match logarithm {
            true => [value * (-1.96 * deviation).exp(), value * (1.96 * deviation).exp()],
            false => [value - 1.96 * deviation * slope, value + 1.96 * deviation * slope],
        };
        Estimate {
            parameter: *parameter,
            unit: parameter.unit_in(Some(law.dof)),
            value,
            std: known.then_some(deviation * slope.abs()),
            interval: known.then_some(interval),
        }
    })
    .collect()
}

/// Probability of the first name, and the others with theirs: by how much worse they fit, noise being as large as the best fit's residuals.
/// The more the best leaves unexplained, the more is left for something not listed.
fn probabilities(names: &[Named], chi2_per_dof: f64) -> (f64, Vec<(Effect, f64)>) {
    let Some(best) = names.first() else { return (0.0, Vec::new()) };
    let scale = chi2_per_dof.max(1.0);
    let weight = |name: &Named| {
        let extra =
            name.fit.parameters.coordinates.len() as f64 - best.fit.parameters.coordinates.len() as f64;
        (-0.5 * ((name.fit.objective - best.fit.objective) / scale + 7.0 * extra)).min(0.0).exp()
    };
    let unlisted = 0.01 + 0.3 * ((scale - LEFT_OVER) / 10.0).clamp(0.0, 1.0);
    let sum: f64 = names.iter().map(weight).sum::<f64>() + unlisted;
    let others = names[1..].iter().map(|name| {
        let law = name.fit.parameters.laws().last().map(Law::effect).unwrap_or_else(|| name.law.effect());
        (law, weight(name) / sum)
    });
    (1.0 / sum, others.filter(|(_, p)| *p > 1e-6).collect())
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
