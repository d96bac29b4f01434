//! Random assemblies, truths and effects.

use jointscope_fixture::{EffectKind, Fixture};
use jointscope_rig::{Family, Instrument, Structure, drawn_within_tolerance, frfs, generator, random_effect};
use jointscope_spectra::{FrfPair, SpectralLines};

#[test]
fn every_family_gives_possible_fixtures_whose_modes_lie_in_the_band() {
    for family in Family::ALL {
        // The modes of a meshed body take their time.
        let seeds = if family == Family::BeamAndBlock { 3 } else { 20 };
        for seed in 0..seeds {
            let fixture = family.draw("drawn", &mut generator(seed)).unwrap();
            let reread = Fixture::from_json(&fixture.to_json()).unwrap();
            assert_eq!(reread, fixture, "{family:?}, seed {seed}");
            let modes = Structure::of(&fixture).unwrap().natural_frequencies().unwrap();
            let within = modes.iter().filter(|f| (15.0..1000.0).contains(*f)).count();
            assert!(within >= 2, "{family:?}, seed {seed}: {modes:?}");
            if family != Family::BeamAndBlock {
                assert!(modes.iter().all(|f| *f < 1000.0), "{family:?}, seed {seed}: {modes:?}");
            }
        }
    }
}

#[test]
fn a_truth_departs_from_what_was_stated_by_its_standard_deviations() {
    let (mut sum, mut count) = (0.0, 0.0);
    for seed in 0..50 {
        let mut rng = generator(seed);
        let fixture = Family::ThreeBlocks.draw("drawn", &mut rng).unwrap();
        let truth = drawn_within_tolerance(&fixture, &mut rng).unwrap();
        for (stated, real) in fixture.quantities().iter().zip(truth.quantities()) {
            if let Some(std) = stated.std.filter(|std| *std > 0.0) {
                sum += ((real.value - stated.value) / std).powi(2);
                count += 1.0;
            }
        }
    }
    assert!(
        (sum / count - 1.0_f64).abs() < 0.1,
        "mean square of the standardised departures: {}",
        sum / count
    );
}

#[test]
fn every_linear_effect_changes_the_frfs_of_a_family_that_has_a_place_for_it() {
    let lines = SpectralLines::even(40.0, 40.0, 25).unwrap();
    for kind in EffectKind::ALL {
        let mut placed = 0;
        for family in Family::ALL {
            let mut rng = generator(100);
            let fixture = family.draw("drawn", &mut rng).unwrap();
            let pairs = family.usual_pairs();
            let Some(effect) = random_effect(&mut rng, &fixture, kind, &pairs).unwrap() else { continue };
            let changed = fixture.clone().with_physics(vec![effect.clone()]).unwrap();
            placed += 1;
            if kind.is_nonlinear() {
                continue;
            }
            let plain = frfs(&fixture, &pairs, &lines, Instrument::AsDescribed).unwrap();
            let with = frfs(&changed, &pairs, &lines, Instrument::AsDescribed).unwrap();
            let difference: f64 =
                plain.all_values().iter().zip(with.all_values()).map(|(a, b)| (a - b).norm_sqr()).sum();
            let size: f64 = plain.all_values().iter().map(|a| a.norm_sqr()).sum();
            let share = (difference / size).sqrt();
            assert!(share > 1e-4, "{kind:?} on {family:?}: {share:.1e} of the FRFs, {effect:?}");
        }
        assert!(placed >= 1, "{kind:?} found a place on {placed} fixtures only");
    }
}

#[test]
fn whatever_structural_effects_are_added_force_and_response_can_be_exchanged() {
    let lines = SpectralLines::even(30.0, 50.0, 15).unwrap();
    let pairs = [FrfPair::transverse("4", "1"), FrfPair::transverse("1", "4")];
    for (seed, family) in Family::ALL.into_iter().enumerate() {
        let mut rng = generator(seed as u64);
        let fixture = family.draw("drawn", &mut rng).unwrap();
        let structural = EffectKind::ALL.into_iter().filter(|k| !k.is_nonlinear() && !k.is_instrumental());
        let effects =
            structural.filter_map(|kind| random_effect(&mut rng, &fixture, kind, &pairs).unwrap()).collect();
        let fixture = fixture.with_physics(effects).unwrap();
        let set = frfs(&fixture, &pairs, &lines, Instrument::AsDescribed).unwrap();
        for (line, (a, b)) in set.values(0).iter().zip(set.values(1)).enumerate() {
            assert!((a - b).norm() < 1e-7 * a.norm(), "{family:?} at {} Hz: {a}, {b}", lines.hz()[line]);
        }
    }
}
