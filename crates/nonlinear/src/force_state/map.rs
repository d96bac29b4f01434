//! The map of one joint from one hit.

use super::bodies::{BodyMotion, Inertia, MotionSource, applied, inertia, measured};
use super::sides::{check_effects, free, sides};
use crate::settings::map::{DIED_DOWN, FALLS_FROM, ONSET, RISES_FROM};
use crate::spectra::{Windowed, rising};
use crate::time::simulation::simulate_one;
use crate::time::structure::{Reading, effects};
use crate::{ForceStateError, RestoringLaw};
use jointscope_fixture::{Dof, EffectKind, Fixture, Joint, Place};
use jointscope_hits::{Hit, MeasuredMotion, Response};
use jointscope_lumped::nominal_stiffness;
use jointscope_spectra::Channel;
use num_complex::Complex64;
use serde::{Serialize, Serializer};
use std::ops::{Mul, Sub};

/// What a joint bore during a hit against how far and how fast it was moved, as measured.
///
/// The force is the inertia force of the bodies on one side of the joint less the hammer's, so neither the
/// joint's stiffness nor its law enters it. The relative motion d = u_to − R·u_from is integrated from
/// accelerations by 1/(iω)²; below `band.0`, where that drifts, it is the simulated fixture's.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ForceStateMap {
    /// The joint.
    pub joint: String,
    /// Number of the hit.
    pub hit: u32,
    /// Its peak force, N.
    #[serde(skip)]
    pub peak_force: f64,
    /// Where d is measured, Hz; force and d end at the upper limit.
    pub band: (f64, f64),
    /// Bodies whose inertia gives the force.
    #[serde(rename = "force_from_bodies")]
    pub weighed: Vec<String>,
    /// Bodies that the map needs, and where their motion is known from.
    #[serde(rename = "motion_from", serialize_with = "by_body")]
    pub sources: Vec<(String, MotionSource)>,
    /// Deflection, and rotation where the joint's bodies rotate.
    pub components: Vec<ForceState>,
}

fn by_body<S: Serializer>(sources: &[(String, MotionSource)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(sources.iter().map(|(body, source)| (body, source)))
}

/// One component of a [`ForceStateMap`], from the blow until the motion has died down. SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct ForceState {
    /// Which component.
    pub dof: Dof,
    /// d, m or rad.
    pub motion: Vec<f64>,
    /// ḋ, m/s or rad/s.
    pub velocity: Vec<f64>,
    /// What the joint bears on this component, N or N·m, without the part k₁₂ of the other component's
    /// motion.
    pub force: Vec<f64>,
    /// The fixture's own stiffness of this component, N/m or N·m/rad.
    pub stiffness: f64,
    /// The fixture's laws of this component.
    pub laws: Vec<RestoringLaw>,
    /// What these laws bear under d, N or N·m.
    pub law_force: Vec<f64>,
}

/// Of the curves only what they come to.
impl Serialize for ForceState {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Summary {
            dof: Dof,
            explained: Option<f64>,
            dashpot: f64,
        }
        Summary { dof: self.dof, explained: self.explained(), dashpot: self.dashpot() }.serialize(serializer)
    }
}

impl ForceState {
    /// The part of the force that is not the linear spring's: force − k·d.
    pub fn beyond_linear(&self) -> Vec<f64> {
        self.force.iter().zip(&self.motion).map(|(f, d)| f - self.stiffness * d).collect()
    }

    /// What neither the linear spring nor the laws bear.
    pub fn left_over(&self) -> Vec<f64> {
        self.beyond_linear().iter().zip(&self.law_force).map(|(r, g)| r - g).collect()
    }

    /// Share of the mean square of [`ForceState::beyond_linear`] that the laws explain; `None` without laws.
    pub fn explained(&self) -> Option<f64> {
        let power = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>();
        let all = power(&self.beyond_linear());
        (!self.laws.is_empty() && all > 0.0).then(|| 1.0 - power(&self.left_over()) / all)
    }

