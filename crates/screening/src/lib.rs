//! What is odd in recorded FRFs before any physics is asked for.
//!
//! Slips of a test's files look like physics: an FRF under another one's label like a resonator and a missing mass, a dead one like anything. They are told here by
//! what no physics does, put right where it is plain what was meant, left out otherwise, and always said.
//!
//! 1. [dead](Oddity::Dead): no signal on any line. Left out.
//! 2. [another axis](Oddity::Axis): FRFs are nothing like the fixture's, and like them at frequencies over 1000, 2π or 60. Taken there.
//! 3. [another form](Oddity::Form): the levels fall behind the fixture's as frequency to the power −1 or −2, whatever the resonances do. Taken as mobility or
//!    receptance.
//! 4. [another unit](Oddity::Unit): all levels are off by what lies between two units. Taken in the other one.
//! 5. [conjugated](Oddity::Conjugated): the phase rises through resonances, so the file's time dependence is e^{−iωt}. Conjugated.
//! 6. [exchanged](Oddity::Exchanged): two FRFs are each like the fixture's other one, and neither like its own. Exchanged.
//! 7. [unexcited](Oddity::Unexcited): no coherence over the upper part of the band. In all FRFs of a reference, left out there; in those of a sensor only said.
//!
//! Two things are told of what cannot be put right: [masses and inertias](Oddity::Masses) of the fixture in another unit, and FRFs of which [a part](Steps) was changed.
//!
//! The fixture is compared as it stands. What it leaves out moves resonances; levels and phases between them hardly change, so all of it goes by medians over the lines.

mod axis;
mod conjugated;
mod exchanged;
mod form;
mod levels;
mod masses;
mod plausibility;
mod steps;
mod unexcited;
mod unit;

pub use levels::median;
pub use plausibility::{Implausible, implausible, plausible};
pub use steps::Steps;

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
    /// The frequencies of all lines are this many times too large: divided by it.
    Axis(f64),
    /// All FRFs are larger by this factor, which lies between two units: divided by it.
    Unit {
        /// The factor.
        factor: f64,
        /// The units that were taken for each other.
        between: &'static str,
    },
    /// Masses or inertias of the fixture are in another unit, or a decimal place off: nothing was changed for it.
    Masses(Implausible),
    /// Two FRFs that stand under each other's labels: exchanged.
    Exchanged(FrfPair, FrfPair),
    /// Two points whose channels, responses or references, have each other's place in all FRFs: exchanged.
    Swapped(String, String),
    /// No coherence from this frequency (Hz) to the end of the band in all FRFs of a channel: `true` of a reference.
    Unexcited {
        /// The channel's point.
        point: String,
        /// Whether it is a reference: where the hammer struck.
        is_reference: bool,
        /// Hz.
        from: f64,
        /// Lines from there on.
        lines: usize,
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
    /// A part of the numbers was changed.
    #[error(
        "FRF {} steps by a factor of {} at {} Hz, and there are {} such steps in all, which no structure makes: a part of the numbers was changed, as where exponents are replaced in an editor; export the file again",
        .0.frf,
        .0.factor,
        jointscope_spectra::in_text(.0.hz),
        .0.count
    )]
    Changed(Box<Steps>),
    /// FRFs that make no set.
    #[error(transparent)]
    Spectra(#[from] SpectraError),
}

/// An FRF's root mean square over that of the median one below which it has no signal.
const DEAD: f64 = 1e-9;

/// The FRFs of a test of `fixture` as they are meant.
///
/// # Errors
/// [`ScreeningError::NothingRecorded`], [`ScreeningError::Changed`].
pub fn screened(frfs: FrfSet, fixture: &Fixture) -> Result<Screened, ScreeningError> {
    let mut oddities = Vec::new();
    let mut frfs = alive(frfs, &mut oddities)?;
    if let Some(steps) = steps::steps(&frfs) {
        return Err(ScreeningError::Changed(Box::new(steps)));
    }
    let mut modelled = modelled(&frfs, fixture);
    if let Some(at_these) = &modelled
        && let Some(factor) = axis::off_axis(&frfs, at_these, fixture)
        && let Some(lines) = axis::over(frfs.lines(), factor)
    {
        frfs = frfs.with_lines(lines);
        modelled = self::modelled(&frfs, fixture);
        oddities.push(Oddity::Axis(factor));
    }
    if let Some(modelled) = &modelled {
        frfs = in_its_units(frfs, modelled, fixture, &mut oddities);
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
        let found = exchanged::exchanged(&frfs, modelled);
        let mut pairs = frfs.pairs().to_vec();
        match exchanged::swapped(&pairs, &found) {
            Some((a, b)) => oddities.push(Oddity::Swapped(a, b)),
            None => oddities
                .extend(found.iter().map(|&(a, b)| Oddity::Exchanged(pairs[a].clone(), pairs[b].clone()))),
        }
        found.into_iter().for_each(|(a, b)| pairs.swap(a, b));
        frfs = frfs.with_pairs(pairs);
    }
    let unexcited = unexcited::unexcited(&frfs);
    frfs = unexcited::masked(frfs, &unexcited);
    oddities.extend(unexcited);
    Ok(Screened { frfs, oddities })
}

