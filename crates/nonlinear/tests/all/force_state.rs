//! Force–state maps of simulated hits, whose law is known.

use jointscope_fixture::{Dof, Fixture};
use jointscope_hits::Hit;
use jointscope_nonlinear::{ForceState, ForceStateError, ForceStateMap, MotionSource, simulate};
use jointscope_spectra::Channel;

const CUBIC: &str =
    r#"{ "kind": "cubic_stiffness", "place": "J", "dof": "translation", "stiffness3": 4e13 }"#;
const BAND: (f64, f64) = (60.0, 2500.0);

fn two_blocks(more: &str, physics: &str) -> Fixture {
    Fixture::from_json(&format!(
        r#"{{
  "bodies": {{ "A": {{ "mass": 1.10, "inertia": 9.5e-4, "x_cg": -0.030 }},
              "B": {{ "mass": 1.30, "inertia": 1.1e-3, "x_cg": 0.095, "masses": [{{ "x": 0.12, "mass": 0.02 }}] }} }},
  "points": {{ "1": {{ "body": "A", "x": -0.060 }}, "2": {{ "body": "A", "x": 0.0 }},
              "3": {{ "body": "B", "x": 0.065 }}, "4": {{ "body": "B", "x": 0.125 }} }},
  "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 }} }} }},
  {more} "damping": {{ "modal_ratios": [0.003] }}, "physics": [{physics}] }}"#
    ))
    .unwrap()
}

/// A blow of 400 N at `struck` and what sensors at `read` record of it.
fn struck(fixture: &Fixture, struck: &str, read: &[&str]) -> Hit {
    let pulse = |i: usize| 400.0 * (-0.5 * ((i as f64 - 40.0) / 1.6).powi(2)).exp();
    let force = (0..4096).map(pulse).collect();
    let hit = Hit::new(1, 1.0 / 6400.0, 0.0, Channel::transverse(struck), force, Vec::new()).unwrap();
    let channels: Vec<Channel> = read.iter().map(|p| Channel::transverse(*p)).collect();
    simulate(fixture, &[hit], &channels).unwrap().hits.remove(0)
}

fn cubic_of(component: &ForceState) -> f64 {
    let beyond = component.beyond_linear();
    let pairs = || beyond.iter().zip(&component.motion);
    pairs().map(|(f, d)| f * d.powi(3)).sum::<f64>() / pairs().map(|(_, d)| d.powi(6)).sum::<f64>()
}

#[test]
fn a_cubic_spring_is_read_from_sensors_on_either_or_both_sides() {
    let fixture = two_blocks("", CUBIC);
    use MotionSource::{Momentum, Sensors};
    let cases: [(&str, &[&str], [MotionSource; 2]); 5] = [
        ("1", &["3", "4"], [Momentum, Sensors]),
        ("4", &["3", "4"], [Momentum, Sensors]),
        ("1", &["1", "2"], [Sensors, Momentum]),
        ("2", &["1", "2", "3", "4"], [Sensors, Sensors]),
        ("1", &["1", "4"], [Momentum, Momentum]),
    ];
    for (at, read, sources) in cases {
        let map = ForceStateMap::of(&fixture, "J", &struck(&fixture, at, read), BAND).unwrap();
        assert_eq!(map.sources.iter().map(|s| s.1).collect::<Vec<_>>(), sources, "{at} {read:?}");
        let [deflection, rotation] = map.components.as_slice() else { panic!("two components") };
        let cubic = cubic_of(deflection);
        assert!((cubic / 4e13 - 1.0).abs() < 0.02, "struck at {at}, read at {read:?}: {cubic:e} N/m³");
        assert!(deflection.explained().unwrap() > 0.98, "{:?}", deflection.explained());
        let power = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>();
        let left = power(&rotation.left_over()) / power(&rotation.force);
        assert!(left < 2e-3, "rotation follows its linear spring: {left:e} of the mean square is left");
    }
}

#[test]
fn force_does_not_depend_on_the_stiffness_and_law_that_the_fixture_states() {
    let hit = struck(&two_blocks("", CUBIC), "1", &["1", "2", "3", "4"]);
    let stated = two_blocks("", "");
    let map = ForceStateMap::of(&stated, "J", &hit, BAND).unwrap();
    assert_eq!(map.components[0].explained(), None);
    assert!((cubic_of(&map.components[0]) / 4e13 - 1.0).abs() < 0.05);
}

#[test]
fn motion_that_sensors_do_not_give_is_the_models_and_is_said_to_be() {
    let held = r#""supports": { "S": { "point": "1", "stiffness": 1e4 } },"#;
    let fixture = two_blocks(held, CUBIC);
    let map = ForceStateMap::of(&fixture, "J", &struck(&fixture, "1", &["3", "4"]), BAND).unwrap();
    assert_eq!(map.weighed, ["B"]);
    assert_eq!(map.sources, [("A".into(), MotionSource::Model), ("B".into(), MotionSource::Sensors)]);
    assert!((cubic_of(&map.components[0]) / 4e13 - 1.0).abs() < 0.02);
}

#[test]
fn bodies_that_do_not_rotate_need_one_sensor_and_show_deflection_alone() {
    let fixture = Fixture::from_json(
        r#"{ "bodies": { "A": { "mass": 2.0, "rotates": false }, "B": { "mass": 3.0, "rotates": false } },
          "points": { "1": { "body": "A", "x": 0 }, "2": { "body": "B", "x": 0.1 } },
          "joints": { "J": { "from": "1", "to": "2", "stiffness": [[5e6, 0], [0, 0]] } },
          "damping": { "modal_ratios": [0.004] },
          "physics": [{ "kind": "gap", "place": "J", "dof": "translation", "clearance": 2e-5, "stiffness": 4e6 }] }"#,
    )
    .unwrap();
    let map = ForceStateMap::of(&fixture, "J", &struck(&fixture, "1", &["2"]), BAND).unwrap();
    assert_eq!(map.components.len(), 1);
    assert_eq!(map.components[0].dof, Dof::Translation);
    assert!(map.components[0].explained().unwrap() > 0.95, "{:?}", map.components[0].explained());
}

#[test]
fn a_map_that_cannot_be_drawn_is_refused_with_the_reason() {
    let free = two_blocks("", "");
    let refused = |fixture: &Fixture, joint: &str, read: &[&str]| {
        ForceStateMap::of(fixture, joint, &struck(fixture, "1", read), BAND).unwrap_err()
    };
    assert!(matches!(refused(&free, "K", &["3", "4"]), ForceStateError::UnknownJoint { .. }));
    let few = refused(&free, "J", &["4"]);
    assert!(matches!(few, ForceStateError::TooFewSensors { .. }), "{few}");
    let both = r#""supports": { "S": { "point": "1", "stiffness": 1e4 }, "T": { "point": "4", "stiffness": 1e4 } },"#;
    let held = refused(&two_blocks(both, ""), "J", &["1", "2", "3", "4"]);
    assert!(matches!(held, ForceStateError::Supported { .. }), "{held}");
    let heavy = r#"{ "kind": "joint_mass", "place": "J", "mass": 0.05 }"#;
    let hit = struck(&free, "1", &["3", "4"]);
    let more = ForceStateMap::of(&two_blocks("", heavy), "J", &hit, BAND).unwrap_err();
    assert!(matches!(more, ForceStateError::Effect { .. }), "{more}");
}
