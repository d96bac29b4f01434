//! The built program: joints side by side.

use crate::common::Bench;
use std::path::PathBuf;
use std::sync::LazyLock;

/// The inferred D0 as lumped model and as finite elements, and with a strip a fifth softer.
fn bench(name: &str) -> Bench {
    static FILES: LazyLock<Vec<(PathBuf, Vec<u8>)>> = LazyLock::new(|| decomposed().into_files());
    Bench::with(&format!("compare-{name}"), &FILES)
}

fn decomposed() -> Bench {
    let bench = Bench::new("compare");
    let d0 = include_str!("../../../../fixtures/paper/D0.json");
    bench.write("d0.json", d0);
    let soft = d0.replacen("2.864708e-10", "2.3e-10", 1);
    assert!(soft != d0);
    bench.write("soft.json", soft);
    bench.done(&["synthesize", "d0.json", "-o", "sim.uff"]);
    bench.done(&["synthesize", "soft.json", "-o", "soft.uff"]);
    bench.done(&[
        "fem", "d0.json", "--corner", "2", "--along", "6", "--across", "1", "--growth", "3", "-o", "fem.uff",
    ]);
    for case in ["sim", "soft", "fem"] {
        let file = format!("{case}.uff");
        bench.done(&["decompose", "d0.json", &file, "--band", "474:843", "-o", case]);
    }
    bench
}

#[test]
fn joints_are_ranked_with_the_probability_of_the_order() {
    let bench = bench("ranked");
    let summary = bench.done(&["compare", "sim", "fem", "soft", "-o", "out"]);
    assert!(summary.contains("K11: soft < fem < sim"), "{summary}");
    let file = bench.json("out/comparison.json");
    assert_eq!(file["rankings"][0]["order"], serde_json::json!(["soft", "fem", "sim"]));
    let probability = file["rankings"][0]["probability"].as_f64().unwrap();
    assert!(probability > 0.5 && probability <= 1.0);
    assert_eq!(file["joints"][0]["name"], "sim");
    let page = bench.text("out/report.html");
    assert!(page.contains("3 joints side by side") && page.contains("Rank order"));
    // The strip of the second is 2.3/2.864708 of the first's, which the fixture they share knows to a
    // thousandth at best.
    let ratio = &file["pairs"][1]["numbers"][0];
    assert_eq!((&file["pairs"][1]["second"], &ratio["element"]), (&"soft".into(), &"K11".into()));
    let value = ratio["ratio"]["value"].as_f64().unwrap();
    assert!((value - 2.3 / 2.864708).abs() < 1e-5, "{value}");
    assert_eq!(file["made"]["inputs"].as_array().unwrap().len(), 3);
    let first = bench.text("out/comparison.json");
    bench.done(&["compare", "sim", "fem", "soft", "-o", "out"]);
    assert_eq!(bench.text("out/comparison.json"), first);
}

#[test]
fn an_order_that_is_not_twice_as_likely_right_as_wrong_is_not_stated_but_its_decided_pairs_are() {
    let bench = Bench::new("compare-undecided");
    let d0 = include_str!("../../../../fixtures/paper/D0.json");
    bench.write("d0.json", d0);
    bench.write("soft.json", d0.replacen("2.864708e-10", "2.3e-10", 1));
    // One joint tested three times, and a softer one.
    for (name, fixture, seed) in
        [("a", "d0.json", "1"), ("b", "d0.json", "2"), ("c", "d0.json", "3"), ("soft", "soft.json", "4")]
    {
        bench.done(&["synthesize", fixture, "--noise", "0.5", "--seed", seed, "-o", "test.uff"]);
        bench.done(&["decompose", "d0.json", "test.uff", "--band", "474:843", "-o", name]);
    }
    let summary = bench.done(&["compare", "a", "b", "c", "soft", "-o", "out"]);
    let file = bench.json("out/comparison.json");
    let open: Vec<_> =
        file["rankings"].as_array().unwrap().iter().filter(|entry| entry["stated"] == false).collect();
    assert!(!open.is_empty(), "{summary}");
    for entry in open {
        assert!(entry["probability"].as_f64().unwrap() < 2.0 / 3.0, "{entry}");
        let element = entry["element"].as_str().unwrap();
        let line = summary.lines().find(|line| {
            line.starts_with(&format!("{element}: ")) && !line.contains(" is ") // not the line of a ratio
        });
        assert!(
            line.is_some_and(|line| line.contains("cannot be told") && !line.contains("probability")),
            "{summary}"
        );
        for pair in entry["decided"].as_array().unwrap() {
            let smaller = format!("{} < ", pair[0].as_str().unwrap());
            assert!(line.unwrap().contains(&smaller), "{summary}");
        }
    }
    let k11 = &file["rankings"][0];
    let decided: Vec<_> =
        k11["decided"].as_array().unwrap().iter().filter(|pair| pair[0] == "soft").collect();
    assert_eq!(decided.len(), 3, "{k11}");
    assert!(bench.text("out/report.html").contains("the order of the others cannot be told"));
}

