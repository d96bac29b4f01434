//! Synthesis followed by decomposition.

use crate::common::{TwoBlocks, frfs, joint_damping, lines};
use jointscope_averaging::AveragingError;
use jointscope_beam::end_stiffness;
use jointscope_decomposition::{Averages, DecompositionError, JointSpectrum, Relation, Sides, decompose};
use jointscope_fixture::Fixture;
use jointscope_linalg::{Matrix2, RealMatrix2};
use jointscope_samples::ACROSS;
use jointscope_spectra::SpectralLines;
use proptest::prelude::*;

fn spectrum(fixture: &Fixture, pairs: &[(&str, &str)], relation: Relation) -> JointSpectrum {
    decompose(&frfs(fixture, pairs, &lines()), &Sides::of(fixture, None).unwrap(), relation).unwrap()
}

/// Rounding may be multiplied this often before a line counts as ill-conditioned: 1e-9 over the rounding of
/// a modal sum, about 1e-15.
const WELL_CONDITIONED: f64 = 1e5;

fn check(
    spectrum: &JointSpectrum,
    k: RealMatrix2,
    c: impl Fn(f64) -> RealMatrix2,
    least_share: f64,
) -> Result<(), TestCaseError> {
    let mut checked = 0;
    for line in &spectrum.solved {
        let omega = std::f64::consts::TAU * line.frequency;
        let c = c(omega);
        for i in 0..2 {
            for j in 0..2 {
                let error = (line.stiffness.at(i, j) / k.at(i, j) - 1.0).abs();
                if line.condition < WELL_CONDITIONED {
                    checked += 1;
                    prop_assert!(
                        error < 1e-9,
                        "K({i},{j}) off by {error:e} at {} Hz, condition {:e}",
                        line.frequency,
                        line.condition
                    );
                }
                // ωC is a small part of |k|: its relative error is that of k times their ratio.
                let ratio = k.at(i, j).abs() / (omega * c.at(i, j).abs());
                if c.at(i, j) != 0.0 && line.condition * ratio < WELL_CONDITIONED {
                    let error = (line.damping.at(i, j) / c.at(i, j) - 1.0).abs();
                    prop_assert!(
                        error < 1e-9,
                        "C({i},{j}) off by {error:e} at {} Hz, condition {:e}",
                        line.frequency,
                        line.condition * ratio
                    );
                }
            }
        }
    }
    let all = 4 * spectrum.solved.len();
    prop_assert!(
        checked as f64 >= least_share * all as f64,
        "only {checked} of {all} elements are well-conditioned"
    );
    Ok(())
}

