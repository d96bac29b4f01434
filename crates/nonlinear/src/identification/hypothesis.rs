//! What a fit may move: quantities of the fixture within their tolerances, and the parameters of
//! amplitude-dependent effects.

use crate::RestoringLaw;
use crate::settings::fit::{LONGEST, LONGEST_OF_EFFECT};
use jointscope_fixture::{
    Effect, Fixture, FixtureError, NamedQuantity, Nature, Quantity, QuantityOwner, SupportPlace,
};
use jointscope_inference::{Parameter, Transform};
use jointscope_tolerances::{DEPARTED, Tolerance, moved};
use std::sync::Arc;

/// A fixture with quantities and effects to be fitted, at coordinates in units of which one is a typical
/// step.
#[derive(Debug, Clone)]
pub(crate) struct Hypothesis {
    fixture: Arc<Fixture>,
    /// The quantities that may move.
    pub quantities: Arc<[Tolerance]>,
    /// Amplitude-dependent effects beyond the fixture's, as they were added.
    effects: Vec<Effect>,
    /// Of the quantities, then of the effects.
    parameters: Vec<Parameter>,
    pub coordinates: Vec<f64>,
}

impl Hypothesis {
    /// The fixture as stated. Points that no joint, support or channel uses stay where they are.
    pub(crate) fn nominal(fixture: &Fixture, exact: bool, channels: &[String]) -> Self {
        let mut quantities = Tolerance::all(fixture, exact);
        quantities.retain(|tolerance| is_used(fixture, &tolerance.quantity, channels));
        Hypothesis {
            fixture: Arc::new(fixture.clone()),
            effects: Vec::new(),
            parameters: quantities.iter().map(|tolerance| tolerance.parameter).collect(),
            coordinates: vec![0.0; quantities.len()],
            quantities: quantities.into(),
        }
    }

    /// The same with one more effect, at the parameters it is given with.
    pub(crate) fn with(&self, effect: Effect) -> Self {
        let mut more = self.clone();
        for (transform, quantity) in transforms(&effect).into_iter().zip(&effect.parameters) {
            more.parameters.push(Parameter::new(transform));
            more.coordinates.extend(transform.coordinate(quantity.value));
        }
        more.effects.push(effect);
        more
    }

    /// The same quantities without any effect.
    pub(crate) fn without_effects(&self) -> Self {
        let mut less = self.clone();
        less.coordinates.truncate(less.quantities.len());
        less.parameters.truncate(less.quantities.len());
        less.effects.clear();
        less
    }

    /// The same without effect `index`; as it is where there is none.
    pub(crate) fn without(&self, index: usize) -> Self {
        let mut less = self.clone();
        if index < less.effects.len() {
            let own: Vec<usize> = self.parameters_of(index).map(|(_, place)| place).collect();
            let of_others = |place: &usize| !own.contains(place);
            let kept: Vec<usize> = (0..self.coordinates.len()).filter(of_others).collect();
            less.coordinates = kept.iter().map(|&place| self.coordinates[place]).collect();
            less.parameters = kept.iter().map(|&place| self.parameters[place]).collect();
            less.effects.remove(index);
        }
        less
    }

    /// The same without the effect that was added last.
    pub(crate) fn without_last(&self) -> Self {
        self.without(self.effects.len().saturating_sub(1))
    }

    /// The effects at the present coordinates.
    pub(crate) fn effects(&self) -> Vec<Effect> {
        let all = self.parameters.iter().zip(&self.coordinates).skip(self.quantities.len());
        let mut values = all.filter_map(|(parameter, at)| parameter.transform.value(*at));
        let at = |effect: &Effect| {
            let own: Vec<f64> = values.by_ref().take(effect.parameters.len()).collect();
            Effect::new(effect.kind, effect.place.clone(), effect.dof, &own)
        };
        self.effects.iter().map(at).collect()
    }

