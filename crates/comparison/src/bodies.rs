//! Which tests were made on the same bodies.
//!
//! A test is one fit: of one joint, or of several that it found at once. A body is the same in two tests
//! where both fixtures say the same of it.

use crate::{Decomposed, FiledJoint, StatedQuantity};
use jointscope_inference::QuadraticLikelihood;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

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
    /// Its file does not say how the fixture's quantities act on it: an earlier version's, or one without a
    /// fit to all FRFs.
    NotStated,
    /// Its FRFs contradict those of another test on the quantities that the fixtures state alike: the bodies
    /// are not the same, or the fit bends them for something else.
    Disagrees,
    /// Its C, or that of a joint found with it, is held where it just gives out no energy, which what its
    /// FRFs alone tell knows nothing of.
    OnTheBoundary,
    /// The other tests on the bodies that its fixture states are themselves taken apart.
    LeftAlone,
    /// No other fixture says the same of a body.
    OtherBodies,
    /// Its numbers and quantities cannot be told apart to working precision.
    Singular,
}

/// How a test's fit enters: where its numbers are and which coordinate each of its quantities is.
pub(crate) struct Part<'a> {
    /// The joints of it that are compared.
    pub joints: Vec<usize>,
    all: &'a [Decomposed],
    /// The fit of the first of them; the quantities are those of all.
    pub fit: &'a FiledJoint,
    /// By quantity: the first joint of the body's first test with the same statement, or of this test for
    /// what is its own.
    pub owners: Vec<usize>,
}

/// The joints by the test that found them, each test by its first joint.
pub(crate) fn tests(joints: &[Decomposed]) -> Vec<Vec<usize>> {
    let mut tests: Vec<Vec<usize>> = Vec::new();
    for (place, joint) in joints.iter().enumerate() {
        match tests.iter_mut().find(|test| joints[test[0]].is_of_the_fit_of(joint)) {
            Some(test) => test.push(place),
            None => tests.push(vec![place]),
        }
    }
    tests
}

/// What the FRFs of a test tell of its joints' numbers, each given by its joint and its place among the six,
/// and after them of the quantities; nothing where its file does not have it.
pub(crate) fn likelihood(
    joints: &[Decomposed],
    test: &[usize],
) -> Option<(Vec<(usize, usize)>, QuadraticLikelihood)> {
    let first = joints[*test.first()?].fitted.as_ref()?;
    if let [joint] = test {
        let (slots, likelihood) = first.likelihood()?;
        return Some((slots.into_iter().map(|slot| (*joint, slot)).collect(), likelihood));
    }
    let place = |joint: &usize| joints[*joint].at_once.as_ref().map(|place| place.joint);
    let places: Vec<usize> = test.iter().map(place).collect::<Option<_>>()?;
    let fit = &joints[test[0]].at_once.as_ref()?.fit;
    let (numbers, likelihood) = fit.likelihood(&places, first.quantities.len())?;
    let compared = |place: usize| places.iter().position(|other| *other == place).map(|index| test[index]);
    let numbers = numbers.into_iter().map(|(place, slot)| Some((compared(place)?, slot)));
    Some((numbers.collect::<Option<_>>()?, likelihood))
}

/// Whether two fits have a body in common: every quantity of it that one of them moved is stated alike by
/// both, and at least one was moved by both. What one fixture takes as exact and the other does not is not
/// stated alike.
fn is_same(a: &FiledJoint, b: &FiledJoint, body: &str) -> bool {
    let is_stated_by =
        |other: &FiledJoint, quantity: &StatedQuantity| other.statement(&quantity.path) == Some(quantity);
    let moved = |path: &str| b.quantities.iter().any(|other| other.path == path);
    a.of_body(body).all(|quantity| is_stated_by(b, quantity))
        && b.of_body(body).all(|quantity| is_stated_by(a, quantity))
        && a.of_body(body).any(|quantity| moved(&quantity.path))
}

/// Paths of bodies' quantities that one fixture states and another one with this body otherwise or not at
/// all.
pub(crate) fn differing(joints: &[Decomposed]) -> Vec<String> {
    let fits: Vec<&FiledJoint> = joints.iter().filter_map(|joint| joint.fitted.as_ref()).collect();
    let differs = |quantity: &StatedQuantity, body: &str| {
        let others = fits.iter().filter(|fit| fit.of_body(body).next().is_some());
        others.into_iter().any(|fit| fit.statement(&quantity.path) != Some(quantity))
    };
    let moved = fits.iter().flat_map(|fit| &fit.quantities);
    let paths = moved.filter(|q| q.body.as_deref().is_some_and(|body| differs(q, body)));
    paths.map(|quantity| quantity.path.clone()).collect::<BTreeSet<String>>().into_iter().collect()
}

