//! Laws whose strength is linear, compared by what they leave of a reconstructed force: suggestions of where
//! to begin a fit.

use super::locations::JointLocation;
use super::misfit::Focus;
use super::reconstruction::{Seen, seen};
use super::records::Record;
use crate::RestoringLaw;
use crate::settings::suggestions::{ALIKE, LARGEST, SEEN_WEIGHT, SHAPES, SIZES, SMALLEST};
use jointscope_fixture::{Effect, Fixture};
use jointscope_inference::each;
use jointscope_linalg::solve_positive_definite;
use num_complex::Complex64;

/// Effects at one location to begin with.
#[derive(Debug, Clone)]
pub(crate) struct Suggestion {
    /// Of one kind, the one that leaves least first.
    pub effects: Vec<Effect>,
    /// Share of the weighted misfit that the first of them explains beyond what a linear change of the joint
    /// does.
    pub share: f64,
}

impl Suggestion {
    /// Takes the best effect of another suggestion, and all of them if it explains more.
    pub(super) fn join(&mut self, mut other: Suggestion) {
        if other.share > self.share {
            std::mem::swap(self, &mut other);
        }
        other.effects.into_iter().take(1).for_each(|effect| self.add(effect));
    }

    fn add(&mut self, effect: Effect) {
        if !self.effects.iter().any(|known| is_like(known, &effect, ALIKE)) {
            self.effects.push(effect);
        }
    }
}

/// Whether names are the same and no parameter differs by more than a part `by`.
pub(super) fn is_like(a: &Effect, b: &Effect, by: f64) -> bool {
    let close = |a: f64, b: f64| (a - b).abs() <= by * a.abs().max(b.abs());
    a.is_named_as(b) && (0..a.parameters.len()).all(|i| close(a.value(i), b.value(i)))
}

/// Columns that stand for what the fixture states a little wrongly: stiffness, dashpot and mass across the
/// joint.
const LINEAR: usize = 3;

/// Sums of least squares: linear columns, then the shape.
#[derive(Clone, Copy, Default)]
struct Sums {
    matrix: [[f64; LINEAR + 1]; LINEAR + 1],
    right: [f64; LINEAR + 1],
    square: f64,
}

/// A law of strength 1 laid against what was recorded.
struct Tried {
    /// Its strength beside a linear change of the joint, and the share of what such a change leaves that it
    /// takes.
    beside: (f64, f64),
    /// Its strength without any such change, and the share of all that it takes.
    alone: (f64, f64),
}

/// Least squares at one location.
struct Regression<'a> {
    seen: &'a [Seen],
    index: usize,
    /// D, sD, s²D of every record.
    columns: Vec<[Vec<Complex64>; LINEAR]>,
    linear: Sums,
    /// What linear columns take off the sum of squares.
    taken: f64,
}

/// For every location, suggestions for each kind of law that helps there. `model` is the fixture as far as it
/// is known, laws found already included.
pub(crate) fn suggestions(
    model: &Fixture,
    records: &[&Record],
    locations: &[JointLocation],
    focus: &Focus,
) -> Option<Vec<Suggestion>> {
    let seen = seen(model, records, locations, focus)?;
    let numbered: Vec<(usize, &JointLocation)> = locations.iter().enumerate().collect();
    Some(each(&numbered, |&(index, location)| suggested(&seen, index, location)).concat())
}

