//! Joints at one law over frequency.
//!
//! K and C of different laws are different numbers of one joint, each with the deviation that it has if its
//! law holds. So joints are compared at one law: of those under which every file says what its FRFs tell, the
//! one with the largest product of probabilities, which is the most probable one if all joints follow one
//! law.
//!
//! Whether joints are the same is tested by what FRFs alone tell under this law, with C free: of a C that is
//! held where it gives out no energy the estimate is no longer normal about the true one, of a free C it is.
//! What other laws would change belongs to no such test: under the law that holds it is no error of either
//! joint.

use crate::laws_in_common::LawsInCommon;
use crate::stiffness_file::Matrix;
use crate::{Decomposed, FiledJoint, FiledLikelihood, FollowedLaw};
use jointscope_inference::NormalEquations;
use serde::Serialize;

/// Share of a frequency below which two are the same number.
pub(crate) const SAME_FREQUENCY: f64 = 1e-6;
/// Odds by which a law must be more probable than those whose numbers can be stated at one frequency to be
/// taken instead of these.
const MORE_PROBABLE: f64 = 20.0;

/// The law over frequency at which joints are compared.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LawOfAll {
    /// Its name.
    pub law: String,
    /// Joints of which another one is the most probable by their own FRFs.
    pub moved: Vec<String>,
    /// Joints whose C is stated at the frequency of the first one's, their own files having it at another.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub restated: Vec<String>,
}

impl LawOfAll {
    /// The most probable law of all these joints together; nothing where they follow laws of their own, where
    /// there is none under which every file says what its FRFs tell, or where its numbers are stated at
    /// frequencies on which they depend.
    pub(crate) fn of(joints: &[Decomposed]) -> Option<Self> {
        let fits: Vec<&FiledJoint> =
            joints.iter().map(|joint| joint.fitted.as_ref()).collect::<Option<_>>()?;
        let first = fits.first()?;
        let common = LawsInCommon::of(&joints.iter().collect::<Vec<_>>());
        if common.as_ref().is_some_and(LawsInCommon::is_refuted) {
            return None;
        }
        let beside = first.laws.iter().map(|entry| entry.law.as_str());
        let laws = beside.filter(|law| *law != first.stated_law()).chain([first.stated_law()]);
        let evidence = |law: &str| {
            let usable =
                fits.iter().map(|fit| fit.probability_under(law).map(f64::ln)).sum::<Option<f64>>()?;
            Some(common.as_ref().and_then(|common| common.evidence(law)).unwrap_or(usable))
        };
        let known: Vec<(&str, f64)> = laws.filter_map(|law| Some((law, evidence(law)?))).collect();
        let best = |at_one_frequency: bool| {
            let all = known.iter().filter(|(law, _)| !at_one_frequency || is_at_one_frequency(joints, law));
            all.copied().max_by(|a, b| a.1.total_cmp(&b.1))
        };
        let (law, found) = best(true)?;
        if best(false).is_some_and(|(_, most)| most > found + MORE_PROBABLE.ln()) {
            return None;
        }
        let is_moved = |joint: &&Decomposed| joint.fitted.as_ref().is_some_and(|fit| fit.stated_law() != law);
        let moved = joints.iter().filter(is_moved).map(|joint| joint.name.clone()).collect();
        let restated = joints.iter().filter(|joint| restated_by(joints, joint, law) != 1.0);
        let restated = restated.map(|joint| joint.name.clone()).collect();
        Some(LawOfAll { law: law.to_owned(), moved, restated })
    }

    /// The joints at this law.
    pub(crate) fn placed(&self, joints: &[Decomposed]) -> Vec<Decomposed> {
        let at = |joint: &Decomposed| {
            let moved = joint.fitted.as_ref().and_then(|fit| fit.at_law(&self.law));
            let by = restated_by(joints, joint, &self.law);
            let moved = moved.map(|fit| if by == 1.0 { fit } else { fit.restated(by) });
            Decomposed { fitted: moved.or_else(|| joint.fitted.clone()), ..joint.clone() }
        };
        joints.iter().map(at).collect()
    }

    /// The same, if every file says what its FRFs tell under this law, with numbers at one frequency.
    pub(crate) fn placed_whole(&self, joints: &[Decomposed]) -> Option<Vec<Decomposed>> {
        let fit = |joint: &Decomposed| joint.fitted.as_ref()?.at_law(&self.law);
        let is_whole = joints.iter().all(|joint| fit(joint).is_some());
        (is_whole && is_at_one_frequency(joints, &self.law)).then(|| self.placed(joints))
    }
}

/// Where a joint's numbers are stated, Hz.
fn stated_at(joint: &Decomposed) -> Option<f64> {
    Some(joint.fitted.as_ref()?.follows.as_ref()?.frequency)
}

fn are_stated_alike(joints: &[Decomposed]) -> bool {
    let all: Vec<f64> = joints.iter().filter_map(stated_at).collect();
    all.iter().all(|at| (at - all[0]).abs() <= SAME_FREQUENCY * all[0].abs())
}

