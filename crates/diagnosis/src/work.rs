//! How much a diagnosis may do, and how much it has done.
//!
//! Work is counted in predicted values of FRFs, so that the same input ends at the same place on any machine
//! and any number of threads. It is asked for only where no others work at the same time. What a search does
//! not come to any more is remembered by name.

use crate::settings::work::costs::{CUBE_OF_COORDINATES, MODEL};
use crate::settings::work::shares::FITS_TOGETHER;
use jointscope_inference::each_used_up;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Work done and allowed.
#[derive(Debug)]
pub(crate) struct Work {
    done: AtomicU64,
    /// What one model costs besides the values it predicts.
    model: u64,
    /// All that may be done, and all that may be done by what is under way.
    total: u64,
    most: AtomicU64,
    until: Option<Instant>,
    left_out: Mutex<Vec<&'static str>>,
}

impl Default for Work {
    fn default() -> Self {
        Work::of(u64::MAX, None)
    }
}

impl Work {
    /// So many values at the most, and for so long.
    pub(crate) fn of(most: u64, time: Option<Duration>) -> Self {
        let until = time.and_then(|time| Instant::now().checked_add(time));
        Work {
            done: AtomicU64::new(0),
            model: MODEL,
            total: most,
            most: AtomicU64::new(most),
            until,
            left_out: Mutex::default(),
        }
    }

    /// The same for models of so many coordinates: modes of a meshed beam cost more than its lines.
    pub(crate) fn for_models_of(self, coordinates: usize) -> Self {
        Work { model: MODEL + (coordinates as u64).pow(3) / CUBE_OF_COORDINATES, ..self }
    }

    /// Counts a model and the values that it predicts.
    pub(crate) fn count(&self, values: usize) {
        self.done.fetch_add(self.model + values as u64, Ordering::Relaxed);
    }

    /// Share of the work that is done already.
    pub(crate) fn spent(&self) -> f64 {
        self.done.load(Ordering::Relaxed) as f64 / self.total as f64
    }

    /// What `of` comes to where it may do no more than a share of all work.
    pub(crate) fn within<T>(&self, share: f64, of: impl FnOnce() -> T) -> T {
        let most = self.most.load(Ordering::Relaxed);
        let own = self.done.load(Ordering::Relaxed).saturating_add((share * self.total as f64) as u64);
        self.most.store(most.min(own), Ordering::Relaxed);
        let outcome = of();
        self.most.store(most, Ordering::Relaxed);
        outcome
    }

    /// What `of` comes to where it may do no more than a share of what is left: something is to follow.
    pub(crate) fn within_rest<T>(&self, share: f64, of: impl FnOnce() -> T) -> T {
        let left = self.most.load(Ordering::Relaxed).saturating_sub(self.done.load(Ordering::Relaxed));
        self.within(share * left as f64 / self.total as f64, of)
    }

    /// The same for what is tried beside the way to an answer: that it did not come to all it would have done
    /// is not remembered.
    pub(crate) fn aside<T>(&self, share: f64, of: impl FnOnce() -> T) -> T {
        let before = self.left_out();
        let outcome = self.within(share, of);
        *self.left_out.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) = before;
        outcome
    }

    /// Whether `what` may still be done; if not, that is remembered.
    pub(crate) fn allows(&self, what: &'static str) -> bool {
        let spent = self.done.load(Ordering::Relaxed) >= self.most.load(Ordering::Relaxed);
        let late = self.until.is_some_and(|until| Instant::now() >= until);
        if !(spent || late) {
            return true;
        }
        // A thread that panicked while it held the list leaves it whole.
        let mut left_out = self.left_out.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if !left_out.contains(&what) {
            left_out.push(what);
        }
        false
    }

    /// What was not done any more, in the order in which it was asked for.
    pub(crate) fn left_out(&self) -> Vec<&'static str> {
        self.left_out.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).clone()
    }

    /// What becomes of each of several items, as far as there is work left for `what`, some at a time on all
    /// threads.
    pub(crate) fn each<T: Send, R: Send>(
        &self,
        items: Vec<T>,
        what: &'static str,
        of: impl Fn(T) -> Option<R> + Sync,
    ) -> Vec<R> {
        let mut all = Vec::with_capacity(items.len());
        let mut items = items.into_iter();
        loop {
            let some: Vec<T> = items.by_ref().take(FITS_TOGETHER).collect();
            if some.is_empty() || !self.allows(what) {
                return all;
            }
            all.extend(each_used_up(some, &of).into_iter().flatten());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_over_when_the_work_is_done_is_remembered_once() {
        let work = Work::of(20 * (MODEL + 10), None);
        let done = work.each((0..100).collect(), "numbers", |n| {
            work.count(10);
            Some(n)
        });
        assert_eq!(done, (0..32).collect::<Vec<_>>());
        assert!(!work.allows("numbers") && !work.allows("letters"));
        assert_eq!(work.left_out(), ["numbers", "letters"]);
    }

    #[test]
    fn a_step_that_may_take_half_of_what_is_left_leaves_the_other_half() {
        let work = Work::of(100 * MODEL, None);
        work.count(19 * MODEL as usize);
        let count = || {
            work.each((0..100).collect(), "numbers", |n| {
                work.count(0);
                Some(n)
            })
        };
        // Eighty models are left; of forty, two and a half times sixteen, what has begun is ended.
        assert_eq!(work.within_rest(0.5, count).len(), 3 * FITS_TOGETHER);
        assert!(work.allows("letters"));
        assert_eq!(count().len(), 2 * FITS_TOGETHER);
        assert!(!work.allows("letters"));
    }

    #[test]
    fn what_is_tried_aside_leaves_the_rest_of_the_work() {
        let work = Work::of(20 * MODEL, None);
        let done = work.aside(0.5, || {
            work.each((0..100).collect(), "numbers", |n| {
                work.count(0);
                Some(n)
            })
        });
        assert_eq!(done.len(), FITS_TOGETHER);
        assert!(work.allows("letters") && work.left_out().is_empty());
    }

    #[test]
    fn a_time_that_is_over_ends_it_too() {
        assert!(!Work::of(u64::MAX, Some(Duration::ZERO)).allows("anything"));
        assert!(
            Work::of(u64::MAX, Some(Duration::MAX)).allows("anything") && Work::default().allows("anything")
        );
    }
}
