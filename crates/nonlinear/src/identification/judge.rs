//! What the laws found come to: quantities from all hits, what each law is known to, and how hits fare that
//! no fit saw.

use super::fit::Fit;
use super::horizon::horizons;
use super::hypothesis::{Hypothesis, has_departed};
use super::locations::locations;
use super::misfit::{Focus, View};
use super::records::Record;
use super::search::{Search, Span, contradicts};
use crate::estimates::estimates;
use crate::settings::band::BEYOND_BAND;
use crate::settings::judgement::{
    FINER, JUDGE_HALVINGS, LEAST_PROBABILITY, LEFT_OVER, MUCH_LEFT_OVER, PARAMETER_COST, PARAMETER_ERROR,
    UNLISTED, UNLISTED_LEFT_OVER,
};
use jointscope_findings::{Finding, HeldOut, Verdict};
use jointscope_fixture::{Effect, Fixture, NamedQuantity};
use jointscope_tolerances::Tolerance;
use serde::Serialize;

/// A law that the hits need.
pub type HitFinding = Finding<HitEvidence>;

/// What hits tell of a law beyond its name, size and probability.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct HitEvidence {
    /// What χ² and priors lose without it.
    #[serde(rename = "gain_chi2")]
    pub gain: f64,
    /// Largest relative motion d of its joint under the hits, m or rad.
    #[serde(rename = "largest_relative_motion")]
    pub reach: f64,
}

/// A fixture and how well it follows the recorded responses.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ModelFit {
    /// The fixture at its fitted quantities.
    pub fixture: Fixture,
    /// √(Σ|simulated − recorded|²/Σ|recorded|²) over all hits in the band.
    pub nrmse: f64,
    /// χ² per degree of freedom.
    pub chi2_per_dof: f64,
    /// Quantities that could move.
    pub quantities: Vec<FittedQuantity>,
}

/// A quantity that could move, and where it ended.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FittedQuantity {
    /// As it is stated.
    pub stated: NamedQuantity,
    /// The fitted value, SI.
    pub value: f64,
    /// Its departure from what is stated, in standard deviations.
    pub deviations: f64,
}

impl FittedQuantity {
    fn of((tolerance, at): (&Tolerance, &f64)) -> Self {
        FittedQuantity { stated: tolerance.quantity.clone(), value: tolerance.value(*at), deviations: *at }
    }
}

impl ModelFit {
    /// Whether it explains the responses down to their noise.
    pub fn leaves_noise_alone(&self) -> bool {
        self.chi2_per_dof < LEFT_OVER
    }

    /// The quantities that had to leave their stated values by more than chance makes, the farthest first.
    pub fn departed(&self) -> Vec<&FittedQuantity> {
        let departed = |quantity: &&FittedQuantity| has_departed(&quantity.stated, quantity.deviations);
        let mut all: Vec<&FittedQuantity> = self.quantities.iter().filter(departed).collect();
        all.sort_by(|a, b| b.deviations.abs().total_cmp(&a.deviations.abs()));
        all
    }
}

/// A law found.
pub(super) struct Step {
    /// The fits with it under each of its names, the best first.
    pub fits: Vec<Fit>,
    /// What χ² and priors lose by it.
    pub gain: f64,
}

/// What is judged.
pub(super) struct Judgement<'a> {
    pub all: &'a [Record],
    /// Indices of the hits that the search did not see.
    pub held: &'a [usize],
    pub search: &'a Search<'a>,
    /// How much of the records the search followed.
    pub span: &'a Span,
}

/// What it comes to.
pub(super) struct Judged {
    pub verdict: Verdict,
    pub findings: Vec<HitFinding>,
    /// As stated, refitted without laws, repaired.
    pub models: [ModelFit; 3],
    pub held_out: Option<HeldOut>,
    pub followed: Option<f64>,
}

impl<'a> Judgement<'a> {
    /// Of the fixture as stated and refitted without laws, and of the best fit with laws; `None` for models
    /// without a finite motion.
    pub(super) fn of(
        &self,
        [nominal, refitted]: [&Hypothesis; 2],
        best: &Fit,
        steps: &[Step],
    ) -> Option<Judged> {
        let records: Vec<&Record> = self.all.iter().collect();
        let focus = Focus { halvings: JUDGE_HALVINGS, ..self.search.focus(self.span.periods) };
        let ends = horizons(&records, &focus, best, self.search.shortest_s());
        let held_out = match self.held.is_empty() {
            true => None,
            false => Some(self.held_out(&focus, &ends, [refitted, &best.hypothesis])?),
        };
        // Names were chosen without the hits held out; quantities are then those that all hits give. They are
        // read from steps finer than the search needs: what steps leave of bias must not exceed what noise
        // leaves of doubt.
        let fine = Focus { within: FINER * focus.within, ..focus };
        let (everything, slopes) = (View::new(&records, &fine, &ends), View::new(&records, &focus, &ends));
        let degrees = everything.degrees();
        let refitted = Fit::sloped(&everything, &slopes, refitted, 1)?;
        let repaired = match steps.is_empty() {
            true => refitted.clone(),
            false => self.of_all(&[focus, fine], [&everything, &slopes], best)?,
        };
        let model = |hypothesis: &Hypothesis, chi2: f64| {
            let quantities = hypothesis.quantities.iter().zip(&hypothesis.coordinates);
            Some(ModelFit {
                fixture: hypothesis.to_fixture().ok()?,
                nrmse: everything.nrmse(hypothesis)?,
                chi2_per_dof: chi2 / degrees,
                quantities: quantities.map(FittedQuantity::of).collect(),
            })
        };
        let chi2_per_dof = repaired.chi2 / degrees;
        let findings = self.findings(&repaired, steps, chi2_per_dof);
        let models = [
            model(nominal, everything.chi2(nominal)?)?,
            model(&refitted.hypothesis, refitted.chi2)?,
            model(&repaired.hypothesis, repaired.chi2)?,
        ];
        // A mass or a stiffness that is left out is taken up by quantities, and no law accounts for it.
        let explains = models[2].leaves_noise_alone() && models[2].departed().is_empty();
        let verdict = match (findings.is_empty(), explains) {
            (true, _) => Verdict::Unexplained,
            (false, true) => Verdict::Explained,
            (false, false) => Verdict::PartlyExplained,
        };
        Some(Judged { verdict, findings, models, held_out, followed: self.followed(&ends) })
    }

