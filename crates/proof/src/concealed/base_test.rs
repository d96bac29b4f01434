//! What there is to conceal in a fixture and a recording, and the drawing of it.

use super::fixture_edit::{entries, is_stiffness, with_mass, with_point_moved, with_stiffness};
use super::recording_edit::{Side, exchanged, with_signal};
use super::{ConcealmentError, ConcealmentKind, Expected};
use crate::Case;
use crate::random::log_uniform;
use jointscope_fixture::{
    Effect, EffectKind, Fixture, NamedQuantity, Place, QuantityKey, QuantityOwner, SupportPlace,
};
use jointscope_rig::extent;
use jointscope_spectra::{Channel, Dof, FrfSet};
use num_complex::Complex64;
use rand::{Rng, RngExt};

/// The fixture that explains a recording, and the recording.
pub(super) struct BaseTest<'a> {
    pub explaining: &'a Fixture,
    pub recorded: &'a FrfSet,
}

/// A case with what was concealed in it.
pub(super) struct Drawn {
    pub case: Case,
    pub what: String,
    pub expected: Vec<Expected>,
}

/// Relative sizes of a mass that is not there.
const MASS: [f64; 2] = [0.01, 0.1];
/// |ln factor| of a channel's gain.
const GAIN: [f64; 2] = [0.05, 0.5];
/// Phase by which a delay turns the highest line, rad.
const DELAY: [f64; 2] = [0.06, 0.6];
/// Distance by which a point is moved, m, and at the least in its standard deviations: less would be
/// tolerance.
const OFFSET: [f64; 2] = [0.002, 0.009];
const OFFSET_DEVIATIONS: [f64; 2] = [5.0, 12.0];
/// |ln factor| of a stiffness, and at the least in its relative deviations.
const FACTOR: [f64; 2] = [0.1, 0.5];
const FACTOR_DEVIATIONS: f64 = 5.0;
/// |ln factor| beyond which a structure is no longer recognised.
const FACTOR_MOST: f64 = 1.1;

