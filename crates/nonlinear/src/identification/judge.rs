//! What the laws found come to: quantities from all hits, what each law is known to, and how hits fare that no fit saw.

use super::candidates::seats;
use super::diagnosis::{Estimate, Finding, HeldOut, ModelFit, Verdict};
use super::fit::Fit;
use super::horizon::horizons;
use super::misfit::{Focus, View};
use super::parameters::{Law, Parameters};
use super::records::Record;
use super::search::{Named, Search, Span, contradicts};
use crate::RestoringLaw;
use jointscope_fixture::Effect;

/// χ² per degree of freedom above which a model leaves something unexplained.
const LEFT_OVER: f64 = 1.5;
/// How much finer the last fit steps than the search.
const FINER: usize = 2;

/// A law found.
pub(super) struct Step {
    /// Its names, the best first.
    pub names: Vec<Named>,
    /// What χ² and priors lose by it.
    pub gain: f64,
}

/// What a judgement looks at.
pub(super) struct Judgement<'a> {
    pub all: &'a [Record],
    /// Indices of the hits that the search did not see.
    pub held: &'a [usize],
    pub search: &'a Search<'a>,
    /// How much of the records the search followed.
    pub span: &'a Span,
    pub band: (f64, f64),
}

/// What it comes to.
pub(super) struct Judged {
    pub verdict: Verdict,
    pub findings: Vec<Finding>,
    /// As stated, refitted without laws, repaired.
    pub models: [ModelFit; 3],
    pub held_out: Option<HeldOut>,
    pub followed: Option<f64>,
}

impl Judgement<'_> {
    /// Of the fixture as stated and refitted without laws, and of the best fit with laws; `None` for models without a finite motion.
    pub fn of(&self, [nominal, refitted]: [&Parameters; 2], best: &Fit, steps: &[Step]) -> Option<Judged> {
        let records: Vec<&Record> = self.all.iter().collect();
        let focus = Focus { halvings: 4, ..self.search.focus(self.span.periods) };
        let ends = horizons(&records, &focus, best, self.search.shortest());
        let held_out = match self.held.is_empty() {
            true => None,
            false => Some(self.held_out(&focus, &ends, [refitted, &best.parameters])?),
        };
        // Names were chosen without the hits held out; quantities are then those that all hits give.
        // They are read from steps finer than the search needs: what steps leave of bias must not exceed what noise leaves of doubt.
        let fine = Focus { within: FINER * focus.within, ..focus };
        let (everything, slopes) = (View::new(&records, &fine, &ends), View::new(&records, &focus, &ends));
        let degrees = everything.degrees();
        let refitted = Fit::sloped(&everything, &slopes, refitted, 1)?;
        let repaired = match steps.is_empty() {
            true => refitted.clone(),
            false => self.of_all(&[focus, fine], [&everything, &slopes], best)?,
        };
        let model = |parameters: &Parameters, chi2: f64| {
            let tolerances =
                parameters.tolerances.iter().cloned().zip(parameters.coordinates.iter().copied());
            Some(ModelFit {
                fixture: parameters.to_fixture().ok()?,
                nrmse: everything.nrmse(parameters)?,
                chi2_per_dof: chi2 / degrees,
                tolerances: tolerances.collect(),
            })
        };
        let chi2_per_dof = repaired.chi2 / degrees;
        let findings = self.findings(&repaired, steps, chi2_per_dof);
        let verdict = match (findings.is_empty(), chi2_per_dof < LEFT_OVER) {
            (true, _) => Verdict::Unexplained,
            (false, true) => Verdict::Explained,
            (false, false) => Verdict::PartlyExplained,
        };
        let models = [
            model(nominal, everything.chi2(nominal)?)?,
            model(&refitted.parameters, refitted.chi2)?,
            model(&repaired.parameters, repaired.chi2)?,
        ];
        Some(Judged { verdict, findings, models, held_out, followed: self.followed(&ends) })
    }

    fn held_out(
        &self,
        focus: &Focus,
        ends: &[usize],
        [refitted, repaired]: [&Parameters; 2],
    ) -> Option<HeldOut> {
        let (unseen, until): (Vec<&Record>, Vec<usize>) =
            self.held.iter().map(|&i| (&self.all[i], ends[i])).unzip();
        let unseen = View::new(&unseen, focus, &until);
        Some(HeldOut {
            hits: self.held.iter().map(|&i| self.all[i].hit.number()).collect(),
            nrmse_refitted: unseen.nrmse(refitted)?,
            nrmse_repaired: unseen.nrmse(repaired)?,
        })
    }

    /// The fit to all hits; that to the hits of the search where the others contradict them.
    fn of_all(
        &self,
        [focus, fine]: &[Focus; 2],
        [everything, slopes]: [&View; 2],
        best: &Fit,
    ) -> Option<Fit> {
        let seen = |focus: &Focus| View::new(&self.search.records, focus, &self.span.ends);
        let (trained, trained_slopes) = (seen(fine), seen(focus));
        let before = Fit::sloped(&trained, &trained_slopes, &best.parameters, 5)?;
        let all = Fit::sloped(everything, slopes, &before.parameters, 5)?;
        let contradicted = contradicts(trained.objective(&all.parameters), before.objective);
        if contradicted { Fit::at(everything, slopes, &before.parameters) } else { Some(all) }
    }

    /// Time of the shortest record that was not followed to its end, s after the blow.
    fn followed(&self, ends: &[usize]) -> Option<f64> {
        let time = |(record, end): (&Record, &usize)| {
            let cut = *end < record.hit.samples();
            cut.then(|| end.saturating_sub(record.onset) as f64 * record.hit.interval())
        };
        let ended = self.all.iter().zip(ends).filter_map(time);
        ended.chain(self.span.periods.map(|periods| self.search.time_of(periods))).reduce(f64::min)
    }

    fn findings(&self, repaired: &Fit, steps: &[Step], chi2_per_dof: f64) -> Vec<Finding> {
        let parameters = &repaired.parameters;
        let covariance = repaired.covariance(chi2_per_dof.max(1.0));
        let n = parameters.coordinates.len();
        let records: Vec<&Record> = self.all.iter().collect();
        let model = parameters.to_fixture();
        let reached = model.map_or(Vec::new(), |model| seats(&model, &records, 2.0 * self.band.1));
        let laws = parameters.laws();
        let mut findings = Vec::new();
        for (index, (law, step)) in laws.iter().zip(steps).enumerate() {
            let first = parameters.first_of(index);
            let deviation = |k: usize| covariance[(first + k) * n + first + k].max(0.0).sqrt();
            let (probability, alternatives) = probabilities(&step.names, chi2_per_dof);
            findings.push(Finding {
                estimates: estimates(law, &(0..law.parameters()).map(deviation).collect::<Vec<_>>()),
                effect: law.effect(),
                probability,
                alternatives,
                gain: step.gain.max(0.0),
                reach: reached
                    .iter()
                    .find(|s| s.joint == law.joint && s.dof == law.dof)
                    .map_or(0.0, |s| s.reach),
            });
        }
        findings
    }
}

/// Relative deviation that steps and sampling leave in a parameter beside noise, as measured on the simulated laboratory.
const INEXACT: f64 = 2.5e-3;
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
