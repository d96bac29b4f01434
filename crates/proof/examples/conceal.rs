//! Packs concealed cases as files: what the diagnosis is given in directories of their own, what is true in one file under seal.
//!
//!     cargo run --release -p jointscope-proof --example conceal -- DIRECTORY CASES GRADED SOLID STRUCK SEED FAMILY…

use jointscope_proof::{FAMILIES, Plan, Precision, Replies, Sealable};
use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [directory, cases, graded, solid, struck, seed, families @ ..] = arguments.as_slice() else {
        return Err("usage: conceal DIRECTORY CASES GRADED SOLID STRUCK SEED FAMILY…".into());
    };
    let named = |(name, family): (&str, _)| families.iter().any(|f| f == name).then_some(family);
    let plan = Plan {
        cases: cases.parse()?,
        graded: graded.parse()?,
        solid: solid.parse()?,
        struck: struck.parse()?,
        seed: seed.parse()?,
        families: FAMILIES.into_iter().filter_map(named).collect(),
        ..Plan::default()
    };
    let (questions, sealed) = plan.draw_routes()?;
    let digest = sealed.digest().to_owned();
    let directory = PathBuf::from(directory);
    // Rounding to single precision is 6e-8 of a value; the noise is 1e-3 of it and more.
    for (number, asked) in questions.all().into_iter().enumerate() {
        let folder = directory.join(format!("{number:02}"));
        std::fs::create_dir_all(&folder)?;
        std::fs::write(folder.join("fixture.json"), asked.believed().to_json())?;
        std::fs::write(folder.join("hammer-test.uff"), asked.recording(Precision::Single)?)?;
    }
    let truths = sealed.open(&Replies::none(&questions)).ok_or("the seal does not open")?;
    let values = serde_json::Value::Array(truths.iter().map(Sealable::to_value).collect());
    std::fs::write(directory.join("truths.json"), values.to_string())?;
    println!("{digest}");
    Ok(())
}
