//! The built program on files: what `synthesize` writes, and what it refuses.

use std::fs;
use std::process::{Command, Stdio};

use crate::common::Bench;
use jointscope::uff::{Abscissa, Data, Encoding, FunctionType};
use jointscope_samples::{two_blocks_damped, with};

/// Two blocks whose response 4 was recorded with the sign turned and twice as large.
fn fixture() -> String {
    let gain = r#""physics": [ { "kind": "channel_gain", "place": "response 4", "factor": -2.0 } ]"#;
    with(&two_blocks_damped(&[0.002, 0.003]), gain)
}

/// A directory with a fixture, `two.json`, in it.
fn bench(name: &str, fixture: &str) -> Bench {
    let bench = Bench::new(&format!("synthesize-{name}"));
    bench.write("two.json", fixture);
    bench
}

/// Real and imaginary part.
fn value(dataset: &jointscope::uff::Dataset58, line: usize) -> (f64, f64) {
    match &dataset.data {
        Data::Complex(values) => (values[line].re, values[line].im),
        Data::Real(_) => panic!("an FRF is complex"),
    }
}

#[test]
fn the_default_is_four_frfs_across_the_joint_on_four_hundred_lines() {
    let bench = bench("default", &fixture());
    let summary = bench.done(&["synthesize", "two.json", "-o", "frf.uff"]);
    assert!(
        summary.starts_with("frf.uff: FRFs 4/1, 3/1, 4/2, 3/2 on 400 lines, 2.5 to 1000 Hz"),
        "{summary}"
    );
    let frfs = bench.datasets("frf.uff");
    let nodes: Vec<_> = frfs.iter().map(|frf| (frf.response.number, frf.reference.number)).collect();
    assert_eq!(nodes, [(4, 1), (3, 1), (4, 2), (3, 2)]);
    for frf in &frfs {
        assert_eq!(frf.function, FunctionType::FrequencyResponse);
        assert_eq!(frf.encoding, Encoding::default());
        assert_eq!(frf.abscissa, Abscissa::Even { start: 2.5, step: 2.5, count: 400 });
        assert_eq!((frf.ordinate_axis.data_type, frf.denominator_axis.data_type), (12, 13));
        assert_eq!(frf.id_lines[0], "two blocks and a beam");
    }
}

#[test]
fn rigid_body_lines_come_out_in_closed_form() {
    let bench = bench("closed-form", &fixture());
    bench.done(&["synthesize", "two.json", "--perfect", "--frf", "1/1", "--lines", "0:1:0.5", "-o", "f.uff"]);
    // At 0 Hz the two blocks move as one body: 1/M + (x − x_cg)²/I.
    let (mass, x_cg) = (2.2_f64, 0.0325_f64);
    let inertia = 2.0 * (9.5e-4 + 1.1 * 0.0625_f64.powi(2));
    let expected = 1.0 / mass + (-0.06 - x_cg).powi(2) / inertia;
    let (re, im) = value(&bench.datasets("f.uff")[0], 0);
    assert!((re - expected).abs() < 1e-6 * expected, "at 0 Hz: expected {expected}, got {re}");
    assert!(im.abs() < 1e-6 * expected, "at 0 Hz the accelerance is real: {im}");
}

#[test]
fn a_perfect_instrument_leaves_out_the_effects_of_the_channels() {
    let bench = bench("perfect", &fixture());
    bench.done(&["synthesize", "two.json", "-o", "recorded.uff"]);
    bench.done(&["synthesize", "two.json", "--perfect", "-o", "perfect.uff"]);
    let (recorded, perfect) = (bench.datasets("recorded.uff"), bench.datasets("perfect.uff"));
    for (frf, factor) in [(0, -2.0), (1, 1.0)] {
        let ((a, _), (b, _)) = (value(&recorded[frf], 100), value(&perfect[frf], 100));
        assert!((a - factor * b).abs() <= 1e-12 * a.abs(), "FRF {frf}: {a} is not {factor} times {b}");
    }
}

#[test]
fn text_and_binary_hold_the_same_frfs() {
    let bench = bench("ascii", &fixture());
    let frfs = ["--frf", "4:theta/1", "3/2", "--lines", "10:500:0.25"];
    bench.done(&[["synthesize", "two.json", "-o", "b.uff"].as_slice(), &frfs].concat());
    bench.done(&[["synthesize", "two.json", "--ascii", "-o", "a.uff"].as_slice(), &frfs].concat());
    let (binary, text) = (bench.datasets("b.uff"), bench.datasets("a.uff"));
    assert_eq!((binary[0].response.direction, binary[0].reference.direction), (6, 2));
    for (binary, text) in binary.iter().zip(&text) {
        assert_eq!((&text.encoding, &text.abscissa), (&Encoding::Ascii, &binary.abscissa));
        for line in 0..binary.data.len() {
            let ((a, b), (c, d)) = (value(binary, line), value(text, line));
            assert!((a - c).hypot(b - d) <= 1e-10 * a.hypot(b), "line {line}: {a} {b} against {c} {d}");
        }
    }
}

