//! A joint's numbers about its elastic centre.
//!
//! What is not known of the blocks acts on K and C of the joint between them nearly alike, and by congruence:
//! a mass that is more scales forces, a point that lies elsewhere moves the end that they act on, TᵀKT and
//! TᵀCT. In the elements of K that bends, for k22 has the square of the shift and the product with k11, and
//! where combinations of elements are known a hundred times better than these the bend is many of their
//! deviations. ln k11, the elastic centre a = k12/k11 and ln(k22 − k12²/k11) about it are as good numbers of K,
//! in which a scale and a shift are straight lines; and with K = LLᵀ, L⁻¹CL⁻ᵀ is the same for all T that keep
//! the first row's direction. Two joints are the same where these are.

use crate::at_law::matrices;
use crate::{Decomposed, FiledJoint, FiledLikelihood, Number};
use jointscope_inference::QuadraticLikelihood;
use jointscope_linalg::dot;

/// Both joints with their numbers about the elastic centre, in the places of k11, k12, k22, c11, c12, c22;
/// nothing where not all elements are compared, or K is not positive definite.
pub(crate) fn about_centre(two: &[Decomposed], numbers: &[Number]) -> Option<Vec<Decomposed>> {
    let slots: Vec<usize> = numbers.iter().map(|number| number.slot()).collect();
    if !is_whole(&slots) {
        return None;
    }
    let centred = |joint: &Decomposed| -> Option<Decomposed> {
        let fit = joint.fitted.as_ref().filter(|_| joint.at_once.is_none())?;
        Some(Decomposed { fitted: Some(of_fit(fit)?), ..joint.clone() })
    };
    two.iter().map(centred).collect()
}

fn of_fit(fit: &FiledJoint) -> Option<FiledJoint> {
    let (slots, likelihood) = fit.likelihood()?;
    let filed = fit.likelihood.as_ref().filter(|_| is_whole(&slots))?;
    let stated = fit.six();
    let mut at = stated;
    at[..slots.len()].copy_from_slice(&likelihood.at[..slots.len()]);
    let moved = in_centred_numbers(&likelihood, slots.len(), &at)?;
    let six = centred(&stated)?;
    let by_elements = slopes_by_elements(&stated, &six);
    let mut model_error = fit.model_error;
    model_error.covariance = congruent(&by_elements, &model_error.covariance);
    let (stiffness, damping) = matrices(&six);
    Some(FiledJoint {
        stiffness,
        damping,
        covariance: congruent(&by_elements, &fit.covariance),
        law_covariance: congruent(&by_elements, &fit.law_covariance),
        model_error,
        likelihood: Some(FiledLikelihood::of(filed.elements.clone(), &moved)),
        ..fit.clone()
    })
}

/// All elements of K, with or without those of C, in their order.
fn is_whole(slots: &[usize]) -> bool {
    slots == [0, 1, 2] || slots == [0, 1, 2, 3, 4, 5]
}

type Square = [[f64; 6]; 6];

/// The likelihood by the centred numbers of a joint at `six`, the first `count` of its parameters.
fn in_centred_numbers(
    likelihood: &QuadraticLikelihood,
    count: usize,
    six: &[f64; 6],
) -> Option<QuadraticLikelihood> {
    let at = centred(six)?;
    let slopes = slopes(&at);
    let n = likelihood.order();
    let by = |i: usize, j: usize| match i < count && j < count {
        true => slopes[i][j],
        false => f64::from(u8::from(i == j)),
    };
    // Bᵀ g and Bᵀ J B: of a column only its own parameter's rows, or the numbers', are not zero.
    let rows = |j: usize| if j < count { 0..count } else { j..j + 1 };
    let gradient = |j: usize| rows(j).map(|i| by(i, j) * likelihood.gradient[i]).sum();
    let entry = |e: usize| -> f64 {
        let (i, j) = (e / n, e % n);
        let inner =
            |k: usize| rows(j).map(move |l| likelihood.information[k * n + l] * by(l, j)).sum::<f64>();
        rows(i).map(|k| by(k, i) * inner(k)).sum()
    };
    let mut moved = QuadraticLikelihood {
        at: likelihood.at.clone(),
        gradient: (0..n).map(gradient).collect(),
        information: (0..n * n).map(entry).collect(),
    };
    moved.at[..count].copy_from_slice(&at[..count]);
    Some(moved)
}

/// ln k11, k12/k11, ln(k22 − k12²/k11), and the elements 11, 12, 22 of L⁻¹CL⁻ᵀ.
fn centred([k11, k12, k22, c11, c12, c22]: &[f64; 6]) -> Option<[f64; 6]> {
    let a = k12 / k11;
    let about = k22 - a * k12;
    if !(*k11 > 0.0 && about > 0.0) {
        return None;
    }
    let moved = c12 - a * c11;
    Some([
        k11.ln(),
        a,
        about.ln(),
        c11 / k11,
        moved / (k11 * about).sqrt(),
        (c22 - a * (c12 + moved)) / about,
    ])
}

