//! What the benchmarks of this workspace work on, and how they compare versions of the same work.
//!
//! * [`cases`]: fixtures, lines, compliances and recordings, made the same in every run;
//! * [`compare`]: versions timed in turns within one run, so that their ratios mean something on a busy
//!   machine;
//! * `benches/decomposition.rs`, `synthesis.rs`, `chain.rs`: criterion benchmarks, one file for each kind of
//!   work;
//! * `benches/summary.rs`: one table with the time a line of each version, and ours beside the floor and the
//!   rivals.
//!
//! The floor of a piece of work is the time to read its inputs and write its outputs, bytes for bytes, with
//! one addition for each value read: no version can be faster by more than the additions cost.
//!
//! ```
//! use jointscope_benches::{cases, compare};
//!
//! let chain = cases::chain(3, cases::Attachments::None);
//! assert_eq!(chain.bodies().len(), 3);
//! let mut sum = 0.0;
//! let times = compare(5, 0.001, &mut [&mut || sum += 1.0]);
//! assert!(times[0].seconds >= 0.0 && sum > 0.0);
//! ```

pub mod cases;
mod timing;

pub use timing::{Timing, compare, ratio};
