//! Names that are exactly the same thing in a recording: a hammer's gain and that of the only reference, a
//! sensor's mass and mass on the body that is read nowhere else.

use crate::hammer_test::recorded_lines;
use crate::objective::relative_error;
use jointscope_fixture::{Effect, EffectKind, Fixture, Place};
use jointscope_rig::{Instrument, frfs};
use jointscope_spectra::{FrfPair, FrfSet};

/// Relative difference of FRFs below which it is rounding.
const ROUNDING: f64 = 1e-9;

/// Whether an effect of the name of `found` makes exactly the FRFs that `hidden` makes, whatever the
/// structure: its size follows from the hidden one's.
pub(super) fn is_the_same(fixture: &Fixture, recorded: &[FrfPair], hidden: &Effect, found: &Effect) -> bool {
    let equal = equals(fixture, hidden, found);
    if equal.is_empty() {
        return false;
    }
    let Some(own) = read(fixture, hidden, recorded) else { return false };
    let is_same = |effect: &Effect| {
        read(fixture, effect, recorded).is_some_and(|set| relative_error(&set, &own) < ROUNDING)
    };
    equal.iter().any(is_same)
}

/// What `hidden` could be by the name of `found`.
fn equals(fixture: &Fixture, hidden: &Effect, found: &Effect) -> Vec<Effect> {
    let value = hidden.value(0);
    let at = |values: &[f64]| Effect::new(found.kind, found.place.clone(), found.dof, values);
    match (hidden.kind, found.kind, &hidden.place) {
        (EffectKind::ChannelGain, EffectKind::ChannelGain, _) => vec![at(&[value]), at(&[value.recip()])],
        (EffectKind::ChannelDelay, EffectKind::ChannelDelay, _) => vec![at(&[value]), at(&[-value])],
        (EffectKind::ChannelHighpass | EffectKind::ChannelResonance, kind, _) if kind == hidden.kind => {
            vec![Effect { place: found.place.clone(), ..hidden.clone() }]
        }
        (EffectKind::SensorMass, EffectKind::AddedMass, Place::Response(point)) => {
            fixture.point(point).map(|point| at(&[point.x.value, value])).into_iter().collect()
        }
        _ => Vec::new(),
    }
}

fn read(fixture: &Fixture, effect: &Effect, pairs: &[FrfPair]) -> Option<FrfSet> {
    let with = fixture.clone().with_physics(vec![effect.clone()]).ok()?;
    frfs(&with, pairs, &recorded_lines().ok()?, Instrument::AsDescribed).ok()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use jointscope_rig::{Family, generator};

    #[test]
    fn a_gain_of_the_force_is_that_of_the_only_reference_and_of_no_other() {
        let fixture = Family::TwoBlocks.draw("case", &mut generator(3)).unwrap();
        let gain = |place| Effect::new(EffectKind::ChannelGain, place, None, &[1.2]);
        let (force, reference) = (gain(Place::Force), gain(Place::Reference("1".into())));
        let response = gain(Place::Response("4".into()));
        let pairs = |all: &[(&str, &str)]| -> Vec<FrfPair> {
            all.iter().map(|(to, from)| FrfPair::transverse(to, from)).collect()
        };
        let (one_struck, one_read) = (pairs(&[("4", "1"), ("3", "1")]), pairs(&[("4", "1"), ("4", "2")]));
        assert!(is_the_same(&fixture, &one_struck, &force, &reference));
        assert!(!is_the_same(&fixture, &one_struck, &force, &response));
        assert!(is_the_same(&fixture, &one_read, &force, &response), "its inverse does the same");
        assert!(!is_the_same(&fixture, &one_read, &force, &reference));
    }

    #[test]
    fn a_sensors_mass_on_the_only_response_is_mass_on_its_body() {
        let fixture = Family::TwoBlocks.draw("case", &mut generator(3)).unwrap();
        let sensor = Effect::new(EffectKind::SensorMass, Place::Response("4".into()), None, &[0.02]);
        let added =
            |body: &str| Effect::new(EffectKind::AddedMass, Place::Body(body.into()), None, &[0.0, 0.05]);
        let one_read = [FrfPair::transverse("4", "1"), FrfPair::transverse("4", "2")];
        let both = [FrfPair::transverse("4", "1"), FrfPair::transverse("3", "1")];
        assert!(is_the_same(&fixture, &one_read, &sensor, &added("B")));
        assert!(!is_the_same(&fixture, &one_read, &sensor, &added("A")));
        assert!(!is_the_same(&fixture, &both, &sensor, &added("B")));
    }
}
