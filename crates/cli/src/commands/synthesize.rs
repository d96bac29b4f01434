//! `jointscope synthesize`: a fixture file in, its FRFs out, as computed or as a hammer test would read them.

use clap::Args;
use jointscope::FrfSet;
use jointscope::lumped::Instrument;
use jointscope::rig::HammerSetup;
use jointscope::spectra::in_text;

use crate::computed_frfs::ComputedFrfs;
use crate::input::FixtureFile;
use crate::refusal::Refusal;
use crate::values::percent;

#[derive(Debug, Args)]
pub(super) struct SynthesizeArguments {
    #[command(flatten)]
    frfs: ComputedFrfs,
    /// As a perfect instrument would read them, without the effects of sensors and analyser.
    #[arg(long)]
    perfect: bool,
    #[command(flatten)]
    noise: NoiseArguments,
}

/// The noise of a hammer test.
#[derive(Debug, Args)]
struct NoiseArguments {
    /// As a hammer test reads them, with coherence: noise of every blow, in per cent of each response's rms
    /// over the lines, and a tenth of that on the force.
    #[arg(long, value_name = "PERCENT", value_parser = percent, allow_negative_numbers = true)]
    noise: Option<f64>,
    /// Blows averaged for an FRF (with `--noise`).
    #[arg(long, value_name = "N", requires = "noise", default_value_t = 10, allow_negative_numbers = true,
        value_parser = clap::value_parser!(u32).range(2..=10_000))]
    averages: u32,
    /// Seed of the noise (with `--noise`): the same seed gives the same file.
    #[arg(long, value_name = "N", requires = "noise", default_value_t = 1, allow_negative_numbers = true)]
    seed: u64,
}

/// Computes the FRFs and writes them; answers with what was written.
pub(super) fn run(arguments: &SynthesizeArguments) -> Result<String, Refusal> {
    let SynthesizeArguments { frfs: asked, perfect, noise } = arguments;
    let fixture = FixtureFile::read(&asked.fixture)?;
    let instrument = if *perfect { Instrument::Perfect } else { Instrument::AsRecorded };
    let frfs = jointscope::synthesize(&fixture, &asked.pairs(&fixture)?, &asked.lines, instrument)
        .map_err(|error| fixture.refusal(error))?;
    let Some(percent) = noise.noise else {
        asked.outputs(&fixture, &frfs, None)?.write()?;
        return Ok(asked.written(&frfs));
    };
    let measured = noise.measured(percent, &frfs).map_err(|error| fixture.refusal(error))?;
    let stated = noise.stated(percent);
    asked.outputs(&fixture, &measured, Some(&stated))?.write()?;
    Ok(format!(
        "{}\n{stated}: on average each FRF is off by {:.2} % of its rms",
        asked.written(&measured),
        100.0 * off(&frfs, &measured)
    ))
}

impl NoiseArguments {
    /// H1 and coherence of the blows.
    fn measured(&self, percent: f64, frfs: &FrfSet) -> Result<FrfSet, jointscope::rig::HammerError> {
        let hz = frfs.lines().hz();
        HammerSetup::ordinary(percent / 100.0, self.averages, hz[hz.len() - 1], self.seed).measure(frfs)
    }

    /// What makes the same file again: ID line 2.
    fn stated(&self, percent: f64) -> String {
        format!("noise {} %, {} averages, seed {}", in_text(percent), self.averages, self.seed)
    }
}

/// Rms error of the FRFs, each relative to its own rms.
fn off(truth: &FrfSet, measured: &FrfSet) -> f64 {
    let count = truth.pairs().len();
    let of_frf = |frf: usize| {
        let (truth, measured) = (truth.values(frf), measured.values(frf));
        let error: f64 = truth.iter().zip(measured).map(|(a, b)| (a - b).norm_sqr()).sum();
        let size: f64 = truth.iter().map(|value| value.norm_sqr()).sum();
        if size > 0.0 { error / size } else { 0.0 }
    };
    ((0..count).map(of_frf).sum::<f64>() / count.max(1) as f64).sqrt()
}
