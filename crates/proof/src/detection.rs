//! From which size on effects are found.

use crate::statistics::median;
use crate::strength::{self, strength_deviation};
use crate::{Judged, Share};
use jointscope_fixture::{Dof, EffectKind};
use serde::{Serialize, Serializer};
use std::fmt::{self, Display, Formatter};

/// Edges of the classes of Δχ².
const EDGES: [f64; 11] = [0.0, 5.0, 10.0, 20.0, 35.0, 50.0, 100.0, 200.0, 1e3, 1e4, f64::INFINITY];
/// Share of effects found that counts as sure, in the fitted curve.
const SURE: f64 = 0.95;
/// Precision of the prior that keeps the fitted curve finite where all large effects are found and no small
/// one: slopes beyond five a decade cannot be told from a step.
const PRIOR: f64 = 0.02;
/// Δχ² by which the smallest detectable effects are stated where no curve could be fitted.
const USUAL: f64 = 50.0;

/// Single effects, graded ones included, of about the same size.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SizeClass {
    /// From this Δχ² on.
    pub from: f64,
    /// Up to this one; the last class has no end.
    pub to: f64,
    /// Their median Δχ²; `None` where there is none.
    #[serde(rename = "median")]
    pub size: Option<f64>,
    /// In how many something was noticed: a verdict other than consistent.
    pub noticed: Share,
    /// In how many the hidden effect, or a name as good, was found.
    pub named: Share,
}

/// The smallest effect of a kind that is found for sure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Smallest {
    /// The kind.
    #[serde(serialize_with = "kind_name")]
    pub kind: EffectKind,
    /// Its degree of freedom, where the kind has one: translation and rotation are counted apart.
    pub dof: Option<Dof>,
    /// The parameter that the figure is of.
    pub parameter: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Median over the cases; where [`Smallest::is_upper`], an effect is the smaller the larger this is.
    #[serde(rename = "median")]
    pub value: f64,
    /// Smallest and largest of the cases.
    pub range: [f64; 2],
    /// Whether effects of a larger parameter are weaker.
    #[serde(rename = "upper")]
    pub is_upper: bool,
    /// Number of cases.
    pub cases: usize,
}

fn kind_name<S: Serializer>(kind: &EffectKind, serializer: S) -> Result<S::Ok, S::Error> {
    kind.name().serialize(serializer)
}

impl SizeClass {
    /// The class in words: `20 to 35`.
    pub(crate) fn name(&self) -> String {
        if self.to.is_finite() {
            format!("{} to {}", self.from, self.to)
        } else {
            format!("{} and more", self.from)
        }
    }
}

impl Smallest {
    /// Kind and degree of freedom.
    pub fn name(&self) -> String {
        let dof = self.dof.map_or_else(String::new, |dof| format!(" {}", dof.name()));
        format!("{}{dof}", self.kind.name())
    }
}

/// Detection against size.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Detection {
    /// Classes of Δχ², from the smallest.
    pub classes: Vec<SizeClass>,
    /// Logistic curve of the share that is named over ln Δχ²: 1/(1 + exp(−(a + b·ln Δχ²))), by maximum of
    /// likelihood; `None` where nothing was hidden.
    #[serde(rename = "course")]
    pub curve: Option<[f64; 2]>,
    /// Δχ² from which half are found; `None` where the curve does not rise to it.
    pub half_named_from: Option<f64>,
    /// Δχ² from which nineteen of twenty are found.
    pub sure_from: Option<f64>,
    /// The smallest effects found for sure by kind.
    pub smallest: Vec<Smallest>,
}

/// Δχ² and whether the name was found.
type Trial = (f64, bool);

impl Detection {
    /// Collects the single and the graded effects of the cases.
    pub(crate) fn of<'a>(judged: impl Iterator<Item = &'a Judged>) -> Self {
        let singles: Vec<&Judged> =
            judged.filter(|judged| judged.truth.role.is_of_one() && judged.answer.is_ok()).collect();
        let trials: Vec<Trial> = singles.iter().map(|judged| (judged.size(), judged.is_named())).collect();
        let curve = logistic_fit(&trials);
        let [half_named_from, sure_from] = [0.5, SURE].map(|share| size_of_share(curve, share));
        let smallest = smallest(&singles, sure_from.unwrap_or(USUAL));
        Detection { classes: classes(&singles), curve, half_named_from, sure_from, smallest }
    }

    /// The fitted share of effects of a size that are found under their names.
    pub fn share_at(&self, size: f64) -> Option<f64> {
        self.curve.map(|[a, b]| logistic(a + b * size.max(1.0).ln()))
    }
}

/// Δχ² from which a share of the effects is found; `None` where the curve does not rise to it.
fn size_of_share(curve: Option<[f64; 2]>, share: f64) -> Option<f64> {
    let [a, b] = curve?;
    (b > 0.0).then(|| (((share / (1.0 - share)).ln() - a) / b).exp())
}

fn classes(singles: &[&Judged]) -> Vec<SizeClass> {
    let class = |edge: &[f64]| {
        let within = |judged: &&&Judged| (edge[0]..edge[1]).contains(&judged.size().max(0.0));
        let these: Vec<&&Judged> = singles.iter().filter(within).collect();
        let sizes: Vec<f64> = these.iter().map(|judged| judged.size()).collect();
        SizeClass {
            from: edge[0],
            to: edge[1],
            size: median(&sizes),
            noticed: Share::count(&these, |judged| judged.is_noticed()),
            named: Share::count(&these, |judged| judged.is_named()),
        }
    };
    EDGES.windows(2).map(class).collect()
}

