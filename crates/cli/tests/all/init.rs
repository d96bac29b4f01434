//! `jointscope init` and `jointscope schema` as a user runs them.

use crate::common::{Bench, TWO_BLOCKS, shipped};

#[test]
fn every_draft_reads_checks_and_synthesizes() {
    let bench = Bench::new("init");
    let drafts: [(&str, &[&str], &str); 4] = [
        ("blocks.json", &["--blocks", "50x50x80:steel", "--strip", "60x40x6:steel"], "4/1"),
        ("frame.json", &["--frame", "3", "--storey-mass", "3.5", "--columns", "300x25x6:aluminium"], "3/1"),
        ("beam.json", &["--beam", "500x40x6:steel"], "5/1"),
        ("clamped.json", &["--beam", "500x40x6:7e10,2700", "--clamped"], "5/1"),
    ];
    for (file, options, frf) in drafts {
        let arguments: Vec<&str> = ["init"].iter().chain(options).chain(&["-o", file]).copied().collect();
        let said = bench.done(&arguments);
        assert!(
            said.contains("weigh") && said.ends_with(&format!("next: jointscope check {file}\n")),
            "{said}"
        );
        bench.done(&["synthesize", file, "--frf", frf, "--lines", "1:1000:1", "-o", "frf.uff"]);
        let checked = bench.done(&["check", file, "frf.uff"]);
        assert!(checked.starts_with("Nothing odd in fixture and recording.\n"), "{file}: {checked}");
        assert!(bench.json(file)["notes"].as_array().unwrap().len() > 2);
    }
    // The solid comes with the blocks.
    assert!(bench.json("blocks.json")["geometry"]["bodies"]["A"].is_object());
}

#[test]
fn nothing_is_odd_in_what_a_frame_with_few_lines_between_its_modes_would_record() {
    let bench = Bench::new("init-frames");
    // Modes from 2 Hz on, most of them narrower than lines are apart; FRFs that fall by eleven decades over
    // the band.
    for (storeys, mass, columns) in
        [("3", "3.5", "200x25x5"), ("4", "2", "400x20x6"), ("5", "3.5", "400x20x6"), ("5", "8", "400x20x6")]
    {
        let columns = format!("{columns}:aluminium");
        let draft = ["init", "--frame", storeys, "--storey-mass", mass, "--columns", &columns];
        bench.done(&[&draft[..], &["--force", "-o", "frame.json"]].concat());
        let frf = format!("{storeys}/1");
        bench.done(&[
            "synthesize",
            "frame.json",
            "--frf",
            &frf,
            "--lines",
            "1:1000:1",
            "-o",
            &format!("{storeys}-{mass}.uff"),
        ]);
        let checked = bench.done(&["check", "frame.json", &format!("{storeys}-{mass}.uff")]);
        assert!(
            checked.starts_with("Nothing odd in fixture and recording.\n"),
            "{storeys} storeys: {checked}"
        );
    }
}

#[test]
fn the_help_says_how_bars_are_written() {
    let help = Bench::new("init-help").done(&["init", "--help"]);
    assert!(help.contains("LENGTHxWIDTHxHEIGHT:MATERIAL in mm") && help.contains("pmma"), "{help}");
}

#[test]
fn points_of_a_recording_are_named_and_have_to_be_filled_in() {
    let bench = Bench::new("init-points");
    let recording = shipped().join("hammer-test.uff");
    let recording = recording.to_str().unwrap();
    let said = bench.done(&[
        "init",
        "--blocks",
        "60x50x50:steel",
        "--strip",
        "65x30x5:steel",
        "--points-from",
        recording,
        "-o",
        "own.json",
    ]);
    assert!(said.contains("FILL IN: the recording has points 1, 2, 3, 4"), "{said}");
    let checked = bench.done(&["check", "own.json"]);
    assert!(checked.contains("! points/3/x: its place is unknown"), "{checked}");
}

