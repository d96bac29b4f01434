//! A first fixture from what a ruler and a drawing say.
//!
//! A [`Draft`] is a [`Structure`] (two blocks and a strip, storeys on columns, a beam) of [`Bar`]s with
//! dimensions and [`Material`]s, the ruler's tolerance, and the points of a recording where there is one,
//! with their places where its geometry tells them. [`Draft::fixture`] makes the fixture: masses, inertias
//! and sections from the closed forms, their standard deviations from those of dimensions and material,
//! points where sensors and hammer usually go, and notes on what to measure and fill in.
//!
//! One order everywhere, as a ruler is laid on: LENGTH along x, WIDTH across, HEIGHT along y, the direction
//! that is struck and measured.
//!
//! ```
//! use jointscope_draft::{Bar, Draft, Structure};
//!
//! let (block, strip): (Bar, Bar) = ("50x50x80:steel".parse()?, "60x40x6:steel".parse()?);
//! let fixture = Draft::new(Structure::Blocks { blocks: [block.clone(), block], strip }).fixture()?;
//! assert_eq!(fixture.points().len(), 4);
//! assert!((fixture.quantities()[0].value - 7850.0 * 0.05 * 0.05 * 0.08).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bar;
mod beam;
mod blocks;
mod draft;
mod error;
mod frame;
mod material;
mod points;
mod unknown;
mod value;

pub use bar::{Bar, BarError};
pub use draft::{Draft, Structure};
pub use error::DraftError;
pub use material::{Material, MaterialError};

use jointscope_fixture::Fixture;

impl Draft {
    /// The fixture.
    ///
    /// # Errors
    /// See [`DraftError`].
    pub fn fixture(&self) -> Result<Fixture, DraftError> {
        let file = match &self.structure {
            Structure::Blocks { blocks, strip } => blocks::file(self, blocks, strip)?,
            Structure::Frame { .. } if !self.placed.is_empty() => return Err(DraftError::Frame),
            Structure::Frame { storeys, mass, column, columns } => {
                frame::file(self, *storeys, *mass, column, *columns)?
            }
            Structure::Beam { bar, clamped } => beam::file(self, bar, *clamped)?,
            Structure::Unknown => unknown::file(self)?,
        };
        Ok(Fixture::from_value(&file)?)
    }
}
