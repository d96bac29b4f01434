//! What is known of an effect along the ridge that its place and its sizes share.
//!
//! A mass that is heavier the nearer it is to a clamp does much the same to every mode, and so do a mass and
//! a spring whose places are traded for their sizes. Derivatives where a fit came to rest say how the ridge
//! sets out there, and nothing of where it leads or ends. So the fit is repeated with the effect held at
//! places on either side, as far as these are credible: the evidence at each is the density of the place, and
//! what the sizes are there, with the deviations that they have there, makes up theirs.

use crate::Hypothesis;
use crate::along_body::{abscissa, is_on_beam};
use crate::estimates::estimates_within;
use crate::modal::fit::{ANY, ModalFit, SetOut};
use crate::modal::prior::Prior;
use crate::modal::searcher::{Named, Searcher};
use crate::settings::modal::along::{
    EVEN, FIRST_STEP, HELD, INCREDIBLE, LONGER, MOST_FIRST_STEP, MOST_STEPS, PARTS, STEEP,
};
use jointscope_findings::Estimate;
use jointscope_fixture::Effect;
use jointscope_inference::normal_below;
use std::ops::Range;

/// Halvings that find an end of an interval.
const HALVINGS: usize = 60;
/// Probability below and above a 95 % interval.
const TAIL: f64 = 0.025;

/// An effect held at a place: ln of the density there, and what its free coordinates are, with their standard
/// deviations.
#[derive(Debug, Clone)]
struct Held {
    ln: f64,
    means: Vec<f64>,
    stds: Vec<f64>,
}

/// What is known of an effect along its body.
#[derive(Debug, Clone)]
pub(super) struct Along {
    /// Interpolated, with the share of the probability of each.
    parts: Vec<(f64, Held)>,
    /// ln of the evidence, of all places about where the fit came to rest.
    pub ln: f64,
    /// Index of the place among the effect's free coordinates, and where the least and the greatest of them
    /// that is credible lies.
    at: usize,
    range: [f64; 2],
    /// The hypothesis in the middle of the probability, where the most probable one is as large as is
    /// possible: the end of what is credible is no estimate of it.
    pub middle: Option<Hypothesis>,
}

impl Along {
    /// From places in their order; `at` is the index of the place among an effect's free coordinates.
    fn of(all: &[Held], at: usize) -> Option<Self> {
        let highest = all.iter().map(|held| held.ln).fold(f64::NEG_INFINITY, f64::max);
        let mix = |a: &[f64], b: &[f64], t: f64| a.iter().zip(b).map(|(a, b)| a + t * (b - a)).collect();
        let mut parts = Vec::new();
        for pair in all.windows(2) {
            let (a, b) = (&pair[0], &pair[1]);
            let width = (b.means[at] - a.means[at]) / PARTS as f64;
            for part in 0..PARTS {
                let t = (part as f64 + 0.5) / PARTS as f64;
                let held = Held {
                    ln: a.ln + t * (b.ln - a.ln),
                    means: mix(&a.means, &b.means, t),
                    stds: mix(&a.stds, &b.stds, t),
                };
                parts.push((width * (held.ln - highest).exp(), held));
            }
        }
        let total: f64 = parts.iter().map(|(weight, _)| weight).sum();
        if total.is_nan() || total <= 0.0 {
            return None;
        }
        parts.iter_mut().for_each(|(weight, _)| *weight /= total);
        let range = [all.first()?.means[at], all.last()?.means[at]];
        Some(Along { parts, ln: highest + total.ln(), at, range, middle: None })
    }

    /// The 95 % interval of free coordinate `index`.
    fn interval(&self, index: usize) -> [f64; 2] {
        self.quantiles(index, [TAIL, 1.0 - TAIL])
    }

