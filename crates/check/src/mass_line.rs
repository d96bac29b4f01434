//! The mass line: below its first bending mode a free structure moves as one rigid body, and its accelerances
//! tell its mass.
//!
//! There A_ij = 1/M + (x_i − x_G)(x_j − x_G)/J, and what the bending modes add grows as ω². Real parts are
//! fitted by a₀ + a₁ω²/(1 − ω²/ω₁²) + a₂ω², the first bending mode and all others (on supports with a₋₁/ω²
//! besides); the same fit is made to the fixture's own FRFs on the same lines. The a₀ of three or more FRFs
//! at different places give mass, centre of gravity and inertia as the recording weighs them, linear in
//! 1/M + x_G²/J, x_G/J and 1/J.

use crate::figure::deviations;
use crate::settings::mass_line::{
    BAND, FEWEST_LINES, FIXTURE_SHARE, FRF_TOLERANCE, LEAST_DEVIATIONS, LEAST_ERROR, MASS_TOLERANCE,
    RECORDED_SHARE,
};
use crate::{Figure, ModelModes, RecordedModes, Totals};
use jointscope_fixture::Fixture;
use jointscope_linalg::LeastSquares;
use jointscope_spectra::{Dof, FrfPair, FrfSet, in_sentence};
use num_complex::Complex64;
use serde::Serialize;
use std::collections::BTreeSet;

/// The mass line of one FRF.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MassLineFrf {
    /// The FRF.
    pub frf: FrfPair,
    /// Its accelerance as a rigid body, 1/kg.
    pub recorded: Figure,
    /// The fixture's by the same fit, 1/kg.
    pub fixture: f64,
    /// Whether the two are apart by more than their deviation and a tenth of the largest.
    pub odd: bool,
}

/// What the recording weighs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MassLine {
    /// Lines in use, Hz.
    pub band: (f64, f64),
    /// FRF by FRF.
    pub frfs: Vec<MassLineFrf>,
    /// Total mass as the recording has it; `None` where its FRFs do not tell it.
    pub mass: Option<Figure>,
    /// The same from the fixture's FRFs between the same channels, kg: how well they tell it.
    pub fixture_mass: Option<f64>,
    /// Whether the two are apart by more than their deviations and 3 %.
    pub odd: bool,
}

/// The mass line of accelerances with variances, `modelled` the fixture's of the same FRFs.
///
/// # Errors
/// Why there is none, in a sentence.
pub(crate) fn of(
    fixture: &Fixture,
    frfs: &FrfSet,
    modelled: &[Complex64],
    totals: &Totals,
    modes: &ModelModes,
    recorded: Option<&RecordedModes>,
) -> Result<MassLine, String> {
    let rigid = RigidBand::of(frfs.lines().hz(), modes, recorded)?;
    let frfs = intercepts(frfs, modelled, &rigid);
    let (mass, fixture_mass) = masses(fixture, &frfs, totals);
    let odd = mass.is_some_and(|(mass, std)| {
        let apart = (mass - totals.mass.value).abs();
        apart > MASS_TOLERANCE * totals.mass.value
            && apart > LEAST_DEVIATIONS * std.hypot(totals.mass.std.unwrap_or(0.0))
    });
    let mass = mass.map(|(value, std)| Figure { value, std: Some(std), unit: "kg" });
    Ok(MassLine { band: rigid.band, frfs, mass, fixture_mass, odd })
}

/// The lines on which the structure moves as one rigid body.
struct RigidBand {
    /// Lines in use, by their places.
    used: Vec<usize>,
    /// The first and the last of them, Hz.
    band: (f64, f64),
    /// Whether supports hold the structure.
    supported: bool,
    /// The recording's own first bending mode, and the fixture's first elastic one, Hz.
    bending: f64,
    elastic: f64,
}

