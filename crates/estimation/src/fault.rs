//! Why a hit is no good for an FRF.

use std::fmt;

use jointscope_hits::Hit;
use jointscope_spectra::Channel;

use crate::overload::is_cut_off;
use crate::pulse::Pulse;
use crate::settings::faults::{
    IN_CONTACT, ONE_SIDED, RESPONSE_STANDS_OUT, SECOND_STRIKE, STANDS_OUT, TO_AND_FRO, VALLEY,
};
use crate::settings::pulse::{EDGE, FILTER_RINGING};

/// Why a hit is no good for an FRF.
#[derive(Debug, Clone, PartialEq)]
pub enum Fault {
    /// The hammer struck again while the record ran.
    DoubleHit {
        /// When after the first, s.
        after: f64,
        /// Peak of the later strike relative to the first.
        ratio: f64,
    },
    /// A channel went beyond the range of its input.
    Overload {
        /// `force`, or the response's channel.
        signal: Signal,
        /// The value at which it is cut off, N or the response's unit.
        at: f64,
    },
    /// The record begins when the force is there already.
    StartsAfterImpact,
    /// No impact stands out of the force's noise.
    NoImpact,
    /// What is called the force rings like a response.
    ForceRings {
        /// The response that looks like a hammer's force instead, if one does.
        pulse_at: Option<Channel>,
    },
}

/// A signal of a hit.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Signal {
    /// The hammer's force.
    Force,
    /// The response at a channel.
    Response(Channel),
}

impl fmt::Display for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Signal::Force => write!(f, "the force"),
            Signal::Response(channel) => write!(f, "the response at {channel}"),
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Fault::DoubleHit { after, ratio } => {
                let (percent, ms) = (100.0 * ratio, 1e3 * after);
                write!(f, "double hit: the hammer struck again {ms:.1} ms later, {percent:.0} % as hard")
            }
            Fault::Overload { signal, at } => {
                let unit = if *signal == Signal::Force { " N" } else { "" };
                write!(
                    f,
                    "overload: {signal} is cut off at {}{unit}, widen the range of its input",
                    figures(*at)
                )
            }
            Fault::StartsAfterImpact => {
                write!(f, "the record starts when the hammer is in contact already: set a pre-trigger")
            }
            Fault::NoImpact => write!(f, "no impact stands out of the force's noise"),
            Fault::ForceRings { pulse_at: Some(channel) } => write!(
                f,
                "the force rings like a response, and the response at {channel} looks like a hammer's force: the channels seem swapped"
            ),
            Fault::ForceRings { pulse_at: None } => {
                write!(f, "the force rings like a response instead of being a pulse")
            }
        }
    }
}

/// What is wrong with a hit whose `force` has no offset any more.
pub(crate) fn faults(hit: &Hit, force: &[f64], pulse: Option<&Pulse>) -> Vec<Fault> {
    let Some(pulse) = pulse else { return vec![Fault::NoImpact] };
    let mut faults = Vec::new();
    if rings(force, pulse) {
        let swapped = pulse_among_responses(hit);
        let noise_alone = swapped.is_none() && pulse.peak.abs() < STANDS_OUT * pulse.noise;
        return vec![if noise_alone { Fault::NoImpact } else { Fault::ForceRings { pulse_at: swapped } }];
    }
    if pulse.peak.abs() < STANDS_OUT * pulse.noise {
        return vec![Fault::NoImpact];
    }
    if force[0] * pulse.peak.signum() > IN_CONTACT * EDGE * pulse.peak.abs() {
        faults.push(Fault::StartsAfterImpact);
    }
    if let Some((at, peak)) = second_strike(force, pulse) {
        let after = (at as f64 - pulse.peak_at as f64).abs() * hit.interval();
        faults.push(Fault::DoubleHit { after, ratio: peak / pulse.peak.abs() });
    }
    let signals = std::iter::once((Signal::Force, hit.force()))
        .chain(hit.responses().iter().map(|r| (Signal::Response(r.channel.clone()), r.values.as_slice())));
    for (signal, values) in signals {
        if let Some(at) = is_cut_off(values) {
            faults.push(Fault::Overload { signal, at });
        }
    }
    faults
}

/// Four significant digits, without zeros that say nothing.
fn figures(value: f64) -> String {
    let exponent = value.abs().log10().floor().clamp(-12.0, 12.0) as i32;
    let digits = format!("{value:.*}", (3 - exponent).max(0) as usize);
    match digits.contains('.') {
        true => digits.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => digits,
    }
}

