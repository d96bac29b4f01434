//! What the choice of a law over frequency does to several joints alike.
//!
//! A joint's K and C are those of one law, in the middle of the band; other laws that explain the FRFs have other K and C there, and by how much they differ is a part of the
//! uncertainty. Joints of which the same law is the most probable are taken to follow one law, whichever it is: its probability is then the product of those that each joint gives
//! it, and what it changes in one joint goes with what it changes in the others: Σ pᵢ δᵢδᵢᵀ over the numbers of all of them. It cancels in their ratio but for what the joints differ in.

use crate::{Decomposed, FiledJoint};

/// Joints that follow one law.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CommonLaw {
    /// Which joints.
    pub joints: Vec<usize>,
    /// Of each law that all of them have: its probability, and by how much it is off each joint.
    laws: Vec<(f64, Vec<[f64; 6]>)>,
}

impl CommonLaw {
    /// The groups of two joints or more with the same most probable law.
    pub(crate) fn of(joints: &[Decomposed]) -> Vec<Self> {
        let best = |joint: usize| joints[joint].fitted.as_ref()?.law.as_deref();
        let first = |joint: usize| (0..joint).all(|other| best(other) != best(joint));
        let firsts = (0..joints.len()).filter(|&joint| best(joint).is_some() && first(joint));
        let group = |joint: usize| {
            let all: Vec<usize> = (0..joints.len()).filter(|&other| best(other) == best(joint)).collect();
            CommonLaw::shared(joints, all)
        };
        firsts.filter_map(group).collect()
    }

    fn shared(joints: &[Decomposed], all: Vec<usize>) -> Option<Self> {
        let fits: Vec<&FiledJoint> =
            all.iter().map(|&joint| joints[joint].fitted.as_ref()).collect::<Option<_>>()?;
        let (first, others) = fits.split_first()?;
        if others.is_empty() {
            return None;
        }
        let law = |name: &str, probability: f64| {
            let of =
                |fit: &&FiledJoint| fit.laws.iter().find(|law| law.law == name).map(|law| law.probability);
            let rest = others.iter().map(of).product::<Option<f64>>()?;
            let departures = fits.iter().map(|fit| fit.departure(name)).collect::<Option<Vec<_>>>()?;
            Some((probability * rest, departures))
        };
        let mut laws: Vec<(f64, Vec<[f64; 6]>)> =
            first.laws.iter().filter_map(|entry| law(&entry.law, entry.probability)).collect();
        let total: f64 = laws.iter().map(|(probability, _)| probability).sum();
        if total.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
            return None;
        }
        laws.iter_mut().for_each(|(probability, _)| *probability /= total);
        Some(CommonLaw { joints: all, laws })
    }

    /// Covariance of two joints' numbers from the law, joints by their places in the group.
    pub(crate) fn covariance(&self, (joint, slot): (usize, usize), (other, with): (usize, usize)) -> f64 {
        self.laws.iter().map(|(probability, by)| probability * by[joint][slot] * by[other][with]).sum()
    }
}