    /// The dashpot that takes most of what is left over, N·s/m or N·m·s/rad.
    pub fn dashpot(&self) -> f64 {
        let left = self.left_over();
        let power: f64 = self.velocity.iter().map(|v| v * v).sum();
        let work: f64 = left.iter().zip(&self.velocity).map(|(f, v)| f * v).sum();
        if power > 0.0 { work / power } else { 0.0 }
    }
}

impl ForceStateMap {
    /// The map of `joint` under `hit`, with the mass properties, stiffness and laws of `fixture`; `band` is
    /// where d is taken from the sensors, Hz.
    ///
    /// # Errors
    /// A joint both of whose sides are held, deformable, or not followed by enough sensors; effects that make
    /// bodies bear more than their inertia.
    pub fn of(fixture: &Fixture, joint: &str, hit: &Hit, band: (f64, f64)) -> Result<Self, ForceStateError> {
        let unknown = || ForceStateError::UnknownJoint(joint.to_owned());
        let joint = fixture.joint(joint).ok_or_else(unknown)?;
        check_effects(fixture)?;
        let sides = sides(fixture, joint)?;
        let lines = Windowed::padded(vec![1.0; hit.samples()], hit.interval());
        let motions = measured(fixture, hit, &lines);
        let side = weighed(fixture, joint, &sides, &motions)?;
        let ends = [joint.to, joint.from];
        let (slow, accelerations) = ends_simulated(fixture, hit, &lines, ends)?;
        let [to, from] = [0, 1].map(|end| {
            let point = &fixture.points()[ends[end]];
            let (Some((_, [a, turn])), Some(body)) = (&motions[point.body], inertia(fixture, point.body))
            else {
                return accelerations[end].clone();
            };
            let arm = point.x.value - body.x_cg;
            [a.iter().zip(turn).map(|(a, turn)| a + turn * arm).collect(), turn.clone()]
        });
        let rates: BodyMotion = across(&to, &from, fixture.joint_length(joint));
        let motion = |component: usize| -> Vec<Complex64> {
            let line = |(i, (rate, slow)): (usize, (&Complex64, &Complex64))| {
                let high = rising(lines.frequency_hz(i), RISES_FROM * band.0, band.0);
                let fast = if high > 0.0 { rate / lines.s(i).powi(2) * high } else { Complex64::ZERO };
                (fast + slow * (1.0 - high)) * upper(lines.frequency_hz(i), band.1)
            };
            rates[component].iter().zip(&slow[component]).enumerate().map(line).collect()
        };
        let force = force(fixture, joint, hit, &lines, &side, &motions, band.1);
        let d = [motion(0), motion(1)];
        let (_, bodies) = side;
        let rotates = ends.into_iter().all(|p| rotates(fixture, p)) && bodies.iter().all(|(_, b)| b.rotates);
        let name = |index: usize| fixture.bodies()[index].name.clone();
        let mut needed: Vec<usize> = bodies.iter().map(|(i, _)| *i).collect();
        needed.extend(ends.map(|p| fixture.points()[p].body));
        needed.sort_unstable();
        needed.dedup();
        let source = |i: usize| motions[i].as_ref().map_or(MotionSource::Model, |(source, _)| *source);
        let component = |c: usize| component(fixture, joint, &lines, c, &d, &force);
        let mut map = ForceStateMap {
            joint: joint.name.clone(),
            hit: hit.number(),
            peak_force: hit.peak_force(),
            band,
            weighed: bodies.iter().map(|(i, _)| name(*i)).collect(),
            sources: needed.into_iter().map(|i| (name(i), source(i))).collect(),
            components: (0..if rotates { 2 } else { 1 }).map(component).collect(),
        };
        map.trim(hit);
        Ok(map)
    }

