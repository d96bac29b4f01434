//! Places in words, and how what is missing there goes with frequency.

use super::numbers::plain;
use crate::location::{Location, Site};

/// Departures of the logarithm from a straight line beyond which a dynamic stiffness follows no power of frequency.
const NO_POWER: f64 = 0.7;

impl Site {
    /// The place in a few words: `body B at x = 110 mm`.
    pub fn says(&self) -> String {
        match self {
            Site::Body { body, x } => format!("body {body} at x = {}", plain(*x, "m")),
            Site::Series { joint, point: Some(point), dof } => {
                format!("joint {joint} in series at point {point} ({})", dof.name())
            }
            Site::Series { joint, point: None, dof } => format!("joint {joint} in series ({})", dof.name()),
            Site::Joint(joint) => format!("the stiffness of joint {joint}"),
            Site::Response(point) => format!("response {point}"),
            Site::Reference(point) => format!("reference {point}"),
            Site::Seat(point) => format!("the seat of point {point}"),
        }
    }
}

impl Location {
    /// How δ(ω) varies with frequency, with no physics named: `grows as frequency to the power 2.0, real and negative`. `None` where too few
    /// lines determine it.
    pub fn variation(&self) -> Option<String> {
        let known: Vec<_> = self
            .delta
            .iter()
            .filter(|d| d.frequency > 0.0 && d.std > 0.0 && d.value.norm() > 2.0 * d.std)
            .collect();
        if known.len() < 8 {
            return None;
        }
        // ln|δ| over ln f, weighted by how well it is known.
        let points: Vec<(f64, f64, f64)> = known
            .iter()
            .map(|d| {
                let (size, share) = (d.value.norm(), d.std / d.value.norm());
                (d.frequency.ln(), size.ln(), 1.0 / (share * share + 1e-4))
            })
            .collect();
        let total: f64 = points.iter().map(|p| p.2).sum();
        let mean =
            |of: &dyn Fn(&(f64, f64, f64)) -> f64| points.iter().map(|p| p.2 * of(p)).sum::<f64>() / total;
        let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
        let spread = mean(&|p| (p.0 - x).powi(2));
        if spread <= 0.0 {
            return None;
        }
        let power = mean(&|p| (p.0 - x) * (p.1 - y)) / spread;
        let scatter = mean(&|p| (p.1 - y - power * (p.0 - x)).powi(2)).sqrt();
        let sum: num_complex::Complex64 = known.iter().map(|d| d.value / d.value.norm()).sum();
        let direction = sum / known.len() as f64;
        let phase = if direction.norm() < 0.7 {
            "of changing phase"
        } else if direction.re.abs() > 2.0 * direction.im.abs() {
            if direction.re > 0.0 { "real and positive" } else { "real and negative" }
        } else if direction.im.abs() > 2.0 * direction.re.abs() {
            if direction.im > 0.0 { "imaginary and positive" } else { "imaginary and negative" }
        } else {
            "real and imaginary alike"
        };
        Some(match power {
            _ if scatter > NO_POWER => format!("follows no power of frequency, {phase}"),
            p if p.abs() < 0.25 => format!("is level over frequency, {phase}"),
            p if p > 0.0 => format!("grows as frequency to the power {p:.1}, {phase}"),
            p => format!("falls as frequency to the power {p:.1}, {phase}"),
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::location::LineEstimate;
    use num_complex::Complex64;

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
        assert_eq!(mass.variation().unwrap(), "grows as frequency to the power 2.0, real and negative");
        let spring = at(&|_| Complex64::new(1e4, 100.0));
        assert_eq!(spring.variation().unwrap(), "is level over frequency, real and positive");
        let dashpot = at(&|f| Complex64::new(0.0, 3.0 * f));
        assert_eq!(
            dashpot.variation().unwrap(),
            "grows as frequency to the power 1.0, imaginary and positive"
        );
        let mut unknown = spring.clone();
        unknown.delta.truncate(3);
        assert_eq!(unknown.variation(), None);
    }
}
