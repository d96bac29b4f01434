//! What keeps a comparison from being taken as it stands.

use crate::{Decomposed, Together, WhyApart};
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
    StrainedFixture {
        /// Which joint.
        joint: String,
        /// Squared departures per what chance makes of them.
        strain: f64,
    },
    /// Physics does not allow what the FRFs ask for.
    Refused {
        /// Which joint.
        joint: String,
        /// The tests that fail.
        tests: Vec<&'static str>,
    },
    /// C is held where it just gives out no energy: the FRFs ask for one beyond, and the deviations are those of a C without this constraint.
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
    /// Its FRFs contradict those of another test on bodies that both fixtures state alike; it is compared as tested on bodies of its own.
    BodiesDisagree {
        /// Which joint.
        joint: String,
    },
}

/// Probability below which a test of a joint fails, as in the decomposition.
const FAILED: f64 = 0.05;

impl Caution {
    /// What is to be known of the joints as their files tell it.
    pub(crate) fn of(joints: &[Decomposed], together: &Together) -> Vec<Self> {
        let mut all: Vec<Caution> = joints.iter().flat_map(Caution::of_joint).collect();
        let heavy = |joint: &&Decomposed| joint.fitted.as_ref().is_some_and(|fit| fit.mass.is_some());
        let names = |joints: Vec<&Decomposed>| joints.iter().map(|joint| joint.name.clone()).collect();
        let (with, without): (Vec<&Decomposed>, Vec<&Decomposed>) = joints.iter().partition(heavy);
        if !with.is_empty() && !without.is_empty() {
            all.push(Caution::Masses { with: names(with), without: names(without) });
        }
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
        let strain = fit.map_or(1.0, |fit| fit.model_error.strain);
        if judged.is_some_and(|judged| judged.verdict == "unusable") {
            all.push(Caution::Unusable { joint: joint() });
        }
        let stated = judged.and_then(|judged| judged.poor_fit).filter(|_| strain <= 1.0);
        if let Some(chi2_per_dof) = inflated.or(stated) {
            all.push(Caution::PoorFit { joint: joint(), chi2_per_dof });
        }
        if strain > 1.0 {
            all.push(Caution::StrainedFixture { joint: joint(), strain });
        }
        if fit.is_some_and(|fit| fit.on_the_boundary_of_passive) {
            all.push(Caution::OnTheBoundary { joint: joint() });
        }
        if let Some(tests) = fit.map(|fit| fit.tests) {
            let named = [
                ("reciprocity", tests.reciprocity),
                ("definite", tests.definite),
                ("passive", tests.passive),
            ];
            let failed = named.into_iter().filter(|(_, p)| p.is_some_and(|p| p < FAILED));
            let tests: Vec<&'static str> = failed.map(|(name, _)| name).collect();
            if !tests.is_empty() {
                all.push(Caution::Refused { joint: joint(), tests });
            }
        }
        all
    }

    /// It in a sentence.
    pub fn says(&self) -> String {
        match self {
            Caution::PoorFit { joint, chi2_per_dof } => format!(
                "{joint}: its fit leaves a chi2 of {} per degree of freedom, so this joint on this fixture does not explain its FRFs; its numbers \
                 may be off by more than their ±",
                short(*chi2_per_dof)
            ),
            Caution::StrainedFixture { joint, strain } => format!(
                "{joint}: its fit moves the fixture's quantities {} times as far as chance does, so something that the fixture leaves out is in its numbers",
                short(strain.sqrt())
            ),
            Caution::Refused { joint, tests } => {
                let tests: Vec<&str> = tests
                    .iter()
                    .map(|test| match *test {
                        "reciprocity" => "k12 and k21 differ",
                        "definite" => "its stiffness would push by itself",
                        _ => "its damping would give out energy",
                    })
                    .collect();
                format!("{joint}: physics forbids what its FRFs ask for: {}", tests.join(", "))
            }
            Caution::OnTheBoundary { joint } => format!(
                "{joint}: its C is held where it just gives out no energy, since its FRFs ask for one that would; it is compared as if on blocks of its own, and the intervals \
                 of its C are those without this limit"
            ),
            Caution::Unusable { joint } => {
                format!(
                    "{joint}: its decomposition is judged unusable; its page says why, and nothing here rests on it"
                )
            }
            Caution::Masses { with, without } => format!(
                "{} {} a mass of the joint's own and {} none: stiffnesses of joints with and without a mass are not of the same thing",
                with.join(", "),
                if with.len() == 1 { "has" } else { "have" },
                without.join(", ")
            ),
            Caution::BodiesDisagree { joint } => format!(
                "{joint}: its FRFs contradict those of another test on the blocks that both fixtures state alike, so it is compared as if on blocks of its own: \
                 they may be others, or the fixture leaves something out"
            ),
        }
    }
}

fn short(value: f64) -> String {
    match value.abs() {
        v if v >= 1000.0 => format!("{value:.0}"),
        v if v >= 10.0 => format!("{value:.1}"),
        v if v >= 0.01 => format!("{value:.2}"),
        _ => format!("{value:.1e}"),
    }
}
