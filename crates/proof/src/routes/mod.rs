//! Cases by several routes: the laboratory's FRFs, the FRFs of solids, hits over time; one seal on all their truths.
//!
//! The laboratory and the diagnosis model the same assembly, of rigid blocks and massless beams, in two programs. The two other routes do
//! not: a solid is meshed and has mass, shear and layers of its own; hits are integrated step by step, and no FRF is computed on the way.

mod score;
mod solid;
mod struck;
mod table;

pub use score::{CaseLine, RouteScore, SizeScore};
pub use solid::{Shown, SolidEvidence, SolidJudged, SolidTruth};
pub use struck::{
    HitsFileError, StruckAnswer, StruckAnswers, StruckCase, StruckDiagnosis, StruckJudged, StruckNoAnswer,
    StruckOutcome, StruckRole, StruckTruth,
};

use crate::answers::on_workers;
use crate::seal::{Filed, Given, Sealable};
use crate::{Answers, Case, GenerationError, Plan, SealedTruths, Truth};
use jointscope_diagnosis::Diagnosis;
use serde_json::{Map, Value, json};

/// What is to be diagnosed, by route.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Questions {
    /// The laboratory's FRFs.
    pub laboratory: Vec<Case>,
    /// FRFs of solids.
    pub solid: Vec<Case>,
    /// Hits over time.
    pub struck: Vec<StruckCase>,
}

impl Questions {
    /// Number of cases.
    pub fn count(&self) -> usize {
        self.laboratory.len() + self.solid.len() + self.struck.len()
    }
}

/// What was answered, by route.
#[derive(Debug)]
pub struct Replies {
    /// To the laboratory's FRFs.
    pub laboratory: Answers,
    /// To those of solids.
    pub solid: Answers,
    /// To hits.
    pub struck: StruckAnswers,
}

impl Given for Replies {
    fn count(&self) -> usize {
        self.laboratory.all().len() + self.solid.all().len() + self.struck.all().len()
    }
}

/// A case by its route, at its position among all.
enum Asked<'a> {
    Frfs(usize, &'a Case),
    Hits(usize, &'a StruckCase),
}

/// An answer with its seconds, by route.
enum Told {
    Frfs(crate::answers::Timed),
    Hits(struck::Timed),
}

impl Replies {
    /// Diagnoses all cases on `threads` workers, whatever their route: none waits for the last case of another. `told` hears the number of
    /// answers given so far; `frfs` and `hits` see every diagnosis with its case's position among all, on the worker that made it and after its
    /// time was taken. A case keeps to one core.
    pub fn to(
        cases: &Questions,
        threads: usize,
        told: impl Fn(usize) + Sync,
        frfs: impl Fn(usize, &Diagnosis) + Sync,
        hits: impl Fn(usize, &StruckDiagnosis) + Sync,
    ) -> Self {
        let of_frfs = cases.laboratory.iter().chain(&cases.solid).enumerate();
        let of_hits = cases.struck.iter().enumerate();
        let first_struck = cases.laboratory.len() + cases.solid.len();
        let asked: Vec<Asked> = of_frfs
            .map(|(position, case)| Asked::Frfs(position, case))
            .chain(of_hits.map(|(index, case)| Asked::Hits(first_struck + index, case)))
            .collect();
        let given = on_workers(&asked, threads, told, |asked| match asked {
            Asked::Frfs(position, case) => {
                Told::Frfs(Answers::one(case, |diagnosis| frfs(*position, diagnosis)))
            }
            Asked::Hits(position, case) => {
                Told::Hits(StruckAnswers::one(case, |diagnosis| hits(*position, diagnosis)))
            }
        });
        let mut of_frfs: Vec<_> = Vec::with_capacity(first_struck);
        let mut of_hits: Vec<_> = Vec::with_capacity(cases.struck.len());
        for (asked, told) in asked.iter().zip(given) {
            match (asked, told) {
                (Asked::Frfs(..), Some(Told::Frfs(timed))) => of_frfs.push(Some(timed)),
                (Asked::Hits(..), Some(Told::Hits(timed))) => of_hits.push(Some(timed)),
                (Asked::Frfs(..), _) => of_frfs.push(None),
                (Asked::Hits(..), _) => of_hits.push(None),
            }
        }
        let of_solids = of_frfs.split_off(cases.laboratory.len());
        Replies {
            laboratory: Answers::collected(of_frfs),
            solid: Answers::collected(of_solids),
            struck: StruckAnswers::collected(of_hits),
        }
    }

    /// The answers as JSON, in the order of the cases.
    pub fn to_value(&self) -> Value {
        let all = [self.laboratory.to_value(), self.solid.to_value(), self.struck.to_value()];
        Value::Array(
            all.into_iter().flat_map(|value| value.as_array().cloned().unwrap_or_default()).collect(),
        )
    }

    /// Seconds that each answer took, on one core, in the order of the cases.
    pub fn seconds(&self) -> Vec<f64> {
        [self.laboratory.seconds(), self.solid.seconds(), self.struck.seconds()].concat()
    }
}

/// The truth of a case of any route.
#[derive(Debug, Clone, PartialEq)]
pub enum RouteTruth {
    /// Of the laboratory.
    Laboratory(Box<Truth>),
    /// Of a solid.
    Solid(Box<SolidTruth>),
    /// Of hits.
    Struck(Box<StruckTruth>),
}

impl Sealable for RouteTruth {
    fn to_value(&self) -> Value {
        match self {
            RouteTruth::Laboratory(truth) => Truth::to_value(truth),
            RouteTruth::Solid(truth) => truth.to_value(),
            RouteTruth::Struck(truth) => truth.to_value(),
        }
    }
}

impl Filed for RouteTruth {
    fn from_value(value: &Value) -> Option<Self> {
        Some(match value["route"].as_str() {
            None => RouteTruth::Laboratory(Box::new(Truth::from_value(value)?)),
            Some("solid") => RouteTruth::Solid(Box::new(SolidTruth::from_value(value)?)),
            Some("struck") => RouteTruth::Struck(Box::new(StruckTruth::from_value(value)?)),
            Some(_) => return None,
        })
    }

    fn index(&self) -> usize {
        match self {
            RouteTruth::Laboratory(truth) => truth.index,
            RouteTruth::Solid(truth) => truth.index,
            RouteTruth::Struck(truth) => truth.index,
        }
    }
}

/// Truths after the seal was broken, by route.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Opened {
    /// Of the laboratory.
    pub laboratory: Vec<Truth>,
    /// Of solids.
    pub solid: Vec<SolidTruth>,
    /// Of hits.
    pub struck: Vec<StruckTruth>,
}

