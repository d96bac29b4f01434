//! A fixture with effects beside it, where every quantity and parameter stands, and how these may move.

use crate::parameter_transforms::{if_wrong, parameters_of};
use crate::settings::effects::quantities::EXPECTED_ERROR;
use jointscope_fixture::{
    Effect, EffectKind, Entry, Fixture, FixtureError, NamedQuantity, Place, QuantityKey, SizeLaw,
};
use jointscope_inference::{Covariance, Parameter, Transform};
use jointscope_tolerances::{Tolerance, moved};
use std::sync::Arc;

/// The fixture with quantities and effects to be fitted: coordinates in units of which one is a typical step.
#[derive(Debug, Clone)]
pub struct Hypothesis {
    // Thousands of neighbours share what none of them changes.
    fixture: Arc<Fixture>,
    tolerances: Arc<[Tolerance]>,
    /// Each effect with how its parameters move, those that stay included.
    effects: Arc<Vec<(Effect, Vec<Parameter>)>>,
    /// How the coordinates move: tolerances, then the effects' free parameters.
    parameters: Arc<[Parameter]>,
    /// Coordinates that stay where they are.
    held: Vec<usize>,
    /// Coordinates: tolerances in deviations from the nominal values, then the effects' free parameters.
    pub(crate) coordinates: Vec<f64>,
}

impl Hypothesis {
    /// The fixture by itself, its own effects kept as they stand but for parameters with a deviation. `exact`
    /// takes bare numbers as exact.
    ///
    /// Young's modulus and second moment of one beam enter as their product
    /// ([`Fixture::uncertain_quantities`]).
    pub fn nominal(fixture: &Fixture, exact: bool) -> Self {
        // A quantity that the fixture itself calls wrong has the value given for it.
        let called_wrong = |quantity: &NamedQuantity| {
            let of_it =
                |effect: &Effect| matches!(&effect.place, Place::Quantity(path, _) if *path == quantity.path);
            fixture.physics().iter().any(of_it)
        };
        let mut tolerances = Tolerance::all(fixture, exact);
        tolerances.retain(|tolerance| !called_wrong(&tolerance.quantity));
        Hypothesis {
            fixture: Arc::new(fixture.clone()),
            parameters: tolerances.iter().map(|tolerance| tolerance.parameter).collect(),
            coordinates: vec![0.0; tolerances.len()],
            tolerances: tolerances.into(),
            effects: Arc::new(Vec::new()),
            held: Vec::new(),
        }
    }

    /// The same with quantity `index` moved by `deviations`.
    pub(crate) fn moved(&self, index: usize, deviations: f64) -> Self {
        let mut other = self.clone();
        other.coordinates[index] += deviations;
        other
    }

    /// The same with one more effect, at the parameters it is given with, or as near to them as is possible
    /// at its place.
    pub fn with(&self, effect: Effect) -> Self {
        let mut more = self.clone();
        let wrong = match &effect.place {
            Place::Quantity(path, _) => self.tolerances.iter().find(|t| t.quantity.path == *path),
            _ => None,
        };
        let wrong =
            wrong.map_or(Parameter::new(Transform::Fixed), |tolerance| if_wrong(&self.fixture, tolerance));
        let sets_out = effect.parameters.first().and_then(|value| wrong.transform.coordinate(value.value));
        let expected = sets_out.map_or(EXPECTED_ERROR, |at| EXPECTED_ERROR.max(at.abs()));
        let parameters = parameters_of(&self.fixture, &effect, wrong.with_precision(expected.powi(-2)));
        for (parameter, quantity) in parameters.iter().zip(&effect.parameters) {
            let stated = parameter.transform.coordinate(quantity.value);
            more.coordinates.extend(stated.map(|at| parameter.clamp(at)));
        }
        Arc::make_mut(&mut more.effects).push((effect, parameters));
        more.listed()
    }

    /// The same without effect `index`.
    pub fn without(&self, index: usize) -> Self {
        let mut fewer = self.clone();
        let range = self.range_of(index);
        fewer.coordinates.drain(range);
        Arc::make_mut(&mut fewer.effects).remove(index);
        fewer.listed()
    }

