//! Two solid blocks on a strip with nothing idealised, and the fixture that an honest analyst writes of them.

use super::footings::Footings;
use crate::GenerationError;
use crate::random::{between, log_uniform};
use crate::routes::solid::assembly::{
    Block, GAP, HIGHEST, LOWEST, MATERIALS, METALS, POISSON, Strip, abscissa, elastic, known_to,
};
use jointscope_fixture::Fixture;
use jointscope_rig::StructureError;
use rand::{Rng, RngExt};
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// Names of the strip's ends.
pub(super) const ENDS: [&str; 2] = ["10", "11"];
/// Points of the solid that no fixture states.
pub(super) const UNSTATED: [&str; 2] = ["91", "92"];
/// Width of the strip over its thickness: narrow enough to bend as a beam, or a plate.
const NARROW: [f64; 2] = [1.5, 3.0];
const WIDE: [f64; 2] = [4.0, 8.0];
/// Thickness of the strip over its length.
const THICKNESS: [f64; 2] = [0.04, 0.15];
/// Shares of a block's length at which it is measured, from its outer end, and where nobody measures.
const OUTER: [f64; 2] = [0.05, 0.2];
const INNER: [f64; 2] = [0.75, 0.9];
const APART: [f64; 2] = [0.4, 0.6];
/// Damping ratios of the elastic modes, and how well they are known.
const RATIO: [f64; 2] = [0.003, 0.009];
const RATIO_KNOWN: f64 = 0.2;
/// Frequency at which a block alone bounces on its soft support, Hz, its damping ratio, and how well both are
/// known.
const BOUNCE: [f64; 2] = [2.0, 4.0];
const BOUNCE_RATIO: [f64; 2] = [0.01, 0.05];
const SUPPORT_KNOWN: [f64; 2] = [0.1, 0.25];
/// How well mass, shear and footing of the strip are known.
const STRIP_MASS_KNOWN: f64 = 0.01;
const SHEAR_KNOWN: f64 = 0.05;
const FOOTING_KNOWN: f64 = 0.08;

/// A layer of glue at one end of the strip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Layer {
    pub end: usize,
    pub thickness: f64,
    pub modulus: f64,
}

/// What of a solid is stated, of all that the lumped model of blocks and strip leaves out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stated {
    pub strip_mass: bool,
    pub shear: bool,
    pub footings: bool,
}

/// The solid.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Assembly {
    pub blocks: [Block; 2],
    pub strip: Strip,
    /// Factor by which the strip's modulus differs from its material's.
    pub factor: f64,
    pub layer: Option<Layer>,
    /// Abscissae of points 1 to 4, of two that nobody measures at, and of soft supports.
    points: [f64; 4],
    apart: [f64; 2],
    supports: Option<[[f64; 2]; 2]>,
    ratios: [f64; 2],
}

impl Assembly {
    /// `None` where what was drawn has no strip of sensible dimensions.
    pub(super) fn draw(random: &mut impl Rng, wide: bool) -> Result<Option<Self>, GenerationError> {
        let mut a = Block::draw(random, 0.0);
        a.left = -a.length;
        let length = between(random, GAP);
        let blocks = [a, Block::draw(random, length)];
        let material = random.random_range(0..METALS);
        let aspect = log_uniform(random, if wide { WIDE } else { NARROW });
        let target = log_uniform(random, HIGHEST);
        let ratios = [log_uniform(random, RATIO), log_uniform(random, RATIO)];
        let bounce = (random.random_range(0.0..1.0) < 0.5)
            .then(|| [0, 1].map(|_| [TAU * between(random, BOUNCE), between(random, BOUNCE_RATIO)]));
        let mut drawn = Assembly {
            blocks,
            strip: Strip { material, length, width: 1e-2, thickness: 1e-3 },
            factor: 1.0,
            layer: None,
            points: [0.0; 4],
            apart: [0.0; 2],
            supports: None,
            ratios,
        };
        drawn.place_points(random);
        // In a free assembly of rigid bodies every elastic frequency goes with the root of the stiffness.
        let [_, highest] = elastic(&drawn.lumped(None, None)?)?;
        let second_moment = drawn.strip.second_moment() * (target / highest).powi(2);
        let thickness = (12.0 * second_moment / aspect).powf(0.25);
        drawn.strip.thickness = thickness;
        drawn.strip.width = aspect * thickness;
        let [depth, height] =
            [blocks.map(|b| b.depth), blocks.map(|b| b.height)].map(|[a, b]| f64::min(a, b));
        let fits = (THICKNESS[0]..THICKNESS[1]).contains(&(thickness / length))
            && thickness < 0.4 * height
            && drawn.strip.width < 0.9 * depth
            && elastic(&drawn.lumped(None, None)?)?[0] > LOWEST;
        drawn.supports = bounce.map(|bounce| {
            [0, 1].map(|block| {
                let ([omega, ratio], mass) = (bounce[block], blocks[block].mass());
                [mass * omega * omega, 2.0 * ratio * mass * omega]
            })
        });
        Ok(fits.then_some(drawn))
    }

    /// Draws where the blocks are measured, anew where they have other lengths.
    pub(super) fn place_points(&mut self, random: &mut impl Rng) {
        let [a, b] = self.blocks;
        let mut at = |block: &Block, share: [f64; 2], mirrored: bool| {
            let share = between(random, share);
            block.at(if mirrored { 1.0 - share } else { share })
        };
        self.points = [at(&a, OUTER, false), at(&a, INNER, false), at(&b, INNER, true), at(&b, OUTER, true)];
        self.apart = [at(&a, APART, false), at(&b, APART, true)];
    }