    /// The parameters of effect `index`: transform of each, and its coordinate's place.
    pub(crate) fn parameters_of(&self, index: usize) -> impl Iterator<Item = (Transform, usize)> {
        let before = self.effects[..index].iter().map(|e| e.parameters.len()).sum::<usize>();
        let first = self.quantities.len() + before;
        (first..first + self.effects[index].parameters.len())
            .map(|place| (self.parameters[place].transform, place))
    }

    pub(crate) fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// What departures from the stated values cost: Σ (departure/std)².
    pub(crate) fn squared_departures(&self) -> f64 {
        self.parameters.iter().zip(&self.coordinates).map(|(p, at)| p.squared_departure(*at)).sum()
    }

    /// Whether some quantity is farther from what is stated than chance takes it.
    pub(crate) fn has_departed(&self) -> bool {
        self.quantities.iter().zip(&self.coordinates).any(|(own, at)| has_departed(&own.quantity, *at))
    }

    /// Step of coordinate `index` for a difference quotient.
    pub(crate) fn difference(&self, index: usize) -> f64 {
        let Some(Tolerance { quantity, parameter, .. }) = self.quantities.get(index) else { return 1e-3 };
        let unit = parameter.transform.slope(quantity.value);
        match quantity.nature {
            Nature::Damping => 0.02,
            Nature::Abscissa => 2e-6 / unit,
            // A step of 2e-5 of a size is felt by no phase, and is far above rounding.
            _ => (2e-5 * quantity.value.abs() / unit).clamp(1e-6, 0.1),
        }
    }

    pub(crate) fn moved(&self, index: usize, step: f64) -> Self {
        let mut moved = self.clone();
        moved.coordinates[index] += step;
        moved
    }

    /// Moved by `step`, no coordinate farther than derivatives reach; damping stops at zero.
    pub(crate) fn stepped(&self, step: &[f64]) -> Self {
        let mut next = self.clone();
        for (i, (coordinate, step)) in next.coordinates.iter_mut().zip(step).enumerate() {
            let longest = if i < self.quantities.len() { LONGEST } else { LONGEST_OF_EFFECT };
            *coordinate = self.parameters[i].clamp(*coordinate + step.clamp(-longest, longest));
        }
        next
    }

    /// The fixture at these coordinates, the effects in its physics.
    pub(crate) fn to_fixture(&self) -> Result<Fixture, FixtureError> {
        let fixture = moved(&self.fixture, &self.quantities, &self.coordinates);
        let physics = [fixture.physics(), &self.effects()].concat();
        fixture.with_physics(physics)
    }
}

/// Whether so many deviations of a quantity, where one is stated, are more than chance makes.
pub(crate) fn has_departed(quantity: &NamedQuantity, deviations: f64) -> bool {
    quantity.std.is_some_and(|std| std > 0.0) && deviations.abs() > DEPARTED
}

/// How each parameter of an amplitude-dependent effect moves: by its logarithm, or in parts of where it
/// started.
fn transforms(effect: &Effect) -> Vec<Transform> {
    let positive = RestoringLaw::of(effect).is_none_or(|law| law.is_positive());
    let transform = |quantity: &Quantity| match positive {
        true => Transform::Logarithmic { centre: 1.0, scale: 1.0 },
        false => Transform::Linear { centre: 0.0, scale: quantity.value.abs().max(f64::MIN_POSITIVE) },
    };
    effect.parameters.iter().map(transform).collect()
}

/// Whether a quantity enters the model: of the points, those at which something is joined, held, struck or
/// read.
fn is_used(fixture: &Fixture, quantity: &NamedQuantity, channels: &[String]) -> bool {
    let QuantityOwner::Point(point) = quantity.owner else { return true };
    let held = |place: &SupportPlace| matches!(place, SupportPlace::Point(p) if *p == point);
    channels.contains(&fixture.points()[point].name)
        || fixture.joints().iter().any(|joint| joint.from == point || joint.to == point)
        || fixture.supports().iter().any(|support| held(&support.place))
}
