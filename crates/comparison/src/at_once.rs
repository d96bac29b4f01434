//! What `stiffness.json` says of joints that one fit found at once: what their numbers have in common.

use crate::filed_likelihood::{ELEMENTS, FiledLikelihood};
use crate::stiffness_file::read;
use jointscope_inference::QuadraticLikelihood;
use serde_json::Value;
use std::sync::Arc;

/// The numbers of joints found at once: their covariance, and what the FRFs alone tell of all of them.
#[derive(Debug, Clone, PartialEq)]
pub struct AtOnce {
    /// The joints, in the file's order.
    pub joints: Vec<String>,
    /// Place of a joint and of one of its six numbers, for each row of the covariance.
    elements: Vec<(usize, usize)>,
    covariance: Vec<Vec<f64>>,
    /// What of the covariance comes from a model that does not explain the FRFs.
    model: Vec<Vec<f64>>,
    likelihood: Option<FiledLikelihood>,
}

/// A joint's place among those that one fit found at once.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaceInFit {
    /// All of them.
    pub fit: Arc<AtOnce>,
    /// Which.
    pub joint: usize,
}

impl AtOnce {
    /// From a file with `joints`; nothing where names or sizes do not go together.
    pub(crate) fn of(file: &Value) -> Option<Self> {
        let names = file["joints"].as_array()?.iter().map(|joint| read(&joint["name"]));
        let joints: Vec<String> = names.collect::<Option<_>>()?;
        let covariance = &file["covariance"];
        let elements: Vec<String> = read(&covariance["elements"])?;
        let place = |name: &String| numbered(&joints, name);
        let elements: Vec<(usize, usize)> = elements.iter().map(place).collect::<Option<_>>()?;
        let matrix: Vec<Vec<f64>> = read(&covariance["matrix"])?;
        let square =
            |all: &Vec<Vec<f64>>| all.len() == elements.len() && all.iter().all(|row| row.len() == all.len());
        let none = || vec![vec![0.0; elements.len()]; elements.len()];
        let model = read(&covariance["model"]).unwrap_or_else(none);
        let is_whole = square(&matrix) && square(&model);
        let is_named_once = (1..joints.len()).all(|i| !joints[..i].contains(&joints[i]));
        let likelihood = read(&file["likelihood"]);
        (is_whole && is_named_once).then_some(AtOnce {
            joints,
            elements,
            covariance: matrix,
            model,
            likelihood,
        })
    }

    /// Covariance of two numbers, each given by its joint and its place among the six; zero of numbers that
    /// were not found.
    pub(crate) fn covariance(&self, a: (usize, usize), b: (usize, usize)) -> f64 {
        self.entry(&self.covariance, a, b)
    }

    /// What of it comes from the model's error.
    pub(crate) fn model(&self, a: (usize, usize), b: (usize, usize)) -> f64 {
        self.entry(&self.model, a, b)
    }

    fn entry(&self, of: &[Vec<f64>], a: (usize, usize), b: (usize, usize)) -> f64 {
        let row = |number: (usize, usize)| self.elements.iter().position(|other| *other == number);
        row(a).zip(row(b)).map_or(0.0, |(a, b)| of[a][b])
    }

    /// The likelihood of the numbers of these joints and after them of `quantities` quantities, the other
    /// joints integrated out; with each number's joint and place among the six. Nothing where the file has
    /// none that fits.
    pub(crate) fn likelihood(
        &self,
        joints: &[usize],
        quantities: usize,
    ) -> Option<(Vec<(usize, usize)>, QuadraticLikelihood)> {
        let written = self.likelihood.as_ref()?;
        let numbers: Vec<(usize, usize)> =
            written.elements.iter().map(|name| numbered(&self.joints, name)).collect::<Option<_>>()?;
        if (1..numbers.len()).any(|i| numbers[..i].contains(&numbers[i])) {
            return None;
        }
        let all = written.whole(numbers.len() + quantities)?;
        let is_kept = |index: &usize| numbers.get(*index).is_none_or(|(joint, _)| joints.contains(joint));
        let kept: Vec<usize> = (0..all.order()).filter(is_kept).collect();
        // Nothing is known of the joints beforehand.
        let marginal = all.marginal(&kept, |_| 0.0)?;
        let numbers: Vec<(usize, usize)> =
            kept.iter().filter_map(|&index| numbers.get(index).copied()).collect();
        (!numbers.is_empty()).then_some((numbers, marginal))
    }
}

/// The joint and the place among the six of a name such as `J1/k11`.
fn numbered(joints: &[String], name: &str) -> Option<(usize, usize)> {
    let (joint, element) = name.rsplit_once('/')?;
    let joint = joints.iter().position(|other| other == joint)?;
    Some((joint, ELEMENTS.iter().position(|other| *other == element)?))
}
