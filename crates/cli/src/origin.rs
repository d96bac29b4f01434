//! What pages and files say of their origin: program, command, inputs with their hashes.

use std::path::PathBuf;

use jointscope::pipeline::HammerTest;
use jointscope::report::{InputFile, PageContext};
use serde_json::{Value, json};

use crate::input;
use crate::names::name;
use crate::refusal::Refusal;

/// The origin of a page, with notes and hits.
pub(crate) fn context<'a>(
    files: impl IntoIterator<Item = &'a PathBuf>,
    notes: Vec<String>,
    hits: Option<HammerTest>,
) -> Result<PageContext, Refusal> {
    context_of(command_line(), files, notes, hits)
}

/// The same of another command line than the one that was typed.
pub(crate) fn context_of<'a>(
    command: String,
    files: impl IntoIterator<Item = &'a PathBuf>,
    notes: Vec<String>,
    hits: Option<HammerTest>,
) -> Result<PageContext, Refusal> {
    Ok(PageContext { program: program(), command, inputs: inputs(files)?, notes, hits })
}

/// Adds to a file's contents what they were made from.
pub(crate) fn add(answer: &mut Value, context: &PageContext) {
    answer["notes"] = json!(context.notes);
    answer["made"] = json!({
        "program": context.program,
        "command": context.command,
        "inputs": inputs_value(&context.inputs),
    });
}

/// Inputs as files state them.
pub(crate) fn inputs_value(inputs: &[InputFile]) -> Value {
    inputs.iter().map(|input| json!({"file": input.name, "sha256": input.sha256})).collect()
}

/// Names and hashes of the files as they were read.
pub(crate) fn inputs<'a>(files: impl IntoIterator<Item = &'a PathBuf>) -> Result<Vec<InputFile>, Refusal> {
    let noted = |path| Ok(InputFile { name: name(path), sha256: input::sha256(path)? });
    files.into_iter().map(|path: &PathBuf| noted(path)).collect()
}

/// The program and its version.
pub(crate) fn program() -> String {
    format!("jointscope {}", env!("CARGO_PKG_VERSION"))
}

/// The words of a command line that [`command_line`] has written.
pub(crate) fn words(command: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut rest = command.trim_start();
    while !rest.is_empty() {
        let mut quoted = serde_json::Deserializer::from_str(rest).into_iter::<String>();
        let word = match rest.starts_with('"').then(|| quoted.next()).flatten() {
            Some(Ok(word)) => {
                let end = quoted.byte_offset();
                rest = &rest[end..];
                word
            }
            _ => {
                let end = rest.find(' ').unwrap_or(rest.len());
                let word = rest[..end].to_owned();
                rest = &rest[end..];
                word
            }
        };
        words.push(word);
        rest = rest.trim_start();
    }
    words
}

/// The command as it was typed; the program by its name alone, wherever it lies.
pub(crate) fn command_line() -> String {
    command_of(std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned()))
}

/// A command line of these words.
pub(crate) fn command_of(words: impl IntoIterator<Item = String>) -> String {
    let quoted = |word: String| if word.contains([' ', '"', '\'']) { format!("{word:?}") } else { word };
    let words = words.into_iter().map(quoted);
    std::iter::once("jointscope".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::words;

    #[test]
    fn a_command_line_comes_apart_into_the_words_it_was_made_of() {
        assert_eq!(words("jointscope diagnose a.json b.uff"), ["jointscope", "diagnose", "a.json", "b.uff"]);
        let quoted = format!("jointscope diagnose {:?} {:?} -o out", "my fixture.json", "it's \"b\".uff");
        let apart = ["jointscope", "diagnose", "my fixture.json", "it's \"b\".uff", "-o", "out"];
        assert_eq!(words(&quoted), apart);
    }
}
