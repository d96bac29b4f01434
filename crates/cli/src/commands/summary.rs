//! `jointscope summary`: what came of many cases, in one table and one page.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use jointscope::cases::{Case, Command, Row, State, Summary};
use jointscope::report::summary_page;
use serde::Deserialize;
use serde_json::{Value, json};

use crate::answered::REFUSED;
use crate::input;
use crate::origin;
use crate::output::{Outputs, pretty};
use crate::refusal::Refusal;
use crate::said::Said;

#[derive(Debug, Args)]
pub(super) struct SummaryArguments {
    /// The directory that `diagnose` or `decompose` wrote the answers of many cases to.
    #[arg(value_name = "DIR")]
    pub directory: PathBuf,
    /// Print the table as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Writes `summary.csv` and `summary.html`; answers with what came of the cases.
pub(super) fn run(arguments: &SummaryArguments) -> Result<Said, Refusal> {
    let directory = &arguments.directory;
    let lists = manifests(directory)?;
    let Some((_, Manifest { command, .. })) = lists.first() else {
        return Err(Refusal::at(
            directory,
            "holds no cases.json; give the directory that `jointscope diagnose` or `jointscope decompose` wrote the answers of many cases to",
        ));
    };
    let command = known(directory, command)?;
    let mut cases: Vec<Case> = Vec::new();
    for (path, list) in &lists {
        if known(path, &list.command)? != command {
            return Err(Refusal::at(
                path,
                "is of another command than the other lists beside it; take one of them out",
            ));
        }
        for case in &list.cases {
            if cases.iter().all(|known| known.name != case.name) {
                cases.push(case.clone());
            }
        }
    }
    let text = written(directory, command, &cases, arguments.json)?;
    let whole = rows(directory, command, &cases).iter().all(|row| row.state.is_answered());
    Ok(Said { text, whole })
}

/// The lists that a directory holds, by their names.
fn manifests(directory: &Path) -> Result<Vec<(PathBuf, Manifest)>, Refusal> {
    let failed = |error: std::io::Error| Refusal::io(directory, &error);
    let mut paths = Vec::new();
    for entry in fs::read_dir(directory).map_err(failed)? {
        let name = entry.map_err(failed)?.file_name().to_string_lossy().into_owned();
        if name == "cases.json" || (name.starts_with("cases-") && name.ends_with(".json")) {
            paths.push(directory.join(name));
        }
    }
    paths.sort();
    let read = |path: PathBuf| {
        let list = serde_json::from_value(input::answer(&path)?).map_err(|error| {
            Refusal::at(
                &path,
                format_args!("is no list of cases ({error}); run the cases again, which writes it anew"),
            )
        })?;
        Ok((path, list))
    };
    paths.into_iter().map(read).collect()
}

/// What stands in a list.
#[derive(Debug, Deserialize)]
struct Manifest {
    command: String,
    cases: Vec<Case>,
}

fn known(path: &Path, command: &str) -> Result<Command, Refusal> {
    Command::named(command).ok_or_else(|| {
        Refusal::at(
            path,
            format_args!("its cases are of `{command}`, which this program does not know; run them again"),
        )
    })
}

/// Refuses a directory that holds cases of another command, whose pages would be overwritten.
pub(super) fn belongs_to(directory: &Path, command: Command) -> Result<(), Refusal> {
    if !directory.is_dir() {
        return Ok(());
    }
    match manifests(directory)?.into_iter().find(|(_, list)| list.command != command.name()) {
        None => Ok(()),
        Some((_, list)) => Err(Refusal::at(
            directory,
            format_args!(
                "holds cases of `{}`, whose pages would be replaced; choose another `-o`",
                list.command
            ),
        )),
    }
}

/// Reads what came of the cases, writes table and page; answers with them in words, or as JSON.
pub(super) fn written(
    directory: &Path,
    command: Command,
    cases: &[Case],
    json: bool,
) -> Result<String, Refusal> {
    let summary = Summary { command, rows: rows(directory, command, cases) };
    let context = origin::context([], Vec::new(), None)?;
    let page = summary_page(&summary, &context).map_err(Refusal::new)?;
    let page_path = directory.join("summary.html");
    let mut outputs = Outputs::default();
    outputs.add(directory.join("summary.csv"), summary.csv());
    outputs.add(&page_path, page);
    outputs.write()?;
    if json {
        let cases: Value = summary.rows.iter().map(|row| json!({ "case": row.case, "came_to": row.state.verdict(), "says": row.state.to_string() })).collect();
        return Ok(pretty(&json!({ "command": command.name(), "says": summary.says(), "cases": cases }))
            .trim_end()
            .to_owned());
    }
    let mut lines = vec![summary.says()];
    lines.extend(summary.rows.iter().map(|row| format!("  {}: {}", row.case, row.state)));
    lines.push(directory.join("summary.csv").display().to_string());
    lines.push(page_path.display().to_string());
    Ok(lines.join("\n"))
}

/// What came of each case, as its directory tells.
fn rows(directory: &Path, command: Command, cases: &[Case]) -> Vec<Row> {
    let state = |case: &Case| {
        let own = directory.join(&case.name);
        if let Ok(refused) = input::answer(&own.join(REFUSED)) {
            let why = refused
                .get("refused")
                .and_then(Value::as_str)
                .unwrap_or("for a reason that its file does not tell");
            return State::Refused(why.to_owned());
        }
        let answer = own.join(command.answer());
        match answer.exists() {
            false => State::Missing,
            true => match input::answer(&answer) {
                Ok(file) => command.state(&file),
                Err(refusal) => State::Refused(refusal.to_string()),
            },
        }
    };
    cases.iter().map(|case| Row { case: case.name.clone(), state: state(case) }).collect()
}