/// The FRFs, without their coherence.
fn frfs_of(bench: &Bench, file: &str) -> Vec<jointscope::uff::Dataset58> {
    let of_type = |dataset: &jointscope::uff::Dataset58| dataset.function == FunctionType::FrequencyResponse;
    bench.datasets(file).into_iter().filter(of_type).collect()
}

#[test]
fn the_coherence_of_noisy_frfs_says_the_noise_that_is_in_them() {
    let bench = bench("noise", &fixture());
    let answer = bench.done(&[
        "synthesize",
        "two.json",
        "--noise",
        "0.8",
        "--averages",
        "16",
        "--seed",
        "7",
        "-o",
        "n.uff",
    ]);
    assert!(
        answer.contains("noise 0.8 %, 16 averages, seed 7: on average each FRF is off by 0.2"),
        "{answer}"
    );
    bench.done(&["synthesize", "two.json", "-o", "clean.uff"]);
    let all = bench.datasets("n.uff");
    let coherences = all.iter().filter(|dataset| dataset.function == FunctionType::Coherence);
    let (clean, noisy) = (frfs_of(&bench, "clean.uff"), frfs_of(&bench, "n.uff"));
    assert_eq!((noisy.len(), coherences.clone().count()), (4, 4));
    for ((clean, noisy), coherence) in clean.iter().zip(&noisy).zip(coherences) {
        assert_eq!(noisy.id_lines[1], "noise 0.8 %, 16 averages, seed 7");
        assert_eq!(noisy.id_lines[4], "averages 16");
        let Data::Real(coherence) = &coherence.data else { panic!("a coherence is real") };
        // Squared errors, and what (1 − γ²)/((n − 1)γ²)·|H|² says they are.
        let (mut error, mut said) = (0.0, 0.0);
        for (line, gamma2) in coherence.iter().enumerate() {
            let ((a, b), (c, d)) = (value(clean, line), value(noisy, line));
            error += (a - c).powi(2) + (b - d).powi(2);
            said += (1.0 - gamma2) / (15.0 * gamma2) * (c * c + d * d);
        }
        let ratio = error / said;
        assert!(
            (0.7..1.4).contains(&ratio),
            "{}: errors are {ratio} of what the coherence says",
            noisy.id_lines[0]
        );
    }
}

#[test]
fn the_same_seed_makes_the_same_bytes_and_another_one_other_noise() {
    let bench = bench("seed", &fixture());
    let made = |seed: &[&str]| {
        bench.done(&[["synthesize", "two.json", "--noise", "1", "-o", "n.uff"].as_slice(), seed].concat());
        fs::read(bench.0.join("n.uff")).unwrap()
    };
    let first = made(&[]);
    assert!(first == made(&["--seed", "1"]) && first != made(&["--seed", "2"]));
}

#[test]
fn a_shipped_fixture_is_consistent_with_its_own_noisy_frfs() {
    let bench = Bench::new("synthesize-rehearsal");
    let two = include_str!("../../../../fixtures/two-blocks/fixture.json");
    bench.write("two.json", two);
    bench.done(&["synthesize", "two.json", "--lines", "5:1000:5", "--noise", "0.5", "-o", "n.uff"]);
    bench.done(&["diagnose", "two.json", "n.uff", "-o", "out"]);
    let answer = bench.json("out/diagnosis.json");
    assert_eq!(answer["verdict"], "consistent", "{answer}");
    let chi2 = answer["mismatch"]["chi2_per_dof"].as_f64().unwrap();
    assert!((0.8..1.2).contains(&chi2), "{chi2}");
}

#[test]
fn a_noise_that_no_test_has_is_refused() {
    let bench = bench("no-noise", &fixture());
    let check = |options: &[&str], parts: &[&str]| {
        bench.refused(&[["synthesize", "two.json", "-o", "n.uff"].as_slice(), options].concat(), parts);
    };
    check(&["--noise", "0"], &["--noise", "above zero"]);
    check(&["--noise", "NaN"], &["--noise", "such as 0.5"]);
    check(&["--noise", "1", "--averages", "1"], &["--averages", "2"]);
    check(&["--seed", "3"], &["--noise"]);
}

#[test]
fn the_output_may_lie_in_a_directory_that_does_not_exist_yet() {
    let bench = bench("directory", &fixture());
    bench.done(&["synthesize", "two.json", "-o", "new/deep/f.uff"]);
    assert_eq!(bench.datasets("new/deep/f.uff").len(), 4);
}

#[test]
fn a_missing_fixture_is_named() {
    let bench = bench("missing", &fixture());
    bench.refused(&["synthesize", "three.json", "-o", "f.uff"], &["three.json", "no such file"]);
    bench.refused(&["synthesize", ".", "-o", "f.uff"], &["directory"]);
}