/// The FRFs in the form and unit that they are meant in, where it is not the fixture's masses that are off.
fn in_its_units(
    mut frfs: FrfSet,
    modelled: &[Complex64],
    fixture: &Fixture,
    oddities: &mut Vec<Oddity>,
) -> FrfSet {
    let unit = unit::off_by_units(&frfs, modelled);
    let left = unit.and_then(|(factor, between)| Some((unit::left(&frfs, modelled, factor)?, between)));
    if let Some(slip) = masses::slip(&frfs, modelled, fixture, left) {
        oddities.push(Oddity::Masses(slip));
    } else if let Some(form) = form::other_form(&frfs, modelled) {
        let omegas: Vec<f64> = frfs.lines().omegas().collect();
        let factor = |at: usize| {
            let omega = omegas[at % omegas.len()];
            let factor = if omega > 0.0 { form.factor_to(FrfForm::Accelerance, omega) } else { None };
            factor.unwrap_or(Complex64::ONE)
        };
        frfs = frfs.with_values(|at, value| value * factor(at));
        oddities.push(Oddity::Form(form));
    }
    if let Some((factor, between)) = unit::off_by_units(&frfs, modelled)
        && !oddities.iter().any(|oddity| matches!(oddity, Oddity::Masses(_)))
    {
        frfs = frfs.with_values(|_, value| value / factor);
        oddities.push(Oddity::Unit { factor, between });
    }
    frfs
}

/// What the fixture makes of the same FRFs, as accelerances; `None` where it has no model, or the FRFs are of another form.
fn modelled(frfs: &FrfSet, fixture: &Fixture) -> Option<Vec<Complex64>> {
    if frfs.form() != FrfForm::Accelerance {
        return None;
    }
    accelerances(fixture, frfs.pairs(), frfs.lines(), Instrument::AsRecorded).ok()
}

/// The FRFs that have a signal.
fn alive(frfs: FrfSet, oddities: &mut Vec<Oddity>) -> Result<FrfSet, ScreeningError> {
    let size = |index: usize| frfs.values(index).iter().map(|value| value.norm_sqr()).sum::<f64>().sqrt();
    let sizes: Vec<f64> = (0..frfs.pairs().len()).map(size).collect();
    let recorded: Vec<f64> = sizes.iter().copied().filter(|size| *size > 0.0).collect();
    let usual = levels::median(recorded).ok_or(ScreeningError::NothingRecorded)?;
    let dead = |index: usize| sizes[index] <= DEAD * usual;
    let names: Vec<FrfPair> =
        (0..sizes.len()).filter(|i| dead(*i)).map(|i| frfs.pairs()[i].clone()).collect();
    if names.is_empty() {
        return Ok(frfs);
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
            Oddity::Axis(factor) => write!(
                f,
                "the frequency axis is {factor:.4} times what it should be, as where kHz, rad/s or cycles a minute are taken for Hz: divided by it; correct the axis in the file"
            ),
            Oddity::Unit { factor, between } => write!(
                f,
                "all FRFs are {factor:.4} times what the fixture makes of them, as where {between} are taken for each other: divided by it; correct the units in the file, or with --assume-units"
            ),
            Oddity::Masses(slip) => write!(f, "{slip}"),
            Oddity::Exchanged(a, b) => write!(
                f,
                "FRFs {a} and {b} stand under each other's labels: exchanged; correct the node numbers in the file"
            ),
            Oddity::Swapped(a, b) => write!(
                f,
                "points {a} and {b} have each other's place: their channels are swapped, in the cables or in the node numbers of the file: exchanged"
            ),
            Oddity::Unexcited { point, is_reference: true, from, lines } => write!(
                f,
                "from {from:.4} Hz on the blows at {point} leave no coherence, so they do not excite that band: its {lines} lines are left out of their FRFs; a harder tip excites them, or end the band below with --band"
            ),
            Oddity::Unexcited { point, is_reference: false, from, .. } => write!(
                f,
                "above {from:.4} Hz response {point} has no coherence: its sensor or filter ends there; replace it, or use --band"
            ),
        }
    }
}
