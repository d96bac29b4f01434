//! `jointscope synthesize`: a fixture file in, its FRFs out.

use jointscope_fixture::Fixture;
use jointscope_lumped::Instrument;
use jointscope_recordings::to_datasets;
use jointscope_spectra::FrfPair;
use jointscope_uff::Encoding;

use crate::arguments::SynthesizeArguments;
use crate::input;
use crate::output::{Outputs, frfs_written};
use crate::refusal::Refusal;

/// Computes the FRFs and writes them; answers with what was written.
pub fn run(arguments: &SynthesizeArguments) -> Result<String, Refusal> {
    let SynthesizeArguments { fixture: path, frf, lines, perfect, ascii, output } = arguments;
    let fixture = input::fixture(path)?;
    let about_fixture = |error: &dyn std::fmt::Display| Refusal::at(path, error);
    let pairs =
        if frf.is_empty() { default_pairs(&fixture).map_err(|e| about_fixture(&e))? } else { frf.clone() };
    let instrument = if *perfect { Instrument::Perfect } else { Instrument::AsRecorded };
    let encoding = if *ascii { Encoding::Ascii } else { Encoding::default() };
    let frfs = jointscope_lumped::synthesize(&fixture, &pairs, lines, instrument)
        .map_err(|error| about_fixture(&error))?;
    let datasets = to_datasets(&frfs, fixture.name(), encoding).map_err(|error| about_fixture(&error))?;
    let bytes = jointscope_uff::write(&datasets).map_err(|error| Refusal::at(output, error))?;
    let mut outputs = Outputs::new([path]);
    outputs.add(output, bytes);
    outputs.write()?;
    Ok(frfs_written(output, &frfs))
}

/// The paper's four FRFs, across the joint between points 2 and 3.
const DEFAULT_PAIRS: [(&str, &str); 4] = [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")];

/// The FRFs computed where none are named.
pub fn default_pairs(fixture: &Fixture) -> Result<Vec<FrfPair>, String> {
    if ["1", "2", "3", "4"].iter().all(|point| fixture.point(point).is_some()) {
        return Ok(DEFAULT_PAIRS
            .iter()
            .map(|(response, reference)| FrfPair::transverse(response, reference))
            .collect());
    }
    let names: Vec<&str> = fixture.points().iter().map(|point| point.name.as_str()).collect();
    let (Some(first), Some(last)) = (names.first(), names.last()) else {
        return Err("the fixture has no points, so there is no FRF to compute".to_owned());
    };
    Err(format!(
        "the default FRFs 4/1, 3/1, 4/2, 3/2 need points 1 to 4, and the fixture has {}; choose FRFs with `--frf`, such as `--frf {last}/{first}`",
        names.join(", ")
    ))
}
