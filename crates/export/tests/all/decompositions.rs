//! Which joint of a decomposition is exported, between which nodes, and what is refused.

use crate::common::{LENGTH, beam, exported, file, same};
use crate::readers;
use jointscope_comparison::Decomposed;
use jointscope_export::{ElasticCentre, ExportError, ExportOptions, Form, Program, write};
use serde_json::{Value, json};

fn plain() -> Value {
    file(beam(76.0, LENGTH), [[30.0, -0.9], [-0.9, 0.1]])
}

/// With a joint from all FRFs besides.
fn fitted() -> Value {
    let mut file = plain();
    let mut covariance = [[0.0; 6]; 6];
    (0..6).for_each(|i| covariance[i][i] = 4.0);
    file["joint"] = json!({"name": "J", "stiffness": beam(80.0, LENGTH), "damping": [[20.0, -0.6], [-0.6, 0.06]], "covariance": covariance});
    file
}

#[test]
fn the_elastic_centre_of_a_beam_is_its_middle_with_the_textbook_stiffnesses() {
    let centre = ElasticCentre::of(&beam(76.0, LENGTH)).unwrap();
    assert!((centre.offset + LENGTH / 2.0).abs() < 1e-15);
    assert!((centre.translation / (12.0 * 76.0 / LENGTH.powi(3)) - 1.0).abs() < 1e-14);
    assert!((centre.rotation / (76.0 / LENGTH) - 1.0).abs() < 1e-12);
    assert_eq!(ElasticCentre::of(&[[0.0, 0.0], [0.0, 5.0]]), None);
}

#[test]
fn the_uncertainty_of_the_centre_follows_from_that_of_the_stiffness() {
    let export = exported(&plain(), &ExportOptions::default()).unwrap();
    let joint = &export.joints[0];
    let [[k11, k12], _] = joint.stiffness;
    let expected = ((1e4 * k12 / (k11 * k11)).powi(2) + (3e2 / k11).powi(2)).sqrt();
    assert!((joint.centre_std().unwrap() / expected - 1.0).abs() < 1e-12);
}

#[test]
fn the_joint_with_moving_quantities_is_preferred_and_brings_its_covariance() {
    let mut file = plain();
    let mut covariance = [[0.0; 6]; 6];
    (0..6).for_each(|i| covariance[i][i] = 4.0);
    (covariance[0][1], covariance[1][0]) = (1.0, 1.0);
    file["joint"] = json!({"name": "J", "stiffness": [[2e6, -5e4], [-5e4, 2e3]], "damping": [[1.0, 0.0], [0.0, 1.0]], "covariance": covariance});
    let export = exported(&file, &ExportOptions::default()).unwrap();
    let joint = &export.joints[0];
    assert_eq!((joint.name.as_str(), joint.stiffness[0][0]), ("J", 2e6));
    assert_eq!((joint.covariance, joint.std.unwrap().0[0][0]), (Some(covariance), 2.0));
    // Correlated errors: g² + h² at variance 4 and twice g·h at covariance 1.
    let (g, h): (f64, f64) = (5e4 / 4e12, 1.0 / 2e6);
    let expected = (4.0 * (g * g + h * h) + 2.0 * g * h).sqrt();
    assert!((joint.centre_std().unwrap() / expected - 1.0).abs() < 1e-12);
}

#[test]
fn nodes_of_the_model_are_taken_and_points_keep_their_numbers_otherwise() {
    let numbers = |options: &ExportOptions| {
        let export = exported(&plain(), options).unwrap();
        export.nodes.iter().map(|node| (node.number, node.existing)).collect::<Vec<_>>()
    };
    assert_eq!(numbers(&ExportOptions::default()), [(2, false), (3, false)]);
    let options = ExportOptions { nodes: Some([505, 101]), ..ExportOptions::default() };
    assert_eq!(numbers(&options), [(101, true), (505, true)]);
    let mut named = plain();
    named["ends"]["to"]["point"] = json!("end");
    let export = exported(&named, &ExportOptions::default()).unwrap();
    assert_eq!(export.joints[0].to.node, 900_001, "a name that is no number");
    let twice = ExportOptions { nodes: Some([7, 7]), ..ExportOptions::default() };
    assert_eq!(exported(&plain(), &twice), Err(ExportError::NodeTwice(7)));
    let nought = ExportOptions { nodes: Some([0, 7]), ..ExportOptions::default() };
    assert_eq!(exported(&plain(), &nought), Err(ExportError::NodeNumber(0)));
}