    /// Below which values of free coordinate `index` these shares of the probability lie.
    fn quantiles<const N: usize>(&self, index: usize, shares: [f64; N]) -> [f64; N] {
        let least = |held: &Held| held.stds[index].max(f64::MIN_POSITIVE);
        let below = |x: f64| -> f64 {
            let of =
                |(weight, held): &(f64, Held)| weight * normal_below((x - held.means[index]) / least(held));
            self.parts.iter().map(of).sum()
        };
        let reach = |sign: f64| {
            let ends =
                self.parts.iter().map(move |(_, held)| held.means[index] + sign * 5.0 * held.stds[index]);
            ends.fold(-sign * f64::INFINITY, |a, b| if sign * (b - a) > 0.0 { b } else { a })
        };
        shares.map(|share| {
            let (mut low, mut high) = (reach(-1.0), reach(1.0));
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if below(middle) < share { low = middle } else { high = middle }
            }
            0.5 * (low + high)
        })
    }

    /// Whether effect `index` of a hypothesis sits among these places.
    pub(super) fn holds(&self, hypothesis: &Hypothesis, index: usize) -> bool {
        let place = hypothesis.coordinates[hypothesis.range_of(index).start + self.at];
        self.range[0] <= place && place <= self.range[1]
    }

    /// The parameters of effect `index` of a hypothesis, with these intervals.
    pub(super) fn estimates(&self, hypothesis: &Hypothesis, index: usize, effect: &Effect) -> Vec<Estimate> {
        let count = hypothesis.range_of(index).len();
        let intervals: Vec<[f64; 2]> = (0..count).map(|coordinate| self.interval(coordinate)).collect();
        estimates_within(hypothesis, index, effect, &intervals)
    }
}

/// An effect whose place is held here and there along its body.
struct Ridge<'a> {
    searcher: &'a Searcher<'a>,
    named: &'a Named,
    /// The effect's coordinates, and among all coordinates that of its place, with its bounds.
    own: Range<usize>,
    coordinate: usize,
    bounds: [f64; 2],
}

impl Ridge<'_> {
    /// The fit with the effect held at a place, set out from another one.
    fn held(&self, from: &ModalFit, to: f64) -> Option<(ModalFit, Held)> {
        let problem = &self.searcher.problem;
        let mut start = from.hypothesis.clone();
        start.coordinates[self.coordinate] = to;
        let mut priors = self.named.fit.priors.clone();
        priors[self.coordinate] = Prior { mean: to, std: HELD };
        let paired = problem.paired_modes(&start)?;
        let set_out = (None, SetOut::Beside(from.evidence.sizes), ANY);
        let fit = problem.fitted_from(&start, paired, &priors, set_out)?;
        let covariance = fit.covariance_at(&self.searcher.widened(&fit))?;
        // Beyond its bound nothing is possible, whatever derivatives say.
        let stopped = fit.hypothesis.stopped();
        let std = |c: usize| if stopped.contains(&c) { 0.0 } else { covariance.std(c) };
        let held = Held {
            ln: fit.ln,
            means: fit.hypothesis.coordinates[self.own.clone()].to_vec(),
            stds: self.own.clone().map(std).collect(),
        };
        Some((fit, held))
    }

    /// Places away from the `middle`, by steps of about this size to the side of its sign, as far as they are
    /// credible.
    fn side(&self, middle: &(ModalFit, Held), mut step: f64) -> Vec<Held> {
        let (mut from, mut all) = (middle.clone(), Vec::new());
        for _ in 0..MOST_STEPS {
            let was = from.0.hypothesis.coordinates[self.coordinate];
            let to = (was + step).clamp(self.bounds[0], self.bounds[1]);
            if (to - was).abs() < HELD {
                break;
            }
            let Some(next) = self.held(&from.0, to) else { break };
            let fall = (from.1.ln - next.1.ln).abs();
            all.push(next.1.clone());
            if middle.1.ln - next.1.ln > INCREDIBLE {
                break;
            }
            step *= if fall < EVEN { LONGER } else { 1.0 };
            step /= if fall > STEEP { LONGER } else { 1.0 };
            from = next;
        }
        all
    }
}

