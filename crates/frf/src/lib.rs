//! FRFs of a rigid block's motion, displacement and rotation, from accelerometers and hammer hits
//! that only know translation (eq 19–23), and the noise that comes with them.
//!
//! * [`fit_rigid_motion`]: the 2×2 matrix of one block's motion per load on another by weighted least squares
//!   from any number of sensors and hammer points, with its covariance and the residual that says whether the
//!   blocks moved rigidly; of two and two it is the paper's two-accelerometer method;
//! * [`noise`]: variances of FRFs from coherence and averages, or from the FRFs alone;
//! * [`KnownNoise`]: FRFs with these, the lines of long recordings merged where the FRFs are smooth;
//! * [`Drift`]: resonances that moved between one FRF and the next.
//!
//! ```
//! use jointscope_frf::{BlockChannel, BlockLayout, fit_rigid_motion};
//! use jointscope_spectra::{Dof, FrfForm, FrfPair, FrfSet, SpectralLines};
//! use num_complex::Complex64;
//!
//! // A block that moves by 3 m/N and turns by 2 rad/N, read at 4 and 0.05 m left of it at 3, hit at 1 and 0.06 m right of it at 2.
//! let (y4, y3) = (Complex64::new(3.0, 0.0), Complex64::new(2.9, 0.0));
//! let pairs = [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")].map(|(to, from)| FrfPair::transverse(to, from));
//! let frfs = FrfSet::new(SpectralLines::new(vec![100.0])?, FrfForm::Receptance, pairs.to_vec(), vec![y4, y3, y4, y3])?;
//! let at = |offset| BlockChannel { offset, dof: Dof::Translation };
//! let channels = vec![(0, at(0.0), at(0.0)), (1, at(-0.05), at(0.0)), (2, at(0.0), at(0.06)), (3, at(-0.05), at(0.06))];
//! let h41 = fit_rigid_motion(&frfs, &BlockLayout { channels, rotate: [true, true] })?.values[0];
//! assert!((h41.at(1, 0).re - 2.0).abs() < 1e-12);
//! assert!(h41.at(0, 1).norm() < 1e-12, "the same response to both hits: a moment does nothing");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod breaks;
mod drift;
mod local_rational;
mod merged;
pub mod noise;
mod rigid_motion;

pub use breaks::{breaks, lone_lines};
pub use drift::{Drift, resonant_lines};
pub use merged::KnownNoise;
pub use rigid_motion::{BlockChannel, BlockFrf, BlockLayout, MaskReason, RigidMotionError, fit_rigid_motion};
