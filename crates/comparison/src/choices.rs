//! Which laws over frequency joints may follow, other than those that they are compared at.
//!
//! Joints of one law follow it together: where another one holds, it holds for all of them.

use crate::common_law::groups;
use crate::laws_in_common::LawsInCommon;
use crate::{Decomposed, LawOfAll};

/// Probability, in units of that of the law compared at, below which another one is left out.
const LEAST: f64 = 1e-3;

/// All joints by some choice of their laws.
pub(crate) struct Choice {
    /// In units of the probability of the laws compared at.
    pub weight: f64,
    /// The joints by these laws.
    pub joints: Vec<Decomposed>,
    /// By how much numbers are off those of the laws compared at, by joint, where files say no more of a law
    /// than that; the joints are then by these.
    pub apart: Option<Vec<[f64; 6]>>,
}

/// The laws compared at first, then every other law of each group of joints that follow one.
pub(crate) fn choices(given: &[Decomposed], placed: &[Decomposed], law: Option<&LawOfAll>) -> Vec<Choice> {
    let mut all = vec![Choice { weight: 1.0, joints: placed.to_vec(), apart: None }];
    let followed = match law {
        Some(_) => vec![(0..placed.len()).collect()],
        None => groups(placed),
    };
    for group in followed {
        let members: Vec<&Decomposed> = group.iter().map(|&joint| &placed[joint]).collect();
        let stated = members[0].fitted.as_ref().map(|fit| fit.stated_law().to_owned());
        let Some((stated, common)) = stated.zip(LawsInCommon::of(&members)) else { continue };
        let Some(own) = common.evidence(&stated) else { continue };
        for (other, evidence) in &common.laws {
            let weight = (evidence - own).exp();
            if *other != stated && weight >= LEAST && weight.is_finite() {
                all.extend(choice(given, placed, (&group, other), weight));
            }
        }
    }
    all
}

fn choice(
    given: &[Decomposed],
    placed: &[Decomposed],
    (group, law): (&[usize], &str),
    weight: f64,
) -> Option<Choice> {
    let mut joints = placed.to_vec();
    let of_group = |joints: &[Decomposed]| -> Vec<Decomposed> {
        group.iter().map(|&joint| joints[joint].clone()).collect()
    };
    let all = LawOfAll { law: law.to_owned(), moved: Vec::new(), restated: Vec::new() };
    if let Some(moved) = all.placed_whole(&of_group(given)) {
        group.iter().zip(moved).for_each(|(&joint, moved)| joints[joint] = moved);
        return Some(Choice { weight, joints, apart: None });
    }
    let mut apart = vec![[0.0; 6]; placed.len()];
    for &joint in group {
        apart[joint] = placed[joint].fitted.as_ref()?.departure(law)?;
    }
    Some(Choice { weight, joints, apart: Some(apart) })
}
