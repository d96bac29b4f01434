//! Which cases are made of a recording and the fixture that explains it.

use super::base_test::BaseTest;
use super::{Concealed, ConcealmentError, ConcealmentKind};
use crate::generate::DRAWS;
use crate::random::seed_of;
use crate::{Case, SealedTruths};
use jointscope_fixture::Fixture;
use jointscope_rig::{drawn_within_tolerance, generator};
use jointscope_spectra::FrfSet;
use rand::seq::SliceRandom;

/// Which concealments to make.
#[derive(Debug, Clone, PartialEq)]
pub struct ConcealmentPlan {
    /// Number of cases, controls among them.
    pub cases: usize,
    /// Seed of places and sizes.
    pub seed: u64,
    /// The one case to make besides the first control; all where none is named.
    pub only: Option<usize>,
    /// The kinds to draw from, as far as fixture and recording have room for them.
    pub kinds: Vec<ConcealmentKind>,
}

impl Default for ConcealmentPlan {
    fn default() -> Self {
        ConcealmentPlan { cases: 8, seed: 1, only: None, kinds: ConcealmentKind::ALL.to_vec() }
    }
}

/// Of so many cases the first is a control.
const CONTROLS: usize = 4;

impl ConcealmentPlan {
    /// Whether the plan has cases, and the one asked for.
    ///
    /// # Errors
    /// [`ConcealmentError::TooFew`], [`ConcealmentError::NoSuchCase`].
    pub fn check(&self) -> Result<(), ConcealmentError> {
        match self.only {
            _ if self.cases < 2 => Err(ConcealmentError::TooFew(self.cases)),
            Some(only) if only >= self.cases => Err(ConcealmentError::NoSuchCase { only, cases: self.cases }),
            _ => Ok(()),
        }
    }

    /// Makes the cases and, sealed, their truths. Case 0 is fixture and recording as they are. Every fourth
    /// case after it is a control too, in which the fixture's quantities are stated anew, drawn from the
    /// normal distributions that it states for them. In all others something is concealed, the kinds in turn,
    /// in an order that the seed decides. A case depends on seed, number and the kinds alone.
    ///
    /// # Errors
    /// See [`ConcealmentError`].
    pub fn conceal(
        &self,
        explaining: &Fixture,
        recorded: &FrfSet,
    ) -> Result<(Vec<Case>, SealedTruths<Concealed>), ConcealmentError> {
        self.check()?;
        let indices: Vec<usize> = match self.only {
            Some(0) => vec![0],
            Some(only) => vec![0, only],
            None => (0..self.cases).collect(),
        };
        let base = BaseTest { explaining, recorded };
        let kinds = self.kinds_in_turn(&base)?;
        let mut cases = Vec::with_capacity(indices.len());
        let mut truths = Vec::with_capacity(indices.len());
        for index in indices {
            let (case, truth) = self.case(index, &kinds, &base)?;
            cases.push(case);
            truths.push(truth);
        }
        Ok((cases, SealedTruths::new(truths)))
    }

    /// The kinds that there is room for, in the order in which cases take them.
    fn kinds_in_turn(&self, base: &BaseTest) -> Result<Vec<ConcealmentKind>, ConcealmentError> {
        let there: Vec<_> =
            ConcealmentKind::ALL.into_iter().filter(|kind| base.has_room_for(*kind)).collect();
        let mut kinds: Vec<_> = there.iter().copied().filter(|kind| self.kinds.contains(kind)).collect();
        if kinds.is_empty() {
            let names =
                |kinds: &[ConcealmentKind]| kinds.iter().map(|k| k.name()).collect::<Vec<_>>().join(", ");
            return Err(ConcealmentError::NoRoom { asked: names(&self.kinds), there: names(&there) });
        }
        kinds.shuffle(&mut generator(seed_of(&format!("seed {} order of concealments", self.seed), 0)));
        Ok(kinds)
    }

    fn case(
        &self,
        index: usize,
        kinds: &[ConcealmentKind],
        base: &BaseTest,
    ) -> Result<(Case, Concealed), ConcealmentError> {
        let as_it_is = Case { believed: base.explaining.clone(), recorded: base.recorded.clone() };
        let mut random = generator(seed_of(&format!("seed {} concealment", self.seed), index));
        let control =
            |what: &str| Concealed { index, kind: None, what: what.to_owned(), expected: Vec::new() };
        if index == 0 {
            return Ok((as_it_is, control("nothing")));
        }
        if index.is_multiple_of(CONTROLS) {
            let believed = drawn_within_tolerance(base.explaining, &mut random)?;
            let restated = control("nothing, quantities stated anew within their deviations");
            return Ok((Case { believed, ..as_it_is }, restated));
        }
        let number = index - 1 - index / CONTROLS;
        let kind = kinds[number % kinds.len()];
        for _ in 0..DRAWS {
            if let Some(drawn) = base.draw(kind, &mut random)? {
                let truth = Concealed { index, kind: Some(kind), what: drawn.what, expected: drawn.expected };
                return Ok((drawn.case, truth));
            }
        }
        Err(ConcealmentError::Unlucky(index))
    }
}
