//! What keeps a comparison from being taken as it stands.

use crate::at_law::SAME_FREQUENCY;
use crate::{Compared, Decomposed, FiledEstimate, Number, Together, WhyApart};
use jointscope_inference::Z95;
use serde::Serialize;

/// One thing to be known before anything else.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "what", rename_all = "snake_case")]
pub enum Caution {
    /// The fit does not explain the recording.
    PoorFit {
        /// Which joint.
        joint: String,
        /// χ² per degree of freedom.
        chi2_per_dof: f64,
    },
    /// The fit had to move the fixture's quantities farther than chance does.
    #[serde(rename = "strained_fixture")]
    LargeDepartures {
        /// Which joint.
        joint: String,
        /// Squared departures per what chance makes of them.
        #[serde(rename = "strain")]
        tolerance_inflation: f64,
    },
    /// Physics does not allow what the FRFs ask for.
    Refused {
        /// Which joint.
        joint: String,
        /// The tests that fail.
        tests: Vec<&'static str>,
    },
    /// C is held where it just gives out no energy: the FRFs ask for one beyond, and the deviations are those
    /// of a C without this constraint.
    OnTheBoundary {
        /// Which joint.
        joint: String,
    },
    /// The decomposition's own judgement: of no use.
    Unusable {
        /// Which joint.
        joint: String,
    },
    /// Some of the joints have a mass of their own, others have none: their K are not of the same thing.
    Masses {
        /// Those with a mass.
        with: Vec<String>,
        /// Those without.
        without: Vec<String>,
    },
    /// Their numbers are those of laws by which C, or K, depends on frequency, each in the middle of its own
    /// band.
    Frequencies {
        /// The joints that follow such laws.
        joints: Vec<String>,
        /// Where the numbers of each are stated, Hz.
        frequencies: Vec<f64>,
    },
    /// It has no fit to all FRFs, so that all joints are compared by less.
    NoFit {
        /// Which joint.
        joint: String,
        /// Why.
        why: String,
    },
    /// Numbers of it have no standard deviation, so that nothing tells how sure their orders and ratios are.
    NoDeviations {
        /// Which joint.
        joint: String,
        /// Which numbers.
        numbers: Vec<String>,
    },
    /// Both are of the same recording, whose noise is in both.
    SameRecording {
        /// A joint.
        first: String,
        /// Another.
        second: String,
    },
    /// Their K and C act over lengths that differ by more than their deviations.
    Lengths {
        /// The joints.
        joints: Vec<String>,
        /// The length of each, m.
        lengths: Vec<f64>,
    },
    /// Its FRFs contradict those of another test on bodies that both fixtures state alike; it is compared as
    /// tested on bodies of its own.
    BodiesDisagree {
        /// Which joint.
        joint: String,
    },
}

/// Share of a length below which two are the same number.
const SAME_LENGTH: f64 = 1e-9;

impl Caution {
    /// What is to be known of the joints as their files tell it.
    pub(crate) fn of(
        joints: &[Decomposed],
        estimates: &[FiledEstimate],
        (compared, numbers): (Compared, &[Number]),
        together: &Together,
    ) -> Vec<Self> {
        let mut all: Vec<Caution> = joints.iter().flat_map(Caution::of_joint).collect();
        if compared != Compared::AllFrfs {
            all.extend(without_fit(joints));
        }
        all.extend(joints.iter().zip(estimates).filter_map(|(joint, estimate)| {
            let is_bare = |number: &&Number| number.has_no_deviation(estimate);
            let numbers: Vec<String> = numbers.iter().filter(is_bare).map(|number| number.name()).collect();
            (!numbers.is_empty()).then(|| Caution::NoDeviations { joint: joint.name.clone(), numbers })
        }));
        all.extend(of_one_recording(joints));
        all.extend(of_other_lengths(joints));
        let heavy = |joint: &&Decomposed| joint.fitted.as_ref().is_some_and(|fit| fit.mass.is_some());
        let names = |joints: Vec<&Decomposed>| joints.iter().map(|joint| joint.name.clone()).collect();
        let (with, without): (Vec<&Decomposed>, Vec<&Decomposed>) = joints.iter().partition(heavy);
        if !with.is_empty() && !without.is_empty() {
            all.push(Caution::Masses { with: names(with), without: names(without) });
        }
        all.extend(of_other_frequencies(joints));
        let disagreeing = together.apart.iter().filter(|apart| apart.why == WhyApart::Disagrees);
        all.extend(disagreeing.map(|apart| Caution::BodiesDisagree { joint: apart.joint.clone() }));
        all
    }

