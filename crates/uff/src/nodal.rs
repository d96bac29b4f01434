//! Data at nodes, of which mode shapes are the usual kind (datasets 55 and 2414).
//!
//! | | 55 | 2414 |
//! |---|---|---|
//! | before | five ID lines | label, name, location (1 nodes, 2 elements, 3 nodes on elements, 5 points), five ID lines |
//! | what it is, `6I10` | model, analysis, characteristic, quantity, data type, values a node | the same |
//! | parameters | `8I10` counts, then integers: load case, mode number; `6E13.5`: normal mode: Hz, modal mass, viscous and hysteretic damping ratio; complex mode: eigenvalue, modal a, modal b | two lines of integers, the mode number sixth; `6E13.5` twice: time, Hz, eigenvalue, modal mass, viscous and hysteretic damping ratio; eigenvalue, modal a, modal b |
//! | a node | `I10`, then its values `6E13.5` (real part, imaginary part in turn) | the same, doubles `3D25.16` |
//!
//! Layouts as the University of Cincinnati's Structural Dynamics Research Laboratory publishes them.

use num_complex::Complex64;

/// Where the values of a dataset sit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ValueLocation {
    /// At nodes: mode shapes, temperatures.
    Nodes,
    /// On elements or at points; of these only the header is read. The code is that of dataset 2414.
    Other(i64),
}

/// What kind of analysis the values are from (second field of record 6 of 55, 9 of 2414).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Analysis {
    /// A real mode.
    NormalMode,
    /// A complex mode, eigenvalue of a first-order system.
    ComplexFirstOrder,
    /// A complex mode, eigenvalue of a second-order system.
    ComplexSecondOrder,
    /// An operating deflection at a frequency.
    FrequencyResponse,
    /// Anything else: 0 unknown, 1 static, 4 transient, 6 buckling, …
    Other(i64),
}

impl Analysis {
    /// The kind that a file's code stands for.
    pub fn from_code(code: i64) -> Self {
        match code {
            2 => Analysis::NormalMode,
            3 => Analysis::ComplexFirstOrder,
            5 => Analysis::FrequencyResponse,
            7 => Analysis::ComplexSecondOrder,
            other => Analysis::Other(other),
        }
    }
}

/// Values at nodes: a mode shape, a temperature field, an operating deflection.
#[derive(Debug, Clone, PartialEq)]
pub struct NodalData {
    /// The dataset it stood in: 55 or 2414.
    pub dataset: u32,
    /// Name (2414) or first ID line (55).
    pub name: String,
    /// Where the values sit.
    pub location: ValueLocation,
    /// What kind of analysis they are from.
    pub analysis: Analysis,
    /// What they are, as [`data_type`](crate::data_type): 8 displacement, 5 temperature, …
    pub quantity: i64,
    /// Number of the mode (or of the step, or 0).
    pub mode: i64,
    /// Natural frequency or frequency, in Hz, where the dataset states one above zero.
    pub frequency: Option<f64>,
    /// Viscous damping ratio; that of a complex mode is −Re λ/|λ|.
    pub damping_ratio: Option<f64>,
    /// Hysteretic damping ratio, where it is not zero.
    pub hysteretic_damping: Option<f64>,
    /// Modal mass of a real mode, where it is not zero.
    pub modal_mass: Option<f64>,
    /// Eigenvalue of a complex mode, 1/s.
    pub eigenvalue: Option<Complex64>,
    /// Values a node: 3 translations, 3 translations and 3 rotations, or 1 scalar.
    pub per_node: usize,
    /// Whether the file stores imaginary parts.
    pub complex: bool,
    /// The values of each node, in file order; of other locations none.
    pub values: Vec<NodeValues>,
}

/// The values of one node.
#[derive(Debug, Clone, PartialEq)]
pub struct NodeValues {
    /// Node number.
    pub node: i64,
    /// [`NodalData::per_node`] values.
    pub values: Vec<Complex64>,
}

impl NodalData {
    /// Whether it is a mode: a displacement, velocity or acceleration shape of a real or complex mode at
    /// nodes.
    pub fn is_mode(&self) -> bool {
        let shape = matches!(self.quantity, 0 | 1 | 8 | 11 | 12) && self.per_node > 1;
        let mode = matches!(
            self.analysis,
            Analysis::NormalMode | Analysis::ComplexFirstOrder | Analysis::ComplexSecondOrder
        );
        self.location == ValueLocation::Nodes && shape && mode
    }
}