/// Derivatives of k11 … c22, by rows, by the centred numbers.
fn slopes([u, a, w, d11, d12, d22]: &[f64; 6]) -> Square {
    let (k11, about) = (u.exp(), w.exp());
    let mean = (k11 * about).sqrt();
    let (c11, moved) = (d11 * k11, d12 * mean);
    let c12 = a * c11 + moved;
    let of_c12 = [c12 - 0.5 * moved, c11, 0.5 * moved, a * k11, mean, 0.0];
    let mut of_c22 = of_c12.map(|by| 2.0 * a * by);
    of_c22[0] -= a * a * c11;
    of_c22[1] += 2.0 * moved;
    of_c22[2] += d22 * about;
    of_c22[3] -= a * a * k11;
    of_c22[5] += about;
    [
        [k11, 0.0, 0.0, 0.0, 0.0, 0.0],
        [a * k11, k11, 0.0, 0.0, 0.0, 0.0],
        [a * a * k11, 2.0 * a * k11, about, 0.0, 0.0, 0.0],
        [c11, 0.0, 0.0, k11, 0.0, 0.0],
        of_c12,
        of_c22,
    ]
}

/// Derivatives of the centred numbers, by rows, by k11 … c22.
fn slopes_by_elements([k11, _, _, c11, c12, _]: &[f64; 6], [_, a, w, d11, d12, d22]: &[f64; 6]) -> Square {
    let about = w.exp();
    let (mean, moved) = ((k11 * about).sqrt(), c12 - a * c11);
    let of_u = [1.0 / k11, 0.0, 0.0, 0.0, 0.0, 0.0];
    let of_a = [-a / k11, 1.0 / k11, 0.0, 0.0, 0.0, 0.0];
    let of_w = [a * a / about, -2.0 * a / about, 1.0 / about, 0.0, 0.0, 0.0];
    let of_moved = [-c11 * of_a[0], -c11 * of_a[1], 0.0, -a, 1.0, 0.0];
    let of_last = [-2.0 * moved * of_a[0], -2.0 * moved * of_a[1], 0.0, a * a, -2.0 * a, 1.0];
    [
        of_u,
        of_a,
        of_w,
        [-d11 / k11, 0.0, 0.0, 1.0 / k11, 0.0, 0.0],
        std::array::from_fn(|e| of_moved[e] / mean - 0.5 * d12 * (of_u[e] + of_w[e])),
        std::array::from_fn(|e| of_last[e] / about - d22 * of_w[e]),
    ]
}

/// A V Aᵀ.
fn congruent(a: &Square, v: &Square) -> Square {
    let rows: Square =
        std::array::from_fn(|i| std::array::from_fn(|j| (0..6).map(|k| a[i][k] * v[k][j]).sum()));
    std::array::from_fn(|i| std::array::from_fn(|j| dot(&rows[i], &a[j])))
}

#[cfg(test)]
mod tests {
    use super::*;

    const JOINT: [f64; 6] = [1.44e6, -4.53e4, 2.21e3, 13.5, -0.45, 0.021];

    #[test]
    fn derivatives_either_way_are_each_others_inverse() {
        let at = centred(&JOINT).unwrap();
        let (back, forth) = (slopes(&at), slopes_by_elements(&JOINT, &at));
        for (i, j) in (0..36).map(|e| (e / 6, e % 6)) {
            let entry: f64 = (0..6).map(|k| forth[i][k] * back[k][j]).sum();
            let size: f64 = (0..6).map(|k| (forth[i][k] * back[k][j]).abs()).sum();
            assert!((entry - f64::from(u8::from(i == j))).abs() < 1e-12 * size.max(1.0), "{i} {j} {entry}");
        }
    }

    #[test]
    fn what_a_shift_and_a_scale_do_to_a_joint_are_straight_lines_and_leave_its_damping_ratios() {
        // Points that lie d farther off and forces that read s times as much: TᵀKT and TᵀCT.
        let moved = |s: f64, d: f64| {
            let of = |[a, b, c]: [f64; 3]| [s * a, s * (b + d * a), s * (c + 2.0 * d * b + d * d * a)];
            let [k, c] = [[0, 1, 2], [3, 4, 5]].map(|places| of(places.map(|place| JOINT[place])));
            centred(&[k[0], k[1], k[2], c[0], c[1], c[2]]).unwrap()
        };
        let at = centred(&JOINT).unwrap();
        let [u, a, w, damping @ ..] = moved(1.1, 2e-3);
        assert!((u - at[0] - 1.1f64.ln()).abs() < 1e-12 && (w - at[2] - 1.1f64.ln()).abs() < 1e-9);
        assert!((a - at[1] - 2e-3).abs() < 1e-14, "{a}");
        for (found, own) in damping.iter().zip(&at[3..]) {
            assert!((found / own - 1.0).abs() < 1e-9, "{found} for {own}");
        }
        assert!(centred(&[1.0, 2.0, 1.0, 0.0, 0.0, 0.0]).is_none());
    }
}
