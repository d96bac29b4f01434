//! What was found, for a finite-element model: the joint of a decomposition, or what the repaired fixture of
//! a diagnosis has in it, as elements of Nastran, ANSYS, Abaqus and CalculiX, or as plain matrices.
//!
//! * [`of_decompositions`], [`of_diagnosis`]: an [`Export`] of what `stiffness.json`, or `diagnosis.json` and
//!   `repaired.json`, hold;
//! * [`Joint`]: matrices on d = u_to − R·u_from, their [`ElasticCentre`], their 4×4 form on [`both_ends`];
//! * [`write()`]: the text for a [`Program`].
//!
//! Axes: x along the joint, y transverse (degree of freedom 2), θ about z (degree of freedom 6), positive
//! from x to y. SI units.
//!
//! The elastic centre of a beam lies at its middle, where a force does not turn the far end:
//!
//! ```
//! use jointscope_export::ElasticCentre;
//!
//! let (ei, l) = (76.0, 0.065_f64);
//! let f = ei / l.powi(3);
//! let centre = ElasticCentre::of(&[[12.0 * f, -6.0 * l * f], [-6.0 * l * f, 4.0 * l * l * f]]).unwrap();
//! assert!((centre.offset + l / 2.0).abs() < 1e-15);
//! assert!((centre.rotation / (ei / l) - 1.0).abs() < 1e-12);
//! ```

mod abaqus;
mod ansys;
mod body;
mod calculix;
mod csv;
mod decomposition;
mod diagnosis;
mod error;
mod header;
mod joint;
mod matrices;
mod nastran;
mod numbering;
mod numbers;
mod parts;
mod program;
mod repaired_joint;
mod write;

pub use decomposition::of_decompositions;
pub use diagnosis::of_diagnosis;
pub use error::ExportError;
pub use joint::{Covariance, ElasticCentre, Joint, JointAtFrequency, JointNode, both_ends};
pub use parts::{Element, Export, Node, Omitted, Part};
pub use program::{Form, Program};
pub use write::{json, write};

/// What to export and how to number it.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportOptions {
    /// One joint of several.
    pub joint: Option<String>,
    /// Nodes of the model at the joint's ends.
    pub nodes: Option<[u64; 2]>,
    /// First number of what has none of its own, 1 to 99,000,000.
    pub first_id: u64,
    /// K and C by line too.
    pub by_line: bool,
    /// Although it is judged unusable.
    pub anyway: bool,
}

impl Default for ExportOptions {
    fn default() -> Self {
        ExportOptions { joint: None, nodes: None, first_id: 900_001, by_line: false, anyway: false }
    }
}