    fn of_joint(decomposed: &Decomposed) -> Vec<Self> {
        let joint = || decomposed.name.clone();
        let mut all = Vec::new();
        let judged = decomposed.judgement.as_ref();
        let fit = decomposed.fitted.as_ref();
        let inflated = fit.filter(|fit| fit.model_error.inflation > 1.0).and_then(|fit| fit.chi2_per_dof);
        let tolerance_inflation = fit.map_or(1.0, |fit| fit.model_error.tolerance_inflation);
        if judged.is_some_and(|judged| judged.verdict == "unusable") {
            all.push(Caution::Unusable { joint: joint() });
        }
        let stated = judged.and_then(|judged| judged.poor_fit).filter(|_| tolerance_inflation <= 1.0);
        if let Some(chi2_per_dof) = inflated.or(stated) {
            all.push(Caution::PoorFit { joint: joint(), chi2_per_dof });
        }
        if tolerance_inflation > 1.0 {
            all.push(Caution::LargeDepartures { joint: joint(), tolerance_inflation });
        }
        if fit.is_some_and(|fit| fit.on_the_boundary_of_passive) {
            all.push(Caution::OnTheBoundary { joint: joint() });
        }
        if let Some(tests) = fit.map(|fit| fit.tests) {
            let tests: Vec<&'static str> = tests.failed().map(|(name, _)| name).collect();
            if !tests.is_empty() {
                all.push(Caution::Refused { joint: joint(), tests });
            }
        }
        all
    }
}

/// The joints that have no fit to all FRFs, by which the others are therefore not compared.
fn without_fit(joints: &[Decomposed]) -> Vec<Caution> {
    // Fits are of the exact relation.
    let any = joints.iter().any(|joint| joint.fitted.is_some());
    let entitled = joints.iter().filter(|joint| joint.relation == "exact" && joint.fitted.is_none());
    let why =
        |joint: &Decomposed| joint.not_fitted.clone().or_else(|| any.then(|| "its file has none".to_owned()));
    entitled
        .filter_map(|joint| Some(Caution::NoFit { joint: joint.name.clone(), why: why(joint)? }))
        .collect()
}

/// Joints whose numbers are stated at several frequencies on which they depend.
fn of_other_frequencies(joints: &[Decomposed]) -> Option<Caution> {
    let depends = |joint: &Decomposed| {
        let follows = joint.fitted.as_ref()?.follows.as_ref().filter(|follows| !follows.is_viscous())?;
        Some((joint.name.clone(), follows.frequency))
    };
    let (joints, frequencies): (Vec<String>, Vec<f64>) = joints.iter().filter_map(depends).unzip();
    let (first, others) = frequencies.split_first()?;
    let differs = others.iter().any(|other| (other - first).abs() > SAME_FREQUENCY * first.abs());
    differs.then_some(Caution::Frequencies { joints, frequencies })
}

/// Pairs of joints of one recording: their files say that they were made from it, or what the FRFs tell is
/// the same to the last digit.
fn of_one_recording(joints: &[Decomposed]) -> Vec<Caution> {
    let likelihood = |joint: &Decomposed| joint.fitted.as_ref().and_then(|fit| fit.likelihood.clone());
    let is_one = |a: &Decomposed, b: &Decomposed| {
        // How the errors of joints found at once go together is known.
        !a.is_of_the_fit_of(b)
            && (a.recording.iter().any(|file| b.recording.contains(file))
                || (likelihood(a).is_some() && likelihood(a) == likelihood(b)))
    };
    let pairs = joints.iter().enumerate().flat_map(|(i, a)| joints[i + 1..].iter().map(move |b| (a, b)));
    pairs
        .filter(|(a, b)| is_one(a, b))
        .map(|(a, b)| Caution::SameRecording { first: a.name.clone(), second: b.name.clone() })
        .collect()
}

/// Whether K and C act over the same length in all joints whose files say it.
fn of_other_lengths(joints: &[Decomposed]) -> Option<Caution> {
    let known: Vec<(&Decomposed, f64)> =
        joints.iter().filter_map(|joint| Some((joint, joint.ends.as_ref()?.length))).collect();
    let fitted = |joint: &Decomposed| joint.fitted.as_ref().and_then(|fit| fit.length);
    let differ = |(a, stated): (&Decomposed, f64), (b, other): (&Decomposed, f64)| {
        let std = fitted(a).map_or(0.0, |l| l.std).hypot(fitted(b).map_or(0.0, |l| l.std));
        let apart = (fitted(a).map_or(stated, |l| l.value) - fitted(b).map_or(other, |l| l.value)).abs();
        // Alike as stated, they are one length that two tests know.
        let is_stated_alike = (stated - other).abs() <= SAME_LENGTH * stated.abs();
        !is_stated_alike && apart > (Z95 * std).max(SAME_LENGTH * stated.abs())
    };
    let any = known.iter().enumerate().any(|(i, a)| known[i + 1..].iter().any(|b| differ(*a, *b)));
    any.then(|| Caution::Lengths {
        joints: known.iter().map(|(joint, _)| joint.name.clone()).collect(),
        lengths: known.iter().map(|(_, length)| *length).collect(),
    })
}
