//! Cases from a seed: random assemblies, true quantities within tolerances, hidden physics, hammer tests.

use crate::case_draft::{CaseDraft, HiddenPhysics};
use crate::random::seed_of;
use crate::workers::on_workers;
use crate::{Case, GenerationError, Role, SealedTruths, Truth};
use jointscope_fixture::{Effect, EffectKind, Fixture};
use jointscope_rig::{Family, Outside, generator, random_effect};
use jointscope_spectra::FrfPair;
use rand::{Rng, RngExt};

/// The kinds that cases hide, in the order in which seeds draw them: what a seed stands for must not change
/// when a kind is added.
pub const HIDDEN_KINDS: [EffectKind; 16] = [
    EffectKind::AddedMass,
    EffectKind::Support,
    EffectKind::AttachedResonator,
    EffectKind::BodyFlexibility,
    EffectKind::InterfaceCompliance,
    EffectKind::ShearDeformation,
    EffectKind::JointMass,
    EffectKind::StiffnessChange,
    EffectKind::LossFactor,
    EffectKind::Relaxation,
    EffectKind::PointOffset,
    EffectKind::JointLength,
    EffectKind::ChannelGain,
    EffectKind::ChannelDelay,
    EffectKind::SensorMass,
    EffectKind::ExponentialWindow,
];

/// Which cases to make.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Number of cases.
    pub cases: usize,
    /// Number of further cases, numbered after the others, of one effect each that is made just so strong as
    /// to cost a fit without it a Δχ² of 3 to 300: what the detection curve is drawn from.
    pub graded: usize,
    /// Number of cases whose recording comes from a solid, numbered after these.
    pub solid: usize,
    /// Number of cases of hits over time, numbered after these.
    pub struck: usize,
    /// Number of cases whose recording comes from a solid of which nothing is idealised, numbered after
    /// these.
    pub solid_as_is: usize,
    /// Number of cases of lumped structures with an error in every mode, numbered after these.
    pub modal_errors: usize,
    /// Number of lumped cases whose one hidden thing is a flaw of the measuring chain, numbered after these.
    pub channel_flaws: usize,
    /// Number of lumped cases whose one hidden thing is a load path beside a joint or to ground, or the
    /// footing of a joint, numbered after these.
    pub load_paths: usize,
    /// Number of lumped cases of physics that no effect of a fixture file is, small and large, numbered last.
    pub unknown_physics: usize,
    /// Seed of all but the fresh ones.
    pub seed: u64,
    /// A text (a commit's hash) that the last of the cases are drawn from, a quarter of them: cases that
    /// nobody can have tuned anything to.
    pub fresh_from: Option<String>,
    /// The one case to make; all where none is named.
    pub only: Option<usize>,
    /// Assemblies to draw from; a deformable beam, whose answers take longest, only on request.
    pub families: Vec<Family>,
}

impl Default for Plan {
    fn default() -> Self {
        let families =
            vec![Family::TwoBlocks, Family::SupportedTwoBlocks, Family::ThreeBlocks, Family::Frame];
        Plan {
            cases: 40,
            graded: 0,
            solid: 0,
            struck: 0,
            solid_as_is: 0,
            modal_errors: 0,
            channel_flaws: 0,
            load_paths: 0,
            unknown_physics: 0,
            seed: 1,
            fresh_from: None,
            only: None,
            families,
        }
    }
}

/// The families by name.
pub const FAMILIES: [(&str, Family); 5] = [
    ("two-blocks", Family::TwoBlocks),
    ("supported-two-blocks", Family::SupportedTwoBlocks),
    ("three-blocks", Family::ThreeBlocks),
    ("frame", Family::Frame),
    ("beam-and-block", Family::BeamAndBlock),
];

/// Roles by case number, repeating: a quarter nulls, half singles, an eighth each of doubles and outside
/// physics.
const ROLES: [Role; 8] = [
    Role::Single,
    Role::Null,
    Role::Single,
    Role::Double,
    Role::Single,
    Role::Null,
    Role::Single,
    Role::Outside,
];

/// Draws of a case before giving up.
pub(crate) const DRAWS: usize = 60;
impl Plan {
    /// Number of fresh cases: a quarter where there is a text to draw them from.
    pub(crate) fn fresh(&self) -> usize {
        if self.fresh_from.is_some() { self.cases.div_ceil(4) } else { 0 }
    }

    /// Makes the laboratory's cases and, sealed, their truths. A case depends on the seed (or the text) and
    /// its number alone.
    ///
    /// # Errors
    /// See [`GenerationError`].
    pub fn draw(&self) -> Result<(Vec<Case>, SealedTruths), GenerationError> {
        if self.cases + self.graded == 0 {
            return Err(GenerationError::NoCases);
        }
        let Plan { cases, graded, seed, only, .. } = *self;
        let (fresh_from, families) = (self.fresh_from.clone(), self.families.clone());
        let own = Plan { cases, graded, seed, only, fresh_from, families, ..Plan::default() };
        let (cases, truths) = self.drawn(&own.numbers()?, |index| self.case(index))?;
        Ok((cases, SealedTruths::new(truths)))
    }

