//! What small effects do to the recorded FRFs, and how much of it no tolerance could do as well.

use crate::objective::{Tolerance, values};
use crate::strength::{strength, with_strength};
use jointscope_fixture::{Effect, Fixture};
use jointscope_linalg::solve_positive_definite;
use jointscope_rig::{Instrument, frfs};
use jointscope_spectra::FrfSet;
use num_complex::Complex64;

/// Step of differences, in standard deviations of a quantity.
const DIFFERENCE: f64 = 2e-3;

/// Times that an effect is made weaker to be linear: the first is still measured where it bends.
const WEAKENED: usize = 2;
/// What it then costs a fit that yields nothing, Δχ².
pub(crate) const WHOLE: f64 = 1e3;

/// Derivatives of a fixture's FRFs by its tolerances, in units of the noise, by the laboratory's own model.
#[derive(Debug)]
pub(crate) struct Sensitivity<'a> {
    at: &'a Fixture,
    recorded: &'a FrfSet,
    plain: Vec<Complex64>,
    /// √(2/σ²) by value.
    scale: Vec<f64>,
    /// Derivative by each tolerance, one standard deviation of it, in units of the noise.
    columns: Vec<Vec<Complex64>>,
    /// JᵀJ and the priors.
    information: Vec<f64>,
}

/// What a unit of an effect's strength does, in units of the noise.
#[derive(Debug, Clone)]
pub(crate) struct Direction {
    values: Vec<Complex64>,
    /// Its products with the tolerances' columns.
    projections: Vec<f64>,
    /// The tolerances that imitate it best.
    imitation: Vec<f64>,
}

fn dot(a: &[Complex64], b: &[Complex64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.re * b.re + a.im * b.im).sum()
}

impl<'a> Sensitivity<'a> {
    /// Of `at`, a fixture without effects, under the tolerances of `believed`, for the FRFs and lines of a
    /// recording whose values have the weights 2/σ².
    ///
    /// `None` where the fixture has no finite FRFs.
    pub(crate) fn of(
        believed: &Fixture,
        at: &'a Fixture,
        recorded: &'a FrfSet,
        weights: impl Iterator<Item = f64>,
    ) -> Option<Self> {
        let scale = weights.map(f64::sqrt).collect();
        let count = recorded.lines().len();
        let mut sensitivity = Sensitivity {
            plain: Vec::with_capacity(count),
            at,
            recorded,
            scale,
            columns: Vec::new(),
            information: Vec::new(),
        };
        sensitivity.plain = sensitivity.frfs(at)?;
        let tolerances = Tolerance::all(believed);
        let from = values(at);
        for tolerance in &tolerances {
            let moved = |sign: f64| {
                let mut fixture = at.clone();
                let step = sign * DIFFERENCE * tolerance.step(&from);
                fixture.set_quantities([(tolerance.index, from[tolerance.index] + step)]);
                sensitivity.frfs(&fixture)
            };
            let (up, down) = (moved(1.0)?, moved(-1.0)?);
            sensitivity.columns.push(sensitivity.difference(&up, &down, 2.0 * DIFFERENCE));
        }
        let n = tolerances.len();
        let mut information = vec![0.0; n * n];
        for m in 0..n {
            for k in 0..=m {
                let product = dot(&sensitivity.columns[m], &sensitivity.columns[k]);
                information[m * n + k] = product;
                information[k * n + m] = product;
            }
            information[m * n + m] += f64::from(tolerances[m].is_known());
            if information[m * n + m] == 0.0 {
                information[m * n + m] = 1.0;
            }
        }
        sensitivity.information = information;
        Some(sensitivity)
    }

    fn frfs(&self, fixture: &Fixture) -> Option<Vec<Complex64>> {
        let (pairs, lines) = (self.recorded.pairs(), self.recorded.lines());
        frfs(fixture, pairs, lines, Instrument::AsDescribed).ok().map(|set| set.all_values().to_vec())
    }

    /// (a − b)/step in units of the noise.
    fn difference(&self, a: &[Complex64], b: &[Complex64], step: f64) -> Vec<Complex64> {
        a.iter().zip(b).zip(&self.scale).map(|((a, b), scale)| (a - b) * *scale / step).collect()
    }

    /// What `effect` does by unit of its strength while it is weak; `None` where it does nothing, or the
    /// fixture cannot have it.
    pub(crate) fn direction(&self, effect: &Effect) -> Option<Direction> {
        // What tolerances leave may be a thousandth of what it does, and a strong effect bends by as much,
        // while of a weak one rounding leaves no more: of two strengths in between the bend is taken out.
        let mut weak = effect.clone();
        let mut values = self.change(&weak)?;
        for _ in 0..WEAKENED {
            let whole = dot(&values, &values);
            if !(whole > 0.0 && whole.is_finite()) {
                return None;
            }
            weak = with_strength(&weak, (WHOLE / whole).sqrt() * strength(effect).signum());
            values = self.change(&weak)?;
        }
        let half = self.change(&with_strength(&weak, 0.5 * strength(&weak)))?;
        values.iter_mut().zip(&half).for_each(|(value, half)| *value = 2.0 * half - *value);
        self.imitated(values)
    }

    /// The same of the effect as strong as it is, bend and all: of what is weaker than first order was taken
    /// at, and does not grow in proportion.
    pub(crate) fn direction_as_it_is(&self, effect: &Effect) -> Option<Direction> {
        self.imitated(self.change(effect)?)
    }

    fn imitated(&self, values: Vec<Complex64>) -> Option<Direction> {
        let projections: Vec<f64> = self.columns.iter().map(|column| dot(column, &values)).collect();
        let mut imitation = projections.clone();
        let usable = values.iter().all(|v| v.is_finite());
        (usable && solve_positive_definite(&mut self.information.clone(), &mut imitation))
            .then_some(Direction { values, projections, imitation })
    }

    /// The change that an effect makes, over its strength.
    fn change(&self, effect: &Effect) -> Option<Vec<Complex64>> {
        let with = self.frfs(&self.at.clone().with_physics(vec![effect.clone()]).ok()?)?;
        Some(self.difference(&with, &self.plain, strength(effect)))
    }
}

impl Direction {
    /// Δχ² by the square of the strength, every quantity of the fixture held.
    pub(crate) fn whole(&self, other: &Direction) -> f64 {
        dot(&self.values, &other.values)
    }

    /// The same of what is left when the quantities of the fixture have yielded within their tolerances.
    pub(crate) fn beyond_tolerances(&self, other: &Direction) -> f64 {
        let taken: f64 = self.projections.iter().zip(&other.imitation).map(|(p, i)| p * i).sum();
        self.whole(other) - taken
    }
}
