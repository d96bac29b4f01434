//! The structure's geometry: where nodes are, in which axes, and what connects them (datasets 15, 2411, 18,
//! 2420, 2412, 82).
//!
//! | dataset | records |
//! |---|---|
//! | 15, nodes | `4I10,3E13.5`: label, definition system, displacement system, colour, three coordinates *in the definition system* |
//! | 2411, nodes | `4I10`: label, export system, displacement system, colour; `3D25.16`: three coordinates *in the part's system*, which is the global one |
//! | 18, coordinate systems | `5I10`: label, type, reference system, colour, method 1; name; `6E13.5`: origin, a point on +x, a point of the +xz plane, in the reference system |
//! | 2420, coordinate systems | part number; part name; a system each: `3I10` label, type, colour; name; `3D25.16` four times: three axes, origin |
//! | 2412, elements | `6I10`: label, descriptor, two property tables, colour, number of nodes; for beams (11, 21 to 24) three more numbers; nodes `8I10` |
//! | 82, trace lines | `3I10`: number, number of nodes, colour; name; nodes `8I10`, 0 lifts the pen |
//!
//! Layouts as the University of Cincinnati's Structural Dynamics Research Laboratory publishes them. A matrix
//! of 2420 is that of row vectors, x_global = x_local·R + t: row i is the local axis i in global coordinates,
//! row 4 the origin.

use crate::Units;

/// The nodes of one dataset 15 or 2411.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Nodes {
    /// In file order.
    pub nodes: Vec<GridPoint>,
    /// Units in force, if the file states any.
    pub units: Option<Units>,
}

/// A node of the geometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridPoint {
    /// Node number.
    pub label: i64,
    /// System in which the coordinates are given; 0 is the global one.
    pub definition_system: i64,
    /// System in which directions 1 to 6 of this node are meant; 0 is the global one.
    pub displacement_system: i64,
    /// Coordinates in the definition system, in the file's unit of length.
    pub coordinates: [f64; 3],
}

/// How a coordinate system counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SystemKind {
    /// x, y, z.
    Cartesian,
    /// r, θ, z.
    Cylindrical,
    /// r, θ, φ.
    Spherical,
}

/// A local coordinate system (datasets 18 and 2420).
#[derive(Debug, Clone, PartialEq)]
pub struct CoordinateSystem {
    /// Its number.
    pub label: i64,
    /// Its name.
    pub name: String,
    /// How it counts.
    pub kind: SystemKind,
    /// The system in which axes and origin are given; 0 is the global one.
    pub reference: i64,
    /// Its axes: rows of unit length.
    pub axes: [[f64; 3]; 3],
    /// Its origin, in the file's unit of length.
    pub origin: [f64; 3],
}

/// A finite element (dataset 2412).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Element {
    /// Its number.
    pub label: i64,
    /// What it is: 11 rod, 21 linear beam, 44 plane stress quadrilateral, 111 solid tetrahedron, …
    pub descriptor: i64,
    /// Its nodes.
    pub nodes: Vec<i64>,
}

/// A line drawn from node to node (dataset 82).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TraceLine {
    /// Its number.
    pub number: i64,
    /// Its name.
    pub name: String,
    /// The nodes it runs through; 0 lifts the pen.
    pub nodes: Vec<i64>,
}

/// Who wrote the file, and of what model (dataset 151).
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Header {
    /// Name of the model file.
    pub model: String,
    /// Its description.
    pub description: String,
    /// The program that made the model.
    pub made_by: String,
    /// The program that wrote this file.
    pub written_by: String,
    /// When, as the file says it.
    pub written: String,
}
