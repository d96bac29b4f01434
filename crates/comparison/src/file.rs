use crate::Comparison;
use serde_json::{Map, Value, json};

/// The contents of `comparison.json`: the joints' matrices with standard deviations, and the order by each element with its probability.
pub fn comparison_file(comparison: &Comparison) -> Value {
    let joints = comparison.joints.iter().map(|joint| {
        let estimate = comparison.estimate(joint);
        json!({
            "name": joint.name,
            "joint": joint.joint,
            "stiffness": estimate.stiffness,
            "damping": estimate.damping,
            "std": { "stiffness": estimate.stiffness_std, "damping": estimate.damping_std },
            "band": [joint.band.0, joint.band.1],
        })
    });
    let rankings = comparison.rankings.iter().map(|entry| {
        let name = |index: &usize| comparison.joints[*index].name.clone();
        let ranks: Map<String, Value> = entry
            .ranking
            .ranks
            .iter()
            .enumerate()
            .map(|(index, ranks)| (name(&index), json!(ranks)))
            .collect();
        json!({
            "element": format!("{}{}{}", entry.kind.symbol(), entry.element.0 + 1, entry.element.1 + 1),
            "order": entry.ranking.order.iter().map(name).collect::<Vec<_>>(),
            "probability": entry.ranking.probability,
            "adjacent": entry.ranking.adjacent,
            "rank_probabilities": ranks,
            "settled": entry.ranking.is_settled(),
        })
    });
    json!({
        "relation": comparison.relation,
        "estimate": comparison.compared.name(),
        "joints": joints.collect::<Vec<_>>(),
        "rankings": rankings.collect::<Vec<_>>(),
    })
}
