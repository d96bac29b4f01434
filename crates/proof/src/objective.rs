//! What every fit minimises: χ² of the FRFs and the squared departures of the fixture's quantities.

use jointscope_diagnosis::Observation;
use jointscope_fixture::{Fixture, QuantityKey};
use jointscope_spectra::FrfSet;
use num_complex::Complex64;

/// Standard deviations beyond which a quantity's departure is worth telling.
pub(crate) const FAR_BEYOND_TOLERANCE: f64 = 4.0;

/// A quantity of the believed fixture that may depart from its statement; Young's modulus and second moment
/// of a beam count as their product.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tolerance {
    /// Position among the fixture's quantities.
    pub index: usize,
    /// Position of the second moment that multiplies it.
    pub with: Option<usize>,
    /// The stated value, of the product where there is one.
    nominal: f64,
    /// Its standard deviation; `None` where it is unknown.
    std: Option<f64>,
}

impl Tolerance {
    /// The quantities of a fixture that are not exact.
    pub(crate) fn all(believed: &Fixture) -> Vec<Tolerance> {
        let quantities = believed.quantities();
        let mut all: Vec<Tolerance> = Vec::new();
        for (index, quantity) in quantities.iter().enumerate() {
            if quantity.std.is_some_and(|std| std <= 0.0) {
                continue;
            }
            let is_modulus = |t: &&mut Tolerance| {
                let first = &quantities[t.index];
                first.key == QuantityKey::YoungsModulus && first.owner == quantity.owner
            };
            let first = all.iter_mut().find(is_modulus);
            if let (QuantityKey::SecondMoment, Some(first)) = (quantity.key, first) {
                let relative =
                    first.std.zip(quantity.std).map(|(a, b)| (a / first.nominal).hypot(b / quantity.value));
                first.nominal *= quantity.value;
                first.std = relative.map(|r| (r * first.nominal).abs());
                first.with = Some(index);
                continue;
            }
            all.push(Tolerance { index, with: None, nominal: quantity.value, std: quantity.std });
        }
        all
    }

    /// Departure of the quantity in standard deviations, zero where that is unknown; `values` are those of
    /// all quantities.
    pub(crate) fn departure(&self, values: &[f64]) -> f64 {
        self.std.map_or(0.0, |std| (self.value(values) - self.nominal) / std)
    }

    /// Its value, of the product where there is one.
    pub(crate) fn value(&self, values: &[f64]) -> f64 {
        values[self.index] * self.with.map_or(1.0, |other| values[other])
    }

    /// Change of the first value that is one standard deviation, a tenth of it where that is unknown.
    pub(crate) fn step(&self, values: &[f64]) -> f64 {
        let scale = self.with.map_or(1.0, |other| values[other]);
        self.std.map_or(0.1 * values[self.index].abs().max(1e-9), |std| std / scale)
    }

    /// Whether a departure costs anything.
    pub(crate) fn is_known(&self) -> bool {
        self.std.is_some()
    }
}

/// The values of all quantities of a fixture.
pub(crate) fn values(fixture: &Fixture) -> Vec<f64> {
    fixture.quantities().iter().map(|quantity| quantity.value).collect()
}

/// χ² of `predicted` and the squared departures of `values`.
pub(crate) fn objective(
    observation: &Observation,
    predicted: &[Complex64],
    tolerances: &[Tolerance],
    values: &[f64],
) -> f64 {
    observation.chi2(predicted) + tolerances.iter().map(|t| t.departure(values).powi(2)).sum::<f64>()
}

/// √(Σ|a − b|²/Σ|b|²).
pub(crate) fn relative_error(a: &FrfSet, b: &FrfSet) -> f64 {
    let error: f64 = a.all_values().iter().zip(b.all_values()).map(|(a, b)| (a - b).norm_sqr()).sum();
    let size: f64 = b.all_values().iter().map(|b| b.norm_sqr()).sum();
    (error / size).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_beams_modulus_and_second_moment_depart_as_their_product() {
        let fixture = Fixture::from_json(
            r#"{
              "bodies": { "A": { "mass": 2.0, "inertia": 1e-3, "x_cg": 0.0 }, "B": { "mass": 3.0, "inertia": 1e-3, "x_cg": 0.1 } },
              "points": { "1": { "body": "A", "x": 0.02 }, "2": { "body": "B", "x": 0.08 } },
              "joints": { "J": { "from": "1", "to": "2", "beam": {
                "youngs_modulus": { "value": 2e11, "std": 6e8 }, "second_moment": { "value": 1e-10, "std": 4e-13 } } } }
            }"#,
        )
        .unwrap();
        let tolerances = Tolerance::all(&fixture);
        // Two masses, inertias, centres and points, and one product.
        assert_eq!(tolerances.len(), 9);
        let product = tolerances.iter().find(|t| t.with.is_some()).unwrap();
        let mut moved = values(&fixture);
        moved[product.index] *= 1.01;
        // 0.3 % and 0.4 % are 0.5 % together, of which 1 % is two.
        assert!((product.departure(&moved) - 2.0).abs() < 1e-9);
        moved.swap_with_slice(&mut values(&fixture));
        moved[product.with.unwrap()] *= 1.01;
        assert!((product.departure(&moved) - 2.0).abs() < 1e-9);
        let step = product.step(&moved);
        moved[product.index] += step;
        assert!((product.departure(&moved) - 3.0).abs() < 1e-9);
    }
}
