//! Whether two tests agree on the bodies that they are said to share.
//!
//! Each test by itself, with the prior, has the shared quantities q at m = E(q) with the covariance S, in
//! standard deviations of the prior. If q is the same in both, m₁ − m₂ is normal with mean zero and the
//! covariance A₁ + A₂ − A₁A₂ − A₂A₁, A = 1 − S being what a test has told of q.
//!
//! Only combinations of q count of which the tests tell something. Along the others a fit lies in a flat,
//! curved valley: where in it the fit ends is known to a few tenths of the prior's deviation, since χ² hardly
//! changes there, and not to the hundredth that A leaves it.

use crate::choices::Choice;
use crate::{Decomposed, Together};
use jointscope_inference::chi_squared_above;
use jointscope_linalg::{Cholesky, generalized_symmetric_eigen};

/// Probability below which two tests do not agree; of several pairs, divided by their number.
const DISAGREE: f64 = 0.01;
/// Share of the prior's variance that the tests take away on average, below which they tell nothing of a
/// combination.
const TOLD: f64 = 0.01;
/// Variance of a difference, in those of the prior, below which it is as far from zero as two fits are from
/// linear.
const LINEAR: f64 = 1e-4;

impl Together {
    /// The test that contradicts most others on the bodies they share, of as many the one of the least
    /// probable agreement; nothing where all agree. The more pairs are looked at, the less probable each has
    /// to be. Each test stands by its first joint. Agreement is the mean of that under each choice of laws,
    /// as often as it is probable.
    pub(crate) fn most_at_odds(&self, choices: &[Choice], firsts: &[usize]) -> Option<usize> {
        let all = firsts.iter().enumerate().flat_map(|(i, &a)| firsts[i + 1..].iter().map(move |&b| [a, b]));
        let agreement = |[a, b]: [usize; 2]| {
            let known = choices.iter().filter(|choice| choice.apart.is_none());
            let each: Vec<(f64, f64)> = known
                .filter_map(|of| Some((of.weight, self.agreement(&of.joints[a], &of.joints[b])?)))
                .collect();
            let weight: f64 = each.iter().map(|(weight, _)| weight).sum();
            let sum: f64 = each.iter().map(|(weight, p)| weight * p).sum();
            (weight > 0.0).then(|| sum / weight)
        };
        let looked_at: Vec<([usize; 2], f64)> =
            all.filter_map(|pair| Some((pair, agreement(pair)?))).collect();
        let disagree = DISAGREE / looked_at.len() as f64;
        let at_odds = |joint: usize| {
            let own = looked_at.iter().filter(|(pair, p)| pair.contains(&joint) && *p < disagree);
            let least = own.clone().map(|(_, p)| *p).fold(1.0, f64::min);
            let count = own.count();
            (count > 0).then_some((joint, count, least))
        };
        let all = firsts.iter().filter_map(|&joint| at_odds(joint));
        all.max_by(|a, b| a.1.cmp(&b.1).then(b.2.total_cmp(&a.2))).map(|(joint, ..)| joint)
    }

