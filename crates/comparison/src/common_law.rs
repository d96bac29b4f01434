//! Joints that follow one law over frequency, whichever it is.
//!
//! A joint's K and C are those of one law, in the middle of the band; other laws that explain the FRFs have
//! other K and C there, and by how much they differ is a part of the uncertainty. Joints of which the same
//! law is the most probable are taken to follow one law: where another one holds, it holds for all of them.

use crate::Decomposed;

/// The joints by their most probable law, each group in the order given; those of which no law is stated by
/// themselves.
pub(crate) fn groups(joints: &[Decomposed]) -> Vec<Vec<usize>> {
    let best = |joint: usize| joints[joint].fitted.as_ref()?.law.as_deref();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for joint in 0..joints.len() {
        let own = best(joint).is_some();
        match groups.iter_mut().find(|group| own && best(group[0]) == best(joint)) {
            Some(group) => group.push(joint),
            None => groups.push(vec![joint]),
        }
    }
    groups
}
