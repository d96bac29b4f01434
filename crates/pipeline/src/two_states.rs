//! A structure in two states, before and now, seen under one exponential window. One that lies on the FRFs of
//! one state alone, or on both with another decay, makes every mode look more damped there: no change of the
//! structure.

use crate::{MeasuredFrfs, Measurement};
use jointscope_estimation::{EstimateOptions, ResponseWindow};

/// How hits of both states are to be estimated, and what a reader should know where FRFs that were recorded as
/// such cannot be made alike any more.
#[derive(Debug, Clone, PartialEq)]
pub struct Alike {
    /// Options for hits, of both states.
    pub estimate: EstimateOptions,
    /// One plain sentence, where windows differ all the same.
    pub note: Option<String>,
}

impl Alike {
    /// Of two states of hits the longer of the windows that each needs by itself lies on both; of hits and
    /// recorded FRFs that of the FRFs. What cannot be estimated changes nothing here: whoever estimates it is
    /// told why.
    pub fn of(before: &Measurement, now: &Measurement, options: &EstimateOptions) -> Self {
        let decay = |state| MeasuredFrfs::of(state, options).map(|measured| measured.window_decay);
        let as_asked = || Alike { estimate: options.clone(), note: None };
        let (Ok(then), Ok(today)) = (decay(before), decay(now)) else { return as_asked() };
        if then == today {
            return as_asked();
        }
        let (estimate, note) = match (before, now) {
            (Measurement::Hits(_), Measurement::Hits(_)) => (windowed(options, then.max(today)), None),
            (Measurement::Hits(_), Measurement::Frfs(_)) => (windowed(options, today), None),
            (Measurement::Frfs(_), Measurement::Hits(_)) => (windowed(options, then), None),
            (Measurement::Frfs(_), Measurement::Frfs(_)) => (options.clone(), Some(unlike(then, today))),
        };
        Alike { estimate, note }
    }
}

fn windowed(options: &EstimateOptions, decay: f64) -> EstimateOptions {
    let response_window = if decay > 0.0 { ResponseWindow::Decay(decay) } else { ResponseWindow::None };
    EstimateOptions { response_window, ..options.clone() }
}

fn unlike(then: f64, today: f64) -> String {
    format!(
        "the baseline's FRFs are under an exponential window of decay {then} 1/s, the recording's under one of {today} 1/s: \
         what has changed in damping is off by that; measure both under the same window"
    )
}
