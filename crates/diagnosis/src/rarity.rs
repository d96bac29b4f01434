//! How much rarer some effects are than others before anything is recorded.

use crate::Hypothesis;
use crate::settings::effects::rarity::LONGER_JOINT;
use jointscope_fixture::{Effect, EffectKind, Place, QuantityOwner};

/// ln of how much rarer the effects of a hypothesis are than the commonest, nats: by kind, a joint that is
/// longer than its points say, and a quantity that is expected twice as far off is wrong half as often.
pub(crate) fn rarity(hypothesis: &Hypothesis) -> f64 {
    let of = |(index, effect): (usize, &Effect)| {
        let far = hypothesis.expected_error(index).map_or(0.0, f64::ln);
        let longer = if makes_a_joint_longer(hypothesis, effect) { LONGER_JOINT } else { 0.0 };
        effect.kind.spec().rarity + far + longer
    };
    hypothesis.effects().iter().enumerate().map(of).sum()
}

fn makes_a_joint_longer(hypothesis: &Hypothesis, effect: &Effect) -> bool {
    let fixture = hypothesis.fixture();
    match (&effect.place, effect.kind) {
        (_, EffectKind::JointLength) => effect.value(0) > 0.0,
        (Place::Quantity(path, _), _) => {
            let quantity = hypothesis.tolerances().iter().map(|t| &t.quantity).find(|q| q.path == *path);
            // A point has no quantity but its abscissa.
            let Some(QuantityOwner::Point(point)) = quantity.map(|quantity| quantity.owner) else {
                return false;
            };
            let outward = effect.value(0) - fixture.points()[point].x.value;
            fixture
                .joints()
                .iter()
                .any(|joint| (joint.from == point && outward < 0.0) || (joint.to == point && outward > 0.0))
        }
        _ => false,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use jointscope_fixture::Fixture;

    #[test]
    fn a_joint_is_longer_than_its_points_say_less_often_than_shorter() {
        let fixture = Fixture::from_json(
            r#"{ "bodies": { "A": { "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }, "B": { "mass": 1.2, "inertia": 9.9e-4, "x_cg": 0.095 } },
                 "points": { "1": { "body": "A", "x": {"value": -0.06, "std": 1e-4} }, "2": { "body": "A", "x": {"value": 0, "std": 1e-4} }, "3": { "body": "B", "x": {"value": 0.065, "std": 1e-4} } },
                 "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2e11, "second_moment": 4e-10 } } } }"#,
        )
        .unwrap();
        let nominal = Hypothesis::nominal(&fixture, false);
        let quantity = |path: &str| {
            let tolerance = nominal.tolerances().iter().find(|t| t.quantity.path == path).unwrap();
            Place::Quantity(path.into(), tolerance.quantity.key)
        };
        let of = |kind, place: &Place, value: f64| {
            rarity(&nominal.with(Effect::new(kind, place.clone(), None, &[value])))
        };
        let joint = Place::Joint("J".into());
        let length = [1e-3, -1e-3].map(|dx| of(EffectKind::JointLength, &joint, dx));
        let far_end = [0.067, 0.063].map(|x| of(EffectKind::QuantityError, &quantity("points/3/x"), x));
        let near_end = [-0.002, 0.002].map(|x| of(EffectKind::QuantityError, &quantity("points/2/x"), x));
        for [longer, shorter] in [length, far_end, near_end] {
            assert!((longer - shorter - LONGER_JOINT).abs() < 1e-9, "{longer} beside {shorter}");
        }
        let sensor = [-0.058, -0.062].map(|x| of(EffectKind::QuantityError, &quantity("points/1/x"), x));
        assert!((sensor[0] - sensor[1]).abs() < 1e-9, "it ends no joint");
    }
}