    /// Whether it has effects whose losses modal ratios hold.
    fn has_losses(&self) -> bool {
        self.effects.iter().any(|(effect, _)| effect.kind.spec().within_modal_ratios)
    }

    /// The list of parameters follows from tolerances and effects.
    fn listed(mut self) -> Self {
        let lost = match self.has_losses() {
            true => self.effects().iter().map(ratio_of_losses).fold(0.0, f64::max),
            false => 0.0,
        };
        let tolerances = self.tolerances.iter().map(|tolerance| less_losses(tolerance, lost));
        let free = self.effects.iter().flat_map(|(_, all)| all).copied().filter(Parameter::is_free);
        self.parameters = tolerances.chain(free).collect();
        self
    }

    /// The same with the quantities of the fixture back at (or at those of) `other`; effects stay.
    pub fn with_tolerances_of(&self, other: &Hypothesis) -> Self {
        let mut moved = self.clone();
        let count = self.tolerances.len();
        moved.coordinates[..count].copy_from_slice(&other.coordinates[..count]);
        moved
    }

    /// The same with `effect` in the fixture itself, where nothing moves it; `None` where the fixture cannot
    /// have it.
    pub(crate) fn beside(&self, effect: Effect) -> Option<Self> {
        let mut physics = self.fixture.physics().to_vec();
        physics.push(effect);
        let fixture = Fixture::clone(&self.fixture).with_physics(physics).ok()?;
        Some(Hypothesis { fixture: Arc::new(fixture), ..self.clone() })
    }

    /// The same with its effects in the fixture itself, where nothing moves them; `None` where the fixture
    /// cannot have them.
    pub(crate) fn with_effects_in_place(&self) -> Option<Self> {
        let alone = (0..self.effect_count()).rev().fold(self.clone(), |rest, index| rest.without(index));
        self.effects().into_iter().try_fold(alone, |rest, effect| rest.beside(effect))
    }

    /// The same where `other`, of the same quantities and effects, stands.
    pub(crate) fn with_coordinates_of(&self, other: &Hypothesis) -> Self {
        Hypothesis { coordinates: other.coordinates.clone(), ..self.clone() }
    }

    /// The same with these coordinates (and no others) held where they are.
    pub(crate) fn holding(mut self, held: &[usize]) -> Self {
        self.held = held.to_vec();
        self
    }

    /// Where every coordinate stands: tolerances in deviations from the stated values, then the effects' free
    /// parameters.
    pub fn coordinates(&self) -> &[f64] {
        &self.coordinates
    }

    /// The same hypothesis of a fixture that describes the structure as it is here, with more in it:
    /// `fixture` with this one's effects beside its own, quantities of the same path where this hypothesis
    /// has them, and all others as they are stated. `exact` takes bare numbers as exact.
    pub fn in_fixture(&self, fixture: &Fixture, exact: bool) -> Self {
        self.carried_to(fixture, exact, |_| true)
    }

    /// The same hypothesis of another state of the structure, as `fixture` describes it: with a mass on it,
    /// off its supports. Modal damping ratios are those of an assembly as it was tested; in another state
    /// they are others, as they are stated of it.
    pub fn in_state(&self, fixture: &Fixture, exact: bool) -> Self {
        self.carried_to(fixture, exact, |tolerance| !tolerance.is_of_one_state())
    }

    fn carried_to(&self, fixture: &Fixture, exact: bool, stays: impl Fn(&Tolerance) -> bool) -> Self {
        let mut other = Hypothesis::nominal(fixture, exact);
        for (index, tolerance) in other.tolerances.iter().enumerate().filter(|(_, own)| stays(own)) {
            let same = |own: &Tolerance| own.quantity.path == tolerance.quantity.path;
            if let Some(own) = self.tolerances.iter().position(same) {
                other.coordinates[index] = match self.tolerances[own].parameter.transform {
                    transform if transform == tolerance.parameter.transform => self.coordinates[own],
                    _ => tolerance.coordinate(self.tolerances[own].value(self.coordinates[own])),
                };
            }
        }
        let moving = self.coordinates[self.tolerances.len()..].iter();
        other.effects = Arc::clone(&self.effects);
        other.coordinates.extend(moving);
        other.listed()
    }

