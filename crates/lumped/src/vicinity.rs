//! Fixtures next to one another, for derivatives by differences.

use crate::assembly::Rows;
use crate::{Instrument, LumpedError, Model, ModelledTest};
use jointscope_fixture::Fixture;
use jointscope_spectra::FrfPair;

/// A fixture's model, beside which those of fixtures that differ next to nothing from it cost little: modes
/// of meshed beams follow to first order from the ones at hand instead of from an eigenproblem of their own.
///
/// It is for derivatives alone. What is off by the square of a step is nothing to a difference over that
/// step; a prediction is made by [`ModelledTest::new`].
#[derive(Debug, Clone)]
pub struct Vicinity {
    fixture: Fixture,
    model: Model,
    rows: Rows,
}

impl Vicinity {
    /// About a fixture, beams meshed for lines up to `highest_hz`; `None` where it cannot be modelled, and
    /// where nothing is gained: of rigid bodies, and of a uniform beam by itself, whose modes cost little.
    pub fn where_it_pays(fixture: Fixture, highest_hz: f64) -> Option<Self> {
        if !Model::has_neighbours(&fixture) {
            return None;
        }
        let model = Model::new(&fixture, highest_hz).ok()?;
        let rows = model.rows();
        Some(Vicinity { fixture, model, rows })
    }

    /// The test of a fixture `moved` by next to nothing, between the channels of `pairs`; by a solution of
    /// its own where the modes at hand do not tell.
    ///
    /// # Errors
    /// Those of [`ModelledTest::new`].
    pub fn beside(
        &self,
        moved: &Fixture,
        pairs: &[FrfPair],
        instrument: Instrument,
    ) -> Result<ModelledTest, LumpedError> {
        let model = self.model.beside((&self.fixture, &self.rows), moved)?;
        ModelledTest::of(model, moved, pairs, instrument)
    }
}