/// Whether numbers under a law do not depend on frequency, are stated at one, or can be.
fn is_at_one_frequency(joints: &[Decomposed], law: &str) -> bool {
    let is_restatable = law.starts_with("structural") && joints.iter().all(|joint| joint.at_once.is_none());
    law.starts_with("viscous") || law.starts_with("constant") || is_restatable || are_stated_alike(joints)
}

/// What C of a structural joint, ηK/ω, is multiplied by to be that at the frequency of the first of all; 1 of
/// other laws.
fn restated_by(joints: &[Decomposed], joint: &Decomposed, law: &str) -> f64 {
    if !law.starts_with("structural") || joint.at_once.is_some() || are_stated_alike(joints) {
        return 1.0;
    }
    stated_at(joint).zip(joints.iter().find_map(stated_at)).map_or(1.0, |(own, first)| own / first)
}

/// The joints as if their laws were certain: without what laws change in them, where files say what that is.
pub(crate) fn certain(joints: &[Decomposed]) -> Vec<Decomposed> {
    let of = |joint: &Decomposed| {
        let fit = joint.fitted.as_ref().filter(|fit| fit.departure(fit.stated_law()).is_some());
        let fit = fit.map(|fit| {
            let mut covariance = fit.covariance;
            for (row, of_laws) in covariance.iter_mut().zip(fit.law_covariance) {
                row.iter_mut().zip(of_laws).for_each(|(entry, of_law)| *entry -= of_law);
            }
            FiledJoint { covariance, law_covariance: [[0.0; 6]; 6], ..fit.clone() }
        });
        Decomposed { fitted: fit.or_else(|| joint.fitted.clone()), ..joint.clone() }
    };
    joints.iter().map(of).collect()
}

/// The joints as their FRFs alone tell of them under the laws that their numbers are of, C free. What one fit
/// found at once stays as it is.
pub(crate) fn with_free_damping(joints: &[Decomposed]) -> Vec<Decomposed> {
    let free = |joint: &Decomposed| {
        let own = joint.fitted.as_ref().filter(|_| joint.at_once.is_none());
        let with_free_damping = own.and_then(FiledJoint::with_free_damping);
        Decomposed { fitted: with_free_damping.or_else(|| joint.fitted.clone()), ..joint.clone() }
    };
    joints.iter().map(free).collect()
}

/// Mean and covariance of the six numbers.
type Six = ([f64; 6], [[f64; 6]; 6]);

impl FiledJoint {
    /// Probability of a law under which the file says what the FRFs tell.
    fn probability_under(&self, law: &str) -> Option<f64> {
        let entry = self.laws.iter().find(|entry| entry.law == law);
        let is_stated = law == self.stated_law();
        let usable = entry.filter(|entry| is_stated || entry.likelihood.is_some());
        let probability = usable.map(|entry| entry.probability).filter(|p| *p > 0.0);
        probability.or_else(|| (is_stated && self.laws.is_empty()).then_some(1.0))
    }

    /// The six numbers as FRFs and the fixture's tolerances tell, those that are not told being zero without
    /// a deviation.
    fn posterior(&self, filed: &FiledLikelihood) -> Option<Six> {
        let (slots, likelihood) = filed.of_six(self.quantities.len())?;
        let precision = |m: usize| f64::from(u8::from(self.quantities[m - slots.len()].std.is_some()));
        let own: Vec<usize> = (0..slots.len()).collect();
        let own = likelihood.marginal(&own, precision)?;
        let mut equations = NormalEquations::zero(slots.len());
        own.add_to(&mut equations, &own.at, &(0..slots.len()).collect::<Vec<_>>());
        let (step, covariance) = (equations.step(0.0)?, equations.covariance()?);
        let (mut mean, mut of) = ([0.0; 6], [[0.0; 6]; 6]);
        for (i, &slot) in slots.iter().enumerate() {
            mean[slot] = own.at[i] + step[i];
            for (j, &with) in slots.iter().enumerate() {
                of[slot][with] = self.model_error.tolerance_inflation * covariance.at(i, j)
                    + self.model_error.covariance[slot][with];
            }
        }
        Some((mean, of))
    }

    /// The joint with C free and its law for certain.
    fn with_free_damping(&self) -> Option<Self> {
        let (mean, covariance) = self.posterior(self.likelihood.as_ref()?)?;
        let (stiffness, damping) = matrices(&mean);
        Some(FiledJoint {
            stiffness,
            damping,
            covariance,
            law_covariance: [[0.0; 6]; 6],
            laws: Vec::new(),
            on_the_boundary_of_passive: false,
            ..self.clone()
        })
    }

