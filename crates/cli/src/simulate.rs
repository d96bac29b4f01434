//! `jointscope simulate`: a fixture with amplitude-dependent effects and recorded forces in, response histories out.

use jointscope::nonlinear::{DiagnoseError, Simulation, simulate};
use jointscope_recordings::{ReadOptions, hits_of, hits_to_datasets};
use jointscope_spectra::Channel;
use jointscope_uff::Encoding;

use crate::arguments::SimulateArguments;
use crate::input;
use crate::output::Outputs;
use crate::refusal::Refusal;

/// Error of the time steps above which it is said, relative to a response's rms.
const NOTABLE: f64 = 1e-4;

/// Simulates and writes the responses; answers with what was written.
pub fn run(arguments: &SimulateArguments) -> Result<String, Refusal> {
    let SimulateArguments { fixture: path, force, at, with_force, ascii, output } = arguments;
    let fixture = input::fixture(path)?;
    let sources = [input::source(force)?];
    let hits = hits_of(&sources, Some(&fixture), &ReadOptions::default()).map_err(Refusal::new)?;
    let channels: Vec<Channel> = match at.is_empty() {
        true => fixture.points().iter().map(|p| Channel::transverse(p.name.clone())).collect(),
        false => at.clone(),
    };
    let Simulation { hits: simulated, error } = simulate(&fixture, &hits.hits, &channels)
        .map_err(|error| Refusal::at(path, DiagnoseError::from(error)))?;
    let encoding = if *ascii { Encoding::Ascii } else { Encoding::default() };
    let datasets = hits_to_datasets(&simulated, fixture.name(), encoding, *with_force)
        .map_err(|error| Refusal::at(path, error))?;
    let bytes = jointscope_uff::write(&datasets).map_err(|error| Refusal::at(output, error))?;
    let mut outputs = Outputs::new([path, force]);
    outputs.add(output, bytes);
    outputs.write()?;
    let names: Vec<String> = channels.iter().map(ToString::to_string).collect();
    let mut lines = hits.notes;
    lines.push(format!(
        "{}: accelerations at {} under {} hits of {} samples; the time steps are right to {error:.0e} of each response",
        output.display(),
        names.join(", "),
        simulated.len(),
        simulated.iter().map(|hit| hit.samples()).max().unwrap_or(0),
    ));
    if error > NOTABLE {
        lines.push("the steps could not be made finer: take the responses with that much doubt".to_owned());
    }
    Ok(lines.join("\n"))
}
