//! What is written for each program, read back.

use crate::common::{LENGTH, Matrix, Matrix4, beam, both_ends, exported, file, same};
use crate::readers;
use jointscope_export::{ExportError, ExportOptions, Form, Program, json, write};
use proptest::prelude::*;

/// Large fields of Nastran hold ten digits and more, data lines of Abaqus thirteen.
const NASTRAN: f64 = 1e-9;
const LINES: f64 = 1e-12;

fn text(k: Matrix, c: Matrix, program: Program, form: Option<Form>) -> String {
    let export = exported(&file(k, c), &ExportOptions::default()).unwrap();
    write(&export, program, form, &["made by a test".to_owned()]).unwrap()
}

fn reads_back(k: Matrix, c: Matrix) {
    let (stiffness, damping) = (both_ends(&k, LENGTH), both_ends(&c, LENGTH));
    let dmig = text(k, c, Program::Nastran, Some(Form::Dmig));
    same(&readers::nastran_dmig(&dmig, "KJOINT"), &stiffness, NASTRAN);
    same(&readers::nastran_dmig(&dmig, "BJOINT"), &damping, NASTRAN);
    let ansys = readers::ansys(&text(k, c, Program::Ansys, None));
    same(&ansys[&4], &stiffness, LINES);
    same(&ansys[&5], &damping, LINES);
    let element = readers::abaqus_element(&text(k, c, Program::Abaqus, None));
    same(&element["STIFFNESS"], &stiffness, LINES);
    same(&element["DAMPING"], &damping, LINES);
    let matrix = readers::abaqus_matrix(&text(k, c, Program::Abaqus, Some(Form::Matrix)));
    same(&matrix["STIFFNESS"], &stiffness, LINES);
    same(&matrix["VISCOUS DAMPING"], &damping, LINES);
    let (springs, dashpots) = readers::calculix(&text(k, c, Program::Calculix, None));
    same(&springs, &stiffness, LINES);
    same(&dashpots, &damping, LINES);
    let table = text(k, c, Program::Csv, None);
    same(&readers::csv(&table, "stiffness, both ends"), &stiffness, LINES);
    same(&readers::csv(&table, "damping, both ends"), &damping, LINES);
    let value = json(&exported(&file(k, c), &ExportOptions::default()).unwrap());
    let both = &value["joints"][0]["both_ends"];
    let read: Matrix4 = serde_json::from_value(both["stiffness"].clone()).unwrap();
    same(&read, &stiffness, LINES);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_format_gives_the_joint_back_on_both_its_nodes(
        k11 in 1e3f64..1e9, a in -0.3f64..0.2, turning in 1.0f64..1e6, c11 in 1e-3f64..1e3, b in -0.3f64..0.2, resisting in 1e-4f64..10.0,
    ) {
        let matrix = |first: f64, offset: f64, last: f64| [[first, offset * first], [offset * first, last + offset * offset * first]];
        reads_back(matrix(k11, a, turning), matrix(c11, b, resisting));
    }

    #[test]
    fn a_bush_gives_a_joint_back_whose_damping_shares_its_centre(k11 in 1e3f64..1e9, a in -0.3f64..0.2, turning in 1.0f64..1e6, eta in 1e-6f64..1e-3) {
        let k = [[k11, a * k11], [a * k11, turning + a * a * k11]];
        let c = k.map(|row| row.map(|e| eta * e));
        let (springs, dashpots) = readers::nastran_bush(&text(k, c, Program::Nastran, Some(Form::Bush)));
        same(&springs, &both_ends(&k, LENGTH), NASTRAN);
        same(&dashpots, &both_ends(&c, LENGTH), NASTRAN);
    }

    #[test]
    fn a_rigid_motion_meets_no_force_and_every_matrix_is_symmetric(ei in 1.0f64..1e5, l in 0.01f64..1.0, y in -1.0f64..1.0, theta in -1.0f64..1.0) {
        let ends = jointscope_export::both_ends(&beam(ei, l), l);
        let motion = [y, theta, y + l * theta, theta];
        for i in 0..4 {
            let force: f64 = ends[i].iter().zip(motion).map(|(k, u)| k * u).sum();
            let scale: f64 = ends[i].iter().zip(motion).map(|(k, u)| (k * u).abs()).sum();
            prop_assert!(force.abs() <= 1e-13 * scale);
            for j in 0..4 {
                prop_assert_eq!(ends[i][j], ends[j][i]);
            }
        }
    }
}

#[test]
fn a_bush_of_a_beam_lies_in_its_middle() {
    let k = beam(76.0, LENGTH);
    let text = text(k, [[0.0; 2]; 2], Program::Nastran, None);
    let entries = readers::entries(&text);
    let bush = &entries.iter().find(|(name, _)| name == "CBUSH").unwrap().1;
    assert!((readers::real(&bush[8]) - 0.5).abs() < 1e-11, "{}", bush[8]);
    let property = &entries.iter().find(|(name, _)| name == "PBUSH").unwrap().1;
    assert!((readers::real(&property[3]) / (12.0 * 76.0 / LENGTH.powi(3)) - 1.0).abs() < 1e-11);
    assert!((readers::real(&property[7]) / (76.0 / LENGTH) - 1.0).abs() < 1e-9);
}

