//! The `jointscope` program: arguments, files and exit codes. What is computed is computed by the crates
//! below.
//!
//! Exit status 0: done. 1: done, though not all of it: of many cases some have no answer, or the files are
//! written and standard output took no more. 2: bad usage or bad input, with one plain sentence on standard
//! error and nothing half-written. Answers go to standard output; notices and progress go to standard error.

mod answered;
mod commands;
mod computed_frfs;
mod estimation_arguments;
mod input;
mod names;
mod origin;
mod output;
mod progress;
mod recording;
mod refusal;
mod replacing;
mod said;
mod values;

use std::io::{ErrorKind, Write};
use std::process::ExitCode;

use commands::Program;
use progress::{tell, visible};
use refusal::Refusal;
use said::Said;

fn main() -> ExitCode {
    let program = match Program::read() {
        Ok(program) => program,
        // Help and version are no errors.
        Err(answer) if !answer.use_stderr() => return say(&answer.render().to_string(), true),
        Err(error) => return refuse(&Refusal::from(&error)),
    };
    match program.run() {
        Ok(Said { text, whole }) => say(&format!("{text}\n"), whole),
        Err(refusal) => refuse(&refusal),
    }
}

/// What was asked is done in part only.
const IN_PART: u8 = 1;
/// Nothing is done.
const REFUSED: u8 = 2;

fn refuse(refusal: &Refusal) -> ExitCode {
    tell(&format!("jointscope: {refusal}"));
    ExitCode::from(REFUSED)
}

/// Prints to standard output. A reader that has gone away (`jointscope … | head`) is no error; an answer that
/// is lost is one.
fn say(text: &str, whole: bool) -> ExitCode {
    let mut output = std::io::stdout().lock();
    match output.write_all(visible(text).as_bytes()).and_then(|()| output.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            tell(&format!(
                "jointscope: standard output takes no more ({error}), so the answer is lost there; direct it to a place with room"
            ));
            ExitCode::from(IN_PART)
        }
        _ if whole => ExitCode::SUCCESS,
        _ => ExitCode::from(IN_PART),
    }
}
