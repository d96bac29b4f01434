//! A measurement that a plan suggests, and what is expected of it, as `plan.json` states it.

use crate::measure::Measure;
use crate::settings::outcome::SURE;
use serde::Serialize;

/// One measurement and what it would bring.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Suggestion {
    /// What to measure, in short: `frf 2/1`.
    pub measure: String,
    /// The same as a sentence without its full stop.
    pub to_do: String,
    /// The same in its parts.
    pub action: Measure,
    /// Expected ln of the Bayes factor for the true name against its nearest rival, nats; the names as
    /// probable as they are now.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub expected_log_odds: Option<f64>,
    /// Box & Hill's expected gain over all pairs of names, nats.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub box_hill: Option<f64>,
    /// Probability that the diagnosis then gives the true name a probability of 0.9 or more: the promise.
    #[serde(rename = "promise", skip_serializing_if = "Option::is_none")]
    pub sure: Option<f64>,
    /// Pairs of names that it tells apart, whichever of the two is true, with a probability of 0.9 or more.
    pub separates: Vec<[String; 2]>,
    /// What it would leave of a wanted interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interval: Option<ExpectedInterval>,
    /// How much work it is, in FRFs to be recorded.
    pub effort: f64,
    /// All of it in a sentence.
    pub says: String,
}

impl Suggestion {
    /// Whether it promises what the plan is for: one name sure thereafter, or an interval as narrow as
    /// wanted.
    pub fn is_promising(&self) -> bool {
        let reaches = self.interval.as_ref().is_some_and(|interval| interval.reaches);
        reaches || self.sure.is_some_and(|sure| sure >= SURE)
    }
}

/// An interval of a joint's element that a measurement would leave.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExpectedInterval {
    /// The element: `k11 of joint J`.
    pub element: String,
    /// Its value.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// Half of the 95 % interval at present; `None` where nothing was recorded yet.
    pub now: Option<f64>,
    /// The same with the measurement.
    pub then: f64,
    /// Whether that is as narrow as wanted.
    pub reaches: bool,
}
