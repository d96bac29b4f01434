//! A structure that is to be drafted, and how well it was measured.

use crate::Bar;

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
        /// One column of one storey; its LENGTH is the storey's height, its HEIGHT the side along which the
        /// storeys move.
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
    /// Names of points that a recording has; their places are placeholders. Empty: points where sensors and
    /// hammer usually go.
    pub points: Vec<String>,
    /// Points whose places are known, by name and abscissa in m, as the recording's geometry has them.
    pub placed: Vec<(String, f64)>,
    /// The abscissa of the fixture's x = 0 in the recording's geometry, m; the points are centred on the
    /// structure where it is not stated and they do not lie on it as they are.
    pub origin: Option<f64>,
}

/// One standard deviation of a dimension taken with a ruler or calliper, m.
const RULER: f64 = 1e-4;

impl Draft {
    /// A structure measured to 0.1 mm, with points where sensors and hammer usually go.
    pub fn new(structure: Structure) -> Self {
        Draft { structure, ruler: RULER, points: Vec::new(), placed: Vec::new(), origin: None }
    }
}