impl FromIterator<RouteTruth> for Opened {
    fn from_iter<I: IntoIterator<Item = RouteTruth>>(truths: I) -> Self {
        let mut opened = Opened::default();
        for truth in truths {
            match truth {
                RouteTruth::Laboratory(truth) => opened.laboratory.push(*truth),
                RouteTruth::Solid(truth) => opened.solid.push(*truth),
                RouteTruth::Struck(truth) => opened.struck.push(*truth),
            }
        }
        opened
    }
}

/// A route's share of the cases that the laboratory makes, and how many these are at the least for a route to have any.
const SHARE: (usize, usize) = (20, 20);

impl Plan {
    /// Solid cases, or cases of hits, that come along with so many of the laboratory's: one in twenty, none with fewer than twenty.
    pub fn along_with(cases: usize) -> usize {
        if cases < SHARE.1 { 0 } else { cases / SHARE.0 }
    }

    /// Makes the cases of all routes, their truths under one seal. A case depends on the seed (or the text), its route and its number within
    /// that alone.
    ///
    /// # Errors
    /// See [`GenerationError`].
    pub fn draw_routes(&self) -> Result<(Questions, SealedTruths<RouteTruth>), GenerationError> {
        let numbers = self.numbers()?;
        let [first_solid, first_struck] = [self.cases + self.graded, self.cases + self.graded + self.solid];
        let within = |from: usize, to: usize| -> Vec<usize> {
            numbers.iter().copied().filter(|number| (from..to).contains(number)).collect()
        };
        let (laboratory, truths) = self.drawn(&within(0, first_solid), |index| self.case(index))?;
        let mut all: Vec<RouteTruth> =
            truths.into_iter().map(|truth| RouteTruth::Laboratory(Box::new(truth))).collect();
        let (solid, truths) = self.drawn(&within(first_solid, first_struck), |index| {
            SolidTruth::draw(index, index - first_solid, self.seed)
        })?;
        all.extend(truths.into_iter().map(|truth| RouteTruth::Solid(Box::new(truth))));
        let (struck, truths) = self.drawn(&within(first_struck, usize::MAX), |index| {
            StruckTruth::draw(index, index - first_struck, self.seed, &self.families)
        })?;
        all.extend(truths.into_iter().map(|truth| RouteTruth::Struck(Box::new(truth))));
        Ok((Questions { laboratory, solid, struck }, SealedTruths::new(all)))
    }
}

/// The scores of the routes beside the laboratory's FRFs that have any case.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RouteScores(pub Vec<RouteScore>);

impl RouteScores {
    /// Scores judged cases.
    pub fn of(solid: &[SolidJudged], struck: &[StruckJudged]) -> Self {
        let all = [
            (!solid.is_empty()).then(|| solid::score(solid)),
            (!struck.is_empty()).then(|| struck::score(struck)),
        ];
        RouteScores(all.into_iter().flatten().collect())
    }

    /// The scores by route as JSON.
    pub fn to_value(&self) -> Value {
        let all: Map<String, Value> =
            self.0.iter().map(|score| (score.key.to_owned(), score.to_value())).collect();
        json!(all)
    }
}
