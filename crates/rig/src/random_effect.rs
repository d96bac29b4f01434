//! Physics that an analyst might have left out: random effects of sensible sizes.

use crate::StructureError;
use crate::families::elastic::elastic_frequencies;
use crate::random::{choice, log_uniform, sign, uniform};
use jointscope_fixture::{Body, BodyKind, Dof, Effect, EffectKind, Fixture, Joint, JointLaw, Nature, Place};
use jointscope_spectra::FrfPair;
use rand::Rng;
use std::f64::consts::TAU;

/// A random effect of `kind` somewhere on `fixture`, of a size that such physics has; `None` where the
/// fixture has no place for it. Effects of the measuring chain fall on channels among `recorded`.
///
/// Whether the effect shows in a recording is for the caller to judge.
///
/// # Errors
/// A fixture whose modes cannot be found.
pub fn random_effect(
    rng: &mut impl Rng,
    fixture: &Fixture,
    kind: EffectKind,
    recorded: &[FrfPair],
) -> Result<Option<Effect>, StructureError> {
    let highest = elastic_frequencies(fixture)?.last().copied().unwrap_or(500.0).min(1000.0);
    let scene = Scene { fixture, recorded, highest };
    Ok(match kind {
        EffectKind::AddedMass
        | EffectKind::Support
        | EffectKind::AttachedResonator
        | EffectKind::BodyFlexibility => scene.on_a_body(rng, kind),
        EffectKind::InterfaceCompliance => scene.interface(rng),
        EffectKind::ShearDeformation | EffectKind::StiffnessChange => scene.of_the_material(rng, kind),
        EffectKind::JointMass | EffectKind::LossFactor | EffectKind::Relaxation | EffectKind::JointLength => {
            scene.of_a_joint(rng, kind)
        }
        EffectKind::Footing => scene.footing(rng),
        EffectKind::ParallelStiffness | EffectKind::Springpot => scene.beside_a_joint(rng, kind),
        EffectKind::Bypass => scene.bypass(rng),
        EffectKind::QuantityError => scene.wrong_quantity(rng),
        EffectKind::CubicStiffness | EffectKind::Friction | EffectKind::Gap => scene.nonlinear(rng, kind),
        EffectKind::PointOffset
        | EffectKind::ChannelGain
        | EffectKind::ChannelDelay
        | EffectKind::ChannelHighpass
        | EffectKind::ChannelResonance
        | EffectKind::SensorMass
        | EffectKind::ExponentialWindow => scene.of_the_instrument(rng, kind),
    })
}

/// A random rotational spring and dashpot that hold a block to ground, as stiff as turn it alone at 5 to
/// 50 Hz; `None` where no body turns.
pub fn random_rotational_support(rng: &mut impl Rng, fixture: &Fixture) -> Option<Effect> {
    let inertia = |body: &Body| match &body.kind {
        BodyKind::Rigid(rigid) if rigid.rotates => Some((body.name.clone(), rigid.inertia?.value)),
        _ => None,
    };
    let blocks: Vec<(String, f64)> = fixture.bodies().iter().filter_map(inertia).collect();
    let (name, inertia) = choice(rng, &blocks)?;
    let omega = TAU * log_uniform(rng, 5.0, 50.0);
    let values = [0.0, inertia * omega * omega, 2.0 * uniform(rng, 0.01, 0.1) * inertia * omega];
    Some(Effect::new(EffectKind::Support, Place::Body(name.clone()), Some(Dof::Rotation), &values))
}

struct Scene<'a> {
    fixture: &'a Fixture,
    recorded: &'a [FrfPair],
    /// The highest elastic mode within the band, Hz.
    highest: f64,
}

