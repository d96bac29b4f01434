//! The built program: joints side by side.

use crate::common::Bench;

/// The inferred D0 as lumped model and as finite elements, and with a strip a fifth softer.
fn bench(name: &str) -> Bench {
    let bench = Bench::new(&format!("compare-{name}"));
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
    bench.done(&["compare", "sim", "fem", "soft", "-o", "again"]);
    assert_eq!(bench.text("again/comparison.json"), bench.text("out/comparison.json"));
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let bench = bench("refused");
    bench.refused(&["compare", "sim", "-o", "out"], &["two decompositions"]);
    bench.refused(&["compare", "sim", "nowhere", "-o", "out"], &["nowhere/stiffness.json", "no such file"]);
    bench.refused(&["compare", "sim", "sim", "-o", "out"], &["called `sim`"]);
    bench.done(&["decompose", "d0.json", "sim.uff", "--relation", "paper", "-o", "paper"]);
    bench.refused(&["compare", "sim", "paper", "-o", "out"], &["`exact`", "`paper`", "--relation"]);
    std::fs::create_dir(bench.0.join("bad")).unwrap();
    bench.write("bad/stiffness.json", "{\"lines\": 3}");
    bench.refused(&["compare", "sim", "bad", "-o", "out"], &["bad/stiffness.json", "`lines`"]);
    assert!(!bench.0.join("out").exists());
}
