//! Sizes of a model's error: what is known of them beforehand, and what a fit says of them.

use crate::modal::fit::ModalFit;
use crate::modal::problem::Problem;
use crate::settings::ModalSettings;
use crate::settings::modal::sizes::{
    AS_PROBABLE, BEYOND_ERRORS, LEAST_OF_STATED_DAMPING, NEGLIGIBLE, STANDING_SHAPE,
};
use jointscope_fixture::{Fixture, Place, Spread, StatedError};
use jointscope_model_error::{
    DAMPING, ErrorSizes, FREQUENCY, GAIN, KINDS, ModelEvidence, SHAPE, STRIKE, SizePrior, UPPER_RESIDUAL,
};
use jointscope_spectra::{Channel, FrfPair};
use serde::Serialize;

/// How wrong a model is, as relative standard deviations over its modes, and how far beside their points
/// sensors sat and hammers struck; zero where the noise explains what is left.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct ModelError {
    /// Of natural frequencies.
    pub frequency: f64,
    /// Of damping ratios.
    pub damping: f64,
    /// Of residues, that is of shapes.
    pub residue: f64,
    /// Of the places of sensors and impacts, m.
    pub strike: f64,
    /// How well these are known; `None` where nothing was estimated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ci95: Option<ErrorIntervals>,
    /// Which of them the fixture states.
    #[serde(skip)]
    pub stated: StatedError,
    /// What such a model's natural frequencies are usually wrong by, where that is more than those of most.
    #[serde(skip)]
    pub usual_frequency: Option<f64>,
    /// How far beside their points sensors and impacts usually are by what is stated of these, m.
    #[serde(skip)]
    pub usual_strike: Option<f64>,
}

/// Intervals that hold the sizes of a model's error with a probability of 95 %.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ErrorIntervals {
    /// Of natural frequencies.
    pub frequency: [f64; 2],
    /// Of damping ratios.
    pub damping: [f64; 2],
    /// Of residues.
    pub residue: [f64; 2],
    /// Of the places of sensors and impacts, m.
    pub strike: [f64; 2],
}

impl ModelError {
    /// What residues of models that stand are usually wrong by.
    pub fn usual_residue() -> f64 {
        STANDING_SHAPE * ErrorSizes::default().shape
    }

    /// Whether the noise explains what is left.
    pub fn is_none(&self) -> bool {
        [self.frequency, self.damping, self.residue, self.strike] == [0.0; 4]
    }
}

/// Whether all bodies have modes of their own above the band.
fn all_bend(fixture: &Fixture) -> bool {
    fixture.bodies().iter().all(|body| body.kind.is_beam())
}

/// Whether all bodies are storeys of a shear building.
fn none_turns(fixture: &Fixture) -> bool {
    fixture.bodies().iter().all(|body| !body.kind.rotates())
}

/// How far beside their points sensors and impacts are: who states how well a point's place is known, knows
/// where it was struck as well.
fn strike_as_stated(fixture: &Fixture, pairs: &[FrfPair], usual: f64) -> f64 {
    let squared = |channel: &Channel| match fixture.point(&channel.point).map(|point| point.x.spread) {
        Some(Spread::Stated(deviation)) => deviation.powi(2),
        _ => usual * usual,
    };
    let all = pairs.iter().flat_map(|pair| [squared(&pair.response), squared(&pair.reference)]);
    let mean = all.sum::<f64>() / (2 * pairs.len()).max(1) as f64;
    mean.sqrt().max(ErrorSizes::LEAST * usual)
}

/// The sizes that are usual but for those that the fixture states.
pub(super) fn known(settings: &ModalSettings, fixture: &Fixture, pairs: &[FrfPair]) -> SizePrior {
    // What has changed since a baseline is held against sizes of its own, of an exact model too.
    let stated = Some(fixture.model_error()).filter(|stated| !stated.is_exact());
    let StatedError { frequency, damping, residue } = stated.unwrap_or_default();
    let usual = settings.usual;
    // Where each record's gain is a quantity of its own, what is stated of it is all that is known: a further
    // error of all gains would hide the one that is off.
    let by_record = fixture.channels().iter().any(|effect| matches!(effect.place, Place::Record(_)));
    let gain = if by_record { ErrorSizes::LEAST * usual.gain } else { usual.gain };
    let scales = ErrorSizes {
        frequency: frequency.unwrap_or(if none_turns(fixture) {
            settings.frequency_of_storeys
        } else {
            usual.frequency
        }),
        damping: damping.unwrap_or(usual.damping),
        shape: residue.unwrap_or(usual.shape),
        upper_residual: if all_bend(fixture) { settings.above_of_beams } else { usual.upper_residual },
        gain: fixture.record_gain().unwrap_or(gain),
        // Who states what residues are wrong by, states all that they are.
        strike: match residue {
            Some(_) => ErrorSizes::LEAST * usual.strike,
            None => strike_as_stated(fixture, pairs, usual.strike),
        },
        ..usual
    };
    let mut stated = [false; KINDS];
    stated[STRIKE] = residue.is_some();
    stated[FREQUENCY] = frequency.is_some();
    stated[DAMPING] = damping.is_some();
    stated[SHAPE] = residue.is_some();
    stated[GAIN] = by_record;
    SizePrior { scales, stated }
}

