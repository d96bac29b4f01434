//! The answers to all cases, each by a worker of its own.

use crate::answer::diagnosed;
use crate::{Answer, Case, NoAnswer, Reply};
use jointscope_pipeline::{Answer as Diagnosed, Measurement};
use rayon::ThreadPoolBuilder;
use serde_json::{Value, json};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
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

    /// Answers to all cases on `threads` workers; `told` hears the number of answers given so far. A case keeps to one core, so its seconds
    /// mean the same however many workers there are.
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

/// Maps `items` on `threads` workers, each with a pool of one thread for whatever runs within; results keep the items' order.
/// `None` where a worker died over an item.
pub(crate) fn on_workers<T: Sync, U: Send>(
    items: &[T],
    threads: usize,
    progress: impl Fn(usize) + Sync,
    work: impl Fn(&T) -> U + Sync,
) -> Vec<Option<U>> {
    let results: Vec<Mutex<Option<U>>> = items.iter().map(|_| Mutex::new(None)).collect();
    let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let worker = || {
        // Without a pool of its own a worker would lend its time to another's case, and neither could be timed.
        let pool = ThreadPoolBuilder::new().num_threads(1).build().ok();
        while let Some(index) = Some(next.fetch_add(1, Ordering::Relaxed)).filter(|i| *i < items.len()) {
            let result = match &pool {
                Some(pool) => pool.install(|| work(&items[index])),
                None => work(&items[index]),
            };
            if let Ok(mut slot) = results[index].lock() {
                *slot = Some(result);
            }
            progress(done.fetch_add(1, Ordering::Relaxed) + 1);
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, items.len().max(1)) {
            scope.spawn(worker);
        }
    });
    results.into_iter().map(|slot| slot.into_inner().ok().flatten()).collect()
}
