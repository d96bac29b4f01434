//! Two blocks and a strip.

use crate::value::{known, rounded, unknown};
use crate::{Bar, Draft, DraftError, points};
use serde_json::{Map, Value, json};

/// How far inside a block's outer end its sensor or hammer point lies: this share of its length, at the most
/// this much, m.
const INSIDE: (f64, f64) = (0.1, 5e-3);
/// Damping ratio to begin with; a fit finds its own.
const RATIO: f64 = 0.003;

pub(crate) fn file(draft: &Draft, blocks: &[Bar; 2], strip: &Bar) -> Result<Value, DraftError> {
    for (block, name) in blocks.iter().zip(["A", "B"]) {
        let sides = [("wide", strip.width, block.width), ("high", strip.height, block.height)];
        if let Some((side, strip, face)) = sides.into_iter().find(|(_, strip, face)| strip > face) {
            return Err(DraftError::Strip { side, strip: 1e3 * strip, block: name, face: 1e3 * face });
        }
    }
    let ruler = draft.ruler;
    let number = |(value, std)| known(value, std);
    let body = |bar: &Bar, centre: f64| json!({ "mass": number(bar.mass(ruler)), "inertia": number(bar.inertia(ruler)), "x_cg": known(centre, ruler) });
    let [a, b] = blocks;
    let (left, gap, right) = (-a.length, strip.length, strip.length + b.length);
    let inside = |bar: &Bar| (INSIDE.0 * bar.length).min(INSIDE.1);
    let at = |body: &str, x: f64| json!({ "body": body, "x": known(x, ruler) });
    let mut all = Map::new();
    let mut notes = vec![
        format!(
            "drafted from block A {}, block B {}, strip {}: lengths along x, widths across, heights along y; dimensions known to {} mm. x = 0 is the face of A that the strip begins at",
            a.says(), b.says(), strip.says(), 1e3 * rounded(ruler)
        ),
        "weigh the blocks, with what is screwed to them, and put the masses with the scales' deviation: it is worth more than any drawing".to_owned(),
        "the strip is taken as massless, and as held firmly by both blocks; the damping ratios are a guess that a fit leaves free".to_owned(),
    ];
    let bodies = [("A".to_owned(), left, 0.0), ("B".to_owned(), gap, right)];
    let ends = match (draft.placed.is_empty(), draft.points.is_empty()) {
        (true, true) => {
            all.insert("1".into(), at("A", left + inside(a)));
            all.insert("2".into(), at("A", 0.0));
            all.insert("3".into(), at("B", gap));
            all.insert("4".into(), at("B", right - inside(b)));
            notes.push("points: 1 and 4 near the outer ends of A and B, 2 and 3 at the faces that the strip is fixed to; move them to where sensors and hammer really are, in metres".to_owned());
            ["2", "3"]
        }
        (no_place, no_name) => {
            all.insert("end at A".into(), at("A", 0.0));
            all.insert("end at B".into(), at("B", gap));
            if !no_place {
                notes.extend(points::put(draft, &bodies, &mut all)?);
            }
            if !no_name {
                notes.push(points::spread(&draft.points, &bodies, &mut all));
            }
            ["end at A", "end at B"]
        }
    };
    let mut file = json!({
        "name": "two blocks and a strip",
        "notes": notes,
        "bodies": { "A": body(a, -0.5 * a.length), "B": body(b, gap + 0.5 * b.length) },
        "points": all,
        "joints": { "J": { "from": ends[0], "to": ends[1], "beam": { "youngs_modulus": number(strip.modulus()), "second_moment": number(strip.second_moment(ruler)) } } },
        "damping": { "modal_ratios": [unknown(RATIO), unknown(RATIO)] }
    });
    if let Some(geometry) = geometry([a, b], strip) {
        file["geometry"] = geometry;
    }
    Ok(file)
}

/// The assembly as a solid; nothing where one name would stand for two materials.
fn geometry([a, b]: [&Bar; 2], strip: &Bar) -> Option<Value> {
    let same =
        |one: &Bar, other: &Bar| one.material.name != other.material.name || one.material == other.material;
    if !(same(a, b) && same(a, strip) && same(b, strip)) {
        return None;
    }
    let solid = |bar: &Bar, from: f64, to: f64| json!({ "from": rounded(from), "to": rounded(to), "height": rounded(bar.height), "depth": rounded(bar.width), "material": bar.material.name });
    let material = |bar: &Bar| {
        let material = &bar.material;
        let entry = json!({ "youngs_modulus": material.youngs_modulus, "poisson_ratio": material.poisson_ratio, "density": material.density });
        (material.name.clone(), entry)
    };
    let materials: Map<String, Value> = [a, b, strip].into_iter().map(material).collect();
    Some(json!({
        "materials": materials,
        "bodies": { "A": solid(a, -a.length, 0.0), "B": solid(b, strip.length, strip.length + b.length) },
        "joints": { "J": { "thickness": rounded(strip.height), "width": rounded(strip.width), "material": strip.material.name } }
    }))
}