    /// Probability of shared quantities as far apart or farther, if they are the same; `None` where nothing
    /// is shared or told.
    pub fn agreement(&self, a: &Decomposed, b: &Decomposed) -> Option<f64> {
        let both = |names: &[String]| [a, b].iter().all(|joint| names.contains(&joint.name));
        let shared = self.shared.iter().filter(|body| both(&body.joints));
        let paths: Vec<&str> = shared.flat_map(|body| body.quantities.iter().map(String::as_str)).collect();
        let known = |path: &&str| {
            let of = |joint: &Decomposed| {
                let fit = joint.fitted.as_ref()?;
                fit.quantities.iter().find(|quantity| quantity.path == **path)?.std
            };
            of(a).is_some() && of(b).is_some()
        };
        let paths: Vec<&str> = paths.into_iter().filter(known).collect();
        let n = paths.len();
        let (first, second) = (posterior(a, &paths)?, posterior(b, &paths)?);
        let dot = |x: &[f64], y: &[f64], i: usize, j: usize| -> f64 {
            (0..n).map(|k| x[i * n + k] * y[k * n + j]).sum()
        };
        let [x, y] = [&first.1, &second.1];
        let entry = |e: usize| {
            let (i, j) = (e / n, e % n);
            x[e] + y[e] - 0.5 * (dot(x, y, i, j) + dot(x, y, j, i) + dot(y, x, i, j) + dot(y, x, j, i))
        };
        let covariance: Vec<f64> = (0..n * n).map(entry).collect();
        let directions = determined_directions(n, x, y)?;
        let m = directions.len();
        let between =
            |a: &[f64], b: &[f64]| -> f64 { (0..n * n).map(|e| a[e / n] * covariance[e] * b[e % n]).sum() };
        let projected: Vec<f64> =
            directions.iter().flat_map(|a| directions.iter().map(|b| between(a, b))).collect();
        let basis = generalized_symmetric_eigen(m, &unit(m), &projected).ok()?;
        let apart: Vec<f64> = first.0.iter().zip(&second.0).map(|(a, b)| a - b).collect();
        let along = |a: &[f64]| a.iter().zip(&apart).map(|(a, d)| a * d).sum::<f64>();
        let apart: Vec<f64> = directions.iter().map(|a| along(a)).collect();
        let (mut chi2, mut degrees) = (0.0, 0);
        for (mode, variance) in basis.eigenvalues().iter().enumerate().filter(|(_, v)| **v > LINEAR) {
            let along: f64 = basis.shape(mode).iter().zip(&apart).map(|(s, d)| s * d).sum();
            chi2 += along * along / variance;
            degrees += 1;
        }
        (degrees > 0).then(|| chi_squared_above(chi2, degrees as f64))
    }
}

fn unit(n: usize) -> Vec<f64> {
    (0..n * n).map(|e| f64::from(u8::from(e / n == e % n))).collect()
}

/// The combinations of the quantities, of length one, of which two tests tell something: `x` and `y` are what
/// each tells, 1 − S.
fn determined_directions(n: usize, x: &[f64], y: &[f64]) -> Option<Vec<Vec<f64>>> {
    let mean: Vec<f64> = x.iter().zip(y).map(|(x, y)| 0.5 * (x + y)).collect();
    let basis = generalized_symmetric_eigen(n, &unit(n), &mean).ok()?;
    let all = basis.eigenvalues().iter().enumerate().filter(|(_, share)| **share > TOLD);
    let directions: Vec<Vec<f64>> = all.map(|(mode, _)| basis.shape(mode).to_vec()).collect();
    (!directions.is_empty()).then_some(directions)
}

/// The posterior mean of these quantities by one test, and 1 − S.
fn posterior(joint: &Decomposed, paths: &[&str]) -> Option<(Vec<f64>, Vec<f64>)> {
    let fit = joint.fitted.as_ref()?;
    let (slots, likelihood) = fit.likelihood()?;
    let place = |path: &&str| fit.quantities.iter().position(|quantity| quantity.path == **path);
    let kept: Vec<usize> = paths.iter().map(|p| Some(slots.len() + place(p)?)).collect::<Option<_>>()?;
    let known = |index: usize| fit.quantities[index].std.is_some();
    let precision = |m: usize| if m >= slots.len() && known(m - slots.len()) { 1.0 } else { 0.0 };
    let own = likelihood.marginal(&kept, precision)?;
    let n = kept.len();
    let mut with_prior = own.information.clone();
    (0..n).for_each(|i| with_prior[i * n + i] += 1.0);
    let factor = Cholesky::of(n, &with_prior)?;
    let mut step: Vec<f64> = own.gradient.iter().zip(&own.at).map(|(g, at)| g - at).collect();
    factor.solve_in_place(&mut step);
    let mean = own.at.iter().zip(&step).map(|(at, step)| at + step).collect();
    let mut posterior = factor.inverse();
    posterior.iter_mut().for_each(|entry| *entry = -*entry);
    (0..n).for_each(|i| posterior[i * n + i] += 1.0);
    Some((mean, posterior))
}
