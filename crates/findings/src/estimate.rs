//! A parameter of what was found, with deviation and interval; of a vague one only the order of magnitude is
//! known.

use jointscope_fixture::{Dof, Motion, ParameterRange, ParameterSpec};
use jointscope_inference::{Z95, interval95};
use serde::Serialize;

/// Ratio of the interval's ends beyond which only the order of magnitude is known.
const VAGUE: f64 = 30.0;
/// Largest exponent of an interval's ratio: its ends stay finite.
const MOST_EXPONENT: f64 = 50.0;

/// A parameter of an effect that was found, SI units.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Estimate {
    /// Name and range.
    #[serde(skip)]
    pub parameter: ParameterSpec,
    /// The value.
    pub value: f64,
    /// One standard deviation; `None` where the data do not determine it.
    pub std: Option<f64>,
    /// 95 % interval.
    #[serde(rename = "ci95")]
    pub interval: Option<[f64; 2]>,
    /// The unit, which the effect's degree of freedom decides.
    pub unit: &'static str,
}

impl Estimate {
    /// A value that nothing is known of yet beyond itself.
    pub fn of(parameter: ParameterSpec, dof: Option<Dof>, value: f64) -> Self {
        Estimate { parameter, value, std: None, interval: None, unit: parameter.unit_in(dof) }
    }

    /// Whether its interval, if it has one, holds its value.
    pub fn holds_its_value(&self) -> bool {
        self.interval.is_none_or(|[low, high]| (low..=high).contains(&self.value))
    }

    /// The same known to ± `std`, its errors normal; the interval holds none but possible values: of a
    /// dashpot that may be none it begins at zero. What tells a height across a body is its square, whose errors
    /// are normal.
    pub fn within(self, std: f64) -> Self {
        let [low, high] = interval95(self.value, std);
        let low = match self.parameter.motion {
            Motion::AcrossBody => {
                (self.value * self.value - 2.0 * Z95 * self.value.abs() * std).max(0.0).sqrt()
            }
            _ => low,
        };
        Estimate { std: Some(std), interval: Some([low.max(self.least()), high]), ..self }
    }

    /// The same known to ± `deviation` in its logarithm: an interval of ratios, lopsided where it is wide.
    pub fn within_ratio(self, deviation: f64) -> Self {
        let factor = (Z95 * deviation).min(MOST_EXPONENT).exp();
        let interval = [self.value / factor, self.value * factor];
        Estimate { std: Some(deviation * self.value.abs()), interval: Some(interval), ..self }
    }

    /// The interval as far as the parameter's range goes.
    pub fn possible_interval(&self) -> Option<[f64; 2]> {
        self.interval.map(|[low, high]| [low.max(self.least()), high])
    }

    /// The least value of the parameter's range.
    fn least(&self) -> f64 {
        match self.parameter.range {
            ParameterRange::Positive | ParameterRange::NonNegative => 0.0,
            ParameterRange::Any | ParameterRange::NonZero => f64::NEG_INFINITY,
        }
    }

    /// Whether the data tell no more of the value than its order of magnitude.
    pub fn is_vague(&self) -> bool {
        self.possible_interval().is_some_and(|[low, high]| {
            !(low.is_finite() && high.is_finite()) || low > 0.0 && high / low > VAGUE
        })
    }

    /// Whether the whole interval lies above zero.
    pub fn is_positive(&self) -> bool {
        self.interval.is_some_and(|[low, _]| low > 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_fixture::EffectKind;

    #[test]
    fn an_interval_of_what_cannot_be_negative_begins_at_zero() {
        let of = |kind: EffectKind, name: &str| {
            let parameter = kind.spec().parameters.iter().find(|p| p.name == name).copied();
            Estimate::of(parameter.expect("it has one"), None, 0.002).within(0.01).interval
        };
        let upper = 0.002 + Z95 * 0.01;
        assert_eq!(of(EffectKind::InterfaceCompliance, "damping"), Some([0.0, upper]));
        assert_eq!(of(EffectKind::AttachedResonator, "damping_ratio"), Some([0.0, upper]));
        assert_eq!(of(EffectKind::PointOffset, "dx"), Some([0.002 - Z95 * 0.01, upper]));
    }

    #[test]
    fn a_height_of_three_deviations_may_be_none() {
        let parameters = EffectKind::AddedMass.spec().parameters;
        let height = parameters.iter().find(|p| p.name == "height").copied().expect("it has one");
        let low =
            |value: f64, std: f64| Estimate::of(height, None, value).within(std).interval.map(|[low, _]| low);
        // h² = 346 ± 186 mm².
        assert_eq!(low(0.0186, 0.005), Some(0.0));
        // h² = 400 ± 40 mm².
        let expected = (400e-6 - Z95 * 40e-6).sqrt();
        assert!(low(0.02, 0.001).is_some_and(|low| (low - expected).abs() < 1e-9));
    }

    #[test]
    fn a_value_beside_its_interval_is_seen() {
        let dx = EffectKind::PointOffset.spec().parameters[0];
        let told = Estimate::of(dx, None, 0.002);
        assert!(told.holds_its_value() && told.within(0.01).holds_its_value());
        assert!(!Estimate { interval: Some([0.003, 0.004]), ..told }.holds_its_value());
    }
}
