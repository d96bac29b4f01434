//! The programs, and the text for each.

use crate::header::comment;
use crate::joint::{both_ends, is_zero};
use crate::{Export, ExportError, Joint, abaqus, ansys, calculix, csv, nastran};
use jointscope_beam::Matrix4;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt;

/// What reads the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Program {
    /// MSC, NX, Autodesk Nastran, OptiStruct: bulk data.
    Nastran,
    /// ANSYS Mechanical APDL.
    Ansys,
    /// Abaqus/Standard.
    Abaqus,
    /// CalculiX.
    Calculix,
    /// A table.
    Csv,
    /// JSON.
    Json,
}

impl Program {
    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Program::Nastran => "nastran",
            Program::Ansys => "ansys",
            Program::Abaqus => "abaqus",
            Program::Calculix => "calculix",
            Program::Csv => "csv",
            Program::Json => "json",
        }
    }

    /// What its files end in.
    pub fn extension(self) -> &'static str {
        match self {
            Program::Nastran => "bdf",
            Program::Ansys => "mac",
            Program::Abaqus | Program::Calculix => "inp",
            Program::Csv => "csv",
            Program::Json => "json",
        }
    }
}

impl fmt::Display for Program {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// How a joint is written, where a program has two ways.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// Nastran: CBUSH and PBUSH about the elastic centre.
    Bush,
    /// Nastran: DMIG on both nodes.
    Dmig,
    /// Abaqus: a linear user element.
    Element,
    /// Abaqus: a matrix of the model.
    Matrix,
}

impl fmt::Display for Form {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Form::Bush => "bush",
            Form::Dmig => "dmig",
            Form::Element => "element",
            Form::Matrix => "matrix",
        })
    }
}

/// A program's text without its header, and what the header has to say of it.
pub(crate) struct Body {
    pub text: String,
    pub notes: Vec<String>,
}

/// The text of a file for a program, with what it was `made` of in its header; [`json()`] writes JSON.
///
/// # Errors
/// A form that the program does not have, matrices that it cannot hold.
pub fn write(
    export: &Export,
    program: Program,
    form: Option<Form>,
    made: &[String],
) -> Result<String, ExportError> {
    let by_line = export.joints.iter().any(|joint| !joint.lines.is_empty());
    if by_line && matches!(program, Program::Ansys | Program::Abaqus | Program::Calculix) {
        return Err(ExportError::ByLine(program));
    }
    let known = match program {
        Program::Nastran => "`bush` and `dmig`",
        Program::Abaqus => "`element` and `matrix`",
        _ => "none",
    };
    match (program, form) {
        (_, None)
        | (Program::Nastran, Some(Form::Bush | Form::Dmig))
        | (Program::Abaqus, Some(Form::Element | Form::Matrix)) => {}
        (_, Some(form)) => return Err(ExportError::FormOf { form, program, known }),
    }
    let (mark, body) = match program {
        Program::Nastran => ("$ ", nastran::body(export, form)?),
        Program::Ansys => ("! ", ansys::body(export)),
        Program::Abaqus => ("** ", abaqus::body(export, form.unwrap_or(Form::Element))),
        Program::Calculix => ("** ", calculix::body(export)?),
        Program::Csv => ("# ", csv::body(export)),
        Program::Json => return Ok(format!("{:#}\n", json(export))),
    };
    Ok(comment(mark, export, made, &body.notes) + &body.text)
}

/// The contents of a JSON file.
pub fn json(export: &Export) -> Value {
    let mut value = json!({
        "units": "SI: m, kg, s, N, rad; stiffness N/m, N/rad, N*m/m, N*m/rad; damping the same times s",
        "axes": "x along the joint, y transverse, theta about z, positive from x to y; matrices act on d = u_to - R u_from, u = (y, theta), R = [[1, L], [0, 1]]",
    });
    // Only maps whose keys are no strings fail, and there are none.
    if let (Value::Object(value), Ok(Value::Object(export))) = (&mut value, serde_json::to_value(export)) {
        value.extend(export);
    }
    value
}

/// A row or column: node and degree of freedom.
pub(crate) type Coordinate = (u64, u8);

/// Matrices of all joints together, the elements on and below the diagonal: (column, row) and value.
#[derive(Debug, Default)]
pub(crate) struct Sparse(BTreeMap<(Coordinate, Coordinate), f64>);

impl Sparse {
    pub(crate) fn add(&mut self, joint: &Joint, matrix: &Matrix4) {
        let (from, to) = (joint.from.node, joint.to.node);
        let coordinates = [(from, 2), (from, 6), (to, 2), (to, 6)];
        for i in 0..4 {
            for j in 0..=i {
                if matrix[i][j] != 0.0 {
                    let (one, other) = (coordinates[i], coordinates[j]);
                    *self.0.entry((one.min(other), one.max(other))).or_default() += matrix[i][j];
                }
            }
        }
    }

    /// The columns with their rows, both ascending.
    pub(crate) fn columns(&self) -> BTreeMap<Coordinate, Vec<(Coordinate, f64)>> {
        let mut columns: BTreeMap<Coordinate, Vec<(Coordinate, f64)>> = BTreeMap::new();
        for ((column, row), value) in &self.0 {
            columns.entry(*column).or_default().push((*row, *value));
        }
        columns
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// The 4×4 matrices that a joint has, by kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Stiffness,
    Damping,
    Structural,
    Mass,
}

pub(crate) const KINDS: [Kind; 4] = [Kind::Stiffness, Kind::Damping, Kind::Structural, Kind::Mass];

impl Kind {
    /// A joint's matrix on both ends, if it has one.
    pub(crate) fn of(self, joint: &Joint) -> Option<Matrix4> {
        let matrix = match self {
            Kind::Stiffness => &joint.stiffness,
            Kind::Damping => &joint.damping,
            Kind::Structural => &joint.structural,
            Kind::Mass => return joint.mass,
        };
        (!is_zero(matrix)).then(|| both_ends(matrix, joint.length))
    }
}
