//! The built program: the finite-element twin of a fixture with `geometry`.

use crate::common::{self, Bench};
use std::fs;

const COARSE: [&str; 8] = ["--corner", "2", "--along", "6", "--across", "1", "--growth", "3"];

fn bench(name: &str) -> Bench {
    let bench = Bench::new(&format!("fem-{name}"));
    bench.write("d0.json", include_str!("../../../../fixtures/paper/D0.json"));
    bench
}

fn fem<'a>(more: &[&'a str]) -> Vec<&'a str> {
    ["fem", "d0.json"].iter().chain(&COARSE).chain(more).copied().collect()
}

#[test]
fn the_twin_s_frfs_are_written_and_decompose_to_the_joint() {
    let bench = bench("whole");
    let summary = bench.done(&fem(&["-o", "twin.uff"]));
    assert!(summary.contains("mode 1: 6") && summary.contains("transverse"), "{summary}");
    assert!(
        summary.ends_with("twin.uff: FRFs 4/1, 3/1, 4/2, 3/2 on 400 lines, 2.5 to 1000 Hz\n"),
        "{summary}"
    );
    bench.done(&["decompose", "d0.json", "twin.uff", "--band", "200:700", "-o", "out"]);
    let file = bench.json("out/stiffness.json");
    // 12 EI/L³ of the lumped beam is 2.58 MN/m; shear and the yielding ends of the strip take some of it.
    let k11 = file["maximum_likelihood"]["stiffness"][0][0].as_f64().unwrap();
    assert!((2.2e6..2.58e6).contains(&k11), "{k11}");
}

#[test]
fn the_same_command_writes_the_same_bytes() {
    let bench = bench("same");
    bench.done(&fem(&["-o", "one.uff"]));
    bench.done(&fem(&["-o", "two.uff", "--deck", "mesh.inp"]));
    assert_eq!(fs::read(bench.0.join("one.uff")).unwrap(), fs::read(bench.0.join("two.uff")).unwrap());
    assert!(fs::read_to_string(bench.0.join("mesh.inp")).unwrap().contains("TYPE=C3D20"));
}

#[test]
fn what_has_no_twin_is_refused() {
    let bench = bench("refused");
    bench.write("two.json", common::TWO_BLOCKS);
    bench.refused(&["fem", "two.json", "-o", "twin.uff"], &["two.json", "`geometry`"]);
    bench.refused(&fem(&["-o", "twin.uff", "--frf", "9/1"]), &["d0.json", "no point `9`"]);
    bench.refused(&["fem", "d0.json", "--corner", "0", "-o", "twin.uff"], &["1 to 200"]);
    bench.refused(&fem(&["--without", "shear", "--deck", "a.inp", "-o", "twin.uff"]), &["`--deck`"]);
    bench.refused(&fem(&["--without", "gravity", "-o", "twin.uff"]), &["gravity", "plate-action"]);
    assert!(!bench.0.join("twin.uff").exists());
}
