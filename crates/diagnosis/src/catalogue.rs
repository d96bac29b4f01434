//! Every effect at every legal place of a fixture, with starts from which a fit may set out.

use crate::Observation;
use crate::freedom::extent;
use jointscope_fixture::{BodyKind, Dof, Effect, EffectKind, Fixture, JointLaw, Place, RigidBody};
use jointscope_lumped::nominal_stiffness;

/// One kind of effect at one place (and dof): a name that a diagnosis can give, with starts for its parameters.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// The kind.
    pub kind: EffectKind,
    /// The place.
    pub place: Place,
    /// The degree of freedom, for kinds that have one.
    pub dof: Option<Dof>,
    /// Parameters to start from: sizes, signs, abscissae, frequencies.
    pub starts: Vec<Vec<f64>>,
    /// Parameters of effects so small that what they do is proportional to their size, one for each abscissa, frequency or time.
    pub directions: Vec<Vec<f64>>,
}

impl Candidate {
    /// The effect at start `index`.
    pub fn effect(&self, index: usize) -> Effect {
        Effect::new(self.kind, self.place.clone(), self.dof, &self.starts[index])
    }

    /// The effect that is `times` as large as direction `index`; `None` where there is none of that sign.
    ///
    /// Large means what it does to the FRFs to first order: a mass, a deviation, a compliance.
    pub(crate) fn scaled(&self, index: usize, times: f64) -> Option<Effect> {
        let effect = Effect::new(self.kind, self.place.clone(), self.dof, &self.directions[index]);
        scaled(&effect, times)
    }

    /// Whether `effect` goes by this name.
    pub fn names(&self, effect: &Effect) -> bool {
        self.kind == effect.kind && self.place == effect.place && self.dof == effect.dof
    }
}

/// The effect made `times` as large in what it does to the FRFs to first order; `None` where none of its kind has that sign.
pub(crate) fn scaled(effect: &Effect, times: f64) -> Option<Effect> {
    use EffectKind as Kind;
    let mut parameters: Vec<f64> = effect.parameters.iter().map(|p| p.value).collect();
    let places =
        matches!(effect.kind, Kind::AddedMass | Kind::SensorMass | Kind::PointOffset | Kind::JointLength);
    let either_sign =
        places || matches!(effect.kind, Kind::ChannelDelay | Kind::ChannelGain | Kind::StiffnessChange);
    if !either_sign && times <= 0.0 {
        return None;
    }
    match effect.kind {
        Kind::AddedMass | Kind::AttachedResonator => parameters[1] *= times,
        Kind::Support => parameters[1..].iter_mut().for_each(|p| *p *= times),
        Kind::InterfaceCompliance | Kind::ShearDeformation => parameters[0] /= times,
        Kind::BodyFlexibility => parameters[0] /= times.sqrt(),
        Kind::ChannelGain => parameters[0] = 1.0 + (parameters[0] - 1.0) * times,
        // A factor must stay positive: half or double is as far as a line leads.
        Kind::StiffnessChange => parameters[0] = (1.0 + (parameters[0] - 1.0) * times).clamp(0.5, 2.0),
        _ => parameters[0] *= times,
    }
    Some(Effect::new(effect.kind, effect.place.clone(), effect.dof, &parameters))
}

/// Sizes of an effect relative to what it acts on.
const SIZES: [f64; 7] = [0.001, 0.003, 0.009, 0.027, 0.08, 0.24, 0.6];
/// Stiffnesses of series springs relative to the joint's own.
const SPRINGS: [f64; 8] = [300.0, 100.0, 35.0, 12.0, 4.0, 1.5, 0.5, 0.2];

/// All linear effects that make sense at the fixture's places and the recording's channels.
pub fn catalogue(fixture: &Fixture, observation: &Observation) -> Vec<Candidate> {
    let mut all = Vec::new();
    on_bodies(fixture, observation, &mut all);
    at_joints(fixture, observation, &mut all);
    of_the_chain(fixture, observation, &mut all);
    all
}

fn candidate(kind: EffectKind, place: Place, dof: Option<Dof>, starts: Vec<Vec<f64>>) -> Candidate {
    // Of starts that differ in size alone the first serves as direction, made small.
    let mut directions: Vec<Vec<f64>> = Vec::new();
    for start in &starts {
        let small = made_small(kind, start, &starts);
        if !directions.iter().any(|d| d == &small) {
            directions.push(small);
        }
    }
    Candidate { kind, place, dof, starts, directions }
}

