//! The stabilisation chart: poles of rising orders, and the tracks of those that stay.

use num_complex::Complex64;
use std::f64::consts::TAU;

use crate::polynomial::OrderPoles;
use crate::settings::stabilization::{
    FOLLOWED_FREQUENCY, FOLLOWED_HALF_WIDTHS, FOLLOWED_SPACING, MISSED_ORDERS, STABLE_DAMPING,
    STABLE_FREQUENCY,
};

/// How a pole compares with that of the order before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stability {
    /// No pole of the order before is near.
    New,
    /// The frequency stays.
    Frequency,
    /// Frequency and damping ratio stay.
    Stable,
}

/// A damped pole of the chart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChartPole {
    /// Order of the denominator.
    pub order: usize,
    /// Natural frequency, Hz.
    pub frequency: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
    /// How it compares with the order before.
    pub stability: Stability,
}

/// Poles of one column of the chart, by ascending order.
#[derive(Debug, Clone)]
pub(crate) struct Track {
    pub members: Vec<(usize, Complex64, Vec<Complex64>)>,
}

impl Track {
    /// The member in the middle of the others, by frequency and damping.
    pub(crate) fn middle(&self) -> (Complex64, Vec<Complex64>) {
        let median = |value: fn(&Complex64) -> f64| {
            let mut all: Vec<f64> = self.members.iter().map(|m| value(&m.1)).collect();
            all.sort_by(f64::total_cmp);
            all[all.len() / 2]
        };
        let (omega, sigma) = (median(|p| p.im), median(|p| -p.re));
        let distance =
            |pole: &Complex64| ((pole.im - omega) / sigma).powi(2) + (-pole.re / sigma).ln().powi(2);
        let best = (1..self.members.len()).fold(0, |best, i| {
            if distance(&self.members[i].1) < distance(&self.members[best].1) { i } else { best }
        });
        let (_, pole, participation) = &self.members[best];
        (*pole, participation.clone())
    }
}

/// The chart's poles and tracks, of lines `spacing` (rad/s) apart.
pub(crate) fn follow(orders: &[OrderPoles], spacing: f64) -> (Vec<ChartPole>, Vec<Track>) {
    let mut tracks: Vec<Track> = Vec::new();
    let mut chart = Vec::new();
    for (index, of_order) in orders.iter().enumerate() {
        let recent = orders[index.saturating_sub(MISSED_ORDERS + 1)].order;
        let mut matches: Vec<(f64, usize, usize)> = Vec::new();
        for (t, track) in tracks.iter().enumerate() {
            let Some((order, last, _)) = track.members.last() else { continue };
            if *order < recent {
                continue;
            }
            for (k, (pole, _)) in of_order.poles.iter().enumerate() {
                let reach = (FOLLOWED_FREQUENCY * last.im)
                    .max(FOLLOWED_HALF_WIDTHS * -last.re)
                    .max(FOLLOWED_SPACING * spacing);
                let distance = (pole - last).norm() / reach;
                if distance < 1.0 {
                    matches.push((distance, t, k));
                }
            }
        }
        matches.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut followed: Vec<Option<usize>> = vec![None; of_order.poles.len()];
        let mut taken = vec![false; tracks.len()];
        for (_, t, k) in matches {
            if followed[k].is_none() && !taken[t] {
                followed[k] = Some(t);
                taken[t] = true;
            }
        }
        for ((pole, participation), track) in of_order.poles.iter().zip(followed) {
            let member = (of_order.order, *pole, participation.clone());
            let stability = match track {
                Some(t) => {
                    let stability = tracks[t].members.last().map_or(Stability::New, |m| compare(pole, &m.1));
                    tracks[t].members.push(member);
                    stability
                }
                None => {
                    tracks.push(Track { members: vec![member] });
                    Stability::New
                }
            };
            chart.push(ChartPole {
                order: of_order.order,
                frequency: pole.norm() / TAU,
                damping_ratio: -pole.re / pole.norm(),
                stability,
            });
        }
    }
    (chart, tracks)
}

fn compare(pole: &Complex64, before: &Complex64) -> Stability {
    let (frequency, damping) = (pole.norm(), -pole.re / pole.norm());
    if (frequency - before.norm()).abs() > STABLE_FREQUENCY * frequency {
        return Stability::New;
    }
    let other = -before.re / before.norm();
    if (damping - other).abs() > STABLE_DAMPING * damping { Stability::Frequency } else { Stability::Stable }
}
