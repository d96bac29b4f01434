//! Two blocks on a strip, as an analyst believes them, and hammer tests on them in the simulated laboratory.
// Every test is built with a copy of its own and uses what it needs.

use jointscope::fixture::Effect;
use jointscope::{Fixture, FrfPair, FrfSet, SpectralLines};
use jointscope_rig::{HammerSetup, Instrument, drawn_within_tolerance, frfs, generator};
use jointscope_samples::{ACROSS, transverse};

/// The fixture file, with the modal damping ratios of its two elastic modes.
pub(crate) fn believed(ratios: [f64; 2]) -> Fixture {
    let [first, second] = ratios;
    Fixture::from_json(&format!(
        r#"{{
  "bodies": {{
    "A": {{ "mass": {{"value": 1.10, "std": 0.0011}}, "inertia": {{"value": 9.5e-4, "std": 4e-6}}, "x_cg": {{"value": -0.030, "std": 1e-4}} }},
    "B": {{ "mass": {{"value": 1.25, "std": 0.0012}}, "inertia": {{"value": 1.1e-3, "std": 4e-6}}, "x_cg": {{"value": 0.096, "std": 1e-4}} }} }},
  "points": {{
    "1": {{ "body": "A", "x": {{"value": -0.060, "std": 1e-4}} }}, "2": {{ "body": "A", "x": {{"value": 0.0, "std": 1e-4}} }},
    "3": {{ "body": "B", "x": {{"value": 0.065, "std": 1e-4}} }},  "4": {{ "body": "B", "x": {{"value": 0.127, "std": 1e-4}} }} }},
  "joints": {{ "J": {{ "from": "2", "to": "3",
    "beam": {{ "youngs_modulus": {{"value": 2.07e11, "std": 1e9}}, "second_moment": {{"value": 3.6e-10, "std": 2e-12}} }} }} }},
  "damping": {{ "modal_ratios": [{{"value": {first}, "std": {}}}, {{"value": {second}, "std": {}}}] }} }}"#,
        0.2 * first,
        0.175 * second,
    ))
    .unwrap()
}

/// The damping of most tests.
pub(crate) const RATIOS: [f64; 2] = [0.006, 0.008];

/// The four FRFs across the joint.
pub(crate) fn four_pairs() -> Vec<FrfPair> {
    transverse(&ACROSS)
}

/// 86 lines to 1290 Hz.
pub(crate) fn lines() -> SpectralLines {
    SpectralLines::even(15.0, 15.0, 86).unwrap()
}

/// The hammer test of most tests: ten hits, half a per cent of noise.
pub(crate) fn hammer(seed: u64) -> HammerSetup {
    HammerSetup {
        averages: 10,
        noise_response: 0.005,
        noise_force: 0.0007,
        corner: 1200.0,
        spread: 0.25,
        common_hits: false,
        seed,
    }
}

/// What `hammer` records of a fixture with quantities drawn within the tolerances of `believed`, and effects.
pub(crate) fn measured(
    believed: &Fixture,
    effects: Vec<Effect>,
    (pairs, lines): (&[FrfPair], &SpectralLines),
    hammer: &HammerSetup,
) -> FrfSet {
    let drawn = drawn_within_tolerance(believed, &mut generator(hammer.seed)).unwrap();
    let truth = drawn.with_physics(effects).unwrap();
    hammer.measure(&frfs(&truth, pairs, lines, Instrument::AsDescribed).unwrap()).unwrap()
}

/// What an analyst would have: the fixture believed, and the four FRFs of one with effects.
pub(crate) fn recorded(effects: Vec<Effect>, seed: u64) -> (Fixture, FrfSet) {
    let believed = believed(RATIOS);
    let frfs = measured(&believed, effects, (&four_pairs(), &lines()), &hammer(seed));
    (believed, frfs)
}