/// The start's shape (abscissa, frequency, time) with a size that depends on its kind alone, too small to bend anything.
fn made_small(kind: EffectKind, start: &[f64], all: &[Vec<f64>]) -> Vec<f64> {
    use EffectKind as Kind;
    let stiffest = all.iter().map(|start| start[0]).fold(0.0, f64::max);
    match kind {
        Kind::AddedMass => vec![start[0], 1e-6],
        Kind::Support => vec![start[0], 1e-2, 0.0],
        Kind::AttachedResonator => vec![start[0], 1e-7, start[2], start[3]],
        Kind::BodyFlexibility => vec![30.0 * stiffest, start[1]],
        Kind::InterfaceCompliance | Kind::ShearDeformation => vec![300.0 * stiffest, 0.0],
        Kind::ChannelGain | Kind::StiffnessChange => vec![1.0 + 1e-5],
        Kind::Relaxation => vec![1e-5, start[1]],
        Kind::ChannelDelay => vec![1e-9],
        _ => vec![1e-6],
    }
}

fn mass_of(fixture: &Fixture, body: usize) -> f64 {
    match &fixture.bodies()[body].kind {
        BodyKind::Rigid(rigid) => rigid.mass.value,
        BodyKind::Beam(beam) => beam.mass_per_length.value * (beam.to.value - beam.from.value),
    }
}

/// Frequencies over the band, evenly on a logarithmic scale.
fn frequencies(observation: &Observation, count: usize, low: f64, high: f64) -> Vec<f64> {
    let hz = observation.lines().hz();
    let (from, to) = ((low * hz[0]).max(0.02 * hz[hz.len() - 1]).ln(), (high * hz[hz.len() - 1]).ln());
    (0..count).map(|i| (from + (to - from) * (i as f64 + 0.5) / count as f64).exp()).collect()
}

fn on_bodies(fixture: &Fixture, observation: &Observation, all: &mut Vec<Candidate>) {
    let middle = frequencies(observation, 1, 1.0, 1.0)[0] * std::f64::consts::TAU;
    for (index, body) in fixture.bodies().iter().enumerate() {
        let place = || Place::Body(body.name.clone());
        let mass = mass_of(fixture, index);
        let (low, high) = extent(fixture, index);
        let turns = matches!(&body.kind, BodyKind::Beam(_))
            || matches!(&body.kind, BodyKind::Rigid(RigidBody { rotates: true, .. }));
        let places: Vec<f64> = match turns {
            true => [0.1, 0.5, 0.9].iter().map(|s| low + s * (high - low)).collect(),
            false => vec![0.0],
        };
        let mut masses = Vec::new();
        let mut springs = Vec::new();
        for &x in &places {
            for size in SIZES {
                masses.extend([1.0, -1.0].map(|sign| vec![x, sign * size.min(0.3) * mass]));
                let stiffness = size * mass * middle * middle;
                springs.push(vec![x, stiffness, 1e-4 * stiffness]);
            }
        }
        all.push(candidate(EffectKind::AddedMass, place(), None, masses));
        all.push(candidate(EffectKind::Support, place(), None, springs));
        let mut resonators = Vec::new();
        for frequency in frequencies(observation, 14, 1.0, 1.1) {
            for &x in &places {
                resonators.extend([0.003, 0.03].map(|size| vec![x, size * mass, frequency, 0.02]));
            }
        }
        all.push(candidate(EffectKind::AttachedResonator, place(), None, resonators));
        match &body.kind {
            BodyKind::Rigid(rigid) if rigid.rotates => {
                let starts =
                    frequencies(observation, 7, 0.5, 6.0).into_iter().map(|f| vec![f, 0.01]).collect();
                all.push(candidate(EffectKind::BodyFlexibility, place(), None, starts));
            }
            BodyKind::Beam(beam) => {
                let bending = beam.youngs_modulus.value * beam.second_moment.value;
                let radius2 = 12.0 * bending / (high - low).powi(2);
                let starts = [10.0, 100.0, 1000.0].map(|s| vec![s * radius2, 0.0]).to_vec();
                all.push(candidate(EffectKind::ShearDeformation, place(), None, starts));
                all.push(candidate(EffectKind::StiffnessChange, place(), None, factors()));
            }
            BodyKind::Rigid(_) => {}
        }
    }
}

fn factors() -> Vec<Vec<f64>> {
    [0.3, 0.5, 0.7, 0.85, 0.95, 1.05, 1.2, 1.5, 2.0, 3.0].map(|f| vec![f]).to_vec()
}

