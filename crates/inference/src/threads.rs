//! What becomes of many items, on all threads.
//!
//! Rayon's iterators are generic down to the jobs of its threads: every use of them was eight thousand lines
//! for the compiler, a quarter of a crate that searches. Here they are compiled once, and what depends on the
//! items is a slot for each result.

use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};

/// What becomes of each item, in the order of the items whatever the number of threads.
pub fn each<'a, T: Sync, R: Send>(items: &'a [T], of: impl Fn(&'a T) -> R + Sync) -> Vec<R> {
    by_index(items.len(), &|i| of(&items[i]))
}

/// [`each`] of items that are used up.
pub fn each_used_up<T: Send, R: Send>(items: Vec<T>, of: impl Fn(T) -> R + Sync) -> Vec<R> {
    let items: Vec<Slot<T>> = items.into_iter().map(Some).map(Mutex::new).collect();
    let all = by_index(items.len(), &|i| {
        let item = items[i].lock().unwrap_or_else(PoisonError::into_inner).take();
        item.map(&of)
    });
    all.into_iter().flatten().collect()
}

type Slot<T> = Mutex<Option<T>>;

fn by_index<R: Send>(count: usize, of: &(dyn Fn(usize) -> R + Sync)) -> Vec<R> {
    let slots: Vec<Slot<R>> = (0..count).map(|_| Mutex::new(None)).collect();
    on_all_threads(count, &|i| {
        let result = of(i);
        *slots[i].lock().unwrap_or_else(PoisonError::into_inner) = Some(result);
    });
    let result = |slot: Slot<R>| slot.into_inner().unwrap_or_else(PoisonError::into_inner);
    slots.into_iter().filter_map(result).collect()
}

fn on_all_threads(count: usize, of: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().for_each(of);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_stand_in_the_order_of_the_items() {
        let items: Vec<usize> = (0..1000).collect();
        let (squares, text) = (each(&items, |i| i * i), each_used_up(items.clone(), |i| i.to_string()));
        assert!(items.iter().all(|&i| squares[i] == i * i && text[i] == i.to_string()));
        assert_eq!((squares.len(), text.len()), (1000, 1000));
        assert!(each(&[] as &[u8], |byte| *byte).is_empty());
    }

    #[test]
    fn results_may_borrow_from_the_items() {
        let items = ["one".to_owned(), "two".to_owned()];
        let starts: Vec<&str> = each(&items, |item| &item[..1]);
        assert_eq!(starts, ["o", "t"]);
    }
}
