//! `jointscope compare`: decompositions in, their joints side by side out: differences, ratios, orders,
//! scatter of specimens.

mod joints;

use std::path::PathBuf;

use clap::Args;
use jointscope::comparison::{Comparison, ComparisonOptions, Source};
use jointscope::comparison_file;
use jointscope::report::comparison_report;
use jointscope::wording::Summary;

use crate::answered::{Answered, Destination, PAGE};
use crate::origin;
use crate::output::pretty;
use crate::refusal::Refusal;
use joints::Listed;

/// Options of `jointscope compare`.
#[derive(Debug, Args)]
pub(super) struct CompareArguments {
    /// Directories with the stiffness.json of a decomposition each; a joint is called by its directory. Of
    /// several joints found at once all are compared, called DIR/J, or the one that `DIR/J` names.
    #[arg(required_unless_present_any = ["specimens", "said"], value_name = "DIR")]
    pub directories: Vec<PathBuf>,
    /// What a directory is of: `sim=DIR` a simulation, `exp=DIR` a measurement, `fem=DIR` finite elements.
    /// Plots draw each kind with dashes of its own, and ratios of models to measurements have a table. May be
    /// given several times; the directory need not be listed again.
    #[arg(long = "as", value_name = "KIND=DIR", value_parser = said)]
    pub said: Vec<Said>,
    /// Directories of several specimens of one kind, whose scatter is wanted: `glued=a1,a2,a3`, or
    /// `glued=a/J,a/K`. May be given several times.
    #[arg(long, value_name = "NAME=DIR,DIR…", value_parser = kind)]
    pub specimens: Vec<Kind>,
    /// Take every joint as tested on blocks of its own, though the fixtures state the same ones.
    #[arg(long)]
    pub independent: bool,
    #[command(flatten)]
    pub destination: Destination,
}

/// A directory and what it is of.
#[derive(Debug, Clone)]
pub(super) struct Said {
    source: Source,
    directory: PathBuf,
}

/// Reads `KIND=DIR`.
fn said(text: &str) -> Result<Said, String> {
    let form = "sim, exp or fem and a directory are needed, such as exp=DIR";
    let (kind, directory) =
        text.split_once('=').filter(|(_, directory)| !directory.is_empty()).ok_or(form)?;
    let source = Source::ALL.into_iter().find(|source| source.short() == kind);
    let source = source.ok_or_else(|| format!("`{kind}` is none of the kinds sim, exp and fem"))?;
    Ok(Said { source, directory: directory.into() })
}

/// A kind of joint and the directories of its specimens.
#[derive(Debug, Clone)]
pub(super) struct Kind {
    name: String,
    directories: Vec<PathBuf>,
}

/// Reads `NAME=DIR,DIR…`.
fn kind(text: &str) -> Result<Kind, String> {
    let form = "a name and directories are needed, such as glued=a1,a2,a3";
    let (name, directories) = text.split_once('=').ok_or(form)?;
    let directories: Vec<PathBuf> =
        directories.split(',').filter(|part| !part.is_empty()).map(PathBuf::from).collect();
    match !name.is_empty() && !directories.is_empty() {
        true => Ok(Kind { name: name.to_owned(), directories }),
        false => Err(form.to_owned()),
    }
}

/// Compares and writes `comparison.json` and `report.html`; answers with ratios, orders and where the page
/// is, or with `comparison.json` itself.
pub(super) fn run(arguments: &CompareArguments) -> Result<String, Refusal> {
    let mut listed = Listed::default();
    for path in &arguments.directories {
        listed.add(path);
    }
    let said: Vec<(usize, Source)> =
        arguments.said.iter().map(|said| (listed.add(&said.directory), said.source)).collect();
    if let Some([first, again]) = listed.given_twice() {
        return Err(Refusal::new(format!(
            "`{}` and `{}` are the same directory: name each decomposition once",
            first.display(),
            again.display()
        )));
    }
    let mut kinds = Vec::new();
    for kind in &arguments.specimens {
        let places: Vec<usize> = kind.directories.iter().map(|path| listed.add(path)).collect();
        kinds.push((kind.name.clone(), places));
    }
    let files = listed.files()?;
    arguments.destination.without_frfs("compare")?;
    arguments.destination.foresee(&files, &[FILE, PAGE])?;
    let mut found = listed.read()?;
    for (place, source) in said {
        found.say(place, source)?;
    }
    let specimens = kinds.into_iter().map(|(name, places)| {
        let mut all: Vec<usize> = places.iter().flat_map(|&place| found.of(place)).collect();
        all.sort_unstable();
        all.dedup();
        (name, all)
    });
    let options = ComparisonOptions { independent: arguments.independent, specimens: specimens.collect() };
    let comparison = Comparison::with(found.joints, &options).map_err(Refusal::new)?;
    let context = origin::context(&files, Vec::new(), None)?;
    let mut file = comparison_file(&comparison);
    origin::add(&mut file, &context);
    let answered = Answered {
        answer: (FILE, pretty(&file)),
        others: Vec::new(),
        elsewhere: Vec::new(),
        report: comparison_report(&comparison, &context),
        frfs: Vec::new(),
        summary: comparison.summary(),
        notes: context.notes,
    };
    answered.end(&arguments.destination, &files)
}

const FILE: &str = "comparison.json";
