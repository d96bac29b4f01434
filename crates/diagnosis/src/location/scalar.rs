//! One line's scalar, eliminated by weighted least squares over the FRFs.

use super::pattern::Course;
use num_complex::Complex64;

/// Newton steps for a scalar that does not enter linearly, and starts besides its neighbour's and zero.
const NEWTON: usize = 12;
const STARTS: [f64; 3] = [-0.3, 0.5, 2.0];
/// A start that leaves this much per real value needs no others beside it.
const ENOUGH: f64 = 4.0;

/// The scalar that fits the line's FRFs best; zero where the pattern vanishes.
pub(super) fn eliminated(
    courses: &[Course],
    measured: &[Complex64],
    weights: &[f64],
    neighbour: Complex64,
) -> Complex64 {
    if courses.iter().all(Course::is_linear) {
        let (mut size, mut along) = (0.0, Complex64::ZERO);
        for ((course, measured), weight) in courses.iter().zip(measured).zip(weights) {
            size += weight * course.linear.norm_sqr();
            along += course.linear.conj() * *weight * (measured - course.start);
        }
        return if size > 0.0 { along / size } else { Complex64::ZERO };
    }
    let mut best = newton(courses, measured, weights, neighbour);
    if best.1 < ENOUGH * 2.0 * courses.len() as f64 {
        return best.0;
    }
    let others = [0.0].into_iter().chain(STARTS).map(|re| Complex64::new(re, 0.0));
    for start in others.filter(|start| *start != neighbour) {
        let other = newton(courses, measured, weights, start);
        if other.1 < best.1 {
            best = other;
        }
    }
    best.0
}

/// Gauss–Newton steps for the scalar, halved where they lose; with what is left of the weighted squares.
fn newton(courses: &[Course], measured: &[Complex64], weights: &[f64], start: Complex64) -> (Complex64, f64) {
    let left = |z: Complex64| -> f64 {
        let terms = courses.iter().zip(measured).zip(weights);
        terms.map(|((c, m), w)| w * (m - c.at(z)).norm_sqr()).sum()
    };
    let mut z = start;
    let mut lowest = left(z);
    for _ in 0..NEWTON {
        let (mut size, mut along) = (0.0, Complex64::ZERO);
        for ((course, measured), weight) in courses.iter().zip(measured).zip(weights) {
            let (value, slope) = course.with_slope(z);
            size += weight * slope.norm_sqr();
            along += slope.conj() * *weight * (measured - value);
        }
        if size.is_nan() || size <= 0.0 {
            break;
        }
        let mut step = along / size;
        let mut better = None;
        for _ in 0..6 {
            let value = left(z + step);
            if value < lowest {
                better = Some(value);
                break;
            }
            step *= 0.5;
        }
        let Some(value) = better else { break };
        z += step;
        let gain = lowest - value;
        lowest = value;
        if gain < 1e-9 * lowest {
            break;
        }
    }
    (z, lowest)
}
