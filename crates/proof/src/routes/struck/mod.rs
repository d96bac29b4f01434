//! Cases of hits over time: what depends on amplitude, in one joint of an assembly, and hits of several
//! strengths.
//!
//! The laboratory integrates the motion step by step (Runge and Kutta); the diagnosis has hits and the
//! fixture, and nothing else.

mod answer;
mod judged;
mod score;

pub use answer::{StruckAnswer, StruckAnswers};
pub(crate) use judged::StruckJudged;

use crate::effect_file::effect_value;
use crate::generate::{DRAWS, Draw, turn};
use crate::name::describe;
use crate::sealable::{Filed, Sealable};
use crate::{Case, GenerationError, Plan};
use jointscope_fixture::{Damping, Dof, Effect, EffectKind, Fixture, JointLaw};
use jointscope_hits::Hit;
use jointscope_recordings::hits_to_datasets;
use jointscope_rig::universal_file::{FileError, Precision};
use jointscope_rig::{StrikeTest, StructureError, drawn_within_tolerance, generator, random_law, reach};
use jointscope_spectra::Channel;
use jointscope_uff::Encoding;
use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

pub(crate) use score::score;

/// A case of hits over time.
pub type StruckCase = Case<Vec<Hit>>;

impl StruckCase {
    /// The hits as a universal file (58b): time histories, the hit's number as sequence number.
    ///
    /// # Errors
    /// A point whose name is no node number.
    pub fn recording(&self, precision: Precision) -> Result<Vec<u8>, FileError> {
        let mut datasets = hits_to_datasets(&self.recorded, "hammer test", Encoding::default(), true)?;
        datasets.iter_mut().for_each(|dataset| dataset.precision = precision);
        Ok(jointscope_uff::write(&datasets)?)
    }
}

/// How much was hidden in hits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StruckRole {
    /// A linear structure.
    Linear,
    /// A law that the hits exercise.
    Law,
    /// A law that they do not: a gap that never closes, friction that never slips, a cubic term that is not
    /// reached.
    #[serde(rename = "idle law")]
    Idle,
}

impl StruckRole {
    /// Every role.
    pub(crate) const ALL: [StruckRole; 3] = [StruckRole::Linear, StruckRole::Law, StruckRole::Idle];

    /// The role in a word.
    pub(crate) fn name(self) -> &'static str {
        match self {
            StruckRole::Linear => "linear",
            StruckRole::Law => "law",
            StruckRole::Idle => "idle law",
        }
    }
}

/// What is true of a case of hits.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct StruckTruth {
    /// The case's number among all.
    #[serde(rename = "case")]
    pub index: usize,
    /// What its random numbers were seeded with.
    pub source: String,
    /// How much was hidden.
    pub role: StruckRole,
    /// The fixture with its true quantities, the hidden law as its `physics`.
    pub fixture: Fixture,
    /// How it was struck.
    pub test: StrikeTest,
    /// Largest relative motion of the hidden law's joint under the hardest blow, of the structure without the
    /// law, m or rad.
    pub reach: Option<f64>,
}

/// Roles by case number, repeating.
const ROLES: [StruckRole; 8] = [
    StruckRole::Law,
    StruckRole::Linear,
    StruckRole::Law,
    StruckRole::Law,
    StruckRole::Idle,
    StruckRole::Law,
    StruckRole::Linear,
    StruckRole::Law,
];
/// Laws take the kinds in turn.
const KINDS: [EffectKind; 3] = [EffectKind::CubicStiffness, EffectKind::Friction, EffectKind::Gap];
/// Peaks of the levels, N.
const LEVELS: [f64; 3] = [35.0, 140.0, 500.0];
/// Samples a second, and numbers of samples of a record.
const RATE: f64 = 6400.0;
const SAMPLES: [usize; 2] = [4096, 6144];
/// Steps of the integration within a sample.
const STEPS: usize = 8;
/// How far beyond what the hits reach an idle law begins.
const IDLE: [f64; 2] = [1.5, 4.0];
/// Share of the joint's own force that an idle cubic spring adds at the most.
const NEGLIGIBLE: f64 = 1e-5;

