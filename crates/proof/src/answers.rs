//! The answers to all cases, each by a worker of its own.

use crate::answer::diagnosed;
use crate::sealable::Given;
use crate::workers::on_workers;
use crate::{Answer, Case, NoAnswer, Reply};
use jointscope_pipeline::{Answer as Diagnosed, Measurement};
use serde_json::{Value, json};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

/// The answers to all cases of a route, in their order.
#[derive(Debug)]
pub struct Answers<A = Answer> {
    all: Vec<Result<A, NoAnswer>>,
    seconds: Vec<f64>,
}

/// An answer, and the seconds it took.
pub(crate) type Timed<A> = (Result<A, NoAnswer>, f64);

impl<A: Reply + Send> Answers<A> {
    /// The answer to one case, and the seconds it took; `watch` sees the diagnosis after its time was taken.
    pub(crate) fn one<R: Clone + Into<Measurement>>(case: &Case<R>, watch: impl Fn(&Diagnosed)) -> Timed<A> {
        let start = Instant::now();
        let diagnosed =
            catch_unwind(AssertUnwindSafe(|| diagnosed(case))).unwrap_or(Err(NoAnswer::BrokeDown));
        let seconds = start.elapsed().as_secs_f64();
        let answer = diagnosed.and_then(|diagnosed| {
            watch(&diagnosed);
            A::of_diagnosed(&diagnosed).ok_or(NoAnswer::BrokeDown)
        });
        (answer, seconds)
    }

    /// Answers to all cases on `threads` workers; `told` hears the number of answers given so far. A case
    /// keeps to one core, so its seconds mean the same however many workers there are.
    pub fn by<R: Sync>(
        cases: &[Case<R>],
        threads: usize,
        progress: impl Fn(usize) + Sync,
        answer: impl Fn(&Case<R>) -> Result<A, NoAnswer> + Sync,
    ) -> Self {
        Self::collected(on_workers(cases, threads, progress, |case| {
            let start = Instant::now();
            let answer = catch_unwind(AssertUnwindSafe(|| answer(case))).unwrap_or(Err(NoAnswer::BrokeDown));
            (answer, start.elapsed().as_secs_f64())
        }))
    }

    /// What workers gave; from one that died there is no answer.
    pub(crate) fn collected(given: impl IntoIterator<Item = Option<Timed<A>>>) -> Self {
        let (all, seconds) = given.into_iter().map(|a| a.unwrap_or((Err(NoAnswer::BrokeDown), 0.0))).unzip();
        Answers { all, seconds }
    }

    /// The answers.
    pub fn all(&self) -> &[Result<A, NoAnswer>] {
        &self.all
    }

    /// Seconds that each answer took, on one core.
    pub fn seconds(&self) -> &[f64] {
        &self.seconds
    }

    /// The answers as JSON.
    pub fn to_value(&self) -> Value {
        self.values().collect()
    }

    /// Each answer as JSON.
    pub(crate) fn values(&self) -> impl Iterator<Item = Value> {
        self.all.iter().map(|answer| match answer {
            Ok(answer) => answer.to_value(),
            Err(why) => json!({ "no_answer": why.to_string() }),
        })
    }

    /// No answer to any of so many cases.
    pub fn none(cases: usize) -> Self {
        Self::collected((0..cases).map(|_| None))
    }
}

impl Given for Answers {
    fn count(&self) -> usize {
        self.all().len()
    }
}
