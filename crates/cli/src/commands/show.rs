//! `jointscope show`: what files hold, before anything is made of it.

use std::path::PathBuf;

use clap::Args;
use jointscope::recordings::Contents;
use serde_json::{Value, json};

use crate::output::pretty;
use crate::recording::{ReadingArguments, RecordingArguments, column_entry};
use crate::refusal::Refusal;

#[derive(Debug, Args)]
pub(super) struct ShowArguments {
    /// The files (UFF, UNV, CSV, MAT); `-` is standard input.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Which column of a CSV file or variable of a MATLAB file is which FRF, such as "H1=4/1 [m/s^2/N]".
    #[arg(long, value_name = "NAME=OUT/IN [UNIT]", value_parser = column_entry, num_args = 1..)]
    pub columns: Vec<String>,
    /// Print what there is as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Answers with functions, units, geometry and modes of each file.
pub(super) fn run(arguments: &ShowArguments) -> Result<String, Refusal> {
    let columns = arguments.columns.clone();
    let sources = RecordingArguments {
        files: arguments.files.clone(),
        reading: ReadingArguments { columns, ..Default::default() },
    }
    .sources()?;
    let contents = sources.iter().map(|source| (source, Contents::of(std::slice::from_ref(source))));
    if arguments.json {
        let files: Value =
            contents.map(|(source, held)| json!({ "file": source.name, "holds": held })).collect();
        return Ok(pretty(&json!({ "files": files })).trim_end().to_owned());
    }
    let mut lines = Vec::new();
    for (source, held) in contents {
        let said = held.says();
        lines.push(format!("{}:", source.name));
        lines.extend(said.into_iter().map(|line| format!("  {line}")));
        if lines.last().is_some_and(|line| !line.starts_with(' ')) {
            lines.push("  nothing".to_owned());
        }
    }
    Ok(lines.join("\n"))
}