    /// Number of cases of all routes.
    pub(crate) fn all(&self) -> usize {
        self.cases + self.graded + self.by_route().iter().map(|(_, count)| count).sum::<usize>()
    }

    /// The numbers of the cases to make.
    pub(crate) fn numbers(&self) -> Result<Vec<usize>, GenerationError> {
        let all = self.all();
        if all == 0 || self.families.is_empty() {
            return Err(GenerationError::NoCases);
        }
        match self.only {
            Some(only) if only >= all => Err(GenerationError::NoSuchCase { only, cases: all }),
            Some(only) => Ok(vec![only]),
            None => Ok((0..all).collect()),
        }
    }

    /// Cases and truths of some numbers, each drawn on a worker.
    pub(crate) fn drawn<C: Send, T: Send>(
        &self,
        indices: &[usize],
        draw: impl Fn(usize) -> Result<(C, T), GenerationError> + Sync,
    ) -> Result<(Vec<C>, Vec<T>), GenerationError> {
        let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let drawn = on_workers(indices, threads, |_| (), |index| draw(*index));
        let drawn = drawn.into_iter().zip(indices).map(|(drawn, index)| {
            // A worker that died over a case has left nothing of it.
            drawn.unwrap_or(Err(GenerationError::Unlucky(*index)))
        });
        Ok(drawn.collect::<Result<Vec<_>, _>>()?.into_iter().unzip())
    }

    pub(crate) fn case(&self, index: usize) -> Result<(Case, Truth), GenerationError> {
        let first_fresh = self.cases - self.fresh();
        // A fresh case counts from the first of them, so that the text alone decides what they are.
        let (source, number, fresh) = match &self.fresh_from {
            _ if index >= self.cases => (format!("seed {} graded", self.seed), index - self.cases, false),
            Some(text) if index >= first_fresh => (format!("text {text}"), index - first_fresh, true),
            _ => (format!("seed {}", self.seed), index, false),
        };
        let seed = seed_of(&source, number);
        let mut random = generator(seed);
        let role = if index >= self.cases { Role::Graded } else { ROLES[number % ROLES.len()] };
        for _ in 0..DRAWS {
            let family = self.families[random.random_range(0..self.families.len())];
            let draft = CaseDraft { family, role, seed, hidden: InTurn { role, number } };
            if let Some((case, drawn)) = draft.draw(&mut random)? {
                return Ok((case, Truth { index, source, fresh, ..drawn }));
            }
        }
        Err(GenerationError::Unlucky(index))
    }
}

/// A case that a route beside the laboratory's has to draw.
pub(crate) struct Draw<'a> {
    pub plan: &'a Plan,
    /// Its number among all cases.
    pub index: usize,
    /// Its number within the route.
    pub number: usize,
    /// What its random numbers are seeded with, in words.
    pub source: String,
    pub seed: u64,
}

impl<'a> Draw<'a> {
    /// A case of the route with a key.
    pub(crate) fn of(plan: &'a Plan, key: &str, index: usize, number: usize) -> Self {
        let source = format!("seed {} {}", plan.seed, key.replace('_', " "));
        let seed = seed_of(&source, number);
        Draw { plan, index, number, source, seed }
    }
}

/// How many cases before this one have its role, of roles that repeat.
pub(crate) fn turn<R: PartialEq>(roles: &[R], number: usize) -> usize {
    let (rounds, place) = (number / roles.len(), number % roles.len());
    let count = |of: &[R]| of.iter().filter(|role| **role == roles[place]).count();
    rounds * count(roles) + count(&roles[..place])
}

/// What the laboratory's own cases hide: the kinds in turn, by the case's number.
struct InTurn {
    role: Role,
    number: usize,
}

impl HiddenPhysics for InTurn {
    fn effects(
        &self,
        random: &mut impl Rng,
        truth: &Fixture,
        pairs: &[FrfPair],
    ) -> Result<Option<Vec<Effect>>, GenerationError> {
        let kinds = match self.role {
            Role::Null | Role::Outside => Vec::new(),
            // Singles take the kinds in turn.
            Role::Single => vec![HIDDEN_KINDS[turn(&ROLES, self.number) % HIDDEN_KINDS.len()]],
            Role::Graded => vec![HIDDEN_KINDS[self.number % HIDDEN_KINDS.len()]],
            Role::Double => {
                let first = random.random_range(0..HIDDEN_KINDS.len());
                let step = random.random_range(1..HIDDEN_KINDS.len());
                vec![HIDDEN_KINDS[first], HIDDEN_KINDS[(first + step) % HIDDEN_KINDS.len()]]
            }
        };
        let mut effects = Vec::with_capacity(kinds.len());
        for kind in kinds {
            match random_effect(random, truth, kind, pairs)? {
                Some(effect) => effects.push(effect),
                None => return Ok(None),
            }
        }
        Ok(Some(effects))
    }

    fn outside(&self, random: &mut impl Rng, truth: &Fixture, pairs: &[FrfPair]) -> Option<Outside> {
        Outside::draw(random, truth, self.number / ROLES.len(), pairs)
    }
}
