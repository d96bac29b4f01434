//! One function at a nodal degree of freedom: dataset 58 as a typed model.

use std::collections::BTreeMap;

use num_complex::Complex64;

use crate::{
    Abscissa, Axis, CoordinateSystem, Element, FunctionType, Header, NodalData, Nodes, ReadError, TraceLine,
    Units,
};

/// What a universal file holds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct UffFile {
    /// Every function of the file, in file order.
    pub datasets: Vec<Dataset58>,
    /// Who wrote the file (dataset 151), if it says.
    pub header: Option<Header>,
    /// The nodes of each dataset 15 or 2411.
    pub nodes: Vec<Nodes>,
    /// All coordinate systems (datasets 18 and 2420).
    pub systems: Vec<CoordinateSystem>,
    /// All elements (dataset 2412).
    pub elements: Vec<Element>,
    /// All trace lines (dataset 82).
    pub traces: Vec<TraceLine>,
    /// Mode shapes and other data at nodes (datasets 55 and 2414).
    pub nodal: Vec<NodalData>,
    /// Datasets of geometry or shapes that cannot be read, and why.
    pub unreadable: Vec<Unreadable>,
    /// How many datasets of each other number were skipped.
    pub skipped: BTreeMap<u32, usize>,
}

/// A dataset beside the functions that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unreadable {
    /// Its number: 15, 2411, …
    pub number: u32,
    /// Why, with the place.
    pub error: ReadError,
}

/// A function at a nodal degree of freedom (dataset 58 or 58b).
#[derive(Debug, Clone, PartialEq)]
pub struct Dataset58 {
    /// The five ID lines, without blanks around them; at most 80 characters each. A blank line is written as
    /// `NONE`.
    pub id_lines: [String; 5],
    /// What the function is: FRF, coherence, time response, …
    pub function: FunctionType,
    /// Function identification number.
    pub function_id: i64,
    /// Version or sequence number (third field of record 6). In time histories it counts the hits.
    pub sequence_number: i64,
    /// Load case identification number; 0 is single-point excitation.
    pub load_case: i64,
    /// Where and in which direction the response was measured.
    pub response: Node,
    /// Where and in which direction the structure was excited.
    pub reference: Node,
    /// Number of points that the header states, where an ASCII dataset is closed after fewer: those there are
    /// have been read, but which of them are missing nobody knows.
    pub stated_points: Option<usize>,
    /// Where the ordinates sit.
    pub abscissa: Abscissa,
    /// Value on the z-axis; 0 if not used.
    pub z_value: f64,
    /// What the abscissa is.
    pub abscissa_axis: Axis,
    /// What the ordinate, or its numerator, is.
    pub ordinate_axis: Axis,
    /// What the ordinate's denominator is; unused for anything but ratios.
    pub denominator_axis: Axis,
    /// What the z-axis is.
    pub z_axis: Axis,
    /// The ordinates, one a point.
    pub data: Data,
    /// Precision in which the ordinates are stored.
    pub precision: Precision,
    /// Form in which the ordinates are stored.
    pub encoding: Encoding,
    /// Units in force (the last dataset 164 before this one), if the file states any.
    pub units: Option<Units>,
}

impl Dataset58 {
    /// A function of unknown type at no node, stored as 58b in double precision: fill in what is known.
    pub fn new(abscissa: Abscissa, data: Data) -> Self {
        Dataset58 {
            id_lines: std::array::from_fn(|_| "NONE".to_owned()),
            function: FunctionType::General,
            function_id: 0,
            sequence_number: 0,
            load_case: 0,
            response: Node::default(),
            reference: Node::default(),
            stated_points: None,
            abscissa,
            z_value: 0.0,
            abscissa_axis: Axis::default(),
            ordinate_axis: Axis::default(),
            denominator_axis: Axis::default(),
            z_axis: Axis::default(),
            data,
            precision: Precision::Double,
            encoding: Encoding::default(),
            units: None,
        }
    }
}

/// A nodal degree of freedom.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Node {
    /// Entity (component) name, at most 10 characters; `NONE` if not used.
    pub entity: String,
    /// Node number.
    pub number: i64,
    /// Direction: 0 scalar, ±1 to ±3 translation along x, y, z, ±4 to ±6 rotation about them.
    pub direction: i32,
}

impl Default for Node {
    /// No node: number 0, scalar.
    fn default() -> Self {
        Node::new(0, 0)
    }
}

impl Node {
    /// A node of no particular entity.
    pub fn new(number: i64, direction: i32) -> Self {
        Node { entity: "NONE".to_owned(), number, direction }
    }
}

/// Ordinates, always kept in double precision in memory.
#[derive(Debug, Clone, PartialEq)]
pub enum Data {
    /// Real values: time histories, coherences, auto spectra.
    Real(Vec<f64>),
    /// Complex values: FRFs, cross spectra.
    Complex(Vec<Complex64>),
}

impl Data {
    /// Number of ordinates.
    pub fn len(&self) -> usize {
        match self {
            Data::Real(values) => values.len(),
            Data::Complex(values) => values.len(),
        }
    }

    /// Whether there is no ordinate at all.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Index of the first ordinate that is NaN or infinite.
    pub(crate) fn first_non_finite(&self) -> Option<usize> {
        match self {
            Data::Real(values) => values.iter().position(|value| !value.is_finite()),
            Data::Complex(values) => values.iter().position(|value| !value.is_finite()),
        }
    }
}

/// Precision of the stored ordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// 4-byte floats, or 6 printed digits.
    Single,
    /// 8-byte floats, or 13 printed digits.
    Double,
}

/// Form of the stored ordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// Dataset 58: text in columns.
    Ascii,
    /// Dataset 58b: IEEE 754 floats.
    Binary(ByteOrder),
}

impl Default for Encoding {
    /// Binary, little endian.
    fn default() -> Self {
        Encoding::Binary(ByteOrder::Little)
    }
}

/// Byte order of binary ordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ByteOrder {
    /// Least significant byte first (PC, DEC).
    Little,
    /// Most significant byte first (older workstations).
    Big,
}