    /// Leaves what lies between the blow's beginning and the end of larger motion.
    fn trim(&mut self, hit: &Hit) {
        let onset = hit.force().iter().position(|f| f.abs() > ONSET * hit.peak_force()).unwrap_or(0);
        let last = |c: &ForceState| {
            let largest = c.motion.iter().fold(0.0, |most: f64, d| d.abs().max(most));
            c.motion.iter().rposition(|d| d.abs() > DIED_DOWN * largest).unwrap_or(0)
        };
        let end = self.components.iter().map(last).max().unwrap_or(0);
        for c in &mut self.components {
            for values in [&mut c.motion, &mut c.velocity, &mut c.force, &mut c.law_force] {
                values.truncate((end + 1).max(onset + 1));
                values.drain(..onset.min(values.len()));
            }
        }
    }
}

/// 1 up to four fifths of `highest`, then falling to 0 there.
fn upper(frequency: f64, highest: f64) -> f64 {
    1.0 - rising(frequency, FALLS_FROM * highest, highest)
}

/// d = u_to − R·u_from, deflection and rotation.
fn across<T>(to: &[Vec<T>; 2], from: &[Vec<T>; 2], length: f64) -> [Vec<T>; 2]
where
    T: Copy + Sub<Output = T> + Mul<f64, Output = T>,
{
    let deflection = (0..to[0].len()).map(|i| to[0][i] - from[0][i] - from[1][i] * length);
    [deflection.collect(), to[1].iter().zip(&from[1]).map(|(to, from)| *to - *from).collect()]
}

fn rotates(fixture: &Fixture, point: usize) -> bool {
    fixture.bodies()[fixture.points()[point].body].kind.rotates()
}

type Side = (f64, Vec<(usize, Inertia)>);

/// The side whose inertia gives the force: free, rigid, its motion measured, by its own sensors if possible.
/// With it the sign by which what its bodies feel is the joint's force.
fn weighed(
    fixture: &Fixture,
    joint: &Joint,
    sides: &[Vec<usize>; 2],
    motions: &[Option<(MotionSource, BodyMotion)>],
) -> Result<Side, ForceStateError> {
    let name = || joint.name.clone();
    let mut why = ForceStateError::Supported(name());
    let mut best: Option<(bool, Side)> = None;
    for (sign, side) in [-1.0, 1.0].into_iter().zip(sides) {
        if !free(fixture, side) {
            continue;
        }
        let bodies: Option<Vec<(usize, Inertia)>> =
            side.iter().map(|&i| inertia(fixture, i).map(|inertia| (i, inertia))).collect();
        let Some(bodies) = bodies else {
            why = ForceStateError::Deformable(name());
            continue;
        };
        let unseen = side.iter().filter(|i| motions[**i].is_none());
        let unseen: Vec<&str> = unseen.map(|i| fixture.bodies()[*i].name.as_str()).collect();
        if !unseen.is_empty() {
            why = ForceStateError::TooFewSensors { joint: name(), bodies: unseen.join(", ") };
            continue;
        }
        let own = side.iter().all(|&i| matches!(motions[i], Some((MotionSource::Sensors, _))));
        if best.as_ref().is_none_or(|(before, _)| own && !before) {
            best = Some((own, (sign, bodies)));
        }
    }
    best.map(|(_, side)| side).ok_or(why)
}