impl ModalFit {
    /// Whether errors of gains are larger than any beside what is `usual`: among modes they may be of any
    /// size.
    pub(crate) fn has_gains_beyond(&self, usual: &ErrorSizes) -> bool {
        self.evidence.sizes.gain > BEYOND_ERRORS * usual.gain
    }
}

impl Problem<'_> {
    /// The sizes that the recording asks for, those that are stated included: what is stated may be too
    /// little.
    pub(crate) fn seen(&self, fit: &ModalFit) -> ModelEvidence {
        if !self.stated.contains(&true) {
            return fit.evidence;
        }
        let freed = fit.linear.evidence(&fit.paired.comparison, self.sizes, Some(&fit.evidence.sizes));
        freed.unwrap_or(fit.evidence)
    }

    /// Whether what a fit needs of errors, as multiples of what is usual, and of departures, in standard
    /// deviations, is no more than `adequate`, and what these leave of the features is chance: of a mass line
    /// that is off by a dozen times what is usual, errors of nothing are as probable as ones that large.
    pub(crate) fn is_adequate(&self, fit: &ModalFit, adequate: (f64, f64)) -> bool {
        self.holds(fit, adequate, 1.0)
    }

    /// The same of a verdict, for which so many times the usual error of shapes is usual: an adequate fit is
    /// searched for by the usual one, and one that stands is refuted by no less.
    pub(crate) fn stands(&self, fit: &ModalFit, adequate: (f64, f64)) -> bool {
        self.holds(fit, adequate, STANDING_SHAPE)
    }

    fn holds(&self, fit: &ModalFit, adequate: (f64, f64), shapes: f64) -> bool {
        let largest = || self.relative_sizes_as_stated(fit, shapes).into_iter().fold(0.0, f64::max);
        fit.largest_departure() <= adequate.1
            && (largest() <= adequate.0 || self.is_as_probable_with_errors_within((adequate.0, shapes), fit))
            && fit.leaves_chance()
    }

    /// Whether a fit is as probable with no error larger than so many times what is usual: ln of the
    /// evidence, the sizes' prior included, loses next to nothing by that. It is asked of one fit by itself:
    /// a size is known to some tenths of itself only, the less the fewer modes there are. What may lose more,
    /// but less than it gained over a fixture that is adequate, is asked by `outweighs_adequate_fixture` of
    /// `judge.rs`.
    fn is_as_probable_with_errors_within(&self, most: (f64, f64), fit: &ModalFit) -> bool {
        let at = |sizes: &ErrorSizes| fit.linear.ln_evidence_at(&fit.paired.comparison, self.prior(), sizes);
        let both = at(&fit.evidence.sizes).zip(at(&self.no_larger(fit, most)));
        both.is_some_and(|(asked, held)| asked - held < AS_PROBABLE)
    }

    /// Whether errors of the model gain less than this in ln p beside another law of its damping, which is none.
    pub(crate) fn is_exact_but_for_its_law(&self, fit: &ModalFit, gain: f64) -> bool {
        let least = self.sizes.times(ErrorSizes::LEAST);
        let without = fit.linear.ln_density(&fit.paired.comparison, &least);
        fit.paired.pairing.alone() == 0.0 && without.is_some_and(|ln| self.seen(fit).ln - ln < gain)
    }

    /// Whether every mode has a partner and errors of the model gain less than this in ln p: among them
    /// another distribution of its damping, where no effect makes its own of that.
    pub(crate) fn is_exact(&self, fit: &ModalFit, gain: f64) -> bool {
        // The model's damping turns shapes, the structure's none: that is an error.
        if fit.paired.comparison.is_in_phase() {
            return false;
        }
        let least = self.sizes.times(ErrorSizes::LEAST);
        let comparison = &fit.paired.comparison;
        let without = || match fit.hypothesis.has_other_modes() {
            true => fit.linear.ln_density(comparison, &least),
            false => fit.linear.ln_density(&comparison.clone().with_damping_as_modelled(), &least),
        };
        let gained = || without().map_or(f64::INFINITY, |ln| self.seen(fit).ln - ln);
        fit.paired.pairing.alone() == 0.0 && gained() < gain
    }

    /// The sizes of [`Problem::relative_sizes`] by which a hypothesis stands or falls: none of upper residuals
    /// beside effects where bodies are rigid; that of shapes, if it is not stated, by so many times (`shapes`)
    /// what is usual; that of damping ratios by no less than a share of what the fixture states as their
    /// deviations. Where effects have made other modes than those of which it states ratios, by no less than
    /// the whole: these get theirs from the others' damping.
    pub(crate) fn relative_sizes_as_stated(&self, fit: &ModalFit, shapes: f64) -> Vec<f64> {
        let mut sizes = self.relative_sizes(fit);
        if !self.stated[SHAPE] {
            sizes[SHAPE] /= shapes;
        }
        let stated = fit.hypothesis.deviation_of_damping();
        let usual = if fit.hypothesis.has_other_modes() { stated } else { LEAST_OF_STATED_DAMPING * stated };
        if usual > self.sizes.damping {
            sizes[DAMPING] *= self.sizes.damping / usual;
        }
        // Where a held block is rigid in the model, all that is above the band may be what it lacks: that
        // refutes no name, and shows none to be needless.
        if fit.hypothesis.effect_count() > 0 && !all_bend(fit.hypothesis.fixture()) {
            sizes[UPPER_RESIDUAL] = 0.0;
        }
        sizes
    }

    /// The sizes of error of a fit, none of those by which it stands or falls larger than so many times what
    /// is usual.
    pub(crate) fn no_larger(&self, fit: &ModalFit, (most, shapes): (f64, f64)) -> ErrorSizes {
        let mut sizes = fit.evidence.sizes.to_array();
        for (size, relative) in sizes.iter_mut().zip(self.relative_sizes_as_stated(fit, shapes)) {
            *size *= (most / relative.max(f64::MIN_POSITIVE)).min(1.0);
        }
        ErrorSizes::from_array(sizes)
    }

    /// Sizes of the errors as multiples of what is usual, or of what is stated: the sizes that the recording
    /// asks for. Gains are the test's, not the model's.
    pub(crate) fn relative_sizes(&self, fit: &ModalFit) -> Vec<f64> {
        let without = ErrorSizes { gain: 0.0, ..self.seen(fit).sizes };
        self.over_usual(&without)
    }

    /// The same without those of mass lines and upper residuals.
    pub(crate) fn relative_sizes_of_modes(&self, fit: &ModalFit) -> Vec<f64> {
        self.over_usual(&ErrorSizes {
            mass_line: 0.0,
            upper_residual: 0.0,
            gain: 0.0,
            ..self.seen(fit).sizes
        })
    }

    /// The same by kind, gains of records among them and without those of natural frequencies and damping, in
    /// which a channel's signal has no part.
    pub(crate) fn relative_sizes_of_signals(&self, fit: &ModalFit) -> Vec<f64> {
        self.over_usual(&ErrorSizes { frequency: 0.0, damping: 0.0, ..self.seen(fit).sizes })
    }

    /// The same with the gains of records among them.
    pub(crate) fn relative_sizes_with_gains(&self, fit: &ModalFit) -> Vec<f64> {
        self.over_usual(&self.seen(fit).sizes)
    }

    fn over_usual(&self, sizes: &ErrorSizes) -> Vec<f64> {
        let usual = self.sizes.to_array();
        sizes.to_array().iter().zip(usual).map(|(size, usual)| size / usual).collect()
    }

    /// The error of a fitted model. A stated size is told as stated, unless the recording asks for more than
    /// `adequate` times as much.
    pub(crate) fn error(&self, fit: &ModalFit, adequate: f64) -> ModelError {
        let seen = self.seen(fit);
        let (sizes, found) = (self.sizes.to_array(), seen.sizes.to_array());
        let usual = ErrorSizes::default().to_array();
        let holds = |kind: usize| self.stated[kind] && found[kind] <= adequate * sizes[kind];
        let size = |kind: usize| match found[kind] {
            _ if holds(kind) => sizes[kind],
            size if size > NEGLIGIBLE * usual[kind] => size,
            _ => 0.0,
        };
        let interval = |kind: usize| match holds(kind) {
            true => [sizes[kind]; 2],
            false => fit.linear.size_interval(&fit.paired.comparison, self.sizes, &seen, kind),
        };
        let stated = |kind: usize| self.stated[kind].then_some(sizes[kind]);
        ModelError {
            frequency: size(FREQUENCY),
            damping: size(DAMPING),
            residue: size(SHAPE),
            strike: if self.stated[STRIKE] { 0.0 } else { size(STRIKE) },
            ci95: Some(ErrorIntervals {
                frequency: interval(FREQUENCY),
                damping: interval(DAMPING),
                residue: interval(SHAPE),
                strike: interval(STRIKE),
            }),
            stated: StatedError {
                frequency: stated(FREQUENCY),
                damping: stated(DAMPING),
                residue: stated(SHAPE),
            },
            usual_frequency: none_turns(fit.hypothesis.fixture()).then_some(sizes[FREQUENCY]),
            usual_strike: Some(sizes[STRIKE]),
        }
    }
}
