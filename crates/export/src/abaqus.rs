//! Keywords for Abaqus/Standard: linear user elements, or matrices of the model; masses, springs and
//! dashpots.

use crate::Form;
use crate::body::Body;
use crate::matrices::{KINDS, Kind, Sparse};
use crate::numbers::twenty;
use crate::parts::{Element, dof_number};
use crate::{Export, Joint};
use jointscope_beam::Matrix4;

/// Values on a data line of *MATRIX.
const ON_A_LINE: usize = 4;

pub(crate) fn body(export: &Export, form: Form) -> Body {
    let mut text = String::new();
    let mut notes = Vec::new();
    let own: Vec<_> = export.nodes.iter().filter(|node| !node.existing).collect();
    if !own.is_empty() {
        text += "*NODE\n";
        own.iter().for_each(|node| {
            text += &format!("{}, {}, {}, 0.\n", node.number, twenty(node.x), twenty(node.y))
        });
    }
    let mut id = export.first_id;
    if form == Form::Matrix {
        text += &matrices(export);
        if !export.joints.is_empty() {
            notes.push("*MATRIX INPUT and *MATRIX ASSEMBLE are model data; matrices are not used by direct steady-state dynamics, for which `--form element` is".to_owned());
        }
    } else {
        for (index, joint) in export.joints.iter().enumerate() {
            text += &user_elements(joint, index, &mut id, &mut notes);
        }
    }
    for part in &export.parts {
        text += &part_keywords(&part.element, &mut id);
    }
    let held: Vec<_> = own.iter().filter(|node| node.only_y).collect();
    if !held.is_empty() {
        text += "*BOUNDARY\n";
        held.iter().for_each(|node| text += &format!("{0}, 1, 1\n{0}, 3, 6\n", node.number));
    }
    Body { text, notes }
}

/// One linear user element with all matrices of a joint.
fn user_elements(joint: &Joint, index: usize, id: &mut u64, notes: &mut Vec<String>) -> String {
    let joint = &joint.without_structural(notes);
    let mut text = format!("*USER ELEMENT, TYPE=U{}, NODES=2, LINEAR\n2, 6\n", 9001 + index);
    for kind in KINDS {
        let Some(matrix) = kind.of(joint) else { continue };
        let name = match kind {
            Kind::Stiffness => "STIFFNESS",
            Kind::Damping => {
                notes.push("releases whose *MATRIX of a user element knows STIFFNESS and MASS only (2016 and before) need `--form matrix` for the damping".to_owned());
                "DAMPING"
            }
            Kind::Mass => "MASS",
            Kind::Structural => {
                notes.push(format!(
                    "joint {}: its structural damping is not written as a user element; `--form matrix` writes it",
                    joint.name
                ));
                continue;
            }
        };
        text += &format!("*MATRIX, TYPE={name}\n{}", upper_columns(&matrix));
    }
    let element = next(id);
    let set = format!("JS_JOINT_{}", index + 1);
    text += &format!(
        "*ELEMENT, TYPE=U{}, ELSET={set}\n{element}, {}, {}\n",
        9001 + index,
        joint.from.node,
        joint.to.node
    );
    text + &format!("*UEL PROPERTY, ELSET={set}\n")
}

/// Column after column from its top to the diagonal, each on lines of its own.
fn upper_columns(matrix: &Matrix4) -> String {
    let column = |j: usize| {
        let values: Vec<String> = (0..=j).map(|i| twenty(matrix[i][j])).collect();
        values.chunks(ON_A_LINE).map(|line| line.join(", ") + "\n").collect::<String>()
    };
    (0..4).map(column).collect()
}

fn matrices(export: &Export) -> String {
    let mut text = String::new();
    let mut assembled = Vec::new();
    for kind in KINDS {
        let mut sparse = Sparse::default();
        for joint in &export.joints {
            kind.of(joint).into_iter().for_each(|matrix| sparse.add(joint, &matrix));
        }
        if sparse.is_empty() {
            continue;
        }
        let (name, parameter) = match kind {
            Kind::Stiffness => ("JS_K", "STIFFNESS"),
            Kind::Damping => ("JS_C", "VISCOUS DAMPING"),
            Kind::Structural => ("JS_S", "STRUCTURAL DAMPING"),
            Kind::Mass => ("JS_M", "MASS"),
        };
        text += &format!("*MATRIX INPUT, NAME={name}, TYPE=SYMMETRIC\n");
        for ((node, dof), rows) in sparse.columns() {
            for ((row, row_dof), value) in rows {
                text += &format!("{row}, {row_dof}, {node}, {dof}, {}\n", twenty(value));
            }
        }
        assembled.push(format!("{parameter}={name}"));
    }
    if !assembled.is_empty() {
        text += &format!("*MATRIX ASSEMBLE, {}\n", assembled.join(", "));
    }
    text
}

fn part_keywords(element: &Element, id: &mut u64) -> String {
    match *element {
        Element::Mass { node, mass } => {
            let number = next(id);
            let set = format!("JS_{number}");
            format!(
                "*ELEMENT, TYPE=MASS, ELSET={set}\n{number}, {node}\n*MASS, ELSET={set}\n{}\n",
                twenty(mass)
            )
        }
        Element::Ground { node, dof, stiffness, damping } => {
            let dof = dof_number(dof).to_string();
            spring_and_dashpot("1", &node.to_string(), &dof, stiffness, damping, id)
        }
        Element::Spring { from, to, stiffness, damping } => {
            spring_and_dashpot("2", &format!("{from}, {to}"), "2, 2", stiffness, damping, id)
        }
    }
}

fn spring_and_dashpot(kind: &str, nodes: &str, dofs: &str, k: f64, c: f64, id: &mut u64) -> String {
    let mut text = String::new();
    for (name, value) in [("SPRING", k), ("DASHPOT", c)] {
        if value != 0.0 {
            let number = next(id);
            let set = format!("JS_{number}");
            text += &format!(
                "*ELEMENT, TYPE={name}{kind}, ELSET={set}\n{number}, {nodes}\n*{name}, ELSET={set}\n{dofs}\n{}\n",
                twenty(value)
            );
        }
    }
    text
}

fn next(id: &mut u64) -> u64 {
    *id += 1;
    *id - 1
}
