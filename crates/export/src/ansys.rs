//! Commands for ANSYS Mechanical APDL: MATRIX27 for joints, MASS21 and COMBIN14 for the rest.

use crate::Export;
use crate::body::Body;
use crate::matrices::{KINDS, Kind};
use crate::numbers::exact;
use crate::parts::{Element, dof_number};
use jointscope_beam::Matrix4;

/// Where y and θ of the two nodes stand among the twelve degrees of freedom UX, UY, UZ, ROTX, ROTY, ROTZ of
/// node I, then of node J.
const PLACES: [usize; 4] = [1, 5, 7, 11];
/// Real constants a command takes.
const ON_A_LINE: usize = 6;

pub(crate) fn body(export: &Export) -> Body {
    let mut notes = vec![
        "read it with /INPUT in /PREP7 after your mesh: element types and real constants are numbered after those that are there".to_owned(),
    ];
    let mut text = String::from("/PREP7\n");
    for node in export.nodes.iter().filter(|node| !node.existing) {
        text += &format!("N,{},{},{},0\n", node.number, exact(node.x), exact(node.y));
        if node.only_y {
            text += &format!("D,{},UX,0,,,,UZ,ROTX,ROTY,ROTZ\n", node.number);
        }
    }
    for joint in &export.joints {
        let joint = &joint.without_structural(&mut notes);
        for kind in KINDS {
            let Some(matrix) = kind.of(joint) else { continue };
            let option = match kind {
                Kind::Stiffness => 4,
                Kind::Damping => 5,
                Kind::Mass => 2,
                Kind::Structural => {
                    notes.push(format!(
                        "joint {}: its structural damping is not written, for MATRIX27 holds stiffness, viscous damping and mass; give it to the analysis (DMPSTR) or as the stiffness's share at your frequency",
                        joint.name
                    ));
                    continue;
                }
            };
            text += &element_type("MATRIX27", &[(3, option)]);
            text += &real_constants(&upper_triangle(&matrix));
            text += &format!("E,{},{}\n", joint.from.node, joint.to.node);
        }
    }
    let mut ground = export.first_id;
    for part in &export.parts {
        text += &part_commands(&part.element, export, &mut ground);
    }
    Body { text, notes }
}

/// The 78 constants C1 to C78: the upper triangle, row after row.
fn upper_triangle(matrix: &Matrix4) -> Vec<f64> {
    let place = |coordinate: usize| PLACES.iter().position(|p| *p == coordinate);
    let element = |row: usize, column: usize| match (place(row), place(column)) {
        (Some(i), Some(j)) => matrix[i][j],
        _ => 0.0,
    };
    (0..12).flat_map(|row| (row..12).map(move |column| (row, column))).map(|(r, c)| element(r, c)).collect()
}

fn element_type(name: &str, options: &[(u8, u8)]) -> String {
    let mut text = format!("*GET,JS_ET,ETYP,0,NUM,MAX\nJS_ET=JS_ET+1\nET,JS_ET,{name}\n");
    for (option, value) in options {
        text += &format!("KEYOPT,JS_ET,{option},{value}\n");
    }
    text + "TYPE,JS_ET\n"
}

fn real_constants(values: &[f64]) -> String {
    let mut text = String::from("*GET,JS_R,RCON,0,NUM,MAX\nJS_R=JS_R+1\n");
    for (index, values) in values.chunks(ON_A_LINE).enumerate() {
        text += if index == 0 { "R,JS_R" } else { "RMORE" };
        for value in values {
            text.push(',');
            text += &if *value == 0.0 { "0".to_owned() } else { exact(*value) };
        }
        text.push('\n');
    }
    text + "REAL,JS_R\n"
}

fn part_commands(element: &Element, export: &Export, ground: &mut u64) -> String {
    match *element {
        Element::Mass { node, mass } => {
            element_type("MASS21", &[(3, 2)]) + &real_constants(&[mass]) + &format!("E,{node}\n")
        }
        Element::Spring { from, to, stiffness, damping } => {
            element_type("COMBIN14", &[(2, 2)])
                + &real_constants(&[stiffness, damping])
                + &format!("E,{from},{to}\n")
        }
        Element::Ground { node, dof, stiffness, damping } => {
            let x = export.nodes.iter().find(|other| other.number == node).map_or(0.0, |node| node.x);
            let fixed = *ground;
            *ground += 1;
            format!("N,{fixed},{},0,0\nD,{fixed},ALL,0\n", exact(x))
                + &element_type("COMBIN14", &[(2, dof_number(dof))])
                + &real_constants(&[stiffness, damping])
                + &format!("E,{node},{fixed}\n")
        }
    }
}