fn logistic(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

/// The logistic curve by Newton's method, with a weak prior on its slope; its middle is free where there are
/// found and missed effects.
fn logistic_fit(trials: &[Trial]) -> Option<[f64; 2]> {
    if trials.is_empty() {
        return None;
    }
    // About the middle of the sizes the two coefficients hardly depend on each other.
    let logs: Vec<f64> = trials.iter().map(|(size, _)| size.max(1.0).ln()).collect();
    let middle = logs.iter().sum::<f64>() / logs.len() as f64;
    let (mut a, mut b) = (0.0, 1.0);
    for _ in 0..100 {
        let (mut gradient, mut curvature) = ([-PRIOR * a, -PRIOR * b], [PRIOR, 0.0, PRIOR]);
        for ((_, found), log) in trials.iter().zip(&logs) {
            let x = log - middle;
            let p = logistic(a + b * x);
            let left = f64::from(*found) - p;
            gradient[0] += left;
            gradient[1] += left * x;
            let weight = p * (1.0 - p);
            curvature[0] += weight;
            curvature[1] += weight * x;
            curvature[2] += weight * x * x;
        }
        let determinant = curvature[0] * curvature[2] - curvature[1] * curvature[1];
        let step = [
            (curvature[2] * gradient[0] - curvature[1] * gradient[1]) / determinant,
            (curvature[0] * gradient[1] - curvature[1] * gradient[0]) / determinant,
        ];
        // Far from the maximum a whole step may jump to where nothing curves.
        let damped = step.map(|s| s.clamp(-1.0, 1.0));
        a += damped[0];
        b += damped[1];
        if step[0].abs() + step[1].abs() < 1e-10 {
            break;
        }
    }
    (a.is_finite() && b.is_finite()).then_some([a - b * middle, b])
}

/// Each hidden effect's strength that would cost a fit without it `size`, by its Cramér–Rao bound.
fn smallest(singles: &[&Judged], size: f64) -> Vec<Smallest> {
    let mut all = Vec::new();
    for kind in EffectKind::ALL {
        for dof in [None, Some(Dof::Translation), Some(Dof::Rotation)] {
            let strengths: Vec<f64> = singles
                .iter()
                .filter_map(|judged| {
                    let effect = judged.truth.effects().first()?;
                    let bounds = judged.fits.bounds.first()?;
                    let bound = (*bounds.get(strength::leading_parameter(effect.kind))?)?;
                    ((effect.kind, effect.dof) == (kind, dof))
                        .then(|| size.sqrt() * strength_deviation(effect, bound))
                })
                .map(|strength| strength::stated(kind, strength))
                .collect();
            let Some(value) = median(&strengths) else { continue };
            let (parameter, unit) = strength::parameter(kind, dof);
            all.push(Smallest {
                kind,
                dof,
                parameter,
                unit,
                value,
                range: [
                    strengths.iter().copied().fold(f64::INFINITY, f64::min),
                    strengths.iter().copied().fold(0.0, f64::max),
                ],
                is_upper: strength::is_inverse(kind),
                cases: strengths.len(),
            });
        }
    }
    all
}

impl Display for Detection {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "\nsingle effects by what they cost a fit without them, Δχ²: noticed, named:")?;
        for class in self.classes.iter().filter(|class| class.named.all > 0) {
            let (noticed, named) = (class.noticed.briefly(), class.named.briefly());
            writeln!(f, "  {:<16} {noticed:<28} {named}", class.name())?;
        }
        if let (Some(half), Some(sure)) = (self.half_named_from, self.sure_from) {
            writeln!(f, "  half are named from Δχ² = {half:.0}, nineteen of twenty from {sure:.0}")?;
        }
        writeln!(f, "\nsmallest effect named with 0.95, median (least to largest) of cases:")?;
        for smallest in &self.smallest {
            let Smallest { parameter, unit, value, range: [least, largest], is_upper, cases, .. } = smallest;
            let relation = if *is_upper { "≤" } else { "≥" };
            let range = format!("({least:.1e} to {largest:.1e}) of {cases}");
            writeln!(f, "  {:<34} {parameter} {relation} {value:.2e} {unit} {range}", smallest.name())?;
        }
        Ok(())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_goes_through_the_shares_that_it_was_made_of() {
        // 20 % of many at Δχ² 10, 80 % at 40.
        let at = |size: f64, share: usize| (0..500).map(move |i| (size, i % 10 < share));
        let trials: Vec<Trial> = at(10.0, 2).chain(at(40.0, 8)).collect();
        let [a, b] = logistic_fit(&trials).unwrap();
        assert!((logistic(a + b * 10f64.ln()) - 0.2).abs() < 0.01);
        assert!((logistic(a + b * 40f64.ln()) - 0.8).abs() < 0.01);
    }

    #[test]
    fn a_clean_step_has_a_finite_curve_with_its_middle_on_the_step() {
        let trials: Vec<Trial> = (1..100).map(|i| (f64::from(i), i > 30)).collect();
        let [a, b] = logistic_fit(&trials).unwrap();
        let middle = (-a / b).exp();
        assert!((25.0..36.0).contains(&middle), "{middle}");
        assert_eq!(logistic_fit(&[]), None);
    }
}
