//! A beam, free or clamped.

use crate::value::{known, rounded, unknown};
use crate::{Bar, Draft, DraftError, points};
use serde_json::{Map, Value, json};

/// Points of a beam, and elastic modes with a ratio of their own.
const POINTS: usize = 5;
const MODES: usize = 4;
/// Damping ratio to begin with; a fit finds its own.
const RATIO: f64 = 0.003;
/// How many times stiffer than the beam, EI/L³ and EI/L, a clamp is taken to be: the first three natural
/// frequencies are then lower by up to 0.13 %. Much stiffer ones would drown the first mode in rounding.
const CLAMP: f64 = 1e5;

/// A point by its number from 0, of those spread evenly over the beam.
fn evenly_spaced(index: usize, length: f64, ruler: f64, clamped: bool) -> (String, Value) {
    // The clamped end itself does not move.
    let share = match clamped {
        true => (index + 1) as f64 / POINTS as f64,
        false => index as f64 / (POINTS - 1) as f64,
    };
    // A point at an end lies on it, however long the beam is.
    let std = if share == 0.0 || share == 1.0 { 0.0 } else { ruler };
    ((index + 1).to_string(), json!({ "body": "beam", "x": known(share * length, std) }))
}

pub(crate) fn file(draft: &Draft, bar: &Bar, clamped: bool) -> Result<Value, DraftError> {
    let number = |(value, std)| known(value, std);
    let (modulus, moment) = (bar.modulus(), bar.second_moment(draft.ruler));
    let mut notes = vec![
        format!(
            "drafted from {}: length along x, width across, height along y, the direction that is struck and measured; dimensions known to {} mm. x = 0 is the {} end",
            bar.says(),
            1e3 * rounded(draft.ruler),
            if clamped { "clamped" } else { "left" }
        ),
        format!(
            "it should weigh {:.4} kg: weigh it, and put the mass per length with the scales' deviation",
            bar.mass(draft.ruler).0
        ),
        "the damping ratios are a guess that a fit leaves free".to_owned(),
    ];
    let mut all = Map::new();
    let body = [("beam".to_owned(), 0.0, bar.length)];
    if !draft.placed.is_empty() {
        notes.extend(points::put(draft, &body, &mut all)?);
    }
    if draft.points.is_empty() && draft.placed.is_empty() {
        all.extend((0..POINTS).map(|index| evenly_spaced(index, bar.length, draft.ruler, clamped)));
        notes.push(
            "points 1 to 5 are evenly spaced; move them to where sensors and hammer really are, in metres"
                .to_owned(),
        );
    } else if !draft.points.is_empty() {
        notes.push(points::spread(&draft.points, &body, &mut all));
    }
    let mut file = json!({
        "name": if clamped { "clamped beam" } else { "free beam" },
        "notes": notes,
        "bodies": { "beam": { "beam": {
            "from": known(0.0, 0.0), "to": known(bar.length, 0.0),
            "youngs_modulus": number(modulus), "second_moment": number(moment), "mass_per_length": number(bar.mass_per_length(draft.ruler))
        } } },
        "points": all,
        "damping": { "modal_ratios": vec![unknown(RATIO); MODES] }
    });
    if clamped {
        let stiffness = modulus.0 * moment.0;
        file["supports"] = json!({ "clamp": {
            "body": "beam", "x": known(0.0, 0.0),
            "stiffness": rounded(CLAMP * stiffness / bar.length.powi(3)),
            "rotational_stiffness": rounded(CLAMP * stiffness / bar.length)
        } });
        if let Some(notes) = file["notes"].as_array_mut() {
            notes.push(json!("the clamp is taken as a hundred thousand times as stiff as the beam; a real one is softer, which a diagnosis finds: state its rotational_stiffness with \"std\": \"unknown\" to have it fitted"));
        }
    }
    Ok(file)
}
