//! All joints in one Gaussian: their numbers, and how the errors of one are those of another.
//!
//! Each fit tells of its joint and of the fixture's quantities what a Gaussian likelihood does. Of joints tested on the same blocks these quantities are the same:
//! the likelihoods are multiplied, with one set of quantities, whose prior enters once. The posterior then has both joints, and what the blocks' tolerances do to one they do to
//! the other: it cancels in their difference. What the fits get wrong besides is added to each joint by itself, what laws over frequency differ by to joints of one law
//! [together](CommonLaw).
//!
//! Where the common quantities are farther from what is stated than chance takes them, the posterior is widened by Birge's ratio, as that of one fit is: each group of joints
//! that bodies connect by its own.
//!
//! A body is the same in two tests where both fixtures say the same of it: every quantity of it and of the points on it that either fit moved has the same value and standard
//! deviation in both. Supports, damping, channels and other joints are taken as set up anew.
//!
//! A joint whose C is held where it just gives out no energy keeps what its file states: the likelihood is that of a C without this constraint, and with it the joint would be one that
//! physics forbids.

use crate::common_law::CommonLaw;
use crate::{Decomposed, Estimate, FiledJoint, Number, StatedQuantity};
use jointscope_inference::NormalEquations;
use serde::Serialize;
use statrs::function::gamma::gamma_ur;
use std::collections::{BTreeMap, BTreeSet};

/// The numbers of all joints with their covariance.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Together {
    count: usize,
    mean: Vec<f64>,
    covariance: Vec<f64>,
    /// Whether the files say how the errors of one joint's numbers go together.
    pub has_covariances: bool,
    /// Bodies that several tests share.
    pub shared: Vec<SharedBody>,
    /// Joints that share nothing, and why.
    pub apart: Vec<Apart>,
    /// Joints that are taken to follow one law over frequency, group by group.
    pub one_law: Vec<Vec<String>>,
    /// Paths of quantities that not all fixtures state alike, where that keeps a body from being the same.
    pub differing: Vec<String>,
}

/// A body that several tests have in common.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct SharedBody {
    /// Its name.
    pub body: String,
    /// The joints tested on it.
    pub joints: Vec<String>,
    /// Paths of its quantities that more than one of the fits moved.
    pub quantities: Vec<String>,
}

/// A joint whose errors are taken as its own.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Apart {
    /// Which.
    pub joint: String,
    /// Why.
    pub why: WhyApart,
}

/// Why a joint shares no quantity with the others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum WhyApart {
    /// It was asked for.
    Asked,
    /// Its file does not say how the fixture's quantities act on it: an earlier version's, or one without a fit to all FRFs.
    NotStated,
    /// Its FRFs contradict those of another test on the quantities that the fixtures state alike: the bodies are not the same, or the fit bends them for something else.
    Disagrees,
    /// Its C is held where it just gives out no energy, which what its FRFs alone tell knows nothing of.
    OnTheBoundary,
    /// The other tests on the bodies that its fixture states are themselves taken apart.
    LeftAlone,
    /// No other fixture says the same of a body.
    OtherBodies,
    /// Its numbers and quantities cannot be told apart to working precision.
    Singular,
}

/// How a test's fit enters: where its numbers are and which coordinate each of its quantities is.
struct Part<'a> {
    joint: usize,
    fit: &'a FiledJoint,
    /// By quantity: the body's first test with the same statement, or the joint itself for what is its own.
    owners: Vec<usize>,
}

impl Together {
    /// Of joints compared by independent estimates.
    pub(crate) fn independent(estimates: &[Estimate], numbers: &[Number]) -> Self {
        let count = numbers.len();
        let mut together = Together::empty(estimates.len(), count);
        for (joint, estimate) in estimates.iter().enumerate() {
            for (index, number) in numbers.iter().enumerate() {
                let (value, std) = number.of(estimate);
                together.mean[joint * count + index] = value;
                together.put((joint, index), (joint, index), std * std);
            }
        }
        together
    }

