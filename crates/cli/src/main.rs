//! The `jointscope` program: arguments, files and exit codes. What is computed is computed by the crates below.
//!
//! Exit status 0: done. 2: bad usage or bad input, with one plain sentence on standard error and nothing half-written.

mod arguments;
mod compare;
mod decompose;
mod diagnose;
mod diagnose_hits;
mod diagnose_levels;
mod diagnosed;
mod estimate;
mod estimation_arguments;
mod fem;
mod input;
mod measured;
mod modes;
mod output;
mod prove;
mod prove_recordings;
mod refusal;
mod simulate;
mod synthesize;
mod tables;

use std::io::Write;
use std::process::ExitCode;

use arguments::{Command, Program};
use clap::Parser;
use refusal::Refusal;

fn main() -> ExitCode {
    let program = match Program::try_parse() {
        Ok(program) => program,
        // Help and version are no errors.
        Err(answer) if !answer.use_stderr() => {
            say(&answer.render().to_string());
            return ExitCode::SUCCESS;
        }
        Err(error) => return refuse(&Refusal::from(&error)),
    };
    match run(&program.command) {
        Ok(summary) => {
            say(&format!("{summary}\n"));
            ExitCode::SUCCESS
        }
        Err(refusal) => refuse(&refusal),
    }
}

/// Runs a command; what it has done is told on standard output.
fn run(command: &Command) -> Result<String, Refusal> {
    match command {
        Command::Synthesize(arguments) => synthesize::run(arguments),
        Command::Estimate(arguments) => estimate::run(arguments),
        Command::Decompose(arguments) => decompose::run(arguments),
        Command::Diagnose(arguments) => diagnose::run(arguments),
        Command::Compare(arguments) => compare::run(arguments),
        Command::Fem(arguments) => fem::run(arguments),
        Command::Modes(arguments) => modes::run(arguments),
        Command::Simulate(arguments) => simulate::run(arguments),
        Command::Prove(arguments) => prove::run(arguments),
        Command::Tables(arguments) => tables::run(arguments),
    }
}

fn refuse(refusal: &Refusal) -> ExitCode {
    // With standard error closed there is nobody left to tell.
    let _ = writeln!(std::io::stderr(), "jointscope: {refusal}");
    ExitCode::from(2)
}

/// Prints to standard output; a reader that has gone away (`jointscope … | head`) is no error.
fn say(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}
