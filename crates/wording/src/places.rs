//! Places in words, and how what is missing there goes with frequency.

use crate::Says;
use crate::format::significant;
use crate::numbers::plain;
use jointscope_diagnosis::{Location, Phase, Site, Variation};

/// Exponents up to this size count as level.
const LEVEL: f64 = 0.25;

/// A few words: `body B at x = 110 mm`.
impl Says for Site {
    fn says(&self) -> String {
        match self {
            Site::Body { body, x } => format!("body {body} at x = {}", plain(*x, "m")),
            Site::Series { joint, point: Some(point), dof } => {
                format!("joint {joint} in series at point {point} ({})", dof.name())
            }
            Site::Series { joint, point: None, dof } => format!("joint {joint} in series ({})", dof.name()),
            Site::Joint(joint) => format!("the stiffness of joint {joint}"),
            Site::Response(point) => format!("response {point}"),
            Site::Reference(point) => format!("reference {point}"),
            Site::Position(point) => format!("the position of point {point}"),
        }
    }
}

/// A part of a recording that is held out, as one would say it: `180 to 240 Hz` for `band 180:240`, `FRF 4/2`
/// for `frf 4/2`.
pub fn held_out_part(name: &str) -> String {
    if let Some(frf) = name.strip_prefix("frf ") {
        return format!("FRF {frf}");
    }
    // Lines of long recordings lie at odd fractions of one hertz.
    let said = |text: &str| {
        let short = significant(text.parse().ok()?, 5);
        Some(if text.len() > short.len() { short } else { text.to_owned() })
    };
    let band = name.strip_prefix("band ").and_then(|band| band.split_once(':'));
    let ends = band.and_then(|(from, to)| Some((said(from)?, said(to)?)));
    ends.map_or_else(|| name.to_owned(), |(from, to)| format!("{from} to {to} Hz"))
}

/// A quantity by its path in the file, as one would say it: `the mass of B` for `bodies/B/mass`; the path
/// itself where there are no words for it.
pub(crate) fn quantity_name(path: &str) -> String {
    let parts: Vec<&str> = path.split('/').collect();
    let (what, whose) = match parts.as_slice() {
        ["bodies", body, "mass"] => ("mass", body),
        ["bodies", body, "inertia"] => ("inertia", body),
        ["bodies", body, "x_cg"] => ("centre of gravity", body),
        ["points", point, "x"] => return format!("the place of point {point}"),
        ["joints", joint, "beam", "youngs_modulus"] => {
            return format!("Young's modulus of joint {joint}");
        }
        _ => return path.to_owned(),
    };
    format!("the {what} of {whose}")
}

/// How δ(ω) of a place varies, with no physics named:
/// `grows as frequency to the power 2.0, real and negative`.
pub(crate) fn variation(location: &Location) -> Option<String> {
    let Variation { power, phase } = location.variation()?;
    let phase = match phase {
        Phase::RealPositive => "real and positive",
        Phase::RealNegative => "real and negative",
        Phase::ImaginaryPositive => "imaginary and positive",
        Phase::ImaginaryNegative => "imaginary and negative",
        Phase::Mixed => "real and imaginary alike",
        Phase::Changing => "of changing phase",
    };
    Some(match power {
        None => format!("follows no power of frequency, {phase}"),
        Some(p) if p.abs() < LEVEL => format!("is level over frequency, {phase}"),
        Some(p) if p > 0.0 => format!("grows as frequency to the power {p:.1}, {phase}"),
        Some(p) => format!("falls as frequency to the power {p:.1}, {phase}"),
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use jointscope_diagnosis::LineEstimate;
    use num_complex::Complex64;

    #[test]
    fn a_quantity_is_said_in_words_and_by_its_path_where_there_are_none() {
        assert_eq!(quantity_name("bodies/B/mass"), "the mass of B");
        assert_eq!(quantity_name("points/3/x"), "the place of point 3");
        assert_eq!(quantity_name("supports/left/stiffness"), "supports/left/stiffness");
    }

    #[test]
    fn a_missing_dynamic_stiffness_is_told_by_its_power_of_frequency_and_phase() {
        let at = |delta: &dyn Fn(f64) -> Complex64| Location {
            site: Site::Body { body: "B".into(), x: 0.1 },
            chi2_per_dof: 1.0,
            departures: 0.0,
            degrees: 100,
            p_value: 0.5,
            bands: Vec::new(),
            frfs: Vec::new(),
            masked: 0,
            laws: Vec::new(),
            delta: (1..40)
                .map(|i| {
                    let frequency = 20.0 * f64::from(i);
                    let value = delta(frequency);
                    LineEstimate { frequency, value, std: 0.05 * value.norm() }
                })
                .collect(),
        };
        let mass = at(&|f| Complex64::new(-0.05 * (std::f64::consts::TAU * f).powi(2), 0.0));
        assert_eq!(variation(&mass).unwrap(), "grows as frequency to the power 2.0, real and negative");
        let spring = at(&|_| Complex64::new(1e4, 100.0));
        assert_eq!(variation(&spring).unwrap(), "is level over frequency, real and positive");
        let dashpot = at(&|f| Complex64::new(0.0, 3.0 * f));
        assert_eq!(
            variation(&dashpot).unwrap(),
            "grows as frequency to the power 1.0, imaginary and positive"
        );
        let mut unknown = spring.clone();
        unknown.delta.truncate(3);
        assert_eq!(variation(&unknown), None);
    }

    #[test]
    fn bands_that_are_held_out_are_said_in_as_many_digits_as_one_reads() {
        assert_eq!(held_out_part("band 302.51953125:307.59765625"), "302.52 to 307.60 Hz");
        assert_eq!(held_out_part("band 305:365"), "305 to 365 Hz");
        assert_eq!(held_out_part("frf 4/2"), "FRF 4/2");
    }
}
