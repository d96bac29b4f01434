//! The sentence with which a command ends that did nothing.

use std::error::Error;
use std::fmt;
use std::num::{IntErrorKind, ParseFloatError, ParseIntError};
use std::path::Path;

use clap::error::{ContextKind, ErrorKind};

use crate::names::name;

/// Why a command did nothing: one plain sentence that names the file, the place in it and the remedy.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Refusal(String);

impl Refusal {
    /// A sentence about the command line.
    pub(crate) fn new(sentence: impl fmt::Display) -> Self {
        Refusal(one_line(&sentence.to_string()))
    }

    /// A sentence about a file.
    pub(crate) fn at(file: &Path, problem: impl fmt::Display) -> Self {
        Refusal::about(&name(file), problem)
    }

    /// A sentence about what goes by this name.
    pub(crate) fn about(name: &str, problem: impl fmt::Display) -> Self {
        Refusal::new(format_args!("{name}: {problem}"))
    }

    /// A directory without the file that a command would have written there.
    pub(crate) fn holding_no(directory: &Path, file: &str, command: &str) -> Self {
        let remedy = format_args!("holds no {file}; give the directory that `jointscope {command}` wrote to");
        Refusal::at(directory, remedy)
    }

    /// A file that could not be read or written.
    pub(crate) fn io(file: &Path, error: &std::io::Error) -> Self {
        use std::io::ErrorKind;
        match error.kind() {
            ErrorKind::NotFound => Refusal::at(file, "there is no such file; check the path"),
            ErrorKind::PermissionDenied => {
                Refusal::at(file, "permission denied; check the rights of file and directory")
            }
            ErrorKind::IsADirectory => {
                Refusal::at(file, "is a directory where a file is needed; name the file in it")
            }
            ErrorKind::NotADirectory => Refusal::at(file, "a part of this path is a file, not a directory"),
            _ => Refusal::at(file, error),
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Bad usage, as found by the argument parser: its sentence, its tip, and where help is to be had.
impl From<&clap::Error> for Refusal {
    fn from(error: &clap::Error) -> Self {
        let text = error.render().to_string();
        if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
            return Refusal::new("no command was given; `jointscope --help` lists the commands");
        }
        if let Some(sentence) = no_number(error).or_else(|| map_entry_as_option(error)) {
            return Refusal(sentence);
        }
        let mut paragraphs = text.split("\n\n");
        let problem = paragraphs.next().unwrap_or_default().trim().trim_start_matches("error: ");
        let tips = paragraphs.filter_map(|paragraph| paragraph.trim().strip_prefix("tip: "));
        let mut sentence = one_line(problem);
        for tip in tips {
            sentence.push_str("; ");
            sentence.push_str(&one_line(tip));
        }
        Refusal(format!("{sentence}; see `jointscope --help`"))
    }
}

/// What is wrong with a value that should be a number: the parsers speak of digits in strings and of ranges.
fn no_number(error: &clap::Error) -> Option<String> {
    let source = error.source()?;
    let needed = match source.downcast_ref::<ParseIntError>().map(ParseIntError::kind) {
        Some(IntErrorKind::PosOverflow) => "no number as large".to_owned(),
        Some(_) => "a whole number of zero or more".to_owned(),
        None if source.is::<ParseFloatError>() => "a number".to_owned(),
        None => {
            let range = source.to_string().split_once(" is not in ")?.1.replace("..=", " to ");
            format!("a whole number from {range}")
        }
    };
    let argument = error.get(ContextKind::InvalidArg)?.to_string();
    let option = argument.split(' ').next()?;
    let given = error.get(ContextKind::InvalidValue)?;
    Some(format!("{option} takes {needed}, not \"{given}\"; see `jointscope --help`"))
}

/// A map entry that begins with a minus is taken for options, none of which is called as an axis is.
fn map_entry_as_option(error: &clap::Error) -> Option<String> {
    let taken = error
        .get(ContextKind::InvalidArg)
        .filter(|_| error.kind() == ErrorKind::UnknownArgument)?
        .to_string();
    let axis = taken.strip_prefix('-').filter(|axis| ["x", "y", "z", "r"].contains(axis))?;
    let rest = if axis == "r" { "rz=-theta" } else { &format!("{axis}=-y") };
    Some(format!(
        "`{taken}` is no option; a map entry has its minus on the right, `--map {rest}`; see `jointscope --help`"
    ))
}

/// Line breaks and the blanks around them become one blank.
fn one_line(text: &str) -> String {
    if !text.contains(['\n', '\r']) {
        return text.to_owned();
    }
    text.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ")
}
