//! What of a repaired fixture is exported.

use crate::common::{beam, same};
use crate::readers;
use jointscope_export::{Element, Export, ExportError, ExportOptions, Form, Program, of_diagnosis, write};
use jointscope_fixture::{Dof, Fixture};
use serde_json::{Value, json};

const EI: f64 = 76.0;
const L: f64 = 0.06;

fn fixture(physics: &str, more: &str) -> Fixture {
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ "A": {{ "mass": 1, "inertia": 1e-3, "x_cg": -0.03 }}, "B": {{ "mass": 1, "inertia": 1e-3, "x_cg": 0.09 }} }},
          "points": {{ "1": {{ "body": "A", "x": -0.05 }}, "2": {{ "body": "A", "x": 0 }}, "3": {{ "body": "B", "x": {L} }} }},
          "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": 2e11, "second_moment": 3.8e-10 }} }} }}{more},
          "physics": [{physics}] }}"#
    ))
    .unwrap()
}

fn diagnosis(findings: Value) -> Value {
    json!({"verdict": "explained", "findings": findings, "recording": {"from": 50.0, "to": 800.0}})
}

fn exported(physics: &str) -> Export {
    of_diagnosis(&diagnosis(json!([])), &fixture(physics, ""), &ExportOptions::default()).unwrap()
}

/// The joint's compliance is the sum of what is in series.
fn compliance(m: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    [[m[1][1] / det, -m[0][1] / det], [-m[1][0] / det, m[0][0] / det]]
}

