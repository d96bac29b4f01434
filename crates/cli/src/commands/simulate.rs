//! `jointscope simulate`: a fixture with amplitude-dependent effects and recorded forces in, response
//! histories out.

use std::path::PathBuf;

use clap::Args;
use jointscope::nonlinear::{DiagnoseError, Simulation, simulate};
use jointscope::recordings::{ReadOptions, hits_of, hits_to_datasets};
use jointscope::spectra::Channel;

use crate::computed_frfs::encoding;
use crate::input::{self, FixtureFile};
use crate::output::Outputs;
use crate::progress::notice;
use crate::refusal::Refusal;
use crate::values::one_channel;

#[derive(Debug, Args)]
pub(super) struct SimulateArguments {
    /// The fixture file (JSON).
    pub fixture: PathBuf,
    /// The forces (UFF time histories, ordinate type 13), one for each hit.
    #[arg(long, value_name = "F.uff")]
    pub force: PathBuf,
    /// Where to read accelerations, such as 3 4:theta [default: transverse at every point].
    #[arg(long, value_name = "POINT", value_parser = one_channel, num_args = 1..)]
    pub at: Vec<Channel>,
    /// Write the forces too, so that the file is a whole recording.
    #[arg(long)]
    pub with_force: bool,
    /// Write text (dataset 58) instead of binary (58b).
    #[arg(long)]
    pub ascii: bool,
    /// The universal file to write.
    #[arg(short, long, value_name = "R.uff")]
    pub output: PathBuf,
}

/// Error of the time steps above which it is said, relative to a response's rms.
const NOTABLE: f64 = 1e-4;

/// Simulates and writes the responses; answers with what was written.
pub(super) fn run(arguments: &SimulateArguments) -> Result<String, Refusal> {
    let SimulateArguments { fixture: path, force, at, with_force, ascii, output } = arguments;
    let fixture = FixtureFile::read(path)?;
    let sources = [input::source(force)?];
    let hits = hits_of(&sources, Some(&fixture), &ReadOptions::default()).map_err(Refusal::new)?;
    let channels: Vec<Channel> = match at.is_empty() {
        true => fixture.points().iter().map(|p| Channel::transverse(p.name.clone())).collect(),
        false => at.clone(),
    };
    Outputs::foresee([path, force], [output.clone()])?;
    let Simulation { hits: simulated, error } = simulate(&fixture, &hits.hits, &channels)
        .map_err(|error| fixture.refusal(DiagnoseError::from(error)))?;
    let datasets = hits_to_datasets(&simulated, fixture.name(), encoding(*ascii), *with_force)
        .map_err(|error| fixture.refusal(error))?;
    let mut outputs = Outputs::new([path, force]);
    outputs.add_datasets(output, &datasets)?;
    outputs.write()?;
    let names: Vec<String> = channels.iter().map(ToString::to_string).collect();
    hits.notes.iter().for_each(|note| notice(note));
    let mut lines = vec![format!(
        "{}: accelerations at {} under {} hits of {} samples; the time steps are right to {error:.0e} of each response",
        output.display(),
        names.join(", "),
        simulated.len(),
        simulated.iter().map(|hit| hit.samples()).max().unwrap_or(0),
    )];
    if error > NOTABLE {
        lines.push("the steps could not be made finer: take the responses with that much doubt".to_owned());
    }
    Ok(lines.join("\n"))
}