#[test]
fn an_unusable_joint_is_refused_unless_it_is_wanted_anyway() {
    let mut file = plain();
    file["judgement"] = json!({"verdict": "unusable", "poor_fit": 80.0});
    let error = exported(&file, &ExportOptions::default()).unwrap_err();
    assert!(error.to_string().contains("80") && error.to_string().contains("--anyway"), "{error}");
    let anyway = ExportOptions { anyway: true, ..ExportOptions::default() };
    assert!(exported(&file, &anyway).unwrap().notes[0].contains("UNUSABLE"));
    file["judgement"] = json!({"verdict": "with_care"});
    assert!(exported(&file, &ExportOptions::default()).unwrap().notes[0].contains("with care"));
}

#[test]
fn what_a_file_does_not_say_is_refused() {
    let mut file = plain();
    file.as_object_mut().unwrap().remove("ends");
    assert_eq!(exported(&file, &ExportOptions::default()), Err(ExportError::NoEnds));
    let mut paper = plain();
    paper["relation"] = json!("paper");
    let by_line = ExportOptions { by_line: true, ..ExportOptions::default() };
    assert_eq!(exported(&paper, &by_line), Err(ExportError::PaperLines));
    paper["maximum_likelihood"] = json!({"failed": "singular"});
    assert_eq!(exported(&paper, &ExportOptions::default()), Err(ExportError::OnlyPaper));
    let other = ExportOptions { joint: Some("K".into()), ..ExportOptions::default() };
    assert!(matches!(exported(&plain(), &other), Err(ExportError::NoSuchJoint { .. })));
}

#[test]
fn a_joints_own_mass_is_written_as_the_fit_has_it() {
    let mut file = fitted();
    file["joint"]["mass"] = json!({"value": 0.21, "std": 0.01});
    let export = exported(&file, &ExportOptions::default()).unwrap();
    let (l, f) = (LENGTH, 0.21 / 420.0);
    let consistent = [
        [156.0, 22.0 * l, 54.0, -13.0 * l],
        [22.0 * l, 4.0 * l * l, 13.0 * l, -3.0 * l * l],
        [54.0, 13.0 * l, 156.0, -22.0 * l],
        [-13.0 * l, -3.0 * l * l, -22.0 * l, 4.0 * l * l],
    ]
    .map(|row| row.map(|e| f * e));
    same(&export.joints[0].mass.unwrap(), &consistent, 1e-12);
    assert!(export.joints[0].says.contains("0.21 ± 0.01 kg"), "{}", export.joints[0].says);
    let deck = write(&export, Program::Nastran, None, &[]).unwrap();
    same(&readers::nastran_dmig(&deck, "MJOINT"), &consistent, 1e-9);
    assert!(deck.contains("M2GG = MJOINT"));
    same(&readers::ansys(&write(&export, Program::Ansys, None, &[]).unwrap())[&2], &consistent, 1e-12);
    let calculix = write(&export, Program::Calculix, None, &[]).unwrap();
    assert!(calculix.contains("its mass is not written"), "{calculix}");
    file["ends"]["length"] = json!(0.0);
    let mut halves = [[0.0; 4]; 4];
    (halves[0][0], halves[2][2]) = (0.105, 0.105);
    assert_eq!(exported(&file, &ExportOptions::default()).unwrap().joints[0].mass, Some(halves));
}

#[test]
fn lines_have_the_joints_inertia_in_them_so_its_mass_is_not_added() {
    let mut file = fitted();
    file["joint"]["mass"] = json!({"value": 0.21, "std": 0.01});
    let by_line = ExportOptions { by_line: true, ..ExportOptions::default() };
    let export = exported(&file, &by_line).unwrap();
    assert_eq!(export.joints[0].mass, None);
    assert!(export.notes.iter().any(|note| note.contains("0.21 kg is not written")), "{:?}", export.notes);
}

#[test]
fn numbers_of_the_models_nodes_are_not_given_again() {
    for nodes in [[900_001, 900_003], [900_006, 900_002]] {
        let options = ExportOptions { nodes: Some(nodes), ..ExportOptions::default() };
        let export = exported(&plain(), &options).unwrap();
        let deck = write(&export, Program::Calculix, None, &[]).unwrap();
        let blocks = readers::blocks(&deck);
        let (_, defined) = blocks.iter().find(|(keyword, _)| keyword == "*NODE").unwrap();
        assert!(defined.len() >= 8, "rotations, motions and fixed nodes");
        for number in nodes.map(|number| number.to_string()) {
            assert!(defined.iter().all(|line| line[0] != number), "{number} is defined anew");
        }
    }
    let high = ExportOptions { nodes: Some([99_000_001, 7]), ..ExportOptions::default() };
    assert_eq!(exported(&plain(), &high), Err(ExportError::NodeNumber(99_000_001)));
}

