//! Recordings of other formats than universal files, standard input, and what files hold.

use jointscope::uff::Data;

use crate::common::{Bench, TWO_BLOCKS};

const LINES: &str = "50:1000:10";

/// The FRFs of `frf.uff` as a table: the first as real and imaginary parts, the second as magnitude and
/// phase, with decimal commas if wanted.
fn table(bench: &Bench, comma: bool) -> String {
    let datasets = bench.datasets("frf.uff");
    let mut header = vec!["frequency [Hz]".to_owned()];
    for (at, dataset) in datasets.iter().enumerate() {
        let name = format!("{}/{}", dataset.response.number, dataset.reference.number);
        match at % 2 {
            0 => header.extend([format!("{name} real [m/s^2/N]"), format!("{name} imag [m/s^2/N]")]),
            _ => header.extend([format!("{name} magnitude [m/s^2/N]"), format!("{name} phase [deg]")]),
        }
    }
    let mut lines = vec![header.join(";")];
    for point in 0..datasets[0].data.len() {
        let mut row = vec![datasets[0].abscissa.value(point).to_string()];
        for (at, dataset) in datasets.iter().enumerate() {
            let Data::Complex(values) = &dataset.data else { panic!("an FRF is complex") };
            let value = values[point];
            match at % 2 {
                0 => row.extend([value.re.to_string(), value.im.to_string()]),
                _ => row.extend([value.norm().to_string(), value.arg().to_degrees().to_string()]),
            }
        }
        let row = row.join(";");
        lines.push(if comma { row.replace('.', ",") } else { row });
    }
    lines.join("\n") + "\n"
}

fn stiffness(bench: &Bench, files: &[&str]) -> f64 {
    let arguments: Vec<&str> = [&["decompose", "two.json"], files, &["-o", "out"]].concat();
    bench.done(&arguments);
    bench.json("out/stiffness.json")["average"]["stiffness"][0][0].as_f64().unwrap()
}

#[test]
fn a_table_gives_the_joint_that_its_universal_file_gives() {
    let bench = Bench::synthesized("formats-table", TWO_BLOCKS, LINES);
    let expected = stiffness(&bench, &["frf.uff"]);
    for comma in [false, true] {
        bench.write("frf.csv", table(&bench, comma));
        let found = stiffness(&bench, &["frf.csv"]);
        assert!((found - expected).abs() < 1e-6 * expected.abs(), "{found} N/m, not {expected}");
    }
}

#[test]
fn standard_input_is_a_recording_of_any_format() {
    let bench = Bench::synthesized("formats-stdin", TWO_BLOCKS, LINES);
    let universal = std::fs::read(bench.0.join("frf.uff")).unwrap();
    let expected = stiffness(&bench, &["frf.uff"]);
    for input in [universal.clone(), table(&bench, true).into_bytes()] {
        let output = bench.run_with_input(&["decompose", "two.json", "-", "-o", "out"], &input);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let answer = bench.json("out/stiffness.json");
        let found = answer["average"]["stiffness"][0][0].as_f64().unwrap();
        assert!((found - expected).abs() < 1e-6 * expected.abs());
        assert!(bench.text("out/report.html").contains("standard input"), "the page names its inputs");
    }
    let output = bench.run_with_input(&["decompose", "two.json", "-", "-o", "none"], b"a,b\n1,x\n");
    let refusal = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(refusal.starts_with("jointscope: standard input: is no universal file"), "{refusal}");
    let twice = bench.run_with_input(&["show", "-", "-"], &universal);
    assert!(String::from_utf8(twice.stderr).unwrap().contains("given twice"));
    let both =
        bench.run_with_input(&["diagnose", "two.json", "-", "--baseline", "-", "-o", "none"], &universal);
    assert!(String::from_utf8(both.stderr).unwrap().contains("given twice"));
}

#[test]
fn columns_without_nodes_are_named_and_entries_of_no_use_refused() {
    let bench = Bench::new("formats-columns");
    let mut rows = String::from("frequency,H1 real,H1 imag\n");
    (1..60).for_each(|line| rows += &format!("{},{},{}\n", 10 * line, 0.5, -0.01 * f64::from(line)));
    bench.write("h1.csv", rows);
    bench.refused(
        &["modes", "h1.csv", "--json"],
        &["h1.csv: line 1, column 2 (`H1 real`)", "--columns \"H1=4/1\""],
    );
    bench.refused(&["modes", "h1.csv", "--columns", "H1", "--json"], &["H1=4/1 [m/s^2/N]"]);
    bench.refused(
        &["modes", "h1.csv", "--columns", "H1=4/1", "H2=3/1", "--json"],
        &["h1.csv", "`H2=3/1` of `--columns` names no column"],
    );
    // No unit is stated, and none is taken.
    bench.refused(
        &["modes", "h1.csv", "--columns", "H1=4/1", "--json"],
        &["h1.csv", "FRF 4:+y/1:+y", "`--assume-units`"],
    );
    let shown = bench.done(&["show", "h1.csv", "--columns", "H1=4:+z/1 [m/s^2/N]"]);
    assert!(shown.contains("1 FRF in m/s^2/N: 59 values from 10 to 590 Hz; channels 4:+z/1:+y"), "{shown}");
}

