//! Edits of a fixture's entries: what an analyst who forgets or misstates something would have written.

use jointscope_fixture::{
    Effect, EffectKind, Fixture, FixtureError, Place, QuantityKey, QuantityOwner, Spread,
};
use serde_json::{Value, json};

/// An entry that can be deleted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Entry {
    /// An effect of `physics`.
    Effect(usize),
    /// A point mass of a body.
    Mass { body: usize, mass: usize },
    /// A support.
    Support(usize),
}

/// The entries of a fixture whose absence one effect describes.
pub(super) fn entries(fixture: &Fixture) -> Vec<Entry> {
    let effects = fixture.physics().iter().enumerate().filter(|(_, effect)| !effect.kind.is_nonlinear());
    let mut all: Vec<Entry> = effects.map(|(index, _)| Entry::Effect(index)).collect();
    for (body, entry) in fixture.bodies().iter().enumerate() {
        let there = entry.masses.iter().enumerate().filter(|(_, mass)| mass.mass.value > 0.0);
        all.extend(there.map(|(mass, _)| Entry::Mass { body, mass }));
    }
    // No effect holds a rotation.
    let supports = fixture.supports().iter().enumerate();
    let plain = supports.filter(|(_, support)| {
        support.rotational_stiffness.is_none() && support.rotational_damping.is_none()
    });
    all.extend(plain.map(|(index, _)| Entry::Support(index)));
    all
}

impl Entry {
    /// The entry as the effect that stands for it where it is missing.
    pub(super) fn as_effect(self, fixture: &Fixture) -> Effect {
        let body = |index: usize| Place::Body(fixture.bodies()[index].name.clone());
        match self {
            Entry::Effect(index) => fixture.physics()[index].clone(),
            Entry::Mass { body: of, mass } => {
                let mass = &fixture.bodies()[of].masses[mass];
                Effect::new(EffectKind::AddedMass, body(of), None, &[mass.x.value, mass.mass.value])
            }
            Entry::Support(index) => {
                let support = &fixture.supports()[index];
                let (of, x) = fixture.support_place(support);
                let damping = support.damping.map_or(0.0, |damping| damping.value);
                Effect::new(EffectKind::Support, body(of), None, &[x, support.stiffness.value, damping])
            }
        }
    }

    /// Its place in the file.
    pub(super) fn path(self, fixture: &Fixture) -> String {
        match self {
            Entry::Effect(index) => format!("physics/{index}"),
            Entry::Mass { body, mass } => format!("bodies/{}/masses/{mass}", fixture.bodies()[body].name),
            Entry::Support(index) => format!("supports/{}", fixture.supports()[index].name),
        }
    }

    /// The fixture without it.
    pub(super) fn deleted(self, fixture: &Fixture) -> Result<Fixture, FixtureError> {
        match self {
            Entry::Effect(index) => {
                let mut physics = fixture.physics().to_vec();
                physics.remove(index);
                fixture.clone().with_physics(physics)
            }
            Entry::Mass { body, mass } => edited(fixture, |file| {
                let masses = file["bodies"][&fixture.bodies()[body].name]["masses"].as_array_mut();
                masses.into_iter().for_each(|masses| _ = masses.remove(mass));
            }),
            Entry::Support(index) => edited(fixture, |file| {
                let supports = file["supports"].as_object_mut();
                supports.into_iter().for_each(|all| _ = all.remove(&fixture.supports()[index].name));
            }),
        }
    }
}

/// The fixture with one more point mass.
pub(super) fn with_mass(fixture: &Fixture, body: &str, x: f64, mass: f64) -> Result<Fixture, FixtureError> {
    edited(fixture, |file| {
        let entry = json!({ "x": x, "mass": mass });
        match file["bodies"][body]["masses"].as_array_mut() {
            Some(masses) => masses.push(entry),
            None => file["bodies"][body]["masses"] = json!([entry]),
        }
    })
}

/// The fixture with a point stated `dx` farther along.
pub(super) fn with_point_moved(fixture: &Fixture, point: usize, dx: f64) -> Result<Fixture, FixtureError> {
    requantified(fixture, |owner, _| owner == QuantityOwner::Point(point), |x| x + dx, 1.0)
}

/// The fixture with the stiffness of a joint or beam body stated `factor` times as large, its relative
/// deviation as it was.
pub(super) fn with_stiffness(
    fixture: &Fixture,
    stiff: QuantityOwner,
    factor: f64,
) -> Result<Fixture, FixtureError> {
    requantified(fixture, |owner, key| owner == stiff && is_stiffness(key), |value| value * factor, factor)
}

