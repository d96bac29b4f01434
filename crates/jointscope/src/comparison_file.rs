//! `comparison.json`: the results of a comparison with the sentences that the page says of them.

use jointscope_comparison::{
    Apart, Caution, Comparison, ElementRanking, Equality, LawOfAll, Matrix, ModelRatios, Pair, SharedBody,
    Source, Specimens,
};
use jointscope_wording::{Says, models};
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;

#[derive(Serialize)]
struct File<'a> {
    relation: &'a str,
    estimate: &'static str,
    sound: bool,
    cautions: Vec<Said<'a>>,
    shared: &'a [SharedBody],
    apart: &'a [Apart],
    differing: &'a [String],
    at_once: &'a [Vec<String>],
    one_law: &'a [Vec<String>],
    #[serde(skip_serializing_if = "Option::is_none")]
    law: Option<&'a LawOfAll>,
    joints: Vec<Joint<'a>>,
    equality: Option<Equality>,
    pairs: &'a [Pair],
    #[serde(skip_serializing_if = "Option::is_none")]
    models: Option<Models<'a>>,
    rankings: Vec<Order<'a>>,
    #[serde(skip_serializing_if = "<[Specimens]>::is_empty")]
    specimens: &'a [Specimens],
}

#[derive(Serialize)]
struct Said<'a> {
    #[serde(flatten)]
    caution: &'a Caution,
    says: String,
}

#[derive(Serialize)]
struct Joint<'a> {
    name: &'a str,
    joint: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    kind: Option<Source>,
    stiffness: Matrix,
    damping: Matrix,
    std: Matrices,
    band: Option<(f64, f64)>,
}

#[derive(Serialize)]
struct Models<'a> {
    says: String,
    as_measured: usize,
    known: usize,
    ratios: &'a [ModelRatios],
}

impl<'a> Models<'a> {
    fn of(ratios: &'a [ModelRatios]) -> Option<Self> {
        let (as_measured, known) = ModelRatios::agreement(ratios);
        Some(Models { says: models::sentence(ratios)?, as_measured, known, ratios })
    }
}

#[derive(Serialize)]
struct Matrices {
    stiffness: Matrix,
    damping: Matrix,
}

#[derive(Serialize)]
struct Order<'a> {
    element: String,
    order: Vec<&'a str>,
    probability: f64,
    adjacent: &'a [f64],
    rank_probabilities: BTreeMap<&'a str, &'a [f64]>,
    settled: bool,
    stated: bool,
    decided: Vec<[&'a str; 2]>,
}

/// The contents of `comparison.json`: the joints' matrices with standard deviations, what they share, every
/// two of them, the order by each number with its probability, models over measurements, the scatter of
/// specimens, and what is to be known before any of it.
pub fn comparison_file(comparison: &Comparison) -> Value {
    let name = |index: usize| comparison.joints[index].name.as_str();
    let joints = comparison.joints.iter().enumerate().map(|(index, joint)| {
        let estimate = comparison.estimate(index);
        Joint {
            name: &joint.name,
            joint: &joint.joint,
            kind: joint.source,
            stiffness: estimate.stiffness,
            damping: estimate.damping,
            std: Matrices { stiffness: estimate.stiffness_std, damping: estimate.damping_std },
            band: joint.average.map(|average| average.band),
        }
    });
    let order = |entry: &'_ ElementRanking| entry.ranking.order.iter().map(|index| name(*index)).collect();
    let rankings = comparison.rankings.iter().map(|entry| Order {
        element: entry.number().name(),
        order: order(entry),
        probability: entry.ranking.probability,
        adjacent: &entry.ranking.adjacent,
        rank_probabilities: entry
            .ranking
            .ranks
            .iter()
            .enumerate()
            .map(|(index, ranks)| (name(index), ranks.as_slice()))
            .collect(),
        settled: entry.is_settled(),
        stated: entry.is_stated(),
        decided: entry
            .decided()
            .flat_map(|(joint, larger)| larger.iter().map(move |&behind| [name(joint), name(behind)]))
            .collect(),
    });
    let said = |caution| Said { caution, says: Says::says(caution) };
    json!(File {
        relation: &comparison.relation,
        estimate: comparison.compared.name(),
        sound: comparison.is_sound(),
        cautions: comparison.cautions.iter().map(said).collect(),
        shared: &comparison.together.shared,
        apart: &comparison.together.apart,
        differing: &comparison.together.differing,
        at_once: &comparison.together.at_once,
        one_law: &comparison.together.one_law,
        law: comparison.law.as_ref(),
        joints: joints.collect(),
        equality: comparison.equality,
        pairs: &comparison.pairs,
        models: Models::of(&comparison.models),
        rankings: rankings.collect(),
        specimens: &comparison.specimens,
    })
}