#[test]
fn what_cannot_be_drafted_is_refused_in_a_sentence_and_work_is_not_overwritten() {
    let bench = Bench::new("init-refused");
    bench.write("two.json", TWO_BLOCKS);
    let blocks = ["init", "--blocks", "50x50x80:steel", "--strip", "60x40x6:steel", "-o", "two.json"];
    bench.refused(&blocks, &["two.json", "is there already", "--force"]);
    bench.refused(&["init", "-o", "new.json"], &["--blocks", "--frame", "--beam"]);
    bench.refused(&["init", "--blocks", "50x50x80:steel", "-o", "new.json"], &["--strip"]);
    bench.refused(&["init", "--beam", "500x40:steel", "-o", "new.json"], &["LENGTHxWIDTHxHEIGHT"]);
    bench.refused(&["init", "--beam", "500,5x40x6:steel", "-o", "new.json"], &["comma", "decimal point"]);
    bench.refused(
        &["init", "--beam", "0.5x0.04x0.006:steel", "-o", "new.json"],
        &["look like metres", "in mm"],
    );
    bench.refused(&["init", "--beam", "500x40x6:stel", "-o", "new.json"], &["no material `stel`", "steel"]);
    bench.refused(
        &["init", "--beam", "500x40x6:steel", "--points-from", "none.uff", "-o", "new.json"],
        &["none.uff", "no such file"],
    );
    bench.refused(&["init", "--frame", "3", "-o", "new.json"], &["--columns"]);
    bench.done(&[&blocks[..], &["--force"]].concat());
    assert_eq!(bench.json("two.json")["name"], "two blocks and a strip");
}

#[test]
fn the_schema_is_printed_or_written_and_is_one() {
    let bench = Bench::new("schema");
    let printed = bench.json_of(&["schema"]);
    bench.done(&["schema", "-o", "fixture.schema.json"]);
    assert_eq!(bench.json("fixture.schema.json"), printed);
    assert_eq!(printed["$schema"], "https://json-schema.org/draft/2020-12/schema");
    assert!(printed["properties"]["bodies"]["description"].as_str().unwrap().contains("rigid blocks"));
}

#[test]
fn a_clamp_of_what_is_no_beam_and_standard_input_twice_are_refused() {
    let bench = Bench::new("init-clamped-frame");
    let frame = [
        "init",
        "--frame",
        "3",
        "--storey-mass",
        "3.5",
        "--columns",
        "300x25x6:steel",
        "--clamped",
        "-o",
        "a.json",
    ];
    bench.refused(&frame, &["--clamped is of a beam"]);
    let twice = ["init", "--beam", "500x40x6:steel", "--points-from", "-", "-", "-o", "a.json"];
    let recording = std::fs::read(shipped().join("hammer-test.uff")).unwrap();
    let refused = bench.run_with_input(&twice, &recording);
    assert!(String::from_utf8(refused.stderr).unwrap().contains("given twice") && bench.names().is_empty());
}

#[test]
fn a_map_for_triaxial_nodes_names_one_direction_of_each() {
    let bench = Bench::new("init-triaxial");
    bench.write(
        "t.csv",
        "f,1:+x/1:+z real,1:+x/1:+z imag,1:+z/1:+z real,1:+z/1:+z imag\n10,1,0,2,0\n20,1,0,2,0\n",
    );
    let said = bench.done(&["init", "--beam", "500x40x6:steel", "--points-from", "t.csv", "-o", "a.json"]);
    let map = said.split("`--map ").nth(1).unwrap().split('`').next().unwrap();
    assert_eq!(map.split_whitespace().count(), 1, "{said}");
}

#[test]
fn nodes_that_all_lie_along_one_other_axis_are_told_the_one_map_entry_for_all() {
    let bench = Bench::new("init-along-z");
    bench.write("t.csv", "f,2:-z/1:+z real,2:-z/1:+z imag\n10,1,0\n20,1,0\n");
    let init = ["init", "--beam", "500x40x6:steel", "--points-from", "t.csv", "-o", "a.json"];
    assert!(bench.done(&init).contains("`--map +z=+y`"));
    bench.write("t.csv", "f,2:-z/1:+y real,2:-z/1:+y imag\n10,1,0\n20,1,0\n");
    assert!(bench.done(&[&init[..], &["--force"]].concat()).contains("`--map 2:+z=2:+y`"));
}

