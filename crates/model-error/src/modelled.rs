//! The modes of a model as a recording would have them: poles with their residues, and residual terms by projection on the recording's own.

use crate::basis::{Pole, UPPER};
use crate::poles::{ModelledMode, mode, poles};
use crate::recorded::RecordedModes;
use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, ModelledTest, Vicinity};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// What a mode of a model counts as beside a recording. A mode that is followed keeps it: where it crosses an end of the band on the way, its features go on smoothly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    /// Beyond the band's ends: what it adds is of the residual terms, as the recording's fit would have it.
    Beyond,
    /// In the band, too low to be told from a mass line: it is a part of that, on both sides.
    Unresolved,
    /// In the band.
    Within,
}

impl Part {
    fn of(recorded: &RecordedModes, pole: &Pole) -> Self {
        let hz = pole.omega / TAU;
        match (hz >= recorded.band.0 && hz <= recorded.band.1, hz <= recorded.resolved_from) {
            (false, _) => Part::Beyond,
            (true, true) => Part::Unresolved,
            (true, false) => Part::Within,
        }
    }
}

/// Modes and residual terms of a model, between the channels of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelledModes {
    /// The modes in and near the band, ascending.
    pub modes: Vec<ModelledMode>,
    /// What each of them counts as.
    parts: Vec<Part>,
    /// Real parts of mass line and upper residual of each FRF.
    pub(crate) residual_terms: Vec<[f64; 2]>,
    /// What a free fit with the recording's poles adds to the residue of each of them, FRF by FRF, as the residual terms cannot write all that
    /// the modes out of the band do.
    pub(crate) leaks: Vec<Vec<Complex64>>,
    /// By how much the last residual term lowers χ² of what the modes leave, over all FRFs and lines of the recording.
    last_term: f64,
}

impl RecordedModes {
    /// What [`ModelledModes::after_step`] sets out from to fixtures about this one; `None` where [`ModelledModes::near`] costs as little.
    pub fn about(&self, fixture: Fixture) -> Option<Vicinity> {
        Vicinity::where_it_pays(fixture, self.band.1)
    }

    /// A fixture as this recording's test would have read it.
    fn modelled(&self, fixture: &Fixture) -> Option<ModelledTest> {
        ModelledTest::new(fixture, &self.pairs, self.band.1, Instrument::AsRecorded).ok()
    }
}

impl ModelledModes {
    /// The modes of a fixture in and near the band of a recording: from half its lowest line to 1.6 times its highest. `None` where a pole cannot be
    /// followed or the model has no finite FRFs.
    ///
    /// A mode that makes no peak in any FRF between the recording's channels is found only where the recording has one nearby.
    pub fn of(fixture: &Fixture, recorded: &RecordedModes) -> Option<Self> {
        let test = recorded.modelled(fixture)?;
        ModelledModes::followed(&test, recorded, &poles(&test, fixture, recorded), None)
    }

    /// The modes of a fixture near those of another one, as which they count; `None` where a pole cannot be followed or the model has no finite FRFs.
    pub fn near(fixture: &Fixture, recorded: &RecordedModes, other: &ModelledModes) -> Option<Self> {
        ModelledModes::followed(&recorded.modelled(fixture)?, recorded, &other.poles(), Some(&other.parts))
    }

    /// As [`ModelledModes::near`] of a fixture that differs from the one of `about` by a step of a difference alone, for derivatives.
    pub fn after_step(
        fixture: &Fixture,
        recorded: &RecordedModes,
        (about, other): (&Vicinity, &ModelledModes),
    ) -> Option<Self> {
        let test = about.beside(fixture, &recorded.pairs, Instrument::AsRecorded).ok()?;
        ModelledModes::followed(&test, recorded, &other.poles(), Some(&other.parts))
    }

    fn followed(
        test: &ModelledTest,
        recorded: &RecordedModes,
        poles: &[Complex64],
        parts: Option<&[Part]>,
    ) -> Option<Self> {
        let mut frfs = test.continued();
        let modes: Vec<ModelledMode> =
            poles.iter().map(|pole| mode(&mut frfs, *pole, recorded.frfs())).collect::<Option<_>>()?;
        let own = || modes.iter().map(|mode| Part::of(recorded, &mode.pole)).collect();
        let parts: Vec<Part> = parts.map_or_else(own, <[Part]>::to_vec);
        let lines = &recorded.outline.lines;
        let mut left = test.accelerances(lines).ok()?;
        let of = |wanted: fn(Part) -> bool| {
            modes.iter().zip(&parts).filter(move |(_, part)| wanted(**part)).map(|(mode, _)| mode)
        };
        let recorded_poles = recorded.outline.poles;
        let mut residual_terms = Vec::with_capacity(recorded.frfs());
        let mut leaks = Vec::with_capacity(recorded.frfs());
        let mut last_term = 0.0;
        for (frf, values) in left.chunks_exact_mut(lines.len()).enumerate() {
            for (value, omega) in values.iter_mut().zip(lines.omegas()) {
                let s = Complex64::new(0.0, omega);
                let modal = of(|part| part != Part::Beyond);
                *value -= modal.map(|mode| mode.pole.accelerance(s) * mode.residues[frf]).sum::<Complex64>();
            }
            let coefficients = recorded.outline.projections[frf].coefficients(values);
            let low: f64 = of(|part| part == Part::Unresolved).map(|mode| mode.residues[frf].re).sum();
            let mass_line: f64 = recorded.outline.mass_line.iter().map(|&c| coefficients[c].re).sum();
            residual_terms.push([mass_line + low, coefficients[recorded_poles + UPPER].re]);
            leaks.push(coefficients[..recorded.outline.inside].to_vec());
            last_term += recorded.outline.projections[frf].lowered_by_last(values);
        }
        last_term *= recorded.outline.recorded as f64 / lines.len() as f64;
        Some(ModelledModes { modes, parts, residual_terms, leaks, last_term })
    }

    /// Whether a free fit of the model's own FRFs would take the last of the recording's residual terms, by Akaike's criterion: modes out of the band ask for it.
    pub(crate) fn needs_last_term(&self) -> bool {
        self.last_term > 4.0 * self.residual_terms.len() as f64
    }

    /// Whether both count their modes as the same.
    pub fn counts_like(&self, other: &ModelledModes) -> bool {
        self.parts == other.parts
    }

    /// Whether a mode that was followed is no longer what it counts as.
    pub fn strays(&self, recorded: &RecordedModes) -> bool {
        self.modes.iter().zip(&self.parts).any(|(mode, part)| Part::of(recorded, &mode.pole) != *part)
    }

    /// The same with all natural frequencies higher by this share, to set out from where exactly at a pole FRFs have no value.
    pub fn beside(mut self, share: f64) -> Self {
        self.modes.iter_mut().for_each(|mode| mode.pole.omega *= 1.0 + share);
        self
    }

    /// The poles, rad/s.
    pub fn poles(&self) -> Vec<Complex64> {
        self.modes.iter().map(|mode| mode.pole.lambda()).collect()
    }
}