#[test]
fn a_beam_is_its_closed_form_and_a_factor_scales_it() {
    let joint = &exported(r#"{"kind": "stiffness_change", "place": "J", "factor": 0.8}"#).joints[0];
    let expected = beam(0.8 * EI, L);
    for i in 0..2 {
        for j in 0..2 {
            assert!((joint.stiffness[i][j] / expected[i][j] - 1.0).abs() < 1e-12);
        }
    }
    assert_eq!(joint.damping, [[0.0; 2]; 2]);
}

#[test]
fn a_yielding_interface_is_in_series_and_parallel_springs_are_beside_the_joint() {
    let joint = &exported(
        r#"{"kind": "interface_compliance", "place": "3", "dof": "rotation", "stiffness": 9000, "damping": 0},
           {"kind": "parallel_stiffness", "place": "J", "dof": "translation", "stiffness": 1e5, "damping": 3}"#,
    )
    .joints[0];
    let mut softer = compliance(beam(EI, L));
    softer[1][1] += 1.0 / 9000.0;
    let mut expected = compliance(softer);
    expected[0][0] += 1e5;
    for i in 0..2 {
        for j in 0..2 {
            assert!((joint.stiffness[i][j] / expected[i][j] - 1.0).abs() < 1e-10);
        }
    }
    assert!((joint.damping[0][0] - 3.0).abs() < 1e-9 && joint.damping[1][1] == 0.0);
}

#[test]
fn a_loss_factor_is_structural_damping_and_a_joints_mass_is_the_consistent_one() {
    let export = exported(
        r#"{"kind": "loss_factor", "place": "J", "loss_factor": 0.04}, {"kind": "joint_mass", "place": "J", "mass": 0.2}"#,
    );
    let joint = &export.joints[0];
    let expected = beam(EI, L);
    assert!((joint.structural[1][1] / (0.04 * expected[1][1]) - 1.0).abs() < 1e-12);
    let f = 0.2 / 420.0;
    let consistent = [
        [156.0, 22.0 * L, 54.0, -13.0 * L],
        [22.0 * L, 4.0 * L * L, 13.0 * L, -3.0 * L * L],
        [54.0, 13.0 * L, 156.0, -22.0 * L],
        [-13.0 * L, -3.0 * L * L, -22.0 * L, 4.0 * L * L],
    ]
    .map(|row| row.map(|e| f * e));
    same(&joint.mass.unwrap(), &consistent, 1e-6);
}

#[test]
fn a_relaxing_joint_is_read_in_the_middle_of_the_band_and_says_so() {
    let export =
        exported(r#"{"kind": "relaxation", "place": "J", "ratio": 0.6, "time": 7.957747154594767e-4}"#);
    // The middle of 50 to 800 Hz is 200 Hz, where ωτ is one: K₀·(1 + 0.6·(1 + i)/2).
    let expected = beam(EI, L)[0][0];
    let joint = &export.joints[0];
    assert!((joint.stiffness[0][0] / (1.3 * expected) - 1.0).abs() < 1e-9);
    let omega = 200.0 * std::f64::consts::TAU;
    assert!((joint.damping[0][0] / (0.3 * expected / omega) - 1.0).abs() < 1e-9);
    assert!(export.notes.iter().any(|note| note.contains("200 Hz")), "{:?}", export.notes);
    let options = ExportOptions { by_line: true, ..ExportOptions::default() };
    let fixture =
        fixture(r#"{"kind": "relaxation", "place": "J", "ratio": 0.6, "time": 7.957747154594767e-4}"#, "");
    let lines = of_diagnosis(&diagnosis(json!([])), &fixture, &options).unwrap().joints[0].lines.clone();
    assert!((lines.first().unwrap().frequency, lines.last().unwrap().frequency) == (50.0, 800.0));
    assert!(lines.windows(2).all(|pair| pair[0].stiffness[0][0] < pair[1].stiffness[0][0]));
}

#[test]
fn masses_supports_resonators_and_springs_past_the_joint_become_parts_with_their_probability() {
    let physics = r#"{"kind": "added_mass", "place": "B", "x": 0.1, "mass": 0.05},
        {"kind": "support", "place": "A", "x": -0.05, "stiffness": 2000, "damping": 4},
        {"kind": "attached_resonator", "place": "A", "x": -0.02, "mass": 0.02, "frequency": 300, "damping_ratio": 0.01},
        {"kind": "bypass", "place": "A/B", "x_from": 0, "x_to": 0.06, "stiffness": 500, "damping": 1}"#;
    let found = json!([{"kind": "added_mass", "place": "B", "parameters": {"x": {"std": 0.002}, "mass": {"std": 0.001}}, "probability": 0.97}]);
    let export = of_diagnosis(&diagnosis(found), &fixture(physics, ""), &ExportOptions::default()).unwrap();
    let elements: Vec<Element> = export.parts.iter().map(|part| part.element).collect();
    let omega = 300.0 * std::f64::consts::TAU;
    let [b, r, m] = [900_001, 900_002, 900_003];
    assert_eq!(elements[0], Element::Mass { node: b, mass: 0.05 });
    // Point 1 is there already.
    assert_eq!(
        elements[1],
        Element::Ground { node: 1, dof: Dof::Translation, stiffness: 2000.0, damping: 4.0 }
    );
    assert_eq!(elements[2], Element::Mass { node: m, mass: 0.02 });
    let Element::Spring { from, to, stiffness, damping } = elements[3] else { panic!("{:?}", elements[3]) };
    assert_eq!((from, to), (r, m));
    assert!(
        (stiffness / (0.02 * omega * omega) - 1.0).abs() < 1e-12
            && (damping / (4e-4 * omega) - 1.0).abs() < 1e-12
    );
    assert_eq!(elements[4], Element::Spring { from: 2, to: 3, stiffness: 500.0, damping: 1.0 });
    assert!(
        export.parts[0].says.contains("mass = 0.05 ± 0.001 kg")
            && export.parts[0].says.contains("probability 0.97")
    );
    assert!(export.parts[1].says.contains("stated in the fixture"));
    assert!(export.nodes.iter().any(|node| node.number == m && node.only_y));
}

#[test]
fn a_mass_on_a_face_sits_at_a_node_of_its_own_above_the_axis() {
    // Its abscissa is that of point 3, which lies on the axis.
    let physics = r#"{"kind": "added_mass", "place": "B", "x": 0.06, "mass": 0.05, "height": 0.025}"#;
    let export =
        of_diagnosis(&diagnosis(json!([])), &fixture(physics, ""), &ExportOptions::default()).unwrap();
    let Element::Mass { node, mass } = export.parts[0].element else { panic!("{:?}", export.parts) };
    let node = export.nodes.iter().find(|other| other.number == node).unwrap();
    assert_eq!((node.x, node.y, mass, node.existing), (0.06, 0.025, 0.05, false));
    for (program, definition) in [
        (Program::Nastran, "\nGRID*   900001                          6.000000000000-22.500000000000-2"),
        (Program::Ansys, "\nN,900001,6.0E-2,2.5E-2,0\n"),
        (Program::Abaqus, "\n900001, 6.000000000000000E-2, 2.500000000000000E-2, 0.\n"),
        (Program::Calculix, "\n900001, 6.000000000000000E-2, 2.500000000000000E-2, 0.\n"),
        (Program::Csv, "\nnode,900001,y,,,,2.5E-2,,m\n"),
    ] {
        let text = write(&export, program, None, &[]).unwrap();
        assert!(text.contains(definition), "{text}");
        assert!(text.contains("node 900001: on body B: tie it to the body there, defined here at x = 0.06 m, y = 0.025 m, z = 0"), "{text}");
    }
}

#[test]
fn what_has_no_counterpart_is_listed_with_the_reason() {
    let physics = r#"{"kind": "channel_gain", "place": "response 3", "factor": 0.9}, {"kind": "exponential_window", "place": "all", "decay": 3},
        {"kind": "gap", "place": "J", "dof": "rotation", "clearance": 1e-5, "stiffness": 100}"#;
    let fixture = fixture(physics, r#", "damping": { "modal_ratios": [0.002] }"#);
    let findings = json!([{"kind": "quantity_error", "place": "bodies/A/mass", "parameters": {"value": {"value": 1.4}}}]);
    let export = of_diagnosis(&diagnosis(findings), &fixture, &ExportOptions::default()).unwrap();
    let listed: Vec<String> = export.not_exported.iter().map(|o| format!("{}: {}", o.what, o.why)).collect();
    for (what, why) in [
        ("channel gain", "measuring chain"),
        ("exponential window", "measuring chain"),
        ("gap", "amplitude"),
        ("quantity error of bodies/A/mass = 1.4", "your own model"),
        ("modal damping", "in the analysis"),
    ] {
        assert!(listed.iter().any(|line| line.contains(what) && line.contains(why)), "{what}: {listed:?}");
    }
    assert!(export.parts.is_empty());
}

#[test]
fn a_longer_joint_moves_what_lies_beyond_it() {
    let export = exported(r#"{"kind": "joint_length", "place": "J", "dx": 0.002}"#);
    let joint = &export.joints[0];
    assert!((joint.length - 0.062).abs() < 1e-15 && (joint.to.x - joint.from.x - joint.length).abs() < 1e-15);
    assert!((joint.stiffness[0][0] / beam(EI, 0.062)[0][0] - 1.0).abs() < 1e-12);
}

#[test]
fn an_unexplained_diagnosis_is_refused_unless_it_is_wanted_anyway() {
    let unexplained = json!({"verdict": "unexplained", "findings": []});
    let fixture = fixture("", "");
    let refused = of_diagnosis(&unexplained, &fixture, &ExportOptions::default());
    assert_eq!(refused, Err(ExportError::Unexplained));
    let anyway = ExportOptions { anyway: true, ..ExportOptions::default() };
    assert!(of_diagnosis(&unexplained, &fixture, &anyway).is_ok());
    let broken = of_diagnosis(&json!({"findings": []}), &fixture, &anyway);
    assert!(matches!(broken, Err(ExportError::Diagnosis(_))));
}

#[test]
fn of_several_joints_one_is_chosen_for_node_numbers_and_the_others_are_told() {
    let chain = Fixture::from_json(
        r#"{ "bodies": { "A": { "mass": 1, "rotates": false }, "B": { "mass": 1, "rotates": false }, "C": { "mass": 1, "rotates": false } },
          "points": { "1": { "body": "A", "x": 0 }, "2": { "body": "B", "x": 0.1 }, "3": { "body": "C", "x": 0.2 } },
          "joints": { "J": { "from": "1", "to": "2", "stiffness": [[1e6, 0], [0, 0]] }, "K": { "from": "2", "to": "3", "stiffness": [[2e6, 0], [0, 0]] } } }"#,
    )
    .unwrap();
    let with = |joint: Option<&str>, nodes| ExportOptions {
        joint: joint.map(str::to_owned),
        nodes,
        ..ExportOptions::default()
    };
    let export = |options| of_diagnosis(&diagnosis(json!([])), &chain, &options);
    assert_eq!(export(with(None, None)).unwrap().joints.len(), 2);
    assert!(matches!(export(with(None, Some([7, 8]))), Err(ExportError::WhichJoint { .. })));
    assert!(matches!(export(with(Some("L"), None)), Err(ExportError::NoSuchJoint { .. })));
    let one = export(with(Some("K"), Some([7, 8]))).unwrap();
    assert_eq!((one.joints[0].from.node, one.joints[0].to.node, one.joints[0].scalar), (7, 8, true));
    assert!(one.not_exported[0].what.contains("joint J"));
}

#[test]
fn parts_are_masses_springs_and_dashpots_of_every_program() {
    let export = exported(
        r#"{"kind": "added_mass", "place": "B", "x": 0.1, "mass": 0.05}, {"kind": "support", "place": "A", "x": -0.05, "stiffness": 2000, "damping": 4}"#,
    );
    let text = |program| write(&export, program, None, &[]).unwrap();
    let entries = readers::entries(&text(Program::Nastran));
    let fields = |name: &str| &entries.iter().find(|(entry, _)| entry == name).unwrap().1;
    assert_eq!((fields("CONM2")[1].as_str(), readers::real(&fields("CONM2")[3])), ("900001", 0.05));
    for (name, value) in [("CELAS2", 2000.0), ("CDAMP2", 4.0)] {
        let [_, size, node, dof, to, ..] = fields(name).as_slice() else { panic!("{name}") };
        assert_eq!((readers::real(size), node.as_str(), dof.as_str(), to.as_str()), (value, "1", "2", ""));
    }
    let ansys = text(Program::Ansys);
    let mass = &ansys[ansys.find("ET,JS_ET,MASS21").unwrap()..];
    assert!(
        mass.contains("KEYOPT,JS_ET,3,2\n")
            && mass.contains("R,JS_R,5.0E-2\n")
            && mass.contains("\nE,900001\n")
    );
    let spring = &ansys[ansys.find("ET,JS_ET,COMBIN14").unwrap()..];
    assert!(
        spring.contains("KEYOPT,JS_ET,2,2\n")
            && spring.contains("R,JS_R,2.0E3,4.0E0\n")
            && spring.contains("\nE,1,900002\n")
    );
    assert!(ansys.contains("D,900002,ALL,0"), "the spring leads to a fixed node");
    let abaqus = text(Program::Abaqus);
    assert!(
        abaqus.contains("TYPE=MASS") && abaqus.contains("TYPE=SPRING1") && abaqus.contains("TYPE=DASHPOT1")
    );
    assert!(abaqus.contains("\n2\n2.000000000000000E+3\n") && abaqus.contains("\n2\n4.000000000000000E+0\n"));
}

#[test]
fn a_loss_factor_is_the_same_in_a_bush_and_in_dmig_and_told_where_it_cannot_be_written() {
    let export = exported(r#"{"kind": "loss_factor", "place": "J", "loss_factor": 0.04}"#);
    let entries = readers::entries(&write(&export, Program::Nastran, None, &[]).unwrap());
    let bush = &entries.iter().find(|(name, _)| name == "PBUSH").unwrap().1;
    let row = bush.chunks(8).find(|row| row[1] == "GE").unwrap();
    assert!(row[2..].iter().all(|field| !field.is_empty()), "a blank would count otherwise");
    assert!((readers::real(&row[3]) - 0.04).abs() < 1e-12 && (readers::real(&row[7]) - 0.04).abs() < 1e-9);
    let dmig = write(&export, Program::Nastran, Some(Form::Dmig), &[]).unwrap();
    let [stiffness, loss] = ["KJOINT", "SJOINT"].map(|name| readers::nastran_dmig(&dmig, name));
    same(&loss, &stiffness.map(|row| row.map(|e| 0.04 * e)), 1e-9);
    assert!(dmig.contains("K42GG = SJOINT"));
    for program in [Program::Ansys, Program::Abaqus, Program::Calculix] {
        let text = write(&export, program, None, &[]).unwrap();
        assert!(text.contains("structural damping is not written"), "{program}");
    }
    let matrix = readers::abaqus_matrix(&write(&export, Program::Abaqus, Some(Form::Matrix), &[]).unwrap());
    same(&matrix["STRUCTURAL DAMPING"], &loss, 1e-9);
}

#[test]
fn beside_nodes_of_the_model_points_are_numbered_from_the_first_number() {
    let physics = r#"{"kind": "support", "place": "A", "x": -0.05, "stiffness": 2000, "damping": 4},
        {"kind": "attached_resonator", "place": "A", "x": -0.02, "mass": 0.02, "frequency": 300, "damping_ratio": 0.01}"#;
    let numbers = |nodes| {
        let options = ExportOptions { nodes, ..ExportOptions::default() };
        let export = of_diagnosis(&diagnosis(json!([])), &fixture(physics, ""), &options).unwrap();
        for node in &export.nodes {
            let tied = node.says.contains("tie it to the body there");
            assert_eq!(tied, !node.existing && !node.only_y, "{node:?}");
        }
        export.nodes.iter().map(|node| node.number).collect::<Vec<_>>()
    };
    // Point 1 at the support is a node of the file, and 1 may be another node of the model.
    assert_eq!(numbers(Some([7, 8])), [7, 8, 900_001, 900_002, 900_003]);
    assert_eq!(numbers(None), [1, 2, 3, 900_001, 900_002]);
}

#[test]
fn what_was_found_is_called_a_description_only_where_something_was_found() {
    let noted = |findings: Value| {
        let mut diagnosis = diagnosis(findings);
        diagnosis["unnamed"] = json!(true);
        let export = of_diagnosis(&diagnosis, &fixture("", ""), &ExportOptions::default()).unwrap();
        export.notes.iter().any(|note| note.contains("not a cause"))
    };
    assert!(!noted(json!([])));
    assert!(noted(json!([{"kind": "stiffness_change", "place": "J"}])));
}

#[test]
fn a_loss_factor_of_nothing_is_not_listed_as_left_out() {
    let omitted = |factor: f64| {
        let fixture = fixture("", &format!(r#", "damping": {{ "loss_factor": {factor} }}"#));
        of_diagnosis(&diagnosis(json!([])), &fixture, &ExportOptions::default()).unwrap().not_exported.len()
    };
    assert_eq!((omitted(0.0), omitted(0.01)), (0, 1));
}