/// FRFs of two blocks with their geometry: nodes 1 to 4 along z, in mm, 1000 mm from where the fixture
/// begins.
fn with_geometry(name: &str) -> Bench {
    let bench = Bench::new(name);
    bench.write("two.json", TWO_BLOCKS);
    bench.done(&["synthesize", "two.json", "--ascii", "--lines", "50:1000:10", "-o", "frf.uff"]);
    let mut text = bench.text("frf.uff");
    text.push_str("    -1\n  2411\n");
    for (node, z) in [(1, 940.0), (2, 1000.0), (3, 1065.0), (4, 1125.0)] {
        text.push_str(&format!(
            "{node:>10}{:>10}{:>10}{:>10}\n{:>25.16}{:>25.16}{z:>25.16}\n",
            0, 0, 11, 5.0, -2.0
        ));
    }
    text.push_str("    -1\n");
    bench.write("with.uff", text);
    bench
}

const OF_BLOCKS: [&str; 6] = ["init", "--blocks", "60x50x50:steel", "--strip", "65x30x5:steel", "--from-uff"];

#[test]
fn nodes_of_a_recording_become_points_at_the_places_of_its_geometry() {
    let bench = with_geometry("init-from-uff");
    let options = ["with.uff", "--length-unit", "mm", "--origin", "1000", "-o", "own.json"];
    let said = bench.done(&[&OF_BLOCKS[..], &options].concat());
    assert!(said.contains("4 nodes along z of the geometry, over 185.0 mm"), "{said}");
    let points = &bench.json("own.json")["points"];
    for (name, body, x) in [("1", "A", -0.06), ("2", "A", 0.0), ("3", "B", 0.065), ("4", "B", 0.125)] {
        let x_of = points[name]["x"]["value"].as_f64().or(points[name]["x"].as_f64()).unwrap();
        assert!(points[name]["body"] == body && (x_of - x).abs() < 1e-9, "{points}");
    }
    // Who takes the names alone is told that there is more.
    let names = [&OF_BLOCKS[..5], &["--points-from", "with.uff", "-o", "names.json"]].concat();
    assert!(bench.done(&names).contains("the recording has a geometry: `--from-uff`"));
    let checked = bench.done(&["check", "own.json", "with.uff"]);
    assert!(!checked.contains("its place is unknown"), "{checked}");
    // By itself: points, and masses to be filled in.
    bench.done(&["init", "--from-uff", "with.uff", "--length-unit", "mm", "-o", "alone.json"]);
    let alone = bench.json("alone.json");
    assert_eq!(alone["points"]["4"]["body"], "body");
    assert!(alone["notes"].to_string().contains("FILL IN: one rigid body stands for the whole structure"));
    bench.done(&["check", "alone.json"]);
}

#[test]
fn without_geometry_or_its_unit_a_sentence_says_what_is_missing() {
    let bench = with_geometry("init-no-geometry");
    let with = |options: &[&'static str]| [&OF_BLOCKS[..], options].concat();
    bench.refused(
        &with(&["frf.uff", "-o", "own.json"]),
        &["frf.uff: there are no nodes (datasets 15 and 2411)", "--points-from"],
    );
    bench.refused(
        &with(&["with.uff", "-o", "own.json"]),
        &["with.uff", "unit of its coordinates", "--length-unit mm"],
    );
    bench.refused(
        &with(&["with.uff", "--length-unit", "m", "-o", "own.json"]),
        &["over 185000.0 mm", "only over 185.0 mm", "--length-unit"],
    );
    bench.refused(
        &[
            "init",
            "--beam",
            "500x40x6:steel",
            "--blocks",
            "9x9x9:steel",
            "--strip",
            "9x9x9:steel",
            "-o",
            "own.json",
        ],
        &["--beam", "cannot be used with"],
    );
}
