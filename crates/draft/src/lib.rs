//! A first fixture from what a ruler and a drawing say.
//!
//! A [`Draft`] is a [`Structure`] (two blocks and a strip, storeys on columns, a beam) of [`Bar`]s with dimensions and [`Material`]s, the ruler's tolerance, and the points of a recording where there
//! is one, with their places where its geometry tells them. [`Draft::fixture`] makes the fixture: masses, inertias and sections from the closed forms, their standard deviations from those of dimensions and material, points
//! where sensors and hammer usually go, and notes on what to measure and fill in.
//!
//! One order everywhere, as a ruler is laid on: LENGTH along x, WIDTH across, HEIGHT along y, the direction that is struck and measured.
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
mod frame;
mod material;
mod points;
mod unknown;
mod value;

pub use bar::{Bar, BarError};
pub use material::{Material, MaterialError};

use jointscope_fixture::{Fixture, FixtureError};

/// What is built.
#[derive(Debug, Clone, PartialEq)]
pub enum Structure {
    /// Two rigid blocks with a strip between their faces, hanging freely; the strip is the joint.
    Blocks {
        /// The left block and the right one.
        blocks: [Bar; 2],
        /// The strip between them.
        strip: Bar,
    },
    /// Storeys that only move sideways, on columns that bend, from a fixed ground.
    Frame {
        /// Number of storeys.
        storeys: usize,
        /// Mass of each, kg.
        mass: f64,
        /// One column of one storey; its LENGTH is the storey's height, its HEIGHT the side along which the storeys move.
        column: Bar,
        /// Columns of each storey.
        columns: usize,
    },
    /// A beam that bends, free or clamped at its left end.
    Beam {
        /// The beam.
        bar: Bar,
        /// Whether its left end is clamped.
        clamped: bool,
    },
    /// Nobody has said yet: one body that holds all points, its numbers to be filled in.
    Unknown,
}

/// A fixture to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct Draft {
    /// What is built.
    pub structure: Structure,
    /// One standard deviation of a dimension, m.
    pub ruler: f64,
    /// Names of points that a recording has; their places are placeholders. Empty: points where sensors and hammer usually go.
    pub points: Vec<String>,
    /// Points whose places are known, by name and abscissa in m, as the recording's geometry has them.
    pub placed: Vec<(String, f64)>,
    /// The abscissa of the fixture's x = 0 in the recording's geometry, m; the points are centred on the structure where it is not stated and they do not lie on it as they are.
    pub origin: Option<f64>,
}

/// Why there is no fixture.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DraftError {
    /// The strip does not fit between the blocks.
    #[error(
        "the strip is {strip:.1} mm {side} and block {block} only {face:.1} mm: it does not fit on the block's face; dimensions are LENGTHxWIDTHxHEIGHT, HEIGHT along the motion"
    )]
    Strip {
        /// `wide` or `high`.
        side: &'static str,
        /// mm.
        strip: f64,
        /// `A` or `B`.
        block: &'static str,
        /// mm.
        face: f64,
    },
    /// A frame without storeys or columns, or with more than anyone builds.
    #[error(
        "a frame of {storeys} storeys on {columns} columns each cannot be drafted: from 1 to 100 storeys on at least one column can"
    )]
    Storeys {
        /// Storeys.
        storeys: usize,
        /// Columns.
        columns: usize,
    },
    /// Points that reach farther than the structure.
    #[error(
        "the recording's points reach over {points:.1} mm and the structure only over {structure:.1} mm: check dimensions, axis (`--axis`) and unit of the geometry (`--length-unit`)"
    )]
    Span {
        /// mm.
        points: f64,
        /// mm.
        structure: f64,
    },
    /// Points off the structure.
    #[error(
        "point {point} would lie at x = {x:.1} mm, off the structure, which reaches from {from:.1} to {to:.1} mm: check the origin, the abscissa in the geometry where the fixture's x = 0 is"
    )]
    Off {
        /// Its name.
        point: String,
        /// mm.
        x: f64,
        /// mm.
        from: f64,
        /// mm.
        to: f64,
    },
    /// Storeys have no places along one axis of motion.
    #[error("the storeys of a frame have no places along x: take the nodes' names alone, `--points-from`")]
    Frame,
    /// Nothing to draft from.
    #[error("there is neither a structure nor a point whose place is known")]
    Nothing,
    /// A mass that is none.
    #[error("a storey of {0} kg is impossible: its mass must be above zero")]
    Mass(f64),
    /// The fixture that results is impossible.
    #[error("what was drafted is no possible fixture: {0}")]
    Fixture(#[from] FixtureError),
}

/// One standard deviation of a dimension taken with a ruler or calliper, m.
const RULER: f64 = 1e-4;

impl Draft {
    /// A structure measured to 0.1 mm, with points where sensors and hammer usually go.
    pub fn new(structure: Structure) -> Self {
        Draft { structure, ruler: RULER, points: Vec::new(), placed: Vec::new(), origin: None }
    }

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
