//! What is true of a case of the laboratory.

use crate::hammer_test::recorded_lines;
use crate::sealable::{Filed, Sealable};
use crate::{GenerationError, Role, describe};
use jointscope_fixture::{Effect, Fixture};
use jointscope_rig::{HammerSetup, Instrument, Outside, StructureError, frfs};
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};
use serde::Deserialize;
use serde::de::{Deserializer, Error};
use serde_json::{Value, json};

/// What is true of a case.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Truth {
    /// The case's number.
    #[serde(rename = "case")]
    pub index: usize,
    /// What its random numbers were seeded with: the seed, or the text of fresh cases.
    pub source: String,
    /// Whether it is one of the fresh cases.
    pub fresh: bool,
    /// How much was hidden.
    pub role: Role,
    /// The fixture with its true quantities, the hidden effects as its `physics`.
    pub fixture: Fixture,
    /// Hidden physics that no effect describes.
    pub outside: Option<Outside>,
    /// How it was measured.
    pub hammer: HammerSetup,
    /// FRFs that nobody recorded.
    #[serde(deserialize_with = "filed_pairs")]
    pub unseen: Vec<FrfPair>,
}

/// FRFs by their names, `4/1`.
pub(crate) fn filed_pairs<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<FrfPair>, D::Error> {
    let names = Vec::<String>::deserialize(deserializer)?;
    let pair = |name: &String| name.split_once('/').map(|(to, from)| FrfPair::transverse(to, from));
    names.iter().map(pair).collect::<Option<_>>().ok_or_else(|| D::Error::custom("no FRF has such a name"))
}

impl Truth {
    /// The hidden effects.
    pub fn effects(&self) -> &[Effect] {
        self.fixture.physics()
    }

    /// What was hidden, in words.
    pub fn hidden(&self) -> String {
        let effects = self.effects().iter().map(describe);
        let all: Vec<String> = effects.chain(self.outside.iter().map(|o| o.to_string())).collect();
        if all.is_empty() { "nothing".to_owned() } else { all.join(" and ") }
    }

    /// Noise-free accelerances of the true structure.
    ///
    /// # Errors
    /// As [`jointscope_rig::frfs`].
    pub(crate) fn frfs(
        &self,
        pairs: &[FrfPair],
        lines: &SpectralLines,
        instrument: Instrument,
    ) -> Result<FrfSet, StructureError> {
        match &self.outside {
            Some(outside) => outside.frfs(&self.fixture, pairs, lines, instrument),
            None => frfs(&self.fixture, pairs, lines, instrument),
        }
    }

    /// The FRFs that nobody recorded, as a perfect instrument would read them, without noise.
    ///
    /// # Errors
    /// As [`jointscope_rig::frfs`].
    pub fn unseen(&self) -> Result<FrfSet, GenerationError> {
        Ok(self.frfs(&self.unseen, &recorded_lines()?, Instrument::Perfect)?)
    }
}

impl Sealable for Truth {
    fn to_value(&self) -> Value {
        let mut outside = json!(self.outside);
        // What was sealed once has its kind last.
        if let Some(kind) = outside.as_object_mut().and_then(|entries| entries.shift_remove("kind")) {
            outside["kind"] = kind;
        }
        json!({
            "case": self.index,
            "source": self.source,
            "fresh": self.fresh,
            "role": self.role,
            "hidden": self.hidden(),
            "fixture": self.fixture,
            "outside": outside,
            "hammer": self.hammer,
            "unseen": self.unseen,
        })
    }
}

impl Filed for Truth {
    fn from_value(value: &Value) -> Option<Self> {
        Truth::deserialize(value).ok()
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
            assert_eq!(read.unseen().unwrap(), truth.unseen().unwrap(), "case {}", truth.index);
        }
    }
}