fn at_joints(fixture: &Fixture, observation: &Observation, all: &mut Vec<Candidate>) {
    let points = fixture.points();
    let slowest = 1.0 / (std::f64::consts::TAU * observation.lines().hz()[observation.lines().len() - 1]);
    for joint in fixture.joints() {
        let place = || Place::Joint(joint.name.clone());
        let length = fixture.joint_length(joint);
        let stiffness = nominal_stiffness(&joint.law, length);
        let bends = stiffness.at(1, 1) > 0.0;
        for point in [joint.from, joint.to] {
            let ends = fixture.joints().iter().filter(|j| j.from == point || j.to == point).count();
            for dof in
                [Dof::Translation, Dof::Rotation].into_iter().filter(|d| *d == Dof::Translation || bends)
            {
                let own = stiffness.at(usize::from(dof == Dof::Rotation), usize::from(dof == Dof::Rotation));
                if ends == 1 && own > 0.0 {
                    let starts = SPRINGS.map(|s| vec![s * own, 1e-6 * s * own]).to_vec();
                    let at = Place::Point(points[point].name.clone());
                    all.push(candidate(EffectKind::InterfaceCompliance, at, Some(dof), starts));
                }
            }
        }
        if matches!(joint.law, JointLaw::Beam { .. }) {
            let starts = SPRINGS.map(|s| vec![s * stiffness.at(0, 0) * length, 0.0]).to_vec();
            all.push(candidate(EffectKind::ShearDeformation, place(), None, starts));
        }
        let lighter = mass_of(fixture, points[joint.from].body).min(mass_of(fixture, points[joint.to].body));
        let masses = SIZES.map(|s| vec![s * lighter]).to_vec();
        all.push(candidate(EffectKind::JointMass, place(), None, masses));
        all.push(candidate(EffectKind::StiffnessChange, place(), None, factors()));
        let losses = [0.003, 0.01, 0.03, 0.1].map(|l| vec![l]).to_vec();
        all.push(candidate(EffectKind::LossFactor, place(), None, losses));
        let mut relaxations = Vec::new();
        for time in [0.5, 2.0, 8.0, 30.0] {
            relaxations.extend([0.05, 0.3].map(|ratio| vec![ratio, time * slowest]));
        }
        all.push(candidate(EffectKind::Relaxation, place(), None, relaxations));
        if bends {
            let lengths = [-0.1, -0.03, -0.01, 0.01, 0.03, 0.1].map(|s| vec![s * length.max(0.01)]).to_vec();
            all.push(candidate(EffectKind::JointLength, place(), None, lengths));
        }
    }
}

fn of_the_chain(fixture: &Fixture, observation: &Observation, all: &mut Vec<Candidate>) {
    let names = |references: bool| {
        let mut names: Vec<String> = observation
            .pairs()
            .iter()
            .map(|pair| if references { pair.reference.to_string() } else { pair.response.to_string() })
            .collect();
        names.sort();
        names.dedup();
        names
    };
    let signed = |sizes: &[f64]| sizes.iter().flat_map(|s| [vec![*s], vec![-*s]]).collect::<Vec<_>>();
    let gains = || [-1.0, 0.6, 0.8, 0.93, 1.07, 1.25, 1.7].map(|f| vec![f]).to_vec();
    let delays = || signed(&[2e-6, 1e-5, 4e-5, 1.5e-4]);
    for (references, make) in [(false, Place::Response as fn(String) -> Place), (true, Place::Reference)] {
        // With one reference only, its gain is that of all responses together: still a name of its own.
        for name in names(references) {
            all.push(candidate(EffectKind::ChannelGain, make(name.clone()), None, gains()));
            all.push(candidate(EffectKind::ChannelDelay, make(name), None, delays()));
        }
    }
    let mut measured: Vec<String> = observation
        .pairs()
        .iter()
        .flat_map(|pair| [pair.response.point.clone(), pair.reference.point.clone()])
        .collect();
    measured.sort();
    measured.dedup();
    for name in measured {
        let Some(point) = fixture.point(&name) else { continue };
        let fixed = matches!(&fixture.bodies()[point.body].kind, BodyKind::Rigid(rigid) if !rigid.rotates);
        if !fixed {
            let offsets = signed(&[5e-4, 2e-3, 6e-3, 1.5e-2]);
            all.push(candidate(EffectKind::PointOffset, Place::Point(name), None, offsets));
        }
    }
    for name in names(false) {
        let point = name.strip_suffix(":theta").unwrap_or(&name);
        let Some(point) = fixture.point(point) else { continue };
        let mass = mass_of(fixture, point.body);
        let masses = [0.002, 0.01, 0.04].map(|s| vec![s * mass]).to_vec();
        all.push(candidate(EffectKind::SensorMass, Place::Response(name), None, masses));
    }
    let decays = [0.5, 2.0, 8.0, 30.0].map(|d| vec![d]).to_vec();
    all.push(candidate(EffectKind::ExponentialWindow, Place::All, None, decays));
}
