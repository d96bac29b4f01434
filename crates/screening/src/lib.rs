//! What is odd in recorded FRFs before any physics is asked for.
//!
//! Slips of a test's files look like physics: an FRF under another one's label like a resonator and a missing
//! mass, a dead one like anything. They are told here by what no physics does, put right where it is plain
//! what was meant, left out otherwise, and always said.
//!
//! 1. [dead](Oddity::Dead): no signal on any line. Left out.
//! 2. [no phase](Oddity::NoPhase): real on all lines, where the fixture's structure is damped. Left out.
//! 3. [empty](Oddity::Empty): exactly zero on some lines, as where an analyser fills a band that it does not
//!    export. Left out there.
//! 4. [polar](Oddity::Polar): magnitudes or decibels and phases in the place of real and imaginary parts: what
//!    should be imaginary parts lies at whole half turns. Taken so.
//! 5. [another axis](Oddity::Axis): FRFs are nothing like the fixture's, and like them at frequencies over
//!    1000, 2π or 60. Taken there.
//! 6. [another form](Oddity::Form): the levels fall behind the fixture's as frequency to the power −1 or −2,
//!    whatever the resonances do. Taken as mobility or receptance.
//! 7. [another unit](Oddity::Unit): all levels are off by what lies between two units. Taken in the other
//!    one.
//! 8. [conjugated](Oddity::Conjugated): the phase rises through resonances, so the file's time dependence is
//!    e^{−iωt}. Conjugated.
//! 9. [exchanged](Oddity::Exchanged): two FRFs are each like the fixture's other one, and neither like its
//!    own. Exchanged.
//! 10. [unexcited](Oddity::Unexcited): no coherence over the upper part of the band. In all FRFs of a
//!     reference, left out there; in those of a sensor only said.
//!
//! Two things are told of what cannot be put right: [masses and inertias](Oddity::Masses) of the fixture in
//! another unit, and FRFs of which [a part](Steps) was changed.
//!
//! The fixture is compared as it stands. What it leaves out moves resonances; levels and phases between them
//! hardly change, so all of it goes by medians over the lines.

mod axis;
mod conjugated;
mod empty;
mod exchanged;
mod form;
mod levels;
mod masses;
mod oddity;
mod phase;
mod plausibility;
mod polar;
mod settings;
mod steps;
mod unexcited;
mod unit;

pub use empty::empty_lines;
pub use levels::median;
pub use oddity::Oddity;
pub use plausibility::{Implausible, implausible, plausible};
pub use polar::Polar;
pub use steps::Steps;

use crate::settings::dead::RMS_RATIO;
use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, accelerances};
use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectraError};
use num_complex::Complex64;

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
    /// No FRF has a phase, and the fixture's structure is damped.
    #[error(
        "all FRFs are real on all lines: they are magnitudes or real parts, and without the phase nothing is told; export complex values, real and imaginary part"
    )]
    NoPhase,
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

/// The FRFs of a test of `fixture` as they are meant.
///
/// # Errors
/// [`ScreeningError::NothingRecorded`], [`ScreeningError::NoPhase`], [`ScreeningError::Changed`].
pub fn screened(frfs: FrfSet, fixture: &Fixture) -> Result<Screened, ScreeningError> {
    let mut oddities = Vec::new();
    let mut frfs = alive(frfs, &mut oddities)?;
    if phase::lacks(&frfs) && is_damped(&frfs, fixture) {
        let (left, without) = phase::with_phase(&frfs).ok_or(ScreeningError::NoPhase)?;
        frfs = left;
        oddities.push(without);
    }
    if let Some(empty) = empty_lines(&frfs) {
        frfs = empty::without_empty_lines(frfs);
        oddities.push(empty);
    }
    let mut modelled = modelled(&frfs, fixture);
    if let Some(reading) = polar::polar(&frfs, modelled.as_deref()) {
        frfs = frfs.with_values(|_, value| reading.value(value));
        oddities.push(Oddity::Polar(reading));
    }
    if let Some(steps) = steps::steps(&frfs) {
        return Err(ScreeningError::Changed(Box::new(steps)));
    }
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
        let model = |frfs: &FrfSet| self::modelled(frfs, fixture);
        if let Some((a, b, labels)) = exchanged::swapped(&frfs, modelled, &found, model) {
            oddities.push(Oddity::Swapped(a, b));
            pairs = labels;
        } else {
            let exchanged = |&(a, b): &(usize, usize)| Oddity::Exchanged(pairs[a].clone(), pairs[b].clone());
            oddities.extend(found.iter().map(exchanged));
            found.into_iter().for_each(|(a, b)| pairs.swap(a, b));
        }
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

/// What the fixture makes of the same FRFs, as accelerances; `None` where it has no model, or the FRFs are of
/// another form.
fn modelled(frfs: &FrfSet, fixture: &Fixture) -> Option<Vec<Complex64>> {
    if frfs.form() != FrfForm::Accelerance {
        return None;
    }
    accelerances(fixture, frfs.pairs(), frfs.lines(), Instrument::AsRecorded).ok()
}

/// Whether the fixture's FRFs have a phase; those of one without a model may have.
fn is_damped(frfs: &FrfSet, fixture: &Fixture) -> bool {
    modelled(frfs, fixture).is_none_or(|model| model.iter().any(|value| value.im != 0.0))
}

/// The FRFs that have a signal.
fn alive(frfs: FrfSet, oddities: &mut Vec<Oddity>) -> Result<FrfSet, ScreeningError> {
    let size = |index: usize| frfs.values(index).iter().map(|value| value.norm_sqr()).sum::<f64>().sqrt();
    let sizes: Vec<f64> = (0..frfs.pairs().len()).map(size).collect();
    let recorded: Vec<f64> = sizes.iter().copied().filter(|size| *size > 0.0).collect();
    let usual = levels::median(recorded).ok_or(ScreeningError::NothingRecorded)?;
    let dead = |index: usize| sizes[index] <= RMS_RATIO * usual;
    let names: Vec<FrfPair> =
        (0..sizes.len()).filter(|i| dead(*i)).map(|i| frfs.pairs()[i].clone()).collect();
    if names.is_empty() {
        return Ok(frfs);
    }
    oddities.push(Oddity::Dead(names));
    frfs.of_frfs(|index| !dead(index)).ok_or(ScreeningError::NothingRecorded)
}
