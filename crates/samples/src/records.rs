//! What an analyser makes of a blow's record.

use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};

/// The transform of a blow sin²(πt/d) of duration d about t = 0.
fn force(omega: f64, duration: f64) -> f64 {
    let sinc = |x: f64| if x.abs() < 1e-12 { 1.0 } else { x.sin() / x };
    let half = 0.5 * omega * duration;
    0.5 * duration * (sinc(half) + 0.5 * (sinc(half - PI) + sinc(half + PI)))
}

/// A blow sin²(πt/d): when its middle comes and how long it lasts, s.
pub type Blow = (f64, f64);

/// The accelerances on `lines` as they are estimated from records that end after the reciprocal of the lines'
/// distance, of a blow for each FRF. `exact` are those of the structure on lines from their own distance on,
/// which is a whole part of that of `lines`, up to where blows excite nothing any more: a signal that repeats
/// itself after the reciprocal of that distance, long after the structure is silent.
pub fn of_records(exact: &FrfSet, lines: &SpectralLines, blow: impl Fn(&FrfPair) -> Blow) -> FrfSet {
    let hz = exact.lines().hz();
    let length = 1.0 / (lines.hz()[1] - lines.hz()[0]);
    let omegas: Vec<f64> = hz.iter().map(|hz| TAU * hz).collect();
    let distance = hz[1] - hz[0];
    let mut values = Vec::new();
    for (frf, pair) in exact.pairs().iter().enumerate() {
        let (at, duration) = blow(pair);
        let signal: Vec<Complex64> = exact
            .values(frf)
            .iter()
            .zip(&omegas)
            .map(|(value, omega)| value * force(*omega, duration) * Complex64::cis(-omega * at))
            .collect();
        for omega in lines.omegas() {
            // ∫ e^{i(ω′ − ω)t} dt over the record, of either sign of ω′.
            let part = |other: f64| {
                let difference = other - omega;
                match difference.abs() < 1e-9 * omega {
                    true => Complex64::from(length),
                    false => (Complex64::cis(difference * length) - 1.0) / Complex64::new(0.0, difference),
                }
            };
            let sum: Complex64 =
                signal.iter().zip(&omegas).map(|(x, &at)| x * part(at) + x.conj() * part(-at)).sum();
            let force = force(omega, duration) * Complex64::cis(-omega * at);
            values.push(sum * distance / force);
        }
    }
    FrfSet::new(lines.clone(), FrfForm::Accelerance, exact.pairs().to_vec(), values).unwrap()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transverse;

    #[test]
    fn a_mass_at_rest_after_its_blow_is_recorded_as_it_is_and_a_mode_that_rings_is_not() {
        let fine = SpectralLines::even(0.25, 0.25, 12_000).unwrap();
        let lines = SpectralLines::even(20.0, 2.5, 300).unwrap();
        let recorded = |accelerance: &dyn Fn(f64) -> Complex64| {
            let values = |lines: &SpectralLines| lines.hz().iter().map(|hz| accelerance(*hz)).collect();
            let set = |lines: &SpectralLines| {
                FrfSet::new(lines.clone(), FrfForm::Accelerance, transverse(&[("1", "1")]), values(lines))
                    .unwrap()
            };
            let (exact, of) = (set(&lines), of_records(&set(&fine), &lines, |_| (0.01, 8e-4)));
            let off = exact.values(0).iter().zip(of.values(0)).map(|(a, b)| (a - b).norm() / a.norm());
            off.fold(0.0, f64::max)
        };
        let rigid = recorded(&|_| Complex64::from(0.5));
        assert!(rigid < 1e-3, "{rigid}");
        // Of 200 Hz and 0.4 %: e^{−2} is left after 0.4 s.
        let ringing = recorded(&|hz| -hz * hz / Complex64::new(200.0 * 200.0 - hz * hz, 0.008 * 200.0 * hz));
        assert!(ringing > 0.1, "{ringing}");
    }
}
