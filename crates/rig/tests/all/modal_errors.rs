//! Structures a little wrong in every mode.

use jointscope_fixture::{EffectKind, Fixture};
use jointscope_rig::{
    Family, Instrument, ModalErrors, UsualErrors, drawn_within_tolerance, frfs, generator, random_effect,
};
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};

fn lines() -> SpectralLines {
    SpectralLines::even(2.5, 2.5, 400).unwrap()
}

fn off(a: &FrfSet, b: &FrfSet) -> f64 {
    let both = a.all_values().iter().zip(b.all_values());
    let (error, size) = both.fold((0.0, 0.0), |(e, s), (a, b)| (e + (a - b).norm_sqr(), s + b.norm_sqr()));
    f64::sqrt(error / size)
}

#[test]
fn a_sum_of_modes_without_errors_gives_the_structures_own_frfs() {
    let kinds = [
        EffectKind::AddedMass,
        EffectKind::Support,
        EffectKind::AttachedResonator,
        EffectKind::InterfaceCompliance,
        EffectKind::ShearDeformation,
        EffectKind::JointMass,
        EffectKind::LossFactor,
        EffectKind::Relaxation,
        EffectKind::PointOffset,
        EffectKind::SensorMass,
        EffectKind::ExponentialWindow,
    ];
    for family in [Family::TwoBlocks, Family::SupportedTwoBlocks, Family::ThreeBlocks, Family::Frame] {
        let mut random = generator(11);
        let fixture = family.draw("sum of modes", &mut random).unwrap();
        let pairs = family.usual_pairs();
        for kind in kinds {
            let Some(effect) = random_effect(&mut random, &fixture, kind, &pairs).unwrap() else { continue };
            let fixture = fixture.clone().with_physics(vec![effect]).unwrap();
            let own = frfs(&fixture, &pairs, &lines(), Instrument::AsDescribed).unwrap();
            let summed = ModalErrors::default().frfs(&fixture, &pairs, &lines(), Instrument::AsDescribed);
            let error = off(&summed.unwrap(), &own);
            // A strip with mass has modes at 10⁴ times the lines' frequencies, against whose eigenvalues the
            // lowest lose digits.
            let allowed = if kind == EffectKind::JointMass { 1e-7 } else { 1e-9 };
            assert!(error < allowed, "{family:?}, {}: {error:.1e}", kind.name());
        }
    }
}

/// A block of 2 kg on a spring of 100 Hz with a hundredth of the critical damping.
const ONE_MODE: &str = r#"{
  "bodies": { "A": { "mass": 2.0, "rotates": false } },
  "points": { "1": { "body": "A", "x": 0.0 } },
  "supports": { "S": { "point": "1", "stiffness": 789568.352, "damping": 25.1327412 } }
}"#;

#[test]
fn errors_are_those_of_frequency_damping_and_residue_in_closed_form() {
    let fixture = Fixture::from_json(ONE_MODE).unwrap();
    let pairs = [FrfPair::transverse("1", "1")];
    let errors = ModalErrors { frequency: vec![0.01], damping: vec![0.2], shape: vec![vec![-0.03]] };
    let set = errors.frfs(&fixture, &pairs, &lines(), Instrument::Perfect).unwrap();
    let omega_r = std::f64::consts::TAU * 101.0;
    for (omega, value) in lines().omegas().zip(set.values(0)) {
        let denominator =
            num_complex::Complex64::new(omega_r * omega_r - omega * omega, 2.0 * 0.012 * omega_r * omega);
        let expected = -omega * omega * 0.97 * 0.97 / 2.0 / denominator;
        assert!(
            (value - expected).norm() < 1e-7 * expected.norm(),
            "{value} for {expected} at {omega} rad/s"
        );
    }
}

#[test]
fn errors_are_drawn_with_their_usual_sizes_and_change_frfs_by_as_much() {
    let mut random = generator(3);
    let usual = UsualErrors { frequency: 0.002, damping: 0.05, shape: 0.005 };
    let mut drawn = Vec::new();
    for _ in 0..60 {
        let believed = Family::ThreeBlocks.draw("modal errors", &mut random).unwrap();
        let fixture = drawn_within_tolerance(&believed, &mut random).unwrap();
        let errors = ModalErrors::draw(&mut random, &fixture, &usual).unwrap();
        assert_eq!((errors.frequency.len(), errors.shape[0].len()), (4, fixture.points().len()));
        drawn.push(errors);
    }
    let rms = |all: &mut dyn Iterator<Item = f64>| {
        let squares: Vec<f64> = all.map(|value| value * value).collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    };
    let frequency = rms(&mut drawn.iter().flat_map(|e| e.frequency.iter().copied()));
    let damping = rms(&mut drawn.iter().flat_map(|e| e.damping.iter().copied()));
    let shape = rms(&mut drawn.iter().flat_map(|e| e.shape.iter().flatten().copied()));
    for (found, usual) in [(frequency, 0.002), (damping, 0.05), (shape, 0.005)] {
        assert!((found / usual - 1.0).abs() < 0.15, "{found} for {usual}");
    }
}
