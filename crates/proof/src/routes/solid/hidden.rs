//! What a solid has that its lumped fixture leaves out, with the effect that says the same in closed form.

use super::assembly::{Assembly, StripShape};
use super::twin::Shown;
use crate::GenerationError;
use crate::random::log_uniform;
use jointscope_fixture::{Dof, Effect, EffectKind, Place};
use jointscope_rig::random_effect;
use jointscope_spectra::FrfPair;
use rand::{Rng, RngExt};

/// What can be concealed in a solid or in the chain that measures it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Concealed {
    /// The strip's mass.
    StripMass,
    /// A layer of glue at one end, as stiff in shear as its modulus makes it.
    Layer,
    /// A layer that gives way in shear alone.
    Sliding,
    /// The strip's shear.
    StripShear,
    /// A mass on a block, a support under it, or a slip of the measuring chain.
    Ordinary(EffectKind),
}

/// Singles take these in turn.
pub(super) const CONCEALED: [Concealed; 9] = [
    Concealed::StripMass,
    Concealed::Layer,
    Concealed::StripShear,
    Concealed::Ordinary(EffectKind::AddedMass),
    Concealed::Sliding,
    Concealed::Ordinary(EffectKind::Support),
    Concealed::Ordinary(EffectKind::ChannelGain),
    Concealed::Ordinary(EffectKind::PointOffset),
    Concealed::Ordinary(EffectKind::ChannelDelay),
];
/// How many of them are in the solid itself: one of two concealed things always is.
pub(super) const IN_THE_SOLID: usize = 5;

/// Young's modulus of glue, N/m², and the stiffness of its layer against the strip's rotational stiffness at
/// that end.
const GLUE: [f64; 2] = [1e9, 8e9];
const AGAINST_ROTATION: [f64; 2] = [1.0, 20.0];
/// Poisson's ratio is switched off in layers.
const SHEAR_OF_YOUNG: f64 = 0.5;
/// Thicknesses of layers, m.
const THICKNESS: [f64; 2] = [5e-5, 1e-3];
/// Stiffness of a sliding layer against the strip's transverse one.
const AGAINST_TRANSLATION: [f64; 2] = [0.5, 20.0];
/// Shear coefficient of a rectangle without Poisson's ratio.
const COEFFICIENT: f64 = 5.0 / 6.0;

impl Concealed {
    pub(super) fn shape(self) -> StripShape {
        if self == Concealed::StripShear { StripShape::Thick } else { StripShape::Slender }
    }
}

/// A layer at one end of the strip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Layer {
    /// 0 at point 2, 1 at point 3.
    pub end: usize,
    pub thickness: f64,
    pub modulus: f64,
}

/// What is concealed in a solid.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Hidden {
    pub shown: Shown,
    pub layer: Option<Layer>,
    /// The effects that say the same: what is asked for.
    pub effects: Vec<Effect>,
    /// Effects that come with them.
    pub besides: Vec<Effect>,
}

impl Hidden {
    /// Conceals one thing more; `None` where there is no place for it.
    pub(super) fn conceal(
        mut self,
        what: Concealed,
        assembly: &Assembly,
        pairs: &[FrfPair],
        random: &mut impl Rng,
    ) -> Result<Option<Self>, GenerationError> {
        let strip = &assembly.strip;
        let joint = || Place::Joint("J".to_owned());
        let bending = strip.modulus() * strip.second_moment();
        let effect = match what {
            Concealed::StripMass => {
                self.shown.strip_mass = true;
                Effect::new(EffectKind::JointMass, joint(), None, &[strip.mass()])
            }
            Concealed::StripShear => {
                self.shown.strip_shear = Some(strip.shear_modulus());
                let stiffness = COEFFICIENT * strip.shear_modulus() * strip.area();
                Effect::new(EffectKind::ShearDeformation, joint(), None, &[stiffness, 0.0])
            }
            Concealed::Layer | Concealed::Sliding if self.layer.is_some() => return Ok(None),
            Concealed::Layer => {
                let end = random.random_range(0..2);
                let modulus = log_uniform(random, GLUE);
                let wanted = log_uniform(random, AGAINST_ROTATION) * 4.0 * bending / strip.length;
                // The layer takes its thickness from the strip: only what it yields more than that counts.
                let excess = 1.0 / modulus - 1.0 / strip.modulus();
                let thickness = strip.second_moment() / (wanted * excess);
                let shear = SHEAR_OF_YOUNG * modulus;
                self.layer = Some(Layer { end, thickness, modulus });
                self.shown.layer_shear = Some(shear);
                self.besides.push(interface(end, Dof::Translation, shear * strip.area() / thickness));
                interface(end, Dof::Rotation, wanted)
            }
            Concealed::Sliding => {
                let end = random.random_range(0..2);
                let wanted = log_uniform(random, AGAINST_TRANSLATION) * 12.0 * bending / strip.length.powi(3);
                let thickness = log_uniform(random, THICKNESS);
                self.layer = Some(Layer { end, thickness, modulus: strip.modulus() });
                self.shown.layer_shear = Some(wanted * thickness / strip.area());
                interface(end, Dof::Translation, wanted)
            }
            Concealed::Ordinary(kind) => {
                let Some(effect) = random_effect(random, &assembly.lumped, kind, pairs)? else {
                    return Ok(None);
                };
                if !fits(&effect, assembly) {
                    return Ok(None);
                }
                effect
            }
        };
        let thin = |layer: &Layer| (THICKNESS[0]..THICKNESS[1]).contains(&layer.thickness);
        if !self.layer.as_ref().is_none_or(thin) {
            return Ok(None);
        }
        self.effects.push(effect);
        Ok(Some(self))
    }
}

fn interface(end: usize, dof: Dof, stiffness: f64) -> Effect {
    let place = Place::Point(["2", "3"][end].to_owned());
    Effect::new(EffectKind::InterfaceCompliance, place, Some(dof), &[stiffness, 0.0])
}

/// Whether what is mounted lies on its block.
fn fits(effect: &Effect, assembly: &Assembly) -> bool {
    match (&effect.place, effect.kind) {
        // Mass that is not there is nothing that a solid could have.
        (Place::Body(_), EffectKind::AddedMass) if effect.value(1) < 0.0 => false,
        (Place::Body(body), _) => assembly.is_on(body, effect.value(0)),
        (Place::Point(name), EffectKind::PointOffset) => {
            let point = assembly.lumped.point(name);
            point.is_some_and(|point| {
                let body = &assembly.lumped.bodies()[point.body].name;
                assembly.is_on(body, point.x.value + effect.value(0))
            })
        }
        _ => true,
    }
}
