//! Why there is no fixture.

use jointscope_fixture::FixtureError;

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
