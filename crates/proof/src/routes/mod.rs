//! Cases by several routes: the laboratory's FRFs, the FRFs of solids, hits over time; one seal on all their truths.
//!
//! The laboratory and the diagnosis model the same assembly, of rigid blocks and massless beams, in two programs. The other routes do
//! not: a solid is meshed and has mass, shear and layers of its own; hits are integrated step by step, and no FRF is computed on the way; solids as they
//! are, and structures with errors in every mode, are such that no fixture is right to the noise; lumped cases hide what the laboratory's own do not.
//!
//! A route is a module that draws a case and its truth, judges an answer by that truth, and scores what was judged; here they come together.

mod as_is;
mod by_name;
mod judged;
mod lumped;
mod modal_errors;
mod quiet;
mod score;
mod solid;
mod struck;

pub use as_is::{AsIsJudged, AsIsTruth};
pub use by_name::{Nameable, TrueName};
pub use judged::JudgedRoutes;
pub use lumped::{LumpedJudged, LumpedRoute, LumpedTruth};
pub use modal_errors::{ModalErrorsJudged, ModalErrorsTruth};
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
    /// FRFs of solids as they are.
    pub as_is: Vec<Case>,
    /// FRFs of structures with errors in every mode.
    pub modal_errors: Vec<Case>,
    /// FRFs of lumped structures that hide one thing of a route's own.
    pub lumped: Vec<Case>,
}

impl Questions {
    /// Every case, route after route.
    pub fn all(&self) -> Vec<Asked<'_>> {
        let first = self.laboratory.iter().chain(&self.solid).map(Asked::Frfs);
        let last = self.as_is.iter().chain(&self.modal_errors).chain(&self.lumped).map(Asked::Frfs);
        first.chain(self.struck.iter().map(Asked::Hits)).chain(last).collect()
    }
}

/// A case by what its recording holds.
#[derive(Debug, Clone, Copy)]
pub enum Asked<'a> {
    /// FRFs, of whatever route.
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
    /// To FRFs of solids as they are.
    pub as_is: Answers,
    /// To those of structures with errors in every mode.
    pub modal_errors: Answers,
    /// To those of lumped structures that hide one thing of a route's own.
    pub lumped: Answers,
}

impl Given for Replies {
    fn count(&self) -> usize {
        self.seconds().len()
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
        let mut given = given.into_iter().map(Option::unwrap_or_default);
        let mut of_frfs =
            |of: &[Case]| Answers::collected(given.by_ref().take(of.len()).map(|(frfs, _)| frfs));
        let (laboratory, solid) = (of_frfs(&cases.laboratory), of_frfs(&cases.solid));
        let struck = Answers::collected(given.by_ref().take(cases.struck.len()).map(|(_, hits)| hits));
        let mut of_frfs =
            |of: &[Case]| Answers::collected(given.by_ref().take(of.len()).map(|(frfs, _)| frfs));
        let (as_is, modal_errors) = (of_frfs(&cases.as_is), of_frfs(&cases.modal_errors));
        let lumped = of_frfs(&cases.lumped);
        Replies { laboratory, solid, struck, as_is, modal_errors, lumped }
    }

    /// The answers as JSON, in the order of the cases.
    pub fn to_value(&self) -> Value {
        let first = &[&self.laboratory, &self.solid];
        let last = &[&self.as_is, &self.modal_errors, &self.lumped];
        let of_frfs = |all: &[&Answers]| all.iter().map(|answers| answers.to_value()).collect::<Vec<_>>();
        let all = [of_frfs(first), vec![self.struck.to_value()], of_frfs(last)].concat();
        Value::Array(
            all.into_iter().flat_map(|value| value.as_array().cloned().unwrap_or_default()).collect(),
        )
    }