    /// The fixture without geometry at its true quantities, with the deviations that an analyst states; of
    /// the strip what is stated.
    pub(super) fn lumped(
        &self,
        stated: Option<Stated>,
        footings: Option<Footings>,
    ) -> Result<Fixture, GenerationError> {
        let [a, b] = &self.blocks;
        let strip = &self.strip;
        let point = |body: &str, x: f64| json!({ "body": body, "x": abscissa(x) });
        let [one, two, three, four] = self.points;
        let mut value = json!({
            "name": "two solid blocks on a strip",
            "bodies": { "A": a.stated(), "B": b.stated() },
            "points": {
                "1": point("A", one), "2": point("A", two), "3": point("B", three), "4": point("B", four),
                ENDS[0]: point("A", a.at(1.0)), ENDS[1]: point("B", b.left),
            },
            "joints": { "J": { "from": ENDS[0], "to": ENDS[1], "beam": {
                "youngs_modulus": known_to(strip.modulus(), 0.01), "second_moment": known_to(strip.second_moment(), 0.01) } } },
            "damping": { "modal_ratios": self.ratios.map(|ratio| known_to(ratio, RATIO_KNOWN)) },
        });
        if let Some(supports) = self.supports {
            value["supports"] = [0, 1]
                .map(|i| (["SA", "SB"][i].to_owned(), self.support(i, supports[i])))
                .into_iter()
                .collect();
        }
        if let Some(stated) = stated {
            value["physics"] = Value::Array(self.physics(stated, footings));
        }
        Ok(Fixture::from_value(&value).map_err(StructureError::from)?)
    }

    fn support(&self, block: usize, [stiffness, damping]: [f64; 2]) -> Value {
        let body = ["A", "B"][block];
        json!({
            "body": body, "x": abscissa(self.blocks[block].at(0.5)),
            "stiffness": known_to(stiffness, SUPPORT_KNOWN[0]), "damping": known_to(damping, SUPPORT_KNOWN[1]),
        })
    }

    fn physics(&self, stated: Stated, footings: Option<Footings>) -> Vec<Value> {
        let strip = &self.strip;
        let mut physics = Vec::new();
        if stated.strip_mass {
            physics.push(json!({ "kind": "joint_mass", "place": "J", "mass": known_to(strip.mass(), STRIP_MASS_KNOWN) }));
        }
        if stated.shear {
            let stiffness = cowper() * strip.modulus() / (2.0 * (1.0 + POISSON)) * strip.area();
            physics.push(
                json!({ "kind": "shear_deformation", "place": "J", "shear_stiffness": known_to(stiffness, SHEAR_KNOWN) }),
            );
        }
        if let (true, Some(footings)) = (stated.footings, footings) {
            physics.extend(ENDS.iter().zip(footings.stiffness()).map(|(point, stiffness)| {
                json!({ "kind": "interface_compliance", "place": point, "dof": "rotation", "stiffness": known_to(stiffness, FOOTING_KNOWN) })
            }));
        }
        physics
    }

    /// The solid as a fixture with geometry: true quantities, points that no fixture states, and nothing of
    /// the strip's physics.
    pub(super) fn solid(&self) -> Result<Value, GenerationError> {
        let mut value = self.lumped(None, None)?.to_value();
        for ((name, body), x) in UNSTATED.iter().zip(["A", "B"]).zip(self.apart) {
            value["points"][*name] = json!({ "body": body, "x": x });
        }
        let material = |index: usize, factor: f64| {
            let (_, modulus, density, _) = MATERIALS[index];
            json!({ "youngs_modulus": factor * modulus, "poisson_ratio": POISSON, "density": density })
        };
        let mut materials = json!({ "strip": material(self.strip.material, self.factor) });
        for block in &self.blocks {
            materials[MATERIALS[block.material].0] = material(block.material, 1.0);
        }
        let mut strip =
            json!({ "thickness": self.strip.thickness, "width": self.strip.width, "material": "strip" });
        if let Some(layer) = self.layer {
            materials["glue"] =
                json!({ "youngs_modulus": layer.modulus, "poisson_ratio": 0.35, "density": 1200 });
            strip["interfaces"] =
                json!({ ENDS[layer.end]: { "thickness": layer.thickness, "material": "glue" } });
        }
        value["geometry"] = json!({
            "materials": materials,
            "bodies": { "A": self.blocks[0].solid(), "B": self.blocks[1].solid() },
            "joints": { "J": strip },
        });
        Ok(value)
    }

    /// Whether either block's face is higher than the strip is thick, twice over.
    pub(super) fn holds_the_strip(&self) -> bool {
        self.blocks.iter().all(|block| 2.0 * self.strip.thickness < block.height)
    }

    /// Damping ratio of the modes beyond those that are listed.
    pub(super) fn last_ratio(&self) -> f64 {
        self.ratios[1]
    }

    /// One of the blocks alone, as a solid.
    pub(super) fn block_alone(&self, which: usize) -> Result<Fixture, GenerationError> {
        let (block, name) = (&self.blocks[which], ["A", "B"][which]);
        let (material, modulus, density, _) = MATERIALS[block.material];
        let value = json!({
            "bodies": { name: block.stated() },
            "points": { "1": { "body": name, "x": block.left }, "2": { "body": name, "x": block.at(1.0) } },
            "geometry": {
                "materials": { material: { "youngs_modulus": modulus, "poisson_ratio": POISSON, "density": density } },
                "bodies": { name: block.solid() },
                "joints": {},
            },
        });
        Ok(Fixture::from_value(&value).map_err(StructureError::from)?)
    }
}

/// Shear coefficient of a rectangle (Cowper, 1966).
fn cowper() -> f64 {
    10.0 * (1.0 + POISSON) / (12.0 + 11.0 * POISSON)
}
