//! The 2×2 matrix of a block's motion: what noise does to it, in whatever form FRFs come.

use crate::common::accelerances;
use jointscope_frf::{BlockChannel, BlockLayout, MaskReason, RigidMotionError, fit_rigid_motion};
use jointscope_linalg::{ComplexMatrix2, Matrix2};
use jointscope_samples::Noise;
use jointscope_spectra::{Dof, FrfForm, FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;

const SENSORS: [f64; 3] = [0.0, -0.06, -0.03];
const HITS: [f64; 3] = [0.0, 0.058, 0.02];

fn seat(offset: f64) -> BlockChannel {
    BlockChannel { offset, dof: Dof::Translation }
}

fn turning() -> BlockChannel {
    BlockChannel { offset: 0.0, dof: Dof::Rotation }
}

/// Every sensor for every hit, in the order of [`measured`].
fn layout(sensors: &[f64], hits: &[f64]) -> BlockLayout {
    let seats = hits.iter().flat_map(|&hit| sensors.iter().map(move |&sensor| (seat(sensor), seat(hit))));
    let channels = seats.enumerate().map(|(index, (sensor, hit))| (index, sensor, hit)).collect();
    BlockLayout { channels, rotate: [true, true] }
}

fn known() -> ComplexMatrix2 {
    let c = Complex64::new;
    Matrix2::new(c(1.0, 0.2), c(-0.3, 4.0), c(5.0, -2.0), c(30.0, 11.0))
}

/// FRFs, with their variances, that `matrix` gives on every line, and noise on them.
fn measured(
    form: FrfForm,
    lines: &SpectralLines,
    seats: &BlockLayout,
    variance: impl Fn(usize) -> f64,
    random: &mut Noise,
) -> FrfSet {
    let h = known();
    let mut values = Vec::new();
    let mut variances = Vec::new();
    for (index, sensor, hit) in &seats.channels {
        let column = |j: usize| h.at(0, j) + h.at(1, j) * sensor.offset;
        for _ in 0..lines.len() {
            values.push(column(0) + column(1) * hit.offset + random.complex(variance(*index)));
            variances.push(variance(*index));
        }
    }
    let pairs = (0..seats.channels.len()).map(|i| FrfPair::transverse(&i.to_string(), "h")).collect();
    FrfSet::new(lines.clone(), form, pairs, values).unwrap().with_variance(variances).unwrap()
}

#[test]
fn chi2_of_a_rigid_motion_is_one_a_degree_of_freedom_and_the_covariance_is_that_of_the_errors() {
    let lines = SpectralLines::even(1.0, 1.0, 4000).unwrap();
    let variance = |index: usize| 1e-4 * (1.0 + index as f64);
    let all = layout(&SENSORS, &HITS);
    let set = measured(FrfForm::Receptance, &lines, &all, variance, &mut Noise::from_state(1));
    let fit = fit_rigid_motion(&set, &all).unwrap();
    assert_eq!(fit.surplus, 5);
    // 40,000 degrees of freedom: ±0.007 is one standard deviation.
    assert!((fit.rigidity().unwrap() - 1.0).abs() < 0.02, "{:?}", fit.rigidity());
    let covariance = &fit.covariance.unwrap()[0];
    let mut found = [[Complex64::ZERO; 4]; 4];
    for value in &fit.values {
        let error = *value - known();
        let error = [error.at(0, 0), error.at(0, 1), error.at(1, 0), error.at(1, 1)];
        for (i, row) in found.iter_mut().enumerate() {
            for (j, sum) in row.iter_mut().enumerate() {
                *sum += error[i] * error[j].conj() / lines.len() as f64;
            }
        }
    }
    for i in 0..4 {
        for j in 0..4 {
            let size = (covariance[i][i] * covariance[j][j]).sqrt();
            let off = (found[i][j] - covariance[i][j]).norm() / size;
            assert!(off < 0.08, "({i},{j}): {} for {}", found[i][j], covariance[i][j]);
        }
    }
}

#[test]
fn two_sensors_and_two_hits_have_the_covariance_of_the_differences_that_they_are() {
    // Columns: 0 → y at both, d the sensors' distance, l the hits': eq (19) and (22).
    let (d, l) = (0.06, 0.058);
    let variance = [1.0, 9.0, 4.0, 0.5];
    let lines = SpectralLines::new(vec![3.0]).unwrap();
    let four = layout(&SENSORS[..2], &HITS[..2]);
    let set = measured(FrfForm::Receptance, &lines, &four, |i| variance[i], &mut Noise::from_state(2));
    let covariance = fit_rigid_motion(&set, &four).unwrap().covariance.unwrap()[0];
    let rows = [
        [1.0, 0.0, 0.0, 0.0],
        [-1.0 / l, 0.0, 1.0 / l, 0.0],
        [1.0 / d, -1.0 / d, 0.0, 0.0],
        [-1.0 / (d * l), 1.0 / (d * l), 1.0 / (d * l), -1.0 / (d * l)],
    ];
    for i in 0..4 {
        for j in 0..4 {
            let expected: f64 = (0..4).map(|k| rows[i][k] * variance[k] * rows[j][k]).sum();
            let size: f64 = (covariance[i][i] * covariance[j][j]).sqrt();
            assert!((covariance[i][j] - expected).abs() < 1e-9 * size, "({i},{j})");
        }
    }
}

#[test]
fn mobilities_and_accelerances_give_the_receptances_their_covariance_and_chi2() {
    let lines = SpectralLines::new(vec![20.0, 70.0, 300.0]).unwrap();
    let all = layout(&SENSORS, &HITS);
    let set = measured(FrfForm::Receptance, &lines, &all, |_| 1e-4, &mut Noise::from_state(3));
    let expected = fit_rigid_motion(&set, &all).unwrap();
    for form in [FrfForm::Mobility, FrfForm::Accelerance] {
        let fit = fit_rigid_motion(&set.to_form(form).unwrap(), &all).unwrap();
        for line in 0..3 {
            let off = (fit.values[line] - expected.values[line]).norm_squared().sqrt();
            assert!(off < 1e-9, "{form:?} {off}");
            let (found, wanted) = (fit.residual[line], expected.residual[line]);
            assert!((found / wanted - 1.0).abs() < 1e-9, "{form:?}: chi2 {found} for {wanted}");
            let variance = |fit: &jointscope_frf::BlockFrf| fit.covariance.as_ref().unwrap()[line][3][3];
            assert!((variance(&fit) / variance(&expected) - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn without_variances_the_misfit_is_a_share_of_what_was_measured() {
    // One hit, three sensors on a line but for the middle one: least squares leave (1, −2, 1)/6 of ε.
    let lines = SpectralLines::new(vec![5.0]).unwrap();
    let value = |frf: usize, _| Complex64::from([2.0, 2.0, 2.0 + 0.06][frf]);
    let set = accelerances(&lines, &[("a", "h"), ("b", "h"), ("c", "h")], value);
    let mut seats = layout(&SENSORS, &HITS[..1]);
    seats.rotate = [true, false];
    let fit = fit_rigid_motion(&set, &seats).unwrap();
    let misfit = 0.06_f64.powi(2) * 2.0 / 3.0;
    assert!((fit.residual[0] / (misfit / (4.0 + 4.0 + 2.06_f64.powi(2))) - 1.0).abs() < 1e-9);
    assert_eq!((fit.surplus, fit.rigidity(), fit.covariance), (1, None, None));
}

#[test]
fn lines_that_tell_nothing_are_masked_and_do_not_count() {
    let lines = SpectralLines::new(vec![0.0, 1.0, 2.0]).unwrap();
    let all = layout(&SENSORS, &HITS);
    let receptances = measured(FrfForm::Receptance, &lines, &all, |_| 1e-4, &mut Noise::from_state(4));
    let set = FrfSet::new(
        lines.clone(),
        FrfForm::Accelerance,
        receptances.pairs().to_vec(),
        receptances.all_values().to_vec(),
    );
    let mut set = set.unwrap().with_variance(vec![1e-4; 27]).unwrap();
    for frf in 0..6 {
        set.set_coherence(frf, vec![1.0, 1.0, 0.0]).unwrap();
    }
    let fit = fit_rigid_motion(&set, &all).unwrap();
    assert_eq!(fit.masked, [(0, MaskReason::ZeroFrequency), (2, MaskReason::NoCoherence)]);
    let rigidity = fit.rigidity().unwrap();
    assert!((rigidity - fit.residual[1] / 10.0).abs() < 1e-12 * rigidity, "one usable line of ten degrees");
    // With a coherence on only one hit's point the loaded block's rotation stays unknown.
    for frf in 6..9 {
        set.set_coherence(frf, vec![1.0, 0.0, 0.0]).unwrap();
    }
    for frf in 3..6 {
        set.set_coherence(frf, vec![1.0, 0.0, 0.0]).unwrap();
    }
    let fit = fit_rigid_motion(&set, &all).unwrap();
    assert!(fit.masked.len() == 3 && fit.rigidity().is_none(), "{:?}", fit.masked);
    for reason in [
        MaskReason::ZeroFrequency,
        MaskReason::NoCoherence,
        MaskReason::Undetermined,
        MaskReason::SingularFrf,
    ] {
        assert!(reason.why().split(' ').count() > 3, "{reason:?}");
    }
}

#[test]
fn seats_that_cannot_tell_a_rotation_are_refused_and_those_that_can_are_not() {
    let lines = SpectralLines::new(vec![1.0]).unwrap();
    let refused = |channels: Vec<(BlockChannel, BlockChannel)>, rotate| {
        let channels: Vec<_> = channels.into_iter().enumerate().map(|(i, (s, h))| (i, s, h)).collect();
        let names: Vec<String> = (0..channels.len()).map(|i| i.to_string()).collect();
        let pairs: Vec<(&str, &str)> = names.iter().map(|name| (name.as_str(), "h")).collect();
        let set = accelerances(&lines, &pairs, |frf, _| Complex64::new(1.0 + frf as f64, 0.0));
        fit_rigid_motion(&set, &BlockLayout { channels, rotate }).err()
    };
    let one_place = |what| Some(RigidMotionError::OnePlace { what });
    let (near, far) = (seat(0.0), seat(0.05));
    assert_eq!(refused(vec![(near, near), (far, near)], [true, true]), one_place("hammer points"));
    assert_eq!(refused(vec![(near, near), (near, far)], [true, true]), one_place("sensors"));
    assert_eq!(refused(vec![(turning(), near), (turning(), far)], [true, true]), one_place("sensors"));
    assert_eq!(refused(vec![(near, near), (seat(1e-9), near)], [true, false]), one_place("sensors"));
    assert_eq!(refused(vec![(near, near), (seat(1.1e-9), near)], [true, false]), None);
    assert_eq!(refused(vec![(turning(), near), (near, near)], [true, false]), None);
    assert_eq!(refused(vec![(near, turning()), (near, near)], [false, true]), None);
    let few = RigidMotionError::TooFew { found: 3, needed: 4 };
    assert_eq!(refused(vec![(near, near), (far, near), (near, far)], [true, true]), Some(few));
}

#[test]
fn a_line_whose_variance_is_stated_as_nothing_weighs_its_frfs_alike() {
    let lines = SpectralLines::new(vec![5.0]).unwrap();
    let all = layout(&SENSORS, &HITS);
    let set = measured(FrfForm::Receptance, &lines, &all, |_| 1e-4, &mut Noise::from_state(5));
    let alike = fit_rigid_motion(&set.clone().with_variance(vec![3.0; 9]).unwrap(), &all).unwrap();
    let none = fit_rigid_motion(&set.with_variance(vec![0.0; 9]).unwrap(), &all).unwrap();
    assert!(none.masked.is_empty() && (none.values[0] - alike.values[0]).norm_squared().sqrt() < 1e-9);
}