#[test]
fn a_first_number_that_programs_do_not_read_is_refused() {
    let mut named = plain();
    named["ends"]["to"]["point"] = json!("end");
    for first_id in [0, 99_000_001, u64::MAX] {
        let options = ExportOptions { first_id, ..ExportOptions::default() };
        assert_eq!(exported(&named, &options), Err(ExportError::NodeNumber(first_id)));
    }
}

#[test]
fn without_a_joint_from_all_frfs_the_maximum_likelihood_joint_is_exported() {
    let mut file = plain();
    file["joint"] = json!({"name": "weld", "failed": "the fit did not converge"});
    let export = exported(&file, &ExportOptions::default()).unwrap();
    let joint = &export.joints[0];
    assert_eq!((joint.name.as_str(), joint.says.as_str()), ("weld", "the maximum-likelihood joint"));
}

#[test]
fn another_law_than_the_one_written_is_not_claimed_for_what_is_written() {
    let mut file = fitted();
    for (law, says) in [
        ("structural", "those of a viscous joint, over frequency the most probable law is structural"),
        ("standard_linear_solid_with_mass", "law is standard linear solid with mass"),
        ("viscous", "deviations; viscous, the most probable law"),
    ] {
        file["joint"]["law"] = json!(law);
        let export = exported(&file, &ExportOptions::default()).unwrap();
        assert!(export.joints[0].says.contains(says), "{}", export.joints[0].says);
    }
}

#[test]
fn a_structural_joint_is_written_with_structural_damping_and_no_dashpot() {
    let mut file = fitted();
    let stated = exported(&file, &ExportOptions::default()).unwrap().joints[0].damping;
    file["joint"]["law"] = json!("structural");
    file["joint"]["follows"] = json!({"law": "structural", "frequency": 100.0,
        "loss_factor": {"value": [[0.004, 0.005], [0.005, 0.006]], "std": [[1e-4, 1e-4], [1e-4, 1e-4]]}});
    let joint = exported(&file, &ExportOptions::default()).unwrap().joints[0].clone();
    assert!(joint.says.contains("loss factor of k11 being 0.004"), "{}", joint.says);
    assert_eq!(joint.damping, [[0.0; 2]; 2]);
    let omega = std::f64::consts::TAU * 100.0;
    for (h, c) in joint.structural.iter().flatten().zip(stated.iter().flatten()) {
        assert!((h - omega * c).abs() <= 1e-12 * h.abs(), "{h} for {c}");
    }
    // Of another law K and C hold at one frequency, which is said.
    file["joint"]["law"] = json!("fractional");
    file["joint"]["follows"] = json!({"law": "fractional", "frequency": 100.0});
    let joint = exported(&file, &ExportOptions::default()).unwrap().joints[0].clone();
    assert!(joint.says.contains("fractional, and K and C are what it has at 100 Hz alone"), "{}", joint.says);
    assert_eq!(joint.damping, stated);
}

#[test]
fn programs_without_structural_damping_get_the_viscous_one_that_loses_as_much_in_the_bands_middle() {
    let viscous = fitted();
    let mut structural = viscous.clone();
    structural["joint"]["law"] = json!("structural");
    structural["joint"]["follows"] = json!({"law": "structural", "frequency": 100.0});
    for program in [Program::Ansys, Program::Abaqus, Program::Calculix] {
        let [viscous, structural] = [&viscous, &structural].map(|file| {
            let export = exported(file, &ExportOptions::default()).unwrap();
            write(&export, program, None, &[]).unwrap()
        });
        assert!(structural.contains("as much at 100"), "{structural}");
        assert!(!structural.contains("c11 = 0"), "{structural}");
        // Numbers to rounding: times ω and back.
        let numbers = |deck: &str| -> Vec<f64> {
            let commands = deck.lines().filter(|line| !line.starts_with(['!', '*']));
            let fields = commands.flat_map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
            fields.filter_map(|field| field.trim().parse().ok()).collect()
        };
        let (viscous, structural) = (numbers(&viscous), numbers(&structural));
        assert_eq!(viscous.len(), structural.len(), "{program:?}");
        let same = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-12 * a.abs().max(b.abs());
        assert!(viscous.iter().zip(&structural).all(same), "{program:?}");
    }
}