#[test]
fn a_bad_fixture_names_file_place_and_remedy() {
    let check = |name: &str, from: &str, to: &str, parts: &[&str]| {
        let bench = bench(name, &fixture().replacen(from, to, 1));
        bench.refused(&["synthesize", "two.json", "-o", "f.uff"], parts);
    };
    check("typo", "\"inertia\"", "\"innertia\"", &["two.json: bodies/A", "did you mean `inertia`?"]);
    check("negative", "1.10", "-1.10", &["two.json: bodies/A/mass", "above zero"]);
    check("comma", "\"bodies\": {", "\"bodies\": {,", &["two.json: line 3, column"]);
}

#[test]
fn an_unknown_point_is_named_with_the_points_there_are() {
    let bench = bench("point", &fixture());
    bench.refused(
        &["synthesize", "two.json", "--frf", "9/1", "-o", "f.uff"],
        &["two.json: FRF 9/1", "`9`", "1, 2, 3, 4"],
    );
}

#[test]
fn a_fixture_without_the_default_points_is_told_to_choose_frfs() {
    let fixture = fixture().replace("\"4\":", "\"40\":").replace("response 4", "response 40");
    let bench = bench("default-points", &fixture);
    bench.refused(&["synthesize", "two.json", "-o", "f.uff"], &["two.json", "1, 2, 3, 40", "`--frf 40/1`"]);
    bench.done(&["synthesize", "two.json", "--frf", "40/1", "-o", "f.uff"]);
}

#[test]
fn a_point_that_is_no_node_number_cannot_be_written() {
    let fixture = fixture().replace("\"4\":", "\"tip\":").replace("response 4", "response tip");
    let bench = bench("tip", &fixture);
    bench.refused(&["synthesize", "two.json", "--frf", "tip/1", "-o", "f.uff"], &["`tip`", "whole numbers"]);
}

#[test]
fn bad_arguments_are_refused_in_one_sentence() {
    let bench = bench("usage", &fixture());
    let check = |arguments: &[&str], parts: &[&str]| bench.refused(arguments, parts);
    check(&[], &["no command", "--help"]);
    check(&["synthesise"], &["synthesise", "synthesize"]);
    check(&["synthesize", "two.json"], &["--output"]);
    check(&["synthesize", "two.json", "-o", "f.uff", "--line", "1:2:1"], &["--line", "--lines"]);
    check(&["synthesize", "two.json", "-o", "f.uff", "--lines", "1:2"], &["--lines", "2.5:1000:2.5"]);
    check(&["synthesize", "two.json", "-o", "f.uff", "--lines", "5:2:1"], &["lies below"]);
    check(&["synthesize", "two.json", "-o", "f.uff", "--frf", "41"], &["--frf", "4:theta/1"]);
    check(&["synthesize", "two.json", "-o", "f.uff", "--frf", "4/1", "4/1"], &["4/1", "twice"]);
}

#[test]
fn neither_inputs_nor_directories_are_overwritten() {
    let bench = bench("overwrite", &fixture());
    bench.refused(&["synthesize", "two.json", "-o", "two.json"], &["two.json", "overwritten"]);
    bench.refused(&["synthesize", "two.json", "-o", "."], &["directory"]);
    bench.refused(&["synthesize", "two.json", "-o", "two.json/f.uff"], &["two.json/f.uff"]);
    assert_eq!(fs::read_to_string(bench.0.join("two.json")).unwrap(), fixture());
}

#[test]
fn a_refusal_leaves_an_earlier_result_as_it_was() {
    let bench = bench("earlier", &fixture());
    bench.done(&["synthesize", "two.json", "-o", "f.uff"]);
    let before = fs::read(bench.0.join("f.uff")).unwrap();
    bench.refused(&["synthesize", "two.json", "--frf", "9/1", "-o", "f.uff"], &["9/1"]);
    assert_eq!(fs::read(bench.0.join("f.uff")).unwrap(), before);
}

#[test]
fn help_and_version_are_no_errors() {
    let bench = bench("help", &fixture());
    assert!(bench.done(&["--help"]).contains("synthesize"));
    assert!(bench.done(&["synthesize", "--help"]).contains("FROM:TO:STEP"));
    assert!(bench.done(&["--version"]).starts_with("jointscope "));
}

#[test]
fn a_reader_that_has_gone_away_is_no_panic() {
    let bench = bench("pipe", &fixture());
    let mut child = Command::new(env!("CARGO_BIN_EXE_jointscope"))
        .args(["synthesize", "two.json", "-o", "f.uff"])
        .current_dir(&bench.0)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), output.stderr.as_slice()), (Some(0), b"".as_slice()));
    assert_eq!(bench.names(), ["f.uff", "two.json"]);
}