/// Whether the stiffness of a joint or beam body is proportional to a quantity of it.
pub(super) fn is_stiffness(key: QuantityKey) -> bool {
    matches!(key, QuantityKey::JointStiffness(..) | QuantityKey::YoungsModulus)
}

/// Changes the quantities that are `asked` for, stated deviations by `wider`.
fn requantified(
    fixture: &Fixture,
    asked: impl Fn(QuantityOwner, QuantityKey) -> bool,
    change: impl Fn(f64) -> f64,
    wider: f64,
) -> Result<Fixture, FixtureError> {
    let mut other = fixture.clone();
    for entry in other.quantities_mut().into_iter().filter(|entry| asked(entry.owner, entry.key)) {
        entry.quantity.value = change(entry.quantity.value);
        if let Spread::Stated(std) = &mut entry.quantity.spread {
            *std *= wider;
        }
    }
    // Checks the fixture anew, as a file would be.
    let physics = other.physics().to_vec();
    other.with_physics(physics)
}

/// The fixture whose file is that of this one, edited.
fn edited(fixture: &Fixture, edit: impl FnOnce(&mut Value)) -> Result<Fixture, FixtureError> {
    let mut file = fixture.to_value();
    edit(&mut file);
    Fixture::from_json(&file.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_fixture::JointLaw;

    fn fixture() -> Fixture {
        Fixture::from_json(
            r#"{
              "bodies": {
                "A": { "mass": 2.0, "inertia": 1e-3, "x_cg": 0.0, "masses": [{"x": 0.01, "mass": 0.02}, {"x": 0.02, "mass": 0.03}] },
                "B": { "mass": 3.0, "inertia": 1e-3, "x_cg": 0.1 } },
              "points": { "1": { "body": "A", "x": 0.02 }, "2": { "body": "B", "x": 0.08 } },
              "joints": { "J": { "from": "1", "to": "2",
                "stiffness": [[{"value": 4e6, "std": 1e5}, -1e5], [-1e5, 5e3]] } },
              "supports": { "S": { "body": "A", "x": 0.0, "stiffness": 200.0 },
                "clamp": { "body": "B", "x": 0.1, "stiffness": 1e6, "rotational_stiffness": 1e3 } },
              "physics": [ { "kind": "interface_compliance", "place": "2", "dof": "rotation", "stiffness": 1e4 },
                { "kind": "gap", "place": "J", "dof": "translation", "clearance": 1e-5, "stiffness": 1e6 } ]
            }"#,
        )
        .unwrap()
    }

    #[test]
    fn every_entry_that_one_effect_stands_for_can_be_deleted_and_no_other() {
        let fixture = fixture();
        let paths: Vec<String> = entries(&fixture).iter().map(|entry| entry.path(&fixture)).collect();
        assert_eq!(paths, ["physics/0", "bodies/A/masses/0", "bodies/A/masses/1", "supports/S"]);
        for entry in entries(&fixture) {
            let without = entry.deleted(&fixture).unwrap();
            assert_eq!(entries(&without).len(), 3, "{}", entry.path(&fixture));
        }
        let mass = Entry::Mass { body: 0, mass: 1 };
        assert_eq!(mass.as_effect(&fixture).value(1), 0.03);
        assert_eq!(mass.deleted(&fixture).unwrap().bodies()[0].masses[0].mass.value, 0.02);
        assert_eq!(Entry::Support(0).deleted(&fixture).unwrap().supports()[0].name, "clamp");
    }

    #[test]
    fn what_is_misstated_is_misstated_and_all_else_stays() {
        let before = fixture();
        let moved = with_point_moved(&before, 0, 0.003).unwrap();
        assert_eq!(moved.points()[0].x.value, 0.023);
        assert_eq!((moved.points()[1].x, moved.joints()), (before.points()[1].x, before.joints()));
        let soft = with_stiffness(&before, QuantityOwner::Joint(0), 0.5).unwrap();
        let JointLaw::Stiffness { stiffness, .. } = &soft.joints()[0].law else { panic!("a stiffness") };
        assert_eq!(stiffness.map(|q| q.value), [2e6, -5e4, 2.5e3]);
        assert_eq!(stiffness[0].spread, Spread::Stated(5e4));
        let heavy = with_mass(&before, "B", 0.09, 0.1).unwrap();
        assert_eq!((heavy.bodies()[1].masses.len(), heavy.bodies()[0].masses.len()), (1, 2));
        assert_eq!(heavy.supports(), before.supports());
    }
}
