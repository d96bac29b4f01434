//! Packs concealed cases as files: what the diagnosis is given in directories of their own, what is true in one file under seal.
//!
//!     cargo run --release -p jointscope-proof --example conceal -- DIRECTORY CASES GRADED SEED FAMILY…

use jointscope_proof::{Answers, FAMILIES, NoAnswer, Plan, Precision, Truth};
use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [directory, cases, graded, seed, families @ ..] = arguments.as_slice() else {
        return Err("usage: conceal DIRECTORY CASES GRADED SEED FAMILY…".into());
    };
    let named = |(name, family): (&str, _)| families.iter().any(|f| f == name).then_some(family);
    let plan = Plan {
        cases: cases.parse()?,
        graded: graded.parse()?,
        seed: seed.parse()?,
        families: FAMILIES.into_iter().filter_map(named).collect(),
        ..Plan::default()
    };
    let (cases, sealed) = plan.draw()?;
    let digest = sealed.digest().to_owned();
    let directory = PathBuf::from(directory);
    for (number, case) in cases.iter().enumerate() {
        let folder = directory.join(format!("{number:02}"));
        std::fs::create_dir_all(&folder)?;
        std::fs::write(folder.join("fixture.json"), case.believed.to_json())?;
        // Rounding to single precision is 6e-8 of a value; the noise is 1e-3 of it and more.
        std::fs::write(folder.join("hammer-test.uff"), case.recording(Precision::Single)?)?;
    }
    let silent = Answers::by(&cases, 1, |_| (), |_| Err(NoAnswer::BrokeDown));
    let truths = sealed.open(&silent).ok_or("the seal does not open")?;
    let values = serde_json::Value::Array(truths.iter().map(Truth::to_value).collect());
    std::fs::write(directory.join("truths.json"), values.to_string())?;
    println!("{digest}");
    Ok(())
}
