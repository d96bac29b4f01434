//! What is exported: joints, parts of one or two nodes, and what has no counterpart.

use crate::{ExportError, Joint};
use jointscope_fixture::Dof;
use serde::Serialize;

/// A node of the finite-element model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Node {
    /// Its number.
    pub number: u64,
    /// Abscissa, m; z is zero.
    pub x: f64,
    /// Height above the bodies' axis, m: zero but of what sits on a block's face.
    pub y: f64,
    /// What it is.
    pub says: String,
    /// Whether the model that reads the file has it already: then it is not defined there.
    pub existing: bool,
    /// Whether it moves along y only: its other motions are to be held.
    pub only_y: bool,
}

/// A part that is no joint.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Part {
    /// Where it comes from, with uncertainty and probability.
    pub says: String,
    /// What it is.
    #[serde(flatten)]
    pub element: Element,
}

/// A part of one or two nodes, SI.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "element", rename_all = "snake_case")]
pub enum Element {
    /// A point mass, the same in every direction; negative for mass that is not there.
    Mass {
        /// Node.
        node: u64,
        /// kg.
        mass: f64,
    },
    /// A spring and dashpot to ground.
    Ground {
        /// Node.
        node: u64,
        /// y or θ.
        dof: Dof,
        /// N/m or N·m/rad.
        stiffness: f64,
        /// N·s/m or N·m·s/rad.
        damping: f64,
    },
    /// A spring and dashpot between the y of two nodes.
    Spring {
        /// One node.
        from: u64,
        /// The other.
        to: u64,
        /// N/m.
        stiffness: f64,
        /// N·s/m.
        damping: f64,
    },
}

/// Something that has no counterpart in a finite-element model.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Omitted {
    /// What.
    pub what: String,
    /// Why, and what to do instead.
    pub why: String,
}

/// Everything that is exported of one answer.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Export {
    /// What it is.
    pub title: String,
    /// Remarks on the whole.
    pub notes: Vec<String>,
    /// Nodes, ascending.
    pub nodes: Vec<Node>,
    /// Joints.
    pub joints: Vec<Joint>,
    /// Masses, supports and springs.
    pub parts: Vec<Part>,
    /// What is not exported.
    pub not_exported: Vec<Omitted>,
    /// First number of elements, properties, tables and of nodes that a writer adds.
    #[serde(skip)]
    pub first_id: u64,
}

/// Largest number: what is made of it, K over L² or a sum of products, keeps to a power of two digits.
const LARGEST: f64 = 1e90;

impl Export {
    /// The same, where all its numbers are ones that a structure can have.
    ///
    /// # Errors
    /// [`ExportError::TooLarge`].
    pub(crate) fn checked(self) -> Result<Self, ExportError> {
        let fits = |value: &f64| value.abs() <= LARGEST;
        let element = |part: &Part| match part.element {
            Element::Mass { mass, .. } => fits(&mass),
            Element::Ground { stiffness, damping, .. } | Element::Spring { stiffness, damping, .. } => {
                fits(&stiffness) && fits(&damping)
            }
        };
        let joint = |joint: &Joint| {
            let lines = joint.lines.iter().flat_map(|line| [line.stiffness, line.damping]);
            let matrices = [joint.stiffness, joint.damping, joint.structural].into_iter().chain(lines);
            let mut all = matrices.flatten().flatten();
            all.all(|value| fits(&value))
                && joint.mass.iter().flatten().flatten().all(fits)
                && fits(&joint.length)
        };
        let joints = self.joints.iter().find(|one| !joint(one)).map(|joint| format!("joint {}", joint.name));
        let parts = || self.parts.iter().find(|part| !element(part)).map(|part| part.says.clone());
        let nodes = || {
            self.nodes
                .iter()
                .find(|node| !fits(&node.x) || !fits(&node.y))
                .map(|node| format!("the abscissa of node {}", node.number))
        };
        match joints.or_else(parts).or_else(nodes) {
            Some(what) => Err(ExportError::TooLarge(what)),
            None => Ok(self),
        }
    }
}

/// The degree of freedom's number: y is 2, θ about z is 6.
pub(crate) fn dof_number(dof: Dof) -> u8 {
    match dof {
        Dof::Translation => 2,
        Dof::Rotation => 6,
    }
}
