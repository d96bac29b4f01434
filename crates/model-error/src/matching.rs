//! Which mode of a model is which of a recording: the assignment of least cost that keeps the order of both,
//! by dynamic programming, with a cost for modes left alone. Frequencies cost by their distance, shapes by
//! their modal assurance criterion (MAC).

use crate::modelled::ModelledModes;
use crate::poles::ModelledMode;
use crate::recorded::{RecordedMode, RecordedModes};
use crate::settings::matching::{
    DAMPING_DECADES, FREQUENCY_BESIDE_SHAPES, FREQUENCY_WITHOUT_SHAPES, MOST_DISTANCE, MOST_UNSEEN,
    PLACED_FREQUENCY, UNLIKE_SHAPES, WITHOUT_PARTNER,
};
use jointscope_modes::mac;
use std::f64::consts::{PI, TAU};

/// Modes of a recording with those of a model, in the order of frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Pairing {
    /// (recorded, modelled), ascending.
    pub pairs: Vec<(usize, usize)>,
    /// Log-density of the recorded modes that the model does not have, as modes of anything.
    pub(crate) unmodelled: f64,
    /// Log-likelihood that a recording does not show the modes that the model has in the band besides.
    pub(crate) unseen: f64,
}

impl Pairing {
    /// The pairing of lowest cost that keeps the order of both.
    pub fn of(recorded: &RecordedModes, modelled: &ModelledModes) -> Self {
        let (a, b) = (&recorded.modes, &modelled.modes);
        let cost = |a: &RecordedMode, b: &ModelledMode| {
            let apart = (a.pole.omega / b.pole.omega).ln().abs();
            match a.residues.len() {
                1 => FREQUENCY_WITHOUT_SHAPES * apart,
                _ => {
                    FREQUENCY_BESIDE_SHAPES * apart.min(MOST_DISTANCE)
                        + UNLIKE_SHAPES * (1.0 - mac(&a.residues, &b.residues))
                }
            }
        };
        let (n, m) = (a.len(), b.len());
        let mut best = vec![vec![0.0; m + 1]; n + 1];
        for i in 0..=n {
            for j in 0..=m {
                if i == 0 && j == 0 {
                    continue;
                }
                let skip_recorded = if i > 0 { best[i - 1][j] + WITHOUT_PARTNER } else { f64::INFINITY };
                let skip_modelled =
                    if j > 0 { best[i][j - 1] + alone(recorded, &b[j - 1]) } else { f64::INFINITY };
                let both = if i > 0 && j > 0 {
                    best[i - 1][j - 1] + cost(&a[i - 1], &b[j - 1])
                } else {
                    f64::INFINITY
                };
                best[i][j] = skip_recorded.min(skip_modelled).min(both);
            }
        }
        let mut pairs = Vec::new();
        let (mut unmodelled, mut unseen) = (0.0, 0.0);
        let (mut i, mut j) = (n, m);
        while i > 0 || j > 0 {
            if i > 0 && j > 0 && best[i][j] == best[i - 1][j - 1] + cost(&a[i - 1], &b[j - 1]) {
                pairs.push((i - 1, j - 1));
                (i, j) = (i - 1, j - 1);
            } else if i > 0 && best[i][j] == best[i - 1][j] + WITHOUT_PARTNER {
                // Too low to be compared in its residues, a mode that stands where it stands is there all the
                // same.
                let is_there = a[i - 1].resolved || recorded.deviations(i - 1)[0] < PLACED_FREQUENCY;
                unmodelled += if is_there { of_anything(recorded, &a[i - 1]) } else { 0.0 };
                i -= 1;
            } else {
                unseen -= visible(recorded, &b[j - 1]).min(MOST_UNSEEN);
                j -= 1;
            }
        }
        pairs.reverse();
        pairs.retain(|&(r, _)| a[r].resolved);
        Pairing { pairs, unmodelled, unseen }
    }

