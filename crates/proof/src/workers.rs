//! Work on many items at once, an item a core.

use rayon::ThreadPoolBuilder;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Maps `items` on `threads` workers, each with a pool of one thread for whatever runs within; results keep
/// the items' order. `None` where a worker died over an item.
pub(crate) fn on_workers<T: Sync, U: Send>(
    items: &[T],
    threads: usize,
    progress: impl Fn(usize) + Sync,
    work: impl Fn(&T) -> U + Sync,
) -> Vec<Option<U>> {
    let results: Vec<Mutex<Option<U>>> = items.iter().map(|_| Mutex::new(None)).collect();
    let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let worker = || {
        // Without a pool of its own a worker would lend its time to another's case, and neither could be
        // timed.
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
