//! Datasets 15, 18, 82, 151, 2411, 2412 and 2420, each from behind its identification line to behind its
//! closing delimiter.

use super::cursor::{Cursor, Line, excerpt, is_delimiter};
use super::fields::{columns_of, line_text};
use super::integers::{list, of_line, reals, record};
use crate::{CoordinateSystem, Element, GridPoint, Header, ReadError, SystemKind, TextProblem, TraceLine};

/// Calls `read` for every record up to the closing delimiter; blank lines between are passed.
fn each(
    cursor: &mut Cursor,
    closing: &'static str,
    mut read: impl FnMut(&mut Cursor) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    loop {
        match cursor.next_filled_line() {
            None => return Err(cursor.truncated(closing)),
            Some(line) if is_delimiter(line.bytes) => return Ok(()),
            Some(line) => {
                cursor.position = line.start;
                read(cursor)?;
            }
        }
    }
}

/// Dataset 15: `4I10,3E13.5`, also with wider reals.
pub(super) fn nodes15(cursor: &mut Cursor) -> Result<Vec<GridPoint>, ReadError> {
    const EXPECTED: &str =
        "label, definition system, displacement system, colour and three coordinates of a node (dataset 15)";
    let mut nodes = Vec::new();
    each(cursor, "a node or the `    -1` line that closes dataset 15", |cursor| {
        let line = cursor.header_line(EXPECTED)?;
        let (whole, coordinates) = line.bytes.split_at(line.bytes.len().min(40));
        let mut inner = Cursor { bytes: coordinates, position: 0, dataset: cursor.dataset };
        let numbers = of_line(cursor, Line { bytes: whole, ..line }, 10, EXPECTED);
        let coordinates = reals::<3>(&mut inner, &[13; 3], EXPECTED);
        match (numbers.as_deref(), coordinates) {
            (Ok(&[label, definition_system, displacement_system, _]), Ok(coordinates)) => {
                nodes.push(GridPoint { label, definition_system, displacement_system, coordinates });
                Ok(())
            }
            _ => Err(cursor.unexpected(line, EXPECTED, line.bytes)),
        }
    })?;
    Ok(nodes)
}

/// Dataset 2411; coordinates are in the part's system, whatever the export system.
pub(super) fn nodes2411(cursor: &mut Cursor) -> Result<Vec<GridPoint>, ReadError> {
    let mut nodes = Vec::new();
    each(cursor, "a node or the `    -1` line that closes dataset 2411", |cursor| {
        let [label, _, displacement_system, _] = record(
            cursor,
            "label, export system, displacement system and colour of a node (dataset 2411, record 1)",
        )?;
        let coordinates = reals(cursor, &[25; 3], "three coordinates of a node (dataset 2411, record 2)")?;
        nodes.push(GridPoint { label, definition_system: 0, displacement_system, coordinates });
        Ok(())
    })?;
    Ok(nodes)
}

fn kind(cursor: &Cursor, code: i64) -> Result<SystemKind, ReadError> {
    match code {
        0 => Ok(SystemKind::Cartesian),
        1 => Ok(SystemKind::Cylindrical),
        2 => Ok(SystemKind::Spherical),
        other => {
            let line = Line { start: cursor.position.saturating_sub(1), bytes: &[] };
            let found = other.to_string();
            Err(cursor.unexpected(
                line,
                "coordinate system type 0, 1 or 2 (datasets 18 and 2420)",
                found.as_bytes(),
            ))
        }
    }
}

fn text(cursor: &mut Cursor, expected: &'static str) -> Result<String, ReadError> {
    Ok(line_text(cursor.header_line(expected)?.bytes).trim().to_owned())
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|at| a[at] - b[at])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let norm = a.iter().map(|x| x * x).sum::<f64>().sqrt();
    (norm.is_finite() && norm > 0.0).then(|| a.map(|x| x / norm))
}

/// Dataset 18: origin, a point on +x, a point of the +xz plane.
pub(super) fn systems18(cursor: &mut Cursor) -> Result<Vec<CoordinateSystem>, ReadError> {
    const POINTS: &str =
        "origin, a point on +x and a point of the +xz plane, not on one line (dataset 18, record 3)";
    let mut systems = Vec::new();
    each(cursor, "a coordinate system or the `    -1` line that closes dataset 18", |cursor| {
        let [label, code, reference, _, _] = record(
            cursor,
            "label, type, reference system, colour and method of a coordinate system (dataset 18, record 1)",
        )?;
        let kind = kind(cursor, code)?;
        let name = text(cursor, "the name of a coordinate system (dataset 18, record 2)")?;
        let start = Line { start: cursor.position, bytes: &[] };
        let [a, b, c, d, e, f, g, h, i] = reals::<9>(cursor, &[13; 6], POINTS)?;
        let origin = [a, b, c];
        let x = unit(minus([d, e, f], origin));
        let y = x.and_then(|x| unit(cross(minus([g, h, i], origin), x)));
        let (Some(x), Some(y)) = (x, y) else {
            return Err(cursor.unexpected(
                start,
                POINTS,
                format!("{a} {b} {c} {d} {e} {f} {g} {h} {i}").as_bytes(),
            ));
        };
        systems.push(CoordinateSystem { label, name, kind, reference, axes: [x, y, cross(x, y)], origin });
        Ok(())
    })?;
    Ok(systems)
}

