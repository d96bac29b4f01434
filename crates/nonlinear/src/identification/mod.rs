//! From hits of several strengths to the law of a joint.

pub(crate) mod candidates;
pub(crate) mod diagnosis;
pub(crate) mod fit;
pub(crate) mod homogeneity;
pub(crate) mod horizon;
mod judge;
pub(crate) mod misfit;
pub(crate) mod parameters;
pub(crate) mod reconstruction;
pub(crate) mod records;
mod says;
pub(crate) mod search;
mod shapes;
pub(crate) mod spectra;
