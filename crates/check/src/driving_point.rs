//! Driving points: FRFs whose sensor sits where the hammer strikes.
//!
//! A passive structure takes in power through a driving point at every frequency, so the real part of its
//! mobility is never negative. With the accelerance A that is Re(A/s) ≥ 0, s = iω (or δ + iω under an
//! exponential window): its imaginary part has one sign throughout, at resonances and between them.

use crate::settings::driving_points::{FEWEST_LINES, MIXED_SHARE, STANDS_OUT, TURNED_SHARE};
use jointscope_spectra::{FrfPair, FrfSet};
use num_complex::Complex64;
use serde::Serialize;

/// What the signs of a driving point say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum DrivingPointVerdict {
    /// Power goes in wherever it can be told.
    Passive,
    /// Power would come out nearly everywhere: sensor and hammer point opposite ways.
    Turned,
    /// Power would come out on some lines: sensor and hammer are not at one point, or the phase is off.
    Mixed,
    /// Too few lines stand out of the noise.
    NotJudged,
}

/// A driving point's signs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrivingPoint {
    /// The FRF.
    pub frf: FrfPair,
    /// Lines on which the real part of the mobility stands out of its noise.
    pub judged_lines: usize,
    /// Share of them on which it is negative.
    pub negative: f64,
    /// What that says.
    pub verdict: DrivingPointVerdict,
}

/// The driving points among accelerances with variances; `decay` (1/s) of the window over them.
pub(crate) fn of(frfs: &FrfSet, decay: f64) -> Vec<DrivingPoint> {
    let at_one_point = |index: &usize| frfs.pairs()[*index].response == frfs.pairs()[*index].reference;
    (0..frfs.pairs().len()).filter(at_one_point).map(|index| judged(frfs, index, decay)).collect()
}

fn judged(frfs: &FrfSet, index: usize, decay: f64) -> DrivingPoint {
    let variance = frfs.variance(index).unwrap_or_default();
    let (mut lines, mut negative) = (0, 0);
    for ((value, omega), variance) in frfs.values(index).iter().zip(frfs.lines().omegas()).zip(variance) {
        let s = Complex64::new(decay, omega);
        if omega == 0.0 {
            continue;
        }
        let mobility = (value / s).re;
        if mobility.abs() > STANDS_OUT * (0.5 * variance).sqrt() / s.norm() {
            lines += 1;
            negative += usize::from(mobility < 0.0);
        }
    }
    let share = negative as f64 / f64::max(lines as f64, 1.0);
    let verdict = match share {
        _ if lines < FEWEST_LINES => DrivingPointVerdict::NotJudged,
        share if share > TURNED_SHARE => DrivingPointVerdict::Turned,
        share if share > MIXED_SHARE => DrivingPointVerdict::Mixed,
        _ => DrivingPointVerdict::Passive,
    };
    DrivingPoint { frf: frfs.pairs()[index].clone(), judged_lines: lines, negative: share, verdict }
}
