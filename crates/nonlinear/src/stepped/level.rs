//! One level of a stepped-sine test.

use jointscope_spectra::{Channel, FrfSet};
use serde::{Serialize, Serializer};
use std::fmt;

/// The amplitude that a stepped-sine test held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Held {
    /// Amplitude of the exciting force, N.
    Force(f64),
    /// Amplitude of the acceleration of the driving point (or of the first response, without one), m/s².
    Response(f64),
}

impl Held {
    /// The number alone.
    pub(crate) fn amplitude(self) -> f64 {
        match self {
            Held::Force(value) | Held::Response(value) => value,
        }
    }

    fn unit(self) -> &'static str {
        match self {
            Held::Force(_) => "N",
            Held::Response(_) => "m/s^2",
        }
    }
}

impl fmt::Display for Held {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.amplitude(), self.unit())
    }
}

impl Serialize for Held {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Entry {
            quantity: &'static str,
            amplitude: f64,
            unit: &'static str,
        }
        let quantity = match self {
            Held::Force(_) => "force",
            Held::Response(_) => "response",
        };
        Entry { quantity, amplitude: self.amplitude(), unit: self.unit() }.serialize(serializer)
    }
}

/// FRFs at one level.
#[derive(Debug, Clone, PartialEq)]
pub struct SteppedLevel {
    /// What was held.
    pub held: Held,
    /// Accelerances between channels of the fixture.
    pub frfs: FrfSet,
}

impl SteppedLevel {
    /// The FRF at whose response the amplitude is held: the driving point, or the first.
    pub(crate) fn watched(&self) -> usize {
        self.frfs.pairs().iter().position(|pair| pair.response == pair.reference).unwrap_or(0)
    }

    /// That response, where one was held and no driving point tells which.
    pub(crate) fn held_at(&self) -> Option<Channel> {
        let pair = &self.frfs.pairs()[self.watched()];
        let told = pair.response == pair.reference || matches!(self.held, Held::Force(_));
        (!told).then(|| pair.response.clone())
    }

    /// Sum of the FRFs' squares on a line.
    fn strength(&self, line: usize) -> f64 {
        (0..self.frfs.pairs().len()).map(|frf| self.frfs.values(frf)[line].norm_sqr()).sum()
    }

    /// The line of the highest response, and the width in Hz over which it stays above half its square.
    pub(crate) fn peak(&self) -> (f64, f64) {
        let hz = self.frfs.lines().hz();
        let strength: Vec<f64> = (0..hz.len()).map(|line| self.strength(line)).collect();
        let top = (0..hz.len()).fold(0, |top, line| if strength[line] > strength[top] { line } else { top });
        let high = |line: &usize| strength[*line] >= 0.5 * strength[top];
        let last = (top..hz.len()).take_while(high).last().unwrap_or(top);
        let first = (0..=top).rev().take_while(high).last().unwrap_or(top);
        let step = (hz[hz.len() - 1] - hz[0]) / (hz.len().max(2) - 1) as f64;
        (hz[top], (hz[last] - hz[first]).max(step))
    }

    /// The level on the lines from `from` to `to` Hz; `None` where there are none.
    pub(crate) fn within(&self, from: f64, to: f64) -> Option<Self> {
        let hz: Vec<f64> = self.frfs.lines().hz().to_vec();
        let frfs = self.frfs.on_lines(|line| hz[line] >= from && hz[line] <= to && hz[line] > 0.0)?;
        Some(SteppedLevel { held: self.held, frfs })
    }
}