    /// Whether a fit leaves coordinate `index` where it is.
    pub(crate) fn is_held(&self, index: usize) -> bool {
        self.held.contains(&index)
    }

    /// The fixture as it is stated.
    pub(crate) fn fixture(&self) -> &Fixture {
        &self.fixture
    }

    /// Number of effects.
    pub fn effect_count(&self) -> usize {
        self.effects.len()
    }

    /// Number of the effects' free parameters.
    pub fn effect_parameters(&self) -> usize {
        self.coordinates.len() - self.tolerances.len()
    }

    /// The quantities that may move.
    pub fn tolerances(&self) -> &[Tolerance] {
        &self.tolerances
    }

    /// Where tolerance `index` stands, in standard deviations (or tenths of its value where it is free): for
    /// masses and stiffnesses those of the logarithm. A modal ratio's deviation is the one that it has beside
    /// these effects.
    pub fn departure(&self, index: usize) -> f64 {
        let precision = self.prior(index);
        self.coordinates[index] * if precision > 0.0 { precision.sqrt() } else { 1.0 }
    }

    /// How each coordinate moves: tolerances first, then the effects' free parameters.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Precision of the prior on coordinate `index`: 1 for a quantity with a deviation, 0 for what is free.
    pub(crate) fn prior(&self, index: usize) -> f64 {
        self.parameters[index].precision
    }

    /// Σ (departure/std)².
    pub fn squared_departures(&self) -> f64 {
        self.parameters
            .iter()
            .zip(&self.coordinates)
            .map(|(parameter, at)| parameter.squared_departure(*at))
            .sum()
    }

    /// The same of the fixture's quantities alone: how far one that an effect calls wrong lies from what is
    /// stated says nothing against the others.
    pub(crate) fn squared_departures_of_quantities(&self) -> f64 {
        let stated = self.parameters.iter().zip(&self.coordinates).take(self.tolerances.len());
        stated.map(|(parameter, at)| parameter.squared_departure(*at)).sum()
    }

    /// Coordinates of effect `index` within the whole.
    pub fn range_of(&self, index: usize) -> std::ops::Range<usize> {
        let free = |(_, parameters): &(Effect, Vec<Parameter>)| {
            parameters.iter().filter(|parameter| parameter.is_free()).count()
        };
        let start = self.tolerances.len() + self.effects[..index].iter().map(free).sum::<usize>();
        start..start + free(&self.effects[index])
    }

    /// The effects at their present parameters.
    pub fn effects(&self) -> Vec<Effect> {
        let mut at = self.tolerances.len();
        self.effects
            .iter()
            .map(|(effect, parameters)| {
                let mut effect = effect.clone();
                for (parameter, quantity) in parameters.iter().zip(&mut effect.parameters) {
                    let coordinate = self.coordinates.get(at).copied().unwrap_or(0.0);
                    if let Some(value) = parameter.transform.value(coordinate) {
                        quantity.value = value;
                        at += 1;
                    }
                }
                effect
            })
            .collect()
    }

    /// How each parameter of effect `index` moves, those that stay included.
    pub(crate) fn effect_parameters_of(&self, index: usize) -> &[Parameter] {
        &self.effects[index].1
    }

    /// Standard deviations, as multiples of [`EXPECTED_ERROR`], that quantity of effect `index` is expected
    /// to be off by; `None` where the effect is about none.
    pub(crate) fn expected_error(&self, index: usize) -> Option<f64> {
        let (effect, parameters) = &self.effects[index];
        let is_about_one = effect.kind == EffectKind::QuantityError;
        let parameter = parameters.first().filter(|_| is_about_one)?;
        Some((parameter.precision.sqrt() * EXPECTED_ERROR).recip())
    }

    /// The coordinates that are at a bound.
    pub(crate) fn stopped(&self) -> Vec<usize> {
        let at_bound = |(at, parameter): (&f64, &Parameter)| *at <= parameter.low || *at >= parameter.high;
        let all = self.coordinates.iter().zip(self.parameters.iter()).enumerate();
        all.filter(|(_, pair)| at_bound(*pair)).map(|(index, _)| index).collect()
    }

