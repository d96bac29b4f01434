//! All joints in one Gaussian: their numbers, and how the errors of one are those of another.
//!
//! Each fit tells of its joint and of the fixture's quantities what a Gaussian likelihood does. Of joints
//! tested on the same blocks these quantities are the same: the likelihoods are multiplied, with one set of
//! quantities, whose prior enters once. The posterior then has both joints, and what the blocks' tolerances
//! do to one they do to the other: it cancels in their difference. What the fits get wrong besides is added
//! to each joint by itself, what laws over frequency differ by to all that follow one.
//!
//! Where the common quantities are farther from what is stated than chance takes them, the posterior is
//! widened by Birge's ratio, as that of one fit is: each group of joints that bodies connect by its own.
//!
//! A body is the same in two tests where both fixtures say the same of it: every quantity of it and of the
//! points on it that either fit moved has the same value and standard deviation in both. Supports, damping,
//! channels and other joints are taken as set up anew.
//!
//! A joint whose C is held where it just gives out no energy keeps what its file states: the likelihood is
//! that of a C without this constraint, and with it the joint would be one that physics forbids.

use crate::bodies::{Part, connected, differing, likelihood, parts, shared, sharing_a_body, tests};
use crate::choices::Choice;
use crate::common_law::groups as followers;
use crate::{Apart, Decomposed, FiledEstimate, Number, SharedBody, WhyApart};
use jointscope_inference::{NormalEquations, birge_ratio};
use std::collections::BTreeMap;

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
    /// Joints that one fit found at once, group by group: their errors go together as its file says, noise
    /// included.
    pub at_once: Vec<Vec<String>>,
    /// Joints that are taken to follow one law over frequency, group by group.
    pub one_law: Vec<Vec<String>>,
    /// Paths of quantities that not all fixtures state alike, where that keeps a body from being the same.
    pub differing: Vec<String>,
}

/// Takes the joints of a test apart.
fn part(test: &[usize], why: &mut [Option<WhyApart>], reason: WhyApart) {
    test.iter().for_each(|&joint| why[joint] = Some(reason));
}

/// Why joints are apart before anything is said of their bodies; and which would share a body with another
/// test but for being on the boundary.
fn apart_beforehand(
    joints: &[Decomposed],
    tests: &[Vec<usize>],
    asked_apart: bool,
) -> (Vec<Option<WhyApart>>, Vec<bool>) {
    let mut why: Vec<Option<WhyApart>> = vec![None; joints.len()];
    for test in tests {
        match likelihood(joints, test) {
            _ if asked_apart => part(test, &mut why, WhyApart::Asked),
            Some(_) => {}
            None => part(test, &mut why, WhyApart::NotStated),
        }
    }
    let shares_a_body = sharing_a_body(joints, &why);
    let is_held =
        |joint: &usize| joints[*joint].fitted.as_ref().is_some_and(|fit| fit.on_the_boundary_of_passive);
    for test in tests {
        if why[test[0]].is_none() && test.iter().any(is_held) {
            part(test, &mut why, WhyApart::OnTheBoundary);
        }
    }
    (why, shares_a_body)
}

impl Together {
    /// Of joints compared by independent estimates.
    pub(crate) fn independent(estimates: &[FiledEstimate], numbers: &[Number]) -> Self {
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

    /// Of joints fitted to all FRFs; `asked_apart` takes them all as tested on blocks of their own. Whether
    /// tests contradict each other on the blocks is asked of the joints under every choice of their laws: by
    /// a law that does not hold a fit bends the blocks to make up for it.
    pub(crate) fn of(
        (joints, choices): (&[Decomposed], &[Choice]),
        numbers: &[Number],
        asked_apart: bool,
    ) -> Self {
        let mut together = Together::empty(joints.len(), numbers.len());
        together.has_covariances = true;
        let tests = tests(joints);
        for test in &tests {
            together.put_test(joints, test, numbers);
        }
        let (mut why, shares_a_body) = apart_beforehand(joints, &tests, asked_apart);
        let groups = loop {
            let parts = parts(joints, &why);
            together.shared = shared(joints, &parts);
            let firsts: Vec<usize> = tests.iter().map(|test| test[0]).collect();
            if let Some(odd) = together.most_at_odds(choices, &firsts) {
                let test = tests.iter().find(|test| test[0] == odd);
                part(test.map_or(&[odd], Vec::as_slice), &mut why, WhyApart::Disagrees);
                continue;
            }
            let (groups, alone) = connected(parts);
            // Joints of the only test have nothing to be apart from.
            for joint in alone.into_iter().filter(|_| tests.len() > 1) {
                why[joint] =
                    Some(if shares_a_body[joint] { WhyApart::LeftAlone } else { WhyApart::OtherBodies });
            }
            break groups;
        };
        for group in &groups {
            if together.tie(group, numbers).is_some() {
                continue;
            }
            let of_it: Vec<usize> = group.iter().flat_map(|part| part.joints.iter().copied()).collect();
            let is_of_it = |name: &String| of_it.iter().any(|&joint| joints[joint].name == *name);
            together.shared.retain(|body| !body.joints.iter().any(is_of_it));
            part(&of_it, &mut why, WhyApart::Singular);
        }
        let names = |test: &Vec<usize>| test.iter().map(|&joint| joints[joint].name.clone()).collect();
        together.at_once = tests.iter().filter(|test| test.len() > 1).map(names).collect();
        let is_of_known_laws = |joint: &usize| {
            joints[*joint].fitted.as_ref().is_some_and(|fit| fit.departure(fit.stated_law()).is_some())
        };
        let followers = followers(joints).into_iter().filter(|group| group.len() > 1);
        together.one_law =
            followers.filter(|group| group.iter().all(is_of_known_laws)).map(|group| names(&group)).collect();
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
            at_once: Vec::new(),
            one_law: Vec::new(),
            differing: Vec::new(),
        }
    }