/// Suggestions for each kind of law that helps at a location.
fn suggested(seen: &[Seen], index: usize, location: &JointLocation) -> Vec<Suggestion> {
    let largest = seen
        .iter()
        .flat_map(|one| one.locations[index].motion.iter().zip(one.window()))
        .filter(|(_, window)| **window > SEEN_WEIGHT)
        .fold(0.0, |most: f64, (d, _)| most.max(d.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return Vec::new();
    }
    let regression = Regression::of(seen, index);
    let unit = largest.powi(-2);
    let sizes: Vec<f64> =
        (0..SIZES).map(|i| largest * SMALLEST.powf(1.0 - i as f64 / (SIZES - 1) as f64) * LARGEST).collect();
    let kinds: [(Shape, &[f64]); 3] = [
        (&|_, k| RestoringLaw::Cubic { stiffness3: k * unit }, &sizes[..1]),
        (&|slip, k| RestoringLaw::Friction { slip_force: k * slip, stiffness: k }, &sizes),
        (&|clearance, k| RestoringLaw::Gap { clearance, stiffness: k }, &sizes),
    ];
    kinds.into_iter().filter_map(|(shape, sizes)| of_kind(&regression, shape, sizes, location)).collect()
}

/// A law by its size (where it slips, where it touches) and its strength.
type Shape<'a> = &'a dyn Fn(f64, f64) -> RestoringLaw;

/// The best sizes of one kind of law, each with its strength.
fn of_kind(
    regression: &Regression,
    shape: Shape,
    sizes: &[f64],
    location: &JointLocation,
) -> Option<Suggestion> {
    let tried: Vec<Option<Tried>> = sizes.iter().map(|size| regression.tried(shape(*size, 1.0))).collect();
    // A cubic spring alone may have either sign.
    let usable = |(k, share): &(f64, f64)| {
        share.is_finite()
            && (*k > 0.0 || (*k < 0.0 && matches!(shape(sizes[0], 1.0), RestoringLaw::Cubic { .. })))
    };
    let results = |by: fn(&Tried) -> (f64, f64)| -> Vec<Option<(f64, f64)>> {
        tried.iter().map(|tried| tried.as_ref().map(by).filter(usable)).collect()
    };
    let (beside, alone) = (results(|tried| tried.beside), results(|tried| tried.alone));
    let best = peaks(&beside);
    let share = beside[*best.first()?]?.1;
    let mut suggestion = Suggestion { effects: Vec::new(), share };
    let chosen = best.iter().take(SHAPES).map(|&i| (i, beside[i]));
    for (i, result) in chosen.chain(peaks(&alone).first().map(|&i| (i, alone[i]))) {
        if let Some((k, _)) = result {
            suggestion.add(shape(sizes[i], k).to_effect(&location.joint, location.dof));
        }
    }
    Some(suggestion)
}

/// Places of the local maxima of the share, the highest first.
fn peaks(results: &[Option<(f64, f64)>]) -> Vec<usize> {
    let share = |i: usize| results.get(i).copied().flatten().map_or(f64::NEG_INFINITY, |(_, share)| share);
    let is_peak = |i: &usize| {
        share(*i).is_finite() && share(*i) >= share(i + 1) && (*i == 0 || share(*i) > share(i - 1))
    };
    let mut peaks: Vec<usize> = (0..results.len()).filter(is_peak).collect();
    peaks.sort_by(|a, b| share(*b).total_cmp(&share(*a)));
    peaks
}

impl Sums {
    /// Coefficient of the last of `count` columns, and what they take off the sum of squares.
    fn solved(&self, count: usize) -> Option<(f64, f64)> {
        let size: Vec<f64> = (0..count).map(|i| self.matrix[i][i].sqrt()).collect();
        if size.iter().any(|s| *s <= 0.0 || !s.is_finite()) {
            return None;
        }
        let mut matrix: Vec<f64> = (0..count * count)
            .map(|k| self.matrix[k / count][k % count] / (size[k / count] * size[k % count]))
            .collect();
        (0..count).for_each(|i| matrix[i * count + i] += 1e-9);
        let right: Vec<f64> = (0..count).map(|i| self.right[i] / size[i]).collect();
        let mut solution = right.clone();
        if !solve_positive_definite(&mut matrix, &mut solution) {
            return None;
        }
        let gain: f64 = solution.iter().zip(&right).map(|(a, b)| a * b).sum();
        Some((solution[count - 1] / size[count - 1], gain))
    }
}

impl<'a> Regression<'a> {
    fn of(seen: &'a [Seen], index: usize) -> Self {
        let columns = |one: &Seen| {
            let motion = &one.locations[index].lines;
            [0, 1, 2].map(|power| motion.iter().zip(&one.s).map(|(d, s)| d * s.powi(power)).collect())
        };
        let columns: Vec<[Vec<Complex64>; LINEAR]> = seen.iter().map(columns).collect();
        let mut linear = Sums::default();
        for (one, columns) in seen.iter().zip(&columns) {
            one.each_value(index, |k, h, target| {
                let values = columns.each_ref().map(|column| column[k] * h);
                linear.square += target.norm_sqr();
                for i in 0..LINEAR {
                    linear.right[i] += product(values[i], target);
                    (0..LINEAR).for_each(|j| linear.matrix[i][j] += product(values[i], values[j]));
                }
            });
        }
        let taken = linear.solved(LINEAR).map_or(0.0, |(_, gain)| gain);
        Regression { seen, index, columns, linear, taken }
    }

    fn tried(&self, law: RestoringLaw) -> Option<Tried> {
        let mut sums = self.linear;
        for (one, columns) in self.seen.iter().zip(&self.columns) {
            let shape = one.force(&law.forces(&one.locations[self.index].motion));
            one.each_value(self.index, |k, h, target| {
                let value = shape[k] * h;
                sums.right[LINEAR] += product(value, target);
                sums.matrix[LINEAR][LINEAR] += value.norm_sqr();
                for i in 0..LINEAR {
                    let cross = product(value, columns[i][k] * h);
                    sums.matrix[i][LINEAR] += cross;
                    sums.matrix[LINEAR][i] += cross;
                }
            });
        }
        let (strength, gain) = sums.solved(LINEAR + 1)?;
        let (own, along) = (sums.matrix[LINEAR][LINEAR], sums.right[LINEAR]);
        Some(Tried {
            beside: (strength, (gain - self.taken) / (sums.square - self.taken)),
            alone: (along / own, along * along / (own * sums.square)),
        })
    }
}

/// Real part of a̅b.
fn product(a: Complex64, b: Complex64) -> f64 {
    a.re * b.re + a.im * b.im
}
