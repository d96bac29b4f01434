//! Random frames: storeys that only translate, with springs between them.

use super::elastic::elastic_frequencies;
use super::statement::{damping, known_to, stated};
use crate::StructureError;
use crate::random::{log_uniform, uniform};
use jointscope_fixture::Fixture;
use rand::Rng;
use serde_json::{Map, Value, json};

/// Four or five storeys that do not rotate, a spring between neighbours.
pub(super) fn storeys(name: &str, rng: &mut impl Rng) -> Result<Fixture, StructureError> {
    let count = 4 + (uniform(rng, 0.0, 2.0) as usize);
    let height = uniform(rng, 0.1, 0.25);
    let masses: Vec<f64> = (0..count).map(|_| uniform(rng, 2.0, 8.0)).collect();
    let springs: Vec<f64> = (1..count).map(|_| uniform(rng, 0.6, 1.4)).collect();
    let target = log_uniform(rng, 250.0, 800.0);
    let fixture = |unit: f64, damping: &Value| {
        let (mut bodies, mut points, mut joints) = (Map::new(), Map::new(), Map::new());
        for (i, mass) in masses.iter().enumerate() {
            let (body, point) = (format!("F{}", i + 1), (i + 1).to_string());
            bodies.insert(body.clone(), json!({ "mass": known_to(*mass, 0.002), "rotates": false }));
            points.insert(point, json!({ "body": body, "x": stated(height * i as f64, 1e-3) }));
        }
        for (i, spring) in springs.iter().enumerate() {
            let stiffness = json!([[known_to(spring * unit, 0.008), 0.0], [0.0, 0.0]]);
            let (from, to) = ((i + 1).to_string(), (i + 2).to_string());
            joints.insert(format!("C{}", i + 1), json!({ "from": from, "to": to, "stiffness": stiffness }));
        }
        Fixture::from_value(&json!({
            "name": name, "bodies": bodies, "points": points, "joints": joints, "damping": damping,
        }))
    };
    let unit = 4e6;
    let highest = elastic_frequencies(&fixture(unit, &json!({}))?)?.last().copied().unwrap_or(target);
    let damping = damping(rng, count - 1, target);
    Ok(fixture(unit * (target / highest).powi(2), &damping)?)
}
