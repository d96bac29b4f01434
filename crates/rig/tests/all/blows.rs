//! What a blow leaves in samples that no filter guards.

use jointscope_fixture::{Damping, Effect, EffectKind, Fixture, Place};
use jointscope_hits::Hit;
use jointscope_rig::{Family, Instrument, StrikeTest, frfs, generator};
use jointscope_spectra::{Channel, FrfPair, SpectralLines};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Decay, 1/s, under which the motion of a second's record is over.
const DECAY: f64 = 20.0;

fn transform(values: &[f64], interval: f64, hz: f64) -> Complex64 {
    let s = Complex64::new(DECAY, TAU * hz);
    values.iter().enumerate().map(|(i, v)| v * (-s * (i as f64 * interval)).exp()).sum()
}

/// Largest phase error over ω, s, and largest error of magnitude of the FRFs of a hit.
fn errors(fixture: &Fixture, pairs: &[FrfPair], hit: &Hit, lines: &SpectralLines) -> (f64, f64) {
    let window = Effect::new(EffectKind::ExponentialWindow, Place::All, None, &[DECAY]);
    let fixture = fixture.clone().with_physics(vec![window]).unwrap();
    let exact = frfs(&fixture, pairs, lines, Instrument::AsDescribed).unwrap();
    let mut worst = (0.0_f64, 0.0_f64);
    for (index, response) in hit.responses().iter().enumerate() {
        for (line, &hz) in lines.hz().iter().enumerate() {
            let sampled = transform(&response.values, hit.interval(), hz)
                / transform(hit.force(), hit.interval(), hz)
                / exact.values(index)[line];
            worst.0 = worst.0.max(sampled.arg().abs() / (TAU * hz));
            worst.1 = worst.1.max((sampled.norm() - 1.0).abs());
        }
    }
    worst
}

#[test]
fn samples_of_blows_without_a_filter_give_the_frfs_of_the_structure_on_every_line_that_they_excite() {
    let test = StrikeTest {
        rate: 6400.0,
        samples: 6144,
        steps: 8,
        pulse: 0.0005,
        levels: vec![100.0],
        hits: 2,
        noise_response: 0.0,
        noise_force: 0.0,
    };
    let lines = SpectralLines::even(25.0, 25.0, 64).unwrap();
    let mut worst = (0.0_f64, 0.0_f64);
    for seed in 0..4 {
        let family = if seed % 2 == 0 { Family::TwoBlocks } else { Family::Frame };
        // Damping that is viscous, as the integration has it.
        let drawn = |seed: u64| family.draw("struck", &mut generator(seed)).unwrap();
        let fixture =
            (seed..).step_by(4).map(drawn).find(|f| !matches!(f.damping(), Damping::LossFactor(_))).unwrap();
        let names: Vec<&str> = fixture.points().iter().map(|p| p.name.as_str()).collect();
        let (struck, read) = (names[0], names[names.len() - 1]);
        let channels = [vec![Channel::transverse(struck)], vec![Channel::transverse(read)]];
        let hits = test.record(&fixture, &channels[0], &channels[1], &mut generator(seed)).unwrap();
        for hit in &hits {
            let found = errors(&fixture, &[FrfPair::transverse(read, struck)], hit, &lines);
            worst = (worst.0.max(found.0), worst.1.max(found.1));
        }
    }
    println!("delay {:.1e} s, magnitude {:.1e}", worst.0, worst.1);
    assert!(worst.0 < 3e-8 && worst.1 < 1e-4, "{worst:?}");
}
