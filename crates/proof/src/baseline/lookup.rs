//! The nearest of a library of simulated signatures.

use crate::effect_file::in_file;
use jointscope_diagnosis::{Observation, catalogue};
use jointscope_fixture::{Effect, Fixture};
use jointscope_lumped::{Instrument, synthesize};
use num_complex::Complex64;
use serde::Serialize;

/// The signature that a misfit looks most like.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Lookup {
    /// The effect that it is of.
    #[serde(serialize_with = "in_file")]
    pub effect: Effect,
    /// Cosine between signature and misfit, both in units of the noise.
    pub likeness: f64,
}

impl Lookup {
    /// Looks a recording's misfit up. The library holds the effects that the diagnosis knows, at every place,
    /// in the sizes from which it sets out. `None` where no signature can be simulated.
    pub fn of(refitted: &Fixture, observation: &Observation) -> Option<Self> {
        let predict = |fixture: &Fixture| {
            let (pairs, lines) = (observation.pairs(), observation.lines());
            synthesize(fixture, pairs, lines, Instrument::AsRecorded)
                .ok()
                .map(|set| set.all_values().to_vec())
        };
        let plain = predict(refitted)?;
        let pattern = |to: &[Complex64]| -> Vec<Complex64> {
            let differences = to.iter().zip(&plain).zip(observation.weights());
            differences.map(|((a, b), weight)| (a - b) * weight.sqrt()).collect()
        };
        let misfit = pattern(observation.values());
        let mut nearest: Option<Lookup> = None;
        for candidate in catalogue(refitted, observation) {
            for index in 0..candidate.starts.len() {
                let effect = candidate.effect(index);
                let with = refitted.clone().with_physics(vec![effect.clone()]).ok();
                let Some(signature) = with.and_then(|with| predict(&with)) else { continue };
                let likeness = cosine(&pattern(&signature), &misfit);
                if nearest.as_ref().is_none_or(|nearest| likeness > nearest.likeness) && likeness.is_finite()
                {
                    nearest = Some(Lookup { effect, likeness });
                }
            }
        }
        nearest
    }
}

fn cosine(a: &[Complex64], b: &[Complex64]) -> f64 {
    let product: f64 = a.iter().zip(b).map(|(a, b)| a.re * b.re + a.im * b.im).sum();
    let square = |v: &[Complex64]| v.iter().map(|v| v.norm_sqr()).sum::<f64>();
    product / (square(a) * square(b)).sqrt()
}
