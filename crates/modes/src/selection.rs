//! Which poles of the chart are modes: those that stay from order to order and without which the FRFs are
//! explained worse than noise allows.

use num_complex::Complex64;
use std::f64::consts::TAU;

use crate::gram::Terms;
use crate::likelihood::{Likelihood, Poles};
use crate::observed::Observed;
use crate::settings::likelihood::MOST_STEPS;
use crate::settings::selection::{
    DOUBTFUL_DEVIATION, DOUBTFUL_WORTH, FEWEST_SEEN, MOST_CANDIDATES, NEAR_FREQUENCY, NEAR_HALF_WIDTHS,
    OUTSIDE_BAND, OVERDAMPED, PICK_ALIKE, PICK_REACH, PICK_SPACINGS, SEEN_SHARE, UNSETTLED_STEPS, WORTH,
};
use crate::stabilization::Track;

/// Candidates for modes, strongest track first.
pub(crate) fn candidates(tracks: &[Track], orders: usize, observed: &Observed) -> Poles {
    let shortest = FEWEST_SEEN.max((SEEN_SHARE * orders as f64).ceil() as usize);
    let mut long: Vec<&Track> = tracks
        .iter()
        .filter(|track| track.members.len() >= shortest && is_resonance(&track.middle().0, observed))
        .collect();
    long.sort_by_key(|track| std::cmp::Reverse(track.members.len()));
    long.truncate(MOST_CANDIDATES);
    let middles = long.iter().map(|track| track.middle());
    let (poles, participations) = middles.unzip();
    Poles { poles, participations }
}

fn is_resonance(pole: &Complex64, observed: &Observed) -> bool {
    let (first, last) = (observed.omegas[0], observed.omegas[observed.lines() - 1]);
    let margin = OUTSIDE_BAND * (last - first);
    -pole.re < OVERDAMPED * pole.norm() && pole.im > first - margin && pole.im < last + margin
}

/// The most likely poles, without candidates that are not worth their unknowns; `None` where the equations
/// cannot be solved.
pub(crate) fn prune(
    observed: &Observed,
    candidates: Poles,
    terms: Terms,
    refine: bool,
) -> Option<Likelihood> {
    let mut poles = candidates;
    let mut settled = false;
    loop {
        let steps = match (refine, settled) {
            (_, true) => MOST_STEPS,
            (true, false) => UNSETTLED_STEPS,
            (false, false) => 0,
        };
        let Some(fit) = Likelihood::search(observed, poles.clone(), terms, steps, None) else {
            // Two columns of the chart that are one mode leave the equations singular.
            let twin = nearest_twin(&poles)?;
            poles = poles.keep(|r| r != twin);
            continue;
        };
        let worth = worth(observed, &fit);
        let weak: Vec<usize> = (0..worth.len())
            .filter(|&r| worth[r] < 1.0 || !is_resonance(&fit.poles.poles[r], observed))
            .collect();
        if weak.is_empty() {
            if !refine {
                return Some(fit);
            }
            if settled {
                match without_a_double(observed, &fit, &worth) {
                    Some(fewer) => poles = fewer,
                    None => return Some(fit),
                }
            } else {
                settled = true;
                poles = fit.poles;
            }
            continue;
        }
        // One of two poles at one place makes the other worthless: only the weakest goes, and its like far
        // from it.
        let mut order = weak;
        order.sort_by(|a, b| worth[*a].total_cmp(&worth[*b]));
        let mut gone: Vec<usize> = Vec::new();
        for r in order {
            let near = |other: &usize| {
                let (a, b) = (fit.poles.poles[r], fit.poles.poles[*other]);
                (a - b).norm() < NEAR_HALF_WIDTHS * (-a.re - b.re) + NEAR_FREQUENCY * a.norm()
            };
            if !gone.iter().any(near) {
                gone.push(r);
            }
        }
        poles = fit.poles.keep(|r| !gone.contains(&r));
    }
}

/// Of the two poles nearest to one another in half-widths, the one that stands later.
fn nearest_twin(poles: &Poles) -> Option<usize> {
    let all = &poles.poles;
    let pairs = (1..all.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
    let distance = |(a, b): (usize, usize)| (all[a] - all[b]).norm() / (all[a].re + all[b].re).abs();
    pairs.min_by(|x, y| distance(*x).total_cmp(&distance(*y))).map(|(_, later)| later)
}

/// The poles without one that the others, moved a little, make up for.
fn without_a_double(observed: &Observed, fit: &Likelihood, worth: &[f64]) -> Option<Poles> {
    let covariance = fit.pole_covariance();
    let mut doubtful: Vec<usize> = (0..worth.len())
        .filter(|&r| worth[r] < DOUBTFUL_WORTH || covariance[r][0][0].sqrt() > DOUBTFUL_DEVIATION)
        .collect();
    doubtful.sort_by(|a, b| worth[*a].total_cmp(&worth[*b]));
    doubtful.into_iter().find_map(|r| {
        let fewer = fit.poles.keep(|other| other != r);
        let without = Likelihood::search(observed, fewer, fit.terms, MOST_STEPS, None)?;
        (without.chi2 - fit.chi2 < needed(observed, fit)).then_some(without.poles)
    })
}

/// Rise of χ² that a mode must be worth.
fn needed(observed: &Observed, fit: &Likelihood) -> f64 {
    let unknowns = 2 * observed.grid.rows.len() + 2 * observed.grid.columns;
    let scale = fit.chi2_per_dof(observed).max(1.0);
    scale * WORTH * unknowns as f64 * (observed.degrees() as f64).ln()
}

/// What each mode is worth: its rise of χ² over that which it must have.
pub(crate) fn worth(observed: &Observed, fit: &Likelihood) -> Vec<f64> {
    let needed = needed(observed, fit);
    fit.significance.iter().map(|rise| rise / needed).collect()
}

/// Whether a pole lies in the band of the lines.
pub(crate) fn is_inside(pole: &Complex64, observed: &Observed) -> bool {
    let natural = pole.norm();
    natural >= observed.omegas[0] && natural <= observed.omegas[observed.lines() - 1]
}

/// Poles of the chart nearest to frequencies picked, Hz; the frequency and the nearest pole's where there is
/// none within reach.
pub(crate) fn picked(tracks: &[Track], picks: &[f64], observed: &Observed) -> Result<Poles, (f64, f64)> {
    let mut poles = Poles { poles: Vec::new(), participations: Vec::new() };
    for &pick in picks {
        // Of the columns of poles within reach the longest; a pick is read off a chart, to a percent or so.
        let distance = |track: &Track| (track.middle().0.norm() / TAU - pick).abs();
        let Some(nearest) = tracks.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))) else {
            return Err((pick, f64::NAN));
        };
        let spacing =
            (observed.omegas[observed.lines() - 1] - observed.omegas[0]) / observed.lines() as f64 / TAU;
        let reach = (PICK_REACH * pick).max(PICK_SPACINGS * spacing);
        if distance(nearest) > reach {
            return Err((pick, nearest.middle().0.norm() / TAU));
        }
        // Near one another in frequency, the column that is seen at most orders.
        let close = distance(nearest).max(PICK_ALIKE * reach);
        let best = tracks
            .iter()
            .filter(|track| distance(track) <= close && !poles.poles.contains(&track.middle().0))
            .max_by_key(|track| track.members.len());
        let (pole, participation) = best.unwrap_or(nearest).middle();
        poles.poles.push(pole);
        poles.participations.push(participation);
    }
    Ok(poles)
}