    fn put(&mut self, a: (usize, usize), b: (usize, usize), value: f64) {
        let n = self.mean.len();
        self.covariance[(a.0 * self.count + a.1) * n + b.0 * self.count + b.1] = value;
    }

    /// The joints of a test as its file states them.
    fn put_test(&mut self, joints: &[Decomposed], test: &[usize], numbers: &[Number]) {
        for &joint in test {
            let Some(fit) = &joints[joint].fitted else { continue };
            let six = fit.six();
            for (a, number) in numbers.iter().enumerate() {
                self.mean[joint * self.count + a] = six[number.slot()];
            }
            for &other in test {
                let places = joints[joint].at_once.as_ref().zip(joints[other].at_once.as_ref());
                for (a, number) in numbers.iter().enumerate() {
                    for (b, with) in numbers.iter().enumerate() {
                        let (m, n) = (number.slot(), with.slot());
                        let covariance = match places {
                            _ if joint == other => fit.covariance[m][n],
                            Some((one, two)) => one.fit.covariance((one.joint, m), (two.joint, n)),
                            None => 0.0,
                        };
                        self.put((joint, a), (other, b), covariance);
                    }
                }
            }
        }
    }

    /// Moves a joint's numbers.
    pub(crate) fn shift(&mut self, joint: usize, by: &[f64]) {
        let own = &mut self.mean[joint * self.count..(joint + 1) * self.count];
        own.iter_mut().zip(by).for_each(|(value, by)| *value += by);
    }

    /// Adds how far the numbers of other laws are from these, each as often as it is probable.
    pub(crate) fn spread(&mut self, others: &[(f64, Together)]) {
        let n = self.mean.len();
        for (probability, other) in others {
            let apart: Vec<f64> = other.mean.iter().zip(&self.mean).map(|(other, own)| other - own).collect();
            for (a, row) in apart.iter().zip(self.covariance.chunks_exact_mut(n.max(1))) {
                row.iter_mut().zip(&apart).for_each(|(entry, b)| *entry += probability * a * b);
            }
        }
    }

    /// Puts in the posterior of all these tests with the quantities that they share; `None` where it is not
    /// determined to working precision.
    fn tie(&mut self, parts: &[Part], numbers: &[Number]) -> Option<()> {
        let mut places: BTreeMap<(&str, usize), usize> = BTreeMap::new();
        let mut tests = Vec::new();
        // The joints' numbers come first.
        let mut order = 0;
        for part in parts {
            let (own_numbers, likelihood) = part.likelihood()?;
            let own: Vec<usize> = (order..order + own_numbers.len()).collect();
            order += own_numbers.len();
            tests.push((part, own_numbers, likelihood, own));
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
        for (_, own_numbers, likelihood, own) in &tests {
            reference[own[0]..own[0] + own_numbers.len()]
                .copy_from_slice(&likelihood.at[..own_numbers.len()]);
        }
        let mut equations = NormalEquations::zero(reference.len());
        for (part, _, likelihood, own) in &tests {
            let quantities = part.fit.quantities.iter().zip(&part.owners);
            let quantities = quantities.map(|(quantity, owner)| places[&(quantity.path.as_str(), *owner)]);
            let all: Vec<usize> = own.iter().copied().chain(quantities).collect();
            likelihood.add_to(&mut equations, &reference, &all);
        }
        precision.iter().enumerate().for_each(|(i, p)| equations.add_prior(order + i, *p, 0.0));
        let (step, covariance) = (equations.step(0.0)?, equations.covariance()?);
        let quantities = precision.iter().enumerate().filter(|(_, p)| **p > 0.0).map(|(i, _)| order + i);
        let departures = quantities.map(|i| (step[i] * step[i], 1.0 - covariance.at(i, i)));
        let inflation = tolerance_inflation(departures);
        // Each number compared: its test, its joint and place there, its coordinate.
        let numbered = |slot: usize| numbers.iter().position(|number| number.slot() == slot);
        let all = tests.iter().enumerate().flat_map(|(test, (_, own_numbers, _, own))| {
            own_numbers
                .iter()
                .zip(own)
                .filter_map(move |(&(joint, slot), &row)| Some((test, (joint, slot), numbered(slot)?, row)))
        });
        let all: Vec<(usize, (usize, usize), usize, usize)> = all.collect();
        for &(one, a, number, row) in &all {
            self.mean[a.0 * self.count + number] = reference[row] + step[row];
            for &(other, b, with, column) in &all {
                let own = if one == other { parts[one].added(a, b) } else { 0.0 };
                self.put((a.0, number), (b.0, with), inflation * covariance.at(row, column) + own);
            }
        }
        Some(())
    }

    /// Numbers of each joint.
    pub(crate) fn numbers(&self) -> usize {
        self.count
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

/// Birge's ratio of quantities' squared departures from what is stated to what chance makes of them (each
/// given with it); 1 where chance explains them.
fn tolerance_inflation(departures: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (squares, expected) =
        departures.fold((0.0, 0.0), |(s, e), (square, chance)| (s + square, e + chance.clamp(0.0, 1.0)));
    birge_ratio(squares, expected)
}
