//! `jointscope man`: manual pages, of the program or of every command.

use std::path::PathBuf;

use clap::Args;
use clap_mangen::Man;

use crate::output::{Outputs, counted};
use crate::refusal::Refusal;

#[derive(Debug, Args)]
pub(super) struct ManArguments {
    /// The directory to write a page a command to [default: the program's own page to standard output].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// Prints or writes the pages of a program with these commands.
pub(super) fn run(arguments: &ManArguments, mut program: clap::Command) -> Result<String, Refusal> {
    program.build();
    let Some(folder) = &arguments.output else {
        return Ok(page(program)?.trim_end().to_owned());
    };
    let mut outputs = Outputs::default();
    let commands: Vec<_> = std::iter::once(&program).chain(program.get_subcommands()).cloned().collect();
    let count = commands.len();
    for command in commands {
        let name = command.get_display_name().unwrap_or_else(|| command.get_name()).to_owned();
        outputs.add(folder.join(format!("{name}.1")), page(command)?);
    }
    outputs.write()?;
    Ok(format!("{}: {}", folder.display(), counted(count, "page")))
}

fn page(command: clap::Command) -> Result<String, Refusal> {
    let mut page = Vec::new();
    Man::new(command).render(&mut page).map_err(Refusal::new)?;
    Ok(String::from_utf8_lossy(&page).into_owned())
}
