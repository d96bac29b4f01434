//! Whether the numbers of a fixture can belong to one structure.
//!
//! A mass in grams beside an inertia in kg·m², abscissae in mm, a modulus in GPa: each number by itself is
//! possible, together they are of no structure, and a diagnosis would explain the slip as physics. Where a
//! change of unit alone makes them fit, that is said.

use crate::settings::plausibility::{
    DENSITY, LEAST_MODULUS, MOST_DEPTH, MOST_MASS, SECTION_AREA, SPAN, USUAL_DENSITY, USUAL_SPAN,
};
use jointscope_fixture::{BodyKind, Fixture, JointLaw};

/// A number that no structure has beside the others.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{place}: {problem}{advice}; correct it, or insist on it with --as-stated")]
pub struct Implausible {
    /// Its place in the file.
    pub place: String,
    /// What is wrong with it.
    pub problem: String,
    /// What it may have been meant as, `: it looks like grams`; empty where nothing fits.
    pub advice: String,
}

/// The first number of a fixture that cannot belong to the same structure as the others.
///
/// # Errors
/// [`Implausible`].
pub fn plausible(fixture: &Fixture) -> Result<(), Implausible> {
    judged(fixture).find_map(Result::err).map_or(Ok(()), Err)
}

/// Every number of a fixture that cannot belong to the same structure as the others, in the order of the
/// file.
pub fn implausible(fixture: &Fixture) -> Vec<Implausible> {
    judged(fixture).filter_map(Result::err).collect()
}

fn judged(fixture: &Fixture) -> impl Iterator<Item = Result<(), Implausible>> {
    let bodies = fixture.bodies().iter().enumerate().map(move |(index, body)| match &body.kind {
        BodyKind::Rigid(rigid) if rigid.mass.value > MOST_MASS => Err(Implausible {
            place: format!("bodies/{}/mass", body.name),
            problem: format!(
                "a mass of {:e} kg is that of no body that is struck by a hammer",
                rigid.mass.value
            ),
            advice: String::new(),
        }),
        BodyKind::Rigid(rigid) if rigid.rotates => {
            let (Some(inertia), Some(x_cg)) = (rigid.inertia, rigid.x_cg) else { return Ok(()) };
            let points = fixture.points().iter().filter(|point| point.body == index);
            let away = points.map(|point| ((point.x.value - x_cg.value).abs(), point.name.as_str()));
            let farthest = away.max_by(|a, b| a.0.total_cmp(&b.0));
            span(&body.name, farthest.unwrap_or_default(), rigid.mass.value, inertia.value)
        }
        BodyKind::Beam(beam) => {
            let place = format!("bodies/{}/beam", body.name);
            let length = beam.length();
            section(&place, length, beam.youngs_modulus.value, beam.second_moment.value)
                .and_then(|()| density(&place, beam.mass_per_length.value, beam.second_moment.value))
        }
        BodyKind::Rigid(_) => Ok(()),
    });
    let joints = fixture.joints().iter().map(|joint| match &joint.law {
        JointLaw::Beam { youngs_modulus, second_moment } => {
            let place = format!("joints/{}/beam", joint.name);
            section(&place, fixture.joint_length(joint), youngs_modulus.value, second_moment.value)
        }
        JointLaw::Stiffness { .. } => Ok(()),
    });
    bodies.chain(joints)
}

fn span(body: &str, (farthest, point): (f64, &str), mass: f64, inertia: f64) -> Result<(), Implausible> {
    if farthest == 0.0 || mass <= 0.0 || inertia <= 0.0 {
        return Ok(());
    }
    let ratio = |farthest: f64, mass: f64, inertia: f64| farthest / (inertia / mass).sqrt();
    let stated = ratio(farthest, mass, inertia);
    if stated >= SPAN.0 && stated <= SPAN.1 {
        return Ok(());
    }
    let usual = |farthest: f64, mass: f64, inertia: f64| {
        let ratio = ratio(farthest, mass, inertia);
        let density = mass / (12.0 * inertia / mass).sqrt().powi(3);
        ratio >= USUAL_SPAN.0
            && ratio <= USUAL_SPAN.1
            && density >= USUAL_DENSITY.0
            && density <= USUAL_DENSITY.1
    };
    let (place, advice) = if usual(farthest, mass, 1e-6 * inertia) {
        (format!("bodies/{body}/inertia"), ": the inertia looks like kg·mm²".to_owned())
    } else if usual(farthest, 1e-3 * mass, inertia) {
        (format!("bodies/{body}/mass"), ": the mass looks like grams".to_owned())
    } else if usual(1e-3 * farthest, mass, inertia) {
        (format!("points/{point}/x"), ": abscissae look like millimetres".to_owned())
    } else {
        (format!("bodies/{body}"), ", be it the point's abscissa, `x_cg`, `inertia` or `mass`".to_owned())
    };
    Err(Implausible {
        place,
        problem: format!(
            "point {point} lies {} from the centre of gravity of body {body}, whose radius of gyration is {}",
            millimetres(farthest),
            millimetres((inertia / mass).sqrt())
        ),
        advice,
    })
}

fn millimetres(metres: f64) -> String {
    let value = 1e3 * metres;
    if value < 0.1 { format!("{value:.1e} mm") } else { format!("{value:.1} mm") }
}

