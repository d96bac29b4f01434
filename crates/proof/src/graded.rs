//! Effects made just so strong that they ought to show a little.

use crate::sensitivity::Sensitivity;
use crate::strength::{strength, with_strength};
use jointscope_fixture::Fixture;
use jointscope_spectra::FrfSet;

/// `truth` with its one effect made so strong that a fit without it should be worse by `wanted` in χ² and squared departures, to first
/// order, under the noise of `recorded`.
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
    let direction = Sensitivity::of(believed, &bare, recorded)?.direction(effect)?;
    let information = direction.beyond_tolerances(&direction);
    let needed = (wanted / information).sqrt();
    if !(information > 0.0 && needed <= strength(effect).abs()) {
        return None;
    }
    let scaled = with_strength(effect, needed * strength(effect).signum());
    truth.clone().with_physics(vec![scaled]).ok()
}
