//! Random fixtures of steel blocks: several in a row with beams between them, or one at the end of a bar.

use super::elastic::elastic_frequencies;
use super::statement::{abscissa, damping, known_to, stated, steel_beam};
use crate::StructureError;
use crate::random::{log_uniform, uniform};
use jointscope_fixture::Fixture;
use rand::Rng;
use serde_json::{Map, Value, json};

/// Density of steel, kg/m³.
const DENSITY: f64 = 7850.0;

/// A steel block as drawn: it reaches from `left` over `length`.
struct Block {
    mass: f64,
    inertia: f64,
    left: f64,
    length: f64,
}

impl Block {
    fn draw(rng: &mut impl Rng, left: f64) -> Self {
        let mass = log_uniform(rng, 0.2, 6.0);
        let size = (mass / DENSITY).cbrt();
        let (length, height) = (size * uniform(rng, 1.0, 1.6), size * uniform(rng, 0.7, 1.0));
        Block { mass, inertia: mass * (length * length + height * height) / 12.0, left, length }
    }

    fn right(&self) -> f64 {
        self.left + self.length
    }

    fn moved_to_end_at(self, right: f64) -> Self {
        Block { left: right - self.length, ..self }
    }

    fn stated(&self) -> Value {
        json!({
            "mass": known_to(self.mass, 0.001),
            "inertia": known_to(self.inertia, 0.004),
            "x_cg": abscissa(self.left + self.length / 2.0),
        })
    }

    fn at(&self, fraction: f64) -> f64 {
        self.left + fraction * self.length
    }
}

/// Blocks in a row, steel beams between neighbours; the first beam starts at x = 0.
pub(super) fn row(
    name: &str,
    rng: &mut impl Rng,
    count: usize,
    supported: bool,
) -> Result<Fixture, StructureError> {
    let mut blocks = vec![Block::draw(rng, 0.0).moved_to_end_at(0.0)];
    for i in 1..count {
        let gap = uniform(rng, 0.02, 0.09);
        let left = blocks[i - 1].right() + gap;
        blocks.push(Block::draw(rng, left));
    }
    let (mut bodies, mut points, mut joints) = (Map::new(), Map::new(), Map::new());
    let mut number = 0;
    let mut add_point = |body: &str, x: f64| {
        number += 1;
        points.insert(number.to_string(), json!({ "body": body, "x": abscissa(x) }));
        number.to_string()
    };
    let mut previous_end: Option<String> = None;
    for (i, (block, body)) in blocks.iter().zip(["A", "B", "C"]).enumerate() {
        bodies.insert(body.into(), block.stated());
        let (first, last) = (i == 0, i + 1 == count);
        if first {
            add_point(body, block.at(uniform(rng, 0.05, 0.3)));
        } else {
            let start = add_point(body, block.left);
            if let Some(from) = previous_end.take() {
                let beam = steel_beam(1e-10 * uniform(rng, 0.7, 1.4));
                let joint = if count == 2 { "J".to_string() } else { format!("J{i}") };
                joints.insert(joint, json!({ "from": from, "to": start, "beam": beam }));
            }
            add_point(body, block.at(uniform(rng, 0.6, 0.95)));
        }
        if !last {
            previous_end = Some(add_point(body, block.right()));
        }
    }
    let mut statement = json!({ "name": name, "bodies": bodies, "points": points, "joints": joints });
    let highest = tune(&mut statement, log_uniform(rng, 350.0, 900.0))?;
    statement["damping"] = damping(rng, 2 * (count - 1), highest);
    if supported {
        let mut spring = |point: &str, std: f64, dashpot: f64| {
            let stiffness = uniform(rng, 300.0, 700.0);
            json!({ "point": point, "stiffness": stated(stiffness, std), "damping": stated(dashpot, 0.1) })
        };
        statement["supports"] = json!({ "S1": spring("1", 40.0, 0.4), "S4": spring("4", 60.0, 0.6) });
    }
    Ok(Fixture::from_value(&statement)?)
}

/// Scales the second moments of all joints so that the highest elastic mode lies at `target` (Hz): in a free
/// assembly of rigid bodies every elastic frequency goes with the root of the stiffness.
fn tune(statement: &mut Value, target: f64) -> Result<f64, StructureError> {
    let fixture = Fixture::from_value(statement)?;
    let Some(highest) = elastic_frequencies(&fixture)?.last().copied() else { return Ok(target) };
    let factor = (target / highest).powi(2);
    if let Some(joints) = statement["joints"].as_object_mut() {
        for joint in joints.values_mut() {
            let second_moment = joint["beam"]["second_moment"]["value"].as_f64().unwrap_or(1e-10);
            joint["beam"] = steel_beam(second_moment * factor);
        }
    }
    Ok(target)
}

/// A deformable steel bar of 0.3 to 0.6 m with a block at its end, points 1 and 2 on the bar, 3 and 4 on the
/// block.
pub(super) fn beam_and_block(name: &str, rng: &mut impl Rng) -> Result<Fixture, StructureError> {
    let (length, thickness) = (uniform(rng, 0.3, 0.6), uniform(rng, 0.01, 0.02));
    let width = uniform(rng, 0.025, 0.04);
    let gap = uniform(rng, 0.02, 0.06);
    let block = Block::draw(rng, gap);
    let bar = json!({ "beam": {
        "from": abscissa(-length), "to": abscissa(0.0),
        "youngs_modulus": known_to(super::statement::STEEL, 0.005),
        "second_moment": known_to(width * thickness.powi(3) / 12.0, 0.005),
        "mass_per_length": known_to(DENSITY * width * thickness, 0.002),
    } });
    let strip = width * uniform(rng, 0.003, 0.008).powi(3) / 12.0;
    let inner = -length * uniform(rng, 0.6, 0.95);
    // The joint sits exactly at the bar's end, which is drawn apart from it: it is set back by five
    // deviations.
    let seat = -5e-4;
    let statement = json!({
        "name": name,
        "bodies": { "A": bar, "B": block.stated() },
        "points": {
            "1": { "body": "A", "x": abscissa(inner) }, "2": { "body": "A", "x": abscissa(seat) },
            "3": { "body": "B", "x": abscissa(block.left) },
            "4": { "body": "B", "x": abscissa(block.at(uniform(rng, 0.6, 0.95))) },
        },
        "joints": { "J": { "from": "2", "to": "3", "beam": steel_beam(strip) } },
        "damping": damping(rng, 4, 1000.0),
    });
    Ok(Fixture::from_value(&statement)?)
}
