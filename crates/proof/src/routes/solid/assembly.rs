//! Two solid blocks on a strip, random, and the lumped fixture that says the same of them.

use crate::GenerationError;
use crate::random::{between, log_uniform};
use jointscope_fixture::Fixture;
use jointscope_rig::{Structure, StructureError};
use rand::{Rng, RngExt};
use serde_json::{Value, json};

/// Materials of blocks and strips: name, Young's modulus (N/m²), density (kg/m³), shear modulus along the
/// grain (N/m²).
pub(in crate::routes) const MATERIALS: [(&str, f64, f64, f64); 5] = [
    ("steel", 2.07e11, 7850.0, 8.0e10),
    ("aluminium", 7.0e10, 2700.0, 2.6e10),
    ("brass", 1.0e11, 8500.0, 3.7e10),
    ("carbon fibre in epoxy", 1.3e11, 1600.0, 4.5e9),
    ("glass fibre in epoxy", 4.0e10, 1900.0, 3.5e9),
];
/// How many of them are metals, of which blocks are made.
pub(in crate::routes) const METALS: usize = 3;
pub(in crate::routes) const POISSON: f64 = 0.3;

/// Mass of a block, kg, and its length and height over the edge of a cube of that mass.
const MASS: [f64; 2] = [0.3, 6.0];
const LENGTH: [f64; 2] = [1.0, 1.6];
const HEIGHT: [f64; 2] = [0.7, 1.0];
/// Free length of the strip, m.
pub(in crate::routes) const GAP: [f64; 2] = [0.03, 0.09];
/// The highest elastic mode of the lumped fixture, Hz, and the lowest that a test still resolves.
pub(in crate::routes) const HIGHEST: [f64; 2] = [350.0, 900.0];
pub(in crate::routes) const LOWEST: f64 = 15.0;
/// Damping ratio of the lower elastic mode.
const RATIO: [f64; 2] = [0.004, 0.015];

/// What the strip is to be like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum StripShape {
    /// A metal strip, slender enough that its bending is what counts.
    Slender,
    /// Thick against its length, of any material.
    Thick,
}

/// A strip of rectangular section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::routes) struct Strip {
    /// Index of its material.
    pub material: usize,
    /// Free length, m.
    pub length: f64,
    /// Across the plane of motion, m.
    pub width: f64,
    /// In the plane of motion, m.
    pub thickness: f64,
}

impl Strip {
    pub(crate) fn modulus(&self) -> f64 {
        MATERIALS[self.material].1
    }

    pub(crate) fn shear_modulus(&self) -> f64 {
        MATERIALS[self.material].3
    }

    pub(crate) fn area(&self) -> f64 {
        self.width * self.thickness
    }

    pub(crate) fn second_moment(&self) -> f64 {
        self.width * self.thickness.powi(3) / 12.0
    }

    pub(crate) fn mass(&self) -> f64 {
        MATERIALS[self.material].2 * self.area() * self.length
    }
}

/// A block: where it begins, and its edges, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::routes) struct Block {
    /// Index of its material.
    pub material: usize,
    /// Where it begins, m.
    pub left: f64,
    pub length: f64,
    pub height: f64,
    pub depth: f64,
}

impl Block {
    pub(crate) fn draw(random: &mut impl Rng, left: f64) -> Self {
        let material = random.random_range(0..METALS);
        let volume = log_uniform(random, MASS) / MATERIALS[material].2;
        let edge = volume.cbrt();
        let (length, height) = (edge * between(random, LENGTH), edge * between(random, HEIGHT));
        Block { material, left, length, height, depth: volume / (length * height) }
    }

    pub(crate) fn mass(&self) -> f64 {
        MATERIALS[self.material].2 * self.length * self.height * self.depth
    }

    pub(crate) fn at(&self, share: f64) -> f64 {
        self.left + share * self.length
    }

    pub(crate) fn stated(&self) -> Value {
        let inertia = self.mass() * (self.length.powi(2) + self.height.powi(2)) / 12.0;
        json!({ "mass": known_to(self.mass(), 0.001), "inertia": known_to(inertia, 0.005), "x_cg": abscissa(self.at(0.5)) })
    }

    pub(crate) fn solid(&self) -> Value {
        json!({
            "from": self.left, "to": self.left + self.length, "height": self.height, "depth": self.depth,
            "material": MATERIALS[self.material].0,
        })
    }
}

/// The assembly: blocks A and B, the strip from point 2 on A to point 3 on B.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Assembly {
    blocks: [Block; 2],
    pub strip: Strip,
    /// The lumped fixture at its true quantities, with the deviations that an analyst states.
    pub lumped: Fixture,
}

