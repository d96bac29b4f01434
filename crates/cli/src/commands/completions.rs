//! `jointscope completions`: what a shell has to know to complete commands and options.

use clap::Args;
use clap_complete::{Shell, generate};

use crate::refusal::Refusal;

#[derive(Debug, Args)]
pub(super) struct CompletionsArguments {
    /// The shell.
    pub shell: Shell,
}

/// Prints the script for a program with these commands.
pub(super) fn run(arguments: &CompletionsArguments, mut program: clap::Command) -> Result<String, Refusal> {
    let mut script = Vec::new();
    generate(arguments.shell, &mut program, "jointscope", &mut script);
    Ok(String::from_utf8_lossy(&script).trim_end().to_owned())
}
