//! Whether stated probabilities and intervals mean what they say.

use jointscope_proof::{Bin, Score, Share};

use crate::format::fixed;
use crate::plot::{Axis, Plot, Role};
use crate::section::Section;

pub(super) fn section(score: &Score) -> Section {
    let log_score = score.figure("log_score").and_then(|figure| figure.value);
    let width = score.figure("interval_width").and_then(|figure| figure.value);
    let mut said = Vec::new();
    if let Some(mean) = log_score {
        said.push(format!(
            "The mean logarithm of the probability that was given to the true name is {}; certainty and always right would be 0, a coin −0.693.",
            fixed(mean, 3)
        ));
    }
    if let Some(width) = width {
        said.push(format!(
            "Intervals are {width:.3} times as wide (median) as the Cramér–Rao bound allows an unbiased estimate to have them."
        ));
    }
    Section::new("Do probabilities and intervals mean what they say?")
        .plots(2, [reliability(score), coverage(score)].into_iter().flatten())
        .notes(said)
}

fn bounds(shares: &[Share], side: usize) -> Vec<f64> {
    shares.iter().map(|share| share.interval()[side]).collect()
}

fn square(title: &str, x: &str, y: &str) -> Plot {
    Plot::new(title, Axis::linear(x, ""), Axis::linear(y, ""))
        .over([0.0, 1.0])
        .dashed("as it should be", Role::Nominal, [0.0, 1.0])
        .height(320)
        .alone()
}

fn reliability(score: &Score) -> Option<Plot> {
    let bins: Vec<&Bin> = score.reliability.0.iter().filter(|bin| bin.true_names.all > 0).collect();
    let stated: Vec<f64> = bins.iter().map(|bin| bin.stated).collect();
    if stated.is_empty() || stated.windows(2).any(|w| w[0] >= w[1]) {
        return None;
    }
    let names: Vec<Share> = bins.iter().map(|bin| bin.true_names).collect();
    let acceptable: Vec<Option<f64>> = bins.iter().map(|bin| bin.acceptable.value()).collect();
    let count: usize = names.iter().map(|share| share.all).sum();
    Some(
        square("Reliability of stated probabilities", "stated probability of a name", "how often it was right")
            .over(stated)
            .band("95 % interval", Role::Uncertainty, bounds(&names, 0), bounds(&names, 1))
            .points("was the hidden name", Role::Estimate, names.iter().map(|share| share.value()))
            .points("hidden, or as good a fit", Role::Reference, acceptable)
            .caption(format!(
                "{count} names given to single effects that show, alternatives included, in classes of stated probability. Above the dashed line: too modest."
            )),
    )
}

fn coverage(score: &Score) -> Option<Plot> {
    let (levels, held): (Vec<f64>, Vec<Share>) = score.coverage.by_level().into_iter().unzip();
    let count = held.first().map_or(0, |share| share.all);
    (count > 0).then(|| {
        square("Coverage of stated intervals", "level of the interval", "share that holds the true parameter")
            .over(levels)
            .band("95 % interval", Role::Uncertainty, bounds(&held, 0), bounds(&held, 1))
            .points("intervals", Role::Estimate, held.iter().map(|share| share.value()))
            .caption(format!(
                "{count} intervals of parameters that the recording determines, of effects found by name; those of levels other than 95 % follow from the stated ones."
            ))
    })
}
