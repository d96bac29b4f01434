//! The modal sums with their low-rank changes, against one dense solution per line of the whole
//! dynamic stiffness matrix by another library.

use jointscope_beam::element_stiffness;
use jointscope_fixture::{Damping, Fixture, RatiosOf};
use jointscope_lumped::{Assembly, Model, Station};
use nalgebra::{Complex, DMatrix};
use num_complex::Complex64;
use proptest::prelude::*;
use std::f64::consts::TAU;

/// η of the assembly's structural damping.
fn loss_factor(assembly: &Assembly) -> f64 {
    match assembly.damping_law() {
        jointscope_damping::DampingLaw::LossFactor(eta) => *eta,
        _ => 0.0,
    }
}

/// Adds value · row rowᵀ.
fn add(z: &mut DMatrix<Complex64>, row: &[f64], value: Complex64) {
    for i in 0..row.len() {
        for j in 0..row.len() {
            z[(i, j)] += value * row[i] * row[j];
        }
    }
}

/// The dense dynamic stiffness of the fixture without its effects: the assembly by its matrices, what they do
/// not hold of supports added by hand.
fn dynamic_stiffness(fixture: &Fixture, assembly: &Assembly, hz: f64) -> DMatrix<Complex64> {
    let n = assembly.order();
    let omega = TAU * hz;
    let structural = loss_factor(assembly);
    let viscous = assembly.viscous_damping();
    let mut z = DMatrix::from_fn(n, n, |i, j| {
        let k = assembly.stiffness()[i * n + j];
        let re = k - omega * omega * assembly.mass()[i * n + j];
        Complex::new(re, omega * viscous[i * n + j] + structural * k)
    });
    // Ratios of the assembly as it stands belong to matrices that hold the springs.
    let held = matches!(fixture.damping(), Damping::ModalRatios { of: RatiosOf::AsItStands, .. });
    let spring = |stiffness: f64| if held { 0.0 } else { stiffness };
    for support in fixture.supports() {
        let (body, x) = fixture.support_place(support);
        let damping = support.damping.map_or(0.0, |d| d.value);
        let row = assembly.station_row(&Station::transverse(body, x));
        add(&mut z, &row, Complex::new(spring(support.stiffness.value), omega * damping));
        let turning = spring(support.rotational_stiffness.map_or(0.0, |d| d.value));
        add(&mut z, &assembly.station_row(&Station::rotational(body, x)), Complex::new(turning, 0.0));
    }
    z
}

/// Receptances by one dense solution; coordinates beyond the assembly's are read by no station.
fn solved(
    z: DMatrix<Complex64>,
    assembly: &Assembly,
    outputs: &[Station],
    inputs: &[Station],
) -> Vec<Complex64> {
    let rows = |stations: &[Station]| {
        DMatrix::from_fn(stations.len(), z.nrows(), |s, i| {
            Complex::from(assembly.station_row(&stations[s]).get(i).copied().unwrap_or(0.0))
        })
    };
    let (read, forced) = (rows(outputs), rows(inputs).transpose());
    let h = read * z.lu().solve(&forced).unwrap();
    (0..outputs.len()).flat_map(|o| (0..inputs.len()).map(move |i| (o, i))).map(|(o, i)| h[(o, i)]).collect()
}

/// Dense receptances of a fixture without effects.
fn direct(fixture: &Fixture, outputs: &[Station], inputs: &[Station], hz: f64) -> Vec<Complex64> {
    let assembly = Assembly::new(fixture, hz).unwrap();
    solved(dynamic_stiffness(fixture, &assembly, hz), &assembly, outputs, inputs)
}

