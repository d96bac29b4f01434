//! Whether what a file calls a coherence says anything of noise.
//!
//! A coherence γ² lies between 0 and 1 and varies from line to line; analysers also export per cent, zeros
//! where none was computed, ones where there was a single average, and values beyond one. Those say nothing,
//! and a variance made of them would decide everything.

use crate::error::enumeration;

/// How far a coherence may leave 0 … 1 by rounding.
const SLACK: f64 = 1e-6;
/// Below this on all lines a coherence is none.
const NOTHING: f64 = 1e-6;
/// From this share of lines on which it is one by all its digits, a coherence says nothing.
const ONES: f64 = 0.9;
const DIGITS: f64 = 1e-7;
/// Per cent are mostly above this, and never beyond a hundred.
const PER_CENT: (f64, f64) = (2.0, 100.0);

/// What a coherence is.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Coherence {
    /// Values between 0 and 1.
    Usable(Vec<f64>),
    /// The same, written in per cent.
    PerCent(Vec<f64>),
    /// No coherence, and why.
    Useless(Uselessness),
}

/// Why a coherence says nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Uselessness {
    Zero,
    One,
    Above,
    Below,
}

impl Coherence {
    pub(crate) fn of(values: Vec<f64>) -> Self {
        let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let share = |of: &dyn Fn(f64) -> bool| {
            values.iter().filter(|value| of(**value)).count() as f64 / values.len().max(1) as f64
        };
        if values.iter().any(|value| value.is_nan() || *value < -SLACK) {
            return Coherence::Useless(Uselessness::Below);
        }
        if largest > 1.0 + SLACK {
            let per_cent = largest <= PER_CENT.1 * (1.0 + SLACK) && share(&|value| value > PER_CENT.0) > 0.5;
            return match per_cent {
                true => {
                    Coherence::PerCent(values.into_iter().map(|value| (value / 100.0).min(1.0)).collect())
                }
                false => Coherence::Useless(Uselessness::Above),
            };
        }
        if largest < NOTHING {
            return Coherence::Useless(Uselessness::Zero);
        }
        if share(&|value| value > 1.0 - DIGITS) > ONES {
            return Coherence::Useless(Uselessness::One);
        }
        Coherence::Usable(values)
    }
}

/// What to say of coherences, gathered over FRFs.
#[derive(Debug, Default)]
pub(crate) struct CoherenceNotes {
    per_cent: Vec<String>,
    useless: Vec<(Uselessness, String)>,
}

impl CoherenceNotes {
    /// The coherence of FRF `name` as far as it says anything.
    pub(crate) fn usable(&mut self, name: String, values: Vec<f64>) -> Option<Vec<f64>> {
        match Coherence::of(values) {
            Coherence::Usable(values) => Some(values),
            Coherence::PerCent(values) => {
                self.per_cent.push(name);
                Some(values)
            }
            Coherence::Useless(why) => {
                self.useless.push((why, name));
                None
            }
        }
    }

    pub(crate) fn into_texts(mut self) -> Vec<String> {
        let mut texts = Vec::new();
        if !self.per_cent.is_empty() {
            texts.push(format!(
                "the coherence of {} is in per cent: taken as such",
                enumeration(self.per_cent)
            ));
        }
        self.useless.sort();
        for same in self.useless.chunk_by(|a, b| a.0 == b.0) {
            let why = match same[0].0 {
                Uselessness::Zero => "is zero on all lines",
                Uselessness::One => {
                    "is one on nearly all lines, as with a single average or a test without noise"
                }
                Uselessness::Above => "is above one, which no coherence is",
                Uselessness::Below => "is negative or no number, which no coherence is",
            };
            let names = enumeration(same.iter().map(|(_, name)| name));
            texts.push(format!(
                "the coherence of {names} {why}: left out, and the noise taken from the scatter over the lines; export it again, with several averages"
            ));
        }
        texts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(value: impl Fn(usize) -> f64) -> Coherence {
        Coherence::of((0..200).map(value).collect())
    }

    #[test]
    fn a_coherence_is_what_lies_between_zero_and_one_and_varies() {
        assert!(matches!(of(|i| 0.9 + 0.0004 * i as f64), Coherence::Usable(_)));
        assert!(matches!(of(|i| if i < 20 { 1.0 + 1e-7 } else { 0.999 }), Coherence::Usable(_)));
        assert_eq!(of(|_| 0.0), Coherence::Useless(Uselessness::Zero));
        assert_eq!(of(|i| if i == 3 { 0.4 } else { 1.0 }), Coherence::Useless(Uselessness::One));
        assert_eq!(of(|i| if i == 3 { 1.32 } else { 0.9 }), Coherence::Useless(Uselessness::Above));
        assert_eq!(of(|i| if i == 3 { -0.2 } else { 0.9 }), Coherence::Useless(Uselessness::Below));
        assert_eq!(of(|i| if i == 3 { f64::NAN } else { 0.9 }), Coherence::Useless(Uselessness::Below));
        assert_eq!(of(|i| 3.0 * i as f64), Coherence::Useless(Uselessness::Above));
    }

    #[test]
    fn per_cent_are_taken_as_such() {
        let Coherence::PerCent(values) = of(|i| 99.0 - 0.2 * i as f64) else { panic!("per cent") };
        assert!((values[100] - 0.79).abs() < 1e-12);
    }
}
