//! Undamped modes that were asked for a moment ago.
//!
//! A fit moves many quantities that leave the matrices alone (damping, where sensors sit, everything of the measuring
//! chain), and the eigenproblem costs as much as hundreds of lines, that of a meshed beam more than all of them.

use jointscope_linalg::{EigenError, ModalBasis, generalized_symmetric_eigen};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

/// Problems remembered by a thread, the latest first.
const KEPT: usize = 6;

struct Solved {
    mass: Vec<f64>,
    stiffness: Vec<f64>,
    basis: Rc<ModalBasis>,
}

thread_local! {
    static SOLVED: RefCell<VecDeque<Solved>> = const { RefCell::new(VecDeque::new()) };
}

/// The modes of exactly these matrices, from memory where they were solved recently by this thread.
///
/// # Errors
/// Those of [`generalized_symmetric_eigen`].
pub(crate) fn modes(order: usize, mass: &[f64], stiffness: &[f64]) -> Result<ModalBasis, EigenError> {
    let known = SOLVED.with_borrow_mut(|solved| {
        let found = solved.iter().position(|s| s.stiffness == stiffness && s.mass == mass)?;
        let latest = solved.remove(found)?;
        let basis = Rc::clone(&latest.basis);
        solved.push_front(latest);
        Some(basis)
    });
    if let Some(basis) = known {
        return Ok((*basis).clone());
    }
    let basis = generalized_symmetric_eigen(order, mass, stiffness)?;
    SOLVED.with_borrow_mut(|solved| {
        solved.truncate(KEPT - 1);
        let (mass, stiffness) = (mass.to_vec(), stiffness.to_vec());
        solved.push_front(Solved { mass, stiffness, basis: Rc::new(basis.clone()) });
    });
    Ok(basis)
}