/// The tests that may share quantities: each body belongs to the first test that states the same of it, and
/// with which all that share it agree.
pub(crate) fn parts<'a>(joints: &'a [Decomposed], why: &[Option<WhyApart>]) -> Vec<Part<'a>> {
    let mut parts: Vec<Part> = Vec::new();
    let able = tests(joints).into_iter().filter(|test| test.iter().all(|joint| why[*joint].is_none()));
    for (test, fit) in
        able.filter_map(|test| Some((joints[test[0]].fitted.as_ref()?, test))).map(|(a, b)| (b, a))
    {
        let first = test[0];
        let owner = |body: &str| {
            let sharing = |first: usize| {
                let mut all = parts.iter().filter(move |part| part.owner(body) == Some(first)).peekable();
                all.peek().is_some() && all.all(|part| is_same(part.fit, fit, body))
            };
            parts.iter().map(|part| part.joints[0]).find(|&first| sharing(first)).unwrap_or(first)
        };
        let owners = fit.quantities.iter().map(|q| q.body.as_deref().map_or(first, owner)).collect();
        parts.push(Part { joints: test, all: joints, fit, owners });
    }
    parts
}

/// Which joints have a body in common with another test's fixture, whatever becomes of the other one.
pub(crate) fn sharing_a_body(joints: &[Decomposed], why: &[Option<WhyApart>]) -> Vec<bool> {
    let unless_asked: Vec<Option<WhyApart>> =
        why.iter().map(|why| why.filter(|why| *why == WhyApart::Asked)).collect();
    let shared = shared(joints, &parts(joints, &unless_asked));
    joints.iter().map(|joint| shared.iter().any(|body| body.joints.contains(&joint.name))).collect()
}

/// The tests in groups that bodies connect, and the joints that have no body in common with another test.
pub(crate) fn connected(parts: Vec<Part>) -> (Vec<Vec<Part>>, Vec<usize>) {
    let mut groups: Vec<Vec<Part>> = Vec::new();
    for part in parts {
        let (with, without): (Vec<_>, Vec<_>) =
            groups.into_iter().partition(|group| group.iter().any(|other| other.meets(&part)));
        groups = without;
        groups.push(with.into_iter().flatten().chain([part]).collect());
    }
    let (mut groups, alone): (Vec<_>, Vec<_>) = groups.into_iter().partition(|group| group.len() > 1);
    groups.iter_mut().for_each(|group| group.sort_by_key(|part| part.joints[0]));
    (groups, alone.into_iter().flatten().flat_map(|part| part.joints).collect())
}

impl Part<'_> {
    /// What the test's FRFs tell, see [`likelihood`].
    pub(crate) fn likelihood(&self) -> Option<(Vec<(usize, usize)>, QuadraticLikelihood)> {
        likelihood(self.all, &self.joints)
    }

    /// What of the covariance of two of its numbers is not that of noise and quantities.
    pub(crate) fn added(&self, (joint, slot): (usize, usize), (other, with): (usize, usize)) -> f64 {
        let fit = |joint: usize| self.all[joint].fitted.as_ref();
        if joint == other {
            return fit(joint)
                .map_or(0.0, |fit| fit.model_error.covariance[slot][with] + fit.law_covariance[slot][with]);
        }
        let place = |joint: usize| self.all[joint].at_once.as_ref();
        place(joint).zip(place(other)).map_or(0.0, |(a, b)| a.fit.model((a.joint, slot), (b.joint, with)))
    }

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

/// The tests of a body with their joints, and how many of them moved each of its quantities.
#[derive(Default)]
struct Tests<'a> {
    tests: Vec<&'a [usize]>,
    moved: BTreeMap<&'a str, usize>,
}

/// The bodies that more than one of the tests has.
pub(crate) fn shared(joints: &[Decomposed], parts: &[Part]) -> Vec<SharedBody> {
    let mut bodies: BTreeMap<(&str, usize), Tests> = BTreeMap::new();
    for part in parts {
        for (quantity, owner) in part.fit.quantities.iter().zip(&part.owners) {
            let Some(body) = quantity.body.as_deref() else { continue };
            let tests = bodies.entry((body, *owner)).or_default();
            if tests.tests.last() != Some(&part.joints.as_slice()) {
                tests.tests.push(&part.joints);
            }
            *tests.moved.entry(&quantity.path).or_default() += 1;
        }
    }
    let several = bodies.into_iter().filter(|(_, tests)| tests.tests.len() > 1);
    several
        .map(|((body, _), tests)| SharedBody {
            body: body.to_owned(),
            joints: tests
                .tests
                .iter()
                .flat_map(|test| *test)
                .map(|&joint| joints[joint].name.clone())
                .collect(),
            quantities: tests
                .moved
                .iter()
                .filter(|(_, n)| **n > 1)
                .map(|(path, _)| (*path).to_owned())
                .collect(),
        })
        .collect()
}
