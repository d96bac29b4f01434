//! What a number means: a modulus as a material, a second moment as a section, an inertia as a bar.

use jointscope_fixture::{BeamBody, BodyKind, Fixture, JointLaw, NamedQuantity, QuantityKey, QuantityOwner};
use jointscope_spectra::in_sentence;
use std::f64::consts::TAU;

/// A material by its Young's modulus, GPa, and its density, kg/m³.
struct Material {
    name: &'static str,
    modulus: (f64, f64),
    density: f64,
}

/// Materials of test benches by ascending modulus, their usual ranges as handbooks state them; the first that
/// holds a modulus names it.
const MATERIALS: [Material; 8] = [
    Material { name: "rubber or foam", modulus: (0.0005, 0.1), density: 1100.0 },
    Material { name: "a soft plastic", modulus: (0.1, 2.2), density: 1000.0 },
    Material { name: "PMMA or another hard plastic", modulus: (2.2, 5.0), density: 1190.0 },
    Material { name: "wood or a composite", modulus: (8.0, 20.0), density: 600.0 },
    Material { name: "magnesium", modulus: (40.0, 47.0), density: 1780.0 },
    Material { name: "aluminium (or glass)", modulus: (64.0, 76.0), density: 2700.0 },
    Material { name: "brass, titanium or cast iron", modulus: (95.0, 130.0), density: f64::NAN },
    Material { name: "steel", modulus: (185.0, 218.0), density: 7850.0 },
];

fn material(modulus: f64) -> Option<&'static Material> {
    MATERIALS.iter().find(|m| (m.modulus.0..=m.modulus.1).contains(&(1e-9 * modulus)))
}

/// What a number means, in a few words; `None` where it says all by itself.
pub(crate) fn of(fixture: &Fixture, quantity: &NamedQuantity, total_mass: f64) -> Option<String> {
    use QuantityKey as Key;
    let value = quantity.value;
    match (quantity.owner, quantity.key) {
        (QuantityOwner::Body(body), Key::Inertia) => {
            let BodyKind::Rigid(rigid) = &fixture.bodies()[body].kind else { return None };
            let gyration = (value / rigid.mass.value).sqrt();
            Some(format!(
                "radius of gyration {}, that of a slender bar {} long",
                millimetres(gyration),
                millimetres(12f64.sqrt() * gyration)
            ))
        }
        (QuantityOwner::Body(body), Key::CentreOfGravity) => among_points(fixture, body, value),
        (_, Key::YoungsModulus) => Some(match material(value) {
            Some(material) => format!("{:.1} GPa, as of {}", 1e-9 * value, material.name),
            None => format!("{:.1} GPa", 1e-9 * value),
        }),
        (QuantityOwner::Body(body), Key::SecondMoment) => {
            let BodyKind::Beam(beam) = &fixture.bodies()[body].kind else { return None };
            Some(section(beam).unwrap_or_else(|| square(value)))
        }
        (QuantityOwner::Joint(joint), Key::SecondMoment) => {
            let joint = &fixture.joints()[joint];
            let JointLaw::Beam { youngs_modulus, .. } = &joint.law else { return None };
            let length = fixture.joint_length(joint);
            let stiffness = 12.0 * youngs_modulus.value * value / length.powi(3);
            Some(format!(
                "{}; over {} it resists a shift of its ends with {}",
                square(value),
                millimetres(length),
                engineering(stiffness, "N/m")
            ))
        }
        (QuantityOwner::Body(body), Key::MassPerLength) => {
            let BodyKind::Beam(beam) = &fixture.bodies()[body].kind else { return None };
            let length = beam.length();
            Some(format!("{} over {}", engineering(1e3 * value * length, "g"), millimetres(length)))
        }
        (QuantityOwner::Body(_), Key::Mass) if fixture.bodies().len() > 1 => {
            Some(format!("{:.0} % of the whole", 100.0 * value / total_mass))
        }
        (QuantityOwner::Support(_), Key::SupportStiffness(jointscope_fixture::Dof::Translation)) => {
            let hz = (value / total_mass).sqrt() / TAU;
            Some(format!("alone it carries the whole at {} Hz", in_sentence(hz)))
        }
        (_, Key::ModalRatio(_)) => Some(format!("{:.3} % of critical", 100.0 * value)),
        _ => None,
    }
}

