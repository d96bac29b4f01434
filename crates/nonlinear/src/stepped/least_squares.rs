//! Non-linear least squares of a few parameters, derivatives by differences.

use jointscope_linalg::{inverse, solve_positive_definite};

/// Where a fit ended.
#[derive(Debug, Clone)]
pub(crate) struct Minimum {
    /// Parameters.
    pub x: Vec<f64>,
    /// Sum of squared residuals.
    pub cost: f64,
}

/// Steps at the most.
const STEPS: usize = 60;
/// Step of the differences, relative to each parameter's scale.
const DIFFERENCE: f64 = 1e-5;
/// A relative gain below which the fit has ended.
const ENDED: f64 = 1e-9;

fn cost(residual: &[f64]) -> f64 {
    residual.iter().map(|r| r * r).sum()
}

fn jacobian(
    residual: &dyn Fn(&[f64]) -> Option<Vec<f64>>,
    x: &[f64],
    scale: &[f64],
) -> Option<Vec<Vec<f64>>> {
    let column = |p: usize| {
        let moved = |sign: f64| {
            let mut to = x.to_vec();
            to[p] += sign * DIFFERENCE * scale[p];
            residual(&to)
        };
        let (up, down) = (moved(1.0)?, moved(-1.0)?);
        Some(up.iter().zip(&down).map(|(a, b)| (a - b) / (2.0 * DIFFERENCE)).collect())
    };
    (0..x.len()).map(column).collect()
}

/// Levenberg–Marquardt from `start`, parameters measured in `scale`; `None` where nothing finite is found.
pub(crate) fn minimum(
    residual: &dyn Fn(&[f64]) -> Option<Vec<f64>>,
    start: &[f64],
    scale: &[f64],
) -> Option<Minimum> {
    let n = start.len();
    let mut x = start.to_vec();
    let mut r = residual(&x)?;
    let mut best = cost(&r);
    if !best.is_finite() {
        return None;
    }
    let mut weight = 1e-3;
    for _ in 0..STEPS {
        let columns = jacobian(residual, &x, scale)?;
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(p, q)| p * q).sum::<f64>();
        let mut improved = None;
        for _ in 0..8 {
            let mut normal = vec![0.0; n * n];
            let mut right = vec![0.0; n];
            for i in 0..n {
                (0..n).for_each(|j| normal[i * n + j] = dot(&columns[i], &columns[j]));
                normal[i * n + i] += weight * normal[i * n + i] + f64::MIN_POSITIVE;
                right[i] = -dot(&columns[i], &r);
            }
            if solve_positive_definite(&mut normal, &mut right) {
                let to: Vec<f64> = x.iter().zip(&right).zip(scale).map(|((x, d), s)| x + d * s).collect();
                if let Some(trial) = residual(&to).filter(|trial| cost(trial) < best) {
                    improved = Some((to, trial));
                    break;
                }
            }
            weight *= 10.0;
        }
        let Some((to, trial)) = improved else { break };
        let gain = best - cost(&trial);
        best -= gain;
        (x, r) = (to, trial);
        weight = (weight * 0.2).max(1e-12);
        if gain <= ENDED * best {
            break;
        }
    }
    Some(Minimum { x, cost: best })
}

/// Standard deviations of the parameters at `x` where the residuals' variance is `variance`; `None` where a combination is free.
pub(crate) fn deviations(
    residual: &dyn Fn(&[f64]) -> Option<Vec<f64>>,
    x: &[f64],
    scale: &[f64],
    variance: f64,
) -> Option<Vec<f64>> {
    let n = x.len();
    let columns = jacobian(residual, x, scale)?;
    let product = |i: usize, j: usize| columns[i].iter().zip(&columns[j]).map(|(a, b)| a * b).sum::<f64>();
    let normal: Vec<f64> = (0..n * n).map(|k| product(k / n, k % n)).collect();
    let covariance = inverse(&normal, n)?;
    let std = |i: usize| (covariance[i * n + i] * variance).sqrt() * scale[i];
    Some((0..n).map(std).collect::<Vec<f64>>()).filter(|all| all.iter().all(|s| s.is_finite()))
}
