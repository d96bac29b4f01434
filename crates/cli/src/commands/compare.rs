//! `jointscope compare`: decompositions in, their joints side by side out: differences, ratios, orders, scatter of specimens.

mod joints;

use std::path::PathBuf;

use clap::Args;
use jointscope::comparison::{Comparison, ComparisonOptions};
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
    /// Directories with the stiffness.json of a decomposition each; a joint is called by its directory. Of several joints found at once all are compared, called DIR/J, or the
    /// one that `DIR/J` names.
    #[arg(required_unless_present = "specimens", value_name = "DIR")]
    pub directories: Vec<PathBuf>,
    /// Directories of several specimens of one kind, whose scatter is wanted: `glued=a1,a2,a3`, or `glued=a/J,a/K`. May be given several times.
    #[arg(long, value_name = "NAME=DIR,DIR…", value_parser = kind)]
    pub specimens: Vec<Kind>,
    /// Take every joint as tested on blocks of its own, though the fixtures state the same ones.
    #[arg(long)]
    pub independent: bool,
    #[command(flatten)]
    pub destination: Destination,
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

/// Compares and writes `comparison.json` and `report.html`; answers with ratios, orders and where the page is, or with `comparison.json` itself.
pub(super) fn run(arguments: &CompareArguments) -> Result<String, Refusal> {
    let mut listed = Listed::default();
    for path in &arguments.directories {
        listed.add(path);
    }
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
    let found = listed.read()?;
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
