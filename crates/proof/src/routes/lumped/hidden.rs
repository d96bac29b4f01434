//! What the cases of a route hide, by kind in turn.

use super::route::LumpedRoute;
use crate::case_draft::HiddenPhysics;
use crate::{GenerationError, Role};
use jointscope_fixture::{Effect, EffectKind, Fixture, Place};
use jointscope_rig::{Family, Outside, random_effect, random_rotational_support};
use jointscope_spectra::FrfPair;
use rand::{Rng, RngExt};

/// An effect that a route hides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Hidden {
    /// A kind, wherever there is room for it.
    Of(EffectKind),
    /// A kind, on one response.
    OnResponse(EffectKind),
    /// A kind, on one reference.
    OnReference(EffectKind),
    /// A kind, on the one hammer of all references.
    OnForce(EffectKind),
    /// A rotational spring to ground.
    RotationalSupport,
}

use EffectKind::{
    Bypass, ChannelDelay, ChannelGain, ChannelHighpass, ChannelResonance, ExponentialWindow, Footing,
    ParallelStiffness, PointOffset, SensorMass, Springpot,
};
use Hidden::{Of, OnForce, OnReference, OnResponse, RotationalSupport};

/// Flaws of the measuring chain, in the order in which cases take them.
const CHANNEL_FLAWS: [Hidden; 15] = [
    OnResponse(ChannelGain),
    OnForce(ChannelDelay),
    OnReference(ChannelHighpass),
    OnResponse(ChannelResonance),
    Of(SensorMass),
    OnForce(ChannelGain),
    OnReference(ChannelDelay),
    OnResponse(ChannelHighpass),
    OnForce(ChannelResonance),
    Of(ExponentialWindow),
    OnReference(ChannelGain),
    OnResponse(ChannelDelay),
    OnForce(ChannelHighpass),
    OnReference(ChannelResonance),
    Of(PointOffset),
];

/// Load paths beside a joint and to ground, and what a joint stands on, in the order in which cases take
/// them.
const LOAD_PATHS: [Hidden; 5] =
    [Of(ParallelStiffness), Of(Footing), Of(Bypass), Of(Springpot), RotationalSupport];

/// Relative change of the recorded FRFs between which physics without a name is drawn: from what nobody could
/// see to what leaves the assembly recognisable.
const SHOWS: [f64; 2] = [1e-4, 0.8];
/// Draws of a flaw until it falls on the side of the chain that is wanted.
const DRAWS: usize = 60;
/// Shares of the tests of channels that strike one point only, or read one only: there an equal flaw
/// elsewhere is the same thing.
const ONE_SIDED: f64 = 0.2;

/// One of the things that a route hides, in turn.
pub(super) struct OneOf {
    pub route: LumpedRoute,
    pub role: Role,
    pub turn: usize,
}

impl HiddenPhysics for OneOf {
    fn pairs(&self, random: &mut impl Rng, family: Family) -> Vec<FrfPair> {
        let mut pairs = family.usual_pairs();
        if self.route == LumpedRoute::ChannelFlaws {
            let (first, chance) = (pairs[0].clone(), random.random_range(0.0..1.0));
            pairs.retain(|pair| match chance {
                c if c < ONE_SIDED => pair.reference == first.reference,
                c if c < 2.0 * ONE_SIDED => pair.response == first.response,
                _ => true,
            });
        }
        pairs
    }

    fn effects(
        &self,
        random: &mut impl Rng,
        truth: &Fixture,
        pairs: &[FrfPair],
    ) -> Result<Option<Vec<Effect>>, GenerationError> {
        let hidden = match (self.role, self.route) {
            (Role::Single, LumpedRoute::ChannelFlaws) => CHANNEL_FLAWS[self.turn % CHANNEL_FLAWS.len()],
            (Role::Single, LumpedRoute::LoadPaths) => LOAD_PATHS[self.turn % LOAD_PATHS.len()],
            _ => return Ok(Some(Vec::new())),
        };
        Ok(hidden.draw(random, truth, pairs)?.map(|effect| vec![effect]))
    }

    fn outside(&self, random: &mut impl Rng, truth: &Fixture, pairs: &[FrfPair]) -> Option<Outside> {
        let kind = Outside::UNLISTED[self.turn % Outside::UNLISTED.len()];
        Outside::draw_kind(random, truth, kind, pairs)
    }

    fn outside_shows(&self) -> [f64; 2] {
        SHOWS
    }
}

impl Hidden {
    fn draw(
        self,
        random: &mut impl Rng,
        truth: &Fixture,
        pairs: &[FrfPair],
    ) -> Result<Option<Effect>, GenerationError> {
        let kind = match self {
            RotationalSupport => return Ok(random_rotational_support(random, truth)),
            Of(kind) | OnResponse(kind) | OnReference(kind) | OnForce(kind) => kind,
        };
        for _ in 0..DRAWS {
            let Some(effect) = random_effect(random, truth, kind, pairs)? else { return Ok(None) };
            match (self, &effect.place) {
                (OnForce(_), _) => return Ok(Some(Effect { place: Place::Force, ..effect })),
                (OnResponse(_), Place::Response(_)) | (OnReference(_), Place::Reference(_)) | (Of(_), _) => {
                    return Ok(Some(effect));
                }
                _ => {}
            }
        }
        Ok(None)
    }
}
