use jointscope_fixture::Fixture;
use jointscope_linalg::LuWorkspace;
use jointscope_lumped::{Model, StateSpace, Station};
use num_complex::Complex64;
use std::f64::consts::TAU;

const LINEAR: &str = r#"
    {"kind": "added_mass", "place": "B", "x": 0.11, "mass": 0.05, "height": 0.02},
    {"kind": "support", "place": "A", "x": -0.03, "stiffness": 3e3, "damping": 2.0},
    {"kind": "attached_resonator", "place": "B", "x": 0.1, "mass": 0.02, "frequency": 300, "damping_ratio": 0.02},
    {"kind": "body_flexibility", "place": "A", "frequency": 1500, "damping_ratio": 0.01},
    {"kind": "interface_compliance", "place": "3", "dof": "rotation", "stiffness": 9e3, "damping": 0.3},
    {"kind": "interface_compliance", "place": "2", "dof": "translation", "stiffness": 8e6},
    {"kind": "stiffness_change", "place": "J", "factor": 1.1},
    {"kind": "relaxation", "place": "J", "ratio": 0.2, "time": 1e-3},
    {"kind": "shear_deformation", "place": "J", "shear_stiffness": 2e6},
    {"kind": "joint_length", "place": "J", "dx": 0.002}"#;

fn fixture(law: &str, physics: &str) -> Fixture {
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ "A": {{ "mass": 1, "inertia": 1e-3, "x_cg": -0.03 }}, "B": {{ "mass": 1, "inertia": 1e-3, "x_cg": 0.09 }} }},
          "points": {{ "1": {{ "body": "A", "x": -0.05 }}, "2": {{ "body": "A", "x": 0 }}, "3": {{ "body": "B", "x": 0.06 }} }},
          "joints": {{ "J": {{ "from": "2", "to": "3", {law} }} }},
          "damping": {{ "modal_ratios": [0.01, 0.02] }}, "physics": [{physics}] }}"#
    ))
    .unwrap()
}

/// tᵀ(sI − A)⁻¹b against the receptance of the modal sums.
#[track_caller]
fn agrees(fixture: &Fixture) {
    let space = StateSpace::new(fixture, 1000.0).unwrap();
    let model = Model::new(fixture, 1000.0).unwrap();
    let (out, input) = (Station::transverse(1, 0.06), Station::transverse(0, -0.05));
    let n = space.states();
    for hz in [20.0, 150.0, 320.0, 900.0] {
        let s = Complex64::new(0.0, TAU * hz);
        let mut lu = LuWorkspace::new();
        lu.factorize(n, |m| {
            for e in 0..n * n {
                m[e] = Complex64::from(-space.matrix()[e]) + if e / n == e % n { s } else { Complex64::ZERO };
            }
        })
        .unwrap();
        let mut x: Vec<Complex64> = space.load(&input).into_iter().map(Complex64::from).collect();
        lu.solve_in_place(&mut x);
        let found: Complex64 = space.displacement(&out).iter().zip(&x).map(|(t, x)| x * *t).sum();
        let mut expected = [Complex64::ZERO];
        assert!(model.receptances(&[out], &[input]).at(s, &mut expected));
        assert!((found / expected[0] - 1.0).norm() < 1e-6, "{hz} Hz: {found} against {}", expected[0]);
    }
}

#[test]
fn every_linear_effect_over_time_has_the_receptance_it_has_by_frequency() {
    let beam = r#""beam": { "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 }"#;
    let spring = r#""stiffness": [[4e6, -1.2e5], [-1.2e5, 5e3]], "damping": [[20, -0.5], [-0.5, 0.03]]"#;
    agrees(&fixture(beam, ""));
    agrees(&fixture(spring, ""));
    agrees(&fixture(beam, LINEAR));
    for one in LINEAR.split("},").map(|one| format!("{}}}", one.trim_end_matches('}'))) {
        agrees(&fixture(beam, &one));
        if !one.contains("shear") && !one.contains("joint_length") {
            agrees(&fixture(spring, &one));
        }
    }
}

#[test]
fn what_is_known_by_frequency_only_is_refused_by_name() {
    for kind in [
        r#"{"kind": "loss_factor", "place": "J", "loss_factor": 0.01}"#,
        r#"{"kind": "joint_mass", "place": "J", "mass": 0.01}"#,
    ] {
        let fixture = fixture(r#""beam": { "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 }"#, kind);
        let error = StateSpace::new(&fixture, 1000.0).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains("no form over time"), "{error}");
    }
}

#[test]
fn the_motion_across_a_joint_is_that_of_its_far_end_beside_its_near_end_carried_over() {
    let space = StateSpace::new(
        &fixture(r#""beam": { "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 }"#, ""),
        1000.0,
    )
    .unwrap();
    let [(deflection, _), (rotation, _)] = space.across("J").unwrap();
    let read = |station: Station| space.displacement(&station);
    let (from, turn) = (read(Station::transverse(0, 0.0)), read(Station::rotational(0, 0.0)));
    let (to, far) = (read(Station::transverse(1, 0.06)), read(Station::rotational(1, 0.06)));
    for s in 0..space.states() {
        assert!((deflection[s] - (to[s] - from[s] - 0.06 * turn[s])).abs() < 1e-9);
        assert!((rotation[s] - (far[s] - turn[s])).abs() < 1e-9);
    }
    assert!(space.across("K").is_none());
}
