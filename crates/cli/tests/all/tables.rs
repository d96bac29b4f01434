//! The built program: the paper's tables.

use crate::common::Bench;

#[test]
fn the_tables_go_to_standard_output_or_to_a_file() {
    let bench = Bench::new("tables-output");
    let text = bench.done(&["tables", "--no-fem"]);
    assert!(
        text.contains("Table 4") && text.contains("| D0      | integral | 3.3       | 3.32 (same)"),
        "{text}"
    );
    assert_eq!(bench.done(&["tables", "--no-fem", "-o", "tables.md"]), "tables.md\n");
    assert_eq!(bench.text("tables.md").trim_end(), text.trim_end());
    bench.done(&["tables", "--no-fem", "--json", "-o", "tables.json"]);
    assert_eq!(bench.json("tables.json")["F01"]["paper"]["stiffness"]["exp"][0], 14.9e6);
}

#[test]
fn a_measured_example_comes_from_a_decomposition() {
    let bench = Bench::shipped("tables-measured");
    bench.done(&["decompose", "fixture.json", "hammer-test.uff", "--relation", "paper", "-o", "out"]);
    let text = bench.done(&["tables", "--no-fem", "--measured", "F1=out"]);
    let row = text.lines().find(|line| line.starts_with("| F1 ")).unwrap();
    assert!(!row.trim_end().ends_with("- |"), "{row}");
    bench.refused(&["tables", "--no-fem", "--measured", "F9=out"], &["out/stiffness.json", "`F9`"]);
    bench.refused(
        &["tables", "--no-fem", "--measured", "F1=nowhere"],
        &["nowhere/stiffness.json", "no such file"],
    );
    bench.refused(&["tables", "--measured", "F1"], &["E2=out"]);
}
