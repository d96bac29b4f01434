//! `jointscope estimate`: hammer hits in, FRFs with coherence out.

use jointscope::estimation::{Estimate, ResponseWindow};
use jointscope_recordings::to_datasets;
use jointscope_uff::{Dataset58, Encoding, FunctionType};

use crate::arguments::EstimateArguments;
use crate::input;
use crate::measured::{Unreadable, estimated, what_was_estimated};
use crate::output::Outputs;
use crate::refusal::Refusal;

/// Estimates the FRFs and writes them; answers with what was seen in the hits and what was written.
pub fn run(arguments: &EstimateArguments) -> Result<String, Refusal> {
    let EstimateArguments { recording, estimation, ascii, output } = arguments;
    let sources = input::sources(recording)?;
    let (hits, estimate) = estimated(recording, estimation, &sources, None, ResponseWindow::None).map_err(
        |error| match error {
            Unreadable::Map(error) => Refusal::new(error),
            Unreadable::Else(refusal) => refusal,
        },
    )?;
    let encoding = if *ascii { Encoding::Ascii } else { Encoding::default() };
    let name = test_name(&sources);
    let mut datasets =
        to_datasets(&estimate.frfs, &name, encoding).map_err(|error| Refusal::at(output, error))?;
    let estimator = estimation.options(ResponseWindow::None).estimator.name();
    state_origin(&mut datasets, &estimate, estimator);
    let bytes = jointscope_uff::write(&datasets).map_err(|error| Refusal::at(output, error))?;
    let mut outputs = Outputs::new(&recording.files);
    outputs.add(output, bytes);
    outputs.write()?;
    let mut lines = hits.notes;
    lines.push(what_was_estimated(
        &estimate,
        &estimate.frfs,
        estimation.options(ResponseWindow::None).estimator,
    ));
    for excitation in &estimate.excitations {
        lines.push(format!(
            "the hits at {} excite up to {:.0} Hz, where their force has fallen by 20 dB or the anti-alias filter begins",
            excitation.struck, excitation.usable_to
        ));
    }
    lines.extend(estimate.remarks.iter().cloned());
    lines.push(output.display().to_string());
    Ok(lines.join("\n"))
}

/// The first ID line of the recordings, which names the test.
fn test_name(sources: &[jointscope_recordings::Source]) -> String {
    let mut datasets = sources.iter().flat_map(|source| &source.file.datasets);
    let history = datasets.find(|dataset| dataset.function == FunctionType::TimeResponse);
    history.map_or_else(String::new, |dataset| dataset.id_lines[0].clone())
}

/// ID line 2: estimator and hits. ID line 3: the exponential window, which whoever reads the FRFs must know of.
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