fn damping() -> impl Strategy<Value = String> {
    prop_oneof![
        (1e-3f64..0.03, 1e-3f64..0.03).prop_map(|(a, b)| format!(r#"{{"modal_ratios": [{a}, {b}]}}"#)),
        (1e-3f64..0.03, 1e-3f64..0.03)
            .prop_map(|(a, b)| format!(r#"{{"modal_ratios": [{a}, {b}], "of": "free"}}"#)),
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
                // Relative to the driving points, so that an antiresonance is no failure. The bar's short
                // elements have frequencies 1e10 times above soft joints', which costs both solutions digits.
                let own = |s: &Station| direct(&fixture, &[*s], &[*s], hz)[0].norm();
                let scale = (own(&outputs[o]) * own(&inputs[i])).sqrt();
                prop_assert!((a - b).norm() < 3e-5 * scale, "({o},{i}) at {hz} Hz: {a} against {b}");
            }
        }
    }
}

/// Three storeys of 2, 2 and 1.5 kg on columns of 300, 250 and 200 kN/m.
fn frame(of: &str, dashpot: f64) -> Fixture {
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ "F1": {{"mass": 2.0, "rotates": false}}, "F2": {{"mass": 2.0, "rotates": false}}, "F3": {{"mass": 1.5, "rotates": false}} }},
             "points": {{ "1": {{"body": "F1", "x": 0.2}}, "2": {{"body": "F2", "x": 0.4}}, "3": {{"body": "F3", "x": 0.6}} }},
             "joints": {{ "S2": {{"from": "1", "to": "2", "stiffness": [[2.5e5, 0], [0, 0]]}}, "S3": {{"from": "2", "to": "3", "stiffness": [[2e5, 0], [0, 0]]}} }},
             "supports": {{ "S1": {{"point": "1", "stiffness": 3e5, "damping": {dashpot}}} }},
             "damping": {{ "modal_ratios": [0.008, 0.011, 0.015]{of} }} }}"#
    ))
    .unwrap()
}

#[test]
fn the_modes_of_a_frame_on_its_columns_have_the_ratios_that_its_fixture_states() {
    let mass = [2.0_f64, 2.0, 1.5];
    let stiffness = DMatrix::from_row_slice(3, 3, &[5.5e5, -2.5e5, 0.0, -2.5e5, 4.5e5, -2e5, 0.0, -2e5, 2e5]);
    // K of coordinates √m·y, whose eigenvectors are the mass-normalised shapes times √m.
    let scaled = DMatrix::from_fn(3, 3, |i, j| stiffness[(i, j)] / (mass[i] * mass[j]).sqrt());
    let eigen = scaled.symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    for dashpot in [0.0, 6.0] {
        let mut viscous = DMatrix::<f64>::zeros(3, 3);
        for (r, ratio) in order.into_iter().zip([0.008, 0.011, 0.015]) {
            let shape = |i: usize| eigen.eigenvectors[(i, r)] / mass[i].sqrt();
            // A test reads what the dashpot to ground does too.
            let rest = 2.0 * ratio * eigen.eigenvalues[r].sqrt() - dashpot * shape(0) * shape(0);
            assert!(rest > 0.0);
            for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                viscous[(i, j)] += mass[i] * shape(i) * rest * shape(j) * mass[j];
            }
        }
        viscous[(0, 0)] += dashpot;
        let fixture = frame("", dashpot);
        let model = Model::new(&fixture, 200.0).unwrap();
        let (top, first) = (Station::transverse(2, 0.6), Station::transverse(0, 0.2));
        let mut receptances = model.receptances(&[top], &[first]);
        for hz in [10.0, 25.4, 61.0, 62.0, 90.0, 130.0] {
            let omega = TAU * hz;
            let z = DMatrix::from_fn(3, 3, |i, j| {
                let inertia = if i == j { omega * omega * mass[i] } else { 0.0 };
                Complex::new(stiffness[(i, j)] - inertia, omega * viscous[(i, j)])
            });
            let expected = z.try_inverse().unwrap()[(2, 0)];
            let mut found = [Complex64::ZERO];
            assert!(receptances.at(Complex64::new(0.0, omega), &mut found));
            assert!((found[0] - expected).norm() < 1e-10 * expected.norm(), "{hz} Hz: {found:?}, {expected}");
        }
    }
}

