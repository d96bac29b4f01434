//! The crates' floors, kept by what cargo itself says of their dependencies.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

/// Crates by floor, from the ground up: a crate stands only on crates of floors below its own.
const FLOORS: [&[&str]; 12] = [
    &["jointscope-cases", "jointscope-linalg", "jointscope-spectra", "jointscope-uff"],
    &[
        "jointscope-beam",
        "jointscope-fixture",
        "jointscope-averaging",
        "jointscope-frf",
        "jointscope-hits",
        "jointscope-import",
        "jointscope-inference",
        "jointscope-samples",
    ],
    &[
        "jointscope-damping",
        "jointscope-estimation",
        "jointscope-findings",
        "jointscope-recordings",
        "jointscope-schema",
        "jointscope-draft",
        "jointscope-tolerances",
    ],
    &["jointscope-fem", "jointscope-lumped", "jointscope-modes", "jointscope-rig"],
    &[
        "jointscope-comparison",
        "jointscope-decomposition",
        "jointscope-model-error",
        "jointscope-nonlinear",
        "jointscope-screening",
    ],
    &["jointscope-diagnosis", "jointscope-export", "jointscope-tables"],
    &["jointscope-wording"],
    &["jointscope-pipeline", "jointscope-plan"],
    &["jointscope-check", "jointscope-proof"],
    &["jointscope-report"],
    &["jointscope"],
    &["jointscope-cli", "jointscope-benches"],
];

struct Package {
    /// (name, whether only tests and benches need it).
    dependencies: Vec<(String, bool)>,
}

fn packages() -> BTreeMap<String, Package> {
    let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/../../Cargo.toml");
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--offline", "--format-version", "1", "--manifest-path", manifest])
        .output()
        .unwrap();
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let packages = metadata["packages"].as_array().unwrap().iter().map(|package| {
        let dependencies = package["dependencies"].as_array().unwrap().iter().map(|dependency| {
            (dependency["name"].as_str().unwrap().to_string(), dependency["kind"].as_str() == Some("dev"))
        });
        (package["name"].as_str().unwrap().to_string(), Package { dependencies: dependencies.collect() })
    });
    packages.collect()
}

fn floor(name: &str) -> Option<usize> {
    FLOORS.iter().position(|crates| crates.contains(&name))
}

#[test]
fn every_crate_has_a_floor_and_stands_only_on_floors_below() {
    for (name, package) in packages() {
        let own = floor(&name).unwrap_or_else(|| panic!("{name} has no floor"));
        for (dependency, only_tests) in &package.dependencies {
            if let (Some(below), false) = (floor(dependency), only_tests) {
                assert!(below < own, "{name} (floor {own}) stands on {dependency} (floor {below})");
            }
        }
    }
}

/// The names of the crates that stand on `library`, tests and benches aside.
fn standing_on(library: &str) -> Vec<String> {
    let names_it =
        |package: &Package| package.dependencies.iter().any(|(d, only_tests)| d == library && !only_tests);
    packages().into_iter().filter(|(_, package)| names_it(package)).map(|(name, _)| name).collect()
}

#[test]
fn the_program_depends_on_the_facade_only() {
    let program = &packages()["jointscope-cli"];
    let ours =
        program.dependencies.iter().filter(|(d, only_tests)| d.starts_with("jointscope") && !only_tests);
    assert_eq!(ours.map(|(d, _)| d.as_str()).collect::<Vec<_>>(), ["jointscope"]);
}

#[test]
fn nothing_but_tests_stands_on_the_samples_of_tests() {
    assert!(standing_on("jointscope-samples").is_empty(), "{:?}", standing_on("jointscope-samples"));
}

#[test]
fn one_crate_alone_names_the_library_behind_the_eigenproblem() {
    assert_eq!(standing_on("faer"), ["jointscope-linalg"]);
}

#[test]
fn one_crate_alone_names_the_library_behind_the_fourier_transform() {
    assert_eq!(standing_on("realfft"), ["jointscope-hits"]);
}

/// Everything that `name` is built of, tests and benches included for itself.
fn built_of(name: &str, packages: &BTreeMap<String, Package>) -> BTreeSet<String> {
    let mut all = BTreeSet::new();
    let mut open: Vec<(String, bool)> =
        packages[name].dependencies.iter().map(|(d, _)| (d.clone(), true)).collect();
    while let Some((dependency, _)) = open.pop() {
        let Some(package) = packages.get(&dependency) else { continue };
        if all.insert(dependency) {
            open.extend(package.dependencies.iter().filter(|(_, only_tests)| !only_tests).cloned());
        }
    }
    all
}

#[test]
fn the_simulated_laboratory_and_what_it_judges_share_no_model() {
    let packages = packages();
    let models = [
        "jointscope-beam",
        "jointscope-damping",
        "jointscope-lumped",
        "jointscope-decomposition",
        "jointscope-diagnosis",
        "jointscope-model-error",
        "jointscope-nonlinear",
    ];
    let laboratory = built_of("jointscope-rig", &packages);
    for model in models {
        assert!(!laboratory.contains(model), "jointscope-rig is built of {model}");
        assert!(!built_of(model, &packages).contains("jointscope-rig"), "{model} is built of jointscope-rig");
    }
}
