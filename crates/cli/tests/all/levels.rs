//! `diagnose` of stepped-sine FRFs at several levels, from files to files.

use crate::common::Bench;
use jointscope::fixture::Fixture;
use jointscope::recordings::to_datasets;
use jointscope::spectra::{FrfPair, SpectralLines};
use jointscope::uff::{Dataset58, Encoding};
use jointscope_rig::{Control, SteppedSines, generator};
use jointscope_samples::with;

/// Two storeys with one elastic mode at 232.6 Hz.
pub(crate) const STOREYS: &str = r#"{
  "name": "two storeys",
  "bodies": { "low": { "mass": 2.0, "rotates": false }, "high": { "mass": 3.0, "rotates": false } },
  "points": { "1": { "body": "low", "x": 0 }, "2": { "body": "high", "x": 0.1 } },
  "joints": { "C": { "from": "1", "to": "2", "stiffness": [[2.563e6, 0], [0, 0]], "damping": [[20.0, 0], [0, 0]] } } }"#;

pub(crate) const CUBIC: &str =
    r#"{ "kind": "cubic_stiffness", "place": "C", "dof": "translation", "stiffness3": 1.5e13 }"#;

/// FRFs 2/2 and 1/2 of the storeys with `physics` at levels of held response, m/s², with 0.5 % noise.
fn recorded(physics: &str, levels: &[f64]) -> Vec<Dataset58> {
    let fixture = Fixture::from_json(&with(STOREYS, &format!(r#""physics": [{physics}]"#))).unwrap();
    let lines = SpectralLines::even(222.0, 0.25, 101).unwrap();
    let test = SteppedSines { control: Control::Response, harmonics: 7, noise: 0.005 };
    let pairs = [FrfPair::transverse("2", "2"), FrfPair::transverse("1", "2")];
    let sets = test.record(&fixture, &pairs, levels, &lines, &mut generator(3)).unwrap();
    let mut all = Vec::new();
    for (set, level) in sets.iter().zip(levels) {
        let mut datasets = to_datasets(set, "stepped sines", Encoding::default()).unwrap();
        datasets.iter_mut().for_each(|d| d.id_lines[3] = format!("response {level} m/s^2"));
        all.extend(datasets);
    }
    all
}

pub(crate) fn bench(name: &str, physics: &str, levels: &[f64]) -> Bench {
    let bench = Bench::new(name);
    bench.write("storeys.json", STOREYS);
    bench.write("levels.uff", jointscope::uff::write(&recorded(physics, levels)).unwrap());
    bench
}

pub(crate) const DIAGNOSE: [&str; 5] = ["diagnose", "storeys.json", "levels.uff", "-o", "out"];

#[test]
fn a_cubic_spring_is_named_from_levels_with_an_interval_that_holds_it() {
    let bench = bench("levels-cubic", CUBIC, &[10.0, 30.0, 50.0, 80.0]);
    let said = bench.done(&DIAGNOSE);
    assert!(said.contains("the frequency rises from"), "{said}");
    let found = bench.json("out/diagnosis.json");
    assert_eq!(found["verdict"], "explained");
    let finding = &found["findings"][0];
    assert_eq!((&finding["kind"], &finding["place"]), (&"cubic_stiffness".into(), &"C".into()));
    let ends: Vec<f64> = finding["parameters"]["stiffness3"]["ci95"]
        .as_array()
        .unwrap()
        .iter()
        .map(|v| v.as_f64().unwrap())
        .collect();
    assert!(ends[0] < 1.5e13 && 1.5e13 < ends[1] && ends[1] < 1.2 * ends[0], "{ends:?}");
    let chi2 = |model: &str| found["fit"]["chi2_per_dof"][model].as_f64().unwrap();
    assert!(chi2("refitted") > 10.0 && (0.5..2.0).contains(&chi2("repaired")), "{}", found["fit"]);
    assert_eq!(found["levels"].as_array().unwrap().len(), 4);
    assert_eq!(bench.json("out/repaired.json")["physics"][0]["kind"], "cubic_stiffness");
    let page = bench.text("out/report.html");
    assert!(page.contains("Frequency and damping against amplitude") && !page.contains("± 0.000<"), "digits");
    // The axis of motions and the column of them are in one unit.
    let unit = page.split("Relative motion of joint C in translation\",\"unit\":\"").nth(1).unwrap();
    let unit = unit.split('"').next().unwrap();
    let heading = page.split("relative motion").nth(1).unwrap().split("</th>").next().unwrap();
    assert!(unit.ends_with('m') && heading.contains(unit), "{unit}: {heading}");
}

#[test]
fn levels_of_a_linear_joint_are_diagnosed_as_one_set_of_frfs_with_the_remark() {
    let bench = bench("levels-linear", "", &[10.0, 40.0, 120.0]);
    let said = bench.done(&DIAGNOSE);
    assert!(said.contains("neither frequency nor damping changes beyond noise"), "{said}");
    assert!(said.contains("means over 3 levels"), "{said}");
    let found = bench.json("out/diagnosis.json");
    assert!(found["levels"].is_null(), "the linear diagnosis answers");
    assert_eq!(found["verdict"], "consistent", "{said}");
    assert!(found["notes"].to_string().contains("nothing depends on amplitude"), "{}", found["notes"]);
    let chi2 = found["fit"]["chi2_per_dof"]["refitted"].as_f64().unwrap();
    assert!((0.6..1.5).contains(&chi2), "{chi2}");
}

#[test]
fn what_a_linear_joint_lacks_is_found_from_its_levels() {
    let mass = r#"{ "kind": "added_mass", "place": "high", "x": 0.1, "mass": 0.2 }"#;
    let bench = bench("levels-mass", mass, &[10.0, 40.0, 120.0]);
    let said = bench.done(&DIAGNOSE);
    let found = bench.json("out/diagnosis.json");
    assert_eq!(found["verdict"], "explained", "{said}");
    assert!(bench.text("out/report.html").contains("nothing depends on amplitude"));
}

#[test]
fn levels_all_alike_are_diagnosed_by_their_frfs_and_amplitude_is_said_not_to_be_judged() {
    let bench = bench("levels-alike", CUBIC, &[10.0, 10.5]);
    let said = bench.done(&DIAGNOSE);
    assert!(
        said.contains("whether anything depends on amplitude could not be judged: the levels, 10 m/s^2"),
        "{said}"
    );
    assert!(said.contains("differ by less than a factor of 1.2"), "{said}");
}

#[test]
fn one_level_is_diagnosed_by_its_frfs_and_said_to_be_one() {
    let bench = bench("levels-one", "", &[40.0]);
    let said = bench.done(&DIAGNOSE);
    assert!(said.contains("the FRFs are those of one level (response 40 m/s^2)"), "{said}");
    assert_eq!(bench.json("out/diagnosis.json")["verdict"], "consistent", "{said}");
}

#[test]
fn levels_from_which_nothing_follows_are_refused_in_one_sentence() {
    let bench = bench("levels-bad", "", &[10.0, 40.0]);
    let refused = |change: &dyn Fn(&mut Vec<Dataset58>), parts: &[&str]| {
        bench.rewrite("levels.uff", "bad.uff", |datasets| change(datasets));
        bench.refused(&["diagnose", "storeys.json", "bad.uff", "-o", "out"], parts);
    };
    let relabel = |d: &mut [Dataset58], to: &str| {
        d.iter_mut().filter(|d| d.id_lines[3].contains("40")).for_each(|d| d.id_lines[3] = to.to_owned());
    };
    let mixed = "level 2 N holds one quantity and level 10 m/s^2 another";
    refused(&|d| relabel(d, "force 2 N"), &["bad.uff", mixed, "held response"]);
    refused(&|d| relabel(d, "response 10 m/s^2"), &["bad.uff", "was given already"]);
    // A unit that is none of the quantity's leaves the amplitude unstated.
    refused(&|d| relabel(d, "force 2 m/s^2"), &["bad.uff", "2 levels"]);
    refused(&|d| relabel(d, "response -3 m/s^2"), &["bad.uff", "2 levels"]);
    let band = ["diagnose", "storeys.json", "levels.uff", "--band", "230:231", "-o", "out"];
    bench.refused(&band, &["levels.uff", "fewer than 8 spectral lines"]);
}