#[test]
fn damping_about_another_centre_is_written_as_dmig_and_refused_as_a_bush() {
    let (k, c) = (beam(76.0, LENGTH), [[30.0, 0.9], [0.9, 0.1]]);
    let dmig = text(k, c, Program::Nastran, None);
    assert!(
        dmig.contains("DMIG") && !dmig.contains("CBUSH*") && dmig.contains("K2GG = KJOINT, B2GG = BJOINT")
    );
    let export = exported(&file(k, c), &ExportOptions::default()).unwrap();
    let error = write(&export, Program::Nastran, Some(Form::Bush), &[]).unwrap_err();
    assert!(matches!(error, ExportError::Centres { .. }), "{error}");
}

#[test]
fn dmig_instead_of_a_bush_has_one_reason() {
    let reason = |k, c| {
        let deck = text(k, c, Program::Nastran, None).replace("\n$", "");
        let words = deck.split_whitespace().collect::<Vec<_>>().join(" ");
        let (_, reason) = words.split_once("one CBUSH does not hold it: ").unwrap();
        reason.split(" note: ").next().unwrap().to_owned()
    };
    let damping = [[30.0, 0.9], [0.9, 0.1]];
    assert_eq!(
        reason(beam(76.0, LENGTH), damping),
        "its damping acts about another centre than its stiffness"
    );
    assert_eq!(reason([[-2e6, 0.0], [0.0, 1e3]], damping), "k11 is not positive");
}

#[test]
fn tables_by_frequency_hold_stiffness_and_damping_about_the_centre() {
    let (k, c) = (beam(76.0, LENGTH), [[30.0, -0.9], [-0.9, 0.1]]);
    let options = ExportOptions { by_line: true, ..ExportOptions::default() };
    let export = exported(&file(k, c), &options).unwrap();
    let entries = readers::entries(&write(&export, Program::Nastran, None, &[]).unwrap());
    let card = &entries.iter().find(|(name, _)| name == "PBUSHT").unwrap().1;
    assert_eq!((card[1].as_str(), card[9].as_str()), ("K", "B"));
    let table = |number: &str| {
        let fields = &entries.iter().find(|(n, f)| n == "TABLED1" && f[0] == number).unwrap().1;
        let end = fields.iter().position(|field| field == "ENDT").unwrap();
        fields[8..end]
            .chunks(2)
            .map(|pair| (readers::real(&pair[0]), readers::real(&pair[1])))
            .collect::<Vec<_>>()
    };
    let across = table(&card[3]);
    assert_eq!(across.len(), 3);
    for (hz, value) in across {
        assert!((value / (k[0][0] * (1.0 + hz / 1e4)) - 1.0).abs() < 1e-10);
    }
    // The damping about the middle: c22 + L·c12 + L²/4·c11.
    let expected = 0.1 - LENGTH * 0.9 + LENGTH * LENGTH / 4.0 * 30.0;
    assert!(table(&card[15]).iter().all(|(_, value)| (value / expected - 1.0).abs() < 1e-9));
    for program in [Program::Ansys, Program::Abaqus, Program::Calculix] {
        assert_eq!(write(&export, program, None, &[]), Err(ExportError::ByLine(program)));
    }
    assert_eq!(write(&export, Program::Nastran, Some(Form::Dmig), &[]), Err(ExportError::DmigByLine));
    assert!(write(&export, Program::Csv, None, &[]).unwrap().contains("joint,J,stiffness,2.0E2,y,y,"));
}

#[test]
fn a_form_of_another_program_is_refused() {
    let export = exported(&file(beam(76.0, LENGTH), [[0.0; 2]; 2]), &ExportOptions::default()).unwrap();
    for (program, form) in
        [(Program::Ansys, Form::Bush), (Program::Nastran, Form::Matrix), (Program::Abaqus, Form::Dmig)]
    {
        assert!(matches!(write(&export, program, Some(form), &[]), Err(ExportError::FormOf { .. })));
    }
}

#[test]
fn headers_are_plain_comments_and_the_same_input_gives_the_same_bytes() {
    let (k, c) = (beam(76.0, LENGTH), [[30.0, -0.9], [-0.9, 0.1]]);
    for (program, mark) in [
        (Program::Nastran, '$'),
        (Program::Ansys, '!'),
        (Program::Abaqus, '*'),
        (Program::Calculix, '*'),
        (Program::Csv, '#'),
    ] {
        let first = text(k, c, program, None);
        assert!(first.is_ascii() && first.starts_with(mark) && first.contains("made by a test"));
        assert!(first.contains("SI units") && first.contains("theta about z") && first.contains("k11 = "));
        assert_eq!(first, text(k, c, program, None));
    }
}
