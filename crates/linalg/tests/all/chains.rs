use jointscope_linalg::{SparsePattern, SparseSymmetric};

/// A free chain of n unit masses on unit springs, stiffness scaled.
pub(crate) fn free_chain(n: usize, stiffness: f64) -> (SparseSymmetric, SparseSymmetric) {
    let couples: Vec<Vec<usize>> = (1..n).map(|i| vec![i - 1, i]).collect();
    let pattern = SparsePattern::of_elements(n, couples.iter().map(Vec::as_slice)).unwrap();
    let (mut k, mut m) = (SparseSymmetric::zero(&pattern), SparseSymmetric::zero(&pattern));
    for i in 0..n {
        m.add_element(&[Some(i)], &[1.0]).unwrap();
        if i > 0 {
            let s = stiffness;
            k.add_element(&[Some(i - 1), Some(i)], &[s, -s, -s, s]).unwrap();
        }
    }
    (k, m)
}
