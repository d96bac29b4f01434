//! `jointscope compare`: decompositions in, their joints side by side out: differences, ratios, orders, scatter of specimens.

use std::path::{Path, PathBuf};

use clap::Args;
use jointscope::comparison::{Comparison, ComparisonOptions, Decomposed};
use jointscope::comparison_file;
use jointscope::report::comparison_report;
use jointscope::wording::Summary;

use crate::answered::{Answered, Destination, PAGE};
use crate::input;
use crate::origin;
use crate::output::pretty;
use crate::refusal::Refusal;

/// Options of `jointscope compare`.
#[derive(Debug, Args)]
pub(super) struct CompareArguments {
    /// Directories with the stiffness.json of a decomposition each; a joint is called by its directory.
    #[arg(required_unless_present = "specimens", value_name = "DIR")]
    pub directories: Vec<PathBuf>,
    /// Directories of several specimens of one kind, whose scatter is wanted: `glued=a1,a2,a3`. May be given several times.
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
    let form = "a name and two directories or more are needed, such as glued=a1,a2,a3";
    let (name, directories) = text.split_once('=').ok_or(form)?;
    let directories: Vec<PathBuf> =
        directories.split(',').filter(|part| !part.is_empty()).map(PathBuf::from).collect();
    match !name.is_empty() && directories.len() > 1 {
        true => Ok(Kind { name: name.to_owned(), directories }),
        false => Err(form.to_owned()),
    }
}

/// Whether two paths lead to one directory.
fn is_same(a: &Path, b: &Path) -> bool {
    let whole = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.components().collect());
    whole(a) == whole(b)
}

/// A directory that was given before, under this name or another.
fn given_twice(directories: &[PathBuf]) -> Option<(&PathBuf, &PathBuf)> {
    let before = |i: usize| directories[..i].iter().find(|other| is_same(other, &directories[i]));
    (0..directories.len()).find_map(|i| Some((before(i)?, &directories[i])))
}

/// Every directory once, those of specimens after the others, and the places of each kind's.
fn listed(arguments: &CompareArguments) -> (Vec<PathBuf>, Vec<(String, Vec<usize>)>) {
    let mut all = arguments.directories.clone();
    let mut place = |directory: &PathBuf| {
        all.iter().position(|other| is_same(other, directory)).unwrap_or_else(|| {
            all.push(directory.clone());
            all.len() - 1
        })
    };
    let mut kinds = Vec::new();
    for kind in &arguments.specimens {
        let mut places: Vec<usize> = kind.directories.iter().map(&mut place).collect();
        places.sort_unstable();
        places.dedup();
        kinds.push((kind.name.clone(), places));
    }
    (all, kinds)
}

/// Compares and writes `comparison.json` and `report.html`; answers with ratios, orders and where the page is, or with `comparison.json` itself.
pub(super) fn run(arguments: &CompareArguments) -> Result<String, Refusal> {
    if let Some((first, again)) = given_twice(&arguments.directories) {
        return Err(Refusal::new(format!(
            "`{}` and `{}` are the same directory: name each decomposition once",
            first.display(),
            again.display()
        )));
    }
    let (directories, specimens) = listed(arguments);
    let files: Vec<PathBuf> = directories.iter().map(|directory| directory.join("stiffness.json")).collect();
    arguments.destination.without_frfs("compare")?;
    arguments.destination.foresee(&files, &[FILE, PAGE])?;
    if let Some(empty) =
        directories.iter().find(|path| path.is_dir() && !path.join("stiffness.json").exists())
    {
        return Err(Refusal::holding_no(empty, "stiffness.json", "decompose"));
    }
    let names = names(&directories);
    let joint = |(name, path): (&String, &PathBuf)| {
        Decomposed::of(name, &input::json(path)?).map_err(|error| Refusal::at(path, error))
    };
    let joints = names.iter().zip(&files).map(joint).collect::<Result<Vec<_>, _>>()?;
    let options = ComparisonOptions { independent: arguments.independent, specimens };
    let comparison = Comparison::with(joints, &options).map_err(Refusal::new)?;
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

/// The directories' last names; the whole paths of those that share one.
fn names(directories: &[PathBuf]) -> Vec<String> {
    let short = |path: &PathBuf| path.file_name().map(|name| name.to_string_lossy().into_owned());
    let name = |path: &PathBuf| {
        let alone = directories.iter().filter(|other| short(other) == short(path)).count() == 1;
        short(path).filter(|_| alone).unwrap_or_else(|| path.display().to_string())
    };
    directories.iter().map(name).collect()
}
