//! Whether joints follow one law over frequency, and which.
//!
//! Each file says how probable each law is by its own FRFs. If all joints follow one law, whichever it is,
//! each law i has the evidence Πⱼ pᵢⱼ; if each has its own, all combinations are as probable beforehand: of L
//! laws and n joints the one is Lⁿ⁻¹ Σᵢ fᵢ Πⱼ pᵢⱼ times as probable as the other. Laws with an exponent or a
//! time are one law only where that is the same: fᵢ = ∫ Πⱼ pⱼ(x) / π(x)ⁿ⁻¹ dx, pⱼ being what test j tells of
//! it and π what is known beforehand, is small where they are told apart.

use crate::{Decomposed, FiledJoint};
use jointscope_inference::SIGNIFICANT;
use std::f64::consts::TAU;

/// Exponents that a fit allows, as likely anywhere between.
const EXPONENTS: [f64; 2] = [0.02, 0.98];
/// Standard deviation of ln(ωτ) in the middle of the band before anything is recorded.
const LN_TIME: f64 = 1.5;
/// Deviations of it beyond which no time is looked for.
const FAR: f64 = 6.0;
/// Points of the quadrature.
const POINTS: usize = 2000;

/// The laws that joints may follow together.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LawsInCommon {
    /// Logarithm of each one's evidence, up to what all have in common.
    pub laws: Vec<(String, f64)>,
    /// Probability that all follow one law rather than each its own, if either is as probable beforehand.
    pub probability: f64,
}

impl LawsInCommon {
    /// Of joints whose laws were compared; nothing where those of one were not.
    pub(crate) fn of(joints: &[&Decomposed]) -> Option<Self> {
        let fits: Vec<&FiledJoint> =
            joints.iter().map(|joint| joint.fitted.as_ref()).collect::<Option<_>>()?;
        in_common(&fits)
    }

    /// Whether the joints count as following laws of their own.
    pub(crate) fn is_refuted(&self) -> bool {
        self.probability < SIGNIFICANT
    }

    /// Logarithm of a law's evidence.
    pub(crate) fn evidence(&self, law: &str) -> Option<f64> {
        self.laws.iter().find(|(name, _)| name == law).map(|(_, evidence)| *evidence)
    }
}

fn in_common(fits: &[&FiledJoint]) -> Option<LawsInCommon> {
    let (first, others) = fits.split_first()?;
    if fits.iter().any(|fit| fit.laws.is_empty()) {
        return None;
    }
    let evidence = |law: &str| {
        let of = |fit: &&FiledJoint| {
            Some(fit.laws.iter().find(|entry| entry.law == law)?.probability.max(0.0).ln())
        };
        let sum = fits.iter().map(of).sum::<Option<f64>>()?;
        Some(sum + ln_of_one_shape(fits, law))
    };
    let laws: Vec<(String, f64)> =
        first.laws.iter().filter_map(|entry| Some((entry.law.clone(), evidence(&entry.law)?))).collect();
    let sum: f64 = laws.iter().map(|(_, evidence)| evidence.exp()).sum();
    let odds = sum * (first.laws.len() as f64).powi(others.len() as i32);
    Some(LawsInCommon { laws, probability: if odds.is_finite() { odds / (1.0 + odds) } else { 1.0 } })
}

