//! Laws as they are named: over which levels one holds, how sure, and with which parameters.

use super::diagnosis::LevelFinding;
use super::diagnosis::Tried;
use super::judge::{Fitted, Form, fitted, share};
use super::least_squares::deviations;
use super::model::{Change, Subject};
use super::tolerances::tolerance_variances;
use crate::{Estimate, RestoringLaw};
use jointscope_fixture::{Effect, Fixture};

/// Share of the change with level that a law must explain to be named.
const NAMED: f64 = 0.75;
/// The same for two laws together, which follow more by chance.
const NAMED_TWO: f64 = 0.95;
/// Levels at the least for a law, and for two.
const LEVELS: (usize, usize) = (3, 6);

/// Relative deviation of a law's parameters from what the balance of one harmonic leaves out: against the laboratory's nine harmonics, a tenth of
/// the usual noise and a fixture that is exact, they err by 0.1 to 0.7 %.
const INEXACT: f64 = 5e-3;

/// All forms at one component of a joint.
pub(crate) struct Judged<'a> {
    pub subject: &'a Subject,
    pub linear: Fitted,
    laws: Vec<Fitted>,
}

impl<'a> Judged<'a> {
    pub fn of(subject: &'a Subject, linear: Fitted) -> Self {
        let tried = |form: &Form| subject.levels.len() >= LEVELS.0 || *form != Form::FrictionAndCubic;
        let laws = Form::LAWS.iter().filter(|form| tried(form));
        Judged { subject, laws: laws.filter_map(|form| fitted(subject, *form)).collect(), linear }
    }

    /// No law tried.
    pub fn unbent(subject: &'a Subject, linear: Fitted) -> Self {
        Judged { subject, laws: Vec::new(), linear }
    }

    pub fn best(&self) -> &Fitted {
        self.laws.iter().fold(&self.linear, |best, fit| if fit.nrmse < best.nrmse { fit } else { best })
    }

    pub fn tried(&self) -> impl Iterator<Item = Tried> {
        std::iter::once(&self.linear).chain(&self.laws).map(|fit| Tried {
            joint: self.subject.seat.joint.clone(),
            dof: self.subject.dof(),
            form: fit.form.name(),
            nrmse: fit.nrmse,
            share: share(self.subject, &self.linear, fit),
        })
    }
}

/// A law with the levels over which it holds.
pub(crate) struct Named {
    /// Which of the judged components.
    pub index: usize,
    pub fit: Fitted,
    pub count: usize,
    pub share: f64,
    /// That component up to the last level over which the law holds, and what else was tried there: component, fit, share.
    subject: Subject,
    linear: Fitted,
    rivals: Vec<(usize, Fitted, f64)>,
}

/// The law that explains the most, over as many levels from the lowest as it holds for.
pub(crate) fn named_law(judged: &[Judged]) -> Option<Named> {
    let levels = judged.first()?.subject.levels.len();
    // Two levels tell a shift from no shift, three whether a law follows it.
    for count in (LEVELS.0.min(levels)..=levels).rev() {
        let mut rivals = Vec::new();
        let mut parts = Vec::new();
        for (index, whole) in judged.iter().enumerate() {
            let Some(subject) = whole.subject.up_to(count) else { continue };
            let part;
            let part = if count == levels {
                whole
            } else {
                let Some(linear) = fitted(&subject, Form::Linear) else { continue };
                part = Judged::of(&subject, linear);
                &part
            };
            rivals.extend(
                part.laws.iter().map(|fit| (index, fit.clone(), share(part.subject, &part.linear, fit))),
            );
            parts.push((index, subject.clone(), part.linear.clone()));
        }
        let fits = |form: Form, share: f64| match form {
            Form::FrictionAndCubic => share >= NAMED_TWO && count >= LEVELS.1,
            _ => share >= NAMED,
        };
        // Two laws only where one alone does not do.
        let simplest = |two: bool| {
            let of = rivals.iter().filter(|(_, fit, share)| {
                (fit.form == Form::FrictionAndCubic) == two && fits(fit.form, *share)
            });
            of.min_by(|a, b| a.1.nrmse.total_cmp(&b.1.nrmse))
        };
        let Some((index, fit, share)) = simplest(false).or_else(|| simplest(true)).cloned() else { continue };
        let (_, subject, linear) = parts.into_iter().find(|(i, ..)| *i == index)?;
        return Some(Named { index, fit, count, share, subject, linear, rivals });
    }
    None
}

