//! The recorded modes as a problem of inference: those of a hypothesis, paired with them, and how they move
//! with its coordinates.

use crate::Hypothesis;
use crate::modal::prior::Prior;
use crate::settings::modal::differences::{MOST_STEP, STEP};
use crate::settings::work::costs::{FOLLOWED_POLES, SEARCHED_POLES};
use crate::work::Work;
use jointscope_fixture::Fixture;
use jointscope_model_error::{
    ErrorSizes, KINDS, ModelledModes, Pairing, RecordedModes, Shapes, SharedFeatures, SizePrior, StrikeSlopes,
};

/// The recording's modes and what is known of the model's error.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Problem<'a> {
    pub recorded: &'a RecordedModes,
    pub features: &'a [f64],
    pub sizes: &'a ErrorSizes,
    /// Which of the sizes are stated.
    pub stated: [bool; KINDS],
    /// Work done.
    pub work: &'a Work,
}

/// The modes of a hypothesis, paired with the recorded ones, and what both have in common.
#[derive(Debug, Clone)]
pub(crate) struct PairedModes {
    pub modelled: ModelledModes,
    pub pairing: Pairing,
    pub comparison: SharedFeatures,
}

impl PairedModes {
    /// The same where the structure's damping turns no shape.
    pub(super) fn in_phase(self) -> Self {
        PairedModes { comparison: self.comparison.with_shapes_in_phase(), ..self }
    }
}

/// One iterate of a fit: the hypothesis, its modes and what they leave.
#[derive(Clone)]
pub(super) struct Iterate {
    pub hypothesis: Hypothesis,
    pub modelled: ModelledModes,
    pub residual: Vec<f64>,
}

impl Problem<'_> {
    /// What is known of the sizes of the error beforehand.
    pub(crate) fn prior(&self) -> SizePrior {
        SizePrior { scales: *self.sizes, stated: self.stated }
    }

    /// The modes of a hypothesis, its poles found anew, paired as is likeliest.
    pub(crate) fn paired_modes(&self, hypothesis: &Hypothesis) -> Option<PairedModes> {
        let fixture = hypothesis.to_fixture().ok()?;
        self.work.count(SEARCHED_POLES * self.recorded.frfs());
        let modelled = ModelledModes::of(&fixture, self.recorded)?;
        let pairing = Pairing::of(self.recorded, &modelled);
        self.paired_as((hypothesis, &fixture), modelled, pairing)
    }

    /// The modes of a hypothesis in a given pairing.
    pub(super) fn paired_as(
        &self,
        (hypothesis, fixture): (&Hypothesis, &Fixture),
        modelled: ModelledModes,
        pairing: Pairing,
    ) -> Option<PairedModes> {
        let shapes = |fixture: &Fixture| Shapes::of(fixture, self.recorded, &modelled.poles());
        let own = shapes(fixture)?;
        let mut comparison = SharedFeatures::new(self.recorded, &pairing, &modelled, &own);
        self.work.count(2 * FOLLOWED_POLES * self.recorded.frfs());
        if let Some(slopes) = StrikeSlopes::of(fixture, self.recorded, &modelled) {
            comparison = comparison.with_strikes(self.recorded, (&pairing, &modelled), &slopes);
        }
        // Dashpots turn phases as the fixture has them, or, if its damping is that of the modes as they
        // stand, not at all; and its damping is no proportional one of a structure with effects. Which of
        // both it is, if either, nobody knows.
        let springs = match hypothesis.without_dashpots() {
            Some(effects) if effects == hypothesis.effects() => Some(own),
            Some(effects) => hypothesis.to_fixture_with(effects).ok().and_then(|fixture| shapes(&fixture)),
            None => None,
        };
        if let Some(springs) = springs {
            comparison = comparison.with_damping_distributed_otherwise(self.recorded, &pairing, &springs);
        }
        Some(PairedModes { modelled, pairing, comparison })
    }

    /// The modes of a hypothesis, followed from those of another one near it.
    pub(super) fn modelled(&self, hypothesis: &Hypothesis, near: &ModelledModes) -> Option<ModelledModes> {
        let fixture = hypothesis.to_fixture().ok()?;
        self.work.count(FOLLOWED_POLES * self.recorded.frfs());
        ModelledModes::near(&fixture, self.recorded, near)
    }

    /// Recorded less modelled features, of the modes that are paired.
    pub(crate) fn residual(&self, paired: &PairedModes, modelled: &ModelledModes) -> Vec<f64> {
        paired.comparison.residual(self.recorded, self.features, modelled, &paired.pairing)
    }

    /// Derivatives of the model's features by coordinates `of`, for a step of one.
    pub(crate) fn slopes(
        &self,
        hypothesis: &Hypothesis,
        paired: &PairedModes,
        modelled: &ModelledModes,
        residual: &[f64],
        priors: &[Prior],
        of: std::ops::Range<usize>,
    ) -> Option<Vec<Vec<f64>>> {
        let about = self.recorded.about(hypothesis.to_fixture().ok()?);
        let beside = |hypothesis: &Hypothesis| {
            let fixture = hypothesis.to_fixture().ok()?;
            self.work.count(FOLLOWED_POLES * self.recorded.frfs());
            ModelledModes::after_step(&fixture, self.recorded, (about.as_ref(), modelled))
        };
        of.map(|index| {
            let size = (STEP * priors[index].std).min(MOST_STEP);
            let inward = hypothesis.inward(index, size);
            // A beam that ends at a support cannot become shorter: then longer.
            let moved = |step: f64| Some((step, beside(&hypothesis.moved(index, step))?));
            let (step, moved) = moved(inward).or_else(|| moved(-inward))?;
            let there = self.residual(paired, &moved);
            Some(residual.iter().zip(&there).map(|(at, there)| (at - there) / step).collect())
        })
        .collect()
    }
}
