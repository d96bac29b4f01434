//! The signals of a hammer hit: one force and the responses to it over time, in SI units and the fixture's
//! terms.
//!
//! * [`Hit`]: what was recorded from one blow, all channels on the same sampling instants;
//! * [`Response`]: one sensor's signal and the [`MeasuredMotion`] it measures;
//! * [`Fourier`], [`InverseFourier`]: signals as spectral lines, and back.
//!
//! ```
//! use jointscope_hits::{Hit, MeasuredMotion, Response};
//! use jointscope_spectra::Channel;
//!
//! let force = vec![0.0, 120.0, 80.0, 0.0];
//! let answer = Response::new(Channel::transverse("4"), MeasuredMotion::Acceleration, vec![0.0, 3.1, -2.0, 0.4]);
//! let hit = Hit::new(1, 1.0 / 6400.0, 0.0, Channel::transverse("1"), force, vec![answer])?;
//! assert_eq!(hit.peak_force(), 120.0);
//! assert_eq!(hit.samples(), 4);
//! # Ok::<(), jointscope_hits::HitError>(())
//! ```

mod fourier;

pub use fourier::{Fourier, InverseFourier};

use jointscope_spectra::Channel;

/// What a sensor measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum MeasuredMotion {
    /// m, or rad.
    Displacement,
    /// m/s, or rad/s.
    Velocity,
    /// m/s², or rad/s².
    Acceleration,
}

impl MeasuredMotion {
    /// The word for it: `displacement`, `velocity` or `acceleration`.
    pub fn name(self) -> &'static str {
        match self {
            MeasuredMotion::Displacement => "displacement",
            MeasuredMotion::Velocity => "velocity",
            MeasuredMotion::Acceleration => "acceleration",
        }
    }
}

/// One sensor's signal during a hit.
#[derive(Debug, Clone, PartialEq)]
pub struct Response {
    /// Where it sits, and whether it follows y or θ.
    pub channel: Channel,
    /// What it measures.
    pub motion: MeasuredMotion,
    /// Its samples along +y or +θ, SI units.
    pub values: Vec<f64>,
}

impl Response {
    /// A sensor's signal.
    pub fn new(channel: Channel, motion: MeasuredMotion, values: Vec<f64>) -> Self {
        Response { channel, motion, values }
    }
}

/// Force and responses of one hit, on common sampling instants.
#[derive(Debug, Clone, PartialEq)]
pub struct Hit {
    number: u32,
    interval: f64,
    start: f64,
    struck: Channel,
    force: Vec<f64>,
    responses: Vec<Response>,
}

/// What makes the signals of a hit impossible.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum HitError {
    /// The interval between samples is not a positive number.
    #[error("hit {hit} has a sampling interval of {interval} s: a positive one is needed")]
    Interval {
        /// The hit's number.
        hit: u32,
        /// The interval found, s.
        interval: f64,
    },
    /// A force without samples.
    #[error("hit {hit} has no samples")]
    Empty {
        /// The hit's number.
        hit: u32,
    },
    /// Force and response differ in length.
    #[error(
        "hit {hit} has {force} samples of force and {response} of the response at {channel}: record both equally long"
    )]
    Length {
        /// The hit's number.
        hit: u32,
        /// Samples of force.
        force: usize,
        /// Samples of the response.
        response: usize,
        /// The response.
        channel: Channel,
    },
    /// A sample is not a finite number.
    #[error("hit {hit}: sample {sample} of {signal} is not a finite number")]
    NotFinite {
        /// The hit's number.
        hit: u32,
        /// Index of the sample, from 0.
        sample: usize,
        /// `the force`, or which response.
        signal: String,
    },
    /// One response twice.
    #[error("hit {hit} holds the response at {channel} twice")]
    Twice {
        /// The hit's number.
        hit: u32,
        /// The response.
        channel: Channel,
    },
}

impl Hit {
    /// A hit from its signals: `interval` between samples and instant of the first sample in s, force in N
    /// along +y (or N·m along +θ).
    ///
    /// # Errors
    /// Signals of different length, of no samples or with values that are no finite numbers, a response given
    /// twice.
    pub fn new(
        number: u32,
        interval: f64,
        start: f64,
        struck: Channel,
        force: Vec<f64>,
        responses: Vec<Response>,
    ) -> Result<Self, HitError> {
        if !(interval.is_finite() && interval > 0.0 && start.is_finite()) {
            return Err(HitError::Interval { hit: number, interval });
        }
        if force.is_empty() {
            return Err(HitError::Empty { hit: number });
        }
        for (i, response) in responses.iter().enumerate() {
            let channel = response.channel.clone();
            if response.values.len() != force.len() {
                let (force, response) = (force.len(), response.values.len());
                return Err(HitError::Length { hit: number, force, response, channel });
            }
            if responses[..i].iter().any(|r| r.channel == channel && r.motion == response.motion) {
                return Err(HitError::Twice { hit: number, channel });
            }
        }
        let named = |r: &Response| format!("the {} at {}", r.motion.name(), r.channel);
        let signals = responses.iter().map(|r| (r.values.as_slice(), Some(r)));
        for (values, response) in std::iter::once((force.as_slice(), None)).chain(signals) {
            if let Some(sample) = values.iter().position(|v| !v.is_finite()) {
                let signal = response.map_or("the force".to_string(), named);
                return Err(HitError::NotFinite { hit: number, sample, signal });
            }
        }
        Ok(Hit { number, interval, start, struck, force, responses })
    }

    /// The hit's number in its test.
    pub fn number(&self) -> u32 {
        self.number
    }

    /// Interval between samples, s.
    pub fn interval(&self) -> f64 {
        self.interval
    }

    /// Instant of the first sample, s.
    pub fn start(&self) -> f64 {
        self.start
    }

    /// Number of samples of every signal.
    pub fn samples(&self) -> usize {
        self.force.len()
    }

    /// Where the hammer struck.
    pub fn struck(&self) -> &Channel {
        &self.struck
    }

    /// The force's samples, N (N·m for a moment).
    pub fn force(&self) -> &[f64] {
        &self.force
    }

    /// The responses, in the order they were given.
    pub fn responses(&self) -> &[Response] {
        &self.responses
    }

    /// The largest force of either sign, N.
    pub fn peak_force(&self) -> f64 {
        self.force.iter().fold(0.0, |peak, f| f.abs().max(peak))
    }
}
