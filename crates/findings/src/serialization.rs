//! How effects and their parameters stand in `diagnosis.json`, for `serde(serialize_with)`.

use crate::Estimate;
use jointscope_fixture::{Dof, Effect};
use serde::{Serialize, Serializer};

/// An effect by `kind`, `place` and, for the kinds that have one, `dof`.
#[derive(Serialize)]
struct Name {
    kind: &'static str,
    place: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    dof: Option<Dof>,
}

impl Name {
    fn of(effect: &Effect) -> Self {
        Name { kind: effect.kind.name(), place: effect.place.to_string(), dof: effect.dof }
    }
}

/// Kind, place and degree of freedom.
///
/// # Errors
/// Those of `serializer`.
pub fn effect_name<S: Serializer>(effect: &Effect, serializer: S) -> Result<S::Ok, S::Error> {
    Name::of(effect).serialize(serializer)
}

/// A value of each of the models that a diagnosis compares: as stated, refitted within tolerances, repaired.
///
/// # Errors
/// Those of `serializer`.
pub fn by_model<T: Serialize, S: Serializer>(values: &[T; 3], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(["nominal", "refitted", "repaired"].into_iter().zip(values))
}

/// A value with its standard deviation.
///
/// # Errors
/// Those of `serializer`.
pub fn with_std<T: Serialize + Copy, S: Serializer>(
    &(value, std): &(f64, T),
    serializer: S,
) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct WithStd<T> {
        value: f64,
        std: T,
    }
    WithStd { value, std }.serialize(serializer)
}

/// Estimates by the names of their parameters.
///
/// # Errors
/// Those of `serializer`.
pub fn parameters<S: Serializer>(estimates: &[Estimate], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(estimates.iter().map(|estimate| (estimate.parameter.name, estimate)))
}

/// Other names for a finding, each with its probability.
///
/// # Errors
/// Those of `serializer`.
pub fn alternatives<S: Serializer>(others: &[(Effect, f64)], serializer: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Alternative {
        #[serde(flatten)]
        name: Name,
        probability: f64,
    }
    let all = others
        .iter()
        .map(|(effect, probability)| Alternative { name: Name::of(effect), probability: *probability });
    serializer.collect_seq(all)
}
