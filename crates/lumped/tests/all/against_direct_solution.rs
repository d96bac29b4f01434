//! The modal sums with their low-rank changes, against one dense solution per line of the whole
//! dynamic stiffness matrix by another library.

use jointscope_fixture::Fixture;
use jointscope_lumped::{Model, Station};
use nalgebra::{Complex, DMatrix};
use num_complex::Complex64;
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Dense receptances of the fixture: free assembly by its matrices, supports and dashpots added by hand.
fn direct(fixture: &Fixture, outputs: &[Station], inputs: &[Station], hz: f64) -> Vec<Complex64> {
    let model = Model::new(fixture, hz).unwrap();
    let assembly = model.assembly();
    let n = assembly.order();
    let omega = TAU * hz;
    let structural = match assembly.damping_law() {
        jointscope_damping::DampingLaw::LossFactor(eta) => *eta,
        _ => 0.0,
    };
    let viscous = assembly.viscous_damping();
    let mut z = DMatrix::from_fn(n, n, |i, j| {
        let k = assembly.stiffness()[i * n + j];
        let re = k - omega * omega * assembly.mass()[i * n + j];
        Complex::new(re, omega * viscous[i * n + j] + structural * k)
    });
    let mut add = |row: Vec<f64>, value: Complex<f64>| {
        for i in 0..n {
            for j in 0..n {
                z[(i, j)] += value * row[i] * row[j];
            }
        }
    };
    for support in fixture.supports() {
        let (body, x) = fixture.support_place(support);
        let damping = support.damping.map_or(0.0, |d| d.value);
        let row = assembly.station_row(&Station::transverse(body, x));
        add(row, Complex::new(support.stiffness.value, omega * damping));
        let turning = support.rotational_stiffness.map_or(0.0, |d| d.value);
        add(assembly.station_row(&Station::rotational(body, x)), Complex::new(turning, 0.0));
    }
    let rows = |stations: &[Station]| {
        DMatrix::from_fn(stations.len(), n, |s, i| Complex::new(assembly.station_row(&stations[s])[i], 0.0))
    };
    let solution = z.lu().solve(&rows(inputs).transpose()).unwrap();
    let h = rows(outputs) * solution;
    (0..outputs.len()).flat_map(|o| (0..inputs.len()).map(move |i| (o, i))).map(|(o, i)| h[(o, i)]).collect()
}