    /// The coordinates of dashpots that go with the effects' springs.
    pub(crate) fn dashpots(&self) -> Vec<usize> {
        let of = |(index, (effect, parameters)): (usize, &(Effect, Vec<Parameter>))| {
            let dashpot = effect.kind.spec().size.dashpot.filter(|at| parameters[*at].is_free())?;
            let before = parameters[..dashpot].iter().filter(|parameter| parameter.is_free()).count();
            Some(self.range_of(index).start + before)
        };
        self.effects.iter().enumerate().filter_map(of).collect()
    }

    /// How many standard deviations the size of effect `index`, or that of its dashpot, is from nothing.
    pub(crate) fn deviations_of(&self, index: usize, covariance: &Covariance) -> f64 {
        let (effect, parameters) = &self.effects[index];
        let size = &effect.kind.spec().size;
        let mut at = self.range_of(index).start;
        let mut most = 0.0_f64;
        for (place, parameter) in parameters.iter().enumerate() {
            if !parameter.is_free() {
                continue;
            }
            let (coordinate, std) = (self.coordinates[at], covariance.std(at));
            at += 1;
            let none = match size.law {
                SizeLaw::FromOne if place == size.parameter => 1.0,
                SizeLaw::FromStated => parameter.transform.value(0.0).unwrap_or(0.0),
                _ => 0.0,
            };
            let is_size = place == size.parameter || Some(place) == size.dashpot;
            let deviations = match parameter.transform {
                _ if !is_size => continue,
                // The size is the parameter, or a power of it: its relative deviation is that of the
                // logarithm, or a multiple.
                Transform::Logarithmic { scale, .. } if none == 0.0 => (std * scale).recip(),
                transform => {
                    let nothing = transform.coordinate(none).unwrap_or(0.0);
                    ((coordinate - nothing) / std).abs()
                }
            };
            most = most.max(deviations);
        }
        most
    }

    /// The fixture at the present quantities, its own effects and the fitted ones in its `physics`.
    ///
    /// # Errors
    /// Quantities or parameters that are impossible.
    pub fn to_fixture(&self) -> Result<Fixture, FixtureError> {
        self.to_fixture_with(self.effects())
    }

    /// The same with other effects in the stead of its own.
    pub(crate) fn to_fixture_with(&self, effects: Vec<Effect>) -> Result<Fixture, FixtureError> {
        let fixture = moved(&self.fixture, &self.tolerances, &self.coordinates);
        let mut physics = fixture.physics().to_vec();
        physics.extend(effects);
        fixture.with_moved_physics(physics)
    }

    /// Its effects without their dashpots, which leaves springs, masses and what no mode depends on; `None`
    /// where one dissipates by itself.
    pub(crate) fn without_dashpots(&self) -> Option<Vec<Effect>> {
        let mut effects = self.effects();
        for effect in &mut effects {
            match effect.kind.spec().size.dashpot {
                Some(dashpot) => effect.parameters[dashpot].value = 0.0,
                None if is_spring_or_mass(effect.kind) || !changes_modes(effect.kind) => {}
                None => return None,
            }
        }
        Some(effects)
    }

    /// Whether channels' signals are told by gains and delays alone, and no filter turns their phases.
    pub(crate) fn filters_nothing(&self) -> bool {
        use EffectKind::{ChannelDelay, ChannelGain};
        let passes = |effect: &Effect| {
            effect.kind.spec().entry != Entry::Signal || matches!(effect.kind, ChannelDelay | ChannelGain)
        };
        self.effects.iter().all(|(effect, _)| passes(effect)) && self.fixture.physics().iter().all(passes)
    }

    /// Whether its effects, springs and masses all, make other modes than the fixture's own.
    pub(crate) fn has_other_modes(&self) -> bool {
        self.without_dashpots().is_some_and(|effects| effects.iter().any(|effect| changes_modes(effect.kind)))
    }

