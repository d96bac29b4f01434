//! `jointscope compare`: decompositions in, their joints side by side and ranked out.

use std::path::PathBuf;

use clap::Args;
use jointscope::comparison::{Comparison, Decomposed, comparison_file};
use jointscope::report::comparison_page;

use crate::input;
use crate::origin;
use crate::output::Outputs;
use crate::refusal::Refusal;

/// Options of `jointscope compare`.
#[derive(Debug, Args)]
pub struct CompareArguments {
    /// Directories with the stiffness.json of a decomposition each; a joint is called by its directory.
    #[arg(required = true, value_name = "DIR")]
    pub directories: Vec<PathBuf>,
    /// The directory to write to.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
}

/// Compares and writes `comparison.json` and `report.html`; answers with the orders and where the page is.
pub fn run(arguments: &CompareArguments) -> Result<String, Refusal> {
    let files: Vec<PathBuf> =
        arguments.directories.iter().map(|directory| directory.join("stiffness.json")).collect();
    let names = names(&arguments.directories);
    let joint = |(name, path): (&String, &PathBuf)| {
        Decomposed::of(name, &input::json(path)?).map_err(|error| Refusal::at(path, error))
    };
    let joints = names.iter().zip(&files).map(joint).collect::<Result<Vec<_>, _>>()?;
    let comparison = Comparison::of(joints).map_err(Refusal::new)?;
    let context = origin::context(&files, Vec::new(), None)?;
    let page = comparison_page(&comparison, &context).map_err(Refusal::new)?;
    let page_path = arguments.output.join("report.html");
    let mut outputs = Outputs::new(&files);
    outputs.add_json(arguments.output.join("comparison.json"), &comparison_file(&comparison));
    outputs.add(&page_path, page);
    outputs.write()?;
    let mut lines =
        vec![format!("from the smallest magnitude to the largest, by {}", comparison.estimate_words())];
    lines.extend(comparison.rankings.iter().map(|entry| {
        let order: Vec<&str> =
            entry.ranking.order.iter().map(|i| comparison.joints[*i].name.as_str()).collect();
        // No order is certain.
        let probability = match entry.ranking.probability {
            p if p > 0.999 => "more than 0.999".to_owned(),
            p => format!("{p:.3}"),
        };
        format!(
            "{}{}{}: {} (right with a probability of {probability})",
            entry.kind.symbol(),
            entry.element.0 + 1,
            entry.element.1 + 1,
            order.join(" < "),
        )
    }));
    lines.push(page_path.display().to_string());
    Ok(lines.join("\n"))
}

/// The directories' last names; the whole paths of those that share one.
fn names(directories: &[PathBuf]) -> Vec<String> {
    let short = |path: &PathBuf| path.file_name().map(|name| name.to_string_lossy().into_owned());
    let name = |path: &PathBuf| {
        let alone = directories.iter().filter(|other| short(other) == short(path)).count() == 1;
        short(path).filter(|_| alone).unwrap_or_else(|| path.display().to_string())
    };
    directories.iter().map(name).collect()
}
