//! How the uncertain quantities of a fixture move in a fit: one rule for every fit that refits a fixture
//! within its tolerances.
//!
//! A coordinate is a number of standard deviations from the stated value, or of tenths of it where nothing is
//! known of it; its prior is a standard normal distribution, or none.
//!
//! ```
//! let fixture = jointscope_fixture::Fixture::from_json(
//!     r#"{ "bodies": { "A": { "mass": { "value": 2.0, "std": 0.02 }, "rotates": false } }, "points": {} }"#,
//! )?;
//! let tolerances = jointscope_tolerances::Tolerance::all(&fixture, true);
//! let heavier = jointscope_tolerances::moved(&fixture, &tolerances, &[3.0]);
//! assert!((heavier.quantities()[0].value - 2.0 * 0.03_f64.exp()).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use jointscope_fixture::{Fixture, Motion, NamedQuantity, Nature, ParameterSpec, QuantityKey};
use jointscope_inference::{Parameter, Transform};

/// A quantity of the fixture that a fit may move.
#[derive(Debug, Clone, PartialEq)]
pub struct Tolerance {
    /// Position among the fixture's quantities.
    pub index: usize,
    /// The quantity as stated; of a beam, Young's modulus stands for its product with the second moment.
    pub quantity: NamedQuantity,
    /// Coordinate: deviations from the stated value, or tenths of it where it is free.
    pub parameter: Parameter,
}

impl Tolerance {
    /// Those of a fixture ([`Fixture::uncertain_quantities`]); `exact` takes bare numbers as exact.
    pub fn all(fixture: &Fixture, exact: bool) -> Vec<Self> {
        let all = fixture.uncertain_quantities(exact).into_iter();
        all.map(|(index, quantity)| Tolerance { index, parameter: parameter_of(&quantity), quantity })
            .collect()
    }

    /// The value at `coordinate` deviations from the stated one.
    pub fn value(&self, coordinate: f64) -> f64 {
        self.parameter.transform.value(coordinate).unwrap_or(self.quantity.value)
    }

    /// Deviations from the stated value at which it is `value`; none where no coordinate reaches it.
    pub fn coordinate(&self, value: f64) -> f64 {
        self.parameter.transform.coordinate(value).unwrap_or(0.0)
    }

    /// Whether another state of the structure (with a mass on it, off its supports) has another one: modal
    /// damping ratios are those of the assembly as it was tested.
    pub fn is_of_one_state(&self) -> bool {
        matches!(self.quantity.key, QuantityKey::ModalRatio(_))
    }

    /// Whether it is known to no better than the share `wide`; damping and where something is attached apart.
    pub fn is_wide(&self, wide: f64) -> bool {
        let NamedQuantity { key, nature, value, std, .. } = self.quantity;
        let deviation = std.map_or(0.5, |std| std / value.abs().max(f64::MIN_POSITIVE));
        let place = matches!(key, QuantityKey::Abscissa | QuantityKey::PointMassAbscissa(_));
        deviation >= wide && value != 0.0 && nature != Nature::Damping && !place
    }
}

/// The fixture with its uncertain quantities at these coordinates.
pub fn moved(fixture: &Fixture, tolerances: &[Tolerance], coordinates: &[f64]) -> Fixture {
    let mut moved = fixture.clone();
    let value = |(own, at): (&Tolerance, &f64)| (own.index, own.value(*at));
    moved.set_quantities(tolerances.iter().zip(coordinates).map(value));
    moved
}

/// Whether a quantity ended so many standard deviations from what is stated that more than one in twenty such
/// are no chance.
pub fn is_far(deviations: f64) -> bool {
    deviations.abs() > FAR
}

/// Standard deviations beyond which a quantity has departed by more than chance makes: once in sixteen
/// thousand.
pub const DEPARTED: f64 = 4.0;

/// Standard deviations beyond which a quantity is far: one in twenty is by chance.
const FAR: f64 = 2.0;

/// Relative deviation up to which a positive quantity moves by its logarithm. One that is stated to a wider
/// deviation has the normal distribution that is stated: a logarithm of that width would make multiples of
/// the value as probable as small parts of it.
const NARROW: f64 = 0.12;

/// What is known of a quantity that is a parameter of an effect.
fn parameter_spec(key: QuantityKey) -> Option<&'static ParameterSpec> {
    match key {
        QuantityKey::Parameter { kind, index, .. } => kind.spec().parameters.get(index),
        _ => None,
    }
}