    fn held_out(
        &self,
        focus: &Focus,
        ends: &[usize],
        [refitted, repaired]: [&Hypothesis; 2],
    ) -> Option<HeldOut> {
        let (unseen, until): (Vec<&Record>, Vec<usize>) =
            self.held.iter().map(|&i| (&self.all[i], ends[i])).unzip();
        let unseen = View::new(&unseen, focus, &until);
        Some(HeldOut {
            what: self.held.iter().map(|&i| format!("hit {}", self.all[i].hit.number())).collect(),
            nrmse_refitted: unseen.nrmse(refitted)?,
            nrmse_repaired: unseen.nrmse(repaired)?,
            same_findings: None,
        })
    }

    /// The fit to all hits; that to the hits of the search where the others contradict them.
    fn of_all(
        &self,
        [focus, fine]: &[Focus<'a>; 2],
        [everything, slopes]: [&View; 2],
        best: &Fit,
    ) -> Option<Fit> {
        let seen = |focus: &Focus<'a>| View::new(&self.search.records, focus, &self.span.ends);
        let (trained, trained_slopes) = (seen(fine), seen(focus));
        let before = Fit::sloped(&trained, &trained_slopes, &best.hypothesis, 5)?;
        let all = Fit::sloped(everything, slopes, &before.hypothesis, 5)?;
        let contradicted = contradicts(trained.objective(&all.hypothesis), before.objective);
        if contradicted { Fit::at(everything, slopes, &before.hypothesis) } else { Some(all) }
    }

    /// Time of the shortest record that was not followed to its end, s after the blow.
    fn followed(&self, ends: &[usize]) -> Option<f64> {
        let time = |(record, end): (&Record, &usize)| {
            let cut = *end < record.hit.samples();
            cut.then(|| end.saturating_sub(record.onset) as f64 * record.hit.interval())
        };
        let ended = self.all.iter().zip(ends).filter_map(time);
        ended.chain(self.span.periods.map(|periods| self.search.time_s(periods))).reduce(f64::min)
    }

    fn findings(&self, repaired: &Fit, steps: &[Step], chi2_per_dof: f64) -> Vec<HitFinding> {
        let hypothesis = &repaired.hypothesis;
        let covariance = repaired.covariance(chi2_per_dof.max(1.0));
        let records: Vec<&Record> = self.all.iter().collect();
        let reached = hypothesis
            .to_fixture()
            .map_or(Vec::new(), |model| locations(&model, &records, BEYOND_BAND * self.search.lines.band.1));
        let finding = |(index, (effect, step)): (usize, (Effect, &Step))| {
            let deviations: Vec<Option<f64>> = hypothesis
                .parameters_of(index)
                .map(|(transform, place)| {
                    // A logarithm's deviation is wanted, not that of its value.
                    let slope = transform.slope(1.0);
                    covariance.as_ref().map(|covariance| covariance.std(place) * slope)
                })
                .collect();
            let (probability, alternatives) = probabilities(&step.fits, chi2_per_dof);
            let mut reaches = reached.iter().filter(|location| location.is_of(&effect));
            HitFinding {
                estimates: estimates(&effect, &deviations, PARAMETER_ERROR),
                probability,
                alternatives,
                evidence: HitEvidence {
                    gain: step.gain.max(0.0),
                    reach: reaches.next().map_or(0.0, |location| location.reach),
                },
                effect,
            }
        };
        hypothesis.effects().into_iter().zip(steps).enumerate().map(finding).collect()
    }
}

/// Probability of the best fit's effect, and the others with theirs: by how much worse they fit, noise being
/// as large as the best fit's residuals. The more the best leaves unexplained, the more is left for something
/// not listed.
fn probabilities(fits: &[Fit], chi2_per_dof: f64) -> (f64, Vec<(Effect, f64)>) {
    let Some(best) = fits.first() else { return (0.0, Vec::new()) };
    let scale = chi2_per_dof.max(1.0);
    let count = |fit: &Fit| fit.hypothesis.coordinates.len() as f64;
    let weight = |fit: &Fit| {
        let extra = count(fit) - count(best);
        (-0.5 * ((fit.objective - best.objective) / scale + PARAMETER_COST * extra)).min(0.0).exp()
    };
    let unlisted = UNLISTED + UNLISTED_LEFT_OVER * ((scale - LEFT_OVER) / MUCH_LEFT_OVER).clamp(0.0, 1.0);
    let sum: f64 = fits.iter().map(weight).sum::<f64>() + unlisted;
    let named = |fit: &Fit| Some((fit.hypothesis.effects().pop()?, weight(fit) / sum));
    let others = fits[1..].iter().filter_map(named).filter(|(_, p)| *p > LEAST_PROBABILITY);
    (1.0 / sum, others.collect())
}
