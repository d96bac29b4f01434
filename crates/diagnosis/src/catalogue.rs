//! Every effect at every legal place of a fixture, with starts from which a fit may set out.

use crate::bodies::{extent, inertia_of, radius_of_gyration, turns};
use crate::candidate::{Candidate, candidate};
use crate::departures::departed;
use crate::settings::effects::quantities::{CHANGES_OF_SUPPORTS, DEPARTURES};
use crate::settings::effects::starts::{
    FEWEST_HALF_WAVES, LEAST_LENGTH, LOWEST_FREQUENCY, MOST_HALF_WAVES, PLACES_A_HALF_WAVE,
};
use crate::together::inverts;
use crate::{Hypothesis, Observation, Tolerance};
use jointscope_fixture::{
    BodyKind, Dof, Effect, EffectKind, EffectSpec, Entry, Fixture, Joint, JointLaw, Measure, NamedQuantity,
    Place, PlaceKind, QuantityKey, QuantityOwner, Starts,
};
use jointscope_lumped::nominal_stiffness;
use std::f64::consts::TAU;

/// All linear effects that make sense at the fixture's places and the recording's channels.
pub fn catalogue(fixture: &Fixture, observation: &Observation) -> Vec<Candidate> {
    let mut catalogue = Catalogue { fixture, observation, all: Vec::new() };
    catalogue.list_structure();
    catalogue.list_measuring_chain();
    catalogue.all
}

/// The kinds of which something holds.
fn kinds(of: fn(&EffectSpec) -> bool) -> impl Iterator<Item = EffectKind> {
    EffectKind::ALL.into_iter().filter(move |kind| of(kind.spec()))
}

/// Candidates as they are listed.
struct Catalogue<'a> {
    fixture: &'a Fixture,
    observation: &'a Observation,
    all: Vec<Candidate>,
}