impl Searcher<'_> {
    /// Effect `index` of `named` along its body, if it sits on one that bends: elsewhere a place and its
    /// sizes are as good as linear.
    pub(super) fn along(&self, named: &Named, index: usize) -> Option<Along> {
        let hypothesis = &named.fit.hypothesis;
        let effect = hypothesis.effects().into_iter().nth(index)?;
        let place = abscissa(&effect)?;
        if !is_on_beam(self.nominal.fixture(), &effect) || self.known.is_some() {
            return None;
        }
        let own = hypothesis.range_of(index);
        let moves = hypothesis.effect_parameters_of(index);
        let free_before = |parameter: usize| moves[..parameter].iter().filter(|p| p.is_free()).count();
        let at = free_before(place);
        let coordinate = own.start + at;
        let size = own.start + free_before(effect.kind.spec().size.parameter);
        let bounds = [moves[place].low, moves[place].high];
        let ridge = Ridge { searcher: self, named, own, coordinate, bounds };
        let deviation = named.fit.covariance_at(&self.widened(&named.fit))?.std(coordinate);
        let step = (FIRST_STEP * deviation).min(MOST_FIRST_STEP);
        let middle = ridge.held(&named.fit, hypothesis.coordinates[coordinate])?;
        let mut all = ridge.side(&middle, -step);
        all.reverse();
        all.push(middle.1.clone());
        all.extend(ridge.side(&middle, step));
        let mut along = Along::of(&all, at)?;
        if hypothesis.stopped().contains(&size) {
            let [half] = along.quantiles(at, [0.5]);
            along.middle = ridge.held(&middle.0, half).map(|(fit, _)| fit.hypothesis);
        }
        Some(along)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// Places about nothing with a density of ln −x²/2, and a size of 3 x ± 4 at each.
    fn ridge(places: &[f64]) -> Along {
        let held = |x: &f64| Held { ln: -0.5 * x * x, means: vec![*x, 3.0 * x], stds: vec![0.0, 4.0] };
        Along::of(&places.iter().map(held).collect::<Vec<_>>(), 0).unwrap()
    }

    fn evenly(from: f64, to: f64) -> Vec<f64> {
        (0..=40).map(|k| from + (to - from) * f64::from(k) / 40.0).collect()
    }

    #[test]
    fn along_a_ridge_a_size_is_as_uncertain_as_its_place_and_itself_together() {
        let along = ridge(&evenly(-4.5, 4.5));
        let [low, high] = along.interval(0);
        assert!((low + 1.96).abs() < 0.02 && (high - 1.96).abs() < 0.02, "{low} {high}");
        let [low, high] = along.interval(1);
        let expected = 1.96 * 3f64.hypot(4.0);
        assert!((low / expected + 1.0).abs() < 0.01 && (high / expected - 1.0).abs() < 0.01, "{low} {high}");
        let evidence = (2.0 * std::f64::consts::PI).sqrt().ln();
        assert!((along.ln - evidence).abs() < 0.01, "{}", along.ln);
    }

    #[test]
    fn where_a_body_ends_so_does_the_interval() {
        // Half a normal distribution: 2.24 deviations hold 97.5 % of it, 0.0313 leave 2.5 % below.
        let along = ridge(&evenly(0.0, 4.5));
        let [low, high] = along.interval(0);
        assert!((low - 0.0313).abs() < 0.01 && (high - 2.2414).abs() < 0.02, "{low} {high}");
    }

    #[test]
    fn half_of_the_probability_lies_on_either_side_of_the_middle() {
        // Half a normal distribution from where the body ends: its median is 0.674 deviations from there.
        let [half] = ridge(&evenly(0.0, 4.5)).quantiles(0, [0.5]);
        assert!((half - 0.674).abs() < 0.01, "{half}");
    }

    #[test]
    fn one_place_alone_has_no_interval() {
        let held = Held { ln: 0.0, means: vec![1.0], stds: vec![0.0] };
        assert!(Along::of(&[held], 0).is_none());
    }
}
