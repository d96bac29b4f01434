//! `jointscope synthesize`: a fixture file in, its FRFs out.

use clap::Args;
use jointscope::lumped::Instrument;

use crate::computed_frfs::ComputedFrfs;
use crate::input::FixtureFile;
use crate::refusal::Refusal;

#[derive(Debug, Args)]
pub(super) struct SynthesizeArguments {
    #[command(flatten)]
    frfs: ComputedFrfs,
    /// As a perfect instrument would read them, without the effects of sensors and analyser.
    #[arg(long)]
    perfect: bool,
}

/// Computes the FRFs and writes them; answers with what was written.
pub(super) fn run(arguments: &SynthesizeArguments) -> Result<String, Refusal> {
    let SynthesizeArguments { frfs: asked, perfect } = arguments;
    let fixture = FixtureFile::read(&asked.fixture)?;
    let instrument = if *perfect { Instrument::Perfect } else { Instrument::AsRecorded };
    let frfs = jointscope::synthesize(&fixture, &asked.pairs(&fixture)?, &asked.lines, instrument)
        .map_err(|error| fixture.refusal(error))?;
    asked.outputs(&fixture, &frfs)?.write()?;
    Ok(asked.written(&frfs))
}
