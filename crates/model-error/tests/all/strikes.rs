//! Sensors beside their points, and hammers that strike there.

use crate::common::*;
use jointscope_fixture::Fixture;
use jointscope_model_error::{ErrorSizes, Linear, SharedFeatures, StrikeSlopes};

/// Beside which points sensors sit, and hammers strike, in mm.
const PLACES: [(&str, f64); 5] = [
    ("response 3", 1.2),
    ("response 4", -0.7),
    ("reference 1", 1.5),
    ("reference 2", -1.1),
    ("response 1", 0.4),
];

fn beside(places: &[(&str, f64)]) -> Fixture {
    let effects = places.iter().map(|(place, mm)| {
        let dx = 1e-3 * mm;
        format!(r#"{{"kind": "point_offset", "place": "{place}", "dx": {dx}}}"#)
    });
    blocks(&effects.collect::<Vec<_>>().join(", "))
}

/// A recording of `structure` compared with the blocks as they are stated, strikes beside their points among
/// the errors.
fn compared(structure: &Fixture) -> (Compared, SharedFeatures) {
    let pairs = pairs(&[("1", "1"), ("3", "1"), ("4", "1"), ("1", "2"), ("3", "2"), ("4", "2")]);
    let recorded = Recorded::of(structure, &pairs, &lines(1500.0), noise(Some(1))).modes();
    let fixture = blocks("");
    let compared = Compared::of(&fixture, recorded);
    let slopes = StrikeSlopes::of(&fixture, &compared.recorded, &compared.modelled).unwrap();
    let with = compared.comparison.clone().with_strikes(
        &compared.recorded,
        (&compared.pairing, &compared.modelled),
        &slopes,
    );
    (compared, with)
}

fn sizes(difference: Vec<f64>, comparison: &SharedFeatures) -> (ErrorSizes, f64) {
    let linear = Linear { difference, slopes: Vec::new() };
    let evidence = linear.evidence(comparison, &ErrorSizes::default(), None).unwrap();
    (evidence.sizes, evidence.ln)
}

#[test]
fn strikes_beside_their_points_are_told_as_such_and_not_as_wrong_shapes() {
    let (own, comparison) = compared(&beside(&PLACES));
    let (found, ln) = sizes(own.difference(), &comparison);
    let rms = (PLACES.iter().map(|(_, mm)| mm * mm).sum::<f64>() / 5.0).sqrt() * 1e-3;
    assert!((0.6..1.6).contains(&(found.strike / rms)), "{found:?}, and rms {rms}");
    assert!(found.shape < 0.003, "{found:?}");
    let (without, ln_without) = sizes(own.difference(), &own.comparison);
    assert!(without.shape > 0.01, "as shapes they would be off by more than a per cent: {without:?}");
    assert!(ln > ln_without + 20.0, "{ln} {ln_without}");
}

#[test]
fn where_everybody_strikes_true_none_is_seen() {
    let (own, comparison) = compared(&blocks(""));
    let (found, _) = sizes(own.difference(), &comparison);
    assert!(found.strike < 5e-5, "{found:?}");
}

#[test]
fn residues_move_with_a_strike_as_the_model_does() {
    let (own, with) = compared(&blocks(""));
    let only = ErrorSizes { strike: 1e-5, ..no_error() };
    let (n, sum, without) = (with.count(), with.covariance(&only), own.covariance(&no_error()));
    // What a hundredth of a millimetre at one channel makes of its features; FRFs of no other channel have it.
    for (place, [a, b]) in [("response 3", [1, 4]), ("reference 1", [0, 2])] {
        let there = modelled(&beside(&[(place, 0.01)]), &own.recorded);
        let moved = own.comparison.residual(&own.recorded, &own.recorded.features(), &there, &own.pairing);
        let change: Vec<f64> = own.difference().iter().zip(&moved).map(|(a, b)| a - b).collect();
        let [i, j] = [a, b].map(|frf| 2 * own.pairing.pairs.len() + 2 * frf);
        let (i, j) = (i.max(j), i.min(j));
        let shared = sum[i * n + j] - without[i * n + j];
        assert!(
            (shared / (change[i] * change[j]) - 1.0).abs() < 1e-3,
            "{place}: {shared:e}, {:e}",
            change[i] * change[j]
        );
    }
}
