//! FRFs under an exponential window: sides and joint are read at s = decay + iω, where they hold exactly.

use crate::common::{TwoBlocks, frfs, joint_damping, lines};
use jointscope_beam::end_stiffness;
use jointscope_decomposition::{
    Analysis, AnalysisOptions, JointSpectrum, Relation, Sides, decompose, maximum_likelihood,
};
use jointscope_fixture::Fixture;
use jointscope_linalg::RealMatrix2;
use jointscope_samples::{ACROSS, Noise};
use jointscope_spectra::{FrfForm, FrfSet, SpectralLines};
use std::f64::consts::TAU;

const DECAY: f64 = 40.0;

fn window(decay: f64) -> String {
    format!(r#", "physics": [{{"kind": "exponential_window", "place": "all", "decay": {decay}}}]"#)
}

fn windowed(decay: f64) -> Fixture {
    TwoBlocks { extra: window(decay), ..TwoBlocks::default() }.fixture()
}

fn truth() -> (RealMatrix2, RealMatrix2) {
    let blocks = TwoBlocks::default();
    (end_stiffness(blocks.bending_stiffness, blocks.length), joint_damping(&blocks.fixture()))
}

fn spectrum(fixture: &Fixture, set: &FrfSet) -> JointSpectrum {
    decompose(set, &Sides::of(fixture, None).unwrap(), Relation::Exact).unwrap()
}

/// The largest relative errors of K and of C over well-conditioned lines, and the share of these.
fn errors(found: &JointSpectrum) -> (f64, f64, f64) {
    let (k, c) = truth();
    let (mut of_k, mut of_c, mut well) = (0.0_f64, 0.0_f64, 0);
    for line in &found.solved {
        let omega = TAU * line.frequency;
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            // sC is a small part of the dynamic stiffness: its relative error is that of the whole times
            // their ratio.
            let ratio = k.at(i, j).abs() / (omega * c.at(i, j).abs());
            if line.condition < 1e5 {
                well += 1;
                of_k = of_k.max((line.stiffness.at(i, j) / k.at(i, j) - 1.0).abs());
            }
            if line.condition * ratio < 1e5 {
                of_c = of_c.max((line.damping.at(i, j) / c.at(i, j) - 1.0).abs());
            }
        }
    }
    (of_k, of_c, well as f64 / (4 * found.solved.len()) as f64)
}

#[test]
fn under_a_window_synthesis_and_decomposition_give_the_joint_to_1e_9_in_every_form_of_frf() {
    for decay in [0.5, DECAY, 400.0] {
        let fixture = windowed(decay);
        let set = frfs(&fixture, &ACROSS, &lines());
        for form in [FrfForm::Accelerance, FrfForm::Mobility, FrfForm::Receptance] {
            let (of_k, of_c, well) = errors(&spectrum(&fixture, &set.to_form(form).unwrap()));
            assert!(of_k < 1e-9 && of_c < 1e-9, "{decay} 1/s, {}: {of_k:e} {of_c:e}", form.name());
            assert!(well > 0.8, "{decay} 1/s, {}: {well}", form.name());
        }
    }
}

#[test]
fn a_window_that_nobody_states_spoils_the_damping() {
    let set = frfs(&windowed(DECAY), &ACROSS, &lines());
    let (_, of_c, _) = errors(&spectrum(&TwoBlocks::default().fixture(), &set));
    assert!(of_c > 0.5, "{of_c}");
}

#[test]
fn a_window_closes_the_paper_relations_own_round_trip_too() {
    let fixture = windowed(DECAY);
    let options = AnalysisOptions { relation: Relation::Paper, ..AnalysisOptions::default() };
    let analysis = Analysis::of(&fixture, &frfs(&fixture, &ACROSS, &lines()), &options).unwrap();
    // What the fixture predicts is what the FRFs are, at the same s.
    for line in &analysis.spectrum.solved {
        let (h41, nominal) = analysis.nominal[line.line].unwrap();
        let (k, c) = analysis.spectrum.stiffness_and_damping(line.line, nominal);
        let close = |found: f64, expected: f64, scale: f64| (found - expected).abs() < 1e-7 * scale;
        let scale = 1e-2 * line.condition.max(100.0) * nominal.norm_squared().sqrt();
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            assert!(close(line.stiffness.at(i, j), k.at(i, j), scale), "K at {} Hz", line.frequency);
            assert!(close(line.damping.at(i, j), c.at(i, j), scale), "C at {} Hz", line.frequency);
        }
        let difference = (h41 - analysis.spectrum.h41.values[line.line]).norm_squared().sqrt();
        assert!(difference < 1e-9 * h41.norm_squared().sqrt());
    }
}

#[test]
fn under_a_window_the_fit_gives_the_joint_and_its_intervals_hold() {
    let fixture = windowed(DECAY);
    let sides = Sides::of(&fixture, None).unwrap();
    let set = frfs(&fixture, &ACROSS, &lines());
    let (k, c) = truth();
    let (mut by_line, mut fitted, mut all) = ([0usize; 2], [0usize; 2], [0usize; 2]);
    let mut noise = Noise::new(5);
    for _ in 0..160 {
        let noisy = noise.on(&set, 1e-4);
        let found = spectrum(&fixture, &noisy);
        let fit = maximum_likelihood(&noisy, &sides, &found, None, None).unwrap();
        assert!((0.8..1.2).contains(&fit.chi2_per_dof), "{}", fit.chi2_per_dof);
        let inside = |a: f64, b: f64, std: f64| usize::from((a - b).abs() < 1.96 * std);
        for (i, j) in [(0, 0), (0, 1), (1, 1)] {
            all[1] += 1;
            fitted[0] += inside(fit.stiffness.at(i, j), k.at(i, j), fit.stiffness_std.at(i, j));
            fitted[1] += inside(fit.damping.at(i, j), c.at(i, j), fit.damping_std.at(i, j));
            for line in found.solved.iter().filter(|line| line.noise_share() < 0.05).step_by(7) {
                all[0] += 1;
                let (k_std, c_std) = (line.stiffness_std.unwrap(), line.damping_std.unwrap());
                by_line[0] += inside(line.stiffness.at(i, j), k.at(i, j), k_std.at(i, j));
                by_line[1] += inside(line.damping.at(i, j), c.at(i, j), c_std.at(i, j));
            }
        }
    }
    println!("of {all:?} intervals hold: by line {by_line:?}, fitted {fitted:?}");
    for (count, of) in [(by_line[0], all[0]), (by_line[1], all[0]), (fitted[0], all[1]), (fitted[1], all[1])]
    {
        let share = count as f64 / of as f64;
        assert!((0.9..0.99).contains(&share), "{count} of {of}");
    }
}

#[test]
fn a_line_at_0_hz_stays_masked_under_a_window() {
    let fixture = windowed(DECAY);
    let set = frfs(&fixture, &ACROSS, &SpectralLines::even(0.0, 50.0, 8).unwrap());
    let found = spectrum(&fixture, &set);
    assert_eq!(found.masked.iter().map(|m| m.0).collect::<Vec<_>>(), [0]);
}
