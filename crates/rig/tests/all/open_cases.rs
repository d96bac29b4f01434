//! The laboratory against recordings made by an independent simulation, where those are at hand.

use crate::common::{chi_squared, frfs_in, largest_error};
use jointscope_fixture::Fixture;
use jointscope_rig::{HammerSetup, Instrument, frfs, smoothed_variance};
use jointscope_spectra::FrfSet;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

fn open_cases() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/concealed/open");
    let Ok(entries) = fs::read_dir(&folder) else {
        println!("no recordings at {}: nothing to compare with", folder.display());
        return Vec::new();
    };
    let mut cases: Vec<PathBuf> =
        entries.flatten().map(|e| e.path()).filter(|p| p.join("truth.json").exists()).collect();
    cases.sort();
    cases
}

fn json(path: PathBuf) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// The fixture with every quantity at its true value and the linear effects as its physics.
fn truth(case: &Path) -> (Fixture, Value) {
    let truth = json(case.join("truth.json"));
    let mut fixture = json(case.join("fixture.json"));
    let linear =
        |effect: &&Value| !["cubic_stiffness", "friction", "gap"].contains(&effect["kind"].as_str().unwrap());
    let effects = truth["effects"].as_array().unwrap().iter().filter(linear).cloned().collect();
    fixture["physics"] = Value::Array(effects);
    let mut fixture = Fixture::from_value(&fixture).unwrap();
    let values = truth["true_quantities"].as_object().unwrap();
    let mut used = 0;
    for entry in fixture.quantities_mut() {
        if let Some(value) = values.get(&entry.path) {
            entry.quantity.value = value["true"].as_f64().unwrap();
            used += 1;
        }
    }
    assert_eq!(used, values.len(), "{}: a true quantity has no place in the fixture", case.display());
    (fixture, truth)
}

#[test]
fn what_a_perfect_instrument_reads_is_what_the_independent_simulation_says() {
    for case in open_cases() {
        let (fixture, truth) = truth(&case);
        let unseen = frfs_in(&fs::read(case.join("unseen.uff")).unwrap(), &fixture);
        let ours = frfs(&fixture, unseen.pairs(), unseen.lines(), Instrument::Perfect).unwrap();
        let error = largest_error(&unseen, &ours.to_form(unseen.form()).unwrap());
        println!("{} {:40} largest error / rms {error:.1e}", truth["id"], kinds(&truth));
        let allowed = match kinds(&truth).as_str() {
            // There the strip was a mesh of six elements; with as many here the difference is 6e-10.
            "joint_mass" => 2e-3,
            // Four millionths in the mode's deflection, just below a resonance.
            "body_flexibility" => 5e-4,
            _ => 1e-8,
        };
        assert!(error < allowed, "{}: {error}", truth["id"]);
    }
}

#[test]
fn what_was_recorded_is_the_truth_within_its_noise() {
    for case in open_cases() {
        let (fixture, truth) = truth(&case);
        let Ok(bytes) = fs::read(case.join("frf.uff")) else { continue };
        let recorded = frfs_in(&bytes, &fixture);
        let ours = frfs(&fixture, recorded.pairs(), recorded.lines(), Instrument::AsDescribed).unwrap();
        let (chi2, dof) = chi_squared(&recorded, &ours, 10);
        println!("{} {:40} chi2/dof {:.3}", truth["id"], kinds(&truth), chi2 / dof);
        assert!((chi2 / dof - 1.0).abs() < 0.12, "{}: {}", truth["id"], chi2 / dof);
    }
}

#[test]
fn the_noise_of_a_simulated_test_is_that_of_the_independent_one() {
    for case in open_cases() {
        let (fixture, truth) = truth(&case);
        let Ok(bytes) = fs::read(case.join("frf.uff")) else { continue };
        let recorded = frfs_in(&bytes, &fixture);
        let setting = |name: &str| truth["measurement"][name].as_f64().unwrap();
        let hammer = HammerSetup {
            averages: setting("averages") as u32,
            noise_response: setting("noise_response"),
            noise_force: setting("noise_force"),
            corner: setting("corner"),
            spread: setting("spread"),
            common_hits: false,
            seed: 1,
        };
        let noise_free = frfs(&fixture, recorded.pairs(), recorded.lines(), Instrument::AsDescribed).unwrap();
        let ours = hammer.measure(&noise_free).unwrap();
        let size = |set: &FrfSet| -> f64 {
            (0..set.pairs().len()).map(|i| smoothed_variance(set, i, 10).unwrap().iter().sum::<f64>()).sum()
        };
        let ratio = (size(&ours) / size(&recorded)).sqrt();
        println!("{} noise relative to the recording's {ratio:.2}", truth["id"]);
        assert!((0.6..1.6).contains(&ratio), "{}: {ratio}", truth["id"]);
    }
}

fn kinds(truth: &Value) -> String {
    let effects = truth["effects"].as_array().unwrap();
    let names: Vec<&str> = effects.iter().map(|e| e["kind"].as_str().unwrap()).collect();
    if names.is_empty() { "-".to_string() } else { names.join(" + ") }
}