/// ln f of a law: by how much more probable one exponent or time of all makes what the tests tell of it, than
/// one of each; 0 of laws without and where a file does not say how well it is known.
fn ln_of_one_shape(fits: &[&FiledJoint], law: &str) -> f64 {
    let is_exponent = law.starts_with("fractional");
    if !is_exponent && !law.starts_with("standard_linear_solid") {
        return 0.0;
    }
    let middle = fits[0].follows.as_ref().map_or(1.0, |follows| TAU * follows.frequency);
    let told = |fit: &&FiledJoint| {
        let entry = fit.laws.iter().find(|entry| entry.law == law)?;
        let told = if is_exponent { entry.exponent } else { entry.time }?;
        Some(if is_exponent {
            (told.value, told.std)
        } else {
            ((told.value * middle).ln(), told.std / told.value)
        })
    };
    let told: Option<Vec<(f64, f64)>> = fits.iter().map(told).collect();
    let is_usable = |(at, std): &(f64, f64)| at.is_finite() && *std >= 0.0;
    let Some(told) = told.filter(|all| all.iter().all(is_usable)) else { return 0.0 };
    let [low, high] = if is_exponent { EXPONENTS } else { [-FAR * LN_TIME, FAR * LN_TIME] };
    let step = (high - low) / POINTS as f64;
    let ln_prior = |x: f64| match is_exponent {
        true => -(high - low).ln(),
        false => -0.5 * (x / LN_TIME).powi(2) - (LN_TIME * TAU.sqrt()).ln(),
    };
    let points: Vec<f64> = (0..POINTS).map(|i| low + (i as f64 + 0.5) * step).collect();
    // A deviation below the points' distance is not seen by them; what is told lies within what a fit allows.
    let ln_told: Vec<Vec<f64>> = told
        .iter()
        .map(|(at, std)| {
            let (at, std) = (at.clamp(low, high), std.max(step));
            let density: Vec<f64> = points.iter().map(|x| -0.5 * ((x - at) / std).powi(2)).collect();
            let sum: f64 = density.iter().map(|ln| ln.exp()).sum();
            let norm = (sum * step).ln();
            density.into_iter().map(|ln| ln - norm).collect()
        })
        .collect();
    let ln_joint = points.iter().enumerate().map(|(i, x)| {
        ln_told.iter().map(|told| told[i]).sum::<f64>() - (fits.len() - 1) as f64 * ln_prior(*x)
    });
    let ln_joint: Vec<f64> = ln_joint.collect();
    let most = ln_joint.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    most + (ln_joint.iter().map(|ln| (ln - most).exp()).sum::<f64>() * step).ln()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ranking::normal;
    use crate::stiffness_file::{ComparedLaw, FollowedLaw, Uncertain};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use serde_json::{Value, json};

    /// Name and probability of a law, its exponent or time with its deviation.
    type Law<'a> = (&'a str, f64, Option<(f64, f64)>);

    fn joint(laws: &[Law]) -> FiledJoint {
        let zero = [[0.0; 2]; 2];
        let covariance = [[0.0; 6]; 6];
        let file = json!({"stiffness": zero, "damping": zero, "covariance": covariance});
        let mut fit: FiledJoint = serde_json::from_value(file).unwrap();
        fit.follows = Some(FollowedLaw::plain(laws[0].0, laws[0].1, 1.0 / TAU));
        let entry = |(law, probability, shape): &Law| {
            let shape = shape.map(|(value, std)| Uncertain { value, std });
            let is_time = law.starts_with("standard");
            ComparedLaw {
                law: (*law).to_owned(),
                probability: *probability,
                parameters: Value::Null,
                exponent: shape.filter(|_| !is_time),
                time: shape.filter(|_| is_time),
                in_the_middle: None,
                likelihood: None,
            }
        };
        fit.laws = laws.iter().map(entry).collect();
        fit
    }

    fn factor(law: &str, a: (f64, f64), b: (f64, f64)) -> f64 {
        let of = |shape| joint(&[(law, 1.0, Some(shape))]);
        ln_of_one_shape(&[&of(a), &of(b)], law).exp()
    }

    #[test]
    fn exponents_that_are_told_apart_are_no_one_law_and_those_that_nothing_tells_may_be() {
        // Normal densities of 0.4 and 0.5, each to 0.1, over a width of 0.96:
        // e^(-0.1²/(4·0.1²))/(2·0.1·√π)·0.96.
        let exact = 0.96 * (-0.25f64).exp() / (0.2 * std::f64::consts::PI.sqrt());
        assert!((factor("fractional", (0.4, 0.1), (0.5, 0.1)) / exact - 1.0).abs() < 1e-2);
        assert!(factor("fractional", (0.977, 0.02), (0.02, 0.02)) < 1e-100);
        assert!((factor("fractional_with_mass", (0.9, 50.0), (0.1, 50.0)) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn times_are_held_against_what_is_known_beforehand() {
        // Told as beforehand: 1.
        let known = factor("standard_linear_solid", (1.0, 1.5), (1.0, 1.5));
        assert!((known - 1.0).abs() < 1e-2, "{known}");
        // ln τ of ±0.3 to 0.1: ∫ N(x; 0.3, 0.1) N(x; -0.3, 0.1)/N(x; 0, 1.5) dx = N(0.6; 0, 0.1·√2)·(1.5·√2π)
        // about x = 0.
        let exact = (-0.5 * 0.36 / 0.02f64).exp() / 0.02f64.sqrt() * 1.5;
        let of = |ln: f64| (ln.exp(), 0.1 * ln.exp());
        let found = factor("standard_linear_solid", of(0.3), of(-0.3));
        assert!((found / exact - 1.0).abs() < 1e-2, "{found} for {exact}");
    }

    #[test]
    fn a_law_without_shape_has_no_factor() {
        let of = |p| joint(&[("viscous", p, None)]);
        assert_eq!(ln_of_one_shape(&[&of(0.5), &of(0.2)], "viscous"), 0.0);
    }

    #[test]
    fn tests_of_one_law_are_seldom_said_to_be_of_two_and_those_of_two_exponents_often() {
        // A fractional law, its exponent anywhere and told to 0.05, which a viscous one imitates the better
        // the nearer to 1 it is.
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let decomposed = |exponent: f64| {
            let viscous = 0.5 * (-0.5 * ((1.0 - exponent) / 0.05).powi(2)).exp();
            let laws = [("fractional", 1.0 - viscous, Some((exponent, 0.05))), ("viscous", viscous, None)];
            joint(&laws)
        };
        let mut refuted = |apart: f64| {
            let count = 2000;
            let pair = |_: usize| {
                let truth = 0.1 + (0.8 - apart) * random.random::<f64>();
                let mut told = |truth: f64| (truth + 0.05 * normal(&mut random)).clamp(0.02, 0.98);
                let (one, other) = (decomposed(told(truth)), decomposed(told(truth + apart)));
                usize::from(in_common(&[&one, &other]).is_some_and(|common| common.is_refuted()))
            };
            (0..count).map(pair).sum::<usize>() as f64 / count as f64
        };
        let (same, apart) = (refuted(0.0), refuted(0.4));
        assert!(same < 0.02 && apart > 0.95, "{same} {apart}");
    }
}