fn section(place: &str, length: f64, modulus: f64, second_moment: f64) -> Result<(), Implausible> {
    if modulus > 0.0 && modulus < LEAST_MODULUS {
        let metal = |modulus: f64| (1e9..1.5e12).contains(&modulus);
        let advice = match (metal(1e9 * modulus), metal(1e6 * modulus)) {
            (true, _) => ": it looks like GPa",
            (false, true) => ": it looks like MPa",
            (false, false) => "",
        };
        return Err(Implausible {
            place: format!("{place}/youngs_modulus"),
            problem: format!("a Young's modulus of {modulus} Pa is that of no strip or beam"),
            advice: advice.to_owned(),
        });
    }
    let depth = |second_moment: f64| (12.0 * second_moment).sqrt().sqrt();
    if second_moment > 0.0 && length > 0.0 && depth(second_moment) > MOST_DEPTH * length {
        let advice = if depth(1e-12 * second_moment) < length { ": it looks like mm⁴" } else { "" };
        return Err(Implausible {
            place: format!("{place}/second_moment"),
            problem: format!(
                "a second moment of {second_moment} m⁴ is that of a section {:.3} m deep, of a beam {length:.3} m long",
                depth(second_moment)
            ),
            advice: advice.to_owned(),
        });
    }
    Ok(())
}

/// Refuses a mass per length that is of no material in any section of this second moment.
fn density(place: &str, mass_per_length: f64, second_moment: f64) -> Result<(), Implausible> {
    if mass_per_length <= 0.0 || second_moment <= 0.0 {
        return Ok(());
    }
    // Of the largest area the section can have, and of the least.
    let at_least = |mass_per_length: f64| mass_per_length / (SECTION_AREA.1 * second_moment.sqrt());
    let at_most = |mass_per_length: f64| mass_per_length / (SECTION_AREA.0 * second_moment.sqrt());
    let possible = |mass: f64| at_least(mass) <= DENSITY.1 && at_most(mass) >= DENSITY.0;
    if possible(mass_per_length) {
        return Ok(());
    }
    let (bound, density) = match at_least(mass_per_length) > DENSITY.1 {
        true => ("at least", at_least(mass_per_length)),
        false => ("at most", at_most(mass_per_length)),
    };
    let advice =
        if bound == "at least" && possible(1e-3 * mass_per_length) { ": it looks like g/m" } else { "" };
    Err(Implausible {
        place: format!("{place}/mass_per_length"),
        problem: format!(
            "{mass_per_length} kg/m in a section of a second moment of {second_moment} m⁴ is a density of {bound} {density:.3e} kg/m³, which no material has"
        ),
        advice: advice.to_owned(),
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn changed(path: &str, value: Value) -> Result<(), Implausible> {
        let mut file = json!({
            "bodies": { "A": { "mass": 1.102, "inertia": 5.9e-4, "x_cg": -0.031 }, "B": { "mass": 1.485, "inertia": 1.02e-3, "x_cg": 0.104 },
                "S": { "beam": { "from": 0.2, "to": 0.5, "youngs_modulus": 2.07e11, "second_moment": 3.4e-10, "mass_per_length": 0.9 } } },
            "points": { "1": { "body": "A", "x": -0.056 }, "2": { "body": "A", "x": 0.0 }, "3": { "body": "B", "x": 0.07 }, "4": { "body": "B", "x": 0.131 } },
            "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2.07e11, "second_moment": 3.4e-10 } } } });
        *file.pointer_mut(path).unwrap() = value;
        plausible(&Fixture::from_value(&file).unwrap())
    }

    #[test]
    fn numbers_of_one_structure_are_plausible() {
        assert_eq!(changed("/bodies/A/mass", json!(1.102)), Ok(()));
        assert_eq!(changed("/joints/J/beam/youngs_modulus", json!(2e6)), Ok(()));
    }

    #[test]
    fn every_slip_is_told_not_only_the_first() {
        let file = json!({
            "bodies": { "A": { "mass": 1102.0, "inertia": 5.9e-4, "x_cg": -0.031 }, "B": { "mass": 1.485, "inertia": 1.02e-3, "x_cg": 0.104 } },
            "points": { "1": { "body": "A", "x": -0.056 }, "2": { "body": "A", "x": 0.0 }, "3": { "body": "B", "x": 0.07 } },
            "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 207.0, "second_moment": 3.4e-10 } } } });
        let places: Vec<String> =
            implausible(&Fixture::from_value(&file).unwrap()).into_iter().map(|slip| slip.place).collect();
        assert_eq!(places, ["bodies/A/mass", "joints/J/beam/youngs_modulus"]);
    }

    #[test]
    fn slips_of_a_unit_are_told_by_what_they_look_like() {
        for (path, value, place, advice) in [
            ("/bodies/A/mass", 1102.0, "bodies/A/mass", "grams"),
            ("/bodies/A/mass", 1e300, "bodies/A/mass", "no body"),
            ("/bodies/A/inertia", 590.0, "bodies/A/inertia", "kg·mm²"),
            ("/points/4/x", 131.0, "points/4/x", "millimetres"),
            ("/joints/J/beam/youngs_modulus", 207.0, "joints/J/beam/youngs_modulus", "GPa"),
            ("/joints/J/beam/youngs_modulus", 207e3, "joints/J/beam/youngs_modulus", "MPa"),
            ("/joints/J/beam/second_moment", 340.0, "joints/J/beam/second_moment", "mm⁴"),
            ("/bodies/S/beam/mass_per_length", 900.0, "bodies/S/beam/mass_per_length", "g/m"),
            ("/bodies/S/beam/mass_per_length", 1e-6, "bodies/S/beam/mass_per_length", "at most"),
            ("/bodies/B/x_cg", 5.0, "bodies/B", "radius of gyration"),
            ("/points/4/x", -0.5, "bodies/B", "point 4 lies 604"),
            ("/bodies/B/inertia", 1e-12, "bodies/B", "radius of gyration"),
        ] {
            let found = changed(path, json!(value)).unwrap_err();
            assert!(found.place == place && found.to_string().contains(advice), "{path} {value}: {found}");
        }
    }
}