/// The relative motion d that the fixture shows, and the accelerations of the joint's ends, far end first.
fn ends_simulated(
    fixture: &Fixture,
    hit: &Hit,
    lines: &Windowed,
    ends: [usize; 2],
) -> Result<(BodyMotion, [BodyMotion; 2]), ForceStateError> {
    let channels = ends.map(|end| {
        let point = &fixture.points()[end].name;
        let rotation = rotates(fixture, end).then(|| Channel::rotational(point.clone()));
        [Some(Channel::transverse(point.clone())), rotation]
    });
    let of = |motion: MeasuredMotion| channels.iter().flatten().flatten().map(move |c| (c.clone(), motion));
    let readings: Vec<Reading> =
        of(MeasuredMotion::Displacement).chain(of(MeasuredMotion::Acceleration)).collect();
    let (simulated, _) = simulate_one(fixture, hit, &readings)?;
    let moved = |end: usize, motion: MeasuredMotion| {
        channels[end].each_ref().map(|channel| {
            let is_it = |r: &&Response| r.motion == motion && Some(&r.channel) == channel.as_ref();
            let read = simulated.responses().iter().find(is_it);
            read.map_or_else(|| vec![0.0; hit.samples()], |r| r.values.clone())
        })
    };
    let [to, from] = [0, 1].map(|end| moved(end, MeasuredMotion::Displacement));
    let length = fixture.points()[ends[0]].x.value - fixture.points()[ends[1]].x.value;
    // What carries the whole assembly along would swamp its lines, so d is formed before the transform.
    let d = across(&to, &from, length).map(|values| lines.lines(&values));
    let accelerated =
        [0, 1].map(|end| moved(end, MeasuredMotion::Acceleration).map(|values| lines.lines(&values)));
    Ok((d, accelerated))
}

/// What the joint bears: the inertia force of the weighed bodies less the hammer's, at the abscissa of its
/// far end, where R carries both components.
fn force(
    fixture: &Fixture,
    joint: &Joint,
    hit: &Hit,
    lines: &Windowed,
    (sign, bodies): &Side,
    motions: &[Option<(MotionSource, BodyMotion)>],
    highest: f64,
) -> [Vec<Complex64>; 2] {
    let x = fixture.points()[joint.to].x.value;
    let struck = fixture.point(&hit.struck().point).map(|p| p.body);
    let hammer = match bodies.iter().any(|(i, _)| Some(*i) == struck) {
        true => applied(fixture, hit, x),
        false => [0.0; 2],
    };
    let mut force = hammer.map(|part| lines.lines(hit.force()).iter().map(|f| -part * f).collect::<Vec<_>>());
    for (index, body) in bodies {
        let Some((_, [a, turn])) = &motions[*index] else { continue };
        let [push, moment] = &mut force;
        for (((push, moment), a), turn) in push.iter_mut().zip(moment).zip(a).zip(turn) {
            *push += a * body.mass;
            *moment += turn * body.inertia + a * (body.mass * (body.x_cg - x));
        }
    }
    force.map(|part| {
        let limited = part.into_iter().enumerate();
        limited.map(|(i, f)| f * *sign * upper(lines.frequency_hz(i), highest)).collect()
    })
}

fn component(
    fixture: &Fixture,
    joint: &Joint,
    lines: &Windowed,
    own: usize,
    d: &[Vec<Complex64>; 2],
    force: &[Vec<Complex64>; 2],
) -> ForceState {
    let dof = [Dof::Translation, Dof::Rotation][own];
    let nominal = nominal_stiffness(&joint.law, fixture.joint_length(joint));
    let here = || Place::Joint(joint.name.clone());
    let changes = effects(fixture, EffectKind::StiffnessChange, here());
    let factor: f64 = changes.map(|e| e.value(0)).product();
    let coupling = nominal.at(own, 1 - own) * factor;
    let motion = lines.signal(d[own].clone());
    let laws: Vec<RestoringLaw> = fixture
        .physics()
        .iter()
        .filter(|e| e.dof == Some(dof) && e.place == here())
        .filter_map(RestoringLaw::of)
        .collect();
    let mut law_force = vec![0.0; motion.len()];
    for law in &laws {
        law_force.iter_mut().zip(law.forces(&motion)).for_each(|(sum, force)| *sum += force);
    }
    ForceState {
        dof,
        velocity: lines.signal(d[own].iter().enumerate().map(|(i, d)| d * lines.s(i)).collect()),
        force: lines.signal(force[own].iter().zip(&d[1 - own]).map(|(f, d)| f - d * coupling).collect()),
        stiffness: nominal.at(own, own) * factor,
        motion,
        laws,
        law_force,
    }
}