/// Whether a signal swings to and fro instead of pushing one way.
fn rings(values: &[f64], pulse: &Pulse) -> bool {
    let sizeable = values.iter().filter(|v| v.abs() > EDGE * pulse.peak.abs());
    let (mut to, mut fro) = (0.0, 0.0);
    for value in sizeable {
        let side = if value * pulse.peak > 0.0 { &mut to } else { &mut fro };
        *side += value * value;
    }
    fro > TO_AND_FRO * to
}

/// The response that is a hammer's pulse, if one is.
fn pulse_among_responses(hit: &Hit) -> Option<Channel> {
    let is_pulse = |values: &[f64]| {
        let mut values = values.to_vec();
        crate::baseline::remove(&mut values, crate::Baseline::Offset, 0);
        let pulse = Pulse::of(&values);
        pulse.is_some_and(|pulse| {
            pulse.peak.abs() > RESPONSE_STANDS_OUT * STANDS_OUT * pulse.noise && !rings(&values, &pulse)
        })
    };
    hit.responses().iter().find(|r| is_pulse(&r.values)).map(|r| r.channel.clone())
}

/// The largest other strike of the hammer: its sample and its height.
fn second_strike(force: &[f64], pulse: &Pulse) -> Option<(usize, f64)> {
    let sign = pulse.peak.signum();
    let threshold = (SECOND_STRIKE * pulse.peak.abs()).max(STANDS_OUT * pulse.noise);
    let push = |i: usize| force[i] * sign;
    let n = force.len();
    let is_peak = |i: &usize| {
        let i = *i;
        push(i) > threshold
            && (i == 0 || push(i) >= push(i - 1))
            && (i + 1 == n || push(i) > push(i + 1))
            && i != pulse.peak_at
    };
    let apart = |i: &usize| {
        let between = if *i > pulse.peak_at { pulse.peak_at..*i } else { *i..pulse.peak_at };
        between.map(push).fold(f64::INFINITY, f64::min) < VALLEY * push(*i)
    };
    let one_sided = |i: &usize| {
        let near = i.saturating_sub(FILTER_RINGING)..(i + FILTER_RINGING + 1).min(n);
        near.map(|j| -push(j)).fold(0.0, f64::max) * ONE_SIDED < push(*i)
    };
    (0..n)
        .filter(is_peak)
        .filter(apart)
        .filter(one_sided)
        .max_by(|a, b| push(*a).total_cmp(&push(*b)))
        .map(|i| (i, push(i)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn half_sine(force: &mut [f64], at: usize, width: usize, peak: f64) {
        for i in 0..width {
            force[at + i] += peak * (std::f64::consts::PI * (i as f64 + 0.5) / width as f64).sin();
        }
    }

    fn strike(second: impl Fn(&mut [f64])) -> Option<(usize, f64)> {
        let mut force = vec![0.0; 1000];
        half_sine(&mut force, 60, 6, 100.0);
        second(&mut force);
        second_strike(&force, &Pulse::of(&force)?)
    }

    #[test]
    fn a_second_strike_is_found_soon_and_late_and_before_a_harder_one() {
        assert_eq!(strike(|_| ()), None);
        assert!(strike(|f| half_sine(f, 68, 6, 30.0)).is_some_and(|(at, _)| (70..=71).contains(&at)));
        assert!(strike(|f| half_sine(f, 700, 6, 8.0)).is_some_and(|(_, peak)| (7.5..8.1).contains(&peak)));
        assert!(strike(|f| half_sine(f, 20, 6, 40.0)).is_some_and(|(at, _)| (22..=23).contains(&at)));
        assert_eq!(strike(|f| half_sine(f, 300, 6, 3.0)), None);
    }

    #[test]
    fn the_ringing_of_an_anti_alias_filter_is_no_second_strike() {
        let ringing = |f: &mut [f64]| {
            for (i, value) in f[66..100].iter_mut().enumerate() {
                *value += 16.0 * (-0.2 * i as f64).exp() * if i % 2 == 0 { -1.0 } else { 1.0 };
            }
        };
        assert_eq!(strike(ringing), None);
    }

    #[test]
    fn a_pulse_with_two_humps_of_one_contact_is_one_strike() {
        assert_eq!(strike(|f| half_sine(f, 63, 6, 90.0)), None);
    }
}
