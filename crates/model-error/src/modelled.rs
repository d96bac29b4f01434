//! The modes of a model as a recording would have them: poles with their residues, and residual terms by
//! projection on the recording's own.

use crate::basis::{Pole, UPPER};
use crate::poles::{ModelledMode, mode, mode_beside, poles};
use crate::recorded::RecordedModes;
use jointscope_fixture::Fixture;
use jointscope_lumped::{ContinuedFrfs, Instrument, ModelledTest, Vicinity};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// What a mode of a model counts as beside a recording. A mode that is followed keeps it: where it crosses an
/// end of the band on the way, its features go on smoothly.
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
    /// What a free fit with the recording's poles adds to the residue of each of them, FRF by FRF, as the
    /// residual terms cannot write all that the modes out of the band do.
    pub(crate) leaks: Vec<Vec<Complex64>>,
    /// What gains and delays of the channels make of each FRF at each mode, and at the lowest and the
    /// highest line.
    pub(crate) signals: Vec<Vec<Complex64>>,
    pub(crate) signals_at_ends: [Vec<Complex64>; 2],
    /// Decay of the exponential window that all of this is read under, 1/s.
    pub(crate) window_decay: f64,
    /// By how much the last residual term lowers χ² of what the modes leave, over all FRFs and lines of the
    /// recording.
    last_term: f64,
}

impl RecordedModes {
    /// What models of fixtures about this one are made from in [`ModelledModes::after_step`]; `None` where
    /// models of their own cost as little.
    pub fn about(&self, fixture: Fixture) -> Option<Vicinity> {
        Vicinity::where_it_pays(fixture, self.band.1)
    }

    /// A fixture as this recording's test would have read it.
    fn modelled(&self, fixture: &Fixture) -> Option<ModelledTest> {
        ModelledTest::new(fixture, &self.pairs, self.band.1, Instrument::AsRecorded).ok()
    }
}

impl ModelledModes {
    /// The modes of a fixture in and near the band of a recording: from half its lowest line to 1.6 times its
    /// highest. `None` where a pole cannot be followed or the model has no finite FRFs.
    ///
    /// A mode that makes no peak in any FRF between the recording's channels is found only where the
    /// recording has one nearby.
    pub fn of(fixture: &Fixture, recorded: &RecordedModes) -> Option<Self> {
        let test = recorded.modelled(fixture)?;
        let modes = follow(&test, recorded, &poles(&test, fixture, recorded), mode)?;
        ModelledModes::made_of(modes, None, &test, recorded)
    }

    /// The modes of a fixture near those of another one, as which they count; `None` where a pole cannot be
    /// followed or the model has no finite FRFs.
    pub fn near(fixture: &Fixture, recorded: &RecordedModes, other: &ModelledModes) -> Option<Self> {
        let test = recorded.modelled(fixture)?;
        let modes = follow(&test, recorded, &other.poles(), mode)?;
        ModelledModes::made_of(modes, Some(&other.parts), &test, recorded)
    }

    /// As [`ModelledModes::near`] of a fixture that differs from the one of `other`, and of `about` where
    /// there is one, by a step of a difference alone: for derivatives.
    pub fn after_step(
        fixture: &Fixture,
        recorded: &RecordedModes,
        (about, other): (Option<&Vicinity>, &ModelledModes),
    ) -> Option<Self> {
        let test = match about {
            Some(about) => about.beside(fixture, &recorded.pairs, Instrument::AsRecorded).ok()?,
            None => recorded.modelled(fixture)?,
        };
        let modes = follow(&test, recorded, &other.poles(), mode_beside)?;
        ModelledModes::made_of(modes, Some(&other.parts), &test, recorded)
    }

    /// From the modes of a test's model, and what they count as.
    fn made_of(
        modes: Vec<ModelledMode>,
        parts: Option<&[Part]>,
        test: &ModelledTest,
        recorded: &RecordedModes,
    ) -> Option<Self> {
        let own = || modes.iter().map(|mode| Part::of(recorded, &mode.pole)).collect();
        let parts: Vec<Part> = parts.map_or_else(own, <[Part]>::to_vec);
        let outline = &recorded.outline;
        let lines = &outline.lines;
        let mut left = test.accelerances(lines).ok()?;
        let of = |wanted: fn(Part) -> bool| {
            modes.iter().zip(&parts).filter(move |(_, part)| wanted(**part)).map(|(mode, _)| mode)
        };
        let in_band: Vec<(&ModelledMode, Vec<Complex64>)> = of(|part| part != Part::Beyond)
            .map(|mode| {
                let along = |omega| mode.pole.accelerance(Complex64::new(0.0, omega));
                (mode, lines.omegas().map(along).collect())
            })
            .collect();
        let mut residual_terms = Vec::with_capacity(recorded.frfs());
        let mut leaks = Vec::with_capacity(recorded.frfs());
        let mut last_term = 0.0;
        for (frf, values) in left.chunks_exact_mut(lines.len()).enumerate() {
            for (mode, along) in &in_band {
                let residue = mode.residues[frf];
                values.iter_mut().zip(along).for_each(|(value, along)| *value -= residue * along);
            }
            let (coefficients, lowered) = outline.projections[frf].with_last(values);
            let low: f64 = of(|part| part == Part::Unresolved).map(|mode| mode.residues[frf].re).sum();
            let mass_line: f64 = outline.mass_line.iter().map(|&c| coefficients[c].re).sum();
            residual_terms.push([mass_line + low, coefficients[outline.poles + UPPER].re]);
            leaks.push(coefficients[..outline.inside].to_vec());
            last_term += lowered;
        }
        let signals = modes.iter().map(|mode| test.gains_and_delays(mode.pole.omega)).collect();
        let signals_at_ends = [recorded.band.0, recorded.band.1].map(|hz| test.gains_and_delays(TAU * hz));
        let window_decay = test.window_decay();
        Some(ModelledModes {
            modes,
            parts,
            residual_terms,
            leaks,
            signals,
            signals_at_ends,
            window_decay,
            last_term,
        })
    }

    /// Whether a free fit of the model's own FRFs would take the last of the recording's residual terms, by
    /// Akaike's criterion: modes out of the band ask for it.
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

    /// The same with all natural frequencies higher by this share, to set out from where exactly at a pole
    /// FRFs have no value.
    pub fn beside(mut self, share: f64) -> Self {
        self.modes.iter_mut().for_each(|mode| mode.pole.omega *= 1.0 + share);
        self
    }

    /// The poles, rad/s.
    pub fn poles(&self) -> Vec<Complex64> {
        self.modes.iter().map(|mode| mode.pole.lambda()).collect()
    }
}

/// The modes of a test's model beside known poles, each of them as `found` says.
fn follow(
    test: &ModelledTest,
    recorded: &RecordedModes,
    poles: &[Complex64],
    found: fn(&mut ContinuedFrfs, Complex64, usize) -> Option<ModelledMode>,
) -> Option<Vec<ModelledMode>> {
    let mut frfs = test.continued();
    poles.iter().map(|pole| found(&mut frfs, *pole, recorded.frfs())).collect()
}
