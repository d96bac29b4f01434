//! Nodes of the files' geometry in global axes and metres, and as points of a fixture along one of them.
//!
//! Coordinates of a dataset 15 are meant in the node's definition system, those of a 2411 in the global one;
//! directions 1 to 3 of a node are the axes of its displacement system. Systems may stand in one another
//! (dataset 18).

use std::collections::BTreeMap;

use jointscope_uff::{CoordinateSystem, GridPoint, SystemKind};
use serde::Serialize;

use crate::Source;
use crate::unit::{Dimension, Unit};

/// An axis of the global coordinate system.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum SpatialAxis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

impl SpatialAxis {
    /// Reads `x`, `y` or `z`.
    pub fn parse(text: &str) -> Option<Self> {
        match text.trim().to_lowercase().as_str() {
            "x" => Some(SpatialAxis::X),
            "y" => Some(SpatialAxis::Y),
            "z" => Some(SpatialAxis::Z),
            _ => None,
        }
    }

    fn index(self) -> usize {
        self as usize
    }
}

/// Why the nodes of files are no points in space.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// No nodes at all.
    #[error("{0}: there are no nodes (datasets 15 and 2411); export the geometry with the recording")]
    NoNodes(String),
    /// Coordinates in a unit that is not stated.
    #[error(
        "{0}: the file does not state the unit of its coordinates (dataset 164); say it, such as `mm`, or export the geometry with its units"
    )]
    NoUnit(String),
    /// A unit that is no length.
    #[error("`{0}` is no unit of length, such as `m` or `mm`")]
    NotALength(String),
    /// One label at two places.
    #[error("{file}: node {node} has two places; export the geometry once")]
    Twice {
        /// The file.
        file: String,
        /// The node.
        node: i64,
    },
    /// A coordinate system that the file does not have.
    #[error(
        "{file}: node {node} is given in the coordinate system {system}, which the file does not have (datasets 18 and 2420); export the systems with the nodes"
    )]
    NoSystem {
        /// The file.
        file: String,
        /// The node.
        node: i64,
        /// The system.
        system: i64,
    },
    /// Coordinates in circles.
    #[error(
        "{file}: node {node} is given in the cylindrical or spherical coordinate system {system}; export the nodes in a Cartesian one"
    )]
    Curvilinear {
        /// The file.
        file: String,
        /// The node.
        node: i64,
        /// The system.
        system: i64,
    },
    /// Systems that stand in each other in a circle.
    #[error("{file}: the coordinate system {system} is defined by itself; export the geometry again")]
    Circle {
        /// The file.
        file: String,
        /// The system.
        system: i64,
    },
}

/// A node in global axes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PlacedNode {
    /// Its number.
    pub node: i64,
    /// Where it is, in m.
    pub position: [f64; 3],
    /// What its directions 1, 2 and 3 are: unit vectors in global axes. Where the displacement system is not
    /// in the file, or runs in circles, nothing.
    pub directions: Option<[[f64; 3]; 3]>,
}

/// A node as a point of a fixture.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PointAlong {
    /// Its number.
    pub node: i64,
    /// Its abscissa along the chosen axis, in m.
    pub x: f64,
    /// How far it is off the straight line through the nodes' centre along that axis, in m: a planar model
    /// knows nothing of it.
    pub off_line: f64,
}

/// The nodes of all files.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Geometry {
    /// In the order of their numbers.
    pub nodes: Vec<PlacedNode>,
}

impl Geometry {
    /// Places the nodes of all files. `length_unit`, such as `mm`, holds for files that state no unit system.
    ///
    /// # Errors
    /// A [`GeometryError`] that names the file and the node.
    pub fn of(sources: &[Source], length_unit: Option<&str>) -> Result<Self, GeometryError> {
        let assumed = length_unit.map(metres).transpose()?;
        let mut placed: BTreeMap<i64, PlacedNode> = BTreeMap::new();
        for source in sources {
            let systems: BTreeMap<i64, &CoordinateSystem> =
                source.file.systems.iter().map(|system| (system.label, system)).collect();
            let frames = Frames { file: &source.name, systems };
            for set in &source.file.nodes {
                let unit = set.units.as_ref().map(|units| 1.0 / units.length_factor).or(assumed);
                let unit = unit.ok_or_else(|| GeometryError::NoUnit(source.name.clone()))?;
                for node in &set.nodes {
                    let found = frames.place(node, unit)?;
                    let known = placed.entry(node.label).or_insert(found);
                    let apart =
                        known.position.iter().zip(found.position).any(|(a, b)| (a - b).abs() > SAME_PLACE);
                    if apart {
                        return Err(GeometryError::Twice { file: source.name.clone(), node: node.label });
                    }
                }
            }
        }
        if placed.is_empty() {
            let files = sources.iter().map(|source| source.name.as_str()).collect::<Vec<_>>().join(", ");
            return Err(GeometryError::NoNodes(files));
        }
        Ok(Geometry { nodes: placed.into_values().collect() })
    }