fn parameter_of(quantity: &NamedQuantity) -> Parameter {
    let nominal = quantity.value;
    let effects = parameter_spec(quantity.key);
    let free = || match effects.map(|spec| spec.motion) {
        Some(Motion::Signed(scale) | Motion::NonNegative(scale)) => scale.of(nominal),
        _ if nominal != 0.0 => 0.1 * nominal.abs(),
        _ => 1.0,
    };
    let scale = quantity.std.unwrap_or_else(free);
    // Masses and stiffnesses trade against factors of each other: by their logarithms such a trade is a
    // straight line.
    let relative = !matches!(quantity.nature, Nature::Abscissa | Nature::Damping)
        && nominal > 0.0
        && scale <= NARROW * nominal;
    let transform = match relative {
        true => Transform::Logarithmic { centre: nominal, scale: scale / nominal },
        false => Transform::Linear { centre: nominal, scale },
    };
    let known = f64::from(u8::from(quantity.std.is_some()));
    let parameter = Parameter::new(transform).with_precision(known);
    // A dashpot stops at zero.
    let stops = match effects {
        Some(spec) => !spec.range.contains(-1.0),
        None => quantity.nature == Nature::Damping && nominal > 0.0,
    };
    if stops { parameter.between(-nominal / scale, f64::INFINITY) } else { parameter }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn tolerances(joint: &str, physics: &str) -> Vec<Tolerance> {
        let text = format!(
            r#"{{ "bodies": {{ "A": {{ "mass": {{"value": 2.0, "std": 0}}, "rotates": false }}, "B": {{ "mass": {{"value": 3.0, "std": 0}}, "rotates": false }} }},
              "points": {{ "1": {{ "body": "A", "x": {{"value": 0, "std": 0}} }}, "2": {{ "body": "B", "x": {{"value": 0.1, "std": 1e-4}} }} }},
              "joints": {{ "J": {{ "from": "1", "to": "2", {joint} }} }}, "physics": [{physics}] }}"#
        );
        Tolerance::all(&Fixture::from_json(&text).unwrap(), true)
    }

    fn of(joint: &str, path: &str) -> Tolerance {
        let all = tolerances(joint, "");
        all.iter().find(|t| t.quantity.path.starts_with(path)).cloned().unwrap_or_else(|| panic!("{all:?}"))
    }

    #[test]
    fn a_well_known_stiffness_moves_by_its_logarithm_and_one_of_a_wide_deviation_as_stated() {
        let stiffness = |std: &str| {
            let joint = format!(
                r#""stiffness": [[{{"value": 1e6, "std": {std}}}, 0], [0, {{"value": 1e3, "std": 0}}]]"#
            );
            of(&joint, "joints/J/stiffness/0/0")
        };
        assert!((stiffness("1e5").value(1.0) / 1e6 - 0.1_f64.exp()).abs() < 1e-12);
        assert_eq!(stiffness("5e5").value(-1.0), 5e5);
        // What is free moves in tenths of its value, by its logarithm, and knows no prior.
        let free = stiffness(r#""unknown""#);
        assert_eq!(free.parameter.precision, 0.0);
        assert!((free.value(-30.0) / 1e6 - (-3.0_f64).exp()).abs() < 1e-12);
    }

    #[test]
    fn a_place_moves_as_it_is_and_a_dashpot_stops_at_zero() {
        let joint = r#""stiffness": [[{"value": 1e6, "std": 0}, 0], [0, {"value": 1e3, "std": 0}]],
                       "damping": [[{"value": 40, "std": 20}, 0], [0, 0]]"#;
        assert_eq!(of(joint, "points/2/x").value(2.0), 0.1 + 2e-4);
        let dashpot = of(joint, "joints/J/damping/0/0");
        assert_eq!(dashpot.value(dashpot.parameter.clamp(-9.0)), 0.0);
    }

    #[test]
    fn a_parameter_of_an_effect_stops_where_the_effect_is_impossible() {
        let joint = r#""stiffness": [[{"value": 1e6, "std": 0}, 0], [0, {"value": 1e3, "std": 0}]]"#;
        let loss = r#"{ "kind": "loss_factor", "place": "J", "loss_factor": {"value": 0.02, "std": 0.01} }"#;
        let all = tolerances(joint, loss);
        let loss =
            all.iter().find(|t| t.quantity.path.contains("physics")).unwrap_or_else(|| panic!("{all:?}"));
        assert_eq!(loss.value(loss.parameter.clamp(-9.0)), 0.0);
    }
}