    /// Of joints fitted to all FRFs; `asked_apart` takes them all as tested on blocks of their own.
    pub(crate) fn of(joints: &[Decomposed], numbers: &[Number], asked_apart: bool) -> Self {
        let mut together = Together::empty(joints.len(), numbers.len());
        together.has_covariances = true;
        for (joint, fit) in joints.iter().enumerate().filter_map(|(i, j)| Some((i, j.fitted.as_ref()?))) {
            together.put_alone(joint, fit, numbers);
        }
        let mut why: Vec<Option<WhyApart>> = joints
            .iter()
            .map(|joint| match &joint.fitted {
                _ if asked_apart => Some(WhyApart::Asked),
                Some(fit) if fit.likelihood().is_some() => None,
                _ => Some(WhyApart::NotStated),
            })
            .collect();
        let has_company = in_company(joints, &why);
        let on_the_boundary =
            |joint: &Decomposed| joint.fitted.as_ref().is_some_and(|fit| fit.on_the_boundary_of_passive);
        for (why, joint) in why.iter_mut().zip(joints) {
            if why.is_none() && on_the_boundary(joint) {
                *why = Some(WhyApart::OnTheBoundary);
            }
        }
        let groups = loop {
            let parts = parts(joints, &why);
            together.shared = shared(joints, &parts);
            if let Some(odd) = together.most_at_odds(joints) {
                why[odd] = Some(WhyApart::Disagrees);
                continue;
            }
            let (groups, alone) = connected(parts);
            for joint in alone {
                why[joint] =
                    Some(if has_company[joint] { WhyApart::LeftAlone } else { WhyApart::OtherBodies });
            }
            break groups;
        };
        for group in &groups {
            if together.tie(group, numbers).is_some() {
                continue;
            }
            let names = |part: &Part| joints[part.joint].name.clone();
            let of_it: Vec<String> = group.iter().map(names).collect();
            together.shared.retain(|body| body.joints.iter().all(|name| !of_it.contains(name)));
            group.iter().for_each(|part| why[part.joint] = Some(WhyApart::Singular));
        }
        for law in CommonLaw::of(joints) {
            together.put_law(&law, joints, numbers);
        }
        let apart = |(joint, why): (usize, &Option<WhyApart>)| {
            Some(Apart { joint: joints[joint].name.clone(), why: (*why)? })
        };
        if !asked_apart {
            together.differing = differing(joints);
        }
        together.apart = why.iter().enumerate().filter_map(apart).collect();
        together
    }

    fn empty(joints: usize, count: usize) -> Self {
        let n = joints * count;
        Together {
            count,
            mean: vec![0.0; n],
            covariance: vec![0.0; n * n],
            has_covariances: false,
            shared: Vec::new(),
            apart: Vec::new(),
            one_law: Vec::new(),
            differing: Vec::new(),
        }
    }

    fn put(&mut self, a: (usize, usize), b: (usize, usize), value: f64) {
        let n = self.mean.len();
        self.covariance[(a.0 * self.count + a.1) * n + b.0 * self.count + b.1] = value;
    }

    /// A fit as its file states it.
    fn put_alone(&mut self, joint: usize, fit: &FiledJoint, numbers: &[Number]) {
        let six = fit.six();
        for (a, number) in numbers.iter().enumerate() {
            self.mean[joint * self.count + a] = six[number.slot()];
            for (b, other) in numbers.iter().enumerate() {
                self.put((joint, a), (joint, b), fit.covariance[number.slot()][other.slot()]);
            }
        }
    }

    /// Replaces what the laws make of each of these joints by what one law makes of all.
    fn put_law(&mut self, law: &CommonLaw, joints: &[Decomposed], numbers: &[Number]) {
        for (a, &joint) in law.joints.iter().enumerate() {
            let own = joints[joint].fitted.as_ref().map_or([[0.0; 6]; 6], |fit| fit.law_covariance);
            for (b, &other) in law.joints.iter().enumerate() {
                for (i, number) in numbers.iter().enumerate() {
                    for (j, with) in numbers.iter().enumerate() {
                        let (m, n) = (number.slot(), with.slot());
                        let before = self.covariance((joint, i), (other, j));
                        let alone = if a == b { own[m][n] } else { 0.0 };
                        self.put((joint, i), (other, j), before - alone + law.covariance((a, m), (b, n)));
                    }
                }
            }
        }
        self.one_law.push(law.joints.iter().map(|&joint| joints[joint].name.clone()).collect());
    }

