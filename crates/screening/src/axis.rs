//! A frequency axis in another unit than its file says.

use crate::levels::{median, ratios_apart};
use crate::settings::axis::UNLIKE_FIXTURE;
use crate::settings::levels::LIKE_FIXTURE;
use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, accelerances};
use jointscope_spectra::{FrfSet, SpectralLines};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// What lies between units of frequency that are taken for each other: kHz, rad/s, and cycles a minute.
const BETWEEN: [f64; 3] = [1000.0, TAU, 60.0];

/// The factor by which the frequencies of all lines are too large: FRFs are nothing like the fixture's at
/// these frequencies, `modelled`, and like them at those over the factor.
pub(crate) fn off_axis(frfs: &FrfSet, modelled: &[Complex64], fixture: &Fixture) -> Option<f64> {
    let apart = |modelled: &[Complex64]| median(ratios_apart(frfs.all_values(), modelled));
    if apart(modelled)? < UNLIKE_FIXTURE {
        return None;
    }
    BETWEEN.into_iter().flat_map(|factor| [factor, factor.recip()]).find(|factor| {
        let there = over(frfs.lines(), *factor)
            .and_then(|lines| accelerances(fixture, frfs.pairs(), &lines, Instrument::AsRecorded).ok());
        there.and_then(|modelled| apart(&modelled)).is_some_and(|apart| apart < LIKE_FIXTURE)
    })
}

/// The same lines at frequencies over a factor.
pub(crate) fn over(lines: &SpectralLines, factor: f64) -> Option<SpectralLines> {
    SpectralLines::new(lines.hz().iter().map(|hz| hz / factor).collect()).ok()
}
