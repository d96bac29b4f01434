//! `jointscope modes` as a user runs it.

use crate::common::Bench;
use jointscope::uff::Data;
use jointscope_samples::{Noise, two_blocks_damped};
use num_complex::Complex64;

fn bench(name: &str) -> Bench {
    Bench::synthesized(name, &two_blocks_damped(&[0.004, 0.006]), "2.5:1500:2.5")
}

#[test]
fn modes_of_a_file_come_with_deviations_a_chart_and_a_page() {
    let bench = bench("modes-plain");
    let said = bench.done(&["modes", "frf.uff", "-o", "out"]);
    assert!(said.ends_with("out/report.html\n"), "{said}");
    let file = bench.json("out/modes.json");
    let modes = file["modes"].as_array().unwrap();
    assert_eq!(modes.len(), 2);
    for (mode, ratio) in modes.iter().zip([0.004, 0.006]) {
        let number = |value: &serde_json::Value| value.as_f64().unwrap();
        assert!((number(&mode["damping_ratio"]) / ratio - 1.0).abs() < 1e-4, "{mode}");
        assert!(number(&mode["std"]["frequency"]) > 0.0 && number(&mode["std"]["damping_ratio"]) > 0.0);
    }
    assert!(!file["stabilization"]["poles"].as_array().unwrap().is_empty());
    let page = bench.text("out/report.html");
    for heading in ["Stabilisation chart", "Mode shapes", "Auto-MAC", "Residual terms"] {
        assert!(page.contains(heading), "{heading}");
    }
    // Scripts need no directory.
    let printed: serde_json::Value =
        serde_json::from_str(&bench.answer(&["modes", "frf.uff", "--json"])).unwrap();
    assert_eq!(printed["modes"], file["modes"]);
}

#[test]
fn measured_ratios_go_into_the_fixture_with_their_deviations_and_give_its_frfs_back() {
    let bench = bench("modes-update");
    let guess = bench.text("two.json").replace("[0.004, 0.006]", "[0.02]");
    bench.write("guess.json", guess);
    let said =
        bench.done(&["modes", "frf.uff", "--fixture", "guess.json", "--update", "new.json", "-o", "out"]);
    assert!(said.contains("elastic mode 1 of the fixture") && said.contains("MAC 1.00"), "{said}");
    let ratios = &bench.json("new.json")["damping"]["modal_ratios"];
    for (ratio, truth) in ratios.as_array().unwrap().iter().zip([0.004, 0.006]) {
        assert!((ratio["value"].as_f64().unwrap() / truth - 1.0).abs() < 1e-4, "{ratio}");
        assert!(ratio["std"].as_f64().unwrap() > 0.0);
    }
    bench.done(&["synthesize", "new.json", "--lines", "2.5:1500:2.5", "-o", "again.uff"]);
    let values = |name: &str| match &bench.datasets(name)[0].data {
        Data::Complex(values) => values.clone(),
        _ => panic!("an FRF is complex"),
    };
    let (one, other): (Vec<Complex64>, Vec<Complex64>) = (values("frf.uff"), values("again.uff"));
    for (a, b) in one.iter().zip(other) {
        assert!((a - b).norm() < 1e-3 * a.norm());
    }
}

#[test]
fn the_analyst_overrules_band_orders_and_poles() {
    let bench = bench("modes-overruled");
    let all = bench.json_of(&["modes", "frf.uff", "--json", "--orders", "4:16"]);
    assert_eq!(all["stabilization"]["orders"], serde_json::json!([4, 16]));
    let first = all["modes"][0]["frequency"].as_f64().unwrap();
    let picked = bench.json_of(&["modes", "frf.uff", "--json", "--pick", &format!("{first:.1}")]);
    assert_eq!(picked["modes"].as_array().unwrap().len(), 1);
    let band = format!("{}:{}", 0.5 * first, 1.5 * first);
    let banded = bench.json_of(&["modes", "frf.uff", "--json", "--band", &band]);
    assert_eq!(banded["modes"].as_array().unwrap().len(), 1);
}

#[test]
fn what_holds_no_modes_is_refused_in_a_sentence() {
    let bench = bench("modes-refused");
    let modes = |more: &[&str], parts: &[&str]| {
        let arguments: Vec<&str> = ["modes", "frf.uff", "-o", "out"].iter().chain(more).copied().collect();
        bench.refused(&arguments, parts);
    };
    modes(&["--band", "5:15"], &["frf.uff", "widen the band"]);
    modes(&["--band", "1200:1450"], &["frf.uff", "nothing is stable"]);
    modes(&["--pick", "20000"], &["frf.uff", "20000 Hz", "nearest"]);
    modes(&["--orders", "9999"], &["frf.uff", "orders 2 to 9999"]);
    modes(&["--orders", "0"], &["such as 40 or 4:40"]);
    modes(&["--update", "new.json"], &["--fixture"]);
    bench.refused(&["modes", "none.uff", "-o", "out"], &["none.uff", "no such file"]);
    bench.refused(&["modes", "two.json", "-o", "out"], &["two.json", "is a JSON file"]);
    bench.refused(&["modes", "frf.uff"], &["--output"]);
    // A fixture of another structure.
    bench.write("stiff.json", bench.text("two.json").replace("3.67e-10", "3.67e-8"));
    modes(
        &["--fixture", "stiff.json", "--update", "new.json"],
        &["stiff.json", "none of the measured modes"],
    );
}

#[test]
fn noise_alone_is_refused_and_nodes_in_any_direction_do() {
    let bench = bench("modes-noise");
    bench.rewrite("frf.uff", "z.uff", |datasets| {
        for dataset in datasets.iter_mut() {
            dataset.response.direction = 3;
            dataset.reference.direction = -3;
        }
    });
    let file = bench.json_of(&["modes", "z.uff", "--json"]);
    assert_eq!(file["modes"].as_array().unwrap().len(), 2);
    let mut noise = Noise::from_state(1);
    let mut uniform = || noise.uniform() - 0.5;
    bench.rewrite("frf.uff", "noise.uff", |datasets| {
        for dataset in datasets.iter_mut() {
            let Data::Complex(values) = &mut dataset.data else { panic!("an FRF is complex") };
            values.iter_mut().for_each(|v| *v = Complex64::new(uniform(), uniform()));
        }
    });
    bench.refused(&["modes", "noise.uff", "-o", "out"], &["noise.uff", "nothing is stable"]);
}
