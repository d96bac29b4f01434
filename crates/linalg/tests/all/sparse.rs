use jointscope_linalg::{SparseError, SparsePattern, SparseSymmetric};
use std::sync::Arc;

fn pattern(springs: usize) -> Arc<SparsePattern> {
    let couples: Vec<Vec<usize>> =
        (0..springs).map(|i| if i == 0 { vec![0] } else { vec![i - 1, i] }).collect();
    SparsePattern::of_elements(springs, couples.iter().map(Vec::as_slice)).unwrap()
}

/// Springs in a row, the first node held.
fn chain(stiffness: &[f64]) -> SparseSymmetric {
    let mut matrix = SparseSymmetric::zero(&pattern(stiffness.len()));
    for (i, k) in stiffness.iter().enumerate() {
        matrix.add_element(&[i.checked_sub(1), Some(i)], &[*k, -k, -k, *k]).unwrap();
    }
    matrix
}

#[test]
fn a_chain_of_springs_multiplies_like_its_dense_matrix() {
    let matrix = chain(&[2.0, 3.0, 5.0]);
    // [[5, −3, 0], [−3, 8, −5], [0, −5, 5]]
    assert_eq!(matrix.multiply(&[1.0, 10.0, 100.0]), [-25.0, -423.0, 450.0]);
    assert_eq!(pattern(3).entries(), 5);
}

#[test]
fn an_element_outside_the_pattern_is_refused() {
    let mut matrix = chain(&[1.0, 1.0, 1.0]);
    let answer = matrix.add_element(&[Some(0), Some(2)], &[1.0; 4]);
    assert_eq!(answer, Err(SparseError::Equation { equation: 2, order: 3 }));
    let outside = [7_usize];
    assert!(SparsePattern::of_elements(3, [outside.as_slice()].into_iter()).is_err());
}

#[test]
fn combining_needs_one_pattern() {
    assert_eq!(chain(&[1.0, 1.0]).plus(1.0, &chain(&[1.0; 3])), Err(SparseError::Patterns));
    let sum = chain(&[1.0, 1.0]).plus(2.0, &chain(&[1.0, 1.0])).unwrap();
    assert_eq!(sum.multiply(&[1.0, 1.0]), [3.0, 0.0]);
}