impl BaseTest<'_> {
    /// Whether there is anything of a kind to conceal.
    pub(super) fn has_room_for(&self, kind: ConcealmentKind) -> bool {
        match kind {
            ConcealmentKind::Entry => !entries(self.explaining).is_empty(),
            ConcealmentKind::Mass => true,
            ConcealmentKind::Stiffness => !self.stiffnesses().is_empty(),
            ConcealmentKind::Point => !self.free_points().is_empty(),
            ConcealmentKind::Gain | ConcealmentKind::Sign | ConcealmentKind::Delay => {
                self.recorded.all_values().iter().any(|value| value.norm_sqr() > 0.0)
            }
            ConcealmentKind::Exchange => !self.exchanges().is_empty(),
        }
    }

    /// Conceals something of a kind; `None` where what was drawn is impossible, and another draw may be
    /// possible.
    pub(super) fn draw(
        &self,
        kind: ConcealmentKind,
        random: &mut impl Rng,
    ) -> Result<Option<Drawn>, ConcealmentError> {
        match kind {
            ConcealmentKind::Entry => self.entry(random),
            ConcealmentKind::Mass => self.mass(random),
            ConcealmentKind::Stiffness => Ok(self.stiffness(random)),
            ConcealmentKind::Point => Ok(self.point(random)),
            ConcealmentKind::Gain | ConcealmentKind::Sign | ConcealmentKind::Delay => {
                self.channel(kind, random)
            }
            ConcealmentKind::Exchange => self.exchange(random),
        }
    }

    fn entry(&self, random: &mut impl Rng) -> Result<Option<Drawn>, ConcealmentError> {
        let Some(entry) = choice(random, &entries(self.explaining)).copied() else { return Ok(None) };
        let believed = entry.deleted(self.explaining)?;
        let what = format!("{} deleted from the fixture", entry.path(self.explaining));
        Ok(Some(self.misstated(believed, what, entry.as_effect(self.explaining))))
    }

    fn mass(&self, random: &mut impl Rng) -> Result<Option<Drawn>, ConcealmentError> {
        let index = random.random_range(0..self.explaining.bodies().len());
        let name = &self.explaining.bodies()[index].name;
        let (from, to, whole) = extent(&self.explaining.bodies()[index]);
        let x = if to > from { random.random_range(from..to) } else { from };
        let mass = whole * log_uniform(random, MASS);
        let believed = with_mass(self.explaining, name, x, mass)?;
        let what = format!("a mass of {mass:.4} kg at {x:.4} m stated on {name}, where there is none");
        let missing = Effect::new(EffectKind::AddedMass, Place::Body(name.clone()), None, &[x, -mass]);
        Ok(Some(self.misstated(believed, what, missing)))
    }

    fn stiffness(&self, random: &mut impl Rng) -> Option<Drawn> {
        let (place, owner, deviation) = choice(random, &self.stiffnesses())?.clone();
        let least = FACTOR[0].max(FACTOR_DEVIATIONS * deviation);
        let most = FACTOR[1].max(2.0 * least).min(FACTOR_MOST);
        if least >= most {
            return None;
        }
        let factor = (sign(random) * log_uniform(random, [least, most])).exp();
        let believed = with_stiffness(self.explaining, owner, factor).ok()?;
        let what = format!("stiffness of {place} stated {factor:.4} times as large");
        let change = Effect::new(EffectKind::StiffnessChange, place, None, &[1.0 / factor]);
        Some(self.misstated(believed, what, change))
    }

    fn point(&self, random: &mut impl Rng) -> Option<Drawn> {
        let &(index, std) = choice(random, &self.free_points())?;
        let name = self.explaining.points()[index].name.clone();
        let range = [0, 1].map(|i| OFFSET[i].max(OFFSET_DEVIATIONS[i] * std));
        let dx = sign(random) * log_uniform(random, range);
        // A beam ends somewhere.
        let believed = with_point_moved(self.explaining, index, dx).ok()?;
        let what = format!("point {name} stated {:.2} mm from where it is", 1e3 * dx);
        let offset = Effect::new(EffectKind::PointOffset, Place::Point(name), None, &[-dx]);
        Some(self.misstated(believed, what, offset))
    }

    fn channel(
        &self,
        kind: ConcealmentKind,
        random: &mut impl Rng,
    ) -> Result<Option<Drawn>, ConcealmentError> {
        let (side, channel) = match choice(random, &self.channels()) {
            Some(drawn) => drawn.clone(),
            None => return Ok(None),
        };
        let place = format!("{} {channel}", side.name());
        let highest = self.recorded.lines().omegas().last().unwrap_or(1.0);
        let (what, of, value, done) = match kind {
            ConcealmentKind::Delay => {
                let seconds = sign(random) * log_uniform(random, DELAY) / highest;
                let late =
                    with_signal(self.recorded, side, &channel, |w| Complex64::from_polar(1.0, -w * seconds))?;
                (
                    format!("{place} delayed by {:.2} microseconds", 1e6 * seconds),
                    EffectKind::ChannelDelay,
                    seconds,
                    late,
                )
            }
            _ => {
                let factor = match kind {
                    ConcealmentKind::Sign => -1.0,
                    _ => (sign(random) * log_uniform(random, GAIN)).exp(),
                };
                let scaled = with_signal(self.recorded, side, &channel, |_| Complex64::new(factor, 0.0))?;
                (format!("{place} scaled by {factor:.4}"), EffectKind::ChannelGain, factor, scaled)
            }
        };
        let expected = self.of_channel(of, side, &channel, value);
        let case = Case { believed: self.explaining.clone(), recorded: done };
        Ok(Some(Drawn { case, what, expected: vec![expected] }))
    }

    fn exchange(&self, random: &mut impl Rng) -> Result<Option<Drawn>, ConcealmentError> {
        let Some((side, [one, other])) = choice(random, &self.exchanges()).cloned() else { return Ok(None) };
        let done = exchanged(self.recorded, side, [&one, &other])?;
        let what = format!("{}s {one} and {other} exchanged", side.name());
        let case = Case { believed: self.explaining.clone(), recorded: done };
        Ok(Some(Drawn { case, what, expected: self.as_offsets(side, [&one, &other]) }))
    }

    fn misstated(&self, believed: Fixture, what: String, missing: Effect) -> Drawn {
        let expected = match &missing.place {
            Place::Response(name) | Place::Reference(name)
                if matches!(missing.kind, EffectKind::ChannelGain | EffectKind::ChannelDelay) =>
            {
                let side = if matches!(missing.place, Place::Response(_)) {
                    Side::Response
                } else {
                    Side::Reference
                };
                let channels = side.channels(self.recorded.pairs());
                let channel = channels.into_iter().find(|channel| channel.is_named(name));
                channel.map(|channel| self.of_channel(missing.kind, side, &channel, missing.value(0)))
            }
            _ => None,
        };
        let expected = expected.unwrap_or(Expected { effect: missing, same: Vec::new() });
        let case = Case { believed, recorded: self.recorded.clone() };
        Drawn { case, what, expected: vec![expected] }
    }

    /// A gain or delay of a channel, and those of other channels that do the same to all that was recorded:
    /// of a channel that is read in the same FRFs.
    fn of_channel(&self, kind: EffectKind, side: Side, channel: &Channel, value: f64) -> Expected {
        let pairs = self.recorded.pairs();
        let effect = |side: Side, channel: &Channel, value: f64| {
            let place = match side {
                Side::Response => Place::Response(channel.to_string()),
                Side::Reference => Place::Reference(channel.to_string()),
            };
            Effect::new(kind, place, None, &[value])
        };
        let frfs = side.frfs(channel, pairs);
        let opposite = if kind == EffectKind::ChannelDelay { -value } else { 1.0 / value };
        let others = self.channels().into_iter().filter(|(s, c)| (*s, c) != (side, channel));
        let alike = others.filter(|(s, c)| s.frfs(c, pairs) == frfs);
        let same = alike.map(|(s, c)| effect(s, &c, if s == side { value } else { opposite })).collect();
        Expected { effect: effect(side, channel, value), same }
    }

    /// An exchange of two channels as two points that are where the other is said to be; none where it is
    /// more than that.
    fn as_offsets(&self, side: Side, [one, other]: [&Channel; 2]) -> Vec<Expected> {
        let pairs = self.recorded.pairs();
        let point = |channel: &Channel| self.explaining.point(&channel.point);
        let (Some(a), Some(b)) = (point(one), point(other)) else { return Vec::new() };
        let only_here = |channel: &Channel| {
            let reads = |side: Side| side.channels(pairs).iter().filter(|c| c.point == channel.point).count();
            channel.dof == Dof::Translation && reads(Side::Response) + reads(Side::Reference) == 1
        };
        let corrected = |channel: &Channel| {
            let name = channel.to_string();
            self.explaining.physics().iter().any(|effect| match &effect.place {
                Place::Point(place) => effect.kind == EffectKind::PointOffset && *place == channel.point,
                Place::Response(place) => side == Side::Response && *place == name,
                Place::Reference(place) => side == Side::Reference && *place == name,
                _ => false,
            })
        };
        let plain = [one, other].into_iter().all(|channel| only_here(channel) && !corrected(channel));
        if a.body != b.body || !self.explaining.bodies()[a.body].kind.rotates() || !plain {
            return Vec::new();
        }
        let offset = |point: &str, dx: f64| Expected {
            effect: Effect::new(EffectKind::PointOffset, Place::Point(point.to_owned()), None, &[dx]),
            same: Vec::new(),
        };
        let apart = b.x.value - a.x.value;
        vec![offset(&a.name, apart), offset(&b.name, -apart)]
    }

    /// Joints and beam bodies whose stiffness is known, with its relative deviation.
    fn stiffnesses(&self) -> Vec<(Place, QuantityOwner, f64)> {
        let joints = self.explaining.joints().iter().enumerate();
        let joints = joints.map(|(i, joint)| (Place::Joint(joint.name.clone()), QuantityOwner::Joint(i)));
        let bodies = self.explaining.bodies().iter().enumerate();
        let beams = bodies.filter(|(_, body)| body.kind.is_beam());
        let beams = beams.map(|(i, body)| (Place::Body(body.name.clone()), QuantityOwner::Body(i)));
        let quantities = self.explaining.quantities();
        let relative = |q: &NamedQuantity| q.std.map(|std| std / q.value.abs());
        let known = |(place, owner): (Place, QuantityOwner)| {
            let own = || quantities.iter().filter(|q| q.owner == owner);
            // Young's modulus and second moment are one stiffness.
            let area = own().find(|q| q.key == QuantityKey::SecondMoment).map_or(Some(0.0), relative)?;
            let each = own().filter(|q| is_stiffness(q.key)).map(|q| Some(relative(q)?.hypot(area)));
            // A coupling of zero has no relative deviation, and none is needed of it.
            let all = each.collect::<Option<Vec<f64>>>()?.into_iter().filter(|d| d.is_finite());
            let largest = all.fold(0.0, f64::max);
            (FACTOR_DEVIATIONS * largest < FACTOR_MOST).then_some((place, owner, largest))
        };
        joints.chain(beams).filter_map(known).collect()
    }

    /// Points at which something was recorded and nothing else sits, with their standard deviations.
    fn free_points(&self) -> Vec<(usize, f64)> {
        let fixture = self.explaining;
        let pairs = self.recorded.pairs();
        let is_free = |index: usize| {
            let holds = fixture.joints().iter().any(|joint| joint.from == index || joint.to == index);
            let rests =
                fixture.supports().iter().any(|s| matches!(s.place, SupportPlace::Point(at) if at == index));
            let point = &fixture.points()[index];
            let read =
                pairs.iter().any(|p| [&p.response, &p.reference].iter().any(|c| c.point == point.name));
            !holds && !rests && read && fixture.bodies()[point.body].kind.rotates()
        };
        let known = |quantity: NamedQuantity| match quantity.owner {
            QuantityOwner::Point(index) if is_free(index) => Some((index, quantity.std?)),
            _ => None,
        };
        fixture.quantities().into_iter().filter_map(known).collect()
    }

    fn channels(&self) -> Vec<(Side, Channel)> {
        let pairs = self.recorded.pairs();
        Side::BOTH.iter().flat_map(|side| side.channels(pairs).into_iter().map(|c| (*side, c))).collect()
    }

    /// Pairs of channels of one side and degree of freedom.
    fn exchanges(&self) -> Vec<(Side, [Channel; 2])> {
        let mut all = Vec::new();
        for side in Side::BOTH {
            let channels = side.channels(self.recorded.pairs());
            for (index, one) in channels.iter().enumerate() {
                let others = channels[index + 1..].iter().filter(|other| other.dof == one.dof);
                all.extend(others.map(|other| (side, [one.clone(), other.clone()])));
            }
        }
        all
    }
}

fn choice<'a, T>(random: &mut impl Rng, of: &'a [T]) -> Option<&'a T> {
    if of.is_empty() { None } else { of.get(random.random_range(0..of.len())) }
}

fn sign(random: &mut impl Rng) -> f64 {
    if random.random_range(0..2) == 0 { 1.0 } else { -1.0 }
}
