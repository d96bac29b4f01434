//! Storeys on columns.

use crate::value::{known, unknown};
use crate::{Bar, Draft, DraftError};
use serde_json::{Map, Value, json};

/// Storeys that a draft takes at the most.
const MOST: usize = 100;
/// Damping ratio to begin with; a fit finds its own.
const RATIO: f64 = 0.01;

/// What the columns weigh and how they are taken to be held, and which storeys the recording's points are
/// taken to be on.
fn notes_on_columns(draft: &Draft, column: &Bar, columns: usize, relative: f64) -> Vec<String> {
    let column_mass = column.mass(draft.ruler).0 * columns as f64;
    let mut notes = vec![
        format!(
            "the columns between two storeys weigh {column_mass:.3} kg together: half of it belongs to the storey above, half to that below; weigh the storeys and add it"
        ),
        format!(
            "columns are taken as fixed at both ends (12 E I/L^3 each); bolted ones are softer, which a fit finds within their deviation of {:.1} % or names; the damping ratios are a guess that a fit leaves free",
            100.0 * relative
        ),
    ];
    if !draft.points.is_empty() {
        notes.push(format!(
            "FILL IN: the recording's points {} were given to the storeys from below, as far as there are storeys; correct which is which",
            draft.points.join(", ")
        ));
    }
    notes
}

/// Columns fixed at both ends resist a storey's shift by n · 12 E I/L³.
pub(crate) fn file(
    draft: &Draft,
    storeys: usize,
    mass: f64,
    column: &Bar,
    columns: usize,
) -> Result<Value, DraftError> {
    if storeys == 0 || storeys > MOST || columns == 0 {
        return Err(DraftError::Storeys { storeys, columns });
    }
    if !mass.is_finite() || mass <= 0.0 {
        return Err(DraftError::Mass(mass));
    }
    let ((modulus, modulus_std), (moment, moment_std)) =
        (column.modulus(), column.second_moment(draft.ruler));
    let stiffness = columns as f64 * 12.0 * modulus * moment / column.length.powi(3);
    let relative =
        (modulus_std / modulus).hypot(moment_std / moment).hypot(3.0 * draft.ruler / column.length);
    let matrix = || json!([[known(stiffness, relative * stiffness), 0.0], [0.0, 0.0]]);
    let (mut bodies, mut points, mut joints) = (Map::new(), Map::new(), Map::new());
    // Storeys beyond the recording's points take numbers that no point has.
    let free = (1..).map(|number: usize| number.to_string()).filter(|number| !draft.points.contains(number));
    let names: Vec<String> = draft.points.iter().cloned().chain(free).take(storeys).collect();
    let name = |storey: usize| names[storey - 1].clone();
    for storey in 1..=storeys {
        let body = format!("F{storey}");
        bodies.insert(body.clone(), json!({ "mass": mass, "rotates": false }));
        points.insert(
            name(storey),
            json!({ "body": body, "x": known(column.length * storey as f64, draft.ruler) }),
        );
        if storey > 1 {
            joints.insert(
                format!("columns {storey}"),
                json!({ "from": name(storey - 1), "to": name(storey), "stiffness": matrix() }),
            );
        }
    }
    let mut notes = vec![format!(
        "drafted from {storeys} storeys of {mass} kg on {columns} columns each, {}: length is the storey's height, height the side along the motion. x runs upwards from the ground, y is the motion",
        column.says()
    )];
    notes.extend(notes_on_columns(draft, column, columns, relative));
    let ground =
        json!({ "ground": { "point": name(1), "stiffness": known(stiffness, relative * stiffness) } });
    Ok(json!({
        "name": format!("frame of {storeys} storeys"),
        "notes": notes,
        "bodies": bodies,
        "points": points,
        "joints": joints,
        "damping": { "modal_ratios": vec![unknown(RATIO); storeys] },
        "supports": ground
    }))
}