#[cfg(unix)]
#[test]
fn a_file_of_which_two_joints_are_named_is_read_once() {
    let bench = Bench::new("compare-once");
    storeys(&bench, "answer", "5e6");
    let contents = bench.text("answer/stiffness.json");
    // What is no file can be read once only.
    let pipe = bench.0.join("answer/stiffness.json");
    std::fs::remove_file(&pipe).unwrap();
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let writer = std::thread::spawn(move || std::fs::write(pipe, contents).unwrap());
    bench.done(&["compare", "answer/lower", "answer/upper", "-o", "out"]);
    writer.join().unwrap();
}

#[test]
fn what_a_fit_does_not_explain_gets_a_caution_and_no_approval() {
    let bench = bench("cautions");
    let summary = bench.done(&["compare", "sim", "fem", "-o", "bad"]);
    assert!(summary.starts_with("caution: fem: its fit leaves a chi2 of"), "{summary}");
    let file = bench.json("bad/comparison.json");
    assert_eq!(file["sound"], false);
    let cautions: Vec<&str> =
        file["cautions"].as_array().unwrap().iter().filter_map(|c| c["what"].as_str()).collect();
    assert!(cautions.contains(&"poor_fit") && cautions.contains(&"bodies_disagree"), "{cautions:?}");
    assert!(!bench.text("bad/report.html").contains("verdict ok"));
    bench.done(&["compare", "sim", "soft", "-o", "good"]);
    assert_eq!(bench.json("good/comparison.json")["sound"], true);
    assert!(bench.text("good/report.html").contains("verdict ok"));
}

#[test]
fn joints_compared_by_less_than_all_frfs_get_no_approval() {
    let bench = bench("less");
    let compared = |joint: serde_json::Value| {
        for case in ["sim", "soft"] {
            let path = format!("{case}/stiffness.json");
            let mut file = bench.json(&path);
            file["joint"] = joint.clone();
            bench.write(&path, file.to_string());
        }
        let summary = bench.done(&["compare", "sim", "soft", "-o", "out"]);
        assert!(!bench.text("out/report.html").contains("verdict ok"));
        (summary, bench.json("out/comparison.json"))
    };
    // As files of earlier versions have it.
    let (_, file) = compared("J".into());
    assert_eq!(file["estimate"], "maximum_likelihood");
    let (summary, file) = compared(serde_json::json!({"name": "J", "failed": "no start gives finite FRFs"}));
    assert!(
        summary.contains("sim: there is no fit to all its FRFs (no start gives finite FRFs)"),
        "{summary}"
    );
    assert_eq!((&file["sound"], &file["cautions"][0]["what"]), (&false.into(), &"no_fit".into()));
}

