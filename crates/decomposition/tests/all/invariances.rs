//! What a decomposition must not depend on: the units of mass, length and time, the side from which the
//! fixture is drawn, the order of the FRFs and how often they are given, which end of a reciprocal pair was
//! struck.

use crate::common::{TwoBlocks, frfs};
use jointscope_decomposition::{Analysis, AnalysisOptions, JointFit};
use jointscope_fixture::Fixture;
use jointscope_linalg::RealMatrix2;
use jointscope_samples::{ACROSS, Noise};
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};
use proptest::prelude::*;

fn lines() -> SpectralLines {
    SpectralLines::even(20.0, 10.0, 90).unwrap()
}

fn fit(fixture: &Fixture, frfs: &FrfSet) -> JointFit {
    let options = AnalysisOptions { exact: true, laws: false, ..AnalysisOptions::default() };
    Analysis::of(fixture, frfs, &options).unwrap().joint_fit.unwrap()
}

/// The same set made of its FRFs in another order, under other labels, times a factor.
fn relabelled(
    set: &FrfSet,
    order: &[usize],
    label: impl Fn(&FrfPair) -> FrfPair,
    factor: f64,
    hz: f64,
) -> FrfSet {
    let lines = SpectralLines::new(set.lines().hz().iter().map(|f| f * hz).collect()).unwrap();
    let pairs = order.iter().map(|i| label(&set.pairs()[*i])).collect();
    let values = order.iter().flat_map(|i| set.values(*i).iter().map(|v| v * factor)).collect();
    let variance =
        order.iter().flat_map(|i| set.variance(*i).unwrap().iter().map(|v| v * factor * factor)).collect();
    FrfSet::new(lines, set.form(), pairs, values).unwrap().with_variance(variance).unwrap()
}

/// Elements of K in units of their own agree to a small part of their standard deviations.
fn agrees(
    one: (RealMatrix2, RealMatrix2),
    other: (RealMatrix2, RealMatrix2),
    units: RealMatrix2,
) -> Result<(), TestCaseError> {
    for (i, j) in [(0, 0), (0, 1), (1, 1)] {
        let unit = units.at(i, j);
        let (value, std) = (one.0.at(i, j) * unit, one.1.at(i, j) * unit.abs());
        prop_assert!(
            (other.0.at(i, j) - value).abs() < 1e-3 * std,
            "({i},{j}): {} for {value} ± {std}",
            other.0.at(i, j)
        );
        prop_assert!(
            (other.1.at(i, j) / std - 1.0).abs() < 1e-3,
            "({i},{j}): ± {} for {std}",
            other.1.at(i, j)
        );
    }
    Ok(())
}

fn found(fit: &JointFit) -> (RealMatrix2, RealMatrix2) {
    (fit.stiffness, fit.std().0)
}

