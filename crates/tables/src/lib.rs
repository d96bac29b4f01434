//! The paper's Tables 1–6, its values beside what the program makes of fixtures inferred from them.
//!
//! The paper prints no dimensions. Those of four integral examples were inferred from its SIM cells, so that
//! agreement there is a fit and no prediction; [`Inference`] says how many numbers were taken from how many
//! cells. What is a test: the cells that the inference does not reach, the finite-element cells, and what the
//! exact relation makes of the same FRFs.
//!
//! * [`paper`]: the printed values, with their units;
//! * [`examples`]: fixtures with their bands and inferences;
//! * [`ProgramRow`]: SIM and FEM averages of an example by eq (7) and by the exact relation;
//! * [`Witness`]: a fixture whose eq (7) gives a printed row, on a side of its poles where it can;
//! * [`Tables`]: all of it as text or JSON.
//!
//! ```
//! use jointscope_tables::{ProgramRow, examples};
//!
//! let d0 = examples()?.remove(0);
//! let row = ProgramRow::of(d0, None)?;
//! // Table 5: 1.5 N·s/m goes in and eq (7) returns 2.4; the exact relation returns what went in.
//! assert!((row.input[0] - 1.5).abs() < 0.05);
//! assert!((row.sim.paper.damping.at(0, 0) - 2.4).abs() < 0.05);
//! assert!((row.sim.exact.stiffness.at(0, 0) / row.stiffness.at(0, 0) - 1.0).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod cells;
mod example;
mod measured;
pub mod paper;
mod reach;
mod tables;
mod text;

pub use cells::{Extracted, ProgramRow};
pub use example::{Example, Inference, examples};
pub use measured::{Measured, MeasuredError};
pub use reach::Witness;
pub(crate) use reach::{Reach, Side};
pub use tables::Tables;

/// Why a table cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TablesError {
    /// A shipped fixture is none.
    #[error(transparent)]
    Fixture(#[from] jointscope_fixture::FixtureError),
    /// The lumped model failed.
    #[error(transparent)]
    Lumped(#[from] jointscope_lumped::LumpedError),
    /// The finite-element twin failed.
    #[error(transparent)]
    Fem(#[from] jointscope_fem::FemError),
    /// The decomposition failed.
    #[error(transparent)]
    Decomposition(#[from] jointscope_decomposition::DecompositionError),
    /// FRFs that are none.
    #[error(transparent)]
    Spectra(#[from] jointscope_spectra::SpectraError),
}
