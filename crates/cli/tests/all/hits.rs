//! `simulate` and `diagnose` of time histories: what depends on amplitude, from files to files.

use crate::common::{self, Bench};
use jointscope::hits::Hit;
use jointscope::recordings::hits_to_datasets;
use jointscope::spectra::Channel;
use jointscope::uff::{Abscissa, Data, Encoding};
use jointscope_samples::{Noise, two_blocks_damped, with};

pub(crate) const CUBIC: &str =
    r#"{ "kind": "cubic_stiffness", "place": "J", "dof": "translation", "stiffness3": 4e13 }"#;

/// Two blocks with modal damping, which has a form over time, and an effect.
pub(crate) fn fixture(physics: &str) -> String {
    with(&two_blocks_damped(&[0.02]), &format!(r#""physics": [{physics}]"#))
}

/// Blows of these peaks, N, in `force.uff`, at the points in turn.
fn forces(bench: &Bench, points: &[&str], peaks: &[f64]) {
    let blow = |(i, peak): (usize, &f64)| {
        let pulse = |k: i32| peak * (-0.5 * ((f64::from(k) - 60.0) / 1.6).powi(2)).exp();
        let force = (0..2048).map(pulse).collect();
        let struck = Channel::transverse(points[i % points.len()]);
        Hit::new(i as u32 + 1, 1.0 / 6400.0, 0.0, struck, force, Vec::new()).unwrap()
    };
    let hits: Vec<Hit> = peaks.iter().enumerate().map(blow).collect();
    let datasets = hits_to_datasets(&hits, "blows", Encoding::default(), true).unwrap();
    bench.write("force.uff", jointscope::uff::write(&datasets).unwrap());
}

/// A bench with `plain.json`, and `hits.uff` that `simulate` makes of it with `physics`, with noise of 0.1 %
/// of each signal's peak.
pub(crate) fn recorded(name: &str, physics: &str, peaks: &[f64]) -> Bench {
    let bench = Bench::new(name);
    bench.write("plain.json", fixture(""));
    bench.write("true.json", fixture(physics));
    forces(&bench, &["1"], peaks);
    strike(&bench, peaks.len());
    bench
}

/// `hits.uff` from `true.json` and `force.uff`.
fn strike(bench: &Bench, hits: usize) {
    let simulate = ["simulate", "true.json", "--force", "force.uff", "--at", "3", "4", "--with-force"];
    let said = bench.done(&[&simulate[..], &["-o", "exact.uff"]].concat());
    assert!(said.contains(&format!("under {hits} hits of 2048 samples")), "{said}");
    let mut noise = Noise::from_state(7);
    let mut uniform = move || noise.uniform() - 0.5;
    bench.rewrite("exact.uff", "hits.uff", |datasets| {
        for dataset in datasets {
            let Data::Real(values) = &mut dataset.data else { panic!("a history is real") };
            let peak = values.iter().fold(0.0, |most: f64, v| v.abs().max(most));
            values.iter_mut().for_each(|v| *v += 2e-3 * peak * uniform());
        }
    });
}

#[test]
fn a_cubic_spring_is_simulated_read_back_and_named_with_its_force_state_map() {
    let bench = recorded("hits-cubic", CUBIC, &[40.0, 41.0, 150.0, 153.0, 500.0, 490.0]);
    let said = bench.done(&["diagnose", "plain.json", "hits.uff", "--exact", "-o", "out"]);
    assert!(said.contains("Joint J in translation stiffens as it is moved further"), "{said}");
    let found = bench.json("out/diagnosis.json");
    assert_eq!(found["verdict"], "explained");
    let finding = &found["findings"][0];
    assert_eq!((&finding["kind"], &finding["place"]), (&"cubic_stiffness".into(), &"J".into()));
    let value = finding["parameters"]["stiffness3"]["value"].as_f64().unwrap();
    assert!((value / 4e13 - 1.0).abs() < 0.02, "{value:e}");
    let map = &found["force_state"][0];
    assert_eq!(map["motion_from"], serde_json::json!({"A": "momentum", "B": "sensors"}));
    assert!(map["components"][0]["explained"].as_f64().unwrap() > 0.8, "{map}");
    assert!(bench.text("out/report.html").contains("Force against motion, as measured"));
    assert_eq!(bench.json("out/repaired.json")["physics"][0]["kind"], "cubic_stiffness");
}

#[test]
fn hits_of_a_linear_joint_are_diagnosed_by_their_frfs_with_the_remark() {
    let bench = recorded("hits-linear", "", &[40.0, 41.0, 500.0, 490.0]);
    let said = bench.done(&["diagnose", "plain.json", "hits.uff", "-o", "out"]);
    assert!(said.contains("FRFs do not change between hits of"), "{said}");
    let found = bench.json("out/diagnosis.json");
    assert!(found["homogeneity"].is_null(), "the linear diagnosis answers");
    assert_eq!(found["verdict"], "consistent", "{said}");
    assert!(found["notes"].to_string().contains("nothing depends on amplitude"), "{}", found["notes"]);
}

#[test]
fn hits_all_alike_are_diagnosed_by_their_frfs_and_amplitude_is_said_not_to_be_judged() {
    let bench = recorded("hits-alike", "", &[100.0, 102.0, 98.0]);
    let said = bench.done(&["diagnose", "plain.json", "hits.uff", "-o", "out"]);
    assert!(said.contains("whether anything depends on amplitude could not be judged"), "{said}");
    assert!(said.contains("strike at two or more strengths"), "{said}");
    assert_eq!(bench.json("out/diagnosis.json")["verdict"], "consistent", "{said}");
}

#[test]
fn hits_that_ring_on_at_the_end_of_their_records_are_decomposed_under_a_window() {
    let bench = Bench::new("hits-ringing");
    let light = fixture("").replace("[0.02]", "[0.002, 0.003]");
    bench.write("true.json", &light);
    forces(&bench, &["1", "2"], &[300.0; 12]);
    strike(&bench, 12);
    bench.done(&["synthesize", "true.json", "--lines", "20:1200:1.25", "-o", "frf.uff"]);
    bench.done(&["decompose", "true.json", "frf.uff", "--exact", "-o", "reference"]);
    let reference = bench.json("reference/stiffness.json")["maximum_likelihood"].clone();
    // With noise on the force H1 reads low, as the estimate remarks, and the damping with it.
    for (file, window, of_stiffness, of_damping) in
        [("exact.uff", "60", 1e-6, 1e-4), ("hits.uff", "auto", 1e-4, 1e-2)]
    {
        let options = ["--exact", "--response-window", window, "-o", "joint"];
        let said = bench.done(&[&["decompose", "true.json", file], &options[..]].concat());
        assert!(said.contains("sides and joint are read at s ="), "{said}");
        let joint = &bench.json("joint/stiffness.json")["maximum_likelihood"];
        assert!(file == "exact.uff" || joint["chi2_per_dof"].as_f64().unwrap() < 1.3, "{joint}");
        for (quantity, tolerance) in [("stiffness", of_stiffness), ("damping", of_damping)] {
            let [expected, found] = [&reference, joint].map(|fit| common::matrix(&fit[quantity]));
            for (expected, found) in expected.iter().flatten().zip(found.iter().flatten()) {
                let error = (found / expected - 1.0).abs();
                assert!(error < tolerance, "{file}: {quantity} {found}, expected {expected}");
            }
        }
    }
    // Without the window what the records' ends cut off is put back, but for what the blow's shape makes of it:
    // more than so little noise.
    let without = ["--exact", "--response-window", "none", "-o", "cut"];
    let output = bench.run(&[&["decompose", "true.json", "hits.uff"], &without[..]].concat());
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.contains("Records ended 0.311 s after the blow, when 37 %"), "{told}");
    let cut = &bench.json("cut/stiffness.json")["maximum_likelihood"];
    assert!((3.0..30.0).contains(&cut["chi2_per_dof"].as_f64().unwrap()), "{cut}");
    let [expected, found] = [&reference, cut].map(|fit| common::matrix(&fit["stiffness"]));
    for (expected, found) in expected.iter().flatten().zip(found.iter().flatten()) {
        assert!((found / expected - 1.0).abs() < 1e-3, "stiffness {found}, expected {expected}");
    }
}

#[test]
fn a_baseline_whose_records_end_earlier_is_no_change_of_damping() {
    let bench = Bench::new("hits-baseline");
    bench.write("true.json", fixture("").replace("[0.02]", "[0.004, 0.005]"));
    forces(&bench, &["1", "2"], &[300.0, 310.0, 280.0, 290.0, 300.0, 295.0]);
    strike(&bench, 6);
    bench.rewrite("hits.uff", "short.uff", |datasets| {
        for dataset in datasets {
            let Data::Real(values) = &mut dataset.data else { panic!("a history is real") };
            values.truncate(1024);
            if let Abscissa::Even { count, .. } = &mut dataset.abscissa {
                *count = 1024;
            }
        }
    });
    let said = bench.done(&["diagnose", "true.json", "hits.uff", "--baseline", "short.uff", "-o", "out"]);
    assert!(said.contains("Nothing has changed since the baseline"), "{said}");
    let decay =
        |said: &str| said.split("window of decay ").nth(1).unwrap().split(' ').next().unwrap().to_owned();
    let alone = bench.done(&["diagnose", "true.json", "short.uff", "-o", "short"]);
    assert_eq!(decay(&said), decay(&alone), "the longer of both windows");
}

#[test]
fn swapped_and_inverted_channels_are_told() {
    let bench = Bench::new("hits-swapped");
    bench.write("true.json", fixture(""));
    forces(&bench, &["1", "2"], &[300.0; 8]);
    strike(&bench, 8);
    let is_force = |d: &jointscope::uff::Dataset58| d.ordinate_axis.data_type == 13;
    bench.rewrite("hits.uff", "swapped.uff", |datasets| {
        for d in datasets.iter_mut().filter(|d| !is_force(d)) {
            d.response.number = 7 - d.response.number;
        }
    });
    let said = bench.done(&["diagnose", "true.json", "swapped.uff", "-o", "out"]);
    assert!(said.contains("have each other's place: their channels are swapped"), "{said}");
    bench.rewrite("hits.uff", "inverted.uff", |datasets| {
        for d in datasets.iter_mut().filter(|d| !is_force(d) && d.response.number == 4) {
            let Data::Real(values) = &mut d.data else { panic!("a history is real") };
            values.iter_mut().for_each(|v| *v = -*v);
        }
    });
    let said = bench.done(&["diagnose", "true.json", "inverted.uff", "-o", "out"]);
    assert!(said.contains("The channel of response 4 has the wrong sign"), "{said}");
    bench.rewrite("hits.uff", "force.uff", |datasets| {
        for number in 1..=8 {
            let data = |force: bool| {
                let mut of_hit = datasets.iter().filter(|d| d.sequence_number == number);
                let found = of_hit.find(|d| is_force(d) == force && (force || d.response.number == 3));
                found.unwrap().data.clone()
            };
            let (force, response) = (data(true), data(false));
            for d in datasets.iter_mut().filter(|d| d.sequence_number == number) {
                if is_force(d) {
                    d.data = response.clone();
                } else if d.response.number == 3 {
                    d.data = force.clone();
                }
            }
        }
    });
    bench.refused(
        &["diagnose", "true.json", "force.uff", "-o", "out"],
        &["force.uff", "the channels seem swapped"],
    );
}

#[test]
fn simulate_refuses_bad_input_in_one_sentence() {
    let bench = recorded("hits-bad", "", &[100.0]);
    let refused = |fixture: &str, force: &str, more: &[&str], parts: &[&str]| {
        let arguments = [&["simulate", fixture, "--force", force], more, &["-o", "r.uff"]].concat();
        bench.refused(&arguments, parts);
    };
    bench.rewrite("exact.uff", "silent.uff", |datasets| datasets.retain(|d| d.ordinate_axis.data_type != 13));
    refused("plain.json", "silent.uff", &[], &["silent.uff", "force"]);
    refused("plain.json", "force.uff", &["--at", "9"], &["plain.json", "no point `9`", "1, 2, 3, 4"]);
    bench.write("heavy.json", fixture(r#"{ "kind": "joint_mass", "place": "J", "mass": 0.01 }"#));
    refused("heavy.json", "force.uff", &[], &["heavy.json", "joint_mass"]);
    bench.write("roving.json", fixture(r#"{ "kind": "sensor_mass", "place": "response 4", "mass": 0.01 }"#));
    refused("roving.json", "force.uff", &[], &["roving.json", "sensor_mass", "added_mass"]);
    forces(&bench, &["9"], &[100.0]);
    refused("plain.json", "force.uff", &[], &["force.uff", "9"]);
}
