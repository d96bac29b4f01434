//! Truths out of the file that was sealed.

use crate::generate::recorded_lines;
use crate::{Role, Truth};
use jointscope_fixture::Fixture;
use jointscope_rig::{HammerTest, Instrument, Outside, frfs};
use jointscope_spectra::FrfPair;
use serde_json::{Value, json};

/// Physics outside the vocabulary as JSON: its kind, and what it is made of.
pub(crate) fn outside_value(outside: &Outside) -> Value {
    let mut value = match outside {
        Outside::Inerter { joint, inertance } => json!({ "joint": joint, "inertance": inertance }),
        Outside::Drift { joint, reference, factor } => {
            json!({ "joint": joint, "reference": reference, "factor": factor })
        }
        Outside::Bypass { from, to, stiffness } => json!({ "from": from, "to": to, "stiffness": stiffness }),
        Outside::Gyroscope { point, coupling } => json!({ "point": point, "coupling": coupling }),
        Outside::Springpot { joint, stiffness, order } => {
            json!({ "joint": joint, "stiffness": stiffness, "order": order })
        }
    };
    value["kind"] = json!(outside.kind());
    value
}

fn outside_of(value: &Value) -> Option<Outside> {
    let text = |key: &str| value[key].as_str().map(str::to_owned);
    let number = |key: &str| value[key].as_f64();
    Some(match value["kind"].as_str()? {
        "inerter" => Outside::Inerter { joint: text("joint")?, inertance: number("inertance")? },
        "drift" => {
            Outside::Drift { joint: text("joint")?, reference: text("reference")?, factor: number("factor")? }
        }
        "bypass" => Outside::Bypass { from: text("from")?, to: text("to")?, stiffness: number("stiffness")? },
        "gyroscope" => Outside::Gyroscope { point: text("point")?, coupling: number("coupling")? },
        "springpot" => Outside::Springpot {
            joint: text("joint")?,
            stiffness: number("stiffness")?,
            order: number("order")?,
        },
        _ => return None,
    })
}

/// How a case was measured, as JSON.
pub(crate) fn hammer_value(hammer: &HammerTest) -> Value {
    json!({
        "averages": hammer.averages, "noise_response": hammer.noise_response, "noise_force": hammer.noise_force,
        "corner": hammer.corner, "spread": hammer.spread, "common_hits": hammer.common_hits,
        "seed": hammer.seed.to_string(),
    })
}

/// What [`hammer_value`] has written.
pub(crate) fn hammer_of(value: &Value) -> Option<HammerTest> {
    let number = |key: &str| value[key].as_f64();
    Some(HammerTest {
        averages: u32::try_from(value["averages"].as_u64()?).ok()?,
        noise_response: number("noise_response")?,
        noise_force: number("noise_force")?,
        corner: number("corner")?,
        spread: number("spread")?,
        common_hits: value["common_hits"].as_bool()?,
        seed: value["seed"].as_str()?.parse().ok()?,
    })
}

impl Truth {
    /// The truth that [`Truth::to_value`] has written; the FRFs that nobody recorded are computed again. `None` of anything else.
    pub(crate) fn from_value(value: &Value) -> Option<Self> {
        let fixture = Fixture::from_value(&value["fixture"]).ok()?;
        let outside = match &value["outside"] {
            Value::Null => None,
            stated => Some(outside_of(stated)?),
        };
        let pair = |value: &Value| {
            let (response, reference) = value.as_str()?.split_once('/')?;
            Some(FrfPair::transverse(response, reference))
        };
        let pairs: Vec<FrfPair> = value["unseen"].as_array()?.iter().map(pair).collect::<Option<_>>()?;
        let lines = recorded_lines().ok()?;
        let unseen = match &outside {
            Some(outside) => outside.frfs(&fixture, &pairs, &lines, Instrument::Perfect),
            None => frfs(&fixture, &pairs, &lines, Instrument::Perfect),
        };
        Some(Truth {
            index: usize::try_from(value["case"].as_u64()?).ok()?,
            source: value["source"].as_str()?.to_owned(),
            fresh: value["fresh"].as_bool()?,
            role: Role::from_name(value["role"].as_str()?)?,
            fixture,
            outside,
            hammer: hammer_of(&value["hammer"])?,
            unseen: unseen.ok()?,
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::{Answers, NoAnswer, Plan};

    #[test]
    fn a_truth_reads_back_as_it_was_written() {
        let plan = Plan { cases: 40, graded: 1, seed: 6, ..Plan::default() };
        let (cases, sealed) = plan.draw().unwrap();
        let silent = Answers::by(&cases, 1, |_| (), |_| Err(NoAnswer::BrokeDown));
        let truths = sealed.open(&silent).unwrap();
        let kinds: std::collections::BTreeSet<_> =
            truths.iter().filter_map(|t| t.outside.as_ref()).map(Outside::kind).collect();
        assert_eq!(kinds.len(), Outside::KINDS, "every kind of unknown physics is among them: {kinds:?}");
        for truth in truths {
            let text = truth.to_value().to_string();
            let read = Truth::from_value(&serde_json::from_str(&text).unwrap()).unwrap();
            assert_eq!(read.to_value().to_string(), text);
            assert_eq!(read.unseen, truth.unseen, "case {}", truth.index);
        }
    }
}
