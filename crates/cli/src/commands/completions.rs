//! `jointscope completions`: what a shell has to know to complete commands and options.

use clap::Args;
use clap_complete::{Shell, generate};

use super::Program;
use crate::refusal::Refusal;

#[derive(Debug, Args)]
pub(super) struct CompletionsArguments {
    /// The shell.
    pub shell: Shell,
}

/// Prints the script.
pub(super) fn run(arguments: &CompletionsArguments) -> Result<String, Refusal> {
    let mut script = Vec::new();
    generate(arguments.shell, &mut Program::arguments(), "jointscope", &mut script);
    Ok(String::from_utf8_lossy(&script).trim_end().to_owned())
}
