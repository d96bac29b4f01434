//! Names that are true of a structure although nobody asked for them.

use jointscope_fixture::{Dof, Effect, EffectKind};
use serde::{Deserialize, Serialize};

/// Effects that are true of a structure, by kind and as far as it matters by degree of freedom, place and
/// size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrueName {
    /// The kind's name.
    pub kind: String,
    /// Its degree of freedom; any where none is stated.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub dof: Option<String>,
    /// Its places; any where none is stated.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub place: Vec<String>,
    /// What its first parameter exceeds.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub above: Option<f64>,
    /// What its first parameter stays below.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub below: Option<f64>,
}

impl TrueName {
    /// A kind wherever it is and however large.
    pub(crate) fn of(kind: EffectKind) -> Self {
        TrueName { kind: kind.name().to_owned(), dof: None, place: Vec::new(), above: None, below: None }
    }

    /// In one degree of freedom only.
    pub(crate) fn in_dof(self, dof: Dof) -> Self {
        TrueName { dof: Some(dof.name().to_owned()), ..self }
    }

    /// At these places only.
    pub(crate) fn at(self, places: &[&str]) -> Self {
        TrueName { place: places.iter().map(|place| (*place).to_owned()).collect(), ..self }
    }

    /// With a first parameter above this only.
    pub(crate) fn above(self, value: f64) -> Self {
        TrueName { above: Some(value), ..self }
    }

    /// With a first parameter below this only.
    pub(crate) fn below(self, value: f64) -> Self {
        TrueName { below: Some(value), ..self }
    }

    /// Whether an effect bears this name.
    pub(crate) fn is_of(&self, effect: &Effect) -> bool {
        let place = effect.place.to_string();
        self.kind == effect.kind.name()
            && self.dof.as_deref().is_none_or(|dof| effect.dof.is_some_and(|own| own.name() == dof))
            && (self.place.is_empty() || self.place.contains(&place))
            && self.above.is_none_or(|above| effect.value(0) > above)
            && self.below.is_none_or(|below| effect.value(0) < below)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_fixture::Place;

    #[test]
    fn a_name_is_true_of_the_places_and_sizes_that_it_states() {
        let softer = TrueName::of(EffectKind::StiffnessChange).below(1.0);
        let change =
            |factor| Effect::new(EffectKind::StiffnessChange, Place::Joint("J".into()), None, &[factor]);
        assert!(softer.is_of(&change(0.9)) && !softer.is_of(&change(1.1)));
        let turning = TrueName::of(EffectKind::InterfaceCompliance).in_dof(Dof::Rotation).at(&["10"]);
        let spring = |point: &str, dof| {
            Effect::new(EffectKind::InterfaceCompliance, Place::Point(point.into()), Some(dof), &[1e4, 0.0])
        };
        assert!(turning.is_of(&spring("10", Dof::Rotation)));
        assert!(
            !turning.is_of(&spring("11", Dof::Rotation)) && !turning.is_of(&spring("10", Dof::Translation))
        );
    }
}
