//! Where the concealed cases come from: those that the program ships, or as many new ones as are asked for.

use jointscope_proof::{
    BrokenSeal, Case, FAMILIES, Plan, Precision, Questions, RouteTruth, SealedTruths, StruckCase,
};
use jointscope_recordings::{ReadOptions, Recording, Source, hits_of};
use serde_json::{Value, json};

use super::ProveArguments;
use super::shipped::{self, Files};
use crate::refusal::Refusal;
use jointscope_fixture::Fixture;

/// What is to be diagnosed, and what is true of it under seal.
pub struct Concealed {
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
    /// The recordings as files, where they came as such.
    files: Option<Vec<&'static [u8]>>,
}

impl Concealed {
    /// The cases that the arguments ask for.
    pub fn of(arguments: &ProveArguments) -> Result<Self, Refusal> {
        let asks_for_new = arguments.cases.is_some()
            || arguments.seed.is_some()
            || arguments.graded.is_some()
            || arguments.solid.is_some()
            || arguments.struck.is_some()
            || arguments.also_from.is_some()
            || !arguments.family.is_empty();
        if asks_for_new { Self::drawn(arguments) } else { Self::shipped(arguments) }
    }

    fn drawn(arguments: &ProveArguments) -> Result<Self, Refusal> {
        let named = |(name, family): (&str, _)| arguments.family.iter().any(|f| f == name).then_some(family);
        let families: Vec<_> = FAMILIES.into_iter().filter_map(named).collect();
        let standard = Plan::default();
        // Who asks for a route alone gets that alone.
        let by_route = arguments.solid.is_some() || arguments.struck.is_some();
        let cases = arguments.cases.unwrap_or(if by_route { 0 } else { standard.cases });
        // The other routes come along unless the assemblies were chosen.
        let along = if families.is_empty() { Plan::along_with(arguments.cases.unwrap_or(0)) } else { 0 };
        let plan = Plan {
            cases,
            graded: arguments.graded.unwrap_or(standard.graded),
            solid: arguments.solid.unwrap_or(along),
            struck: arguments.struck.unwrap_or(along),
            seed: arguments.seed.unwrap_or(standard.seed),
            fresh_from: arguments.also_from.clone(),
            only: arguments.only,
            families: if families.is_empty() { standard.families } else { families },
        };
        let (cases, truths) = plan.draw_routes().map_err(Refusal::new)?;
        let numbers = arguments.only.map_or_else(|| (0..cases.count()).collect(), |only| vec![only]);
        Ok(Concealed { cases, numbers, truths, what: plan.to_string(), plan: plan.to_value(), files: None })
    }

    fn shipped(arguments: &ProveArguments) -> Result<Self, Refusal> {
        let all = [&shipped::LABORATORY[..], &shipped::SOLID, &shipped::STRUCK].concat();
        let count = all.len();
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
        let first_solid = shipped::LABORATORY.len();
        let first_struck = first_solid + shipped::SOLID.len();
        let mut cases = Questions::default();
        for &number in &numbers {
            match number {
                n if n < first_solid => cases.laboratory.push(read_frfs(number, all[number])?),
                n if n < first_struck => cases.solid.push(read_frfs(number, all[number])?),
                _ => cases.struck.push(read_hits(number, all[number])?),
            }
        }
        let only = arguments.only.map_or_else(String::new, |only| format!("case {only} of "));
        Ok(Concealed {
            cases,
            truths,
            what: format!("{only}the {count} cases shipped in fixtures/concealed"),
            plan: json!({ "shipped": "fixtures/concealed", "cases": count, "only": arguments.only }),
            files: Some(numbers.iter().map(|&number| all[number].1).collect()),
            numbers,
        })
    }

    /// What the analyst believes of the case at a position.
    pub fn believed(&self, position: usize) -> &Fixture {
        match self.route(position) {
            Route::Frfs(case) => &case.believed,
            Route::Hits(case) => &case.believed,
        }
    }

    /// The recording of the case at a position as a universal file: as it came, or in double precision as it was made.
    pub fn recording(&self, position: usize) -> Result<Vec<u8>, Refusal> {
        match (&self.files, self.route(position)) {
            (Some(files), _) => Ok(files[position].to_vec()),
            (None, Route::Frfs(case)) => case.recording(Precision::Double).map_err(Refusal::new),
            (None, Route::Hits(case)) => case.recording(Precision::Double).map_err(Refusal::new),
        }
    }

    /// Positions of the first solid case and of the first of hits.
    pub fn firsts(&self) -> [usize; 2] {
        let first_solid = self.cases.laboratory.len();
        [first_solid, first_solid + self.cases.solid.len()]
    }

    fn route(&self, position: usize) -> Route<'_> {
        let [first_solid, first_struck] = self.firsts();
        match position {
            p if p < first_solid => Route::Frfs(&self.cases.laboratory[p]),
            p if p < first_struck => Route::Frfs(&self.cases.solid[p - first_solid]),
            p => Route::Hits(&self.cases.struck[p - first_struck]),
        }
    }
}

/// What a case's recording holds.
enum Route<'a> {
    Frfs(&'a Case),
    Hits(&'a StruckCase),
}

/// A shipped case of FRFs, read as a user's files are.
fn read_frfs(number: usize, files: Files) -> Result<Case, Refusal> {
    let (believed, source) = read(number, files)?;
    let read = Recording::of(&[source], &believed, &ReadOptions::default());
    let recorded = read.and_then(|read| read.frfs().cloned()).map_err(|error| broken(number, &error))?;
    Ok(Case { believed, recorded })
}

/// A shipped case of hits.
fn read_hits(number: usize, files: Files) -> Result<StruckCase, Refusal> {
    let (believed, source) = read(number, files)?;
    let read = hits_of(&[source], Some(&believed), &ReadOptions::default());
    let hits = read.map_err(|error| broken(number, &error))?.hits;
    Ok(StruckCase { believed, hits })
}

fn read(number: usize, (fixture, recording): Files) -> Result<(Fixture, Source), Refusal> {
    let believed = Fixture::from_json(fixture).map_err(|error| broken(number, &error))?;
    let file = jointscope_uff::read(recording).map_err(|error| broken(number, &error))?;
    Ok((believed, Source { name: format!("{}/hammer-test.uff", directory(number)), file }))
}

fn broken(number: usize, error: &dyn std::fmt::Display) -> Refusal {
    Refusal::new(format_args!("{}: {error}", directory(number)))
}

fn directory(number: usize) -> String {
    format!("fixtures/concealed/{number:02}")
}