impl Scene<'_> {
    /// A number that was written down wrong, by more than anybody would take for its deviation.
    fn wrong_quantity(&self, rng: &mut impl Rng) -> Option<Effect> {
        let mut all = self.fixture.quantities();
        all.retain(|quantity| {
            !matches!(quantity.nature, Nature::Damping | Nature::Support | Nature::Effect)
                && quantity.std.is_some_and(|std| std > 0.0)
        });
        let quantity = choice(rng, &all)?;
        let wrong = quantity.value + sign(rng) * quantity.std? * log_uniform(rng, 8.0, 30.0);
        // Nothing that is positive is written down as negative.
        let wrong = if quantity.nature == Nature::Abscissa { wrong } else { wrong.max(0.3 * quantity.value) };
        let place = Place::Quantity(quantity.path.clone(), quantity.key);
        Some(Effect::new(EffectKind::QuantityError, place, None, &[wrong]))
    }

    fn on_a_body(&self, rng: &mut impl Rng, kind: EffectKind) -> Option<Effect> {
        let suits = |body: &&Body| match (&body.kind, kind) {
            (BodyKind::Rigid(rigid), EffectKind::BodyFlexibility) => rigid.rotates,
            (BodyKind::Beam(_), EffectKind::BodyFlexibility) => false,
            _ => true,
        };
        let bodies: Vec<&Body> = self.fixture.bodies().iter().filter(suits).collect();
        let body = choice(rng, &bodies)?;
        let (from, to, mass) = extent(body);
        let x = uniform(rng, from, to);
        let values = match kind {
            EffectKind::AddedMass => {
                // Mass that is not there is rarer than mass that was forgotten.
                let sign = if uniform(rng, 0.0, 1.0) < 0.2 { -1.0 } else { 1.0 };
                vec![x, sign * mass * log_uniform(rng, 0.01, 0.1)]
            }
            EffectKind::Support => {
                let omega = TAU * log_uniform(rng, 5.0, 50.0);
                vec![x, mass * omega * omega, 2.0 * uniform(rng, 0.01, 0.1) * mass * omega]
            }
            EffectKind::AttachedResonator => {
                let frequency = self.highest * log_uniform(rng, 0.15, 0.95);
                vec![x, mass * log_uniform(rng, 0.01, 0.06), frequency, log_uniform(rng, 0.005, 0.03)]
            }
            _ => vec![self.highest * log_uniform(rng, 1.0, 3.0), log_uniform(rng, 0.002, 0.01)],
        };
        Some(Effect::new(kind, Place::Body(body.name.clone()), None, &values))
    }

    fn interface(&self, rng: &mut impl Rng) -> Option<Effect> {
        let mut candidates = Vec::new();
        for joint in self.fixture.joints() {
            let [translation, rotation] = stiffness(self.fixture, joint);
            for point in [joint.from, joint.to] {
                let shared =
                    self.fixture.joints().iter().filter(|j| j.from == point || j.to == point).count();
                let stiff = [(Dof::Translation, translation), (Dof::Rotation, rotation)];
                candidates.extend(
                    stiff
                        .into_iter()
                        .filter(|(_, k)| shared == 1 && *k > 0.0)
                        .map(|(dof, k)| (point, dof, k)),
                );
            }
        }
        let &(point, dof, joint_stiffness) = choice(rng, &candidates)?;
        let stiffness = joint_stiffness
            * match dof {
                Dof::Translation => log_uniform(rng, 0.5, 20.0),
                Dof::Rotation => log_uniform(rng, 1.0, 30.0),
            };
        let dashpot = stiffness * log_uniform(rng, 0.003, 0.1) / (TAU * self.highest);
        let place = Place::Point(self.fixture.points()[point].name.clone());
        Some(Effect::new(EffectKind::InterfaceCompliance, place, Some(dof), &[stiffness, dashpot]))
    }

    fn beside_a_joint(&self, rng: &mut impl Rng, kind: EffectKind) -> Option<Effect> {
        let mut candidates = Vec::new();
        for joint in self.fixture.joints() {
            let dofs = [Dof::Translation, Dof::Rotation].into_iter().zip(stiffness(self.fixture, joint));
            candidates.extend(dofs.filter(|(_, k)| *k > 0.0).map(|(dof, k)| (joint, dof, k)));
        }
        let &(joint, dof, joint_stiffness) = choice(rng, &candidates)?;
        let stiffness = joint_stiffness * log_uniform(rng, 0.03, 0.5);
        let values = match kind {
            // As stiff as that where the highest mode is.
            EffectKind::Springpot => {
                let exponent = uniform(rng, 0.2, 0.8);
                [stiffness / (TAU * self.highest).powf(exponent), exponent]
            }
            _ => [stiffness, stiffness * log_uniform(rng, 0.003, 0.1) / (TAU * self.highest)],
        };
        Some(Effect::new(kind, Place::Joint(joint.name.clone()), Some(dof), &values))
    }

    fn bypass(&self, rng: &mut impl Rng) -> Option<Effect> {
        let bodies = self.fixture.bodies();
        let one = choice(rng, bodies)?;
        let others: Vec<&Body> = bodies.iter().filter(|body| body.name != one.name).collect();
        let other = choice(rng, &others)?;
        let place = |rng: &mut _, body: &Body| {
            let (from, to, _) = extent(body);
            uniform(rng, from, to)
        };
        let (x_from, x_to) = (place(rng, one), place(rng, other));
        let mass = extent(one).2.min(extent(other).2);
        let omega = TAU * self.highest * log_uniform(rng, 0.03, 0.3);
        let values = [x_from, x_to, mass * omega * omega, 2.0 * uniform(rng, 0.01, 0.1) * mass * omega];
        let place = Place::Between(one.name.clone(), other.name.clone());
        Some(Effect::new(EffectKind::Bypass, place, None, &values))
    }

    fn footing(&self, rng: &mut impl Rng) -> Option<Effect> {
        let bending = |joint: &&Joint| stiffness(self.fixture, joint)[1] > 0.0;
        let joints: Vec<&Joint> = self.fixture.joints().iter().filter(bending).collect();
        let joint = choice(rng, &joints)?;
        let stiffness = stiffness(self.fixture, joint)[1] * log_uniform(rng, 1.0, 30.0);
        let dashpot = stiffness * log_uniform(rng, 0.003, 0.1) / (TAU * self.highest);
        Some(Effect::new(EffectKind::Footing, Place::Joint(joint.name.clone()), None, &[stiffness, dashpot]))
    }

    fn of_the_material(&self, rng: &mut impl Rng, kind: EffectKind) -> Option<Effect> {
        let sheared = kind == EffectKind::ShearDeformation;
        let mut places = Vec::new();
        for joint in self.fixture.joints() {
            let length = self.fixture.joint_length(joint);
            let [translation, _] = stiffness(self.fixture, joint);
            if !sheared || matches!(joint.law, jointscope_fixture::JointLaw::Beam { .. }) {
                places.push((Place::Joint(joint.name.clone()), translation * length, 0.0));
            }
        }
        for body in self.fixture.bodies() {
            if let BodyKind::Beam(beam) = &body.kind {
                let length = beam.length();
                let bending = beam.youngs_modulus.value * beam.second_moment.value;
                let euler = std::f64::consts::PI.powi(2) * bending / (length * length);
                // A radius of gyration of a thirtieth of the length: a stocky bar.
                let rotary = beam.mass_per_length.value * (length / 30.0).powi(2);
                places.push((Place::Body(body.name.clone()), 3.0 * euler, rotary));
            }
        }
        let (place, stiff, rotary) = choice(rng, &places)?;
        let values = if sheared {
            vec![stiff / log_uniform(rng, 0.05, 1.0), rotary * uniform(rng, 0.3, 1.5)]
        } else {
            vec![(sign(rng) * log_uniform(rng, 0.03, 0.5)).exp()]
        };
        Some(Effect::new(kind, place.clone(), None, &values))
    }

    fn of_a_joint(&self, rng: &mut impl Rng, kind: EffectKind) -> Option<Effect> {
        // Between storeys that do not rotate a longer spring is the same spring.
        let rotates = |point: usize| self.fixture.bodies()[self.fixture.points()[point].body].kind.rotates();
        let suits = |joint: &&Joint| {
            let shows =
                matches!(joint.law, JointLaw::Beam { .. }) || rotates(joint.from) || rotates(joint.to);
            kind != EffectKind::JointLength || (shows && self.fixture.joint_length(joint) > 0.0)
        };
        let joints: Vec<&Joint> = self.fixture.joints().iter().filter(suits).collect();
        let joint = choice(rng, &joints)?;
        let values = match kind {
            EffectKind::JointMass => {
                let of_body =
                    |point: usize| extent(&self.fixture.bodies()[self.fixture.points()[point].body]).2;
                vec![of_body(joint.from).min(of_body(joint.to)) * log_uniform(rng, 0.01, 0.15)]
            }
            EffectKind::LossFactor => vec![log_uniform(rng, 0.01, 0.1)],
            EffectKind::Relaxation => {
                let frequency = self.highest * log_uniform(rng, 0.3, 3.0);
                vec![uniform(rng, 0.1, 0.8), 1.0 / (TAU * frequency)]
            }
            _ => vec![sign(rng) * self.fixture.joint_length(joint) * log_uniform(rng, 0.01, 0.08)],
        };
        Some(Effect::new(kind, Place::Joint(joint.name.clone()), None, &values))
    }

    fn nonlinear(&self, rng: &mut impl Rng, kind: EffectKind) -> Option<Effect> {
        let mut candidates = Vec::new();
        for joint in self.fixture.joints() {
            let stiff = stiffness(self.fixture, joint);
            let dofs = [Dof::Translation, Dof::Rotation].into_iter().zip(stiff);
            candidates.extend(dofs.filter(|(_, k)| *k > 0.0).map(|(dof, k)| (joint, dof, k)));
        }
        let &(joint, dof, k) = choice(rng, &candidates)?;
        // The relative motion at which the effect matters, under hits of some hundred newtons.
        let motion = match dof {
            Dof::Translation => log_uniform(rng, 1e-5, 1e-4),
            Dof::Rotation => log_uniform(rng, 2e-4, 2e-3),
        };
        let values = match kind {
            EffectKind::CubicStiffness => vec![k / (motion * motion)],
            EffectKind::Friction => {
                let stiffness = k * uniform(rng, 0.2, 1.0);
                vec![stiffness * motion * uniform(rng, 0.1, 0.5), stiffness]
            }
            _ => vec![motion, k * log_uniform(rng, 0.1, 1.0)],
        };
        Some(Effect::new(kind, Place::Joint(joint.name.clone()), Some(dof), &values))
    }

    fn of_the_instrument(&self, rng: &mut impl Rng, kind: EffectKind) -> Option<Effect> {
        let pair = choice(rng, self.recorded)?;
        let on_response = sign(rng) > 0.0;
        let channel = if on_response { &pair.response } else { &pair.reference };
        let place = match kind {
            EffectKind::PointOffset => Place::Point(channel.point.clone()),
            EffectKind::ExponentialWindow => Place::All,
            EffectKind::SensorMass => Place::Response(pair.response.to_string()),
            _ if on_response => Place::Response(channel.to_string()),
            _ => Place::Reference(channel.to_string()),
        };
        let value = match kind {
            EffectKind::PointOffset => self.offset(rng, &channel.point)?,
            EffectKind::ChannelGain if uniform(rng, 0.0, 1.0) < 0.2 => -1.0,
            EffectKind::ChannelGain => (sign(rng) * log_uniform(rng, 0.05, 0.5)).exp(),
            EffectKind::ChannelDelay => sign(rng) * log_uniform(rng, 1e-5, 1e-4),
            EffectKind::SensorMass => log_uniform(rng, 0.002, 0.02),
            EffectKind::ChannelHighpass => log_uniform(rng, 0.2, 5.0),
            EffectKind::ChannelResonance => self.highest * log_uniform(rng, 1.5, 6.0),
            _ => log_uniform(rng, 2.0, 20.0),
        };
        let values = match kind {
            EffectKind::ChannelResonance => vec![value, log_uniform(rng, 0.01, 0.05)],
            _ => vec![value],
        };
        Some(Effect::new(kind, place, None, &values))
    }

    /// A displacement of 2 to 9 mm, inwards where the point is near the end of a deformable body; `None` on a
    /// storey, where it makes no difference.
    fn offset(&self, rng: &mut impl Rng, point: &str) -> Option<f64> {
        let point = self.fixture.point(point)?;
        let dx = sign(rng) * log_uniform(rng, 0.002, 0.009);
        match &self.fixture.bodies()[point.body].kind {
            BodyKind::Rigid(rigid) => rigid.rotates.then_some(dx),
            BodyKind::Beam(beam) => {
                let (from, to, x) = (beam.from.value, beam.to.value, point.x.value + dx);
                Some(if x < from || x > to { -dx } else { dx })
            }
        }
    }
}