impl RigidBand {
    fn of(hz: &[f64], modes: &ModelModes, recorded: Option<&RecordedModes>) -> Result<Self, String> {
        let on_supports = modes.highest_on_supports();
        if modes.rigid == 0 && on_supports == 0.0 {
            return Err("the structure is held: it has no rigid-body motion to weigh it by".to_owned());
        }
        let elastic =
            modes.first_elastic().ok_or("the model has no elastic mode above which a mass line would end")?;
        // The recording's own first bending mode may lie lower than the fixture's.
        let bending = recorded.iter().flat_map(|recorded| &recorded.modes).map(|mode| mode.frequency);
        let bending = bending.filter(|hz| *hz > BAND.0 * on_supports).reduce(f64::min).unwrap_or(elastic);
        let lowest = bending.min(elastic);
        let (low, high) = (BAND.0 * on_supports, BAND.1 * lowest);
        let used: Vec<usize> =
            (0..hz.len()).filter(|&k| hz[k] > 0.0 && hz[k] >= low && hz[k] <= high).collect();
        if low >= high {
            return Err(format!(
                "the highest mode on the supports, {} Hz, is too near the first bending mode, {} Hz: at no frequency between them does the structure move as one rigid body; a softer suspension would weigh it",
                in_sentence(on_supports),
                in_sentence(lowest)
            ));
        }
        if used.len() < FEWEST_LINES {
            return Err(format!(
                "{} of the recording lie between {} and {} Hz, where the structure moves as one rigid body: a finer resolution or a lower first line would weigh it",
                if used.is_empty() { "no lines".to_owned() } else { format!("only {} lines", used.len()) },
                in_sentence(low),
                in_sentence(high)
            ));
        }
        let band = (hz[used[0]], hz[used[used.len() - 1]]);
        Ok(RigidBand { used, band, supported: on_supports > 0.0, bending, elastic })
    }
}

/// The transverse FRFs as a rigid body's, recorded and modelled, and whether the two are odd beside each
/// other.
fn intercepts(frfs: &FrfSet, modelled: &[Complex64], rigid: &RigidBand) -> Vec<MassLineFrf> {
    let hz = frfs.lines().hz();
    let transverse =
        |pair: &FrfPair| pair.response.dof == Dof::Translation && pair.reference.dof == Dof::Translation;
    let mut all = Vec::new();
    for index in (0..frfs.pairs().len()).filter(|&index| transverse(&frfs.pairs()[index])) {
        let variance = frfs.variance(index).unwrap_or_default();
        let weight = |k: usize| variance.get(k).map_or(1.0, |v| 1.0 / (0.5 * v).max(f64::MIN_POSITIVE));
        let fixtures = &modelled[index * hz.len()..(index + 1) * hz.len()];
        let fitted = |values: &[Complex64], first: f64| {
            intercept(hz, values, &rigid.used, weight, (rigid.supported, first))
        };
        let (recorded, model) = (fitted(frfs.values(index), rigid.bending), fitted(fixtures, rigid.elastic));
        if let (Some((value, std)), Some((fixture, _))) = (recorded, model) {
            let recorded = Figure { value, std: Some(std), unit: "1/kg" };
            all.push(MassLineFrf { frf: frfs.pairs()[index].clone(), recorded, fixture, odd: false });
        }
    }
    let largest = largest(&all);
    for line in &mut all {
        let apart = (line.recorded.value - line.fixture).abs();
        line.odd =
            apart > FRF_TOLERANCE * largest && apart > LEAST_DEVIATIONS * line.recorded.std.unwrap_or(0.0);
    }
    all
}

fn largest(lines: &[MassLineFrf]) -> f64 {
    lines.iter().map(|line| line.fixture.abs()).fold(0.0, f64::max)
}

