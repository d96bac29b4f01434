//! One case of the laboratory: an assembly, what is true of it, what is hidden in it, a hammer test.

use crate::graded::scaled_to;
use crate::hammer_test::{drawn_hammer, recorded_lines, unseen_pairs};
use crate::objective::relative_error;
use crate::random::log_uniform;
use crate::{Case, GenerationError, Role, Truth};
use jointscope_fixture::{Effect, Fixture};
use jointscope_rig::{Family, Instrument, Outside, StructureError, drawn_within_tolerance, frfs};
use jointscope_spectra::FrfPair;
use rand::Rng;

/// Relative change of the recorded FRFs between which physics outside the vocabulary is drawn: it shows, and
/// leaves the assembly recognisable.
const OUTSIDE_SHOWS: [f64; 2] = [0.03, 0.8];
/// Costs Δχ² of graded effects: from what chance makes to what is plain.
const GRADED: [f64; 2] = [3.0, 300.0];

/// What a case hides, and which FRFs of it are recorded.
pub(crate) trait HiddenPhysics {
    /// The FRFs that are recorded.
    fn pairs(&self, _: &mut impl Rng, family: Family) -> Vec<FrfPair> {
        family.usual_pairs()
    }

    /// The effects to hide; `None` where the fixture has no place for them.
    fn effects(
        &self,
        random: &mut impl Rng,
        truth: &Fixture,
        pairs: &[FrfPair],
    ) -> Result<Option<Vec<Effect>>, GenerationError>;

    /// Physics outside the vocabulary, where the role asks for it; `None` where the fixture has no place for
    /// it.
    fn outside(&self, random: &mut impl Rng, truth: &Fixture, pairs: &[FrfPair]) -> Option<Outside>;

    /// By how much that may change the recorded FRFs, relative.
    fn outside_shows(&self) -> [f64; 2] {
        OUTSIDE_SHOWS
    }
}

/// A case of the laboratory that is to be drawn.
pub(crate) struct CaseDraft<H> {
    pub family: Family,
    pub role: Role,
    pub seed: u64,
    pub hidden: H,
}

impl<H: HiddenPhysics> CaseDraft<H> {
    /// A case with its truth, not numbered yet; `None` where the fixture that was drawn has no place for what
    /// is to be hidden.
    pub(crate) fn draw(&self, random: &mut impl Rng) -> Result<Option<(Case, Truth)>, GenerationError> {
        let mut believed = self.family.draw("concealed case", random)?;
        let truth = drawn_within_tolerance(&believed, random)?;
        let pairs = self.hidden.pairs(random, self.family);
        let lines = recorded_lines()?;
        let Some(effects) = self.hidden.effects(random, &truth, &pairs)? else { return Ok(None) };
        let mut truth = truth.with_physics(effects).map_err(StructureError::from)?;
        let read = |truth: &Fixture| frfs(truth, &pairs, &lines, Instrument::AsDescribed);
        let plain = match read(&truth) {
            Ok(plain) => plain,
            // Two effects that cannot be together, or a place that has gone: another draw.
            Err(_) if self.role == Role::Double => return Ok(None),
            Err(error) => return Err(error.into()),
        };
        let (mut clean, outside) = if self.role == Role::Outside {
            let Some(outside) = self.hidden.outside(random, &truth, &pairs) else { return Ok(None) };
            let stated = |fixture: Fixture| fixture.with_physics(outside.known());
            let mut without = plain;
            if !outside.known().is_empty() {
                truth = stated(truth).map_err(StructureError::from)?;
                believed = stated(believed).map_err(StructureError::from)?;
                without = read(&truth)?;
            }
            let clean = outside.frfs(&truth, &pairs, &lines, Instrument::AsDescribed)?;
            let ([least, most], change) = (self.hidden.outside_shows(), relative_error(&clean, &without));
            if !(least..=most).contains(&change) {
                return Ok(None);
            }
            (clean, Some(outside))
        } else {
            (plain, None)
        };
        let hammer = drawn_hammer(random, self.seed);
        if self.role == Role::Graded {
            let wanted = log_uniform(random, GRADED);
            let noisy = hammer.measure(&clean)?;
            let Some(scaled) = scaled_to(wanted, &believed, &truth, &noisy) else { return Ok(None) };
            clean = read(&scaled)?;
            truth = scaled;
        }
        let recorded = hammer.measure(&clean)?;
        let unseen = unseen_pairs(&truth, &pairs, random);
        let (fixture, role) = (truth, self.role);
        let (index, source, fresh) = (0, String::new(), false);
        let truth = Truth { index, source, fresh, role, fixture, outside, hammer, unseen };
        Ok(Some((Case { believed, recorded }, truth)))
    }
}
