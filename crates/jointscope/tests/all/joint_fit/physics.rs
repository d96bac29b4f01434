//! The tests of what physics allows: reciprocity, definiteness, passivity.

use super::{Case, EIGHT, TESTS, fit, fixture, from_uniform, lines, recorded, report, run};
use jointscope::decomposition::{DecompositionError, JointFitOptions, Relation, Sides, decompose, fit_joint};
use jointscope::linalg::Matrix2;
use jointscope::lumped::nominal_stiffness;
use jointscope::spectra::{FrfForm, FrfSet};
use jointscope_samples::Noise;
use num_complex::Complex64;

#[test]
fn p_values_are_uniform_where_the_joint_is_on_the_edge_of_what_physics_allows() {
    let runs = run(&Case::edge(), 60, 3);
    report(&runs);
    for (name, p) in TESTS.iter().zip(&runs.p) {
        // Kolmogorov and Smirnov's bound for 60 values at 1 %.
        assert!(from_uniform(p) < 1.63 / (p.len() as f64).sqrt(), "{name}: {}", from_uniform(p));
    }
}

#[test]
#[ignore = "minutes; the record of the joint from all FRFs has its figures"]
fn p_values_are_uniform_in_three_hundred_runs() {
    let runs = run(&Case::edge(), 400, 4);
    report(&runs);
    for (name, p) in TESTS.iter().zip(&runs.p) {
        println!("{name}: farthest from uniform {:.3}", from_uniform(p));
        assert!(from_uniform(p) < 1.63 / (p.len() as f64).sqrt(), "{name}");
    }
}

#[test]
fn a_joint_whose_k21_is_a_tenth_off_its_k12_fails_reciprocity_and_a_symmetric_one_does_not() {
    let fixture = fixture(&Case::ordinary(), "");
    let sides = Sides::of(&fixture, None).unwrap();
    let dummy = recorded(&fixture, &mut Noise::new(1), 1e-6, &EIGHT[..4]);
    let compliances = decompose(&dummy, &sides, Relation::Exact).unwrap().sides;
    let p = |k21: f64, structural: bool| {
        let mut values = vec![Complex64::ZERO; dummy.all_values().len()];
        let n = lines().len();
        for (line, omega) in lines().omegas().enumerate() {
            let c = |k: f64, c: f64| Complex64::new(k, if structural { 0.012 * k } else { omega * c });
            let joint = Matrix2::new(c(2.4e6, 12.0), c(-8.4e4, -0.35), c(k21, -0.35), c(4.1e3, 0.02));
            let s = &compliances;
            let [a21, a22, b33, b43] = [&s.alpha21, &s.alpha22, &s.beta33, &s.beta43].map(|all| all[line]);
            let h = Relation::synthesize(joint, a21, a22, b33, b43, s.length).unwrap();
            // Reference points 4 and 1; points 3 and 2 lie 61 mm before and 56 mm behind them.
            for (index, (out, input)) in
                [(0.0, 0.0), (-0.061, 0.0), (0.0, 0.056), (-0.061, 0.056)].into_iter().enumerate()
            {
                let row = [h.at(0, 0) + h.at(1, 0) * out, h.at(0, 1) + h.at(1, 1) * out];
                values[index * n + line] = -(row[0] + row[1] * input) * (omega * omega);
            }
        }
        let frfs = FrfSet::new(lines(), FrfForm::Accelerance, dummy.pairs().to_vec(), values).unwrap();
        let fit = fit(&fixture, &Noise::new(4).on(&frfs, 0.01), structural);
        assert!(k21 != -8.4e4 || (fit.stiffness.at(0, 0) / 2.4e6 - 1.0).abs() < 0.01, "{:?}", fit.stiffness);
        assert_eq!(fit.admissible.is_some(), k21 != -8.4e4);
        fit.tests.reciprocity.unwrap()
    };
    for structural in [false, true] {
        let (symmetric, not) = (p(-8.4e4, structural), p(-8.4e4 * 1.1, structural));
        println!("structural {structural}: symmetric {symmetric}, not {not}");
        assert!(symmetric > 0.05 && not < 1e-3, "{structural}: {symmetric} {not}");
    }
}

#[test]
fn a_joint_whose_k22_is_negative_fails_definiteness_and_the_nearest_one_allowed_is_given() {
    let sound = fixture(&Case::ordinary(), "");
    let mut unstable = sound.clone();
    let k22 = unstable.quantities().iter().position(|own| own.path == "joints/J/stiffness/1/1").unwrap();
    unstable.set_quantities(vec![(k22, -900.0)]);
    let fit = fit(&sound, &recorded(&unstable, &mut Noise::new(6), 0.01, &EIGHT), true);
    println!("{:?} {:?}", fit.stiffness, fit.tests);
    assert!(fit.stiffness.at(1, 1) < 0.0, "{:?}", fit.stiffness);
    assert!(fit.tests.definite.is_some_and(|p| p < 1e-3), "{:?}", fit.tests);
    let nearest = fit.admissible.unwrap().stiffness;
    assert!(nearest[0][0] >= 0.0 && nearest[1][1] >= 0.0, "{nearest:?}");
}

#[test]
fn damping_that_would_give_out_energy_is_held_where_it_just_gives_out_none() {
    // A response that runs 50 µs ahead looks as if energy came in.
    let fixture = fixture(&Case::ordinary(), "");
    let frfs = recorded(&fixture, &mut Noise::new(3), 0.01, &EIGHT);
    let (n, omegas) = (frfs.lines().len(), lines().omegas().collect::<Vec<f64>>());
    let ahead: Vec<bool> = frfs.pairs().iter().map(|pair| pair.response.point == "4").collect();
    let frfs = frfs.with_values(|index, value| match ahead[index / n] {
        true => value * Complex64::from_polar(1.0, 5e-5 * omegas[index % n]),
        false => value,
    });
    let fit = fit(&fixture, &frfs, false);
    assert!(fit.is_on_the_boundary && fit.tests.passive.is_some_and(|p| p < 0.05), "{:?}", fit.tests);
    let c = fit.damping;
    let (diagonal, coupled) = (c.at(0, 0) * c.at(1, 1), c.at(0, 1) * c.at(1, 0));
    assert!(c.at(0, 0) >= 0.0 && (diagonal - coupled).abs() < 1e-6 * diagonal, "{c:?}");
}

#[test]
fn a_recording_of_something_else_has_no_joint() {
    let analyst = fixture(&Case::ordinary(), "");
    let mut noise = Noise::new(12);
    let frfs = recorded(&analyst, &mut noise, 0.01, &EIGHT);
    let sides = Sides::of(&analyst, None).unwrap();
    let fitted = |frfs: &FrfSet| {
        let spectrum = decompose(frfs, &sides, Relation::Exact).unwrap();
        let nominal = nominal_stiffness(&sides.joint().law, sides.length());
        fit_joint(frfs, &sides, spectrum.scalar, None, nominal, JointFitOptions::default())
    };
    assert!(fitted(&frfs).is_ok());
    // As large, and of no modes at all.
    let drawn = frfs.all_values().iter().map(|value| noise.complex(2.0 * value.norm_sqr()));
    let drawn: Vec<Complex64> = drawn.collect();
    let other = frfs.clone().with_values(|at, _| drawn[at]);
    let error = fitted(&other).unwrap_err();
    assert!(matches!(error, DecompositionError::NoFit(why) if why.contains("comes near")), "{error}");
}
