//! Undamped modes that were asked for a moment ago.
//!
//! A fit moves many quantities that leave the matrices alone (damping, where sensors sit, everything of the
//! measuring chain), and the eigenproblem costs as much as hundreds of lines, that of a meshed beam more than
//! all of them.

use crate::condensed::{Stretch, condensed_modes};
use jointscope_linalg::{EigenError, ModalBasis};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::sync::Arc;

/// Problems remembered by a thread, the latest first; of meshed beams so many more, as far as their matrices
/// have no more entries together than these: a fit of theirs comes back to where its last two sets of
/// derivatives were taken.
const KEPT: usize = 6;
const KEPT_OF_BEAMS: usize = 32;
const ENTRIES: usize = 1 << 18;

struct Solved {
    condensed: bool,
    mass: Vec<f64>,
    stiffness: Vec<f64>,
    basis: Arc<ModalBasis>,
}

thread_local! {
    static SOLVED: RefCell<VecDeque<Solved>> = const { RefCell::new(VecDeque::new()) };
}

/// The modes of exactly these matrices, from memory where they were solved recently by this thread.
///
/// # Errors
/// Those of [`condensed_modes`].
pub(crate) fn modes(
    order: usize,
    mass: &[f64],
    stiffness: &[f64],
    stretches: &[Stretch],
) -> Result<Arc<ModalBasis>, EigenError> {
    let known = SOLVED.with_borrow_mut(|solved| {
        let diagonal = |a: &[f64], b: &[f64]| a.iter().step_by(order + 1).eq(b.iter().step_by(order + 1));
        // Most problems differ in one of the two only, and show it there at once.
        let alike = |s: &Solved| {
            s.condensed != stretches.is_empty()
                && diagonal(&s.mass, mass)
                && diagonal(&s.stiffness, stiffness)
        };
        let same = |s: &Solved| alike(s) && s.stiffness == stiffness && s.mass == mass;
        let found = solved.iter().position(same)?;
        let latest = solved.remove(found)?;
        let basis = Arc::clone(&latest.basis);
        solved.push_front(latest);
        Some(basis)
    });
    if let Some(basis) = known {
        return Ok(basis);
    }
    let kept = match stretches {
        [] => KEPT,
        _ => (ENTRIES / mass.len()).clamp(KEPT, KEPT_OF_BEAMS),
    };
    let basis = Arc::new(condensed_modes(order, mass, stiffness, stretches)?);
    SOLVED.with_borrow_mut(|solved| {
        solved.truncate(kept - 1);
        let (mass, stiffness) = (mass.to_vec(), stiffness.to_vec());
        solved.push_front(Solved {
            condensed: !stretches.is_empty(),
            mass,
            stiffness,
            basis: Arc::clone(&basis),
        });
    });
    Ok(basis)
}
