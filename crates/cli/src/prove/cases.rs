//! Where the concealed cases come from: those that the program ships, or as many new ones as are asked for.

use jointscope_proof::{BrokenSeal, Case, FAMILIES, Plan, Precision, SealedTruths};
use jointscope_recordings::{ReadOptions, Recording, Source};
use serde_json::{Value, json};

use super::{ProveArguments, shipped};
use crate::refusal::Refusal;
use jointscope_fixture::Fixture;

/// What is to be diagnosed, and what is true of it under seal.
pub struct Concealed {
    /// Fixtures and recordings.
    pub cases: Vec<Case>,
    /// The cases' numbers.
    pub numbers: Vec<usize>,
    /// What is true of them.
    pub truths: SealedTruths,
    /// Which cases these are, in a line.
    pub what: String,
    /// The same as JSON.
    pub plan: Value,
    /// The recordings as files, where they came as such.
    files: Option<Vec<&'static [u8]>>,
}

impl Concealed {
    /// The cases that the arguments ask for.
    pub fn of(arguments: &ProveArguments) -> Result<Self, Refusal> {
        let asks_for_new = arguments.cases.is_some()
            || arguments.seed.is_some()
            || arguments.graded.is_some()
            || arguments.also_from.is_some()
            || !arguments.family.is_empty();
        if asks_for_new { Self::drawn(arguments) } else { Self::shipped(arguments) }
    }

    fn drawn(arguments: &ProveArguments) -> Result<Self, Refusal> {
        let named = |(name, family): (&str, _)| arguments.family.iter().any(|f| f == name).then_some(family);
        let families: Vec<_> = FAMILIES.into_iter().filter_map(named).collect();
        let standard = Plan::default();
        let plan = Plan {
            cases: arguments.cases.unwrap_or(standard.cases),
            graded: arguments.graded.unwrap_or(standard.graded),
            seed: arguments.seed.unwrap_or(standard.seed),
            fresh_from: arguments.also_from.clone(),
            only: arguments.only,
            families: if families.is_empty() { standard.families } else { families },
        };
        let (cases, truths) = plan.draw().map_err(Refusal::new)?;
        let numbers = arguments.only.map_or_else(|| (0..cases.len()).collect(), |only| vec![only]);
        Ok(Concealed { cases, numbers, truths, what: plan.to_string(), plan: plan.to_value(), files: None })
    }

    fn shipped(arguments: &ProveArguments) -> Result<Self, Refusal> {
        let count = shipped::CASES.len();
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
        let truths = SealedTruths::filed(shipped::TRUTHS, shipped::TRUTHS_SHA256, arguments.only).map_err(
            |error: BrokenSeal| Refusal::new(format_args!("fixtures/concealed/truths.json: {error}")),
        )?;
        let cases = numbers.iter().map(|&number| read(number)).collect::<Result<_, _>>()?;
        let only = arguments.only.map_or_else(String::new, |only| format!("case {only} of "));
        Ok(Concealed {
            cases,
            truths,
            what: format!("{only}the {count} cases shipped in fixtures/concealed"),
            plan: json!({ "shipped": "fixtures/concealed", "cases": count, "only": arguments.only }),
            files: Some(numbers.iter().map(|&number| shipped::CASES[number].1).collect()),
            numbers,
        })
    }

    /// The recording of the case at a position as a universal file: as it came, or in double precision as it was made.
    pub fn recording(&self, position: usize) -> Result<Vec<u8>, Refusal> {
        match &self.files {
            Some(files) => Ok(files[position].to_vec()),
            None => self.cases[position].recording(Precision::Double).map_err(Refusal::new),
        }
    }
}

/// A shipped case, read as a user's files are.
fn read(number: usize) -> Result<Case, Refusal> {
    let (fixture, recording) = shipped::CASES[number];
    let name = format!("fixtures/concealed/{number:02}");
    let broken = |error: &dyn std::fmt::Display| Refusal::new(format_args!("{name}: {error}"));
    let believed = Fixture::from_json(fixture).map_err(|error| broken(&error))?;
    let file = jointscope_uff::read(recording).map_err(|error| broken(&error))?;
    let source = Source { name: format!("{name}/hammer-test.uff"), file };
    let read =
        Recording::of(&[source], &believed, &ReadOptions::default()).map_err(|error| broken(&error))?;
    let recorded = read.frfs().map_err(|error| broken(&error))?.clone();
    Ok(Case { believed, recorded })
}
