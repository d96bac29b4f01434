//! Lumped cases of the laboratory's structures that hide one effect of a chosen set of kinds, or physics that
//! no effect is.
//!
//! The laboratory's own cases take sixteen kinds in turn, and what a seed draws of them must stay the same.
//! Kinds that came later, all flaws of the measuring chain, and more of what no fixture file describes have
//! routes of their own here.

mod hidden;
mod route;
mod same;

pub use route::LumpedRoute;

use super::by_name::Nameable;
use crate::case_draft::CaseDraft;
use crate::generate::{Draw, turn};
use crate::sealable::{Filed, Sealable};
use crate::truth::filed_pairs;
use crate::{AS_GOOD, Answer, Case, GenerationError, IndependentFits, Judgeable, Name, Role, Truth};
use hidden::OneOf;
use jointscope_fixture::{Effect, EffectKind};
use jointscope_rig::{Outside, generator};
use jointscope_spectra::FrfPair;
use rand::RngExt;
use serde_json::{Value, json};

/// Roles by case number, repeating, where something has a name.
const ROLES: [Role; 4] = [Role::Single, Role::Null, Role::Single, Role::Single];
/// Draws of a case before giving up: a table under supports needs supports.
const DRAWS: usize = 400;
/// A resonator has the frequency of a cable's resonance within this, relative.
const NEAR: f64 = 0.05;

/// What is true of a lumped case.
#[derive(Debug, Clone, PartialEq)]
pub struct LumpedTruth {
    /// What its route hides.
    pub route: LumpedRoute,
    /// The structure, and how it was measured.
    pub truth: Truth,
    /// The FRFs that were recorded.
    pub recorded: Vec<FrfPair>,
}

impl LumpedTruth {
    /// The case of a number, and apart from it what is true of it.
    pub(crate) fn draw(route: LumpedRoute, at: Draw) -> Result<(Case, Self), GenerationError> {
        let Draw { plan, index, number, source, seed } = at;
        let mut random = generator(seed);
        let (role, turn) = match route {
            LumpedRoute::UnknownPhysics => (Role::Outside, number),
            _ => (ROLES[number % ROLES.len()], turn(&ROLES, number)),
        };
        for _ in 0..DRAWS {
            let family = plan.families[random.random_range(0..plan.families.len())];
            let draft = CaseDraft { family, role, seed, hidden: OneOf { route, role, turn } };
            if let Some((case, truth)) = draft.draw(&mut random)? {
                let truth = Truth { index, source, ..truth };
                let recorded = case.recorded.pairs().to_vec();
                return Ok((case, LumpedTruth { route, truth, recorded }));
            }
        }
        Err(GenerationError::Unlucky(index))
    }
}

impl Sealable for LumpedTruth {
    fn to_value(&self) -> Value {
        let mut value = self.truth.to_value();
        value["route"] = json!(self.route.key());
        value["recorded"] = json!(self.recorded);
        value
    }
}

impl Filed for LumpedTruth {
    fn from_value(value: &Value) -> Option<Self> {
        let route = LumpedRoute::ALL.into_iter().find(|route| value["route"] == route.key())?;
        let recorded = filed_pairs(&value["recorded"]).ok()?;
        Some(LumpedTruth { route, truth: Truth::from_value(value)?, recorded })
    }
}

impl Judgeable for LumpedTruth {
    fn index(&self) -> usize {
        self.truth.index
    }

    fn role(&self) -> Role {
        self.truth.role
    }

    /// What is hidden. Beside physics without a name the fixture may state what is known of it, which is not.
    fn effects(&self) -> &[Effect] {
        if self.truth.role == Role::Outside { &[] } else { self.truth.effects() }
    }

    fn hidden(&self) -> String {
        self.truth.outside.as_ref().map_or_else(|| self.truth.hidden(), ToString::to_string)
    }

    fn independent_fits(&self, case: &Case, answer: &Answer) -> Option<IndependentFits> {
        let fits = self.truth.independent_fits(case, answer)?;
        // What is known beside physics without a name is in every fit.
        let without = if self.truth.role == Role::Outside { Vec::new() } else { fits.without };
        Some(IndependentFits { without, ..fits })
    }
}

impl Nameable for LumpedTruth {
    /// What fits alone as well as the truth; of physics without a name all that is named together.
    fn stands_for(&self, found: &Effect, fits: &IndependentFits) -> bool {
        let as_good = |objective: f64| objective <= fits.truth + AS_GOOD;
        match self.truth.role {
            Role::Single => fits.others.get(&Name::of(found)).copied().is_some_and(as_good),
            Role::Outside => as_good(fits.repaired),
            _ => false,
        }
    }

    fn is_the_same(&self, found: &Effect) -> bool {
        match self.effects() {
            [hidden] => same::is_the_same(&self.truth.fixture, &self.recorded, hidden, found),
            _ => false,
        }
    }

    /// A cable resonates as a resonator does, and holds the body as a spring to ground.
    fn is_true(&self, found: &Effect) -> bool {
        let Some(Outside::Cable { body, frequency, .. }) = &self.truth.outside else { return false };
        let resonates = |hz: f64| {
            let multiple = (hz / frequency).round().max(1.0);
            (hz / (multiple * frequency) - 1.0).abs() < NEAR
        };
        found.place.to_string() == *body
            && match found.kind {
                EffectKind::AttachedResonator => resonates(found.value(2)),
                EffectKind::Support => found.dof.is_none(),
                _ => false,
            }
    }
}
