//! From hits of several strengths to the law of a joint.

pub(crate) mod diagnosis;
mod fit;
pub(crate) mod homogeneity;
mod horizon;
mod hypothesis;
pub(crate) mod judge;
mod laws;
mod locations;
pub(crate) mod misfit;
mod needed;
mod reconstruction;
mod records;
mod search;
mod shapes;
