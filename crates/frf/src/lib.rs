//! FRFs of a rigid block's motion, displacement and rotation, from accelerometers and hammer hits
//! that only know translation (eq 19–23), and the noise that comes with them.
//!
//! * [`rotation_from_two`], [`per_moment_from_two`], [`from_four_frfs`]: the paper's two-accelerometer method, exactly determined;
//! * [`fit_rigid_motion`]: the same 2×2 matrix by weighted least squares from any number of sensors on one
//!   block and hammer points on the other, with its covariance and the residual that says whether the blocks
//!   moved rigidly;
//! * [`noise`]: variances of FRFs from coherence and averages, or from the FRFs alone;
//! * [`KnownNoise`]: FRFs with these, the lines of long recordings merged where the FRFs are smooth;
//! * [`Drift`]: resonances that moved between one FRF and the next.
//!
//! ```
//! use jointscope_frf::from_four_frfs;
//! use num_complex::Complex64;
//!
//! // A block that translates by 3 and turns by 2 rad/N, read at 4 and 0.05 m left of it at 3.
//! let (y4, y3) = (Complex64::new(3.0, 0.0), Complex64::new(2.9, 0.0));
//! let h41 = from_four_frfs([y4, y3], [y4, y3], 0.05, 0.06);
//! assert!((h41.at(1, 0).re - 2.0).abs() < 1e-12);
//! assert!(h41.at(0, 1).norm() < 1e-12, "the same response to both hits: a moment does nothing");
//! ```

mod breaks;
mod drift;
mod local_rational;
mod merged;
pub mod noise;
mod rigid_motion;
mod two_accelerometers;

pub use breaks::breaks;
pub use drift::{Drift, resonant_lines};
pub use merged::KnownNoise;
pub use rigid_motion::{BlockChannel, BlockFrf, BlockLayout, MaskReason, RigidMotionError, fit_rigid_motion};
pub use two_accelerometers::{from_four_frfs, per_moment_from_two, rotation_from_two};