/// First and last abscissa (m) of a body, that of the uniform bar with its mass and inertia for a block, and
/// its mass (kg).
pub fn extent(body: &Body) -> (f64, f64, f64) {
    match &body.kind {
        BodyKind::Beam(beam) => {
            let (from, to) = (beam.from.value, beam.to.value);
            (from, to, beam.mass_per_length.value * (to - from))
        }
        BodyKind::Rigid(rigid) => {
            let half = rigid.inertia.map_or(0.0, |inertia| (3.0 * inertia.value / rigid.mass.value).sqrt());
            let centre = rigid.x_cg.map_or(0.0, |x| x.value);
            (centre - half, centre + half, rigid.mass.value)
        }
    }
}

/// Transverse and rotational stiffness of a joint at its far end, the other motion held: N/m, N·m/rad.
fn stiffness(fixture: &Fixture, joint: &Joint) -> [f64; 2] {
    match &joint.law {
        JointLaw::Stiffness { stiffness, .. } => [stiffness[0].value, stiffness[2].value],
        JointLaw::Beam { youngs_modulus, second_moment } => {
            let (length, bending) = (fixture.joint_length(joint), youngs_modulus.value * second_moment.value);
            [12.0 * bending / length.powi(3), 4.0 * bending / length]
        }
    }
}
