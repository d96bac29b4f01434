//! Joints of models over measured ones: SIM/EXP and FEM/EXP, number by number.

use crate::by_law::ByLaw;
use crate::{Decomposed, Kind, Number, Pair, Ratio, Source};
use serde::Serialize;

/// A model's joint over a measured one. These are the ratios of their [`Pair`], the measurement being the
/// first of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ModelRatios {
    /// The model's joint.
    pub model: String,
    /// Which model it is of.
    pub kind: Source,
    /// The measured joint.
    pub measurement: String,
    /// By number: all of K, those of C that have a ratio.
    pub numbers: Vec<ModelRatio>,
}

/// One number of a model over the measured one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelRatio {
    /// `K11` ….
    pub element: String,
    /// Model over measurement; nothing where the measured number cannot be told from zero, or one of them has
    /// no deviation.
    pub ratio: Option<Ratio>,
    /// What the ratio's interval says.
    pub model_is: Option<ModelIs>,
    /// K or C.
    #[serde(skip)]
    pub of: Kind,
}

/// What the 95 % interval of a ratio says of the model's number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ModelIs {
    /// 1 is in the interval.
    AsMeasured,
    /// Larger by magnitude.
    Larger,
    /// Smaller by magnitude.
    Smaller,
    /// Not as measured, and it may be of the other sign and as large or larger.
    Different,
}

impl ModelIs {
    fn of(ratio: &Ratio) -> Self {
        match ratio.ci95 {
            [low, high] if low <= 1.0 && 1.0 <= high => ModelIs::AsMeasured,
            [low, _] if low > 1.0 => ModelIs::Larger,
            [low, _] if low > -1.0 => ModelIs::Smaller,
            _ => ModelIs::Different,
        }
    }
}

impl ModelRatios {
    /// Every model over every measurement. Of joints found at once those of one name are of one kind, others
    /// are not set against each other.
    pub(crate) fn all(joints: &[Decomposed], by_law: &ByLaw, numbers: &[Number]) -> Vec<Self> {
        let of = |wanted: fn(Source) -> bool| {
            let sources = joints.iter().enumerate().map(|(place, joint)| (place, joint.source));
            sources.filter_map(move |(place, source)| Some((place, source.filter(|&s| wanted(s))?)))
        };
        let measured = of(|source| !source.is_model());
        let pairs = measured.flat_map(|(first, _)| of(Source::is_model).map(move |model| (first, model)));
        let belong = |a: &Decomposed, b: &Decomposed| {
            (a.at_once.is_none() && b.at_once.is_none()) || a.joint == b.joint
        };
        pairs
            .filter(|&(first, (second, _))| belong(&joints[first], &joints[second]))
            .map(|(first, (second, kind))| {
                let names = [first, second].map(|joint| joints[joint].name.as_str());
                let pair = Pair::of(by_law, numbers, (first, second), names, None);
                let all = numbers.iter().zip(pair.numbers).map(|(number, paired)| ModelRatio {
                    element: paired.element,
                    ratio: paired.ratio,
                    model_is: paired.ratio.as_ref().map(ModelIs::of),
                    of: number.kind,
                });
                let numbers = all.filter(|n| n.of == Kind::Stiffness || n.ratio.is_some()).collect();
                ModelRatios { model: pair.second, kind, measurement: pair.first, numbers }
            })
            .collect()
    }

    /// How many numbers are as measured, and how many have a ratio.
    pub fn agreement(all: &[Self]) -> (usize, usize) {
        let said: Vec<ModelIs> =
            all.iter().flat_map(|one| &one.numbers).filter_map(|number| number.model_is).collect();
        (said.iter().filter(|is| **is == ModelIs::AsMeasured).count(), said.len())
    }
}