#[test]
fn joints_are_as_well_known_as_alone_where_blocks_are_said_to_be_different() {
    let bench = bench("independent");
    let deviation = |arguments: &[&str]| {
        let summary = bench.done(arguments);
        let file = bench.json("out/comparison.json");
        let deviation = file["pairs"][0]["numbers"][0]["ratio"]["std"].as_f64().unwrap();
        (summary, file, deviation)
    };
    let (summary, shared, paired) = deviation(&["compare", "sim", "soft", "-o", "out"]);
    assert!(summary.contains("taken as the same blocks") && shared["shared"][0]["body"] == "A", "{summary}");
    let (summary, apart, alone) = deviation(&["compare", "sim", "soft", "--independent", "-o", "out"]);
    assert!(summary.contains("as asked for") && apart["apart"][0]["why"] == "asked", "{summary}");
    assert!(alone > 30.0 * paired, "{alone} {paired}");
    // Another mass of a block, or as sure of it as not: that block is another one.
    let d0 = bench.text("d0.json");
    bench.write("other.json", d0.replacen("5.113312", "{\"value\": 5.113312, \"std\": 0.0011}", 1));
    assert!(bench.text("other.json") != d0, "{d0}");
    bench.done(&["decompose", "other.json", "soft.uff", "--band", "474:843", "-o", "other"]);
    let summary = bench.done(&["compare", "sim", "other", "-o", "out"]);
    let file = bench.json("out/comparison.json");
    assert_eq!(file["shared"].as_array().unwrap().len(), 1, "{summary}");
    assert_eq!(file["shared"][0]["body"], "A");
    assert!(summary.contains("the fixtures differ in bodies/B/mass"), "{summary}");
}

#[test]
fn specimens_of_a_kind_scatter() {
    let bench = bench("specimens");
    let summary = bench.done(&["compare", "sim", "--specimens", "strips=sim,soft", "-o", "out"]);
    assert!(summary.contains("strips: 2 specimens"), "{summary}");
    let file = bench.json("out/comparison.json");
    assert_eq!(file["joints"].as_array().unwrap().len(), 2);
    let scatter = &file["specimens"][0]["numbers"][0];
    // Two values 19.7 % apart scatter by their difference over √2.
    let relative = scatter["between"].as_f64().unwrap() / scatter["mean"]["value"].as_f64().unwrap();
    let expected = (1.0 - 2.3 / 2.864708) / (1.0 + 2.3 / 2.864708) * 2.0_f64.sqrt();
    assert!((relative - expected).abs() < 1e-3, "{relative} {expected}");
    assert!(bench.text("out/report.html").contains("Specimens: strips"));
    bench.refused(&["compare", "--specimens", "strips=sim", "-o", "out"], &["two directories"]);
    bench.refused(&["compare", "soft", "--specimens", "strips=sim,sim", "-o", "out"], &["one specimen"]);
}

#[test]
fn models_and_measurements_are_drawn_with_dashes_of_their_own_and_set_against_each_other() {
    let bench = bench("kinds");
    // The softer strip stands for the test.
    let arguments =
        ["compare", "--as", "sim=sim", "--as", "exp=soft", "--as", "fem=fem", "-o", "out", "--also", "svg"];
    let summary = bench.done(&arguments);
    let file = bench.json("out/comparison.json");
    let kinds: Vec<_> =
        file["joints"].as_array().unwrap().iter().map(|j| (j["name"].clone(), j["kind"].clone())).collect();
    let expected = [("sim", "simulation"), ("soft", "measurement"), ("fem", "finite_elements")];
    assert_eq!(kinds, expected.map(|(name, kind)| (name.into(), kind.into())));
    let models = &file["models"];
    let says = models["says"].as_str().unwrap();
    assert!(
        summary.contains(says) && says.contains("sim is stiffer than soft by K11, K12, K22"),
        "{summary}"
    );
    let k11 = &models["ratios"][0]["numbers"][0];
    assert_eq!((&k11["element"], &k11["model_is"]), (&"K11".into(), &"larger".into()));
    let value = k11["ratio"]["value"].as_f64().unwrap();
    assert!((value - 2.864708 / 2.3).abs() < 1e-4, "{value}");
    assert_eq!(models["ratios"][1]["kind"], "finite_elements");
    let numbers = models["ratios"].as_array().unwrap().iter().flat_map(|r| r["numbers"].as_array().unwrap());
    let of = |is: &str| numbers.clone().filter(|number| number["model_is"] == is).count() as u64;
    assert_eq!(models["as_measured"], of("as_measured"));
    assert_eq!(
        models["known"],
        ["as_measured", "larger", "smaller", "different"].map(of).iter().sum::<u64>()
    );
    // The table has a column a model and a row a number, and the pairs' lines do not say it again.
    assert!(
        summary
            .lines()
            .any(|line| line.trim_start().starts_with("sim / soft") && line.ends_with("fem / soft")),
        "{summary}"
    );
    assert!(summary.lines().any(|line| line.starts_with("  K11  124.5")), "{summary}");
    assert!(!summary.contains("K11: soft is") && summary.contains("K11: fem is"), "{summary}");
    let page = bench.text("out/report.html");
    for words in
        ["Models over measurement", "sim (simulation)", "soft (measurement)", "fem (finite elements)"]
    {
        assert!(page.contains(words), "{words}");
    }
    let figure = bench.text("out/figures/assemblies-h4111.svg");
    for dashes in ["stroke-dasharray=\"7 4\"", "stroke-dasharray=\"2 3\""] {
        assert!(figure.contains(dashes), "{dashes}");
    }
    // Nobody has said anything of these.
    bench.done(&["compare", "sim", "soft", "-o", "plain"]);
    let file = bench.json("plain/comparison.json");
    assert!(file.get("models").is_none() && file["joints"][0].get("kind").is_none());
}

