//! `jointscope schema`: the JSON Schema of fixture files out.

use std::path::PathBuf;

use clap::Args;
use jointscope::schema::fixture_schema;

use crate::output::{Outputs, pretty};
use crate::refusal::Refusal;

#[derive(Debug, Args)]
pub(super) struct SchemaArguments {
    /// The file to write it to [default: standard output].
    #[arg(short, long, value_name = "OUT.json")]
    pub output: Option<PathBuf>,
}

/// Prints or writes the schema.
pub(super) fn run(arguments: &SchemaArguments) -> Result<String, Refusal> {
    let schema = fixture_schema();
    let Some(path) = &arguments.output else { return Ok(pretty(&schema).trim_end().to_owned()) };
    Outputs::one(path.clone(), &schema)?;
    Ok(format!(
        "{}; name it in a fixture as \"$schema\", and editors complete and check the file",
        path.display()
    ))
}
