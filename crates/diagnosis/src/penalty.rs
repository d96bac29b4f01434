//! What effects must gain in χ² before they are believed.

use crate::Hypothesis;
use crate::rarity::rarity;
use crate::settings::SelectionSettings;

/// What an effect must gain in χ² to be believed, given the penalty of its parameters. A search over many
/// candidates at several starts each gains 2 ln(candidates) more by its best one: the price of looking.
pub(crate) fn needed_gain(settings: &SelectionSettings, parameters: f64, candidates: usize) -> f64 {
    settings.penalty + parameters + 2.0 * (candidates as f64).ln()
}

/// What the effects of a hypothesis cost in χ² when hypotheses are compared: every parameter gains something
/// by chance, one that is searched over a range (a frequency, a time) has as many chances as the range has
/// resolvable values, and what is rare has the odds against it.
pub(crate) fn parameter_penalty(settings: &SelectionSettings, hypothesis: &Hypothesis) -> f64 {
    let ranges: f64 = hypothesis.effects().iter().map(|effect| effect.kind.spec().range_penalty).sum();
    // A modal ratio that may be less by what an effect dissipates is less probable where it stays as stated.
    let widened: f64 = (0..hypothesis.tolerances().len())
        .map(|index| hypothesis.prior(index))
        .filter(|precision| *precision > 0.0)
        .map(|precision| -precision.ln())
        .sum();
    settings.parameter_penalty * hypothesis.effect_parameters() as f64
        + ranges
        + widened
        + 2.0 * rarity(hypothesis)
}