#[test]
fn a_directory_is_said_once_what_it_is_of() {
    let bench = bench("said");
    let words = ["`sim` and `", "are the same directory"];
    bench.refused(&["compare", "sim", "soft", "--as", "sim=./sim", "-o", "out"], &words);
    bench.refused(&["compare", "--as", "sim=sim", "--as", "exp=sim/", "-o", "out"], &words);
    bench.refused(&["compare", "--as", "sim=sim", "-o", "out"], &["two decompositions"]);
    let summary = bench.done(&["compare", "soft", "--as", "sim=sim", "-o", "out"]);
    assert!(summary.contains("no joint is said to be of a measurement"), "{summary}");
    storeys(&bench, "frame", "5e6");
    bench.refused(
        &["compare", "--as", "sim=frame", "--as", "exp=frame/upper", "-o", "none"],
        &["`--as` names `frame/upper` twice"],
    );
    // Measured specimens of one kind.
    let specimens = ["--specimens", "tests=soft,fem"];
    let arguments = ["compare", "--as", "sim=sim", "--as", "exp=soft", "--as", "exp=fem", "-o", "kind"];
    let summary = bench.done(&[&arguments[..], &specimens].concat());
    assert!(summary.contains("tests: 2 specimens") && summary.contains("sim / fem"), "{summary}");
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let bench = bench("refused");
    bench.refused(&["compare", "sim", "-o", "out"], &["two decompositions"]);
    bench.refused(&["compare", "sim", "nowhere", "-o", "out"], &["nowhere/stiffness.json", "no such file"]);
    for again in ["sim", "sim/", "./sim", "soft/../sim"] {
        let words = ["`sim` and `", "are the same directory"];
        bench.refused(&["compare", "sim", again, "-o", "out"], &words);
    }
    bench.refused(&["compare", "soft", "--specimens", "strips=sim,./sim/", "-o", "out"], &["one specimen"]);
    bench.done(&["decompose", "d0.json", "sim.uff", "--relation", "paper", "-o", "paper"]);
    bench.refused(&["compare", "sim", "paper", "-o", "out"], &["`exact`", "`paper`", "--relation"]);
    std::fs::create_dir(bench.0.join("bad")).unwrap();
    bench.write("bad/stiffness.json", "{\"lines\": 3}");
    bench.refused(&["compare", "sim", "bad", "-o", "out"], &["bad/stiffness.json", "`lines`"]);
    assert!(!bench.0.join("out").exists());
}

/// Three storeys on two joints, of which `upper` is as stiff as said, decomposed at once into `answer`.
fn storeys(bench: &Bench, answer: &str, upper: &str) {
    bench.write("truth.json", STOREYS.replace("5e6", upper));
    bench.write("storeys.json", STOREYS);
    let frfs = ["--frf", "1/1", "--frf", "2/1", "--frf", "3/1", "--frf", "3/3"];
    bench.done(&[&["synthesize", "truth.json", "--lines", "20:400:5", "-o", "frf.uff"], &frfs[..]].concat());
    bench.done(&["decompose", "storeys.json", "frf.uff", "-o", answer]);
}