fn damping() -> impl Strategy<Value = String> {
    prop_oneof![
        (1e-3f64..0.03, 1e-3f64..0.03).prop_map(|(a, b)| format!(r#"{{"modal_ratios": [{a}, {b}]}}"#)),
        (0.0f64..5.0, 1e-6f64..1e-4)
            .prop_map(|(a, b)| format!(r#"{{"rayleigh": {{"mass": {a}, "stiffness": {b}}}}}"#)),
        (1e-3f64..0.05).prop_map(|a| format!(r#"{{"loss_factor": {a}}}"#)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn blocks_a_storey_and_a_beam_on_supports_respond_as_the_whole_matrix_says(
        m in prop::array::uniform3(0.2f64..5.0), size in prop::array::uniform2(0.03f64..0.15), ei in 10.0f64..500.0,
        k in prop::array::uniform3(1e3f64..1e6), damping in damping(), hz in 5.0f64..900.0, rotational in 10.0f64..1e4
    ) {
        let inertia = [m[0] * size[0] * size[0] / 3.0, m[1] * size[1] * size[1] / 3.0];
        let fixture = Fixture::from_json(&format!(r#"{{
            "bodies": {{
                "A": {{ "mass": {}, "inertia": {}, "x_cg": {} }},
                "B": {{ "mass": {}, "inertia": {}, "x_cg": {}, "masses": [{{"x": 0.12, "mass": 0.03}}] }},
                "S": {{ "mass": {}, "rotates": false }},
                "bar": {{ "beam": {{ "from": 0.3, "to": 0.5, "youngs_modulus": 2e11, "second_moment": 4e-10, "mass_per_length": 0.9 }} }} }},
            "points": {{ "1": {{"body": "A", "x": -0.05}}, "2": {{"body": "A", "x": 0}}, "3": {{"body": "B", "x": 0.06}}, "4": {{"body": "B", "x": 0.13}},
                         "5": {{"body": "S", "x": 0.2}}, "6": {{"body": "bar", "x": 0.35}}, "7": {{"body": "B", "x": 0.15}}, "8": {{"body": "bar", "x": 0.463}} }},
            "joints": {{ "J": {{"from": "2", "to": "3", "beam": {{"youngs_modulus": 1e11, "second_moment": {} }} }},
                         "C": {{"from": "4", "to": "5", "stiffness": [[{}, 0], [0, 0]] }},
                         "D": {{"from": "7", "to": "6", "stiffness": [[{}, 10], [10, 900]] }} }},
            "damping": {damping},
            "supports": {{ "G": {{"point": "1", "stiffness": {}, "damping": 3, "rotational_stiffness": {rotational}}},
                           "W": {{"body": "bar", "x": 0.49, "stiffness": 3e4, "damping": 0.5}} }} }}"#,
            m[0], inertia[0], -size[0], m[1], inertia[1], 0.06 + size[1], m[2], ei / 1e11, k[0], k[1], k[2])).unwrap();
        let outputs = [Station::transverse(0, -0.05), Station::rotational(1, 0.13), Station::transverse(2, 0.2), Station::transverse(3, 0.463)];
        let inputs = [Station::transverse(0, -0.02), Station::rotational(1, 0.06), Station::transverse(3, 0.41)];
        let model = Model::new(&fixture, hz).unwrap();
        let mut receptances = model.receptances(&outputs, &inputs);
        let mut found = vec![Complex64::ZERO; 12];
        prop_assert!(receptances.at(Complex64::new(0.0, TAU * hz), &mut found));
        let expected = direct(&fixture, &outputs, &inputs, hz);
        for o in 0..4 {
            for i in 0..3 {
                let (a, b) = (found[o * 3 + i], expected[o * 3 + i]);
                // Relative to the driving points, so that an antiresonance is no failure. The bar's short elements
                // have frequencies 1e10 times above soft joints', which costs both solutions digits.
                let own = |s: &Station| direct(&fixture, &[*s], &[*s], hz)[0].norm();
                let scale = (own(&outputs[o]) * own(&inputs[i])).sqrt();
                prop_assert!((a - b).norm() < 3e-6 * scale, "({o},{i}) at {hz} Hz: {a} against {b}");
            }
        }
    }
}

#[test]
fn a_free_beam_has_the_frequencies_of_the_closed_form() {
    let fixture = Fixture::from_json(
        r#"{ "bodies": { "beam": { "beam": { "from": 0, "to": 1.2, "youngs_modulus": 2e11, "second_moment": 6e-8, "mass_per_length": 4.7 } } },
             "points": { "1": { "body": "beam", "x": 0.3 } } }"#,
    )
    .unwrap();
    let model = Model::new(&fixture, 1500.0).unwrap();
    let found = model.assembly().natural_frequencies_hz();
    assert_eq!(&found[..2], &[0.0, 0.0]);
    // Roots of cosh z cos z = 1.
    for (mode, z) in
        [4.730_040_745_f64, 7.853_204_624, 10.995_607_838, 14.137_165_491].into_iter().enumerate()
    {
        let expected = z * z / 1.44 * (2e11_f64 * 6e-8 / 4.7).sqrt() / TAU;
        let error = found[mode + 2] / expected - 1.0;
        assert!(error.abs() < 1e-5, "mode {}: {} Hz instead of {expected} Hz", mode + 1, found[mode + 2]);
    }
}

#[test]
fn a_clamped_beam_deflects_statically_as_the_textbook_says() {
    let fixture = Fixture::from_json(
        r#"{ "bodies": { "beam": { "beam": { "from": 0, "to": 0.5, "youngs_modulus": 2e11, "second_moment": 1e-9, "mass_per_length": 1 } } },
             "points": { "1": { "body": "beam", "x": 0.0 }, "2": { "body": "beam", "x": 0.5 } },
             "supports": { "clamp": { "point": "1", "stiffness": 1e12, "rotational_stiffness": 1e10 } } }"#,
    )
    .unwrap();
    let model = Model::new(&fixture, 100.0).unwrap();
    let mut value = [Complex64::ZERO];
    let tip = [Station::transverse(0, 0.5)];
    assert!(model.receptances(&tip, &tip).at(Complex64::new(0.0, 0.01), &mut value));
    let expected = 0.5f64.powi(3) / (3.0 * 200.0);
    assert!((value[0].re / expected - 1.0).abs() < 1e-5, "{} instead of {expected}", value[0].re);
}
