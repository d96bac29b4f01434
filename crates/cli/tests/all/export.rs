//! The built program: what was found, for finite-element programs.

use crate::common::{Bench, TWO_BLOCKS};

const LINES: &str = "50:1000:10";
const PROGRAMS: [(&str, &str); 6] = [
    ("nastran", "joint.bdf"),
    ("ansys", "joint.mac"),
    ("abaqus", "joint.inp"),
    ("calculix", "joint.inp"),
    ("csv", "joint.csv"),
    ("json", "joint.json"),
];

/// With a decomposition in `answer`.
fn decomposed(name: &str) -> Bench {
    let bench = Bench::synthesized(name, TWO_BLOCKS, LINES);
    bench.done(&["decompose", "two.json", "frf.uff", "-o", "answer"]);
    bench
}

#[test]
fn a_decomposition_is_written_for_every_program_with_its_origin_and_alike_each_time() {
    let bench = decomposed("export-all");
    for (program, file) in PROGRAMS {
        let summary = bench.done(&["export", "answer", "--to", program, "-o", program]);
        assert!(
            summary.contains("joint J between nodes 2 and 3") && summary.trim_end().ends_with(file),
            "{summary}"
        );
        let first = bench.text(&format!("{program}/{file}"));
        assert!(first.contains("answer/stiffness.json"), "{first}");
        assert!(first.contains(&format!("jointscope export answer --to {program} -o {program}")));
        bench.done(&["export", "answer", "--to", program, "-o", program]);
        assert_eq!(bench.text(&format!("{program}/{file}")), first);
    }
    let json = bench.json("json/joint.json");
    assert_eq!(json["made"]["inputs"][0]["sha256"].as_str().unwrap().len(), 64);
    assert_eq!(json["joints"][0]["from"]["body"], "A");
    let found = &bench.json("answer/stiffness.json")["joint"];
    assert_eq!(json["joints"][0]["stiffness"], found["stiffness"], "the joint from all FRFs");
    // A viscous joint fitted to structural damping is off by more than rounding, and says by how much.
    let [k11, std] = [&found["stiffness"], &found["std"]["stiffness"]].map(|m| m[0][0].as_f64().unwrap());
    let expected = 12.0 * 2.07e11 * 3.67e-10 / 0.065_f64.powi(3);
    assert!((k11 - expected).abs() < std, "{k11} ± {std} for {expected}");
}

#[test]
fn nodes_of_the_model_are_named_and_not_defined() {
    let bench = decomposed("export-nodes");
    bench.done(&["export", "answer", "--to", "nastran", "--nodes", "101,202", "-o", "a.bdf"]);
    let deck = bench.text("a.bdf");
    assert!(
        !deck.contains("GRID")
            && deck.contains("node 101: point 2 of body A, of your model, must lie at x = 0 m")
    );
}

#[test]
fn a_repaired_fixture_is_exported_with_what_was_found_in_it() {
    let bench = Bench::new("export-diagnosis");
    let physics = r#""physics": [{"kind": "added_mass", "place": "B", "x": 0.1, "mass": 0.05}, {"kind": "channel_gain", "place": "response 4", "factor": 0.9}],"#;
    std::fs::create_dir(bench.0.join("answer")).unwrap();
    bench.write("answer/repaired.json", TWO_BLOCKS.replacen('{', &format!("{{ {physics}"), 1));
    bench.write(
        "answer/diagnosis.json",
        r#"{"verdict": "explained", "findings": [{"kind": "added_mass", "place": "B", "parameters": {"mass": {"value": 0.05, "std": 0.001}}, "probability": 0.99}]}"#,
    );
    let summary = bench.done(&["export", "answer", "--to", "nastran", "-o", "deck.bdf"]);
    assert!(
        summary.contains("probability 0.99") && summary.contains("not exported: channel gain"),
        "{summary}"
    );
    let deck = bench.text("deck.bdf");
    assert!(deck.contains("CONM2*") && deck.contains("CBUSH*") && deck.contains("GE"), "{deck}");
    bench.refused(
        &["export", "answer", "--to", "nastran", "--by-line", "-o", "x.bdf"],
        &["diagnosis.json", "band"],
    );
    std::fs::remove_file(bench.0.join("answer/repaired.json")).unwrap();
    bench.refused(&["export", "answer", "--to", "csv", "-o", "x.csv"], &["repaired.json", "no such file"]);
}

#[test]
fn bad_input_is_refused_in_one_sentence_and_nothing_is_written() {
    let bench = decomposed("export-bad");
    bench.refused(&["export", "nowhere", "--to", "csv", "-o", "out"], &["nowhere", "no such directory"]);
    bench.refused(
        &["export", ".", "--to", "csv", "-o", "out"],
        &["neither stiffness.json nor diagnosis.json"],
    );
    bench.refused(
        &["export", "two.json", "--to", "csv", "-o", "out"],
        &["two.json", "neither a stiffness.json"],
    );
    bench.refused(&["export", "answer", "--to", "patran", "-o", "out"], &["patran", "nastran"]);
    bench.refused(
        &["export", "answer", "--to", "csv", "--nodes", "5,5", "-o", "out"],
        &["two different node numbers"],
    );
    bench.refused(
        &["export", "answer", "--to", "csv", "--nodes", "0,5", "-o", "out"],
        &["stiffness.json", "0 is no node number"],
    );
    bench.refused(&["export", "answer", "--to", "csv", "--joint", "K", "-o", "out"], &["no joint `K`", "J"]);
    bench.refused(&["export", "answer", "--to", "ansys", "--by-line", "-o", "out"], &["--by-line", "ansys"]);
    bench.refused(
        &["export", "answer", "--to", "ansys", "--form", "dmig", "-o", "out"],
        &["`--form dmig`", "ansys"],
    );
    bench.refused(
        &["export", "answer", "--to", "nastran", "--form", "dmig", "--by-line", "-o", "out"],
        &["`--by-line`", "leave `--form dmig`"],
    );
    bench.refused(
        &["export", "answer", "--to", "json", "-o", "answer/stiffness.json"],
        &["answer/stiffness.json", "would be overwritten"],
    );
    bench.refused(&["export", "answer", "--to", "csv", "-o", "two.json/x.csv"], &["two.json", "is a file"]);
    let whole = bench.text("answer/stiffness.json");
    bench.write("answer/stiffness.json", &whole[..whole.len() / 2]);
    bench.refused(
        &["export", "answer", "--to", "csv", "-o", "out"],
        &["answer/stiffness.json", "ends in the middle, at line", "make the file anew"],
    );
    bench.write("answer/stiffness.json", whole);
    let mut old = bench.json("answer/stiffness.json");
    old["judgement"]["verdict"] = "unusable".into();
    bench.write("answer/stiffness.json", old.to_string());
    bench.refused(&["export", "answer", "--to", "csv", "-o", "out"], &["unusable", "--anyway"]);
    bench.done(&["export", "answer", "--to", "csv", "--anyway", "-o", "anyway"]);
    old.as_object_mut().unwrap().remove("ends");
    bench.write("answer/stiffness.json", old.to_string());
    bench.refused(
        &["export", "answer", "--to", "csv", "--anyway", "-o", "out"],
        &["`ends`", "jointscope decompose"],
    );
    bench.write("answer/diagnosis.json", "{}");
    bench.refused(&["export", "answer", "--to", "csv", "-o", "out"], &["holds both", "name the one"]);
    assert!(!bench.0.join("out").exists());
}