const STOREYS: &str = r#"{
  "bodies": {
    "F1": { "mass": { "value": 7.0, "std": 0.007 }, "rotates": false }, "F2": { "mass": { "value": 6.0, "std": 0.006 }, "rotates": false },
    "F3": { "mass": { "value": 5.0, "std": 0.005 }, "rotates": false }
  },
  "points": { "1": { "body": "F1", "x": 0 }, "2": { "body": "F2", "x": 0.2 }, "3": { "body": "F3", "x": 0.4 } },
  "joints": {
    "lower": { "from": "1", "to": "2", "stiffness": [[3e6, 0], [0, 0]], "damping": [[300, 0], [0, 0]] },
    "upper": { "from": "2", "to": "3", "stiffness": [[5e6, 0], [0, 0]], "damping": [[300, 0], [0, 0]] }
  }
}"#;

#[test]
fn joints_found_at_once_are_compared_all_or_by_name() {
    let bench = Bench::new("compare-at-once");
    storeys(&bench, "before", "5e6");
    storeys(&bench, "after", "4e6");
    let summary = bench.done(&["compare", "before", "after", "-o", "all"]);
    let file = bench.json("all/comparison.json");
    let names: Vec<&str> =
        file["joints"].as_array().unwrap().iter().map(|j| j["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["before/lower", "before/upper", "after/lower", "after/upper"]);
    assert_eq!(file["at_once"][0], serde_json::json!(["before/lower", "before/upper"]));
    assert_eq!(file["shared"][0]["joints"].as_array().unwrap().len(), 4, "{summary}");
    assert!(!file["cautions"].as_array().unwrap().iter().any(|c| c["what"] == "same_recording"), "{summary}");
    let summary = bench.done(&["compare", "before/upper", "after/upper", "-o", "one"]);
    assert!(summary.contains("K11: after/upper is 80.0"), "{summary}");
    let ratio = &bench.json("one/comparison.json")["pairs"][0]["numbers"][0]["ratio"];
    assert!((ratio["value"].as_f64().unwrap() - 0.8).abs() < 1e-4, "{ratio}");
    assert!(bench.text("one/report.html").contains("2 joints side by side"));
    // Specimens of one kind by the names of joints, or as a whole directory's.
    let summary = bench.done(&["compare", "--specimens", "columns=before/upper,after/upper", "-o", "kind"]);
    assert!(summary.contains("columns: 2 specimens"), "{summary}");
    let summary = bench.done(&["compare", "--specimens", "columns=before", "-o", "kind"]);
    assert!(summary.contains("columns: 2 specimens"), "{summary}");
    bench.refused(&["compare", "before/middle", "after", "-o", "none"], &["middle", "lower, upper"]);
    bench.refused(&["compare", "before/upper", "before/upper", "-o", "none"], &["same directory"]);
}

#[test]
fn joints_found_at_once_are_exported_all_or_by_name() {
    let bench = Bench::new("export-at-once");
    storeys(&bench, "answer", "5e6");
    for program in ["nastran", "ansys", "abaqus", "calculix", "csv"] {
        let summary = bench.done(&["export", "answer", "--to", program, "-o", program]);
        assert!(summary.contains("2 joints, 0 other parts"), "{summary}");
    }
    bench.done(&["export", "answer", "--to", "json", "-o", "all.json"]);
    let (all, found) = (bench.json("all.json"), bench.json("answer/stiffness.json"));
    for joint in 0..2 {
        assert_eq!(all["joints"][joint]["stiffness"], found["joints"][joint]["stiffness"]);
    }
    // Both joints meet at point 2 of the storey between them: one node.
    assert_eq!(all["joints"][0]["to"]["node"], all["joints"][1]["from"]["node"]);
    assert_eq!(all["nodes"].as_array().unwrap().len(), 3);
    bench.done(&[
        "export", "answer", "--to", "json", "--joint", "upper", "--nodes", "12,13", "-o", "one.json",
    ]);
    let one = bench.json("one.json");
    assert_eq!((&one["joints"][0]["name"], &one["joints"][0]["to"]["node"]), (&"upper".into(), &13.into()));
    bench.refused(
        &["export", "answer", "--to", "json", "--nodes", "12,13", "-o", "x.json"],
        &["lower, upper", "--joint"],
    );
    bench.refused(
        &["export", "answer", "--to", "json", "--joint", "middle", "-o", "x.json"],
        &["lower, upper"],
    );
    bench.refused(&["export", "answer", "--to", "json", "--by-line", "-o", "x.json"], &["decompose --joint"]);
}