#[test]
fn what_files_hold_is_shown_and_said_where_frfs_are_missing() {
    let bench = Bench::synthesized("formats-show", TWO_BLOCKS, LINES);
    let sample = include_bytes!("../../../uff/tests/all/samples/geometry-by-pyuff.uff");
    bench.write("mesh.uff", sample);
    let shown = bench.done(&["show", "mesh.uff", "frf.uff"]);
    for part in [
        "mesh.uff:\n  written by pyuff 2.5\n",
        "a geometry of 5 nodes and 1 trace line: x from -0.00225 to 0.15 m",
        "2 mode shapes (312.5 to 636.6 Hz)",
        "1. 312.5 Hz, damping ratio 0.3 %, 3 nodes",
        "frf.uff:\n  4 FRFs of acceleration per excitation force in m/s^2 per N: 96 values from 50 to 1000 Hz",
    ] {
        assert!(shown.contains(part), "`{part}` is missing from:\n{shown}");
    }
    let json = bench.json_of(&["show", "mesh.uff", "--json"]);
    assert_eq!(json["files"][0]["holds"]["modes"][0]["frequency"], 312.5);
    bench.refused(
        &["modes", "mesh.uff", "--json"],
        &[
            "mesh.uff: there is no FRF (function type 4)",
            "a geometry of 5 nodes and 1 trace line, 2 mode shapes",
            "dataset 58",
        ],
    );
    bench.write("book.xlsx", b"PK\x03\x04....");
    bench.refused(
        &["modes", "book.xlsx", "--json"],
        &["book.xlsx: is a ZIP archive or an Excel workbook", "CSV"],
    );
}

/// Every file of many programs is read, or refused for what it is.
#[test]
fn files_of_many_programs_are_read_or_refused_with_the_right_reason() {
    let folder =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/recordings/pyuff-data");
    if !folder.is_dir() {
        println!("skipped: no folder `shared/recordings/pyuff-data` beside the workspace");
        return;
    }
    let bench = Bench::new("formats-programs");
    let reasons = [
        ("1858.uff", "2 datasets 1858 (qualifiers of functions)"),
        ("2411 and 2414.uff", "a mesh of 441 nodes and 400 elements, 10 mode shapes (0.9564 to 25.76 Hz)"),
        (
            "Artemis export - Geometry RPBC_setup_05_14102016_105117.uff",
            "a mesh of 74 nodes and 108 elements",
        ),
        ("NX simulation output.uff", "a mesh of 18 nodes and 17 elements, 176 mode shapes"),
        ("Sample_UFF58_ascii.uff", "it is no force"),
        ("Sample_UFF58b_bin.uff", "it is no force"),
        ("Simcenter_nxopen_thickness.uff", "on elements"),
        ("TestLab 161 164 18 15 82.uff", "a geometry of 36 nodes and 3 trace lines"),
        ("binary8byte.uff", "it is no force"),
        ("dataset_milestone_in_header.uff", "there is 1 time history and no FRF; it is no force"),
        ("groups_test.uff", "a mesh of 74 nodes and 341 elements, dataset 2467 (groups)"),
        ("heat_engine_housing.uff", "temperature at 10 nodes"),
        ("mesh_Oros-modal_uff15_uff2412.uff", "a mesh of 96 nodes and 72 elements"),
        ("mesh_set2412_to_convert.uff", "a mesh of 96 nodes and 72 elements"),
        ("mesh_test_uff2412_mixed.uff", "a mesh of 5 nodes and 5 elements"),
        ("non_ascii_header.uff", "at least 8 are needed"),
        ("sample_dataset58_psd.uff", "1 power spectral density (function type 9)"),
        ("time-history-not-all-columns-filled.uff", "jointscope estimate"),
        ("uff55 sample_test record10.uff", "1 mode shape"),
        ("uff55_translation.uff", "3 mode shapes (10 to 13 Hz)"),
        ("uff55_translation_rotation.uff", "1 mode shape (97.01 Hz)"),
        ("meas_point_1.txt", "no line holds a frequency and numbers beside it"),
    ];
    for (name, reason) in reasons {
        let path = folder.join(name);
        let path = path.to_str().unwrap();
        bench.refused(&["modes", path, "--json"], &[name, reason]);
        if !name.ends_with(".txt") {
            let shown = bench.done(&["show", path]);
            assert!(shown.lines().count() > 1 && !shown.contains("cannot be read"), "{shown}");
        }
    }
}
