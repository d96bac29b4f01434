//! The built program on files: what `decompose` writes and says.

use std::f64::consts::TAU;
use std::fs;

use crate::common::{BENDING_STIFFNESS, Bench, LENGTH, TWO_BLOCKS, matrix, scale};
use jointscope::uff::{Abscissa, Data, FunctionType};
use jointscope_samples::two_blocks_damped;
use serde_json::Value;

const ON_SHIPPED: [&str; 3] = ["decompose", "fixture.json", "hammer-test.uff"];
const ON_TWO_BLOCKS: [&str; 3] = ["decompose", "two.json", "frf.uff"];

fn decompose<'a>(on: [&'a str; 3], more: &[&'a str]) -> Vec<&'a str> {
    [on.as_slice(), more].concat()
}

fn lines(file: &Value) -> &Vec<Value> {
    file["lines"].as_array().unwrap()
}

/// k = EI/L³·[[12, −6L],[−6L, 4L²]], of the beam that [`TWO_BLOCKS`] holds.
fn beam() -> [[f64; 2]; 2] {
    let (f, l) = (BENDING_STIFFNESS / LENGTH.powi(3), LENGTH);
    [[12.0 * f, -6.0 * l * f], [-6.0 * l * f, 4.0 * l * l * f]]
}

#[track_caller]
fn close(found: [[f64; 2]; 2], expected: [[f64; 2]; 2], tolerance: f64, what: &str) {
    for i in 0..2 {
        for j in 0..2 {
            let error = (found[i][j] / expected[i][j] - 1.0).abs();
            assert!(
                error <= tolerance,
                "{what}: element {}{} is {}, expected {} (relative error {error:.1e})",
                i + 1,
                j + 1,
                found[i][j],
                expected[i][j]
            );
        }
    }
}

#[test]
fn the_shipped_example_gives_every_field_of_the_contract() {
    let bench = Bench::shipped("contract");
    let said = bench.done(&decompose(ON_SHIPPED, &["-o", "out"]));
    assert_eq!(said.lines().last(), Some("out/report.html"), "{said}");
    assert!(said.contains("joint J: 400 of 400 lines solved"), "{said}");
    assert!(fs::read_to_string(bench.0.join("out/report.html")).unwrap().starts_with("<!DOCTYPE html>"));

    let file = bench.json("out/stiffness.json");
    assert_eq!((file["joint"]["name"].as_str(), file["relation"].as_str()), (Some("J"), Some("exact")));
    assert_eq!((lines(&file).len(), file["masked"].as_array().map(Vec::len)), (400, Some(0)));
    for (index, line) in lines(&file).iter().enumerate() {
        assert_eq!(line["frequency"].as_f64(), Some(2.5 * (index + 1) as f64));
        matrix(&line["stiffness"]);
        matrix(&line["damping"]);
        for std in [matrix(&line["std"]["stiffness"]), matrix(&line["std"]["damping"])] {
            assert!(std.iter().flatten().all(|s| *s > 0.0), "line {index}: {std:?}");
        }
    }
    for average in [&file["average"], &file["weighted_average"], &file["maximum_likelihood"]] {
        matrix(&average["stiffness"]);
        matrix(&average["damping"]);
        matrix(&average["std"]["stiffness"]);
        matrix(&average["std"]["damping"]);
    }
    let joint = &file["joint"];
    for entry in [joint, &joint["std"]] {
        matrix(&entry["stiffness"]);
        matrix(&entry["damping"]);
    }
    let covariance: Vec<Vec<f64>> = serde_json::from_value(joint["covariance"].clone()).unwrap();
    assert!(covariance.len() == 6 && covariance.iter().all(|row| row.len() == 6), "{covariance:?}");
    let total: f64 =
        joint["laws"].as_array().unwrap().iter().map(|law| law["probability"].as_f64().unwrap()).sum();
    assert!((total - 1.0).abs() < 1e-9, "{total}");
    assert_eq!(joint["law"], joint["laws"][0]["law"]);
    for test in ["reciprocity", "definite", "passive"] {
        assert!((0.0..=1.0).contains(&joint["tests"][test].as_f64().unwrap()), "{test}");
    }
    let band: Vec<f64> =
        file["average"]["band"].as_array().unwrap().iter().map(|f| f.as_f64().unwrap()).collect();
    assert!(band.len() == 2 && 2.5 <= band[0] && band[0] < band[1] && band[1] <= 1000.0, "{band:?}");
}

#[test]
fn the_shipped_examples_joint_comes_out_as_soft_as_its_readme_says() {
    let bench = Bench::shipped("truth");
    bench.done(&decompose(ON_SHIPPED, &["-o", "out"]));
    let file = bench.json("out/stiffness.json");
    // The joint from all FRFs has a mass of its own, and with it the static stiffness.
    let (found, std) = (matrix(&file["joint"]["stiffness"]), matrix(&file["joint"]["std"]["stiffness"]));
    for (i, j, truth) in [(0, 0, 1.4339e6), (0, 1, -4.5212e4), (1, 1, 2.1887e3)] {
        assert!((found[i][j] - truth).abs() < 3.0 * std[i][j], "k{}{} is {}", i + 1, j + 1, found[i][j]);
        assert!(std[i][j] < 0.03 * truth.abs(), "k{}{} ± {}", i + 1, j + 1, std[i][j]);
    }
    let mass = file["joint"]["mass"]["value"].as_f64().unwrap();
    assert!((mass / 0.0768 - 1.0).abs() < 0.1, "{mass} kg");
    let mass_std = file["joint"]["mass"]["std"].as_f64().unwrap();
    assert!((mass - 0.0768).abs() < 3.0 * mass_std, "{mass} ± {mass_std} kg");
    // The layers of epoxy, which the fit across the joint makes too soft.
    for (layer, truth) in [("rotation_from", 7212.0), ("rotation_to", 5515.0)] {
        let ends = &file["interfaces"][layer]["ci95"];
        let (low, high) = (ends[0].as_f64().unwrap(), ends[1].as_f64().unwrap());
        assert!(low < truth && truth < high, "{layer}: {low} to {high}");
    }
    let fit = &file["maximum_likelihood"];
    let found = matrix(&fit["stiffness"]);
    // The table of fixtures/glued-joint/README.md. The strip's mass, which the fixture leaves out, costs a
    // tenth; what the fixture believes lies twice as high.
    for (i, j, truth, believed) in
        [(0, 0, 1.4339e6, 2.8266e6), (0, 1, -4.5212e4, -9.1864e4), (1, 1, 2.1887e3, 3.9808e3)]
    {
        let (k, place) = (found[i][j], format!("k{}{}", i + 1, j + 1));
        assert!((k / truth - 1.0).abs() < 0.2, "{place} is {k} instead of {truth}");
        assert!((k / believed - 1.0).abs() > 0.4, "{place} is {k}, as believed");
    }
    // And the fit says itself that a constant joint is not all there is.
    assert!(fit["chi2_per_dof"].as_f64().unwrap() > 10.0, "{}", fit["chi2_per_dof"]);
}

#[test]
fn the_same_input_gives_the_same_bytes_wherever_they_are_written() {
    let (one, two) = (Bench::shipped("same-1"), Bench::shipped("same-2"));
    one.done(&decompose(ON_SHIPPED, &["-o", "out"]));
    two.done(&decompose(ON_SHIPPED, &["-o", "out"]));
    two.done(&decompose(ON_SHIPPED, &["-o", "a-second-place"]));
    for file in ["stiffness.json", "report.html"] {
        assert!(one.text(&format!("out/{file}")) == two.text(&format!("out/{file}")), "{file} differs");
    }
    // Both tell their command, and that alone is another one.
    for file in ["stiffness.json", "report.html"] {
        let second = two.text(&format!("a-second-place/{file}")).replace("a-second-place", "out");
        assert!(second == two.text(&format!("out/{file}")), "{file} differs");
    }
}

#[test]
fn the_exact_relation_gives_back_what_was_synthesized() {
    let bench = Bench::synthesized("exact", TWO_BLOCKS, "20:1000:2.5");
    bench.done(&decompose(ON_TWO_BLOCKS, &["-o", "out"]));
    let file = bench.json("out/stiffness.json");
    assert_eq!(lines(&file).len(), 393);
    for line in lines(&file) {
        let frequency = line["frequency"].as_f64().unwrap();
        close(matrix(&line["stiffness"]), beam(), 1e-9, &format!("K at {frequency} Hz"));
        let loss = beam().map(|row| row.map(|k| 0.006 * k / (TAU * frequency)));
        close(matrix(&line["damping"]), loss, 1e-6, &format!("C at {frequency} Hz"));
    }
}

#[test]
fn the_papers_relation_gives_its_own_closed_form_signs_included() {
    let fixture = two_blocks_damped(&[0.0]);
    let bench = Bench::synthesized("paper", &fixture, "400:1000:2.5");
    bench.done(&decompose(ON_TWO_BLOCKS, &["--relation", "paper", "-o", "out"]));
    let file = bench.json("out/stiffness.json");
    assert_eq!(file["relation"], "paper");
    // Eq (7) on two rigid blocks and a massless beam, I about the centres of gravity, c their distance from 2
    // and 3.
    let (ei, l, inertia, c) = (BENDING_STIFFNESS, LENGTH, 9.5e-4, 0.03);
    let s = 2.0 * c / inertia;
    for line in lines(&file) {
        let frequency = line["frequency"].as_f64().unwrap();
        let x = (TAU * frequency).powi(2);
        let g = 1.0
            / (1.0 - ei / (l * l) * (12.0 * s + 12.0 * l / inertia) / x
                + 12.0 * (ei / (l * inertia * x)).powi(2));
        let k12 = 6.0 * ei / (l * l) * g * (1.0 - 2.0 * ei / (l * inertia * x));
        let k22 = -2.0 * ei / l * g * (1.0 + 6.0 * ei * s / (l * l * x));
        let expected = [[12.0 * ei / l.powi(3) * g, k12], [-k12, k22]];
        close(matrix(&line["stiffness"]), expected, 1e-8, &format!("eq (7) at {frequency} Hz"));
    }
}

#[test]
fn the_band_asked_for_is_the_band_averaged() {
    let bench = Bench::shipped("band");
    bench.done(&decompose(ON_SHIPPED, &["--band", "400:600", "-o", "out"]));
    let file = bench.json("out/stiffness.json");
    assert_eq!(file["average"]["band"], serde_json::json!([400.0, 600.0]));
    let inside: Vec<f64> = lines(&file)
        .iter()
        .filter(|line| (400.0..=600.0).contains(&line["frequency"].as_f64().unwrap()))
        .map(|line| matrix(&line["stiffness"])[0][0])
        .collect();
    let mean = inside.iter().sum::<f64>() / inside.len() as f64;
    let found = matrix(&file["average"]["stiffness"])[0][0];
    assert_eq!((inside.len(), file["average"]["lines"].as_u64()), (81, Some(81)));
    assert!((found / mean - 1.0).abs() < 1e-12, "eq (35): {mean}, found {found}");
}

const STOREYS: &str = r#"{
  "bodies": { "F1": { "mass": 7.0, "rotates": false }, "F2": { "mass": 6.0, "rotates": false }, "F3": { "mass": 5.0, "rotates": false } },
  "points": { "1": { "body": "F1", "x": 0 }, "2": { "body": "F2", "x": 0.2 }, "3": { "body": "F3", "x": 0.4 } },
  "joints": {
    "lower": { "from": "1", "to": "2", "stiffness": [[3e6, 0], [0, 0]] },
    "upper": { "from": "2", "to": "3", "stiffness": [[5e6, 0], [0, 0]] }
  },
  "damping": { "loss_factor": 0.01 }
}"#;

