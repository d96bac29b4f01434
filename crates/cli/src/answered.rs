//! The end of a command that finds something: its files written, its notices told, its answer handed back.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use jointscope::recordings::to_datasets;
use jointscope::report::{Report, ReportFile};
use jointscope::spectra::FrfSet;
use jointscope::uff::Encoding;

use crate::output::Outputs;
use crate::progress;
use crate::refusal::Refusal;

/// What is written beside answer and page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Also {
    /// Every table and curve of the page, below tables and curves.
    Csv,
    /// Every figure of the page, below figures.
    Svg,
    /// FRFs as measured and of each model, and what is left of them, below frfs.
    Uff,
}

/// Where the answer goes.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct Destination {
    /// Print the answer as the JSON file holds it, for scripts.
    #[arg(long)]
    pub json: bool,
    /// Also write tables and curves of the page (csv), its figures (svg), or FRFs of the models and what is
    /// left of the measured ones (uff).
    #[arg(long, value_name = "KIND", value_enum, value_delimiter = ',', requires = "output")]
    pub also: Vec<Also>,
    /// The directory to write to; may be left out with --json.
    #[arg(short, long, value_name = "DIR", required_unless_present = "json")]
    pub output: Option<PathBuf>,
}

impl Destination {
    /// Whether files of these names could be written, to be asked before anything that takes long.
    pub(crate) fn foresee<'a>(
        &self,
        inputs: impl IntoIterator<Item = &'a PathBuf>,
        names: &[&str],
    ) -> Result<(), Refusal> {
        let folder = self.output.iter();
        Outputs::foresee(inputs, folder.flat_map(|folder| names.iter().map(|name| folder.join(name))))
    }

    /// Refuses FRFs of models where the command has none.
    pub(crate) fn without_frfs(&self, command: &str) -> Result<(), Refusal> {
        match self.also.contains(&Also::Uff) {
            false => Ok(()),
            true => Err(Refusal::new(format_args!(
                "`--also uff` writes FRFs of models beside the measured ones, and `{command}` has none; `diagnose`, `decompose`, `modes` and `check` have"
            ))),
        }
    }
}

/// What a command found, before anything of it is written.
pub(crate) struct Answered {
    /// What a reader should know besides.
    pub notes: Vec<String>,
    /// The answer's file: its name, and its contents, which `--json` prints.
    pub answer: (&'static str, String),
    /// Files beside it: name and contents.
    pub others: Vec<(&'static str, String)>,
    /// Files that go to places of their own.
    pub elsewhere: Vec<(PathBuf, String)>,
    /// The page.
    pub report: Report,
    /// FRFs by the name of their file.
    pub frfs: Vec<(String, FrfSet)>,
    /// What came out, a line each.
    pub summary: Vec<String>,
}

/// The page's name in every folder.
pub(crate) const PAGE: &str = "report.html";

/// A refusal in the place of an answer, where many tests are diagnosed.
pub(crate) const REFUSED: &str = "refused.json";

impl Answered {
    /// Writes what the destination asks for, tells the notices, and answers with what came out and where the
    /// page is.
    pub(crate) fn end<'a>(
        self,
        destination: &Destination,
        inputs: impl IntoIterator<Item = &'a PathBuf>,
    ) -> Result<String, Refusal> {
        let mut outputs = Outputs::new(inputs);
        for (path, contents) in &self.elsewhere {
            outputs.add(path, contents.clone());
        }
        if let Some(folder) = &destination.output {
            self.add(folder, &destination.also, &mut outputs)?;
        }
        outputs.write()?;
        self.notes.iter().for_each(|note| progress::notice(note));
        if destination.json {
            return Ok(self.answer.1.trim_end().to_owned());
        }
        let mut lines = self.summary;
        lines.extend(destination.output.iter().map(|folder| folder.join(PAGE).display().to_string()));
        Ok(lines.join("\n"))
    }

    /// Adds the files that go to `folder` to those to be written.
    pub(crate) fn add(&self, folder: &Path, also: &[Also], outputs: &mut Outputs) -> Result<(), Refusal> {
        outputs.add(folder.join(self.answer.0), self.answer.1.clone());
        for (name, contents) in &self.others {
            outputs.add(folder.join(name), contents.clone());
        }
        if also.contains(&Also::Csv) {
            add_all(folder, self.report.tables(), outputs);
            add_all(folder, self.report.curves().map_err(Refusal::new)?, outputs);
        }
        if also.contains(&Also::Svg) {
            add_all(folder, self.report.figures().map_err(Refusal::new)?, outputs);
        }
        if also.contains(&Also::Uff) {
            for (name, frfs) in &self.frfs {
                let path = folder.join("frfs").join(format!("{name}.uff"));
                let datasets = to_datasets(frfs, name, Encoding::default())
                    .map_err(|error| Refusal::at(&path, error))?;
                outputs.add_datasets(&path, &datasets)?;
            }
        }
        outputs.add(folder.join(PAGE), self.report.html().map_err(Refusal::new)?);
        Ok(())
    }
}

fn add_all(folder: &Path, files: Vec<ReportFile>, outputs: &mut Outputs) {
    for ReportFile { path, contents } in files {
        outputs.add(folder.join(path), contents);
    }
}