/// Where an abscissa lies among the points of a body.
fn among_points(fixture: &Fixture, body: usize, x: f64) -> Option<String> {
    let points = fixture.points().iter().filter(|point| point.body == body);
    let (low, high) = points.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), point| {
        (low.min(point.x.value), high.max(point.x.value))
    });
    (low <= high).then(|| match x {
        x if x < low => format!("left of its points by {}", millimetres(low - x)),
        x if x > high => format!("right of its points by {}", millimetres(x - high)),
        x => format!(
            "{} right of its first point, {} left of its last",
            millimetres(x - low),
            millimetres(high - x)
        ),
    })
}

/// A beam body's section as a rectangle, where its modulus tells the material and that its density.
fn section(beam: &BeamBody) -> Option<String> {
    let material = material(beam.youngs_modulus.value)?;
    let area = beam.mass_per_length.value / material.density;
    let height = (12.0 * beam.second_moment.value / area).sqrt();
    (area > 0.0 && height.is_finite()).then(|| {
        format!(
            "with the modulus and the mass a rectangle {} wide and {} high of {}",
            millimetres(area / height),
            millimetres(height),
            material.name
        )
    })
}

fn square(second_moment: f64) -> String {
    format!("a square section {} deep", millimetres((12.0 * second_moment).sqrt().sqrt()))
}

fn millimetres(metres: f64) -> String {
    let value = 1e3 * metres;
    if value.abs() < 0.1 { format!("{value:.1e} mm") } else { format!("{value:.1} mm") }
}

/// Three significant digits and a prefix by thousands.
fn engineering(value: f64, unit: &str) -> String {
    let (factor, prefix) = match value.abs() {
        v if v >= 1e9 => (1e9, "G"),
        v if v >= 1e6 => (1e6, "M"),
        v if v >= 1e3 => (1e3, "k"),
        _ => (1.0, ""),
    };
    let value = value / factor;
    let decimals = if value.abs() >= 100.0 {
        0
    } else if value.abs() >= 10.0 {
        1
    } else {
        2
    };
    format!("{value:.decimals$} {prefix}{unit}")
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn means(path: &str) -> String {
        let fixture = Fixture::from_json(
            r#"{ "bodies": {
                "A": { "mass": 1.2, "inertia": 1e-3, "x_cg": -0.03 },
                "S": { "beam": { "from": 0.0, "to": 0.5, "youngs_modulus": 2.1e11, "second_moment": 7.2e-10, "mass_per_length": 1.884 } } },
              "points": { "1": { "body": "A", "x": -0.06 }, "2": { "body": "A", "x": 0 }, "3": { "body": "S", "x": 0 } },
              "supports": { "G": { "point": "1", "stiffness": 1000 } } }"#,
        );
        let fixture = fixture.unwrap();
        let quantity = fixture.quantities().into_iter().find(|q| q.path == path).unwrap();
        of(&fixture, &quantity, 2.142).unwrap()
    }

    #[test]
    fn a_beam_of_steel_is_told_as_the_strip_that_it_is() {
        // 40 mm × 6 mm: A = 2.4e-4 m², I = 7.2e-10 m⁴.
        assert_eq!(
            means("bodies/S/beam/second_moment"),
            "with the modulus and the mass a rectangle 40.0 mm wide and 6.0 mm high of steel"
        );
        assert_eq!(means("bodies/S/beam/youngs_modulus"), "210.0 GPa, as of steel");
        assert_eq!(means("bodies/S/beam/mass_per_length"), "942 g over 500.0 mm");
    }

    #[test]
    fn inertia_centre_and_support_are_told_as_lengths_and_a_frequency() {
        assert_eq!(
            means("bodies/A/inertia"),
            "radius of gyration 28.9 mm, that of a slender bar 100.0 mm long"
        );
        assert_eq!(means("bodies/A/x_cg"), "30.0 mm right of its first point, 30.0 mm left of its last");
        assert_eq!(means("supports/G/stiffness"), "alone it carries the whole at 3.439 Hz");
    }
}
