//! `jointscope check` as a user runs it.

use crate::common::{Bench, TWO_BLOCKS, scale};

#[test]
fn a_fixture_alone_is_weighed_and_nothing_is_written() {
    let bench = Bench::new("check-alone");
    bench.write("two.json", TWO_BLOCKS);
    let said = bench.done(&["check", "two.json"]);
    for part in ["Nothing odd in the fixture", "total mass 2.2000 ± 0.0031 kg", "2 rigid-body modes at 0 Hz"]
    {
        assert!(said.contains(part), "{part} is missing from {said}");
    }
    assert_eq!(bench.names(), ["two.json"]);
}

#[test]
fn slips_are_an_answer_and_no_error() {
    let bench = Bench::new("check-slips");
    bench.write(
        "two.json",
        TWO_BLOCKS.replace(
            r#""mass": 1.10, "inertia": 9.5e-4, "x_cg": 0.095"#,
            r#""mass": 1100, "inertia": 9.5e-4, "x_cg": 0.095"#,
        ),
    );
    let said = bench.done(&["check", "two.json"]);
    assert!(
        said.starts_with("1 thing wrong in the fixture.\n")
            && said.contains("bodies/B/mass")
            && said.contains("grams"),
        "{said}"
    );
}

#[test]
fn a_recording_is_laid_beside_the_fixture_with_a_page_and_a_file() {
    let bench = Bench::synthesized("check-recording", TWO_BLOCKS, "5:1500:2.5");
    bench.rewrite("frf.uff", "turned.uff", |datasets| {
        datasets.iter_mut().filter(|d| d.response.number == 4).for_each(|d| scale(d, -1.0));
    });
    let said = bench.done(&["check", "two.json", "turned.uff", "-o", "out"]);
    assert!(
        said.contains("! response 4: its FRFs have the opposite sign") && said.ends_with("out/report.html\n"),
        "{said}"
    );
    let file = bench.json("out/check.json");
    assert_eq!(file["recording"]["channels"][1]["channel"], "response 4");
    assert_eq!(file["recording"]["channels"][1]["turned"], true);
    assert_eq!(file["remarks"][0]["place"], "response 4");
    assert!(file["made"]["inputs"][1]["sha256"].is_string());
    let page = bench.text("out/report.html");
    for heading in
        ["What is odd", "The assembly", "Modes of the model", "Mass line", "Every number", "opposite sign"]
    {
        assert!(page.contains(heading), "{heading}");
    }
    assert_eq!(bench.json_of(&["check", "two.json", "turned.uff", "--json"])["remarks"], file["remarks"]);
    let as_it_is = bench.done(&["check", "two.json", "frf.uff"]);
    assert!(as_it_is.starts_with("Nothing odd in fixture and recording.\n"), "{as_it_is}");
}

#[test]
fn what_cannot_be_read_is_refused_in_a_sentence() {
    let bench = Bench::synthesized("check-refused", TWO_BLOCKS, "5:500:5");
    bench.refused(&["check", "none.json"], &["none.json", "no such file"]);
    bench.refused(&["check", "two.json", "none.uff"], &["none.uff", "no such file"]);
    bench.refused(&["check", "two.json", "two.json"], &["two.json", "is a JSON file, such as a fixture"]);
    bench.refused(&["check", "two.json", "frf.uff", "-o", "two.json"], &["two.json"]);
    bench.write("bad.json", TWO_BLOCKS.replace("\"mass\": 1.10,", ""));
    bench.refused(&["check", "bad.json"], &["bad.json", "bodies/A", "the key `mass` is missing"]);
}
