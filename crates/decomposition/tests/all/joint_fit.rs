//! The joint from all FRFs, on recordings that the simulated laboratory makes: it shares no mechanics with the model fitted.

use crate::common::Noise;
use jointscope_decomposition::{
    Analysis, AnalysisOptions, JointFit, JointFitOptions, LawKind, Relation, Sides, decompose, fit_joint, maximum_likelihood,
};
use jointscope_fixture::{Fixture, JointLaw};
use jointscope_lumped::nominal_stiffness;
use jointscope_rig::{Instrument, drawn_within_tolerance, generator};
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};

const EIGHT: [(&str, &str); 8] =
    [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2"), ("1", "1"), ("2", "1"), ("4", "4"), ("3", "4")];

/// Two blocks whose joint has a stiffness and dashpots of its own, tolerances as of a weighed and measured fixture.
fn fixture(physics: &str) -> Fixture {
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
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ "A": {}, "B": {} }}, "points": {{ "1": {}, "2": {}, "3": {}, "4": {} }},
            "joints": {{ "J": {{ "from": "2", "to": "3",
                "stiffness": [[{}, {}], [{}, {}]], "damping": [[12.0, -0.35], [-0.35, 0.02]] }} }}, "physics": [{physics}] }}"#,
        block(1.102, 5.9e-4, -0.031),
        block(1.485, 1.02e-3, 0.104),
        point("A", -0.056),
        point("A", 0.0),
        point("B", 0.07),
        point("B", 0.131),
        q(2.4e6, 2.4e5),
        q(-8.4e4, 4e3),
        q(-8.4e4, 4e3),
        q(4.1e3, 4e2),
    ))
    .unwrap()
}

fn lines() -> SpectralLines {
    SpectralLines::even(4.0, 4.0, 300).unwrap()
}

fn recorded(truth: &Fixture, noise: &mut Noise, relative: f64, pairs: &[(&str, &str)]) -> FrfSet {
    let pairs: Vec<FrfPair> = pairs.iter().map(|(o, i)| FrfPair::transverse(o, i)).collect();
    noise.on(&jointscope_rig::frfs(truth, &pairs, &lines(), Instrument::Perfect).unwrap(), relative)
}

/// k11, k12, k22, c11, c12, c22 that a fixture states.
fn six(fixture: &Fixture) -> [f64; 6] {
    match &fixture.joints()[0].law {
        JointLaw::Stiffness { stiffness: [a, b, d], damping: Some([e, f, g]) } => [a, b, d, e, f, g].map(|q| q.value),
        _ => unreachable!(),
    }
}

fn found(fit: &JointFit) -> [f64; 6] {
    let (k, c) = (&fit.stiffness, &fit.damping);
    [k.at(0, 0), k.at(0, 1), k.at(1, 1), c.at(0, 0), c.at(0, 1), c.at(1, 1)]
}

fn fit(fixture: &Fixture, frfs: &FrfSet, laws: bool) -> JointFit {
    let sides = Sides::of(fixture, None).unwrap();
    let spectrum = decompose(frfs, &sides, Relation::Exact).unwrap();
    let nominal = nominal_stiffness(&sides.joint().law, sides.length());
    let near = maximum_likelihood(frfs, &sides, &spectrum, None, Some(nominal)).ok();
    let options = JointFitOptions { laws, ..Default::default() };
    fit_joint(frfs, &sides, spectrum.scalar, near.as_ref(), nominal, options).unwrap()
}

/// What many drawn fixtures give: errors of the six numbers in standard deviations, relative errors, p-values.
#[derive(Default)]
struct Runs {
    scores: Vec<[f64; 6]>,
    errors: Vec<[f64; 6]>,
    p: [Vec<f64>; 3],
    chi2: Vec<f64>,
}

fn run(count: u64, relative: f64, seed: u64) -> Runs {
    let fixture = fixture("");
    let (mut rng, mut noise) = (generator(seed), Noise::new(seed));
    let mut runs = Runs::default();
    for _ in 0..count {
        let truth = drawn_within_tolerance(&fixture, &mut rng).unwrap();
        let fit = fit(&fixture, &recorded(&truth, &mut noise, relative, &EIGHT), false);
        let (found, expected) = (found(&fit), six(&truth));
        runs.scores.push(std::array::from_fn(|e| (found[e] - expected[e]) / fit.covariance[e][e].sqrt()));
        runs.errors.push(std::array::from_fn(|e| found[e] / expected[e] - 1.0));
        for (all, p) in runs.p.iter_mut().zip([fit.tests.reciprocity, fit.tests.definite, fit.tests.passive]) {
            all.extend(p);
        }
        runs.chi2.push(fit.chi2_per_dof);
    }
    runs
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), v| (sum + v * v, count + 1));
    (sum / f64::from(count)).sqrt()
}

const NAMES: [&str; 6] = ["k11", "k12", "k22", "c11", "c12", "c22"];

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
    for (name, p) in ["reciprocity", "definite", "passive"].iter().zip(&runs.p) {
        let below = |q: f64| p.iter().filter(|p| **p < q).count() as f64 / p.len() as f64;
        println!("{name}: p below 0.01, 0.05, 0.2, 0.5, 0.8: {:.3} {:.3} {:.3} {:.3} {:.3}", below(0.01), below(0.05), below(0.2), below(0.5), below(0.8));
    }
}

#[test]
fn on_fixtures_drawn_from_their_tolerances_the_six_numbers_are_as_far_off_as_stated() {
    let runs = run(40, 0.01, 7);
    report(&runs);
}

#[test]
fn scratch_times() {
    let fixture = fixture("");
    let mut noise = Noise::new(1);
    let truth = drawn_within_tolerance(&fixture, &mut generator(3)).unwrap();
    for (pairs, laws) in [(&EIGHT[..4], false), (&EIGHT[..], false), (&EIGHT[..], true)] {
        let frfs = recorded(&truth, &mut noise, 0.01, pairs);
        let start = std::time::Instant::now();
        let fit = fit(&fixture, &frfs, laws);
        println!("{} FRFs, laws {laws}: {:?}", pairs.len(), start.elapsed());
        for q in &fit.quantities { println!("{} {:.3} std after {:.3}", q.path, q.deviations, q.fitted_std / q.std.unwrap()); }
        println!("{:?} {:?}", fit.tests, fit.admissible);
        for law in &fit.laws { println!("{} {:.4} {:.2} {:?} {:?}", law.name(), law.probability, law.objective, law.mass, law.shape); }
        let start = std::time::Instant::now();
        let analysis = Analysis::of(&fixture, &frfs, &AnalysisOptions::default()).unwrap();
        println!("analysis {:?}", start.elapsed());
        let ml = analysis.likelihood.unwrap();
        println!("ml {:?}", found(&fit).iter().zip([ml.stiffness.at(0,0), ml.stiffness.at(0,1), ml.stiffness.at(1,1)]).map(|(a,b)| b/a).collect::<Vec<_>>());
    }
}
