//! What is odd in recorded FRFs before any physics is asked for.
//!
//! Slips of a test's files look like physics: an FRF under another one's label like a resonator and a missing mass, a dead one like anything. They are told here by
//! what no physics does, put right where it is plain what was meant, left out otherwise, and always said.
//!
//! 1. [dead](Oddity::Dead): no signal on any line. Left out.
//! 2. [another form](Oddity::Form): the levels fall behind the fixture's as frequency to the power −1 or −2, whatever the resonances do. Taken as mobility or
//!    receptance.
//! 3. [conjugated](Oddity::Conjugated): the phase rises through resonances, so the file's time dependence is e^{−iωt}. Conjugated.
//! 4. [exchanged](Oddity::Exchanged): two FRFs are each like the fixture's other one, and neither like its own. Exchanged.
//! 5. [unexcited](Oddity::Unexcited): no coherence over the upper part of the band. Only said: the noise says the rest.
//!
//! The fixture is compared as it stands. What it leaves out moves resonances; levels and phases between them hardly change, so all of it goes by medians over the lines.

mod conjugated;
mod exchanged;
mod form;
mod levels;
mod unexcited;

use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, accelerances};
use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectraError};
use num_complex::Complex64;
use std::fmt;

/// Something odd in a recording, and what was done about it. Shown as one plain sentence, without a full stop.
#[derive(Debug, Clone, PartialEq)]
pub enum Oddity {
    /// FRFs without a signal on any line: left out.
    Dead(Vec<FrfPair>),
    /// FRFs whose phase rises through resonances: their conjugates were taken.
    Conjugated(Vec<FrfPair>),
    /// FRFs that are of this form, and not what the file says: taken as such.
    Form(FrfForm),
    /// Two FRFs that stand under each other's labels: exchanged.
    Exchanged(FrfPair, FrfPair),
    /// No coherence from this frequency (Hz) to the end of the band in all FRFs of a channel: `true` of a reference.
    Unexcited {
        /// The channel's point.
        point: String,
        /// Whether it is a reference: where the hammer struck.
        is_reference: bool,
        /// Hz.
        from: f64,
    },
}

/// FRFs as they are meant, with what was odd about them.
#[derive(Debug, Clone, PartialEq)]
pub struct Screened {
    /// The FRFs, put right.
    pub frfs: FrfSet,
    /// What was odd, in the order in which it was found.
    pub oddities: Vec<Oddity>,
}

/// Why nothing is left of a recording.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ScreeningError {
    /// No FRF has a signal.
    #[error(
        "all FRFs are zero on all lines: nothing was recorded, or not exported; check the channels and export again"
    )]
    NothingRecorded,
    /// FRFs that make no set.
    #[error(transparent)]
    Spectra(#[from] SpectraError),
}

/// An FRF's root mean square over that of the median one below which it has no signal.
const DEAD: f64 = 1e-9;

/// The FRFs of a test of `fixture` as they are meant.
///
/// # Errors
/// [`ScreeningError::NothingRecorded`].
pub fn screened(frfs: &FrfSet, fixture: &Fixture) -> Result<Screened, ScreeningError> {
    let mut oddities = Vec::new();
    let mut frfs = alive(frfs, &mut oddities)?;
    let modelled = modelled(&frfs, fixture);
    if let Some(modelled) = &modelled
        && let Some(form) = form::other_form(&frfs, modelled)
    {
        let omegas: Vec<f64> = frfs.lines().omegas().collect();
        let factor = |at: usize| {
            let omega = omegas[at % omegas.len()];
            let factor = if omega > 0.0 { form.factor_to(FrfForm::Accelerance, omega) } else { None };
            factor.unwrap_or(Complex64::ONE)
        };
        frfs = frfs.with_values(|at, value| value * factor(at));
        oddities.push(Oddity::Form(form));
    }
    let conjugates = conjugated::conjugated(&frfs);
    if !conjugates.is_empty() {
        let count = frfs.lines().len();
        frfs = frfs
            .with_values(|at, value| if conjugates.contains(&(at / count)) { value.conj() } else { value });
        oddities
            .push(Oddity::Conjugated(conjugates.iter().map(|&index| frfs.pairs()[index].clone()).collect()));
    }
    if let Some(modelled) = &modelled {
        for (a, b) in exchanged::exchanged(&frfs, modelled) {
            let mut pairs = frfs.pairs().to_vec();
            pairs.swap(a, b);
            oddities.push(Oddity::Exchanged(pairs[a].clone(), pairs[b].clone()));
            frfs = frfs.with_pairs(pairs);
        }
    }
    oddities.extend(unexcited::unexcited(&frfs));
    Ok(Screened { frfs, oddities })
}

/// What the fixture makes of the same FRFs, as accelerances; `None` where it has no model, or the FRFs are of another form.
fn modelled(frfs: &FrfSet, fixture: &Fixture) -> Option<Vec<Complex64>> {
    if frfs.form() != FrfForm::Accelerance {
        return None;
    }
    accelerances(fixture, frfs.pairs(), frfs.lines(), Instrument::AsRecorded).ok()
}

/// The FRFs that have a signal.
fn alive(frfs: &FrfSet, oddities: &mut Vec<Oddity>) -> Result<FrfSet, ScreeningError> {
    let size = |index: usize| frfs.values(index).iter().map(|value| value.norm_sqr()).sum::<f64>().sqrt();
    let sizes: Vec<f64> = (0..frfs.pairs().len()).map(size).collect();
    let recorded: Vec<f64> = sizes.iter().copied().filter(|size| *size > 0.0).collect();
    let usual = levels::median(recorded).ok_or(ScreeningError::NothingRecorded)?;
    let dead = |index: usize| sizes[index] <= DEAD * usual;
    let names: Vec<FrfPair> =
        (0..sizes.len()).filter(|i| dead(*i)).map(|i| frfs.pairs()[i].clone()).collect();
    if names.is_empty() {
        return Ok(frfs.clone());
    }
    oddities.push(Oddity::Dead(names));
    frfs.of_frfs(|index| !dead(index)).ok_or(ScreeningError::NothingRecorded)
}

impl fmt::Display for Oddity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let listed = |pairs: &[FrfPair]| pairs.iter().map(FrfPair::to_string).collect::<Vec<_>>().join(", ");
        match self {
            Oddity::Dead(pairs) => write!(
                f,
                "{} without a signal on any line, left out: {}; check the sensor, its cable and the export",
                if pairs.len() == 1 { "an FRF" } else { "FRFs" },
                listed(pairs)
            ),
            Oddity::Conjugated(pairs) => write!(
                f,
                "the phase rises through the resonances, as with a time dependence of exp(−iωt): conjugates taken of {}; export with exp(+iωt), as universal files have it",
                listed(pairs)
            ),
            Oddity::Form(form) => write!(
                f,
                "the levels are not those of what the file says it holds: taken as {}; correct the file's function and unit codes",
                form.name()
            ),
            Oddity::Exchanged(a, b) => write!(
                f,
                "FRFs {a} and {b} stand under each other's labels: exchanged; correct the node numbers in the file"
            ),
            Oddity::Unexcited { point, is_reference: true, from } => write!(
                f,
                "above {from:.4} Hz the blows at {point} leave no coherence: they do not excite that band; a harder tip does, or use --band"
            ),
            Oddity::Unexcited { point, is_reference: false, from } => write!(
                f,
                "above {from:.4} Hz response {point} has no coherence: its sensor or filter ends there; replace it, or use --band"
            ),
        }
    }
}
