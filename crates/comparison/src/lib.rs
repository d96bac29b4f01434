//! Decompositions of several joints side by side, and which of them is the stiffer (Table 4), with the probability that the order is right.
//!
//! The paper arranges joints by the averages of each element of K and says nothing of how sure the order is. Here every
//! element has a standard deviation, and an order has a probability: [`Ranking`].
//!
//! * [`Decomposed`]: what `stiffness.json` says of one joint;
//! * [`Comparison`]: several of them, by one relation and one estimate, ranked element by element;
//! * [`comparison_file`]: the contents of `comparison.json`.
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

mod comparison;
mod decomposed;
mod file;
mod ranking;

pub use comparison::{Compared, Comparison, ComparisonError, ELEMENTS, ElementRanking, Kind};
pub use decomposed::{
    Decomposed, DecomposedError, End, Ends, Estimate, FittedJoint, JointMass, JointTests, Judged, Line,
    Matrix,
};
pub use file::comparison_file;
pub use ranking::Ranking;
