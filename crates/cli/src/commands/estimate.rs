//! `jointscope estimate`: hammer hits in, FRFs with coherence out.

use std::path::PathBuf;

use clap::Args;
use jointscope::Says;
use jointscope::estimation::{Estimate, EstimateError, ResponseWindow};
use jointscope::pipeline::{Error, HammerTest};
use jointscope::recordings::{hits_of, to_datasets};
use jointscope::spectra::in_sentence;
use jointscope::uff::{Dataset58, FunctionType};

use crate::computed_frfs::encoding;
use crate::estimation_arguments::EstimationArguments;
use crate::output::Outputs;
use crate::progress::notice;
use crate::recording::RecordingArguments;
use crate::refusal::Refusal;

#[derive(Debug, Args)]
pub(super) struct EstimateArguments {
    #[command(flatten)]
    pub recording: RecordingArguments,
    /// Write text (dataset 58) instead of binary (58b).
    #[arg(long)]
    pub ascii: bool,
    /// The universal file to write.
    #[arg(short, long, value_name = "F.uff")]
    pub output: PathBuf,
    #[command(flatten)]
    pub estimation: EstimationArguments,
}

/// Estimates the FRFs and writes them; answers with what was seen in the hits and what was written.
pub(super) fn run(arguments: &EstimateArguments) -> Result<String, Refusal> {
    let EstimateArguments { recording, estimation, ascii, output } = arguments;
    let sources = recording.sources()?;
    let hits = hits_of(&sources, None, &recording.options()?)
        .map_err(|error| recording.unreadable(error.into(), None))?;
    let options = estimation.options(ResponseWindow::None);
    Outputs::foresee(&recording.files, [output.clone()])?;
    let test = HammerTest::of(&hits.hits, &options).map_err(|error| match error {
        EstimateError::Window { .. } => Refusal::new(error),
        error => recording.refusal(Error::from(error)),
    })?;
    let estimate = &test.estimate;
    let name = test_name(&sources);
    let mut datasets =
        to_datasets(&estimate.frfs, &name, encoding(*ascii)).map_err(|error| Refusal::at(output, error))?;
    state_origin(&mut datasets, estimate, options.estimator.name());
    let mut outputs = Outputs::new(&recording.files);
    outputs.add_datasets(output, &datasets)?;
    outputs.write()?;
    hits.notes.iter().for_each(|note| notice(note));
    let mut lines = vec![test.says(&estimate.frfs, options.estimator)];
    for excitation in &estimate.excitations {
        lines.push(format!(
            "the hits at {} excite up to {} Hz, where their force has fallen by 20 dB or the anti-alias filter begins",
            excitation.struck, in_sentence(excitation.usable_to)
        ));
    }
    lines.extend(estimate.remarks.iter().map(Says::says));
    lines.push(output.display().to_string());
    Ok(lines.join("\n"))
}

/// The first ID line of the recordings, which names the test.
fn test_name(sources: &[jointscope::recordings::Source]) -> String {
    let mut datasets = sources.iter().flat_map(|source| &source.file.datasets);
    let history = datasets.find(|dataset| dataset.function == FunctionType::TimeResponse);
    history.map_or_else(String::new, |dataset| dataset.id_lines[0].clone())
}

/// ID line 2: estimator and hits. ID line 3: the exponential window, which whoever reads the FRFs must know
/// of.
fn state_origin(datasets: &mut [Dataset58], estimate: &Estimate, estimator: &str) {
    for dataset in datasets {
        let reference = dataset.reference.number.to_string();
        let of_point = |e: &&jointscope::estimation::Excitation| e.struck.point == reference;
        if let Some(excitation) = estimate.excitations.iter().find(of_point) {
            let hits: Vec<String> = excitation.hits.iter().map(u32::to_string).collect();
            let line = format!("{estimator} of hits {}", hits.join(" "));
            dataset.id_lines[1] = line.chars().take(80).collect();
        }
        if estimate.decay > 0.0 {
            dataset.id_lines[2] = format!("exponential window {} 1/s", estimate.decay);
        }
    }
}
