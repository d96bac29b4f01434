//! What the diagnosis is worth: concealed cases, sealed truths, scores with their uncertainty.
//!
//! A [`Plan`] draws random assemblies in the simulated laboratory, true quantities within the stated
//! tolerances, hidden physics and a noisy hammer test. The diagnosis gets the [`Case`], fixture and
//! recording, and nothing else; the [`Truth`] stays in [`SealedTruths`], which give it out only against the
//! [`Answers`] to all cases, and whose SHA-256 is known before the first. Then [`Judged`] lays truth and
//! answer side by side: the laboratory's own model is fitted about the truth ([`Reference`]), and a name
//! counts as right if it is the truth or fits within [`AS_GOOD`] of that. [`Score`] counts.
//!
//! | theme | items |
//! |---|---|
//! | making cases | [`Plan`], [`Case`], [`Truth`], [`Role`], [`SealedTruths`] |
//! | cases by other routes | [`Plan::draw_routes`], [`Questions`], [`RouteTruth`], [`Replies`], [`Opened`]; [`SolidTruth`]; [`StruckCase`], [`StruckTruth`]; [`AsIsTruth`]; [`ModalErrorsTruth`]; [`LumpedTruth`] |
//! | answers | [`Answers`], [`Answer`], [`Reply`], [`Found`], [`Timing`] |
//! | judging | [`Judged`], [`IndependentFits`], [`Reference`], [`Name`] |
//! | what else one could do | [`Baseline`], [`Methods`] |
//! | limits of a test | [`Limits`] |
//! | scores | [`Score`], [`Rate`], [`Share`], [`Reliability`], [`Confusion`], [`Detection`], [`Coverage`] |
//! | scores by route | [`RouteScores`], [`RouteScore`], [`SizeScore`], [`CaseLine`] |
//! | real recordings | [`concealed`]: something concealed relative to a fixture that explains them |
//!
//! Nothing is random but by the seed: cases, answers and scores are the same on any number of threads.
//!
//! ```
//! use jointscope_proof::{Answers, Judged, NoAnswer, Plan, Score};
//!
//! let plan = Plan { cases: 2, ..Plan::default() };
//! let (cases, sealed) = plan.draw()?;
//! let published = sealed.digest().to_owned();
//! // Somebody who never answers, in place of `Answers::by(&cases, 1, |_| (), Answer::of)`.
//! let answers = Answers::by(&cases, 1, |_| (), |_| Err(NoAnswer::BrokeDown));
//! let truths = sealed.open(&answers).ok_or("answers are missing")?;
//! let score = Score::of(&Judged::all(&cases, truths, &answers, 1, |_| ()));
//! assert_eq!(published.len(), 64);
//! assert_eq!(score.rate("nulls_consistent").map(|rate| rate.share.of), Some(0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod answer;
mod answers;
mod baseline;
mod case;
mod case_draft;
mod case_line;
pub mod concealed;
mod confusion;
mod coverage;
mod detection;
mod effect_file;
mod generate;
mod generation_error;
mod graded;
mod hammer_test;
mod judge;
mod judged;
mod laboratory;
mod limits;
mod name;
mod objective;
mod plan_table;
mod planning;
mod random;
mod reference;
mod reliability;
mod role;
mod routes;
mod score;
mod seal;
mod sealable;
mod sensitivity;
mod sheet;
mod size;
mod statistics;
mod strength;
mod timing;
mod truth;
mod workers;

pub use answer::{Answer, Found, NoAnswer, Reply};
pub use answers::Answers;
pub use baseline::{Baseline, Lookup, Method, Methods, Updated, WIDER};
pub use case::Case;
pub use case_line::CaseLine;
pub use confusion::{Confusion, NOTHING};
pub use coverage::Coverage;
pub use detection::{Detection, SizeClass, Smallest};
pub use generate::{FAMILIES, HIDDEN_KINDS, Plan};
pub use generation_error::GenerationError;
pub use jointscope_rig::Family;
pub use jointscope_rig::universal_file::{FileError, Precision};
pub use judged::{AS_GOOD, IndependentFits, Judgeable, Judged, PLAIN, VISIBLE};
pub use limits::{Alike, Limits, SmallestShown};
pub use name::Name;
pub(crate) use name::describe;
pub use planning::{PlannedCase, Planning, PromiseClass};
pub use reference::Reference;
pub use reliability::{Bin, Reliability};
pub use role::Role;
pub use routes::{
    AsIsTruth, Asked, LumpedRoute, LumpedTruth, ModalErrorsTruth, Nameable, Opened, Questions, Replies,
    RouteScore, RouteScores, RouteTruth, Shown, SolidTruth, StruckAnswer, StruckAnswers, StruckCase,
    StruckRole, StruckTruth, TrueName,
};
pub use score::{CHANCE, FreshComparison, Score, VerdictCounts};
pub use seal::{BrokenSeal, SealedTruths};
pub use sealable::{Filed, Given, Sealable};
pub use sheet::{Rate, RoleCount, ScoredFigure, Sheet, Target, TargetStatus};
pub use size::{Size, SizeScore};
pub use statistics::Share;
pub use timing::Timing;
pub use truth::Truth;
