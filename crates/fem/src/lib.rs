//! The finite-element twin of a fixture: the assembly as a deformable solid, its modes, and the FRFs of its
//! points.
//!
//! The lumped model knows rigid blocks and a massless beam. The twin is built of what the fixture file says
//! under `geometry`: boxes for bodies, strips for joints, layers of weld or glue between them, meshed with
//! 20-node bricks whose quadratic shape functions bend without locking. What it shows beyond the lumped model
//! is what that leaves out: the joint's mass and shear, plate action across its width, the blocks' own
//! flexibility and that of the strip's footing in them.
//!
//! * [`Mesh`]: bricks graded away from the strips, over half the depth (the assembly is symmetric) or the
//!   whole;
//! * [`Matrices`]: mass and stiffness over the free equations, and the motions that strain nothing;
//! * [`Twin`]: the lowest modes by shift-invert Lanczos, rigid motions held at exactly zero;
//! * [`Twin::frfs`]: mode superposition with the fixture's damping and a chosen number of modes
//!   ([`Superposition`]), supports and point masses;
//! * [`Twin::deflections`]: what forces in equilibrium do to it statically;
//! * [`calculix_deck`]: the mesh for somebody else's program.
//!
//! ```
//! use jointscope_fem::{MeshOptions, ModeRange, Twin};
//! use jointscope_fixture::Fixture;
//!
//! let fixture = Fixture::from_json(include_str!("../../../fixtures/paper/D0.json"))?;
//! let coarse = MeshOptions { corner: 2, along: 6, across: 1, growth: 3.0, ..MeshOptions::default() };
//! let twin = Twin::of(&fixture, &coarse, ModeRange { at_least: 2, up_to: 600.0 }, |_| {})?;
//! let hz = twin.frequencies();
//! // Two blocks on a strip: the blocks against each other, then their rotations against it; the lumped model says 68.5 and 396.9 Hz.
//! assert!((hz[0] - 68.5).abs() < 3.0 && (hz[1] - 396.9).abs() < 15.0, "{hz:?}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod assembly;
mod brick;
mod deck;
mod grading;
mod mesh;
mod omissions;
mod superposition;
mod twin;

pub use assembly::Matrices;
pub use brick::Elasticity;
pub use deck::calculix_deck;
pub use mesh::{Brick, BrickOwner, Mesh};
pub use omissions::Omissions;
pub use superposition::Superposition;
pub use twin::{ModeKind, ModeRange, Progress, Twin};

/// How fine the mesh is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshOptions {
    /// Elements along the edges where a strip meets its blocks are its thickness over this: there the stress
    /// is singular.
    pub corner: usize,
    /// A strip's elements are no longer than its length over this.
    pub along: usize,
    /// Elements across half a strip's width.
    pub across: usize,
    /// Factor by which elements grow from one to the next, away from the strips' ends.
    pub growth: f64,
    /// Mesh the whole depth and not its half: torsion and sideways modes come in.
    pub whole: bool,
    /// What is switched off, to see what it does.
    pub without: Omissions,
}

impl Default for MeshOptions {
    /// Frequencies within 0.5 % of the converged ones; see docs/guide/solid.md.
    fn default() -> Self {
        MeshOptions {
            corner: 16,
            along: 16,
            across: 3,
            growth: 2.0,
            whole: false,
            without: Omissions::default(),
        }
    }
}

impl MeshOptions {
    fn check(&self) -> Result<(), FemError> {
        let counts = [self.corner, self.along, self.across];
        if counts.iter().any(|count| *count == 0 || *count > 200)
            || !(self.growth >= 1.0 && self.growth <= 10.0)
        {
            return Err(FemError::Options);
        }
        Ok(())
    }
}

/// Why there is no finite-element twin.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FemError {
    /// The fixture has no geometry.
    #[error("the fixture has no `geometry`: state the boxes of its bodies and the strips of its joints")]
    NoGeometry,
    /// An effect of the fixture has no place in the solid.
    #[error(
        "physics/{index}: `{kind}` is no part of the finite-element twin, which is made of `geometry` alone; leave `physics` out"
    )]
    Effect {
        /// Position in the fixture's `physics`.
        index: usize,
        /// The effect's name.
        kind: &'static str,
    },
    /// Options out of range.
    #[error(
        "the mesh needs 1 to 200 elements a thickness, along and across the strip, and a growth of 1 to 10"
    )]
    Options,
    /// Too many elements.
    #[error("the mesh would have {elements} cells; take fewer elements or a larger growth")]
    TooFine {
        /// Cells of the grid.
        elements: usize,
    },
    /// A material that is none.
    #[error(
        "geometry/materials/{name}: sound would travel at {speed:.1e} m/s in it, and no solid carries it above some 20 km/s: check Young's modulus in Pa and density in kg/m^3"
    )]
    Material {
        /// Its name.
        name: String,
        /// √(E/ρ), m/s.
        speed: f64,
    },
    /// An element is too distorted.
    #[error("element {element} of the mesh is degenerate: check the dimensions in `geometry`")]
    Degenerate {
        /// Its index.
        element: usize,
    },
    /// The matrices or their modes failed.
    #[error("the modes of the mesh cannot be computed: {0}")]
    Sparse(#[from] jointscope_linalg::SparseError),
    /// An FRF names a point that the fixture does not have.
    #[error("FRF {frf}: the fixture has no point `{point}` (it has {known})")]
    UnknownPoint {
        /// The FRF asked for.
        frf: String,
        /// The missing point.
        point: String,
        /// The points there are.
        known: String,
    },
    /// A superposition of modes that end below the last line.
    #[error(
        "modes are known up to {} Hz and the last line is {} Hz: find more modes",
        jointscope_spectra::in_text(*modes),
        jointscope_spectra::in_text(*last)
    )]
    ModesEndBelow {
        /// Frequency up to which modes are known, Hz.
        modes: f64,
        /// The last line, Hz.
        last: f64,
    },
    /// An undamped resonance lies on a line.
    #[error(
        "the response is unbounded at {} Hz: the model has an undamped resonance on that line; state some damping or move the line",
        jointscope_spectra::in_text(*frequency)
    )]
    Unbounded {
        /// The line, Hz.
        frequency: f64,
    },
    /// The resulting FRFs are not a valid set.
    #[error(transparent)]
    Spectra(#[from] jointscope_spectra::SpectraError),
}