    /// Puts in the posterior of all these fits with the quantities that they share; `None` where it is not determined to working precision.
    fn tie(&mut self, parts: &[Part], numbers: &[Number]) -> Option<()> {
        let mut places: BTreeMap<(&str, usize), usize> = BTreeMap::new();
        let mut likelihoods = Vec::new();
        // The joints' numbers come first.
        let mut order = 0;
        for part in parts {
            let (slots, likelihood) = part.fit.likelihood()?;
            let own: Vec<usize> = (order..order + slots.len()).collect();
            order += slots.len();
            likelihoods.push((slots, likelihood, own));
        }
        let mut precision = Vec::new();
        for part in parts {
            for (quantity, owner) in part.fit.quantities.iter().zip(&part.owners) {
                places.entry((&quantity.path, *owner)).or_insert_with(|| {
                    precision.push(if quantity.std.is_some() { 1.0 } else { 0.0 });
                    order + precision.len() - 1
                });
            }
        }
        // About the joints as fitted, the quantities as stated.
        let mut reference = vec![0.0; order + precision.len()];
        for (slots, likelihood, own) in &likelihoods {
            reference[own[0]..own[0] + slots.len()].copy_from_slice(&likelihood.at[..slots.len()]);
        }
        let mut equations = NormalEquations::zero(reference.len());
        for (part, (_, likelihood, own)) in parts.iter().zip(&likelihoods) {
            let quantities = part.fit.quantities.iter().zip(&part.owners);
            let quantities = quantities.map(|(quantity, owner)| places[&(quantity.path.as_str(), *owner)]);
            let all: Vec<usize> = own.iter().copied().chain(quantities).collect();
            likelihood.add_to(&mut equations, &reference, &all);
        }
        precision.iter().enumerate().for_each(|(i, p)| equations.add_prior(order + i, *p, 0.0));
        let (step, covariance) = (equations.step(0.0)?, equations.covariance()?);
        let quantities = precision.iter().enumerate().filter(|(_, p)| **p > 0.0).map(|(i, _)| order + i);
        let departures = quantities.map(|i| (step[i] * step[i], 1.0 - covariance.at(i, i)));
        let strain = strain(departures);
        let own_place = |part: usize, slot: usize| {
            let (slots, _, own) = &likelihoods[part];
            slots.iter().position(|other| *other == slot).map(|index| own[index])
        };
        for (a, one) in parts.iter().enumerate() {
            for (i, number) in numbers.iter().enumerate() {
                let Some(row) = own_place(a, number.slot()) else { continue };
                self.mean[one.joint * self.count + i] = reference[row] + step[row];
                for (b, other) in parts.iter().enumerate() {
                    for (j, with) in numbers.iter().enumerate() {
                        let Some(column) = own_place(b, with.slot()) else { continue };
                        let own = if a == b { one.fit.added(number.slot(), with.slot()) } else { 0.0 };
                        self.put((one.joint, i), (other.joint, j), strain * covariance.at(row, column) + own);
                    }
                }
            }
        }
        Some(())
    }

    /// A joint's number.
    pub fn value(&self, joint: usize, number: usize) -> f64 {
        self.mean[joint * self.count + number]
    }

    /// Covariance of a joint's number and another's.
    pub fn covariance(&self, (joint, number): (usize, usize), (other, with): (usize, usize)) -> f64 {
        let n = self.mean.len();
        self.covariance[(joint * self.count + number) * n + other * self.count + with]
    }

    /// Standard deviation of a joint's number.
    pub fn std(&self, joint: usize, number: usize) -> f64 {
        self.covariance((joint, number), (joint, number)).max(0.0).sqrt()
    }
}

/// Probability below which the quantities' departures are no chance, as in the decomposition.
const NO_CHANCE: f64 = 0.01;

/// Birge's ratio of quantities' squared departures from what is stated to what chance makes of them (each given with it); 1 where chance explains them.
fn strain(departures: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (squares, expected) =
        departures.fold((0.0, 0.0), |(s, e), (square, chance)| (s + square, e + chance.clamp(0.0, 1.0)));
    let ratio: f64 = squares / expected;
    let by_chance = |ratio: f64| gamma_ur(0.5 * expected, 0.5 * ratio * expected) >= NO_CHANCE;
    if !(expected > 0.0 && ratio > 1.0) || by_chance(ratio) { 1.0 } else { ratio }
}

impl FiledJoint {
    /// What of a covariance is not that of noise and quantities.
    fn added(&self, m: usize, n: usize) -> f64 {
        self.model_error.covariance[m][n] + self.law_covariance[m][n]
    }
}

/// Whether two fits have a body in common: every quantity of it that one of them moved is stated alike by both, and at least one was moved by both. What one fixture takes as exact and the other
/// does not is not stated alike.
fn is_same(a: &FiledJoint, b: &FiledJoint, body: &str) -> bool {
    let is_stated_by =
        |other: &FiledJoint, quantity: &StatedQuantity| other.statement(&quantity.path) == Some(quantity);
    let moved = |path: &str| b.quantities.iter().any(|other| other.path == path);
    a.of_body(body).all(|quantity| is_stated_by(b, quantity))
        && b.of_body(body).all(|quantity| is_stated_by(a, quantity))
        && a.of_body(body).any(|quantity| moved(&quantity.path))
}

/// Paths of bodies' quantities that one fixture states and another one with this body otherwise or not at all.
fn differing(joints: &[Decomposed]) -> Vec<String> {
    let fits: Vec<&FiledJoint> = joints.iter().filter_map(|joint| joint.fitted.as_ref()).collect();
    let differs = |quantity: &StatedQuantity, body: &str| {
        let others = fits.iter().filter(|fit| fit.of_body(body).next().is_some());
        others.into_iter().any(|fit| fit.statement(&quantity.path) != Some(quantity))
    };
    let moved = fits.iter().flat_map(|fit| &fit.quantities);
    let paths = moved.filter(|q| q.body.as_deref().is_some_and(|body| differs(q, body)));
    paths.map(|quantity| quantity.path.clone()).collect::<BTreeSet<String>>().into_iter().collect()
}

