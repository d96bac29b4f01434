//! Several poles at one place that are one pole which moved from FRF to FRF.
//!
//! Of many lines, poles that no FRF has by itself pay: two or three beside each other, mixed otherwise in
//! each FRF, follow a resonance that is elsewhere in each. As [drift](crate::DriftingMode) it takes fewer
//! unknowns.

use num_complex::Complex64;

use crate::likelihood::{Likelihood, Poles, Prior};
use crate::observed::Observed;
use crate::settings::drift::ONE_PLACE;
use crate::settings::each_frf::{FEWEST_FRFS, HELD, OWN_STEPS};
use crate::settings::likelihood::MOST_STEPS;

/// The fit with one pole at every place where several explain no more than one that moves from FRF to FRF.
pub(crate) fn one_at_each_place(observed: &Observed, fit: Likelihood) -> Likelihood {
    let mut fit = fit;
    while let Some(fewer) = with_one_fewer_place(observed, &fit) {
        fit = fewer;
    }
    fit
}

fn with_one_fewer_place(observed: &Observed, fit: &Likelihood) -> Option<Likelihood> {
    if observed.frfs() < FEWEST_FRFS {
        return None;
    }
    let poles = &fit.poles.poles;
    let is_near = |r: usize, s: usize| {
        r != s && (poles[r] - poles[s]).norm() < ONE_PLACE * -(poles[r].re + poles[s].re)
    };
    let mut strongest: Vec<usize> = (0..poles.len()).collect();
    strongest.sort_by(|&r, &s| fit.significance[s].total_cmp(&fit.significance[r]));
    // What an unknown must gain, as of any model of so many numbers (Schwarz 1978).
    let needed = fit.chi2_per_dof(observed).max(1.0) * (observed.degrees() as f64).ln();
    let shared = fit.chi2 + needed * fit.unknowns() as f64;
    strongest.into_iter().filter(|&r| (0..poles.len()).any(|s| is_near(r, s))).find_map(|r| {
        let fewer = fit.poles.keep(|s| !is_near(r, s));
        let one = moving(observed, fit, &fewer, needed)?;
        let several = moving(observed, fit, &fit.poles, needed).unwrap_or(f64::INFINITY);
        if one >= shared.min(several) {
            return None;
        }
        Likelihood::search(observed, fewer, fit.terms, MOST_STEPS, None)
    })
}

/// χ² of the FRFs each with poles of its own near `poles`, and what their unknowns must gain.
fn moving(observed: &Observed, fit: &Likelihood, poles: &Poles, needed: f64) -> Option<f64> {
    let prior = Prior { poles: poles.poles.clone(), std: HELD };
    let one = vec![Complex64::ONE];
    let start = Poles { poles: poles.poles.clone(), participations: vec![one; poles.poles.len()] };
    let of = |frf: usize| {
        let own =
            Likelihood::search(&observed.single(frf), start.clone(), fit.terms, OWN_STEPS, Some(&prior))?;
        Some(own.chi2 + needed * own.unknowns() as f64)
    };
    (0..observed.frfs()).map(of).sum()
}
