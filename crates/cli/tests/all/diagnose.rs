//! `jointscope diagnose` as a user runs it: files in, `diagnosis.json`, two fixtures and a page out.

use crate::common::{self, Bench};
use jointscope::uff::{Axis, Data, Dataset58, FunctionType, data_type};
use jointscope_samples::{Noise, TWO_STOREYS, with};
use num_complex::Complex64;
use serde_json::Value;

/// Recordings of the storeys: FRFs 1/1, 2/1, with noise that is the same each time, and effects in `physics`
/// where given.
fn storeys(name: &str, physics: &str) -> Bench {
    let bench = Bench::new(name);
    bench.write("believed.json", TWO_STOREYS);
    bench.write("truth.json", with(TWO_STOREYS, &format!(r#""physics": [{physics}]"#)));
    bench.done(&[
        "synthesize",
        "truth.json",
        "--frf",
        "1/1",
        "2/1",
        "--lines",
        "20:400:4",
        "-o",
        "clean.uff",
    ]);
    bench.rewrite("clean.uff", "frf.uff", noise);
    bench
}

/// Noise of half a per cent, and the coherence of ten averages that belongs to it.
fn noise(datasets: &mut Vec<Dataset58>) {
    const SHARE: f64 = 0.005;
    const AVERAGES: f64 = 10.0;
    let mut noise = Noise::from_state(7);
    let mut uniform = move || noise.uniform() - 0.5;
    let mut coherences = Vec::new();
    for dataset in datasets.iter_mut() {
        let Data::Complex(values) = &mut dataset.data else { panic!("an FRF is complex") };
        for value in values.iter_mut() {
            // Uniform numbers on (−½, ½) have variance 1/12, and each part half of the whole.
            let size = SHARE * value.norm() * 6.0_f64.sqrt();
            *value += Complex64::new(uniform(), uniform()) * size;
        }
        let coherence = 1.0 / (1.0 + (AVERAGES - 1.0) * SHARE * SHARE);
        let data = Data::Real(vec![coherence; values.len()]);
        dataset.id_lines[4] = format!("averages {AVERAGES}");
        coherences.push(Dataset58 {
            function: FunctionType::Coherence,
            data,
            ordinate_axis: Axis::new(data_type::GENERAL, "Coherence", "NONE"),
            denominator_axis: Axis::default(),
            ..dataset.clone()
        });
    }
    datasets.extend(coherences);
}

const DIAGNOSE: [&str; 5] = ["diagnose", "believed.json", "frf.uff", "-o", "out"];

/// Every number of the answer is finite: JSON has no other, so what is not finite would be `null`.
fn nulls(value: &Value, path: &str, found: &mut Vec<String>) {
    match value {
        Value::Null => found.push(path.to_owned()),
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(i, v)| nulls(v, &format!("{path}/{i}"), found))
        }
        Value::Object(map) => map.iter().for_each(|(k, v)| nulls(v, &format!("{path}/{k}"), found)),
        _ => {}
    }
}

#[test]
fn a_forgotten_mass_is_named_in_files_that_the_program_reads_again() {
    let bench =
        storeys("diagnose-mass", r#"{ "kind": "added_mass", "place": "high", "x": 0.18, "mass": 0.6 }"#);
    let told = bench.done(&DIAGNOSE);
    assert!(told.contains("explained: The fixture leaves out") && told.contains("body high"), "{told}");
    assert!(told.trim_end().ends_with("out/report.html"), "{told}");
    assert!(!told.contains("estimated from the scatter"), "{told}");

    let answer = bench.json("out/diagnosis.json");
    assert_eq!(answer["verdict"], "explained");
    let finding = &answer["findings"][0];
    assert_eq!(
        (finding["kind"].as_str(), finding["place"].as_str()),
        (Some("added_mass"), Some("high")),
        "{finding}"
    );
    let mass = &finding["parameters"]["mass"];
    let [low, high] = [0, 1].map(|end| mass["ci95"][end].as_f64().unwrap());
    assert!(low < 0.6 && 0.6 < high && high - low < 0.3 && mass["unit"] == "kg", "{mass}");
    assert!(finding["says"].as_str().unwrap().contains("Body high carries a mass"), "{finding}");
    let alternatives = finding["alternatives"].as_array().unwrap().iter();
    let sum: f64 = finding["probability"].as_f64().unwrap()
        + alternatives.map(|a| a["probability"].as_f64().unwrap()).sum::<f64>();
    assert!((0.0..=1.0).contains(&sum), "{sum}");
    let chi2 = &answer["fit"]["chi2_per_dof"];
    assert!(chi2["repaired"].as_f64() <= chi2["refitted"].as_f64(), "{chi2}");
    assert_eq!(answer["made"]["inputs"][0]["sha256"].as_str().unwrap().len(), 64);

    assert_eq!(bench.json("out/repaired.json")["physics"][0]["kind"], "added_mass");
    assert!(bench.json("out/refitted.json").get("physics").is_none());
    for model in ["out/refitted.json", "out/repaired.json"] {
        bench.done(&["synthesize", model, "--frf", "2/2", "--lines", "20:400:4", "-o", "unmeasured.uff"]);
    }
    let page = bench.text("out/report.html");
    for part in [
        "Diagnosis: what the fixture leaves out",
        "1. added mass",
        "Before and after",
        "Tolerances",
        "sha256",
    ] {
        assert!(page.contains(part), "`{part}` is missing from the page");
    }
    assert!(!page.contains("NaN") && !page.contains("src=\"http") && !page.contains("href=\"http"));
}

#[test]
fn nothing_left_out_is_said_plainly_and_the_same_input_gives_the_same_bytes() {
    let bench = storeys("diagnose-null", "");
    let told = bench.done(&DIAGNOSE);
    assert!(told.starts_with("consistent: Nothing is left out"), "{told}");
    let files = ["diagnosis.json", "refitted.json", "repaired.json", "report.html"];
    let first = files.map(|name| bench.text(&format!("out/{name}")));
    assert!(first[3].contains("Nothing is left out"));
    bench.done(&DIAGNOSE);
    assert!(
        first == files.map(|name| bench.text(&format!("out/{name}"))),
        "the files differ between two runs"
    );
    let mut found = Vec::new();
    nulls(&bench.json("out/diagnosis.json"), "", &mut found);
    assert!(found.iter().all(|path| path == "/fit/held_out"), "not finite: {found:?}");
    assert_eq!(bench.json("out/diagnosis.json")["findings"], serde_json::json!([]));
}

#[test]
fn the_answer_goes_to_standard_output_for_scripts_and_no_file_is_written() {
    let bench =
        storeys("diagnose-json", r#"{ "kind": "channel_gain", "place": "response 2", "factor": 0.85 }"#);
    let before = bench.names();
    let told = bench.done(&[
        "diagnose",
        "believed.json",
        "frf.uff",
        "--json",
        "--hold-out",
        "1/1",
        "--band",
        "30:380",
        "--exclude",
        "45:55",
        "98:102",
    ]);
    let answer: Value = serde_json::from_str(&told).unwrap();
    assert_eq!(
        (answer["verdict"].as_str(), answer["findings"][0]["kind"].as_str()),
        (Some("explained"), Some("channel_gain"))
    );
    assert!(answer["findings"][0]["says"].as_str().unwrap().contains("response 2 reads low"), "{answer:#}");
    let held_out = answer["fit"]["held_out"]["what"].as_array().unwrap();
    assert!(held_out.contains(&"frf 1/1".into()), "{held_out:?}");
    assert!(answer["recording"]["from"].as_f64() >= Some(30.0));
    assert_eq!(bench.names(), before);
}

#[test]
fn a_search_that_is_out_of_time_answers_with_what_it_has_and_says_what_it_did_not_come_to() {
    let bench = storeys("diagnose-time", r#"{ "kind": "added_mass", "place": "low", "x": 0, "mass": 0.2 }"#);
    let told = bench.done(&["diagnose", "believed.json", "frf.uff", "--time-limit", "0.000001", "-o", "out"]);
    assert!(told.contains("The search ended at its limit"), "{told}");
    let answer = bench.json("out/diagnosis.json");
    assert!(!answer["stopped"].as_array().unwrap().is_empty());
    assert!(answer["fit"]["nrmse"]["refitted"].as_f64().unwrap() > 0.0);
    let told = bench.done(&["diagnose", "believed.json", "frf.uff", "--time-limit", "600", "-o", "out"]);
    assert!(!told.contains("ended at its limit"), "{told}");
    assert_eq!(bench.json("out/diagnosis.json").get("stopped"), None);
    for limit in ["0", "-3", "NaN", "soon"] {
        let limit = format!("--time-limit={limit}");
        bench.refused(
            &["diagnose", "believed.json", "frf.uff", &limit, "-o", "out"],
            &["time-limit", "a number of seconds above zero is needed"],
        );
    }
}

#[test]
fn one_frf_alone_is_diagnosed_with_a_word_on_what_it_cannot_say() {
    let bench = storeys("diagnose-one", "");
    bench.rewrite("frf.uff", "one.uff", |datasets| datasets.retain(|d| d.response.number == 1));
    let told = bench.done(&["diagnose", "believed.json", "one.uff", "-o", "out"]);
    assert!(told.contains("one FRF only, 1/1") && told.contains("cannot say where"), "{told}");
    assert!(bench.text("out/report.html").contains("cannot say where"));
}

#[test]
fn without_coherence_the_noise_is_estimated_from_the_scatter_and_that_is_said() {
    let bench = storeys("diagnose-scatter", "");
    bench.rewrite("frf.uff", "bare.uff", |datasets| datasets.truncate(2));
    let told = bench.done(&["diagnose", "believed.json", "bare.uff", "-o", "out"]);
    assert!(told.contains("all FRFs was estimated from the scatter"), "{told}");
    assert_eq!(bench.json("out/diagnosis.json")["recording"]["noise_from"]["2/1"], "scatter over the lines");
    assert!(bench.text("out/report.html").contains("scatter over the lines"));
}

#[test]
fn a_fixture_that_is_grossly_wrong_gets_a_plain_answer() {
    let bench = storeys("diagnose-gross", "");
    bench.write("believed.json", TWO_STOREYS.replace("3.4e6", "10.2e6"));
    let told = bench.done(&DIAGNOSE);
    assert!(!told.starts_with("consistent") && !told.contains("NaN") && !told.contains("inf"), "{told}");
    assert!(bench.text("out/report.html").contains("</html>"));
}

#[test]
fn a_mismatch_without_a_name_is_placed_and_no_physics_is_named_for_certain() {
    let bench = storeys("diagnose-unknown", "");
    // One FRF turns by an angle that grows with the square of frequency: no effect does.
    bench.rewrite("frf.uff", "odd.uff", |datasets| {
        let Data::Complex(values) = &mut datasets[0].data else { panic!("an FRF is complex") };
        let count = values.len() as f64;
        for (line, value) in values.iter_mut().enumerate() {
            let share = line as f64 / count;
            *value *= Complex64::cis(0.6 * share * share);
        }
    });
    bench.done(&["diagnose", "believed.json", "odd.uff", "-o", "out"]);
    let answer = bench.json("out/diagnosis.json");
    assert_ne!(answer["verdict"], "consistent");
    assert_ne!(answer["verdict"], "explained", "{}", answer["says"]);
    assert!(answer["says"].as_str().unwrap().contains("Hz"), "{}", answer["says"]);
}

#[test]
fn the_shipped_example_is_explained_and_its_readme_does_not_give_it_away() {
    let bench = Bench::new("diagnose-shipped");
    let folder = common::shipped().with_file_name("two-blocks");
    for file in ["fixture.json", "hammer-test.uff"] {
        std::fs::copy(folder.join(file), bench.0.join(file)).unwrap();
    }
    let told = bench.answer(&["diagnose", "fixture.json", "hammer-test.uff", "--json"]);
    let answer: Value = serde_json::from_str(&told).unwrap();
    assert_eq!(answer["verdict"], "explained", "{}", answer["says"]);
    assert_eq!(answer["findings"].as_array().unwrap().len(), 1);
    assert!(answer["findings"][0]["probability"].as_f64() > Some(0.9), "{}", answer["findings"][0]);
    let readme = std::fs::read_to_string(folder.join("README.md")).unwrap().to_lowercase();
    let kind = answer["findings"][0]["kind"].as_str().unwrap();
    for word in kind.split('_').chain(["compliance", "rotation", "glue", "weld"]) {
        assert!(!readme.contains(word), "`{word}` gives the example away");
    }
}

#[test]
fn on_a_pipe_each_stage_is_a_line_and_standard_output_holds_the_answer_alone() {
    let bench = storeys("stages", r#"{ "kind": "added_mass", "place": "high", "x": 0.18, "mass": 0.6 }"#);
    let arguments = ["diagnose", "believed.json", "frf.uff", "--json"];
    let output = bench.run(&arguments);
    assert_eq!(output.status.code(), Some(0));
    let told = String::from_utf8(output.stderr).unwrap();
    for stage in [
        "refitting the fixture within its tolerances (2 FRFs on 96 lines) …",
        "searching the whole recording …",
    ] {
        assert!(told.lines().any(|line| line == stage), "`{stage}` is missing from:\n{told}");
    }
    assert!(!told.contains('\r') && !told.contains('\u{1b}'), "{told:?}");
    let answer = String::from_utf8(output.stdout).unwrap();
    let file: Value = serde_json::from_str(&answer).unwrap();
    assert_eq!(file["findings"][0]["kind"], "added_mass", "{answer}");
    assert_eq!(answer, bench.answer(&arguments), "the answer depends on when something was told");
}

#[test]
fn a_baseline_with_other_frfs_is_refused_before_anything_is_told() {
    let bench = storeys("other-baseline", "");
    bench.rewrite("frf.uff", "one.uff", |datasets| datasets.retain(|dataset| dataset.response.number == 1));
    let refused = ["diagnose", "believed.json", "frf.uff", "--baseline", "one.uff", "-o", "out"];
    bench.refused(&refused, &["baseline and recording have no FRFs or no modes in common"]);
}
