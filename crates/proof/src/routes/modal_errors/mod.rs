//! Lumped structures that are a little wrong in every mode.
//!
//! The laboratory's structures are what their fixtures say, but for what is hidden. Here every natural
//! frequency, damping ratio and shape of the true structure has an error of its own besides, as real
//! structures have, and the hammer test is quiet enough for that to matter.

use super::by_name::Nameable;
use super::quiet::quiet_hammer;
use crate::generate::{DRAWS, Draw, HIDDEN_KINDS, turn};
use crate::hammer_test::{recorded_lines, unseen_pairs};
use crate::judge::Judge;
use crate::judged::error_on;
use crate::laboratory::others;
use crate::random::log_uniform;
use crate::sealable::{Filed, Sealable};
use crate::{AS_GOOD, Answer, Case, GenerationError, IndependentFits, Judgeable, Judged, Name, Role, Truth};
use jointscope_fixture::{Effect, Fixture};
use jointscope_rig::{
    Instrument, ModalErrors, StructureError, UsualErrors, drawn_within_tolerance, generator, random_effect,
};
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};
use rand::RngExt;
use serde::Deserialize;
use serde_json::{Value, json};

/// Roles by case number, repeating.
const ROLES: [Role; 4] = [Role::Single, Role::Null, Role::Single, Role::Single];
/// Usual errors of a case's modes, relative: of natural frequencies, damping ratios, and shapes.
const FREQUENCY: [f64; 2] = [0.0005, 0.005];
const DAMPING: [f64; 2] = [0.01, 0.1];
const SHAPE: [f64; 2] = [0.001, 0.01];
/// How many times as large as with it χ² must be without what is hidden for that to show: the model's error
/// is then three times as large.
const SHOWS: f64 = 10.0;

/// What is true of a case with errors in its modes.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalErrorsTruth {
    /// The structure without them, and how it was measured.
    pub truth: Truth,
    /// The errors.
    pub errors: ModalErrors,
}

impl ModalErrorsTruth {
    /// The case of a number, and apart from it what is true of it.
    pub(crate) fn draw(at: Draw) -> Result<(Case, Self), GenerationError> {
        let Draw { plan, index, number, source, seed } = at;
        let mut random = generator(seed);
        let role = ROLES[number % ROLES.len()];
        for _ in 0..DRAWS {
            let family = plan.families[random.random_range(0..plan.families.len())];
            let believed = family.draw("concealed case", &mut random)?;
            let fixture = drawn_within_tolerance(&believed, &mut random)?;
            let pairs = family.usual_pairs();
            let effects = match role {
                Role::Single => {
                    let kind = HIDDEN_KINDS[turn(&ROLES, number) % HIDDEN_KINDS.len()];
                    let Some(effect) = random_effect(&mut random, &fixture, kind, &pairs)? else { continue };
                    vec![effect]
                }
                _ => Vec::new(),
            };
            let fixture = fixture.with_physics(effects).map_err(StructureError::from)?;
            let usual = UsualErrors {
                frequency: log_uniform(&mut random, FREQUENCY),
                damping: log_uniform(&mut random, DAMPING),
                shape: log_uniform(&mut random, SHAPE),
            };
            let errors = match ModalErrors::draw(&mut random, &fixture, &usual) {
                Ok(errors) => errors,
                // More negative mass than there is: another draw.
                Err(StructureError::Modes(_)) => continue,
                Err(error) => return Err(error.into()),
            };
            let clean = errors.frfs(&fixture, &pairs, &recorded_lines()?, Instrument::AsDescribed)?;
            let hammer = quiet_hammer(&mut random, seed);
            let recorded = hammer.measure(&clean)?;
            let unseen = unseen_pairs(&fixture, &pairs, &mut random);
            let (fresh, outside) = (false, None);
            let truth = Truth { index, source, fresh, role, fixture, outside, hammer, unseen };
            return Ok((Case { believed, recorded }, ModalErrorsTruth { truth, errors }));
        }
        Err(GenerationError::Unlucky(index))
    }

    /// Noise-free accelerances of the structure with the errors of its modes.
    ///
    /// # Errors
    /// As [`ModalErrors::frfs`].
    pub fn frfs(
        &self,
        pairs: &[FrfPair],
        lines: &SpectralLines,
        instrument: Instrument,
    ) -> Result<FrfSet, StructureError> {
        self.errors.frfs(&self.truth.fixture, pairs, lines, instrument)
    }
}

impl Sealable for ModalErrorsTruth {
    fn to_value(&self) -> Value {
        let mut value = self.truth.to_value();
        value["route"] = json!("modal_errors");
        value["errors"] = json!(self.errors);
        value
    }
}

impl Filed for ModalErrorsTruth {
    fn from_value(value: &Value) -> Option<Self> {
        let errors = ModalErrors::deserialize(&value["errors"]).ok()?;
        Some(ModalErrorsTruth { truth: Truth::from_value(value)?, errors })
    }
}

impl Judgeable for ModalErrorsTruth {
    fn index(&self) -> usize {
        self.truth.index
    }

    fn role(&self) -> Role {
        self.truth.role
    }

    fn effects(&self) -> &[Effect] {
        self.truth.effects()
    }

    fn independent_fits(&self, case: &Case, answer: &Answer) -> Option<IndependentFits> {
        let judge = Judge::of(case)?;
        let lines = recorded_lines().ok()?;
        let unseen = self.frfs(&self.truth.unseen, &lines, Instrument::Perfect).ok()?;
        let error = |fixture: &Fixture| error_on(&unseen, fixture);
        let own = IndependentFits::of_answer(&judge, answer)?;
        Some(IndependentFits {
            truth: judge.best(&self.truth.fixture)?.objective,
            without: judge.without_each(&self.truth.fixture),
            others: others(&self.truth, answer, own.repaired, &judge),
            unseen: error(&answer.refitted).zip(error(&answer.repaired)).map(Into::into),
            values: 2 * judge.observation.values().len(),
            ..own
        })
    }
}

impl Nameable for ModalErrorsTruth {
    /// What fits alone as well as the truth: within what chance makes, χ² per degree of freedom being what
    /// the errors make it.
    fn stands_for(&self, found: &Effect, fits: &IndependentFits) -> bool {
        let inflation = (fits.truth / fits.values.max(1) as f64).max(1.0);
        let as_good = |objective: &f64| *objective <= fits.truth + AS_GOOD * inflation;
        self.role() == Role::Single && fits.others.get(&Name::of(found)).is_some_and(as_good)
    }

    fn shows(judged: &Judged<Self>) -> bool {
        judged.is_visible() && judged.size() >= (SHOWS - 1.0) * judged.fits.truth
    }
}
