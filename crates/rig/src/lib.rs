//! A simulated vibration laboratory: recordings of assemblies whose hidden physics is known.
//!
//! Whoever judges a diagnosis needs recordings of which the truth is known, made by a route of its own. This
//! crate builds the *physical* structure (masses, meshed beams, springs, dashpots, extra coordinates), solves
//! it whole at every spectral line and measures it with a noisy hammer. It shares no code with the crates
//! that identify and diagnose.
//!
//! | theme | items |
//! |---|---|
//! | the structure | [`Structure`], built of an [`Assembly`] of elements on [`Station`]s, or from a fixture with its `physics` |
//! | what channels read | [`frfs`], [`read`], [`Instrument`] |
//! | hammer hits and noise | [`HammerSetup`] |
//! | hits over time on joints that depend on amplitude | [`StrikeTest`], [`random_law`] |
//! | stepped sines at several levels on such joints | [`SteppedSines`] |
//! | random assemblies | [`Family`], [`drawn_within_tolerance`], [`random_effect`], [`random_rotational_support`], [`extent`] |
//! | physics without a name in fixture files | [`Outside`] |
//! | structures a little wrong in every mode | [`ModalErrors`] |
//! | a worked case | [`glued_joint`]: two steel blocks and a glued strip |
//! | files | [`universal_file`]: FRFs with coherence as UFF |
//!
//! ```
//! use jointscope_fixture::Fixture;
//! use jointscope_rig::{Instrument, frfs};
//! use jointscope_spectra::{FrfPair, SpectralLines};
//!
//! let fixture = Fixture::from_json(r#"{
//!   "bodies": { "A": { "mass": 2.0, "rotates": false }, "B": { "mass": 3.0, "rotates": false } },
//!   "points": { "1": { "body": "A", "x": 0.0 }, "2": { "body": "B", "x": 0.1 } },
//!   "joints": { "J": { "from": "1", "to": "2", "stiffness": [[5e6, 0.0], [0.0, 0.0]] } },
//!   "physics": [ { "kind": "added_mass", "place": "B", "x": 0.1, "mass": 1.0 } ]
//! }"#)?;
//! let lines = SpectralLines::new(vec![1.0])?;
//! let set = frfs(&fixture, &[FrfPair::transverse("2", "1")], &lines, Instrument::Perfect)?;
//! // Far below the resonance the free assembly moves as one mass of 6 kg.
//! assert!((set.values(0)[0].re - 1.0 / 6.0).abs() < 1e-5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod channels;
mod effects;
mod error;
mod families;
pub mod glued_joint;
mod hits;
mod modal_errors;
mod outside;
mod physical;
mod random;
mod random_effect;
mod stepped_sines;
mod strikes;
mod tolerance;
pub mod universal_file;

pub use channels::{Instrument, frfs, read};
pub use error::{HammerError, StructureError};
pub use families::Family;
pub use hits::{HammerSetup, smoothed_variance};
pub use modal_errors::{ModalErrors, UsualErrors};
pub use outside::Outside;
pub use physical::{Assembly, BeamElement, Law, Row, Station, Structure};
pub use random::generator;
pub use random_effect::{extent, random_effect, random_rotational_support};
pub use stepped_sines::{Control, SteppedSines};
pub use strikes::{StrikeTest, random_law, reach};
pub use tolerance::drawn_within_tolerance;
