//! Diagnoses recorded cases whose truth lies beside them, and compares.
//!
//! `cargo run --release -p jointscope --example diagnose_cases -- DIR…`: each folder holds `fixture.json`,
//! `frf.uff` and `truth.json` with `effects` and `accepted` (names that the data cannot tell from the truth).
//! Folders without FRFs are left out.
#![allow(clippy::unwrap_used)]

use jointscope::Fixture;
use jointscope::diagnosis::{Observation, Search};
use jointscope::fixture::{Dof, Effect};
use std::path::Path;

fn main() {
    let (mut right, mut all) = (0, 0);
    for folder in std::env::args().skip(1) {
        let folder = Path::new(&folder);
        let Ok(bytes) = std::fs::read(folder.join("frf.uff")) else { continue };
        let text = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
        let fixture = Fixture::from_json(&text("fixture.json")).unwrap();
        let truth: serde_json::Value = serde_json::from_str(&text("truth.json")).unwrap();
        let recording = jointscope::read(&fixture, &bytes).unwrap();
        let observation = Observation::new(recording.frfs().unwrap(), |_| true).unwrap();
        let start = std::time::Instant::now();
        let search = Search::of(&fixture, &observation, false).unwrap();
        let seconds = start.elapsed().as_secs_f64();
        let found = search.repaired.hypothesis.effects();
        let hidden = truth["effects"].as_array().unwrap();
        let accepted = truth["accepted"].as_array().unwrap();
        let named = |effect: &Effect| accepted.iter().chain(hidden).any(|name| is(effect, name));
        let correct = found.len() == hidden.len() && found.iter().all(named);
        (right, all) = (right + usize::from(correct), all + 1);
        let names: Vec<String> = found.iter().map(describe).collect();
        println!(
            "{} {} in {seconds:.1} s: objective {:.0} nominal, {:.1} refitted, {:.1} repaired of {}; found [{}]",
            folder.file_name().unwrap_or_default().to_string_lossy(),
            if correct { "right" } else { "WRONG" },
            search.nominal.objective,
            search.refitted.objective,
            search.repaired.objective,
            observation.degrees(),
            names.join(", ")
        );
    }
    println!("{right} of {all} right");
}

fn is(effect: &Effect, name: &serde_json::Value) -> bool {
    name["kind"] == effect.kind.name()
        && name["place"] == effect.place.to_string().as_str()
        && name["dof"].as_str() == effect.dof.map(Dof::name)
}

fn describe(effect: &Effect) -> String {
    let values: Vec<String> = effect.parameters.iter().map(|p| format!("{:.4e}", p.value)).collect();
    format!(
        "{} {} {} {}",
        effect.kind.name(),
        effect.place,
        effect.dof.map_or("", Dof::name),
        values.join(" ")
    )
}
