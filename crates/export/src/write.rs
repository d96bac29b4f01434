//! The file for each program.

use crate::header::comment;
use crate::{Export, ExportError, Form, Program, abaqus, ansys, calculix, csv, nastran};
use serde_json::{Value, json};

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
