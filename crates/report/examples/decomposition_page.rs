//! Decomposes a recording for a joint and writes its page.
//!
//! `cargo run -p jointscope-report --example decomposition_page -- fixture.json hammer-test.uff page.html [joint] [paper]`

use jointscope_decomposition::{Analysis, AnalysisOptions, Relation};
use jointscope_fixture::Fixture;
use jointscope_recordings::{ReadOptions, Recording, Source};
use jointscope_report::{InputFile, PageContext, decomposition_report};
use jointscope_uff::read;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [fixture_path, recording_path, page_path, rest @ ..] = arguments.as_slice() else {
        return Err("give a fixture file, a recording and the page to write".into());
    };
    let fixture = Fixture::from_json(&std::fs::read_to_string(fixture_path)?)?;
    let file = read(&std::fs::read(recording_path)?)?;
    let source = Source { name: recording_path.clone(), file };
    let recording = Recording::of(&[source], &fixture, &ReadOptions::default())?;
    let relation = if rest.iter().any(|r| r == "paper") { Relation::Paper } else { Relation::Exact };
    let options = AnalysisOptions {
        joint: rest.iter().find(|r| *r != "paper").cloned(),
        relation,
        ..AnalysisOptions::default()
    };
    let analysis = Analysis::of(&fixture, recording.frfs()?, &options)?;
    let input = |path: &str| {
        let name = path.rsplit('/').next().unwrap_or(path);
        InputFile { name: name.to_owned(), sha256: "not taken by this example".to_owned() }
    };
    let context = PageContext {
        program: format!("jointscope {}", env!("CARGO_PKG_VERSION")),
        command: "jointscope decompose fixture.json test.uff -o out".to_owned(),
        inputs: vec![input(fixture_path), input(recording_path)],
        notes: recording.notes.clone(),
        hits: None,
    };
    std::fs::write(page_path, decomposition_report(&analysis, &fixture, &context).html()?)?;
    Ok(())
}
