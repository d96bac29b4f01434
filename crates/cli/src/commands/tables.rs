//! `jointscope tables`: the paper's tables, paper beside program.

use std::path::PathBuf;

use clap::Args;
use jointscope::fem::MeshOptions;
use jointscope::tables::{Measured, Tables};

use crate::input;
use crate::output::{Outputs, pretty};
use crate::progress;
use crate::refusal::Refusal;

/// Options of `jointscope tables`.
#[derive(Debug, Args)]
pub(super) struct TablesArguments {
    /// Your own decomposition of an example (a directory with stiffness.json, made with `--relation paper`),
    /// for the column EXP.
    #[arg(long, value_name = "E2=DIR", num_args = 1.., value_parser = measured)]
    pub measured: Vec<(String, PathBuf)>,
    /// Leave the finite-element cells out.
    #[arg(long)]
    pub no_fem: bool,
    /// Print the numbers as JSON, in SI units and with their signs.
    #[arg(long)]
    pub json: bool,
    /// Write to a file and not to standard output.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// Computes the tables; answers with them, or with the file that holds them.
pub(super) fn run(arguments: &TablesArguments) -> Result<String, Refusal> {
    let mut measured = Vec::new();
    let mut inputs = Vec::new();
    for (example, directory) in &arguments.measured {
        let path = directory.join("stiffness.json");
        let decomposed = Measured::of(example, &input::json(&path)?);
        measured.push(decomposed.map_err(|error| Refusal::at(&path, error))?);
        inputs.push(path);
    }
    Outputs::foresee(&inputs, arguments.output.clone())?;
    let bar = progress::bar(1, "{bar:30} {pos}/{len} {msg} ({elapsed})", "tables");
    let mesh = MeshOptions::default();
    let mesh = (!arguments.no_fem).then_some(&mesh);
    let tables = Tables::of(mesh, measured, |name, index, count| {
        bar.set_length(count as u64);
        bar.set_message(name.to_owned());
        bar.set_position(index as u64);
    });
    drop(bar);
    let tables = tables.map_err(Refusal::new)?;
    let text = match arguments.json {
        true => pretty(&tables.to_value()),
        false => tables.to_text(),
    };
    match &arguments.output {
        None => Ok(text.trim_end().to_owned()),
        Some(path) => {
            let mut outputs = Outputs::new(&inputs);
            outputs.add(path, text);
            outputs.write()?;
            Ok(path.display().to_string())
        }
    }
}

/// Reads `EXAMPLE=DIR`.
fn measured(text: &str) -> Result<(String, PathBuf), String> {
    match text.split_once('=') {
        Some((example, directory)) if !example.is_empty() && !directory.is_empty() => {
            Ok((example.to_owned(), PathBuf::from(directory)))
        }
        _ => Err("an example and a directory with stiffness.json are needed, such as E2=out".to_owned()),
    }
}
