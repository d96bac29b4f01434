//! From hits of several strengths to the law of a joint.

pub(crate) mod candidates;
pub(crate) mod diagnosis;
pub(crate) mod fit;
pub(crate) mod homogeneity;
pub(crate) mod misfit;
pub(crate) mod parameters;
pub(crate) mod records;
mod says;
pub(crate) mod search;
pub(crate) mod spectra;