impl Catalogue<'_> {
    /// Lists a kind at a place, in every degree of freedom that it can have there, where it has starts and is
    /// possible.
    fn add(&mut self, kind: EffectKind, place: Place, joint: Option<&Joint>) {
        if is_stated(self.fixture, kind, &place) {
            return;
        }
        let body = body_at(self.fixture, &place);
        // What holds a whole body against rotation: of a beam there is no such thing.
        let whole = body.is_some_and(|body| matches!(self.fixture.bodies()[body].kind, BodyKind::Rigid(_)));
        let dofs: &[Option<Dof>] = match (kind.spec().has_dof, kind.spec().may_turn && whole) {
            (true, _) => &[Some(Dof::Translation), Some(Dof::Rotation)],
            (false, true) => &[None, Some(Dof::Rotation)],
            (false, false) => &[None],
        };
        for &dof in dofs {
            let second = match &place {
                Place::Between(_, other) => body_at(self.fixture, &Place::Body(other.clone())),
                _ => None,
            };
            let surroundings = Surroundings {
                fixture: self.fixture,
                observation: self.observation,
                body,
                second,
                joint,
                dof,
            };
            let starts = surroundings.starts(kind);
            let possible = |values| {
                let effect = Effect::new(kind, place.clone(), dof, values);
                self.fixture.clone().with_physics(vec![effect]).is_ok()
            };
            if starts.first().is_some_and(|values| possible(values)) {
                self.all.push(candidate(kind, place.clone(), dof, starts));
            }
        }
    }

    /// What bodies, joints and pairs of bodies can have.
    fn list_structure(&mut self) {
        use PlaceKind::{Beam, Body, JointOrBeamBody, Point};
        for body in self.fixture.bodies() {
            for kind in kinds(|spec| matches!(spec.place, Body | JointOrBeamBody | Beam)) {
                self.add(kind, Place::Body(body.name.clone()), None);
            }
        }
        for joint in self.fixture.joints() {
            let of_joints = |spec: &EffectSpec| {
                matches!(spec.place, PlaceKind::Joint | JointOrBeamBody | Beam)
                    || spec.entry == Entry::InSeries
            };
            for kind in kinds(of_joints) {
                if kind.spec().place != Point {
                    self.add(kind, Place::Joint(joint.name.clone()), Some(joint));
                    continue;
                }
                for point in [joint.from, joint.to] {
                    self.add(kind, Place::Point(self.fixture.points()[point].name.clone()), Some(joint));
                }
            }
        }
        for (index, one) in self.fixture.bodies().iter().enumerate() {
            for other in &self.fixture.bodies()[index + 1..] {
                kinds(|spec| spec.place == PlaceKind::TwoBodies).for_each(|kind| {
                    self.add(kind, Place::Between(one.name.clone(), other.name.clone()), None)
                });
            }
        }
    }

    /// What channels, records and the test as a whole can have.
    fn list_measuring_chain(&mut self) {
        use PlaceKind::{All, Channel, ResponseChannel};
        let pairs = self.observation.pairs();
        let responses = sorted(pairs.iter().map(|pair| pair.response.to_string()));
        let references = sorted(pairs.iter().map(|pair| pair.reference.to_string()));
        // With one reference only, its gain is that of all responses together: still a name of its own. With
        // several, one hammer struck them all.
        let force = (references.len() > 1).then_some(Place::Force);
        let channels = responses.iter().cloned().map(Place::Response);
        for channel in channels.chain(references.into_iter().map(Place::Reference)).chain(force) {
            kinds(|spec| spec.place == Channel).for_each(|kind| self.add(kind, channel.clone(), None));
        }
        // A filter of all responses alike, the one sensor's or the analyser's; a gain or a delay of all of
        // them is one of the force.
        if responses.len() > 1 {
            let filters = kinds(|spec| spec.place == Channel).filter(|kind| !inverts(*kind));
            filters.for_each(|kind| self.add(kind, Place::Responses, None));
        }
        // Records that are taken one by one may each have a gain of its own, where the fixture says so.
        for effect in self.fixture.channels() {
            if matches!(effect.place, Place::Record(_)) {
                self.add(effect.kind, effect.place.clone(), None);
            }
        }
        let points =
            pairs.iter().flat_map(|pair| [pair.response.point.clone(), pair.reference.point.clone()]);
        for point in sorted(points) {
            // Where a point is both struck and read, its sensor or its impacts may be off by themselves: no
            // hammer strikes a sensor.
            let at = |channel: &jointscope_spectra::Channel| {
                channel.point == point && channel.dof == Dof::Translation
            };
            let is_driven =
                pairs.iter().any(|pair| at(&pair.response)) && pairs.iter().any(|pair| at(&pair.reference));
            let own = [Place::Response(point.clone()), Place::Reference(point.clone())];
            let own = own.into_iter().filter(|_| is_driven);
            for place in std::iter::once(Place::Point(point.clone())).chain(own) {
                kinds(|spec| spec.entry == Entry::Offset)
                    .for_each(|kind| self.add(kind, place.clone(), None));
            }
        }
        // The one sensor that was moved from response to response.
        let all = (responses.len() > 1).then_some(Place::Responses);
        for place in responses.into_iter().map(Place::Response).chain(all) {
            kinds(|spec| spec.place == ResponseChannel).for_each(|kind| self.add(kind, place.clone(), None));
        }
        kinds(|spec| spec.place == All).for_each(|kind| self.add(kind, Place::All, None));
    }
}

/// Whether a fixture states what the name says that it leaves out: a strip's mass, that it shears, or that
/// both its ends turn on what they are fixed to. What is wrong there is the quantity.
fn is_stated(fixture: &Fixture, kind: EffectKind, place: &Place) -> bool {
    let states = |kind: EffectKind, place: &Place, dof: Option<Dof>| {
        fixture.physics().iter().any(|own| own.kind == kind && own.place == *place && own.dof == dof)
    };
    let turns = |end: usize| {
        let point = Place::Point(fixture.points()[end].name.clone());
        states(EffectKind::InterfaceCompliance, &point, Some(Dof::Rotation))
    };
    match (kind, place) {
        (EffectKind::JointMass | EffectKind::ShearDeformation, _) => states(kind, place, None),
        (EffectKind::Footing, Place::Joint(name)) => {
            let joint = fixture.joints().iter().find(|joint| joint.name == *name);
            states(kind, place, None) || joint.is_some_and(|joint| turns(joint.from) && turns(joint.to))
        }
        _ => false,
    }
}

