//! What is written beside answer and page on request: tables, curves, figures, FRFs of the models.

use crate::common::{Bench, TWO_BLOCKS};
use jointscope::uff::{Data, FunctionType};
use num_complex::Complex64;

fn files(bench: &Bench, folder: &str) -> Vec<String> {
    let Ok(entries) = std::fs::read_dir(bench.0.join(folder)) else { return Vec::new() };
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

fn frfs(bench: &Bench, name: &str) -> Vec<Complex64> {
    let datasets = bench.datasets(name).into_iter();
    let frfs = datasets.filter(|dataset| dataset.function == FunctionType::FrequencyResponse);
    frfs.flat_map(|dataset| match dataset.data {
        Data::Complex(values) => values,
        Data::Real(_) => panic!("an FRF is complex"),
    })
    .collect()
}

#[test]
fn a_diagnosis_comes_with_its_tables_curves_figures_and_the_frfs_of_its_models() {
    let bench = Bench::new("results");
    let folder = crate::common::shipped().with_file_name("two-blocks");
    for file in ["fixture.json", "hammer-test.uff"] {
        std::fs::copy(folder.join(file), bench.0.join(file)).unwrap();
    }
    bench.done(&["diagnose", "fixture.json", "hammer-test.uff", "--also", "csv,svg,uff", "-o", "out"]);
    let page = bench.text("out/report.html");
    assert_eq!(files(&bench, "out/tables").len(), page.matches("<table").count());
    let plots = page.matches("data-plot=").count();
    assert_eq!(files(&bench, "out/curves").len(), plots);
    assert_eq!(files(&bench, "out/figures").len(), plots + page.matches("<figure class=\"sketch\"").count());
    for name in files(&bench, "out/figures") {
        let figure = bench.text(&format!("out/figures/{name}"));
        assert!(figure.starts_with("<?xml") && !figure.contains("var("), "{name}");
    }
    // The curve of an FRF is its magnitude on every line, as measured and of each model; 3/1 is the first of
    // all.
    let curves = bench.text("out/curves/frfs-frf-3-1.csv");
    let head = curves.lines().next().unwrap();
    assert!(head.starts_with("Frequency [Hz],") && head.ends_with(",repaired [(m/s^2)/N]"), "{head}");
    assert_eq!(curves.lines().count(), 201);
    let names = ["measured", "nominal", "refitted", "repaired"]
        .map(|name| frfs(&bench, &format!("out/frfs/{name}.uff")));
    // What was measured comes with how sure it is.
    let measured = std::fs::read(bench.0.join("out/frfs/measured.uff")).unwrap();
    let says = |words: &str| measured.windows(words.len()).filter(|part| *part == words.as_bytes()).count();
    assert_eq!((says("Coherence"), says("averages 8")), (4, 8));
    // The repaired model is the last column.
    let first = curves.lines().nth(1).unwrap().rsplit(',').next().unwrap();
    assert!((first.parse::<f64>().unwrap() / names[3][0].norm() - 1.0).abs() < 1e-12);
    // What is left is what was measured less the model, and the error of the answer is made of it.
    let left = frfs(&bench, "out/frfs/residual-repaired.uff");
    let size = |values: &[Complex64]| values.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
    for ((left, measured), model) in left.iter().zip(&names[0]).zip(&names[3]) {
        assert!((left - (measured - model)).norm() <= 1e-12 * measured.norm());
    }
    let stated = bench.json("out/diagnosis.json")["fit"]["nrmse"]["repaired"].as_f64().unwrap();
    assert!((size(&left) / size(&names[0]) / stated - 1.0).abs() < 1e-9, "{stated}");
    assert!(size(&frfs(&bench, "out/frfs/residual-nominal.uff")) > 10.0 * size(&left));
}

#[test]
fn modes_come_with_the_frfs_rebuilt_from_them() {
    let bench = Bench::shipped("results-modes");
    bench.done(&["modes", "hammer-test.uff", "--also", "uff", "-o", "out"]);
    assert_eq!(files(&bench, "out/frfs"), ["measured.uff", "rebuilt.uff", "residual-rebuilt.uff"]);
    assert!(files(&bench, "out/tables").is_empty() && files(&bench, "out/figures").is_empty());
}

#[test]
fn a_decomposition_and_a_check_come_with_the_frfs_of_the_fixture_and_of_the_joint_found() {
    let bench = Bench::shipped("results-joint");
    bench.done(&["decompose", "fixture.json", "hammer-test.uff", "--also", "uff", "-o", "out"]);
    let names = ["fitted.uff", "measured.uff", "nominal.uff", "residual-fitted.uff", "residual-nominal.uff"];
    assert_eq!(files(&bench, "out/frfs"), names);
    let [fitted, measured, nominal, left, _] = names.map(|name| frfs(&bench, &format!("out/frfs/{name}")));
    let size = |values: &[Complex64]| values.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
    let apart = |a: &[Complex64], b: &[Complex64]| {
        size(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>()) / size(b)
    };
    assert!((apart(&fitted, &measured) - size(&left) / size(&measured)).abs() < 1e-12);
    // The glue is soft: the joint found meets what was measured, the nominal one does not.
    assert!(apart(&fitted, &measured) < 0.05, "{}", apart(&fitted, &measured));
    assert!(apart(&nominal, &measured) > 0.5, "{}", apart(&nominal, &measured));
    bench.done(&["check", "fixture.json", "hammer-test.uff", "--also", "uff", "-o", "checked"]);
    assert_eq!(files(&bench, "checked/frfs"), ["measured.uff", "nominal.uff", "residual-nominal.uff"]);
    assert_eq!(
        frfs(&bench, "checked/frfs/nominal.uff").len(),
        frfs(&bench, "checked/frfs/measured.uff").len()
    );
    // What is measured comes back with the coherence that it had.
    let coherences = |name: &str| {
        let all = bench.datasets(name).into_iter();
        all.filter(|dataset| dataset.function == FunctionType::Coherence).count()
    };
    assert_eq!(coherences("checked/frfs/measured.uff"), coherences("hammer-test.uff"));
}

#[test]
fn what_a_command_does_not_have_is_refused_before_the_work() {
    let bench = Bench::synthesized("results-refused", TWO_BLOCKS, "50:1000:10");
    bench.done(&["decompose", "two.json", "frf.uff", "-o", "joint"]);
    bench.refused(
        &["compare", "joint", "--also", "uff", "-o", "out"],
        &["--also uff", "`compare` has none", "`diagnose`, `decompose`, `modes` and `check`"],
    );
    bench.refused(
        &["check", "two.json", "--also", "uff", "-o", "out"],
        &["no recording is given", "`synthesize`"],
    );
    bench.refused(&["decompose", "two.json", "frf.uff", "--also", "csv", "--json"], &["--output <DIR>"]);
    bench.refused(
        &["diagnose", "two.json", "frf.uff", "--also", "png", "-o", "out"],
        &["png", "csv, svg, uff"],
    );
}
