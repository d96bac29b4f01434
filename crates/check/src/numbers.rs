//! Every number of a fixture file.

use crate::settings::numbers::{HIGH_DAMPING, PLACE_DEVIATION, SLOWEST_SUPPORT, VAGUE_DEVIATION};
use crate::{Remark, Totals, meaning};
use jointscope_fixture::{Dof, Fixture, NamedQuantity, QuantityKey, QuantityOwner, Spread};
use jointscope_spectra::in_sentence;
use serde::Serialize;
use std::f64::consts::TAU;

/// How a number's deviation is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Known {
    /// The file states it.
    Stated,
    /// A bare number: the default of its kind.
    Default,
    /// `"std": "unknown"`.
    Unknown,
    /// A bare parameter of an effect, or a stated deviation of zero.
    Exact,
}

/// A number of the file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Number {
    /// Its path, such as `bodies/A/mass`.
    pub path: String,
    /// SI.
    pub value: f64,
    /// Its unit; empty for a pure number.
    pub unit: &'static str,
    /// One standard deviation; `None` where it is unknown.
    pub std: Option<f64>,
    /// Where the deviation comes from.
    pub known: Known,
    /// What it means, in a few words.
    pub means: Option<String>,
}

/// Every number of the file in its order; what is odd about them is added to `remarks`.
pub(crate) fn of(fixture: &Fixture, remarks: &mut Vec<Remark>) -> Vec<Number> {
    let mass = Totals::of(fixture).mass.value;
    let exact = fixture.quantities_exact();
    let mut numbers: Vec<Number> = Vec::new();
    for (quantity, exact) in fixture.quantities().into_iter().zip(exact) {
        let known = match (quantity.std, exact.std) {
            (None, _) => Known::Unknown,
            (Some(0.0), _) => Known::Exact,
            (Some(_), Some(0.0)) => Known::Default,
            _ => Known::Stated,
        };
        odd(&quantity, known, mass, remarks);
        numbers.push(Number {
            means: meaning::of(fixture, &quantity, mass),
            path: quantity.path,
            value: quantity.value,
            unit: quantity.key.unit(),
            std: quantity.std,
            known,
        });
    }
    for (index, effect) in fixture.physics().iter().enumerate() {
        let parameters = effect.kind.spec().parameters.iter().zip(&effect.parameters).enumerate();
        for (at, (parameter, value)) in parameters {
            if effect.has_parameter(at) && value.spread == Spread::Default {
                numbers.push(Number {
                    path: format!("physics/{index}/{}", parameter.name),
                    value: value.value,
                    unit: parameter.unit_in(effect.dof),
                    std: Some(0.0),
                    known: Known::Exact,
                    means: None,
                });
            }
        }
    }
    numbers
}

fn odd(quantity: &NamedQuantity, known: Known, total_mass: f64, remarks: &mut Vec<Remark>) {
    if let QuantityKey::ModalRatio(_) = quantity.key
        && quantity.value > HIGH_DAMPING
    {
        remarks.push(Remark::odd(
            &quantity.path,
            format!(
                "a damping ratio of {} is {:.0} % of critical: 1 % is written 0.01",
                quantity.value,
                100.0 * quantity.value
            ),
        ));
    }
    if let (QuantityOwner::Point(_), Known::Unknown) = (quantity.owner, known) {
        remarks.push(Remark::odd(
            &quantity.path,
            "its place is unknown: measure it, and put it with its deviation, such as {\"value\": 0.031, \"std\": 0.0005}",
        ));
    }
    if let QuantityKey::SupportStiffness(Dof::Translation) = quantity.key
        && (0.0..total_mass * (TAU * SLOWEST_SUPPORT).powi(2)).contains(&quantity.value)
    {
        remarks.push(Remark::odd(
            &quantity.path,
            format!(
                "{} N/m hold {} kg at {} Hz, softer than any foam or cord: a stiffness is in N/m, 3 N/mm is written 3000; a support that holds nothing is left out",
                in_sentence(quantity.value),
                in_sentence(total_mass),
                in_sentence((quantity.value / total_mass).sqrt() / TAU)
            ),
        ));
    }
    let of_place = quantity.nature == jointscope_fixture::Nature::Abscissa;
    if let (Known::Stated, Some(std)) = (known, quantity.std)
        && !of_place
        && quantity.value != 0.0
        && std > VAGUE_DEVIATION * quantity.value.abs()
    {
        remarks.push(Remark::odd(
            &quantity.path,
            format!("its standard deviation is {:.0} % of it: a deviation is in the number's own unit; write \"unknown\" where nothing is known", 100.0 * std / quantity.value.abs()),
        ));
    }
    if of_place && known == Known::Stated && quantity.std.is_some_and(|std| std > PLACE_DEVIATION) {
        let std = quantity.std.unwrap_or_default();
        remarks.push(Remark::odd(
            &quantity.path,
            format!("a standard deviation of {:.0} mm: deviations of places are in metres, 0.2 mm is written 0.0002", 1e3 * std),
        ));
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_support_that_carries_next_to_nothing_is_odd_and_one_of_foam_is_not() {
        let odd = |stiffness: &str| {
            let fixture = Fixture::from_json(&format!(
                r#"{{ "bodies": {{ "A": {{ "mass": 1.5, "inertia": 1e-3, "x_cg": 0 }} }}, "points": {{ "1": {{ "body": "A", "x": 0.05 }} }},
                  "supports": {{ "left": {{ "point": "1", "stiffness": {stiffness} }} }} }}"#
            ));
            let mut remarks = Vec::new();
            of(&fixture.unwrap(), &mut remarks);
            remarks.iter().filter(|remark| remark.place == "supports/left/stiffness").count()
        };
        assert_eq!(["0.003", "3", "3000"].map(odd), [1, 0, 0]);
    }

    #[test]
    fn every_number_is_listed_with_where_its_deviation_comes_from() {
        let fixture = Fixture::from_json(
            r#"{ "bodies": { "A": { "mass": {"value": 1.2, "std": 0.9}, "inertia": 1e-3, "x_cg": {"value": 0, "std": "unknown"} } },
              "points": { "1": { "body": "A", "x": {"value": 0.05, "std": 0.2} } },
              "damping": { "modal_ratios": [0.3] },
              "physics": [{ "kind": "added_mass", "place": "A", "x": 0.01, "mass": {"value": 0.1, "std": 0.01} }] }"#,
        );
        let mut remarks = Vec::new();
        let numbers = of(&fixture.unwrap(), &mut remarks);
        let known: Vec<(&str, Known)> = numbers.iter().map(|n| (n.path.as_str(), n.known)).collect();
        assert_eq!(
            known,
            [
                ("bodies/A/mass", Known::Stated),
                ("bodies/A/inertia", Known::Default),
                ("bodies/A/x_cg", Known::Unknown),
                ("points/1/x", Known::Stated),
                ("damping/modal_ratios/0", Known::Default),
                ("physics/0/mass", Known::Stated),
                ("physics/0/x", Known::Exact),
            ]
        );
        let odd: Vec<&str> = remarks.iter().map(|remark| remark.place.as_str()).collect();
        assert_eq!(odd, ["bodies/A/mass", "points/1/x", "damping/modal_ratios/0"]);
        assert_eq!((numbers[1].unit, numbers[1].std), ("kg*m^2", Some(1e-5)));
    }
}
