//! The joint from all FRFs, on recordings that the simulated laboratory makes: it shares no mechanics with
//! the model fitted.

mod accuracy;
mod laws;
mod physics;

use jointscope::decomposition::{
    JointFit, JointFitOptions, LawKind, Relation, Sides, decompose, fit_joint, maximum_likelihood,
};
use jointscope::fixture::{Fixture, JointLaw};
use jointscope::lumped::nominal_stiffness;
use jointscope::spectra::{FrfSet, SpectralLines};
use jointscope_rig::{Instrument, drawn_within_tolerance, generator};
use jointscope_samples::{Noise, transverse};

pub(crate) const EIGHT: [(&str, &str); 8] =
    [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2"), ("1", "1"), ("2", "1"), ("4", "4"), ("3", "4")];

/// What the joint is.
#[derive(Clone, Copy)]
pub(crate) struct Case {
    /// k11, k12, k22.
    pub stiffness: [f64; 3],
    /// c11, c12, c22; nothing where they are zero.
    pub damping: [f64; 3],
    /// A beam with structural damping of the whole in place of the matrices.
    pub beam: bool,
}

impl Case {
    pub(crate) fn ordinary() -> Self {
        Case { stiffness: [2.4e6, -8.4e4, 4.1e3], damping: [12.0, -0.35, 0.02], beam: false }
    }

    /// k and c of rank one: smallest eigenvalues of zero.
    fn edge() -> Self {
        Case { stiffness: [2.4e6, -8.4e4, 2.94e3], damping: [12.0, -0.36, 0.0108], beam: false }
    }
}

/// Two blocks on a joint, tolerances as of a weighed and measured fixture.
pub(crate) fn fixture(case: &Case, physics: &str) -> Fixture {
    let q = |value: f64, std: f64| format!(r#"{{"value": {value}, "std": {std}}}"#);
    let block = |mass: f64, inertia: f64, x: f64| {
        format!(
            r#"{{ "mass": {}, "inertia": {}, "x_cg": {} }}"#,
            q(mass, 1e-3 * mass),
            q(inertia, 5e-3 * inertia),
            q(x, 1e-4)
        )
    };
    let point = |body: &str, x: f64| format!(r#"{{ "body": "{body}", "x": {} }}"#, q(x, 1e-4));
    let matrix = |[a, b, d]: [f64; 3], std: f64| {
        let [a, b, d] = [a, b, d].map(|e| q(e, std * e.abs()));
        format!("[[{a}, {b}], [{b}, {d}]]")
    };
    // On the edge a drawn matrix would be beyond it.
    let stiffness_std = if case.stiffness[2] == 4.1e3 { 0.01 } else { 0.0 };
    let damping = match case.damping {
        [0.0, ..] => String::new(),
        damping => format!(r#", "damping": {}"#, matrix(damping, 0.0)),
    };
    let (joint, losses) = if case.beam {
        let beam = r#""beam": { "youngs_modulus": {"value": 2.07e11, "std": 1e9}, "second_moment": {"value": 3.4e-10, "std": 2e-12} }"#;
        (
            beam.to_owned(),
            r#""damping": {"rayleigh": {"mass": {"value": 0, "std": 0}, "stiffness": {"value": 5e-6, "std": 0}}},"#,
        )
    } else {
        (format!(r#""stiffness": {}{damping}"#, matrix(case.stiffness, stiffness_std)), "")
    };
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ "A": {}, "B": {} }}, "points": {{ "1": {}, "2": {}, "3": {}, "4": {} }},
            "joints": {{ "J": {{ "from": "2", "to": "3", {joint} }} }}, {losses} "physics": [{physics}] }}"#,
        block(1.102, 5.9e-4, -0.031),
        block(1.485, 1.02e-3, 0.104),
        point("A", -0.056),
        point("A", 0.0),
        point("B", 0.07),
        point("B", 0.131),
    ))
    .unwrap()
}

pub(crate) fn lines() -> SpectralLines {
    SpectralLines::even(4.0, 4.0, 300).unwrap()
}

pub(crate) fn recorded(truth: &Fixture, noise: &mut Noise, relative: f64, pairs: &[(&str, &str)]) -> FrfSet {
    noise.on(
        &jointscope_rig::frfs(truth, &transverse(pairs), &lines(), Instrument::Perfect).unwrap(),
        relative,
    )
}

/// k11, k12, k22, c11, c12, c22 that a fixture states.
pub(crate) fn six(fixture: &Fixture) -> [f64; 6] {
    match &fixture.joints()[0].law {
        JointLaw::Stiffness { stiffness: [a, b, d], damping: Some([e, f, g]) } => {
            [a, b, d, e, f, g].map(|q| q.value)
        }
        _ => unreachable!(),
    }
}