    /// The node of a number.
    pub fn node(&self, number: i64) -> Option<&PlacedNode> {
        let at = self.nodes.binary_search_by_key(&number, |node| node.node).ok()?;
        self.nodes.get(at)
    }

    /// The nodes as points along an axis, in the order of their abscissae (of equal ones, of their numbers).
    pub fn points_along(&self, axis: SpatialAxis) -> Vec<PointAlong> {
        let along = axis.index();
        let count = self.nodes.len().max(1) as f64;
        let centre: [f64; 3] =
            std::array::from_fn(|i| self.nodes.iter().map(|node| node.position[i]).sum::<f64>() / count);
        let off = |position: [f64; 3]| {
            let across = (0..3).filter(|i| *i != along).map(|i| (position[i] - centre[i]).powi(2));
            across.sum::<f64>().sqrt()
        };
        let point = |node: &PlacedNode| PointAlong {
            node: node.node,
            x: node.position[along],
            off_line: off(node.position),
        };
        let mut points: Vec<PointAlong> = self.nodes.iter().map(point).collect();
        points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.node.cmp(&b.node)));
        points
    }

    /// How far the nodes reach along x, y and z, in m.
    pub(crate) fn extent(&self) -> [[f64; 2]; 3] {
        std::array::from_fn(|axis| {
            let values = || self.nodes.iter().map(|node| node.position[axis]);
            [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
        })
    }

    /// The axis along which the nodes reach farthest; of equal ones the first.
    pub fn longest_axis(&self) -> SpatialAxis {
        let all = self.extent();
        let extent = |axis: &SpatialAxis| all[axis.index()][1] - all[axis.index()][0];
        let mut best = SpatialAxis::X;
        for axis in [SpatialAxis::Y, SpatialAxis::Z] {
            if extent(&axis) > extent(&best) {
                best = axis;
            }
        }
        best
    }
}

/// Places that are one place, m.
const SAME_PLACE: f64 = 1e-6;

fn metres(unit: &str) -> Result<f64, GeometryError> {
    Unit::parse(unit)
        .filter(|parsed| parsed.dimension == Dimension::motion(0, false))
        .map(|parsed| parsed.si)
        .ok_or_else(|| GeometryError::NotALength(unit.to_owned()))
}

/// Axes in rows and an origin: x_global = x_local·axes + origin.
#[derive(Debug, Clone, Copy)]
struct Frame {
    axes: [[f64; 3]; 3],
    origin: [f64; 3],
}

const GLOBAL: Frame = Frame { axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], origin: [0.0; 3] };

impl Frame {
    fn turn(&self, local: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|k| local[k] * self.axes[k][i]).sum())
    }

    fn place(&self, local: [f64; 3]) -> [f64; 3] {
        let turned = self.turn(local);
        std::array::from_fn(|i| turned[i] + self.origin[i])
    }
}

struct Frames<'a> {
    file: &'a str,
    systems: BTreeMap<i64, &'a CoordinateSystem>,
}

impl Frames<'_> {
    fn place(&self, node: &GridPoint, unit: f64) -> Result<PlacedNode, GeometryError> {
        let file = || self.file.to_owned();
        let definition = node.definition_system;
        let frame = match self.systems.get(&definition) {
            _ if definition == 0 => GLOBAL,
            None => {
                return Err(GeometryError::NoSystem { file: file(), node: node.label, system: definition });
            }
            Some(system) if system.kind != SystemKind::Cartesian => {
                return Err(GeometryError::Curvilinear {
                    file: file(),
                    node: node.label,
                    system: definition,
                });
            }
            Some(system) => self.frame(system)?,
        };
        let directions = match self.systems.get(&node.displacement_system) {
            _ if node.displacement_system == 0 => Some(GLOBAL.axes),
            Some(system) if system.kind == SystemKind::Cartesian => Some(self.frame(system)?.axes),
            _ => None,
        };
        Ok(PlacedNode {
            node: node.label,
            position: frame.place(node.coordinates).map(|x| x * unit),
            directions,
        })
    }

    /// A system in global axes, through those that it stands in.
    fn frame(&self, system: &CoordinateSystem) -> Result<Frame, GeometryError> {
        let mut frame = Frame { axes: system.axes, origin: system.origin };
        let mut reference = system.reference;
        // Each system at most once on the way out.
        for _ in 0..=self.systems.len() {
            // A system that is not in the file is the part's own, which is the global one.
            let Some(outer) = self.systems.get(&reference).filter(|_| reference != 0) else {
                return Ok(frame);
            };
            let outer_frame = Frame { axes: outer.axes, origin: outer.origin };
            frame = Frame {
                axes: frame.axes.map(|axis| outer_frame.turn(axis)),
                origin: outer_frame.place(frame.origin),
            };
            reference = outer.reference;
        }
        Err(GeometryError::Circle { file: self.file.to_owned(), system: system.label })
    }
}