impl Assembly {
    /// `None` where what was drawn has no strip of sensible dimensions.
    pub(super) fn draw(random: &mut impl Rng, shape: StripShape) -> Result<Option<Self>, GenerationError> {
        let mut a = Block::draw(random, 0.0);
        a.left = -a.length;
        let length = between(random, GAP);
        let b = Block::draw(random, length);
        let blocks = [a, b];
        let material = match shape {
            StripShape::Slender => random.random_range(0..METALS),
            StripShape::Thick => random.random_range(0..MATERIALS.len()),
        };
        let ends = [a.at(between(random, [0.05, 0.3])), b.at(between(random, [0.6, 0.95]))];
        let ratio = log_uniform(random, RATIO);
        let proportion = between(random, [0.0, 1.0]);
        let target = log_uniform(random, HIGHEST);
        let modulus = MATERIALS[material].1;
        let lumped = |second_moment, ratios| statement(&blocks, ends, modulus, second_moment, ratios);
        // In a free assembly of rigid bodies every elastic frequency goes with the root of the stiffness.
        const TRIED: f64 = 1e-10;
        let [lowest, highest] = elastic(&lumped(TRIED, [ratio; 2])?)?;
        let second_moment = TRIED * (target / highest).powi(2);
        let depth = a.depth.min(b.depth);
        let height = a.height.min(b.height);
        let (width, thickness) = match shape {
            StripShape::Slender => {
                let width = depth * (0.25 + 0.55 * proportion);
                (width, (12.0 * second_moment / width).cbrt())
            }
            StripShape::Thick => {
                let thickness = length * (0.15 + 0.25 * proportion);
                (12.0 * second_moment / thickness.powi(3), thickness)
            }
        };
        let thick = shape == StripShape::Thick || thickness < 0.2 * length;
        // ζω alike: a matrix proportional to the blocks' masses, which couples no modes whatever yields
        // between them.
        let lumped = lumped(second_moment, [ratio, ratio * lowest / highest])?;
        if !(thick
            && thickness < 0.5 * height
            && width > 0.004
            && width < 0.9 * depth
            && elastic(&lumped)?[0] > LOWEST)
        {
            return Ok(None);
        }
        let strip = Strip { material, length, width, thickness };
        Ok(Some(Assembly { blocks, strip, lumped }))
    }

    /// Whether an abscissa lies on the block of this name.
    pub(super) fn is_on(&self, block: &str, x: f64) -> bool {
        let block = &self.blocks[usize::from(block != "A")];
        (block.left..=block.left + block.length).contains(&x)
    }

    /// Abscissae for points that nobody measures at, one on each block.
    pub(super) fn apart(&self, random: &mut impl Rng) -> [f64; 2] {
        [self.blocks[0].at(between(random, [0.4, 0.8])), self.blocks[1].at(between(random, [0.1, 0.5]))]
    }

    /// The `geometry` of the solid; `layer` is one end (0 or 1) of the strip, the layer's thickness (m) and
    /// Young's modulus (N/m²).
    pub(super) fn geometry(&self, layer: Option<(usize, f64, f64)>) -> Value {
        let material = |(name, modulus, density, _): &(&str, f64, f64, f64)| {
            (
                (*name).to_owned(),
                json!({ "youngs_modulus": modulus, "poisson_ratio": POISSON, "density": density }),
            )
        };
        let used = |(index, _): &(usize, _)| {
            *index == self.strip.material || self.blocks.iter().any(|block| block.material == *index)
        };
        let mut materials: serde_json::Map<String, Value> =
            MATERIALS.iter().enumerate().filter(used).map(|(_, entry)| material(entry)).collect();
        let mut strip = json!({
            "thickness": self.strip.thickness, "width": self.strip.width, "material": MATERIALS[self.strip.material].0,
        });
        if let Some((end, thickness, modulus)) = layer {
            materials.insert(
                "layer".into(),
                json!({ "youngs_modulus": modulus, "poisson_ratio": POISSON, "density": 1200 }),
            );
            let point = ["2", "3"][end];
            strip["interfaces"] = json!({ point: { "thickness": thickness, "material": "layer" } });
        }
        json!({
            "materials": materials,
            "bodies": { "A": self.blocks[0].solid(), "B": self.blocks[1].solid() },
            "joints": { "J": strip },
        })
    }
}

fn statement(
    blocks: &[Block; 2],
    ends: [f64; 2],
    modulus: f64,
    second_moment: f64,
    ratios: [f64; 2],
) -> Result<Fixture, GenerationError> {
    let [a, b] = blocks;
    let point = |body: &str, x: f64| json!({ "body": body, "x": abscissa(x) });
    let statement = json!({
        "name": "two solid blocks on a strip",
        "bodies": { "A": a.stated(), "B": b.stated() },
        "points": { "1": point("A", ends[0]), "2": point("A", a.at(1.0)), "3": point("B", b.left), "4": point("B", ends[1]) },
        "joints": { "J": { "from": "2", "to": "3", "beam": {
            "youngs_modulus": known_to(modulus, 0.005), "second_moment": known_to(second_moment, 0.005) } } },
        "damping": { "modal_ratios": ratios.map(|ratio| known_to(ratio, 0.15)) },
    });
    Ok(Fixture::from_value(&statement).map_err(StructureError::from)?)
}

/// Lowest and highest elastic frequency of a lumped fixture, Hz.
pub(in crate::routes) fn elastic(fixture: &Fixture) -> Result<[f64; 2], GenerationError> {
    let modes = Structure::of(fixture)?.natural_frequencies()?;
    // Two rigid motions, two elastic modes.
    let at = |from_the_top: usize| modes.len().checked_sub(from_the_top).and_then(|i| modes.get(i)).copied();
    Ok([at(2).unwrap_or(0.0), at(1).unwrap_or(1.0)])
}

/// A quantity known to a share of itself.
pub(in crate::routes) fn known_to(value: f64, share: f64) -> Value {
    json!({ "value": value, "std": share * value.abs() })
}

/// An abscissa, known to a tenth of a millimetre.
pub(in crate::routes) fn abscissa(x: f64) -> Value {
    json!({ "value": x, "std": 1e-4 })
}