fn blocks() -> impl Strategy<Value = TwoBlocks> {
    // Masses over two decades, sizes over one, bending stiffness over four.
    let log = |low: f64, high: f64| (low.ln()..high.ln()).prop_map(f64::exp);
    (log(0.1, 10.0), log(0.1, 10.0), log(0.02, 0.2), log(0.02, 0.2), log(0.1, 1e3), log(0.01, 0.15)).prop_map(
        |(ma, mb, a, b, bending_stiffness, length)| TwoBlocks {
            mass: [ma, mb],
            half_length: [a, b],
            bending_stiffness,
            length,
            ..TwoBlocks::default()
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_exact_relation_returns_a_modally_damped_joint(mut blocks in blocks(), ratios in prop::array::uniform2(1e-4f64..0.03)) {
        blocks.damping = format!(r#"{{"modal_ratios": [{}, {}]}}"#, ratios[0], ratios[1]);
        let fixture = blocks.fixture();
        let c = joint_damping(&fixture);
        let k = end_stiffness(blocks.bending_stiffness, blocks.length);
        check(&spectrum(&fixture, &ACROSS, Relation::Exact), k, |_| c, 0.0)?;
    }

    #[test]
    fn the_exact_relation_returns_a_joint_with_a_loss_factor(mut blocks in blocks(), eta in 1e-3f64..0.1) {
        blocks.damping = format!(r#"{{"loss_factor": {eta}}}"#);
        let k = end_stiffness(blocks.bending_stiffness, blocks.length);
        check(&spectrum(&blocks.fixture(), &ACROSS, Relation::Exact), k, |omega| k.scale(eta / omega), 0.0)?;
    }

    #[test]
    fn sides_keep_their_supports_known_masses_and_mass_proportional_damping(
        mut blocks in blocks(), alpha in 0.0f64..5.0, beta in 1e-6f64..1e-4, support in 1e2f64..1e5, mass in 0.001f64..0.3
    ) {
        blocks.damping = format!(r#"{{"rayleigh": {{"mass": {alpha}, "stiffness": {beta}}}}}"#);
        let [a, b] = blocks.half_length;
        blocks.extra = format!(r#", "supports": {{
            "S": {{"point": "1", "stiffness": {support}, "damping": 2}},
            "T": {{"body": "B", "x": {}, "stiffness": {support}, "rotational_stiffness": 3, "damping": 0.4}} }},
            "physics": [{{"kind": "added_mass", "place": "A", "x": {}, "mass": {mass}}}]"#, blocks.length + b, -a);
        let k = end_stiffness(blocks.bending_stiffness, blocks.length);
        let mut found = spectrum(&blocks.fixture(), &ACROSS, Relation::Exact);
        // Below a side's resonance on its supports its compliance is the difference of two large numbers: up
        // to support/(ω²m) times the rounding comes on top of the relation's own condition, and that of
        // taking supports and masses off each side.
        for line in &mut found.solved {
            let omega = std::f64::consts::TAU * line.frequency;
            let lightest = blocks.mass[0].min(blocks.mass[1]);
            line.condition *= 10.0 * (1.0 + support / (omega * omega * lightest));
        }
        check(&found, k, |_| k.scale(beta), 0.0)?;
    }
}

#[test]
fn on_the_papers_kind_of_fixture_nearly_every_line_is_well_conditioned_and_exact() {
    let blocks = TwoBlocks::default();
    let k = end_stiffness(blocks.bending_stiffness, blocks.length);
    let fixture = blocks.fixture();
    let c = joint_damping(&fixture);
    check(&spectrum(&fixture, &ACROSS, Relation::Exact), k, |_| c, 0.95).unwrap();
}

#[test]
fn hammer_and_sensors_may_change_sides() {
    let fixture = TwoBlocks::default().fixture();
    let there = spectrum(&fixture, &ACROSS, Relation::Exact);
    let swapped: Vec<(&str, &str)> = ACROSS.iter().map(|(o, i)| (*i, *o)).collect();
    let back = spectrum(&fixture, &swapped, Relation::Exact);
    for (a, b) in there.solved.iter().zip(&back.solved) {
        for (x, y) in a.stiffness.0.iter().flatten().zip(b.stiffness.0.iter().flatten()) {
            assert!((x - y).abs() < 1e-9 * x.abs() * a.condition.max(1.0), "{} Hz: {x} {y}", a.frequency);
        }
    }
}

/// The closed form of eq (7) on two rigid blocks and a massless Euler beam, x = ω²; an E with a loss factor
/// makes EI complex.
fn closed_form(blocks: &TwoBlocks, eta: f64, omega: f64) -> jointscope_linalg::ComplexMatrix2 {
    use num_complex::Complex64;
    let ei = Complex64::new(1.0, eta) * blocks.bending_stiffness;
    let (l, x) = (blocks.length, omega * omega);
    let [ia, ib] = [blocks.inertia(0), blocks.inertia(1)];
    let [ca, cb] = blocks.half_length;
    let s = ca / ia + cb / ib;
    let g = (1.0 - ei / (l * l) * (12.0 * s + 6.0 * l * (1.0 / ia + 1.0 / ib)) / x
        + ei * ei * 12.0 / (l * l * ia * ib * x * x))
        .inv();
    Matrix2::new(
        ei * 12.0 / l.powi(3) * g,
        ei * 6.0 / (l * l) * g * (1.0 - ei * 2.0 / (l * ib * x)),
        -ei * 6.0 / (l * l) * g * (1.0 - ei * 2.0 / (l * ia * x)),
        -ei * 2.0 / l * g * (1.0 + ei * 6.0 * s / (l * l * x)),
    )
}

/// Compares eq (7) of the program with its closed form on sixty lines up to twice the peak and one line 1e-3
/// beside it, to 1e-9 on well-conditioned lines and to rounding times the condition number on the others; the
/// condition beside the peak.
fn check_paper(blocks: &TwoBlocks, eta: f64) -> Result<f64, TestCaseError> {
    let (ei, l, inertia) = (blocks.bending_stiffness, blocks.length, [blocks.inertia(0), blocks.inertia(1)]);
    let s = blocks.half_length[0] / inertia[0] + blocks.half_length[1] / inertia[1];
    let sum = ei / (l * l) * (12.0 * s + 6.0 * l * (1.0 / inertia[0] + 1.0 / inertia[1]));
    let product = 12.0 * ei * ei / (l * l * inertia[0] * inertia[1]);
    // The upper pole of g is the peak of the paper's spectra.
    let peak = (0.5 * (sum + (sum * sum - 4.0 * product).sqrt())).sqrt() / std::f64::consts::TAU;
    let mut hz: Vec<f64> = (1..60).map(|i| peak * i as f64 / 29.7).collect();
    hz.push(peak * (1.0 + 1e-3));
    hz.sort_by(f64::total_cmp);
    hz.dedup();
    let fixture = blocks.fixture();
    let set = frfs(&fixture, &ACROSS, &SpectralLines::new(hz).unwrap());
    let found = decompose(&set, &Sides::of(&fixture, None).unwrap(), Relation::Paper).unwrap();
    let mut beside_the_peak = f64::INFINITY;
    for line in &found.solved {
        let omega = std::f64::consts::TAU * line.frequency;
        let expected = closed_form(blocks, eta, omega);
        let allowed = 1e-9 * (line.condition / WELL_CONDITIONED).max(1.0);
        if (line.frequency / peak - 1.001).abs() < 1e-6 {
            beside_the_peak = line.condition;
        }
        for i in 0..2 {
            for j in 0..2 {
                let found =
                    num_complex::Complex64::new(line.stiffness.at(i, j), omega * line.damping.at(i, j));
                let error = (found / expected.at(i, j) - 1.0).norm();
                prop_assert!(
                    error < allowed,
                    "K({i},{j}) at {} Hz (peak {peak}): {found} against {}, condition {:e}",
                    line.frequency,
                    expected.at(i, j),
                    line.condition
                );
            }
        }
    }
    Ok(beside_the_peak)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_paper_relation_is_its_closed_form_peaks_included(
        ma in 0.5f64..5.0, mb in 0.5f64..5.0, a in 0.03f64..0.1, b in 0.03f64..0.1, ei in 5.0f64..300.0, l in 0.03f64..0.1,
        eta in prop_oneof![Just(0.0), 1e-3f64..0.1]
    ) {
        let blocks = TwoBlocks {
            mass: [ma, mb], half_length: [a, b], bending_stiffness: ei, length: l,
            damping: format!(r#"{{"loss_factor": {eta}}}"#), extra: String::new(),
        };
        // Undamped, 1e-3 from the pole, K is hundreds of times its asymptote and must still have been
        // compared.
        let condition = check_paper(&blocks, eta)?;
        prop_assert!(condition < 1e8, "{condition:e}");
    }
}

#[test]
fn beside_the_peak_of_the_papers_kind_of_fixture_the_closed_form_holds_to_1e_9() {
    for eta in [0.0, 0.006] {
        let damping = format!(r#"{{"loss_factor": {eta}}}"#);
        let condition = check_paper(&TwoBlocks { damping, ..TwoBlocks::default() }, eta).unwrap();
        assert!(condition < WELL_CONDITIONED, "loss factor {eta}: {condition:e}");
    }
}

#[test]
fn each_joint_of_a_chain_is_found_by_name() {
    let fixture = Fixture::from_json(
        r#"{ "bodies": { "A": { "mass": 1.07, "inertia": 8e-4, "x_cg": -0.032 }, "B": { "mass": 1.06, "inertia": 8.9e-4, "x_cg": 0.094 },
                         "C": { "mass": 0.82, "inertia": 6e-4, "x_cg": 0.227 } },
             "points": { "1": { "body": "A", "x": -0.058 }, "2": { "body": "A", "x": 0 }, "3": { "body": "B", "x": 0.063 }, "4": { "body": "B", "x": 0.108 },
                         "5": { "body": "B", "x": 0.125 }, "6": { "body": "C", "x": 0.195 }, "7": { "body": "C", "x": 0.252 } },
             "joints": { "J1": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2e11, "second_moment": 6e-10 } },
                         "J2": { "from": "5", "to": "6", "beam": { "youngs_modulus": 2e11, "second_moment": 4e-10 } } },
             "damping": { "loss_factor": 0.01 } }"#,
    )
    .unwrap();
    let set = frfs(
        &fixture,
        &[("3", "1"), ("4", "1"), ("3", "2"), ("4", "2"), ("6", "1"), ("7", "1"), ("6", "2"), ("7", "2")],
        &lines(),
    );
    for (name, ei, length) in [("J1", 120.0, 0.063), ("J2", 80.0, 0.07)] {
        let found = decompose(&set, &Sides::of(&fixture, Some(name)).unwrap(), Relation::Exact).unwrap();
        let k = end_stiffness(ei, length);
        check(&found, k, |omega| k.scale(0.01 / omega), 0.8).unwrap_or_else(|e| panic!("{name}: {e}"));
    }
}

#[test]
fn a_storeys_column_is_the_scalar_of_eq_5() {
    let fixture = Fixture::from_json(
        r#"{ "bodies": { "F1": { "mass": 6.9, "rotates": false }, "F2": { "mass": 6.0, "rotates": false }, "F3": { "mass": 5.7, "rotates": false } },
             "points": { "1": { "body": "F1", "x": 0 }, "2": { "body": "F2", "x": 0.18 }, "3": { "body": "F3", "x": 0.36 } },
             "joints": { "C1": { "from": "1", "to": "2", "stiffness": [[3.4e6, 0], [0, 0]] }, "C2": { "from": "2", "to": "3", "stiffness": [[5e6, 0], [0, 0]] } },
             "damping": { "loss_factor": 0.02 } }"#,
    )
    .unwrap();
    let set = frfs(&fixture, &[("1", "1"), ("2", "1"), ("3", "1")], &lines());
    for (name, k) in [("C1", 3.4e6), ("C2", 5e6)] {
        let found = decompose(&set, &Sides::of(&fixture, Some(name)).unwrap(), Relation::Exact).unwrap();
        assert!(found.scalar);
        for line in found.solved.iter().filter(|line| line.condition < WELL_CONDITIONED) {
            assert!(
                (line.stiffness.at(0, 0) / k - 1.0).abs() < 1e-9,
                "{name} at {} Hz: {}",
                line.frequency,
                line.stiffness.at(0, 0)
            );
            let c = 0.02 * k / (std::f64::consts::TAU * line.frequency);
            assert!((line.damping.at(0, 0) / c - 1.0).abs() < 1e-6);
        }
        assert!(found.solved.iter().filter(|line| line.condition < WELL_CONDITIONED).count() > 300);
    }
}

#[test]
fn without_a_solved_line_there_is_no_average() {
    let mut spectrum = spectrum(&TwoBlocks::default().fixture(), &ACROSS, Relation::Exact);
    spectrum.solved.clear();
    let none = Averages::of(&spectrum, None, (RealMatrix2::zero(), RealMatrix2::zero()));
    assert!(matches!(none, Err(DecompositionError::Averaging(AveragingError::NoLines))), "{none:?}");
}
