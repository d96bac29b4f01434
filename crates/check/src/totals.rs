//! Mass, centre of gravity and inertia of the whole: what scales and a drawing tell as well.

use crate::Figure;
use crate::figure::deviations;
use jointscope_fixture::{BodyKind, EffectKind, Fixture, Place};
use serde::Serialize;
use std::collections::BTreeSet;

/// Something that has a mass.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MassPart {
    /// Its path in the file, such as `bodies/A` or `bodies/A/masses/0`.
    pub path: String,
    /// kg.
    pub mass: f64,
    /// Abscissa of its centre of gravity, m; `None` for a body that does not rotate and states none.
    pub x_cg: Option<f64>,
    /// Moment of inertia about its own centre of gravity, kg·m²; `None` for a body that does not rotate.
    pub inertia: Option<f64>,
}

/// Totals of the assembly, known masses and masses among its effects included.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Totals {
    /// Total mass.
    pub mass: Figure,
    /// Abscissa of the common centre of gravity; `None` where a body does not say where its own is.
    pub x_cg: Option<Figure>,
    /// Moment of inertia about the common centre of gravity; `None` where a body does not rotate.
    pub inertia: Option<Figure>,
    /// What it is made of.
    pub parts: Vec<MassPart>,
}

impl Totals {
    pub(crate) fn of(fixture: &Fixture) -> Self {
        let parts = parts(fixture);
        let nominal = sums(&parts);
        let std = deviations(fixture, &nominal, &BTreeSet::new(), |moved| Some(sums(&self::parts(moved))));
        let figure =
            |k: usize, unit| nominal[k].is_finite().then(|| Figure { value: nominal[k], std: std[k], unit });
        Totals {
            mass: Figure { value: nominal[0], std: std[0], unit: "kg" },
            x_cg: figure(1, "m"),
            inertia: figure(2, "kg*m^2"),
            parts,
        }
    }
}

/// Mass, centre of gravity and inertia; what is not known is NaN.
fn sums(parts: &[MassPart]) -> Vec<f64> {
    let mass: f64 = parts.iter().map(|part| part.mass).sum();
    let x_cg = parts.iter().map(|part| part.x_cg.map_or(f64::NAN, |x| part.mass * x)).sum::<f64>() / mass;
    let about = |part: &MassPart| match (part.inertia, part.x_cg) {
        (Some(inertia), Some(x)) => inertia + part.mass * (x - x_cg).powi(2),
        _ => f64::NAN,
    };
    vec![mass, x_cg, parts.iter().map(about).sum()]
}

fn parts(fixture: &Fixture) -> Vec<MassPart> {
    let mut parts = Vec::new();
    let point = |path: String, mass: f64, x: f64, turns: bool| MassPart {
        path,
        mass,
        x_cg: Some(x),
        inertia: turns.then_some(0.0),
    };
    for body in fixture.bodies() {
        let path = format!("bodies/{}", body.name);
        parts.push(match &body.kind {
            BodyKind::Rigid(rigid) => MassPart {
                path: path.clone(),
                mass: rigid.mass.value,
                x_cg: rigid.x_cg.map(|x| x.value),
                inertia: rigid.inertia.filter(|_| rigid.rotates).map(|inertia| inertia.value),
            },
            BodyKind::Beam(beam) => {
                let (length, mass) = (beam.length(), body.kind.mass());
                let x = 0.5 * (beam.from.value + beam.to.value);
                MassPart {
                    path: path.clone(),
                    mass,
                    x_cg: Some(x),
                    inertia: Some(mass * length * length / 12.0),
                }
            }
        });
        for (index, mass) in body.masses.iter().enumerate() {
            let path = format!("{path}/masses/{index}");
            parts.push(point(path, mass.mass.value, mass.x.value, body.kind.rotates()));
        }
    }
    for (index, effect) in fixture.physics().iter().enumerate() {
        let path = format!("physics/{index}");
        let turns = |name: &str| fixture.body(name).is_some_and(|body| body.kind.rotates());
        match (effect.kind, &effect.place) {
            // Both have the abscissa first and the mass second.
            (EffectKind::AddedMass | EffectKind::AttachedResonator, Place::Body(name)) => {
                let mut part = point(path, effect.value(1), effect.value(0), turns(name));
                part.inertia = part.inertia.map(|inertia| inertia + effect.inertia_about_axis());
                parts.push(part);
            }
            (EffectKind::JointMass, Place::Joint(name)) => {
                if let Some(joint) = fixture.joint(name) {
                    let (length, mass) = (fixture.joint_length(joint), effect.value(0));
                    let x = fixture.points()[joint.from].x.value + 0.5 * length;
                    let inertia = Some(mass * length * length / 12.0);
                    parts.push(MassPart { path, mass, x_cg: Some(x), inertia });
                }
            }
            _ => {}
        }
    }
    parts
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn totals_are_those_of_the_parallel_axis_theorem_with_the_deviations_of_the_masses() {
        let fixture = Fixture::from_json(
            r#"{ "bodies": {
                "A": { "mass": {"value": 2.0, "std": 0.03}, "inertia": 0.001, "x_cg": {"value": -0.1, "std": 0} },
                "B": { "beam": { "from": 0.0, "to": 0.2, "youngs_modulus": 2e11, "second_moment": 1e-9, "mass_per_length": {"value": 5.0, "std": 0.2} },
                       "masses": [{ "x": 0.2, "mass": {"value": 1.0, "std": 0.0} }] } },
              "points": {} }"#,
        );
        let totals = Totals::of(&fixture.unwrap());
        let x_cg = (2.0 * -0.1 + 1.0 * 0.1 + 1.0 * 0.2) / 4.0;
        assert!((totals.mass.value - 4.0).abs() < 1e-12);
        assert!((totals.x_cg.unwrap().value - x_cg).abs() < 1e-12);
        let inertia = 0.001 + 2.0 * 0.125f64.powi(2) + 0.04 / 12.0 + 0.075f64.powi(2) + 0.175f64.powi(2);
        assert!((totals.inertia.unwrap().value - inertia).abs() < 1e-12);
        // Masses of 0.03 and 0.04 kg; the ends' 0.2 mm by 5 kg/m are 1 g each.
        let std = (0.03f64.powi(2) + 0.04f64.powi(2) + 2.0 * 0.001f64.powi(2)).sqrt();
        assert!((totals.mass.std.unwrap() - std).abs() < 1e-6, "{:?}", totals.mass);
    }

    #[test]
    fn what_rests_on_an_unknown_number_has_no_deviation_and_storeys_have_no_inertia() {
        let fixture = Fixture::from_json(
            r#"{ "bodies": { "A": { "mass": {"value": 2.0, "std": "unknown"}, "rotates": false } }, "points": {} }"#,
        );
        let totals = Totals::of(&fixture.unwrap());
        assert_eq!((totals.mass.value, totals.mass.std), (2.0, None));
        assert_eq!((totals.x_cg, totals.inertia), (None, None));
    }
}