/// Dataset 2420: three axes and an origin.
pub(super) fn systems2420(cursor: &mut Cursor) -> Result<Vec<CoordinateSystem>, ReadError> {
    const MATRIX: &str = "three rows of unit length and an origin (dataset 2420, records 5 to 8)";
    let [_part] = record(cursor, "a part number (dataset 2420, record 1)")?;
    let _part_name = text(cursor, "a part name (dataset 2420, record 2)")?;
    let mut systems = Vec::new();
    each(cursor, "a coordinate system or the `    -1` line that closes dataset 2420", |cursor| {
        let [label, code, _] =
            record(cursor, "label, type and colour of a coordinate system (dataset 2420, record 3)")?;
        let kind = kind(cursor, code)?;
        let name = text(cursor, "the name of a coordinate system (dataset 2420, record 4)")?;
        let start = Line { start: cursor.position, bytes: &[] };
        let mut rows = [[0.0; 3]; 4];
        for row in &mut rows {
            *row = reals(cursor, &[25; 3], MATRIX)?;
        }
        let [x, y, z, origin] = rows;
        let is_unit = |row: [f64; 3]| (row.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-3;
        if ![x, y, z].into_iter().all(is_unit) {
            return Err(cursor.unexpected(start, MATRIX, format!("{x:?} {y:?} {z:?}").as_bytes()));
        }
        systems.push(CoordinateSystem { label, name, kind, reference: 0, axes: [x, y, z], origin });
        Ok(())
    })?;
    Ok(systems)
}

/// Dataset 2412; rods and beams have a record more.
pub(super) fn elements(cursor: &mut Cursor) -> Result<Vec<Element>, ReadError> {
    let mut elements = Vec::new();
    each(cursor, "an element or the `    -1` line that closes dataset 2412", |cursor| {
        let [label, descriptor, _, _, _, count] = record(
            cursor,
            "label, descriptor, tables, colour and number of nodes of an element (dataset 2412, record 1)",
        )?;
        if matches!(descriptor, 11 | 21..=24) {
            let [_, _, _] =
                record(cursor, "orientation node and cross-sections of a beam (dataset 2412, record 2)")?;
        }
        let nodes = list(cursor, count, "the nodes of an element (dataset 2412)")?;
        elements.push(Element { label, descriptor, nodes });
        Ok(())
    })?;
    Ok(elements)
}

/// Dataset 82: one trace line.
pub(super) fn trace(cursor: &mut Cursor) -> Result<TraceLine, ReadError> {
    let [number, count, _] =
        record(cursor, "number, number of nodes and colour of a trace line (dataset 82, record 1)")?;
    let name = text(cursor, "the name of a trace line (dataset 82, record 2)")?;
    let nodes = list(cursor, count, "the nodes of a trace line (dataset 82, record 3)")?;
    close(cursor, "the `    -1` line that closes dataset 82")?;
    Ok(TraceLine { number, name, nodes })
}

/// Dataset 151. Nothing depends on it, so missing lines are blank.
pub(super) fn header(cursor: &mut Cursor) -> Result<Header, ReadError> {
    const EXPECTED: &str = "the `    -1` line that closes dataset 151";
    let mut lines: [String; 7] = Default::default();
    let mut slots = lines.iter_mut();
    loop {
        let line = cursor.expect_line(EXPECTED)?;
        if is_delimiter(line.bytes) {
            break;
        }
        if let Some(slot) = slots.next() {
            *slot = columns_of(&line_text(line.bytes), 0, 80).trim().to_owned();
        }
    }
    let [model, description, made_by, _, _, written_by, written] = lines;
    Ok(Header { model, description, made_by, written_by, written })
}

/// Passes the closing delimiter, with nothing but blank lines before it.
pub(super) fn close(cursor: &mut Cursor, expected: &'static str) -> Result<(), ReadError> {
    match cursor.next_filled_line() {
        None => Err(cursor.truncated(expected)),
        Some(line) if is_delimiter(line.bytes) => Ok(()),
        Some(line) => Err(cursor.error(line, TextProblem::Field { expected, found: excerpt(line.bytes) })),
    }
}