#[test]
fn a_structural_joint_is_a_bush_where_its_losses_share_the_centre_within_their_uncertainty() {
    let mut file = fitted();
    file["joint"]["law"] = json!("structural");
    file["joint"]["follows"] = json!({"law": "structural", "frequency": 100.0});
    let has_bush = |c12_off: f64, std: f64| {
        let mut file = file.clone();
        let (k, mut c) = (beam(76.0, LENGTH), beam(76e-5, LENGTH));
        (c[0][1], c[1][0]) = (c[0][1] * (1.0 + c12_off), c[1][0] * (1.0 + c12_off));
        (file["joint"]["stiffness"], file["joint"]["damping"]) = (json!(k), json!(c));
        let mut covariance = [[0.0; 6]; 6];
        covariance[4][4] = (std * c[0][1]).powi(2);
        file["joint"]["covariance"] = json!(covariance);
        let export = exported(&file, &ExportOptions::default()).unwrap();
        let deck = write(&export, Program::Nastran, None, &[]).unwrap();
        deck.lines().any(|line| line.starts_with("CBUSH"))
    };
    assert!(has_bush(0.01, 0.02));
    assert!(!has_bush(0.01, 0.001));
}

#[test]
fn a_bush_with_tables_by_line_has_the_losses_of_a_structural_joint_once() {
    let mut file = fitted();
    (file["joint"]["stiffness"], file["joint"]["damping"]) =
        (json!(beam(76.0, LENGTH)), json!(beam(76e-5, LENGTH)));
    file["joint"]["law"] = json!("structural");
    file["joint"]["follows"] = json!({"law": "structural", "frequency": 100.0,
        "loss_factor": {"value": [[0.004, 0.004], [0.004, 0.004]], "std": [[1e-4, 1e-4], [1e-4, 1e-4]]}});
    let deck = |by_line: bool| {
        let options = ExportOptions { by_line, ..ExportOptions::default() };
        let export = exported(&file, &options).unwrap();
        write(&export, Program::Nastran, Some(Form::Bush), &[]).unwrap()
    };
    let has_loss_factor = |deck: &str| deck.lines().any(|line| !line.starts_with('$') && line.contains("GE"));
    assert!(has_loss_factor(&deck(false)));
    let tables = deck(true);
    assert!(tables.contains("PBUSHT") && !has_loss_factor(&tables), "{tables}");
}

#[test]
fn a_stiffness_that_is_not_positive_definite_is_told() {
    let noted = |k: [[f64; 2]; 2]| {
        let export = exported(&file(k, [[0.0; 2]; 2]), &ExportOptions::default()).unwrap();
        export.notes.iter().find(|note| note.contains("not positive definite")).cloned()
    };
    assert_eq!(noted(beam(76.0, LENGTH)), None);
    assert_eq!(noted([[2e6, 0.0], [0.0, 0.0]]), None, "blocks that do not rotate");
    assert!(noted([[2e6, -6e4], [-6e4, 1e3]]).unwrap().contains("k11*k22 - k12^2 is not positive"));
    assert!(noted([[-2e6, 0.0], [0.0, 1e3]]).unwrap().contains("k11 is not positive"));
}

#[test]
fn tests_that_the_joint_failed_are_told() {
    let mut file = fitted();
    file["joint"]["tests"] = json!({"reciprocity": 0.01, "definite": 0.3, "passive": null});
    let export = exported(&file, &ExportOptions::default()).unwrap();
    assert_eq!(export.notes.len(), 1);
    assert!(export.notes[0].contains("not reciprocal (p = 0.01)"), "{:?}", export.notes);
    file["joint"]["tests"] = json!({"reciprocity": 0.06, "definite": 0.02, "passive": 0.04});
    let notes = exported(&file, &ExportOptions::default()).unwrap().notes;
    assert!(notes[0].contains("negative eigenvalue") && notes[1].contains("gives out energy"), "{notes:?}");
}

#[test]
fn a_maximum_likelihood_joint_that_is_not_whole_is_an_error_unless_it_failed() {
    let mut file = plain();
    file["maximum_likelihood"].as_object_mut().unwrap().remove("damping");
    let error = Decomposed::of("J", &file).unwrap_err().to_string();
    assert!(error.contains("maximum_likelihood") && error.contains("make the file anew"), "{error}");
    file["maximum_likelihood"] = json!({"failed": "no descent"});
    assert_eq!(Decomposed::of("J", &file).unwrap().likelihood, None);
    assert!(exported(&file, &ExportOptions::default()).unwrap().joints[0].says.contains("plain average"));
}
