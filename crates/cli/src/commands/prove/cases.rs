//! Where the concealed cases come from: those that the program ships, or as many new ones as are asked for.

use std::fs;
use std::path::{Path, PathBuf};

use jointscope::proof::{
    Asked, Case, FAMILIES, Plan, Precision, Questions, RouteTruth, SealedTruths, StruckCase,
};
use jointscope::recordings::{ReadOptions, Recording, hits_of};
use serde_json::{Value, json};

use super::arguments::ProveArguments;
use super::shipped;
use crate::input::{self, FixtureFile};
use crate::refusal::Refusal;

/// The files of a case.
const FILES: [&str; 2] = ["fixture.json", "hammer-test.uff"];

/// What is to be diagnosed, and what is true of it under seal.
pub(super) struct Concealed {
    /// Fixtures and recordings by route.
    pub cases: Questions,
    /// The cases' numbers, route after route.
    pub numbers: Vec<usize>,
    /// What is true of them.
    pub truths: SealedTruths<RouteTruth>,
    /// Which cases these are, in a line.
    pub what: String,
    /// The same as JSON.
    pub plan: Value,
    /// The folders of the cases, where they came as files.
    folders: Option<Vec<PathBuf>>,
}

impl Concealed {
    /// The cases that the arguments ask for.
    pub(super) fn of(arguments: &ProveArguments) -> Result<Self, Refusal> {
        let asks_for_new = arguments.cases.is_some()
            || arguments.seed.is_some()
            || arguments.graded.is_some()
            || arguments.asks_for_routes()
            || arguments.also_from.is_some()
            || !arguments.family.is_empty();
        if asks_for_new { Self::drawn(arguments) } else { Self::shipped(arguments) }
    }

    fn drawn(arguments: &ProveArguments) -> Result<Self, Refusal> {
        let named = |(name, family): (&str, _)| arguments.family.iter().any(|f| f == name).then_some(family);
        let families: Vec<_> = FAMILIES.into_iter().filter_map(named).collect();
        let standard = Plan::default();
        // Who asks for a route alone gets that alone.
        let by_route = arguments.asks_for_routes();
        let cases = arguments.cases.unwrap_or(if by_route { 0 } else { standard.cases });
        // The other routes come along unless the assemblies were chosen.
        let along = if families.is_empty() { Plan::along_with(arguments.cases.unwrap_or(0)) } else { 0 };
        let plan = Plan {
            cases,
            graded: arguments.graded.unwrap_or(standard.graded),
            solid: arguments.solid.unwrap_or(along),
            struck: arguments.struck.unwrap_or(along),
            solid_as_is: arguments.solid_as_is.unwrap_or(along),
            modal_errors: arguments.modal_errors.unwrap_or(along),
            channel_flaws: arguments.channel_flaws.unwrap_or(along),
            load_paths: arguments.load_paths.unwrap_or(along),
            unknown_physics: arguments.unknown_physics.unwrap_or(along),
            seed: arguments.seed.unwrap_or(standard.seed),
            fresh_from: arguments.also_from.clone(),
            only: arguments.only,
            families: if families.is_empty() { standard.families } else { families },
        };
        let (cases, truths) = plan.draw_routes().map_err(Refusal::new)?;
        let numbers = arguments.only.map_or_else(|| (0..cases.all().len()).collect(), |only| vec![only]);
        Ok(Concealed { cases, numbers, truths, what: plan.to_string(), plan: plan.to_value(), folders: None })
    }

    fn shipped(arguments: &ProveArguments) -> Result<Self, Refusal> {
        let [laboratory, solid, struck] = shipped::COUNTS;
        let count = laboratory + solid + struck;
        let numbers: Vec<usize> = match arguments.only {
            Some(only) if only >= count => {
                return Err(Refusal::new(format_args!(
                    "there is no case {only}: the {count} cases that are shipped are numbered 0 to {}; \
                     others are made with `--cases` and `--seed`",
                    count - 1
                )));
            }
            Some(only) => vec![only],
            None => (0..count).collect(),
        };
        let folder = shipped::folder(arguments.shipped.as_deref())?;
        let path = folder.join("truths.json");
        let text = fs::read_to_string(&path).map_err(|error| Refusal::io(&path, &error))?;
        let truths = SealedTruths::filed(&text, shipped::TRUTHS_SHA256, arguments.only)
            .map_err(|error| Refusal::at(&path, error))?;
        let folders: Vec<PathBuf> =
            numbers.iter().map(|number| folder.join(format!("{number:02}"))).collect();
        let mut cases = Questions::default();
        for (number, folder) in numbers.iter().zip(&folders) {
            match *number {
                n if n < laboratory => cases.laboratory.push(read_frfs(folder)?),
                n if n < laboratory + solid => cases.solid.push(read_frfs(folder)?),
                _ => cases.struck.push(read_hits(folder)?),
            }
        }
        let only = arguments.only.map_or_else(String::new, |only| format!("case {only} of "));
        Ok(Concealed {
            cases,
            truths,
            what: format!("{only}the {count} cases shipped in {}", shipped::FOLDER),
            plan: json!({ "shipped": shipped::FOLDER, "cases": count, "only": arguments.only }),
            folders: Some(folders),
            numbers,
        })
    }

    /// The recording of the case at a position as a universal file: as it came, or in double precision as it
    /// was made.
    pub(super) fn recording(&self, position: usize, case: &Asked) -> Result<Vec<u8>, Refusal> {
        match &self.folders {
            Some(folders) => input::bytes(&folders[position].join(FILES[1])),
            None => case.recording(Precision::Double).map_err(Refusal::new),
        }
    }
}

/// A shipped case of FRFs, read as a user's files are.
fn read_frfs(folder: &Path) -> Result<Case, Refusal> {
    let [fixture, recording] = FILES.map(|file| folder.join(file));
    let (believed, source) = (FixtureFile::read(&fixture)?.fixture, input::source(&recording)?);
    let read = Recording::of(&[source], &believed, &ReadOptions::default());
    let recorded =
        read.and_then(|read| read.frfs().cloned()).map_err(|error| Refusal::at(&recording, error))?;
    Ok(Case { believed, recorded })
}

/// A shipped case of hits.
fn read_hits(folder: &Path) -> Result<StruckCase, Refusal> {
    let [fixture, recording] = FILES.map(|file| folder.join(file));
    let (believed, source) = (FixtureFile::read(&fixture)?.fixture, input::source(&recording)?);
    let read = hits_of(&[source], Some(&believed), &ReadOptions::default());
    let recorded = read.map_err(|error| Refusal::at(&recording, error))?.hits;
    Ok(Case { believed, recorded })
}
