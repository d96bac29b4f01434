//! Cases by several routes: the laboratory's FRFs, the FRFs of solids, hits over time; one seal on all their truths.
//!
//! The laboratory and the diagnosis model the same assembly, of rigid blocks and massless beams, in two programs. The two other routes do
//! not: a solid is meshed and has mass, shear and layers of its own; hits are integrated step by step, and no FRF is computed on the way.

mod score;
mod solid;
mod struck;

pub use score::{RouteScore, RouteScores};
pub use solid::{Shown, SolidJudged, SolidTruth};
pub use struck::{StruckAnswer, StruckAnswers, StruckCase, StruckJudged, StruckRole, StruckTruth};

use crate::answers::on_workers;
use crate::seal::{Filed, Given, Sealable};
use crate::{Answers, Case, FileError, GenerationError, Plan, Precision, SealedTruths, Truth};
use jointscope_fixture::Fixture;
use jointscope_pipeline::Answer as Diagnosed;
use serde::Deserialize;
use serde_json::Value;

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
    /// Every case, route after route.
    pub fn all(&self) -> Vec<Asked<'_>> {
        let of_frfs = self.laboratory.iter().chain(&self.solid).map(Asked::Frfs);
        of_frfs.chain(self.struck.iter().map(Asked::Hits)).collect()
    }
}

/// A case by what its recording holds.
#[derive(Debug, Clone, Copy)]
pub enum Asked<'a> {
    /// FRFs, of the laboratory or of a solid.
    Frfs(&'a Case),
    /// Hits over time.
    Hits(&'a StruckCase),
}

impl Asked<'_> {
    /// The fixture as the analyst believes it.
    pub fn believed(&self) -> &Fixture {
        match self {
            Asked::Frfs(case) => &case.believed,
            Asked::Hits(case) => &case.believed,
        }
    }

    /// The recording as a universal file (58b).
    ///
    /// # Errors
    /// A point whose name is no node number.
    pub fn recording(&self, precision: Precision) -> Result<Vec<u8>, FileError> {
        match self {
            Asked::Frfs(case) => case.recording(precision),
            Asked::Hits(case) => case.recording(precision),
        }
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

impl Replies {
    /// Diagnoses all cases on `threads` workers, whatever their route: none waits for the last case of another. `told` hears the number of
    /// answers given so far; `watch` sees every diagnosis with its case's position among all, on the worker that made it and after its time was
    /// taken. A case keeps to one core.
    pub fn to(
        cases: &Questions,
        threads: usize,
        told: impl Fn(usize) + Sync,
        watch: impl Fn(usize, &Diagnosed) + Sync,
    ) -> Self {
        let asked: Vec<_> = cases.all().into_iter().enumerate().collect();
        let given = on_workers(&asked, threads, told, |(position, asked)| {
            let watch = |diagnosed: &Diagnosed| watch(*position, diagnosed);
            match asked {
                Asked::Frfs(case) => (Some(Answers::one(case, watch)), None),
                Asked::Hits(case) => (None, Some(Answers::one(case, watch))),
            }
        });
        // A worker that died has left neither.
        let (mut frfs, hits): (Vec<_>, Vec<_>) = given.into_iter().map(Option::unwrap_or_default).unzip();
        let mut later = frfs.split_off(cases.laboratory.len());
        later.truncate(cases.solid.len());
        Replies {
            laboratory: Answers::collected(frfs),
            solid: Answers::collected(later),
            struck: Answers::collected(hits.into_iter().skip(cases.laboratory.len() + cases.solid.len())),
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
            RouteTruth::Laboratory(truth) => truth.to_value(),
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
            Some("struck") => RouteTruth::Struck(Box::new(StruckTruth::deserialize(value).ok()?)),
            Some(_) => return None,
        })
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