#[test]
fn each_joint_of_a_chain_is_found_by_its_name() {
    let bench = Bench::new("chain");
    bench.write("two.json", STOREYS);
    bench.done(&["synthesize", "two.json", "--frf", "3/1", "--lines", "20:400:5", "-o", "frf.uff"]);
    for (joint, stiffness) in [("lower", 3e6), ("upper", 5e6)] {
        let said = bench.done(&decompose(ON_TWO_BLOCKS, &["--joint", joint, "-o", joint]));
        assert!(said.starts_with(&format!("joint {joint}: 77 of 77 lines solved")), "{said}");
        let file = bench.json(&format!("{joint}/stiffness.json"));
        assert_eq!(file["joint"]["name"], joint);
        for line in lines(&file) {
            let k = matrix(&line["stiffness"])[0][0];
            assert!((k / stiffness - 1.0).abs() < 1e-9, "{joint} at {} Hz: {k}", line["frequency"]);
        }
    }
}

#[test]
fn rayleigh_damping_of_the_masses_is_no_damping_of_the_joint() {
    let fixture = TWO_BLOCKS
        .replace(r#"{ "loss_factor": 0.006 }"#, r#"{ "rayleigh": { "mass": 4.0, "stiffness": 2e-6 } }"#);
    let bench = Bench::synthesized("rayleigh", &fixture, "50:1000:5");
    bench.done(&decompose(ON_TWO_BLOCKS, &["-o", "out"]));
    for line in lines(&bench.json("out/stiffness.json")) {
        let frequency = &line["frequency"];
        close(matrix(&line["stiffness"]), beam(), 1e-8, &format!("K at {frequency} Hz"));
        let viscous = beam().map(|row| row.map(|k| 2e-6 * k));
        close(matrix(&line["damping"]), viscous, 1e-5, &format!("C at {frequency} Hz"));
    }
}

#[test]
fn a_line_at_zero_and_lines_without_coherence_are_masked_counted_and_told() {
    let bench = Bench::shipped("masked");
    bench.rewrite("hammer-test.uff", "holes.uff", |datasets| {
        for dataset in datasets.iter_mut() {
            dataset.abscissa = Abscissa::Even { start: 0.0, step: 2.5, count: 400 };
            if dataset.function == FunctionType::Coherence && dataset.response.number == 4 {
                let Data::Real(values) = &mut dataset.data else { panic!("a coherence is real") };
                values[100..107].fill(0.0);
            }
        }
    });
    let said = bench.done(&["decompose", "fixture.json", "holes.uff", "-o", "out"]);
    assert!(said.contains("joint J: 392 of 400 lines solved"), "{said}");
    assert!(said.contains("1 line masked: no displacement at 0 Hz"), "{said}");
    assert!(said.contains("7 lines masked: zero coherence"), "{said}");
    let file = bench.json("out/stiffness.json");
    assert_eq!(lines(&file).len(), 392);
    let masked = file["masked"].as_array().unwrap();
    let frequencies: Vec<f64> = masked.iter().map(|m| m["frequency"].as_f64().unwrap()).collect();
    assert_eq!(frequencies, [0.0, 250.0, 252.5, 255.0, 257.5, 260.0, 262.5, 265.0]);
    assert_eq!(masked[0]["why"], "no displacement at 0 Hz");
    assert!(masked[1]["why"].as_str().unwrap().contains("zero coherence"), "{}", masked[1]);
}

#[test]
fn a_line_whose_frf_matrix_is_singular_is_masked_and_one_without_values_left_out() {
    let bench = Bench::synthesized("singular", TWO_BLOCKS, "50:1000:10");
    let with = |name: &str, value: f64| {
        bench.rewrite("frf.uff", name, |datasets| {
            for dataset in datasets.iter_mut() {
                let Data::Complex(values) = &mut dataset.data else { panic!("an FRF is complex") };
                values[10] = value.into();
            }
        });
        bench.done(&["decompose", "two.json", name, "-o", "out"])
    };
    let alike = with("alike.uff", 1.0);
    assert!(alike.contains("1 line masked: the FRF matrix is singular"), "{alike}");
    assert_eq!(bench.json("out/stiffness.json")["masked"][0]["frequency"], 150.0);
    let empty = with("empty.uff", 0.0);
    assert!(empty.contains("95 of 95 lines solved"), "{empty}");
    assert!(empty.contains("3/1, 3/2, 4/1, 4/2 at 150 Hz"), "{empty}");
}

#[test]
fn nodes_directions_and_units_are_what_the_user_says_where_the_file_does_not() {
    let bench = Bench::synthesized("map", TWO_BLOCKS, "50:1000:10");
    bench.rewrite("frf.uff", "other.uff", |datasets| {
        for dataset in datasets.iter_mut() {
            dataset.response.number += 100;
            dataset.reference.number += 100;
            // Sensor 104 looks the other way, and everything along z.
            let sign = if dataset.response.number == 104 { -1 } else { 1 };
            (dataset.response.direction, dataset.reference.direction) = (3 * sign, 3);
            for axis in [&mut dataset.ordinate_axis, &mut dataset.denominator_axis] {
                (axis.data_type, axis.units) = (0, "NONE".to_owned());
            }
            // m/s² per N, told in g per lbf.
            scale(dataset, f64::from(sign) * 4.448_221_615_260_5 / 9.80665);
        }
    });
    let arguments = ["decompose", "two.json", "other.uff", "--assume-units", "g,lbf", "-o", "out", "--map"];
    let by_node = ["101:+z=1:+y", "102:+z=2:+y", "103:+z=3:+y", "104:+z=4:+y"];
    for map in [&by_node[..], &["10*:+z=*:+y"]] {
        bench.done(&[arguments.as_slice(), map].concat());
        for line in lines(&bench.json("out/stiffness.json")) {
            close(matrix(&line["stiffness"]), beam(), 1e-8, &format!("K at {} Hz", line["frequency"]));
        }
    }
}

#[test]
fn an_earlier_result_is_replaced_as_a_whole_and_nothing_else_is_touched() {
    let bench = Bench::shipped("again");
    bench.done(&decompose(ON_SHIPPED, &["-o", "out"]));
    bench.write("out/notes.txt", "mine");
    bench.done(&decompose(ON_SHIPPED, &["--relation", "paper", "-o", "out"]));
    assert_eq!(bench.json("out/stiffness.json")["relation"], "paper");
    assert_eq!(bench.text("out/notes.txt"), "mine");
    let mut names: Vec<_> =
        fs::read_dir(bench.0.join("out")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["notes.txt", "report.html", "stiffness.json"]);
}