#[test]
fn ratios_of_the_free_frame_leave_its_first_mode_on_the_columns_hardly_damped() {
    let ratio = |fixture: &Fixture| {
        let free = Assembly::new(fixture, 200.0).unwrap();
        free.mode_damping()[0].viscous
    };
    assert_eq!(ratio(&frame(r#", "of": "free""#, 0.0)), 0.0);
    assert!(ratio(&frame("", 0.0)) > 1.0);
}

#[test]
fn modes_of_a_soft_suspension_use_up_no_damping_ratio() {
    let hung = |supports: &str| {
        let fixture = Fixture::from_json(&format!(
            r#"{{ "bodies": {{ "A": {{"mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03}}, "B": {{"mass": 1.1, "inertia": 9.5e-4, "x_cg": 0.095}} }},
                 "points": {{ "1": {{"body": "A", "x": -0.06}}, "2": {{"body": "A", "x": 0}}, "3": {{"body": "B", "x": 0.065}}, "4": {{"body": "B", "x": 0.125}} }},
                 "joints": {{ "J": {{"from": "2", "to": "3", "beam": {{"youngs_modulus": 2.07e11, "second_moment": 3.67e-10}} }} }},
                 {supports} "damping": {{ "modal_ratios": [0.002, 0.003] }} }}"#
        ));
        Assembly::new(&fixture.unwrap(), 1000.0).unwrap()
    };
    let free = hung("");
    let soft = hung(
        r#""supports": { "L": {"point": "1", "stiffness": 500, "damping": 0.5}, "R": {"point": "4", "stiffness": 500} },"#,
    );
    assert_eq!(free.elastic_modes(), [2, 3]);
    assert_eq!(soft.elastic_modes(), [2, 3]);
    let omega = |assembly: &Assembly, r: usize| assembly.modes().eigenvalues()[r].sqrt();
    for r in [2, 3] {
        let (free, soft) = (
            free.mode_damping()[r].viscous / omega(&free, r),
            soft.mode_damping()[r].viscous / omega(&soft, r),
        );
        // All but what the suspension's own dashpot does.
        assert!(soft < free && soft > 0.9 * free, "{soft}, {free}");
    }
    assert_eq!(soft.mode_damping()[0].viscous, 0.0);
}

#[test]
fn a_free_beam_has_the_frequencies_of_the_closed_form() {
    let fixture = Fixture::from_json(
        r#"{ "bodies": { "beam": { "beam": { "from": 0, "to": 1.2, "youngs_modulus": 2e11, "second_moment": 6e-8, "mass_per_length": 4.7 } } },
             "points": { "1": { "body": "beam", "x": 0.3 } } }"#,
    )
    .unwrap();
    let found = Assembly::new(&fixture, 1500.0).unwrap().natural_frequencies_hz();
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

const BAR: f64 = 0.06;
const BENDING: f64 = 76.0;

/// Two blocks on a bar of length [`BAR`] with an effect on it.
fn two_blocks(damping: &str, effect: &str) -> Fixture {
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ "A": {{ "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }}, "B": {{ "mass": 1.3, "inertia": 1.1e-3, "x_cg": 0.095 }} }},
              "points": {{ "1": {{ "body": "A", "x": -0.06 }}, "2": {{ "body": "A", "x": 0 }}, "3": {{ "body": "B", "x": {BAR} }}, "4": {{ "body": "B", "x": 0.125 }} }},
              "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": 2e11, "second_moment": {} }} }} }},
              "damping": {damping}, "physics": [{effect}] }}"#,
        BENDING / 2e11
    ))
    .unwrap()
}

/// Receptances of [`two_blocks`] with `effect` against those of the bare blocks' dense dynamic stiffness as
/// `by_hand` changes it.
#[track_caller]
fn check_effect(effect: &str, by_hand: impl Fn(DMatrix<Complex64>, &Assembly, f64) -> DMatrix<Complex64>) {
    let stations =
        [Station::transverse(0, -0.06), Station::rotational(0, 0.0), Station::transverse(1, 0.125)];
    for damping in [r#"{"loss_factor": 0.01}"#, r#"{"modal_ratios": [0.004, 0.007]}"#] {
        let bare = two_blocks(damping, "");
        let assembly = Assembly::new(&bare, 900.0).unwrap();
        let changed = Model::new(&two_blocks(damping, effect), 900.0).unwrap();
        let mut receptances = changed.receptances(&stations, &stations);
        for hz in [7.0, 61.0, 240.0, 870.0] {
            let mut found = vec![Complex64::ZERO; 9];
            assert!(receptances.at(Complex64::new(0.0, TAU * hz), &mut found));
            let z = by_hand(dynamic_stiffness(&bare, &assembly, hz), &assembly, hz);
            let expected = solved(z, &assembly, &stations, &stations);
            for (index, (a, b)) in found.iter().zip(&expected).enumerate() {
                assert!((a - b).norm() < 1e-9 * b.norm(), "{effect} at {hz} Hz, {index}: {a} against {b}");
            }
        }
    }
}

