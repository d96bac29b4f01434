use jointscope_linalg::{SparseCholesky, SparseError, SparsePattern, SparseSymmetric};

/// A grid of springs, width × height nodes, each also held to ground by `ground`.
fn grid(width: usize, height: usize, ground: f64) -> SparseSymmetric {
    let mut couples = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let node = y * width + x;
            couples.push(vec![node]);
            if x + 1 < width {
                couples.push(vec![node, node + 1]);
            }
            if y + 1 < height {
                couples.push(vec![node, node + width]);
            }
        }
    }
    let pattern = SparsePattern::of_elements(width * height, couples.iter().map(Vec::as_slice)).unwrap();
    let mut matrix = SparseSymmetric::zero(&pattern);
    for couple in &couples {
        match couple.as_slice() {
            [a, b] => matrix.add_element(&[Some(*a), Some(*b)], &[1.0, -1.0, -1.0, 1.0]).unwrap(),
            [a] => matrix.add_element(&[Some(*a)], &[ground]).unwrap(),
            _ => unreachable!(),
        }
    }
    matrix
}

#[test]
fn what_is_solved_multiplies_back_to_the_right_hand_side() {
    let matrix = grid(40, 30, 1e-3);
    let factor = SparseCholesky::of(&matrix).unwrap();
    let right: Vec<f64> = (0..2 * 1200).map(|i| ((i * 37) % 101) as f64 - 50.0).collect();
    let mut solution = right.clone();
    factor.solve_in_place(&mut solution);
    for (x, b) in solution.chunks(1200).zip(right.chunks(1200)) {
        for (found, wanted) in matrix.multiply(x).iter().zip(b) {
            assert!((found - wanted).abs() < 1e-8, "{found} instead of {wanted}");
        }
    }
}

#[test]
fn a_structure_that_can_move_freely_has_no_factor() {
    assert!(matches!(SparseCholesky::of(&grid(5, 5, -1.0)), Err(SparseError::NotPositiveDefinite)));
    assert!(matches!(SparseCholesky::of(&grid(5, 5, f64::NAN)), Err(SparseError::NotPositiveDefinite)));
}
