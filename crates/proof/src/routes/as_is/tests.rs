//! The solid against a finer mesh, its stated fixture, and a fit with everything stated.

use super::*;
use crate::Plan;
use crate::routes::solid::assembly::POISSON;

/// The case of this number.
fn drawn(seed: u64, number: usize) -> Result<(Case, AsIsTruth), GenerationError> {
    AsIsTruth::draw(Draw::of(&Plan { seed, ..Plan::default() }, "solid_as_is", number, number))
}

/// Elements half as long and thick.
const FINER: MeshOptions = MeshOptions { corner: 8, along: 24, across: 4, growth: 2.0, ..MESH };

fn transverse_frequencies(solid: &Fixture, mesh: &MeshOptions) -> Vec<f64> {
    let twin = Twin::of(solid, mesh, ModeRange { at_least: 4, up_to: last_line().unwrap() }, |_| ()).unwrap();
    let own = twin.frequencies().into_iter().zip(&twin.kinds);
    own.filter(|(_, kind)| **kind == ModeKind::Transverse).map(|(hz, _)| hz).take(2).collect()
}

#[test]
fn frequencies_are_nearly_those_of_a_finer_mesh() {
    let (_, truth) = drawn(1, 1).unwrap();
    let [coarse, fine] = [&MESH, &FINER].map(|mesh| transverse_frequencies(&truth.solid, mesh));
    for (coarse, fine) in coarse.iter().zip(&fine) {
        assert!((coarse / fine - 1.0).abs() < 1e-2, "{coarse} Hz for {fine} Hz");
    }
}

#[test]
fn a_null_with_everything_stated_refits_to_a_small_error() {
    let (case, truth) = drawn(1, 1).unwrap();
    let judge = Judge::of(&case).unwrap();
    let values = 2.0 * judge.observation.values().len() as f64;
    let (stated, refitted) = (judge.objective(&truth.lumped).unwrap(), judge.best(&truth.lumped).unwrap());
    // Peaks are off by their widths before; afterwards, with 0.25 % of noise, the error is 1.5 % at the most.
    assert!(stated > 10.0 * values, "{:.1} a value", stated / values);
    assert!(refitted.objective < 36.0 * values, "{:.1} a value", refitted.objective / values);
}

#[test]
fn a_truth_reads_back_as_it_was_written_and_gives_the_same_frfs() {
    for number in [0, 3] {
        let (_, truth) = drawn(3, number).unwrap();
        let text = truth.to_value().to_string();
        let read = AsIsTruth::from_value(&serde_json::from_str(&text).unwrap()).unwrap();
        assert_eq!(read.to_value().to_string(), text, "case {number}");
        assert_eq!(read.frfs().unwrap(), truth.frfs().unwrap(), "case {number}");
    }
}

#[test]
fn in_a_static_solve_footings_and_shear_yield_less_than_the_strips_bending() {
    let mut random = generator(5);
    for _ in 0..4 {
        let assembly =
            std::iter::repeat_with(|| Assembly::draw(&mut random, false).unwrap()).flatten().next().unwrap();
        let solid = fixture(&assembly.solid().unwrap()).unwrap();
        let twin = twin(&solid, ModeRange { at_least: 4, up_to: last_line().unwrap() }).unwrap();
        let footings = Footings::of(&assembly, &twin).unwrap();
        let strip = &assembly.strip;
        let bending = strip.length / (strip.modulus() * strip.second_moment());
        let shear = strip.length / (0.85 * strip.modulus() / (2.0 * (1.0 + POISSON)) * strip.area());
        // The strip's ends yield across it as well.
        assert!((1.0..4.0).contains(&(footings.across / shear)), "{footings:?}, {shear}");
        assert!(
            footings.rotation.iter().all(|c| (0.0..0.2 * bending).contains(c)),
            "{footings:?}, {bending}"
        );
    }
}
