//! What can be hidden in a solid as it is, or in the chain that measures it.

use super::assembly::{Assembly, Layer};
use crate::random::{between, log_uniform};
use jointscope_fixture::{Dof, Effect, EffectKind, Place};
use rand::{Rng, RngExt};
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// What is hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Concealed {
    /// A mass on a block.
    Mass,
    /// A spring to ground under a block.
    Ground,
    /// A channel that is late.
    Delay,
    /// A strip of another modulus.
    Modulus,
    /// A layer of glue at one end.
    Glue,
    /// A block so long and flat that it bends.
    Bending,
    /// A channel's calibration.
    Gain,
}

/// Singles take these in turn.
pub(super) const CONCEALED: [Concealed; 7] = [
    Concealed::Mass,
    Concealed::Ground,
    Concealed::Delay,
    Concealed::Modulus,
    Concealed::Glue,
    Concealed::Bending,
    Concealed::Gain,
];

/// A mass against its block's, and the shares of the block's length where it sits.
const MASS: [f64; 2] = [0.03, 0.08];
const ON_BLOCK: [f64; 2] = [0.1, 0.9];
/// Frequency of a block alone on the spring, Hz, and its damping ratio.
const GROUND: [f64; 2] = [25.0, 80.0];
const GROUND_RATIO: [f64; 2] = [0.005, 0.03];
/// A channel's delay, s.
const DELAY: [f64; 2] = [5e-6, 5e-5];
/// Logarithms of the factors of a strip's stiffness and of a channel's gain, of either sign.
const MODULUS: [f64; 2] = [0.08, 0.2];
const GAIN: [f64; 2] = [0.03, 0.3];
/// Young's modulus of glue, N/m², and the thicknesses of its layers, m.
const GLUE: [f64; 2] = [1e9, 5e9];
const LAYER: [f64; 2] = [1e-4, 5e-4];
/// Length of a block that bends over its height, at the same mass and depth.
const SLENDER: [f64; 2] = [7.0, 12.0];

impl Concealed {
    /// Conceals it where the assembly is changed by it; the effect that says the same follows from
    /// [`Concealed::effect`].
    pub(super) fn within(self, mut assembly: Assembly, random: &mut impl Rng) -> Assembly {
        match self {
            Concealed::Modulus => {
                assembly.factor = (sign(random) * between(random, MODULUS)).exp();
            }
            Concealed::Glue => {
                let end = random.random_range(0..2);
                let (thickness, modulus) = (log_uniform(random, LAYER), log_uniform(random, GLUE));
                assembly.layer = Some(Layer { end, thickness, modulus });
            }
            Concealed::Bending => {
                let block = &mut assembly.blocks[1];
                let (area, slender) = (block.length * block.height, between(random, SLENDER));
                block.length = (area * slender).sqrt();
                block.height = area / block.length;
                assembly.place_points(random);
            }
            _ => {}
        }
        assembly
    }

    /// The effect that says the same; sizes that only the solid itself tells are `found`.
    pub(super) fn effect(self, assembly: &Assembly, found: Size, random: &mut impl Rng) -> Effect {
        let which = random.random_range(0..2);
        let block = &assembly.blocks[which];
        let body = Place::Body(["A", "B"][which].to_owned());
        let x = block.at(between(random, ON_BLOCK));
        match self {
            Concealed::Mass => {
                let mass = log_uniform(random, MASS) * block.mass();
                Effect::new(EffectKind::AddedMass, body, None, &[x, mass])
            }
            Concealed::Ground => {
                let (omega, ratio) = (TAU * log_uniform(random, GROUND), between(random, GROUND_RATIO));
                let values = [x, block.mass() * omega * omega, 2.0 * ratio * block.mass() * omega];
                Effect::new(EffectKind::Support, body, None, &values)
            }
            Concealed::Delay => {
                let seconds = sign(random) * log_uniform(random, DELAY);
                Effect::new(EffectKind::ChannelDelay, channel(random), None, &[seconds])
            }
            Concealed::Gain => {
                let factor = (sign(random) * log_uniform(random, GAIN)).exp();
                Effect::new(EffectKind::ChannelGain, channel(random), None, &[factor])
            }
            Concealed::Modulus => Effect::new(
                EffectKind::StiffnessChange,
                Place::Joint("J".to_owned()),
                None,
                &[assembly.factor],
            ),
            Concealed::Glue => {
                let end = assembly.layer.map_or(0, |layer| layer.end);
                let place = Place::Point(super::assembly::ENDS[end].to_owned());
                let values = [found.layer_stiffness, 0.0];
                Effect::new(EffectKind::InterfaceCompliance, place, Some(Dof::Rotation), &values)
            }
            Concealed::Bending => {
                let values = [found.first_bending[1], assembly.last_ratio()];
                Effect::new(EffectKind::BodyFlexibility, Place::Body("B".to_owned()), None, &values)
            }
        }
    }
}

/// Sizes that only the solid tells.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Size {
    /// Rotational stiffness of the layer, N·m/rad.
    pub layer_stiffness: f64,
    /// First bending of either block alone, Hz.
    pub first_bending: [f64; 2],
}

/// Mounts an effect on the solid's fixture.
pub(super) fn mount(solid: &mut Value, effect: &Effect) {
    let Place::Body(body) = &effect.place else { return };
    match effect.kind {
        EffectKind::AddedMass => {
            solid["bodies"][body.as_str()]["masses"] =
                json!([{ "x": effect.value(0), "mass": effect.value(1) }]);
        }
        EffectKind::Support => {
            if solid["supports"].is_null() {
                solid["supports"] = json!({});
            }
            solid["supports"]["ground"] = json!({
                "body": body, "x": effect.value(0), "stiffness": effect.value(1), "damping": effect.value(2) });
        }
        _ => {}
    }
}

fn sign(random: &mut impl Rng) -> f64 {
    if random.random_range(0..2) == 0 { 1.0 } else { -1.0 }
}

/// A response or a reference.
fn channel(random: &mut impl Rng) -> Place {
    let (side, which) = (random.random_range(0..2), random.random_range(0..2));
    let points = [["3", "4"], ["1", "2"]];
    let name = points[side][which].to_owned();
    if side == 0 { Place::Response(name) } else { Place::Reference(name) }
}