fn found(fit: &JointFit) -> [f64; 6] {
    let (k, c) = (&fit.stiffness, &fit.damping);
    [k.at(0, 0), k.at(0, 1), k.at(1, 1), c.at(0, 0), c.at(0, 1), c.at(1, 1)]
}

pub(crate) fn fit(fixture: &Fixture, frfs: &FrfSet, laws: bool) -> JointFit {
    let sides = Sides::of(fixture, None).unwrap();
    let spectrum = decompose(frfs, &sides, Relation::Exact).unwrap();
    let nominal = nominal_stiffness(&sides.joint().law, sides.length());
    let near = maximum_likelihood(frfs, &sides, &spectrum, None, Some(nominal)).ok();
    let options = JointFitOptions { laws, ..Default::default() };
    fit_joint(frfs, &sides, spectrum.scalar, near.as_ref(), nominal, options).unwrap()
}

/// The tests of what physics allows.
const TESTS: [&str; 3] = ["reciprocity", "definite", "passive"];

/// What many drawn fixtures give: errors of the six numbers in standard deviations, relative errors,
/// p-values.
#[derive(Default)]
struct Runs {
    scores: Vec<[f64; 6]>,
    errors: Vec<[f64; 6]>,
    p: [Vec<f64>; 3],
    chi2: Vec<f64>,
}

fn run(case: &Case, count: u64, seed: u64) -> Runs {
    run_of(case, (count, seed), 0.01, &EIGHT)
}

/// The same of these FRFs with this noise.
fn run_of(case: &Case, (count, seed): (u64, u64), level: f64, frfs: &[(&str, &str)]) -> Runs {
    let fixture = fixture(case, "");
    let (mut rng, mut noise) = (generator(seed), Noise::new(seed));
    let mut runs = Runs::default();
    for _ in 0..count {
        let truth = drawn_within_tolerance(&fixture, &mut rng).unwrap();
        let fit = fit(&fixture, &recorded(&truth, &mut noise, level, frfs), false);
        let (found, expected) = (found(&fit), six(&truth));
        runs.scores.push(std::array::from_fn(|e| (found[e] - expected[e]) / fit.covariance[e][e].sqrt()));
        runs.errors.push(std::array::from_fn(|e| found[e] / expected[e] - 1.0));
        for (all, p) in runs.p.iter_mut().zip([fit.tests.reciprocity, fit.tests.definite, fit.tests.passive])
        {
            all.extend(p);
        }
        runs.chi2.push(fit.chi2_per_dof);
    }
    runs
}

pub(crate) fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), v| (sum + v * v, count + 1));
    (sum / f64::from(count)).sqrt()
}

pub(crate) const NAMES: [&str; 6] = ["k11", "k12", "k22", "c11", "c12", "c22"];

fn report(runs: &Runs) {
    let n = runs.scores.len();
    println!("{n} runs, chi2 per dof {:.3}", runs.chi2.iter().sum::<f64>() / n as f64);
    for (e, name) in NAMES.iter().enumerate() {
        let inside = runs.scores.iter().filter(|s| s[e].abs() < 1.96).count();
        println!(
            "{name}: rms error {:.3} %, rms of error/std {:.3}, 95 % intervals hold {:.1} %",
            100.0 * rms(runs.errors.iter().map(|s| s[e])),
            rms(runs.scores.iter().map(|s| s[e])),
            100.0 * inside as f64 / n as f64
        );
    }
    print_p_values(&runs.p);
}

/// How small the p-values of the three tests are.
fn print_p_values(all: &[Vec<f64>; 3]) {
    for (name, p) in TESTS.iter().zip(all) {
        let below = [0.01, 0.05, 0.2, 0.5, 0.8].map(|q| p.iter().filter(|p| **p < q).count());
        println!("{name}: p below 0.01, 0.05, 0.2, 0.5, 0.8 of {}: {below:?}", p.len());
    }
}

/// Largest difference between the share of p-values below a probability and that probability.
pub(crate) fn from_uniform(p: &[f64]) -> f64 {
    let mut p = p.to_vec();
    p.sort_by(f64::total_cmp);
    let n = p.len() as f64;
    p.iter()
        .enumerate()
        .map(|(i, p)| (p - i as f64 / n).abs().max((p - (i + 1) as f64 / n).abs()))
        .fold(0.0, f64::max)
}

pub(crate) fn parameters_of(kind: LawKind, heavy: bool) -> usize {
    let own = match kind {
        LawKind::Constant => 3,
        LawKind::Viscous | LawKind::Structural => 6,
        LawKind::StandardLinearSolid | LawKind::Fractional => 7,
        LawKind::LinearStiffness => 9,
    };
    own + usize::from(heavy)
}
