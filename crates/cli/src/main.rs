//! The `jointscope` program: arguments, files and exit codes. What is computed is computed by the crates below.
//!
//! Exit status 0: done. 2: bad usage or bad input, with one plain sentence on standard error and nothing half-written.

mod commands;
mod computed_frfs;
mod estimation_arguments;
mod input;
mod origin;
mod output;
mod progress;
mod recording;
mod refusal;
mod values;

use std::io::Write;
use std::process::ExitCode;

use clap::Parser;
use commands::Program;
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
    match program.run() {
        Ok(summary) => {
            say(&format!("{summary}\n"));
            ExitCode::SUCCESS
        }
        Err(refusal) => refuse(&refusal),
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