/// Whether an effect of another kind says the very same of a quantity: a modulus is a factor of stiffness, a
/// support's stiffer spring another support, a point that holds nothing an offset.
pub(crate) fn has_a_name(fixture: &Fixture, quantity: &NamedQuantity, departure: f64) -> bool {
    match (quantity.owner, quantity.key) {
        (QuantityOwner::Joint(joint), QuantityKey::JointStiffness(..)) => {
            match &fixture.joints()[joint].law {
                // The only element of a matrix is all of it.
                JointLaw::Stiffness { stiffness, .. } => {
                    stiffness.iter().filter(|k| k.value != 0.0).count() == 1
                }
                JointLaw::Beam { .. } => false,
            }
        }
        // A spring beside it makes it stiffer, none softer.
        (_, QuantityKey::SupportStiffness(_)) => departure > 0.0,
        (_, QuantityKey::YoungsModulus | QuantityKey::SecondMoment | QuantityKey::Parameter { .. }) => true,
        (QuantityOwner::Point(point), _) => fixture.held_points().all(|held| held != point),
        _ => false,
    }
}

/// The candidates and, of the quantities that a refit took beyond what chance makes, the `count` farthest:
/// each may be wrong as it is stated. No effect says the same of them.
pub(crate) fn with_wrong_quantities(
    candidates: &[Candidate],
    refitted: &Hypothesis,
    count: usize,
) -> Vec<Candidate> {
    let is_named = |index: usize| {
        has_a_name(refitted.fixture(), &refitted.tolerances()[index].quantity, refitted.departure(index))
    };
    with_departed(candidates, refitted, count, |index| !is_named(index))
}

/// The same with those that an effect says the same of, but for damping: a modal ratio is one of the structure
/// with that quantity as it is, and one of the structure without that effect.
pub(crate) fn with_all_wrong_quantities(
    candidates: &[Candidate],
    refitted: &Hypothesis,
    count: usize,
) -> Vec<Candidate> {
    with_departed(candidates, refitted, count, |_| true)
}

/// The same with the stiffness of every support that may have changed since a fixture was calibrated: of one
/// that has become softer no spring beside it tells.
pub(crate) fn with_changed_supports(candidates: &[Candidate], calibrated: &Hypothesis) -> Vec<Candidate> {
    let tolerances = calibrated.tolerances();
    let is_support =
        |index: &usize| matches!(tolerances[*index].quantity.key, QuantityKey::SupportStiffness(_));
    let changed = (0..tolerances.len()).filter(is_support).map(|index| {
        let now = tolerances[index].value(calibrated.departure(index));
        wrong(&tolerances[index], CHANGES_OF_SUPPORTS.map(|times| times * now).to_vec())
    });
    candidates.iter().cloned().chain(changed).collect()
}

/// A quantity that has another value than stated, which a search sets out from each of these to find.
fn wrong(tolerance: &Tolerance, values: Vec<f64>) -> Candidate {
    let place = Place::Quantity(tolerance.quantity.path.clone(), tolerance.quantity.key);
    let starts = values.into_iter().map(|value| vec![value]).collect();
    Candidate { kind: EffectKind::QuantityError, place, dof: None, starts, directions: Vec::new() }
}

fn with_departed(
    candidates: &[Candidate],
    refitted: &Hypothesis,
    count: usize,
    is_one: impl Fn(usize) -> bool,
) -> Vec<Candidate> {
    let tolerances = refitted.tolerances();
    let all = (0..tolerances.len()).filter(|&index| departed(refitted, index) && is_one(index));
    let mut farthest: Vec<usize> = all.collect();
    let distance = |index: usize| refitted.departure(index).abs();
    farthest.sort_by(|a, b| distance(*b).total_cmp(&distance(*a)));
    farthest.truncate(count);
    let departed = farthest.into_iter().map(|index| {
        let tolerance = &tolerances[index];
        let at = |times: f64| tolerance.value(times * refitted.departure(index));
        wrong(tolerance, DEPARTURES.map(at).to_vec())
    });
    let mut all = candidates.to_vec();
    for other in departed {
        if all.iter().all(|known| known.place != other.place) {
            all.push(other);
        }
    }
    all
}

/// Middles of so many equal parts of one.
fn evenly(count: f64) -> impl Iterator<Item = f64> {
    (0..count as usize).map(move |index| (index as f64 + 0.5) / count)
}

fn sorted(names: impl Iterator<Item = String>) -> Vec<String> {
    let mut all: Vec<String> = names.collect();
    all.sort();
    all.dedup();
    all
}

/// The body that a place is on, where it is on one.
fn body_at(fixture: &Fixture, place: &Place) -> Option<usize> {
    match place {
        Place::Body(name) | Place::Between(name, _) => {
            fixture.bodies().iter().position(|body| body.name == *name)
        }
        Place::Point(name) => fixture.point(name).map(|point| point.body),
        Place::Response(name) | Place::Reference(name) => {
            let point = name.strip_suffix(":theta").unwrap_or(name);
            fixture.point(point).map(|point| point.body)
        }
        _ => None,
    }
}

