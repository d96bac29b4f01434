//! Decompositions of several joints side by side, and which of them is the stiffer (Table 4), with the
//! probability that the order is right.
//!
//! The paper arranges joints by the averages of each element of K and says nothing of how sure the order is.
//! Here every number has a standard deviation, and errors that joints have in common are known as such: two
//! joints on the same blocks share what is not known of the blocks, which cancels in their ratio.
//!
//! * [`Decomposed`]: what `stiffness.json` says of one joint, by entries ([`LineEntry`], [`EstimateEntry`] …)
//!   that its writer shares;
//! * [`Comparison`]: several of them, by one relation and one estimate;
//! * [`Together`]: their numbers in one Gaussian, the quantities of shared bodies in it once;
//! * [`Pair`]: difference and ratio of two with intervals, who is the larger, whether they are the same
//!   ([`Equality`]), whether they follow one law ([`LawsDiffer`]);
//! * [`LawOfAll`]: the law over frequency at which they are compared, the most probable of all of them
//!   together;
//! * [`Ranking`]: the order by each number with its probability;
//! * [`ModelRatios`]: joints of models over measured ones, where it is said which is which ([`Source`]);
//! * [`Specimens`]: the scatter between specimens of one kind, apart from that of measurement;
//! * [`Caution`]: why a comparison may not be taken as it stands.
//!
//! ```
//! use jointscope_comparison::Ranking;
//!
//! // Three joints with their standard deviations: the first two cannot be told apart.
//! let ranking = Ranking::of(&[(1.00, 0.05), (1.01, 0.05), (2.0, 0.05)]);
//! assert_eq!(ranking.order, [0, 1, 2]);
//! assert!(ranking.probability > 0.5 && ranking.probability < 0.62);
//! assert!(ranking.adjacent[1] > 0.999);
//! ```

mod about_centre;
mod agreement;
mod at_law;
mod at_once;
mod bodies;
mod by_law;
mod caution;
mod choices;
mod common_law;
mod compared;
mod comparison;
mod decomposed;
mod equality;
mod filed;
mod filed_likelihood;
mod laws_in_common;
mod models;
mod normal;
mod number;
mod one_slope;
mod pair;
mod ranking;
mod source;
mod specimens;
mod stiffness_file;
mod together;

pub use at_law::LawOfAll;
pub use at_once::{AtOnce, PlaceInFit};
pub use bodies::{Apart, SharedBody, WhyApart};
pub use caution::Caution;
pub use compared::Compared;
pub use comparison::{Comparison, ComparisonError, ComparisonOptions, ElementRanking};
pub use decomposed::{Average, Decomposed, DecomposedError, End, Ends, FiledEstimate, Judged, Line};
pub use equality::Equality;
pub use filed::{FiledJoint, FiledTests, StatedQuantity};
pub use filed_likelihood::FiledLikelihood;
pub use models::{ModelIs, ModelRatio, ModelRatios};
pub use number::{ELEMENTS, Kind, Number};
pub use pair::{FigureInterval, LawsDiffer, Pair, PairedNumber, Ratio};
pub use ranking::Ranking;
pub use source::Source;
pub use specimens::{Scatter, Specimens};
pub use stiffness_file::{
    ComparedLaw, EstimateEntry, FollowedLaw, LineEntry, LossFactor, Matrix, MatrixPair, ModelError, Nominal,
    Uncertain,
};
pub use together::Together;