const SAME: RealMatrix2 = jointscope_linalg::Matrix2([[1.0, 1.0], [1.0, 1.0]]);
const AS_THEY_ARE: [usize; 4] = [0, 1, 2, 3];

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn other_units_of_mass_length_and_time_give_the_same_joint_in_those_units(
        mass in 0.1..10.0_f64, length in 0.2..5.0_f64, time in 0.2..5.0_f64, seed in 1..1000_u64
    ) {
        let blocks = TwoBlocks::default();
        let scaled = TwoBlocks {
            mass: blocks.mass.map(|m| m * mass),
            half_length: blocks.half_length.map(|a| a * length),
            length: blocks.length * length,
            bending_stiffness: blocks.bending_stiffness * mass * length.powi(3) / time.powi(2),
            ..blocks.clone()
        };
        let recorded = Noise::new(seed).on(&frfs(&blocks.fixture(), &ACROSS, &lines()), 1e-3);
        // An accelerance is one over a mass.
        let other = relabelled(&recorded, &AS_THEY_ARE, FrfPair::clone, 1.0 / mass, 1.0 / time);
        let force = mass / time.powi(2);
        let units = jointscope_linalg::Matrix2([[force, force * length], [force * length, force * length.powi(2)]]);
        agrees(found(&fit(&blocks.fixture(), &recorded)), found(&fit(&scaled.fixture(), &other)), units)?;
    }

    #[test]
    fn the_order_of_the_frfs_means_nothing(order in Just(AS_THEY_ARE.to_vec()).prop_shuffle(), seed in 1..1000_u64) {
        let fixture = TwoBlocks::default().fixture();
        let recorded = Noise::new(seed).on(&frfs(&fixture, &ACROSS, &lines()), 1e-3);
        let other = relabelled(&recorded, &order, FrfPair::clone, 1.0, 1.0);
        agrees(found(&fit(&fixture, &recorded)), found(&fit(&fixture, &other)), SAME)?;
    }

    #[test]
    fn force_and_response_of_an_frf_can_be_exchanged(seed in 1..1000_u64) {
        let fixture = TwoBlocks::default().fixture();
        let recorded = Noise::new(seed).on(&frfs(&fixture, &ACROSS, &lines()), 1e-3);
        let exchanged = |pair: &FrfPair| FrfPair::new(pair.reference.clone(), pair.response.clone());
        let other = relabelled(&recorded, &AS_THEY_ARE, exchanged, 1.0, 1.0);
        agrees(found(&fit(&fixture, &recorded)), found(&fit(&fixture, &other)), SAME)?;
    }

    #[test]
    fn frfs_given_twice_with_half_their_weight_count_as_once(seed in 1..1000_u64) {
        let fixture = TwoBlocks::default().fixture();
        let recorded = Noise::new(seed).on(&frfs(&fixture, &ACROSS, &lines()), 1e-3);
        let exchanged = |pair: &FrfPair| FrfPair::new(pair.reference.clone(), pair.response.clone());
        let again = relabelled(&recorded, &AS_THEY_ARE, exchanged, 1.0, 1.0);
        let pairs = [recorded.pairs(), again.pairs()].concat();
        let values = [recorded.all_values(), again.all_values()].concat();
        let variance = (0..8).flat_map(|i| recorded.variance(i % 4).unwrap().iter().map(|v| 2.0 * v)).collect();
        let both = FrfSet::new(lines(), recorded.form(), pairs, values).unwrap().with_variance(variance).unwrap();
        let (once, twice) = (found(&fit(&fixture, &recorded)), found(&fit(&fixture, &both)));
        for (i, j) in [(0, 0), (0, 1), (1, 1)] {
            let std = once.1.at(i, j);
            prop_assert!((twice.0.at(i, j) - once.0.at(i, j)).abs() < 1e-2 * std, "({i},{j}): {} for {} ± {std}", twice.0.at(i, j), once.0.at(i, j));
        }
    }

    #[test]
    fn a_fixture_drawn_from_its_other_side_has_the_joint_seen_from_there(seed in 1..1000_u64) {
        let blocks = TwoBlocks::default();
        let mirrored = TwoBlocks {
            mass: [blocks.mass[1], blocks.mass[0]],
            half_length: [blocks.half_length[1], blocks.half_length[0]],
            ..blocks.clone()
        };
        let recorded = Noise::new(seed).on(&frfs(&blocks.fixture(), &ACROSS, &lines()), 1e-3);
        let turned = |name: &str| ["4", "3", "2", "1"][name.parse::<usize>().unwrap() - 1].to_owned();
        let label = |pair: &FrfPair| FrfPair::transverse(&turned(&pair.response.point), &turned(&pair.reference.point));
        let other = relabelled(&recorded, &AS_THEY_ARE, label, 1.0, 1.0);
        let (one, back) = (found(&fit(&blocks.fixture(), &recorded)), found(&fit(&mirrored.fixture(), &other)));
        // K speaks of the end at point 3; seen from the other end the displacement there is moved by the
        // length and rotations turn the other way.
        let arm = jointscope_linalg::Matrix2([[1.0, -blocks.length], [0.0, -1.0]]);
        let expected = arm.transpose() * one.0 * arm;
        for (i, j) in [(0, 0), (0, 1), (1, 1)] {
            let std = back.1.at(i, j);
            prop_assert!((back.0.at(i, j) - expected.at(i, j)).abs() < 1e-3 * std, "({i},{j}): {} ± {std} for {}", back.0.at(i, j), expected.at(i, j));
        }
    }
}
