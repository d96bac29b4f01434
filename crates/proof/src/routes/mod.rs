//! Cases by several routes: the laboratory's FRFs, the FRFs of solids, hits over time; one seal on all their
//! truths.
//!
//! The laboratory and the diagnosis model the same assembly, of rigid blocks and massless beams, in two
//! programs. The other routes do not: a solid is meshed and has mass, shear and layers of its own; hits are
//! integrated step by step, and no FRF is computed on the way; solids as they are, and structures with errors
//! in every mode, are such that no fixture is right to the noise; lumped cases hide what the laboratory's own
//! do not.
//!
//! A route is a module that draws a case and its truth, judges an answer by that truth, and scores what was
//! judged; here they come together.
//!
//! Which routes there are is said once, at the end of this file; beside that a route has a count in [`Plan`].

mod as_is;
mod by_name;
mod lumped;
mod modal_errors;
mod quiet;
mod score;
mod solid;
mod struck;

pub use as_is::AsIsTruth;
pub use by_name::{Nameable, TrueName};
pub use lumped::{LumpedRoute, LumpedTruth};
pub use modal_errors::ModalErrorsTruth;
pub use score::{RouteScore, RouteScores};
pub use solid::{Shown, SolidTruth};
pub(crate) use struck::StruckJudged;
pub use struck::{StruckAnswer, StruckAnswers, StruckCase, StruckRole, StruckTruth};

use crate::answers::Timed;
use crate::generate::Draw;
use crate::sealable::{Filed, Given, Sealable};
use crate::size::SizeScore;
use crate::workers::on_workers;
use crate::{
    Answer, Answers, Case, FileError, GenerationError, Judged, Plan, Precision, SealedTruths, Sheet, Truth,
};
use by_name::{ONE_OR_NONE, UNLISTED, WRONG_EVERYWHERE};
use jointscope_fixture::Fixture;
use jointscope_pipeline::Answer as Diagnosed;
use serde_json::Value;
use std::sync::atomic::{AtomicUsize, Ordering};

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

/// An answer by what its case's recording holds.
enum Replied {
    Frfs(Timed<Answer>),
    Hits(Timed<StruckAnswer>),
}

impl Given for Replies {
    fn count(&self) -> usize {
        self.seconds().len()
    }
}

/// A route's share of the cases that the laboratory makes, and how many these are at the least for a route to
/// have any.
const SHARE: (usize, usize) = (20, 20);

impl Plan {
    /// Cases of each other route that come along with so many of the laboratory's: one in twenty, none with
    /// fewer than twenty.
    pub fn along_with(cases: usize) -> usize {
        if cases < SHARE.1 { 0 } else { cases / SHARE.0 }
    }
}

