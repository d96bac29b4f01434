//! Effects made just so strong that they ought to show a little.

use crate::sensitivity::Sensitivity;
use crate::strength::{strength, with_strength};
use jointscope_fixture::Fixture;
use jointscope_rig::smoothed_variance;
use jointscope_spectra::FrfSet;

/// Lines on each side over which the recording's variance is averaged.
const SMOOTHED_OVER: usize = 10;

/// `truth` with its one effect made so strong that a fit without it should be worse by `wanted` in χ² and
/// squared departures, to first order, under the noise of `recorded`.
///
/// `None` where the effect does nothing, or its strength would be more than it was.
pub(crate) fn scaled_to(
    wanted: f64,
    believed: &Fixture,
    truth: &Fixture,
    recorded: &FrfSet,
) -> Option<Fixture> {
    let [effect] = truth.physics() else { return None };
    let bare = truth.clone().with_physics(Vec::new()).ok()?;
    // Not the diagnosis' own estimate of the noise: what makes cases does not ask what judges them.
    let mut weights = Vec::with_capacity(recorded.all_values().len());
    for index in 0..recorded.pairs().len() {
        let variance = smoothed_variance(recorded, index, SMOOTHED_OVER)?;
        weights.extend(variance.iter().map(|v| if *v > 0.0 { 2.0 / v } else { 0.0 }));
    }
    let direction = Sensitivity::of(believed, &bare, recorded, weights.into_iter())?.direction(effect)?;
    let information = direction.beyond_tolerances(&direction);
    let needed = (wanted / information).sqrt();
    if !(information > 0.0 && needed <= strength(effect).abs()) {
        return None;
    }
    let scaled = with_strength(effect, needed * strength(effect).signum());
    truth.clone().with_physics(vec![scaled]).ok()
}