    /// Seconds that each answer took, on one core, in the order of the cases.
    pub fn seconds(&self) -> Vec<f64> {
        let Replies { laboratory, solid, struck, as_is, modal_errors, lumped } = self;
        let (first, last) = ([laboratory, solid], [as_is, modal_errors, lumped]);
        let of_frfs = |all: &[&Answers]| all.iter().flat_map(|answers| answers.seconds().to_vec()).collect();
        [of_frfs(&first), struck.seconds().to_vec(), of_frfs(&last)].concat()
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
    /// Of a solid as it is.
    AsIs(Box<AsIsTruth>),
    /// Of a structure with errors in every mode.
    ModalErrors(Box<ModalErrorsTruth>),
    /// Of a lumped structure that hides one thing of a route's own.
    Lumped(Box<LumpedTruth>),
}

impl Sealable for RouteTruth {
    fn to_value(&self) -> Value {
        match self {
            RouteTruth::Laboratory(truth) => truth.to_value(),
            RouteTruth::Solid(truth) => truth.to_value(),
            RouteTruth::Struck(truth) => truth.to_value(),
            RouteTruth::AsIs(truth) => truth.to_value(),
            RouteTruth::ModalErrors(truth) => truth.to_value(),
            RouteTruth::Lumped(truth) => truth.to_value(),
        }
    }
}

impl Filed for RouteTruth {
    fn from_value(value: &Value) -> Option<Self> {
        Some(match value["route"].as_str() {
            None => RouteTruth::Laboratory(Box::new(Truth::from_value(value)?)),
            Some("solid") => RouteTruth::Solid(Box::new(SolidTruth::from_value(value)?)),
            Some("struck") => RouteTruth::Struck(Box::new(StruckTruth::deserialize(value).ok()?)),
            Some("solid_as_is") => RouteTruth::AsIs(Box::new(AsIsTruth::from_value(value)?)),
            Some("modal_errors") => RouteTruth::ModalErrors(Box::new(ModalErrorsTruth::from_value(value)?)),
            Some(_) => RouteTruth::Lumped(Box::new(LumpedTruth::from_value(value)?)),
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
    /// Of solids as they are.
    pub as_is: Vec<AsIsTruth>,
    /// Of structures with errors in every mode.
    pub modal_errors: Vec<ModalErrorsTruth>,
    /// Of lumped structures that hide one thing of a route's own.
    pub lumped: Vec<LumpedTruth>,
}

impl FromIterator<RouteTruth> for Opened {
    fn from_iter<I: IntoIterator<Item = RouteTruth>>(truths: I) -> Self {
        let mut opened = Opened::default();
        for truth in truths {
            match truth {
                RouteTruth::Laboratory(truth) => opened.laboratory.push(*truth),
                RouteTruth::Solid(truth) => opened.solid.push(*truth),
                RouteTruth::Struck(truth) => opened.struck.push(*truth),
                RouteTruth::AsIs(truth) => opened.as_is.push(*truth),
                RouteTruth::ModalErrors(truth) => opened.modal_errors.push(*truth),
                RouteTruth::Lumped(truth) => opened.lumped.push(*truth),
            }
        }
        opened
    }
}

/// A route's share of the cases that the laboratory makes, and how many these are at the least for a route to have any.
const SHARE: (usize, usize) = (20, 20);

impl Plan {
    /// Cases of each other route that come along with so many of the laboratory's: one in twenty, none with fewer than twenty.
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
        let mut first = 0;
        // The numbers of a route of so many cases, and its first.
        let mut route = |count: usize| -> (Vec<usize>, usize) {
            let from = first;
            first += count;
            (numbers.iter().copied().filter(|number| (from..first).contains(number)).collect(), from)
        };
        let mut all = Vec::with_capacity(numbers.len());
        let (own, _) = route(self.cases + self.graded);
        let (laboratory, truths) = self.drawn(&own, |index| self.case(index))?;
        all.extend(truths.into_iter().map(|truth| RouteTruth::Laboratory(Box::new(truth))));
        let (own, from) = route(self.solid);
        let (solid, truths) = self.drawn(&own, |index| SolidTruth::draw(index, index - from, self.seed))?;
        all.extend(truths.into_iter().map(|truth| RouteTruth::Solid(Box::new(truth))));
        let (own, from) = route(self.struck);
        let draw = |index| StruckTruth::draw(index, index - from, self.seed, &self.families);
        let (struck, truths) = self.drawn(&own, draw)?;
        all.extend(truths.into_iter().map(|truth| RouteTruth::Struck(Box::new(truth))));
        let (own, from) = route(self.solid_as_is);
        let (as_is, truths) = self.drawn(&own, |index| AsIsTruth::draw(index, index - from, self.seed))?;
        all.extend(truths.into_iter().map(|truth| RouteTruth::AsIs(Box::new(truth))));
        let (own, from) = route(self.modal_errors);
        let (modal_errors, truths) =
            self.drawn(&own, |index| ModalErrorsTruth::draw(index, index - from, self))?;
        all.extend(truths.into_iter().map(|truth| RouteTruth::ModalErrors(Box::new(truth))));
        let mut lumped = Vec::new();
        for of in LumpedRoute::ALL {
            let (own, from) = route(of.count(self));
            let (cases, truths) =
                self.drawn(&own, |index| LumpedTruth::draw(of, index, index - from, self))?;
            lumped.extend(cases);
            all.extend(truths.into_iter().map(|truth| RouteTruth::Lumped(Box::new(truth))));
        }
        let questions = Questions { laboratory, solid, struck, as_is, modal_errors, lumped };
        Ok((questions, SealedTruths::new(all)))
    }
}