    /// Root mean square of the relative deviations to which the fixture states the damping of its modes; zero
    /// where they do not move.
    pub(crate) fn deviation_of_damping(&self) -> f64 {
        use QuantityKey::{LossFactor, ModalRatio, RayleighMass, RayleighStiffness};
        let relative = |tolerance: &Tolerance| match tolerance.quantity {
            NamedQuantity {
                key: ModalRatio(_) | RayleighMass | RayleighStiffness | LossFactor,
                value,
                std,
                ..
            } => Some(std? / value),
            _ => None,
        };
        let all: Vec<f64> = self.tolerances.iter().filter_map(relative).filter(|d| d.is_finite()).collect();
        (all.iter().map(|d| d * d).sum::<f64>() / all.len().max(1) as f64).sqrt()
    }

    /// A step of size `size` of coordinate `index` that stays within its bounds.
    pub(crate) fn inward(&self, index: usize, size: f64) -> f64 {
        if self.coordinates[index] + size > self.parameters[index].high { -size } else { size }
    }

    /// Moves by `step`, bounded parameters stopping at their bounds.
    pub fn stepped(&self, step: &[f64]) -> Self {
        let mut next = self.clone();
        for ((coordinate, step), parameter) in
            next.coordinates.iter_mut().zip(step).zip(self.parameters.iter())
        {
            *coordinate = parameter.clamp(*coordinate + step);
        }
        if next.has_losses() { next.listed() } else { next }
    }
}

/// The most that a loss factor may add to a modal ratio: half of it, where all strain is in that joint.
fn ratio_of_losses(effect: &Effect) -> f64 {
    if effect.kind.spec().within_modal_ratios { 0.5 * effect.value(0) } else { 0.0 }
}

/// How a quantity moves beside losses that modal ratios hold: of a stated ratio the viscous part may be less
/// by them, down to none.
fn less_losses(tolerance: &Tolerance, lost: f64) -> Parameter {
    let parameter = tolerance.parameter;
    match (tolerance.quantity.key, parameter.transform) {
        (QuantityKey::ModalRatio(_), Transform::Linear { centre, scale }) if parameter.precision > 0.0 => {
            parameter.with_precision((1.0 + (lost.min(centre) / scale).powi(2)).recip())
        }
        _ => parameter,
    }
}

/// Whether an effect has stiffness or mass and dissipates nothing.
fn is_spring_or_mass(kind: EffectKind) -> bool {
    use EffectKind::{AddedMass, JointLength, JointMass, ShearDeformation, StiffnessChange};
    matches!(kind, AddedMass | JointLength | JointMass | ShearDeformation | StiffnessChange)
}

/// Whether an effect is one of the structure, and not of the measuring chain or of what the fixture says
/// where.
fn changes_modes(kind: EffectKind) -> bool {
    !matches!(kind.spec().entry, Entry::Signal | Entry::Restated | Entry::Offset)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mass_of_a_body_that_is_called_damping_plate_is_a_mass() {
        let named = |name: &str| {
            let text = format!(
                r#"{{ "bodies": {{ "{name}": {{ "mass": 2.0, "rotates": false }}, "B": {{ "mass": 3.0, "rotates": false }} }},
                  "points": {{ "1": {{ "body": "{name}", "x": 0.0 }}, "2": {{ "body": "B", "x": 0.0 }} }},
                  "joints": {{ "damping": {{ "from": "1", "to": "2", "stiffness": [[{{"value": 1e6, "std": 3e5}}, 0.0], [0.0, 0.0]] }} }} }}"#
            );
            let hypothesis = Hypothesis::nominal(&Fixture::from_json(&text).unwrap(), false);
            let moves = |t: &Tolerance| (t.parameter, t.is_wide(0.1));
            hypothesis.tolerances().iter().map(moves).collect::<Vec<_>>()
        };
        assert_eq!(named("damping-plate"), named("plate"));
        assert!(matches!(named("damping-plate")[0].0.transform, Transform::Logarithmic { .. }));
        let stiffness = named("damping-plate").into_iter().find(|(_, wide)| *wide);
        assert!(stiffness.is_some_and(|(parameter, _)| parameter.low == f64::NEG_INFINITY));
    }
}