/// E/ρ of steel, aluminium and titanium alike, within 4 %, m²/s²: of a section whose area is not stated, EI
/// tells ρI by it.
const MODULUS_OVER_DENSITY: f64 = 2.55e7;

/// What there is at a place, of which starts are multiples.
struct Surroundings<'a> {
    fixture: &'a Fixture,
    observation: &'a Observation,
    body: Option<usize>,
    second: Option<usize>,
    joint: Option<&'a Joint>,
    dof: Option<Dof>,
}

impl Surroundings<'_> {
    /// Every combination of the starts of a kind's parameters; what shapes the effect (a frequency, an
    /// abscissa) varies more slowly than its size.
    fn starts(&self, kind: EffectKind) -> Vec<Vec<f64>> {
        let spec = kind.spec();
        let leading = spec.size.parameter;
        let mut order: Vec<usize> =
            (0..spec.parameters.len()).rev().filter(|&index| index != leading).collect();
        order.push(leading);
        let mut all = vec![vec![0.0; spec.parameters.len()]];
        for index in order {
            let parameter = &spec.parameters[index];
            let values = match parameter.of_bodies_only && self.body.is_none() {
                true => vec![0.0],
                false => self.values(parameter.starts),
            };
            let with = |start: Vec<f64>| {
                values.iter().map(move |&value| {
                    let mut start = start.clone();
                    start[index] = value;
                    start
                })
            };
            all = all.into_iter().flat_map(with).collect();
        }
        for (index, parameter) in spec.parameters.iter().enumerate() {
            if let Starts::OfLeading(times) = parameter.starts {
                all.iter_mut().for_each(|start| start[index] = times * start[leading]);
            }
        }
        all
    }

    fn values(&self, starts: Starts) -> Vec<f64> {
        let times = |measure: Measure, times: &[f64]| match self.measure(measure) {
            Some(size) if size > 0.0 => times.iter().map(|times| times * size).collect(),
            _ => Vec::new(),
        };
        match starts {
            Starts::Times(measure, factors) => times(measure, factors),
            Starts::OnJointOrBody(measure, on_joint, on_body) => {
                times(measure, if self.joint.is_some() { on_joint } else { on_body })
            }
            // What holds a whole body against rotation does so anywhere.
            Starts::AlongBody(_) if self.joint.is_none() && self.dof == Some(Dof::Rotation) => vec![0.0],
            Starts::AlongBody(shares) => self.along(self.body, shares),
            Starts::AlongSecondBody(shares) => self.along(self.second, shares),
            Starts::AcrossBody => {
                let radius = self.body.and_then(|body| radius_of_gyration(self.fixture, body));
                vec![radius.unwrap_or(0.0)]
            }
            Starts::OverBand { count, low, high } => self.frequencies(count, low, high),
            Starts::OfLeading(_) => vec![0.0],
            Starts::WhereItBends(values) => match self.joint.map(|joint| &joint.law) {
                Some(JointLaw::Beam { .. }) if self.dof == Some(Dof::Rotation) => values.to_vec(),
                _ => vec![0.0],
            },
        }
    }

    /// Shares of the way along a body, of a beam as many as its modes ask for.
    fn along(&self, body: Option<usize>, shares: &[f64]) -> Vec<f64> {
        let Some(body) = body else { return vec![0.0] };
        let (low, high) = extent(self.fixture, body);
        if !turns(self.fixture, body) {
            return vec![low];
        }
        let at = |share: f64| low + share * (high - low);
        match self.half_waves(body).filter(|_| self.second.is_none()) {
            Some(waves) => evenly((PLACES_A_HALF_WAVE * waves).ceil()).map(at).collect(),
            None => shares.iter().map(|share| at(*share)).collect(),
        }
    }

    /// Half-waves of bending along a beam at the highest line.
    fn half_waves(&self, body: usize) -> Option<f64> {
        let BodyKind::Beam(beam) = &self.fixture.bodies()[body].kind else { return None };
        let hz = self.observation.lines().hz();
        let omega = TAU * hz[hz.len() - 1];
        let bending = beam.youngs_modulus.value * beam.second_moment.value;
        let wave_number = (omega * omega * beam.mass_per_length.value / bending).sqrt().sqrt();
        let waves = wave_number * beam.length() / std::f64::consts::PI;
        Some(waves.clamp(FEWEST_HALF_WAVES, MOST_HALF_WAVES))
    }

    /// Frequencies over the band, evenly on a logarithmic scale.
    fn frequencies(&self, count: usize, low: f64, high: f64) -> Vec<f64> {
        let hz = self.observation.lines().hz();
        let highest = hz[hz.len() - 1];
        let (from, to) = ((low * hz[0]).max(LOWEST_FREQUENCY * highest).ln(), (high * highest).ln());
        (0..count).map(|i| (from + (to - from) * (i as f64 + 0.5) / count as f64).exp()).collect()
    }

    /// Bending stiffness EI, N·m², and length of the body where it is a beam.
    fn beam(&self) -> Option<(f64, f64)> {
        match &self.fixture.bodies()[self.body?].kind {
            BodyKind::Beam(beam) => {
                Some((beam.youngs_modulus.value * beam.second_moment.value, beam.length()))
            }
            BodyKind::Rigid(_) => None,
        }
    }

    /// The stiffest of the joints and supports of bodies that do not turn, N/m; nothing of others. What holds
    /// a storey is of the kind of what holds the storeys to each other, wherever the middle of the band lies.
    fn stiffest_beside_storeys(&self) -> f64 {
        let fixture = self.fixture;
        let is_storey = |body: usize| [self.body, self.second].contains(&Some(body)) && !turns(fixture, body);
        let body_of = |point: usize| fixture.points()[point].body;
        let joints = fixture
            .joints()
            .iter()
            .filter(|joint| is_storey(body_of(joint.from)) || is_storey(body_of(joint.to)));
        let joints = joints.map(|joint| nominal_stiffness(&joint.law, fixture.joint_length(joint)).at(0, 0));
        let supports =
            fixture.supports().iter().filter(|support| is_storey(fixture.support_place(support).0));
        joints.chain(supports.map(|support| support.stiffness.value)).fold(0.0, f64::max)
    }

    fn measure(&self, measure: Measure) -> Option<f64> {
        let mass = |body: usize| self.fixture.bodies()[body].kind.mass();
        let point = |point: usize| &self.fixture.points()[point];
        let length = self.joint.map(|joint| self.fixture.joint_length(joint));
        let stiffness = self.joint.zip(length).map(|(joint, length)| nominal_stiffness(&joint.law, length));
        let bends = stiffness.is_some_and(|stiffness| stiffness.at(1, 1) > 0.0);
        match measure {
            Measure::One => Some(1.0),
            Measure::OneWhereItTurns => self.body.filter(|&body| turns(self.fixture, body)).map(|_| 1.0),
            // What sits on no body in particular is small beside the lightest.
            Measure::BodyMass => self
                .body
                .map(mass)
                .or_else(|| (0..self.fixture.bodies().len()).map(mass).min_by(f64::total_cmp)),
            Measure::BodySpring => {
                let middle = self.frequencies(1, 1.0, 1.0)[0] * TAU;
                let own = |body: usize| match self.dof {
                    Some(Dof::Rotation) => inertia_of(self.fixture, body),
                    _ => self.second.map_or(mass(body), |second| mass(body).min(mass(second))),
                };
                let inertial = self.body.map(|body| own(body) * middle * middle)?;
                Some(inertial.max(self.stiffest_beside_storeys()))
            }
            Measure::LowestLine => Some(self.observation.lines().hz()[0]),
            Measure::LighterBody => {
                self.joint.map(|joint| mass(point(joint.from).body).min(mass(point(joint.to).body)))
            }
            Measure::JointStiffness(dof) => {
                let dof = usize::from(dof.or(self.dof) == Some(Dof::Rotation));
                stiffness.map(|stiffness| stiffness.at(dof, dof))
            }
            Measure::BendingForce => {
                let of_beam = || self.beam().map(|(bending, length)| 12.0 * bending / length.powi(2));
                match stiffness {
                    Some(stiffness) => length.map(|length| stiffness.at(0, 0) * length),
                    None => of_beam(),
                }
            }
            Measure::SectionInertia => self.beam().map(|(bending, _)| bending / MODULUS_OVER_DENSITY),
            Measure::FreeLength => length.filter(|_| bends).map(|length| length.max(LEAST_LENGTH)),
            Measure::ShortestTime => {
                let hz = self.observation.lines().hz();
                Some(1.0 / (TAU * hz[hz.len() - 1]))
            }
            _ => None,
        }
    }
}