impl StruckTruth {
    /// The case of a number, and apart from it what is true of it.
    pub(crate) fn draw(at: Draw) -> Result<(StruckCase, Self), GenerationError> {
        let Draw { plan: Plan { families, .. }, index, number, source, seed } = at;
        let mut random = generator(seed);
        let role = ROLES[number % ROLES.len()];
        for _ in 0..DRAWS {
            let family = families[random.random_range(0..families.len())];
            let believed = family.draw("concealed case", &mut random)?;
            // A loss factor has no form over time.
            if matches!(believed.damping(), Damping::LossFactor(_)) {
                continue;
            }
            let truth = drawn_within_tolerance(&believed, &mut random)?;
            let test = StrikeTest {
                rate: RATE,
                samples: SAMPLES[random.random_range(0..SAMPLES.len())],
                steps: STEPS,
                pulse: random.random_range(0.0005..0.0007),
                levels: LEVELS.to_vec(),
                hits: random.random_range(2..4),
                noise_response: 0.01,
                noise_force: random.random_range(0.001..0.0015),
            };
            let point = |i: usize| Channel::transverse(believed.points()[i].name.clone());
            let last = believed.points().len() - 1;
            let (struck, read) = ([point(0), point(1)], [point(last - 1), point(last)]);
            let law = match role {
                StruckRole::Linear => None,
                role => {
                    let kind = KINDS[turn(&ROLES, number) % KINDS.len()];
                    Some(law(&mut random, kind, role, &truth, &struck, &test)?)
                }
            };
            let (effects, reach) = law.map_or((Vec::new(), None), |(law, reach)| (vec![law], Some(reach)));
            let fixture = truth.with_physics(effects).map_err(StructureError::from)?;
            let hits = test.record(&fixture, &struck, &read, &mut random)?;
            let truth = StruckTruth { index, source, role, fixture, test, reach };
            return Ok((Case { believed, recorded: hits }, truth));
        }
        Err(GenerationError::Unlucky(index))
    }

    /// The hidden law.
    pub fn law(&self) -> Option<&Effect> {
        self.fixture.physics().first()
    }

    /// What was hidden, in words.
    pub(crate) fn hidden(&self) -> String {
        let Some(law) = self.law() else { return "nothing".to_owned() };
        let reach = self.reach.unwrap_or(0.0);
        let idle = if self.role == StruckRole::Idle { ", idle" } else { "" };
        format!("{}{idle}, reach {reach:.2e}", describe(law))
    }
}

impl Filed for StruckTruth {
    fn from_value(value: &Value) -> Option<Self> {
        StruckTruth::deserialize(value).ok()
    }
}

impl Sealable for StruckTruth {
    fn to_value(&self) -> Value {
        json!({
            "case": self.index,
            "route": "struck",
            "source": self.source,
            "role": self.role,
            "hidden": self.hidden(),
            "law": self.law().map(effect_value),
            "reach": self.reach,
            "fixture": self.fixture,
            "test": self.test,
        })
    }
}

/// A law at a random joint and degree of freedom, and how far the hits drive that.
fn law(
    random: &mut impl Rng,
    kind: EffectKind,
    role: StruckRole,
    truth: &Fixture,
    struck: &[Channel],
    test: &StrikeTest,
) -> Result<(Effect, f64), GenerationError> {
    let joint = &truth.joints()[random.random_range(0..truth.joints().len())];
    let own = match &joint.law {
        JointLaw::Stiffness { stiffness, .. } => [stiffness[0].value, stiffness[2].value],
        JointLaw::Beam { youngs_modulus, second_moment } => {
            let (length, bending) = (truth.joint_length(joint), youngs_modulus.value * second_moment.value);
            [12.0 * bending / length.powi(3), 4.0 * bending / length]
        }
    };
    let rotates = own[1] > 0.0 && random.random_range(0.0..1.0) < 0.4;
    let (dof, stiffness) = if rotates { (Dof::Rotation, own[1]) } else { (Dof::Translation, own[0]) };
    let hardest = test.levels.iter().copied().fold(0.0, f64::max);
    let reached = struck.iter().map(|channel| reach(truth, (&joint.name, dof), channel, test, hardest));
    let most = reached.collect::<Result<Vec<_>, _>>()?.into_iter().fold(0.0, f64::max);
    let law = random_law(random, kind, &joint.name, dof, stiffness, most);
    if role == StruckRole::Law {
        return Ok((law, most));
    }
    let beyond = random.random_range(IDLE[0]..IDLE[1]);
    let values = match kind {
        EffectKind::CubicStiffness => vec![NEGLIGIBLE * stiffness / (most * most)],
        EffectKind::Friction => vec![law.value(1) * most * beyond, law.value(1)],
        _ => vec![most * beyond, law.value(1)],
    };
    Ok((Effect::new(kind, law.place.clone(), Some(dof), &values), most))
}