/// The mass with its deviation that the recording tells, and that which the fixture's own FRFs do, kg.
fn masses(fixture: &Fixture, lines: &[MassLineFrf], totals: &Totals) -> (Option<(f64, f64)>, Option<f64>) {
    let rotating = fixture.bodies().iter().all(|body| body.kind.rotates());
    let at_best = LEAST_ERROR * largest(lines);
    let recorded = |line: &MassLineFrf| (line.recorded.value, line.recorded.std.unwrap_or(0.0).max(at_best));
    let fixtures = |line: &MassLineFrf| (line.fixture, at_best);
    let ends = lines.iter().flat_map(|line| [&line.frf.response.point, &line.frf.reference.point]);
    let channels: BTreeSet<&str> = ends.map(String::as_str).collect();
    // Places that are not quite where they are said to be weigh more than noise.
    let places = |mass: f64| {
        let moved = |moved: &Fixture| Some(vec![weighed(moved, lines, recorded, rotating)?.0]);
        deviations(fixture, &[mass], &channels, moved)[0].unwrap_or(f64::INFINITY)
    };
    let mass = weighed(fixture, lines, recorded, rotating)
        .map(|(mass, std)| (mass, std.hypot(places(mass))))
        .filter(|(mass, std)| *std < RECORDED_SHARE * mass);
    let fixture_mass = weighed(fixture, lines, fixtures, rotating).map(|(mass, _)| mass);
    // Where the fixture's own FRFs do not tell its mass, the recording's do not either.
    let fixture_mass = fixture_mass.filter(|mass| (mass / totals.mass.value - 1.0).abs() < FIXTURE_SHARE);
    (mass.filter(|_| fixture_mass.is_some()), fixture_mass)
}

/// a₀ of the real parts on the lines `used`, with its standard deviation, that of the noise or of what the
/// fit leaves, whichever is larger.
fn intercept(
    hz: &[f64],
    values: &[Complex64],
    used: &[usize],
    weight: impl Fn(usize) -> f64,
    (supported, first): (bool, f64),
) -> Option<(f64, f64)> {
    let unknowns = if supported { 4 } else { 3 };
    let mut fit = LeastSquares::new();
    fit.begin(unknowns);
    for &k in used {
        let t = (hz[k] / first).powi(2);
        let terms = [1.0, t / (1.0 - t), t, 1.0 / t];
        fit.equation(&terms[..unknowns], Complex64::from(values[k].re), weight(k));
    }
    let mut solution = [Complex64::ZERO; 4];
    let left = fit.solve(&mut solution[..unknowns]).ok()?;
    let degrees = used.len().saturating_sub(unknowns).max(1) as f64;
    Some((solution[0].re, (fit.covariance(0, 0) * (left / degrees).max(1.0)).sqrt()))
}

/// The mass that the intercepts of FRFs tell, with its standard deviation.
fn weighed(
    fixture: &Fixture,
    lines: &[MassLineFrf],
    intercept: impl Fn(&MassLineFrf) -> (f64, f64),
    rotating: bool,
) -> Option<(f64, f64)> {
    let unknowns = if rotating { 3 } else { 1 };
    if lines.len() < unknowns {
        return None;
    }
    let x = |point: &str| fixture.point(point).map(|point| point.x.value);
    let reach = fixture.points().iter().map(|point| point.x.value.abs()).fold(0.0, f64::max).max(1e-9);
    let mut fit = LeastSquares::new();
    fit.begin(unknowns);
    for line in lines {
        let (out, at) = (x(&line.frf.response.point)? / reach, x(&line.frf.reference.point)? / reach);
        let (value, std) = intercept(line);
        fit.equation(&[1.0, out + at, out * at][..unknowns], Complex64::from(value), 1.0 / (std * std));
    }
    let mut solution = [Complex64::ZERO; 3];
    let left = fit.solve(&mut solution[..unknowns]).ok()?;
    let scatter = (left / lines.len().saturating_sub(unknowns).max(1) as f64).max(1.0);
    let [p, q, r] = solution.map(|value| value.re);
    // 1/M = p − q²/r, and its derivatives.
    let (inverse, gradient) = match rotating {
        true if r > 0.0 => (p - q * q / r, [1.0, -2.0 * q / r, (q / r).powi(2)]),
        true => return None,
        false => (p, [1.0, 0.0, 0.0]),
    };
    let variance: f64 = (0..unknowns)
        .flat_map(|i| (0..unknowns).map(move |j| (i, j)))
        .map(|(i, j)| gradient[i] * gradient[j] * fit.covariance(i, j))
        .sum();
    let std = (scatter * variance).sqrt() / (inverse * inverse);
    (inverse > 0.0 && std.is_finite()).then(|| (1.0 / inverse, std))
}