    /// This pairing with a mode that has no partner in the place of the next one that has, above or below:
    /// where a model is far off, its mode may be taken for another's neighbour, and no fit leads from there.
    pub fn others(&self, recorded: &RecordedModes, modelled: &ModelledModes) -> Vec<Self> {
        let unseen = |m: usize| visible(recorded, &modelled.modes[m]).min(MOST_UNSEEN);
        // The pairs on either side of a mode that has none of its own.
        let beside = |mode: usize, own: fn(&(usize, usize)) -> usize| {
            let above = self.pairs.partition_point(|pair| own(pair) < mode);
            let is_paired = self.pairs.get(above).is_some_and(|pair| own(pair) == mode);
            let places = above.saturating_sub(1)..(above + 1).min(self.pairs.len());
            places.filter(move |_| !is_paired)
        };
        let swapped = |at: usize, pair: (usize, usize)| {
            let mut other = self.clone();
            let had = std::mem::replace(&mut other.pairs[at], pair);
            if had.1 != pair.1 {
                other.unseen = self.unseen + unseen(pair.1) - unseen(had.1);
            }
            other
        };
        let resolved = (0..recorded.modes.len()).filter(|&r| recorded.modes[r].resolved);
        let seen = (0..modelled.modes.len()).filter(|&m| alone(recorded, &modelled.modes[m]) > 0.0);
        let of_recorded = resolved.flat_map(|r| beside(r, |pair| pair.0).map(move |at| (at, r)));
        let of_modelled = seen.flat_map(|m| beside(m, |pair| pair.1).map(move |at| (at, m)));
        let of_recorded = of_recorded.map(|(at, r)| swapped(at, (r, self.pairs[at].1)));
        of_recorded.chain(of_modelled.map(|(at, m)| swapped(at, (self.pairs[at].0, m)))).collect()
    }

    /// What modes without a partner add to the logarithm of the evidence, nats: recorded ones as modes of
    /// anything, those of the model by half the χ² that the recording would show of them, 60 nats at most.
    pub fn alone(&self) -> f64 {
        self.unmodelled + self.unseen
    }
}

/// What it costs not to see a mode of the model: nothing outside the band.
fn alone(recorded: &RecordedModes, mode: &ModelledMode) -> f64 {
    let hz = mode.pole.omega / TAU;
    if hz < recorded.resolved_from || hz > recorded.band.1 { 0.0 } else { WITHOUT_PARTNER }
}

/// Log-density of a mode's features where it may be a mode of anything: any frequency in the band, any
/// damping ratio of some decades, residues of its own size.
fn of_anything(recorded: &RecordedModes, mode: &RecordedMode) -> f64 {
    let frequency = (recorded.band.1 / recorded.band.0).ln().ln();
    let damping = (DAMPING_DECADES * 10f64.ln()).ln();
    let frfs = mode.residues.len() as f64;
    -(frequency + damping + frfs * (TAU.ln() + 0.5))
}

/// Half the χ² that a mode would make if the recording did not have it.
fn visible(recorded: &RecordedModes, mode: &ModelledMode) -> f64 {
    let hz = mode.pole.omega / TAU;
    let (low, high) = recorded.band;
    if hz < recorded.resolved_from || hz > high {
        return 0.0;
    }
    let spacing = (high - low) / (recorded.outline.recorded as f64 - 1.0).max(1.0);
    // Near the resonance |s²/(s² + 2ζωs + ω²)|² ≈ (ω²/4)/((ω' − ω)² + ζ²ω²), whose integral over frequency is
    // πf/(4ζ): over the spacing, the sum over lines.
    let lines = PI * hz / (4.0 * mode.pole.damping_ratio.max(1e-9)) / spacing;
    let sizes = mode.residues.iter().zip(&recorded.outline.weights);
    0.5 * sizes.map(|(a, weight)| a.norm_sqr() * weight * lines).sum::<f64>()
}