/// Defines whatever holds something of every route, and how routes are drawn, judged and scored.
///
/// A line is a route beside the laboratory's, in the order in which cases are numbered: its key in files,
/// which is its field here and its count in [`Plan`], what is true of a case; what a recording holds, with
/// the types of case and answers; where recordings come from, in words; how a case is drawn, how all are
/// judged, and how they are scored.
macro_rules! routes {
    ($(
        $key:ident: $Route:ident($Truth:ty), $Recording:ident($Case:ty => $Answers:ty), $what:literal,
        $draw:expr, $judge:expr, $score:expr;
    )+) => {
        /// What is to be diagnosed, by route.
        #[derive(Debug, Clone, PartialEq, Default)]
        pub struct Questions {
            /// The laboratory's FRFs.
            pub laboratory: Vec<Case>,
            $(#[doc = $what] pub $key: Vec<$Case>,)+
        }

        impl Questions {
            /// Every case, route after route.
            pub fn all(&self) -> Vec<Asked<'_>> {
                let mut all: Vec<_> = self.laboratory.iter().map(Asked::Frfs).collect();
                $(all.extend(self.$key.iter().map(Asked::$Recording));)+
                all
            }
        }

        /// What was answered, by route.
        #[derive(Debug)]
        pub struct Replies {
            /// The laboratory's FRFs.
            pub laboratory: Answers,
            $(#[doc = $what] pub $key: $Answers,)+
        }

        impl Replies {
            /// Diagnoses all cases on `threads` workers, whatever their route: none waits for the last case
            /// of another. `told` hears the number of answers given so far; `watch` sees every diagnosis with
            /// its case's position among all, on the worker that made it and after its time was taken. A case
            /// keeps to one core.
            pub fn to(
                cases: &Questions,
                threads: usize,
                progress: impl Fn(usize) + Sync,
                watch: impl Fn(usize, &Diagnosed) + Sync,
            ) -> Self {
                let asked: Vec<_> = cases.all().into_iter().enumerate().collect();
                let replied = on_workers(&asked, threads, progress, |(position, asked)| {
                    let watch = |diagnosed: &Diagnosed| watch(*position, diagnosed);
                    match asked {
                        Asked::Frfs(case) => Replied::Frfs(Answers::one(case, watch)),
                        Asked::Hits(case) => Replied::Hits(Answers::one(case, watch)),
                    }
                });
                let mut replied = replied.into_iter();
                let own = |replied| if let Some(Replied::Frfs(answer)) = replied { Some(answer) } else { None };
                let laboratory =
                    Answers::collected(replied.by_ref().take(cases.laboratory.len()).map(own));
                $(
                    let own = |replied| match replied {
                        Some(Replied::$Recording(answer)) => Some(answer),
                        _ => None,
                    };
                    let $key = Answers::collected(replied.by_ref().take(cases.$key.len()).map(own));
                )+
                Replies { laboratory, $($key),+ }
            }

            /// No answer to any case.
            pub fn none(cases: &Questions) -> Self {
                Replies {
                    laboratory: Answers::none(cases.laboratory.len()),
                    $($key: Answers::none(cases.$key.len()),)+
                }
            }

            /// The answers as JSON, in the order of the cases.
            pub fn to_value(&self) -> Value {
                self.laboratory.values()$(.chain(self.$key.values()))+.collect()
            }

            /// Seconds that each answer took, on one core, in the order of the cases.
            pub fn seconds(&self) -> Vec<f64> {
                [self.laboratory.seconds(), $(self.$key.seconds()),+].concat()
            }
        }

        /// The truth of a case of any route.
        #[derive(Debug, Clone, PartialEq)]
        pub enum RouteTruth {
            /// The laboratory's FRFs.
            Laboratory(Box<Truth>),
            $(#[doc = $what] $Route(Box<$Truth>),)+
        }

        impl Sealable for RouteTruth {
            fn to_value(&self) -> Value {
                match self {
                    RouteTruth::Laboratory(truth) => truth.to_value(),
                    $(RouteTruth::$Route(truth) => truth.to_value(),)+
                }
            }
        }

        impl Filed for RouteTruth {
            fn from_value(value: &Value) -> Option<Self> {
                Some(match value["route"].as_str() {
                    None => RouteTruth::Laboratory(Box::new(Truth::from_value(value)?)),
                    $(Some(stringify!($key)) => RouteTruth::$Route(Box::new(<$Truth>::from_value(value)?)),)+
                    Some(_) => return None,
                })
            }
        }

        /// Truths after the seal was broken, by route.
        #[derive(Debug, Clone, PartialEq, Default)]
        pub struct Opened {
            /// The laboratory's FRFs.
            pub laboratory: Vec<Truth>,
            $(#[doc = $what] pub $key: Vec<$Truth>,)+
        }

        impl FromIterator<RouteTruth> for Opened {
            fn from_iter<I: IntoIterator<Item = RouteTruth>>(truths: I) -> Self {
                let mut opened = Opened::default();
                for truth in truths {
                    match truth {
                        RouteTruth::Laboratory(truth) => opened.laboratory.push(*truth),
                        $(RouteTruth::$Route(truth) => opened.$key.push(*truth),)+
                    }
                }
                opened
            }
        }

        impl Plan {
            /// Number of cases of each route beside the laboratory's, by its key in files.
            pub(crate) fn by_route(&self) -> Vec<(&'static str, usize)> {
                vec![$((stringify!($key), self.$key)),+]
            }

            /// Makes the cases of all routes, their truths under one seal. A case depends on the seed (or the
            /// text), its route and its number within that alone.
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
                $(
                    let draw: fn(Draw) -> Result<($Case, $Truth), GenerationError> = $draw;
                    let (own, from) = route(self.$key);
                    let ($key, truths) =
                        self.drawn(&own, |index| draw(Draw::of(self, stringify!($key), index, index - from)))?;
                    all.extend(truths.into_iter().map(|truth| RouteTruth::$Route(Box::new(truth))));
                )+
                Ok((Questions { laboratory, $($key),+ }, SealedTruths::new(all)))
            }
        }

        impl RouteScores {
            /// Judges all cases beside the laboratory's on `threads` workers and scores them by route; `told`
            /// hears the number of cases of FRFs judged so far.
            pub fn of(
                cases: &Questions,
                truths: Opened,
                answers: &Replies,
                threads: usize,
                progress: impl Fn(usize) + Sync,
            ) -> Self {
                let done = AtomicUsize::new(0);
                let progress = |_: usize| progress(done.fetch_add(1, Ordering::Relaxed) + 1);
                let mut scores = Vec::new();
                $(if !cases.$key.is_empty() {
                    let score: fn(&[_]) -> (Sheet, Vec<SizeScore>) = $score;
                    let judge = $judge;
                    let (sheet, sizes) = score(&judge(&cases.$key, truths.$key, &answers.$key, threads, &progress));
                    scores.push(RouteScore { key: stringify!($key), what: $what, sheet, sizes });
                })+
                RouteScores(scores)
            }
        }
    };
}

routes! {
    solid: Solid(SolidTruth), Frfs(Case => Answers),
        "recordings of the finite-element twin of two solid blocks on a strip",
        SolidTruth::draw, Judged::all, solid::score;
    struck: Struck(StruckTruth), Hits(StruckCase => StruckAnswers),
        "hits over time on joints that may depend on amplitude",
        StruckTruth::draw, |_, truths, answers, _, _| StruckJudged::all(truths, answers), struck::score;
    solid_as_is: AsIs(AsIsTruth), Frfs(Case => Answers),
        "recordings of the finite-element twin of two solid blocks on a strip, nothing idealised",
        AsIsTruth::draw, Judged::all, |judged| by_name::score(WRONG_EVERYWHERE, judged);
    modal_errors: ModalErrors(ModalErrorsTruth), Frfs(Case => Answers),
        "recordings of lumped structures with an error in every mode",
        ModalErrorsTruth::draw, Judged::all, |judged| by_name::score(WRONG_EVERYWHERE, judged);
    channel_flaws: ChannelFlaws(LumpedTruth), Frfs(Case => Answers),
        "recordings of lumped structures by a measuring chain with one flaw or none",
        |at| LumpedTruth::draw(LumpedRoute::ChannelFlaws, at), Judged::all, |judged| by_name::score(ONE_OR_NONE, judged);
    load_paths: LoadPaths(LumpedTruth), Frfs(Case => Answers),
        "recordings of lumped structures with one further load path, footings that turn, or neither",
        |at| LumpedTruth::draw(LumpedRoute::LoadPaths, at), Judged::all, |judged| by_name::score(ONE_OR_NONE, judged);
    unknown_physics: UnknownPhysics(LumpedTruth), Frfs(Case => Answers),
        "recordings of lumped structures with physics that no effect is, small and large",
        |at| LumpedTruth::draw(LumpedRoute::UnknownPhysics, at), Judged::all, |judged| by_name::score(UNLISTED, judged);
}