/// Motions (y, θ) at the bar's near end and (y, θ) at its far end.
fn ends(assembly: &Assembly) -> [Vec<f64>; 4] {
    let [y1, t1] = Station::both(0, 0.0);
    let [y2, t2] = Station::both(1, BAR);
    [y1, t1, y2, t2].map(|station| assembly.station_row(&station))
}

#[test]
fn a_mass_on_the_face_of_a_block_goes_back_and_forth_as_the_block_turns() {
    let (x, mass, height) = (0.11, 0.06, 0.025);
    let effect =
        format!(r#"{{"kind": "added_mass", "place": "B", "x": {x}, "mass": {mass}, "height": {height}}}"#);
    check_effect(&effect, |mut z, assembly, hz| {
        let [up, turned] = Station::both(1, x).map(|station| assembly.station_row(&station));
        // Of a point at (x, height) on a body that turns by θ: y + … along y, −height·θ along x.
        let along: Vec<f64> = turned.iter().map(|theta| -height * theta).collect();
        for motion in [up, along] {
            add(&mut z, &motion, Complex::new(-(TAU * hz).powi(2) * mass, 0.0));
        }
        z
    });
}

#[test]
fn a_spring_beside_a_joint_acts_on_the_relative_motion_of_its_ends() {
    for (dof, stiffness, damping) in [("translation", 3e5, 40.0), ("rotation", 900.0, 0.2)] {
        let effect = format!(
            r#"{{"kind": "parallel_stiffness", "place": "J", "dof": "{dof}", "stiffness": {stiffness}, "damping": {damping}}}"#
        );
        check_effect(&effect, |mut z, assembly, hz| {
            let [y1, t1, y2, t2] = ends(assembly);
            let stretch: Vec<f64> = (0..y1.len())
                .map(|i| if dof == "rotation" { t2[i] - t1[i] } else { y2[i] - y1[i] - BAR * t1[i] })
                .collect();
            add(&mut z, &stretch, Complex::new(stiffness, TAU * hz * damping));
            z
        });
    }
}

#[test]
fn a_footing_is_a_rotational_spring_at_either_end_of_the_bar() {
    let (stiffness, damping) = (4e3, 0.7);
    let effect =
        format!(r#"{{"kind": "footing", "place": "J", "stiffness": {stiffness}, "damping": {damping}}}"#);
    check_effect(&effect, |bare, assembly, hz| {
        // Two coordinates more: the rotations of the bar's own ends.
        let n = bare.nrows();
        let mut z = bare.resize(n + 2, n + 2, Complex64::ZERO);
        let wide = |mut row: Vec<f64>| {
            row.resize(n + 2, 0.0);
            row
        };
        let [y1, t1, y2, t2] = ends(assembly).map(wide);
        let own = |index: usize| wide((0..=index).map(|i| f64::from(u8::from(i == index))).collect());
        let (turned1, turned2) = (own(n), own(n + 1));
        let element = element_stiffness(BENDING, BAR);
        let modulus = Complex64::new(1.0, loss_factor(assembly));
        for (rows, sign) in [([&y1, &t1, &y2, &t2], -1.0), ([&y1, &turned1, &y2, &turned2], 1.0)] {
            for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
                for (i, j) in (0..n + 2).flat_map(|i| (0..n + 2).map(move |j| (i, j))) {
                    z[(i, j)] += modulus * (sign * element[a][b] * rows[a][i] * rows[b][j]);
                }
            }
        }
        for (held, turned) in [(&t1, &turned1), (&t2, &turned2)] {
            let slip: Vec<f64> = held.iter().zip(turned).map(|(held, turned)| held - turned).collect();
            add(&mut z, &slip, Complex64::new(stiffness, TAU * hz * damping));
        }
        z
    });
}