/// The fits that may share quantities: each body belongs to the first test that states the same of it, and with which all that share it agree.
fn parts<'a>(joints: &'a [Decomposed], why: &[Option<WhyApart>]) -> Vec<Part<'a>> {
    let mut parts: Vec<Part> = Vec::new();
    let able = joints.iter().enumerate().filter(|(joint, _)| why[*joint].is_none());
    for (joint, fit) in able.filter_map(|(index, joint)| Some((index, joint.fitted.as_ref()?))) {
        let owner = |body: &str| {
            let sharing = |first: usize| {
                let mut all = parts.iter().filter(move |part| part.owner(body) == Some(first)).peekable();
                all.peek().is_some() && all.all(|part| is_same(part.fit, fit, body))
            };
            parts.iter().map(|part| part.joint).find(|&first| sharing(first)).unwrap_or(joint)
        };
        let owners = fit.quantities.iter().map(|q| q.body.as_deref().map_or(joint, owner)).collect();
        parts.push(Part { joint, fit, owners });
    }
    parts
}

/// Which joints have a body in common with another one's fixture, whatever becomes of the other one.
fn in_company(joints: &[Decomposed], why: &[Option<WhyApart>]) -> Vec<bool> {
    let unless_asked: Vec<Option<WhyApart>> =
        why.iter().map(|why| why.filter(|why| *why == WhyApart::Asked)).collect();
    let shared = shared(joints, &parts(joints, &unless_asked));
    joints.iter().map(|joint| shared.iter().any(|body| body.joints.contains(&joint.name))).collect()
}

/// The fits in groups that bodies connect, and the joints that have no body in common with another.
fn connected(parts: Vec<Part>) -> (Vec<Vec<Part>>, Vec<usize>) {
    let mut groups: Vec<Vec<Part>> = Vec::new();
    for part in parts {
        let (with, without): (Vec<_>, Vec<_>) =
            groups.into_iter().partition(|group| group.iter().any(|other| other.meets(&part)));
        groups = without;
        groups.push(with.into_iter().flatten().chain([part]).collect());
    }
    let (mut groups, alone): (Vec<_>, Vec<_>) = groups.into_iter().partition(|group| group.len() > 1);
    groups.iter_mut().for_each(|group| group.sort_by_key(|part| part.joint));
    (groups, alone.into_iter().flatten().map(|part| part.joint).collect())
}

impl Part<'_> {
    /// Whether a body is the same in both tests.
    fn meets(&self, other: &Part) -> bool {
        let bodies = self.fit.quantities.iter().filter_map(|quantity| quantity.body.as_deref());
        let mut bodies = bodies.map(|body| (self.owner(body), other.owner(body)));
        bodies.any(|(own, others)| own.is_some() && own == others)
    }

    /// The test that a body belongs to.
    fn owner(&self, body: &str) -> Option<usize> {
        let mut all = self.fit.quantities.iter().zip(&self.owners);
        all.find(|(quantity, _)| quantity.body.as_deref() == Some(body)).map(|(_, owner)| *owner)
    }
}

/// The tests of a body, and how many of them moved each of its quantities.
#[derive(Default)]
struct Tests<'a> {
    joints: Vec<usize>,
    moved: BTreeMap<&'a str, usize>,
}

/// The bodies that more than one of the fits has.
fn shared(joints: &[Decomposed], parts: &[Part]) -> Vec<SharedBody> {
    let mut bodies: BTreeMap<(&str, usize), Tests> = BTreeMap::new();
    for part in parts {
        for (quantity, owner) in part.fit.quantities.iter().zip(&part.owners) {
            let Some(body) = quantity.body.as_deref() else { continue };
            let tests = bodies.entry((body, *owner)).or_default();
            if tests.joints.last() != Some(&part.joint) {
                tests.joints.push(part.joint);
            }
            *tests.moved.entry(&quantity.path).or_default() += 1;
        }
    }
    let several = bodies.into_iter().filter(|(_, tests)| tests.joints.len() > 1);
    several
        .map(|((body, _), tests)| SharedBody {
            body: body.to_owned(),
            joints: tests.joints.iter().map(|joint| joints[*joint].name.clone()).collect(),
            quantities: tests
                .moved
                .iter()
                .filter(|(_, n)| **n > 1)
                .map(|(path, _)| (*path).to_owned())
                .collect(),
        })
        .collect()
}