    /// The joint by another of the laws compared.
    fn at_law(&self, law: &str) -> Option<Self> {
        let named = Some(law.to_owned());
        if law == self.stated_law() {
            // Files of earlier versions state a law that is not the most probable one.
            let law = if self.follows.is_some() { named } else { self.law.clone() };
            return Some(FiledJoint { law, ..self.clone() });
        }
        let entry = self.laws.iter().find(|entry| entry.law == law)?;
        let likelihood = entry.likelihood.clone();
        let (mean, mut covariance) = self.posterior(likelihood.as_ref()?)?;
        let follows = self.follows.as_ref()?;
        let (stiffness, free) = matrices(&mean);
        let damping = passive(&free, &stiffness);
        let mut moved = FiledJoint {
            stiffness,
            damping,
            likelihood,
            law: named,
            follows: Some(FollowedLaw::plain(law, entry.probability, follows.frequency)),
            on_the_boundary_of_passive: damping != free,
            mass: entry.mass(),
            ..self.clone()
        };
        moved.law_covariance = moved.spread();
        for (row, of_laws) in covariance.iter_mut().zip(moved.law_covariance) {
            row.iter_mut().zip(of_laws).for_each(|(entry, of_law)| *entry += of_law);
        }
        Some(FiledJoint { covariance, ..moved })
    }

    /// The same joint with C in other units: `by` of them are one of before.
    fn restated(&self, by: f64) -> Self {
        let factor = |slot: usize| if slot < 3 { 1.0 } else { by };
        let scaled = |matrix: &[[f64; 6]; 6]| -> [[f64; 6]; 6] {
            std::array::from_fn(|i| std::array::from_fn(|j| matrix[i][j] * factor(i) * factor(j)))
        };
        let likelihood = self.likelihood.as_ref().and_then(|filed| {
            let (slots, likelihood) = filed.of_six(self.quantities.len())?;
            // One unit of the new number is 1/by of the old.
            let unit = |index: usize| slots.get(index).map_or(1.0, |slot| factor(*slot));
            Some(FiledLikelihood::of(filed.elements.clone(), &likelihood.scaled(unit)))
        });
        let follows = self
            .follows
            .clone()
            .map(|follows| FollowedLaw { frequency: follows.frequency * by.recip(), ..follows });
        let mut model_error = self.model_error;
        model_error.covariance = scaled(&model_error.covariance);
        let mut laws = self.laws.clone();
        for middle in laws.iter_mut().filter_map(|law| law.in_the_middle.as_mut()) {
            middle.damping = middle.damping.map(|row| row.map(|c| c * by));
        }
        FiledJoint {
            damping: self.damping.map(|row| row.map(|c| c * by)),
            covariance: scaled(&self.covariance),
            law_covariance: scaled(&self.law_covariance),
            model_error,
            likelihood,
            follows,
            laws,
            ..self.clone()
        }
    }

    /// Mean products of what the laws compared differ by from the one stated.
    fn spread(&self) -> [[f64; 6]; 6] {
        let mut spread = [[0.0; 6]; 6];
        for entry in &self.laws {
            let Some(by) = self.departure(&entry.law) else { continue };
            for (row, a) in spread.iter_mut().zip(by) {
                row.iter_mut().zip(by).for_each(|(sum, b)| *sum += entry.probability * a * b);
            }
        }
        spread
    }
}

pub(crate) fn matrices(six: &[f64; 6]) -> (Matrix, Matrix) {
    let matrix = |first: usize| [[six[first], six[first + 1]], [six[first + 1], six[first + 2]]];
    (matrix(0), matrix(3))
}

/// The nearest C that gives out no energy, its elements in units of those of K.
fn passive(c: &Matrix, k: &Matrix) -> Matrix {
    let unit = |i: usize| if k[i][i] == 0.0 { 1.0 } else { k[i][i].abs().sqrt() };
    let (u, v) = (unit(0), unit(1));
    let (a, b, d) = (c[0][0] / (u * u), c[0][1] / (u * v), c[1][1] / (v * v));
    let (mean, radius) = (0.5 * (a + d), (0.5 * (a - d)).hypot(b));
    if mean - radius >= 0.0 {
        return *c;
    }
    // What is left is the larger eigenvalue, if it is positive, along its vector.
    let (largest, angle) = ((mean + radius).max(0.0), 0.5 * b.atan2(0.5 * (a - d)));
    let (x, y) = (angle.cos() * u, angle.sin() * v);
    [[largest * x * x, largest * x * y], [largest * x * y, largest * y * y]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_c_that_gives_out_energy_is_moved_to_the_nearest_that_does_not() {
        let k = [[4.0, 0.0], [0.0, 1.0]];
        assert_eq!(passive(&[[4.0, 0.5], [0.5, 1.0]], &k), [[4.0, 0.5], [0.5, 1.0]]);
        let held = passive(&[[8.0, 0.0], [0.0, -1.0]], &k);
        assert!((held[0][0] - 8.0).abs() < 1e-12 && held[1][1].abs() < 1e-12, "{held:?}");
        assert_eq!(passive(&[[-8.0, 0.0], [0.0, -1.0]], &k), [[0.0; 2]; 2]);
        // Bodies that do not rotate.
        assert_eq!(passive(&[[-1.0, 0.0], [0.0, 0.0]], &[[4.0, 0.0], [0.0, 0.0]]), [[0.0; 2]; 2]);
    }
}