impl Named {
    /// `by_fixture`: the fixture, and whether its bare numbers are exact.
    pub fn findings(&self, judged: &[Judged], by_fixture: (&Fixture, bool)) -> Vec<LevelFinding> {
        let effect = |index: usize, law: &RestoringLaw| {
            law.to_effect(&judged[index].subject.seat.joint, judged[index].subject.dof())
        };
        // Laplace's approximation with as many observations as the levels have stiffnesses and losses.
        let observations = 2.0 * self.count as f64;
        let two = self.fit.form == Form::FrictionAndCubic;
        let comparable = |fit: &Fitted| two == (fit.form == Form::FrictionAndCubic);
        let badness = |fit: &Fitted| {
            2.0 * observations * fit.nrmse.max(self.subject.floor).ln()
                + fit.form.parameters() as f64 * observations.ln()
        };
        let least = badness(&self.fit);
        let weigh = |fit: &Fitted| (0.5 * (least - badness(fit))).exp();
        let rivals: Vec<_> = self.rivals.iter().filter(|(_, fit, _)| comparable(fit)).collect();
        let total: f64 = rivals.iter().map(|(_, fit, _)| weigh(fit)).sum::<f64>().max(1.0);
        // What is not explained is the share of something not listed.
        let probability = |fit: &Fitted| self.share * weigh(fit) / total;
        let motions = (self.subject.motion(0), self.subject.motion(self.count - 1));
        let std = self.deviations(by_fixture);
        let mut first = 3;
        let mut all = Vec::new();
        for (k, law) in self.fit.change.laws.iter().enumerate() {
            let effect_found = effect(self.index, law);
            let estimates = estimates(&effect_found, law, &std[first..]);
            first += estimates.len();
            let mut alternatives: Vec<(Effect, f64)> = rivals
                .iter()
                .filter(|(index, fit, _)| *index != self.index || fit.form != self.fit.form)
                .filter_map(|(index, fit, _)| {
                    Some((effect(*index, fit.change.laws.get(k)?), probability(fit)))
                })
                .filter(|(_, probability)| *probability >= 5e-4)
                .collect();
            alternatives.sort_by(|a, b| b.1.total_cmp(&a.1));
            all.push(LevelFinding {
                probability: probability(&self.fit),
                effect: effect_found,
                estimates,
                alternatives,
                share: self.share,
                motions,
            });
        }
        all
    }

    /// Standard deviations of the parameters: from the scatter of lines, or of fits that leave one level out, whichever is larger; with what the
    /// fixture's tolerances add, and what a motion of one harmonic leaves out.
    fn deviations(&self, (fixture, exact): (&Fixture, bool)) -> Vec<Option<f64>> {
        let x = self.fit.change.parameters();
        let scale = self.subject.scales(&self.fit.change);
        let residual = |x: &[f64]| self.subject.residuals(&self.fit.change.at(x), None);
        let left: f64 = residual(&x).map_or(f64::NAN, |r| r.iter().map(|r| r * r).sum());
        let variance = left / (self.subject.count().max(x.len() + 1) - x.len()) as f64;
        let by_lines = deviations(&residual, &x, &scale, variance);
        let without: Vec<Vec<f64>> = self.left_out_fits().map(|(_, change)| change.parameters()).collect();
        let n = without.len() as f64;
        let jackknife = |p: usize| {
            let mean = without.iter().map(|x| x[p]).sum::<f64>() / n;
            ((n - 1.0) / n * without.iter().map(|x| (x[p] - mean).powi(2)).sum::<f64>()).sqrt()
        };
        let tolerances = tolerance_variances(fixture, exact, &self.subject, &self.fit.change);
        let cubic = self.fit.change.cubic_places();
        let of = |p: usize| {
            let noise = by_lines.as_ref()?[p].max(if n >= 2.0 { jackknife(p) } else { 0.0 });
            // The others are fitted by their logarithms.
            let inexact = if cubic.contains(&p) { INEXACT * x[p] } else { INEXACT };
            Some((noise * noise + tolerances[p] + inexact * inexact).sqrt())
        };
        (0..x.len()).map(of).collect()
    }

    fn left_out_fits(&self) -> impl Iterator<Item = (usize, Change)> {
        (0..self.count).filter_map(|l| Some((l, self.subject.without(l).fitted(&self.fit.change, None)?.0)))
    }

    /// Root-mean-square relative errors at levels that the fit did not see.
    pub fn left_out(&self) -> Option<[f64; 2]> {
        let of = |change: &Change| {
            let squares: Option<Vec<f64>> = (0..self.count)
                .map(|l| {
                    let (fit, _) = self.subject.without(l).fitted(change, None)?;
                    Some(self.subject.error_of(l, &fit).powi(2))
                })
                .collect();
            squares.map(|all| (all.iter().sum::<f64>() / self.count as f64).sqrt())
        };
        Some([of(&self.linear.change)?, of(&self.fit.change)?])
    }
}

/// Parameters of a law as the file names them; those above zero were fitted by their logarithm.
fn estimates(effect: &Effect, law: &RestoringLaw, std: &[Option<f64>]) -> Vec<Estimate> {
    let logarithmic = !matches!(law, RestoringLaw::Cubic { .. });
    let each = effect.kind.spec().parameters.iter().enumerate().map(|(index, parameter)| {
        let value = effect.value(index);
        let spread = std.get(index).copied().flatten().filter(|s| !logarithmic || *s < 2.0);
        let interval = spread.map(|s| match logarithmic {
            true => [value * (-1.96 * s).exp(), value * (1.96 * s).exp()],
            false => [value - 1.96 * s, value + 1.96 * s],
        });
        Estimate {
            parameter: *parameter,
            unit: parameter.unit_in(effect.dof),
            value,
            std: spread.map(|s| if logarithmic { value * s } else { s }),
            interval,
        }
    });
    each.collect()
}
