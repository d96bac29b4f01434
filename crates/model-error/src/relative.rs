//! A recording's modes for a model that is calibrated on another recording, the baseline.

use crate::matching::Pairing;
use crate::modelled::ModelledModes;
use crate::recorded::{Offsets, RecordedModes};
use num_complex::Complex64;

impl RecordedModes {
    /// These modes as a model that is calibrated on a `baseline` should have them: what the baseline's poles
    /// differ by from those of the model (`modelled`, paired by `pairing`) is taken off, what its residues
    /// differ by is added to those of whatever model they are compared with, as its channels read it, and the
    /// covariance of both is added. Modes that the baseline does not show are left out.
    ///
    /// `None` where the FRFs are not the same.
    pub fn relative_to(
        &self,
        baseline: &RecordedModes,
        modelled: &ModelledModes,
        [own, of_baseline]: [&Pairing; 2],
    ) -> Option<Self> {
        if self.pairs != baseline.pairs {
            return None;
        }
        let frfs = self.frfs();
        let mut relative = self.clone();
        let mut shared = Vec::new();
        let mut offsets = vec![vec![Complex64::ZERO; frfs]; relative.modes.len()];
        for (r, mode) in relative.modes.iter_mut().enumerate() {
            let model = own.pairs.iter().find(|(recorded, _)| *recorded == r).map(|(_, m)| *m);
            let pair = model.and_then(|m| of_baseline.pairs.iter().find(|(_, other)| *other == m));
            let Some(&(b, m)) = pair else {
                mode.resolved = false;
                continue;
            };
            let (was, model) = (&baseline.modes[b], &modelled.modes[m]);
            mode.pole.omega *= model.pole.omega / was.pole.omega;
            mode.pole.damping_ratio *= model.pole.damping_ratio / was.pole.damping_ratio;
            let offset = |frf: usize| {
                let with_leak = model.residues[frf] + modelled.leaks[frf][b];
                (was.residues[frf] - with_leak) / modelled.signals[m][frf]
            };
            offsets[r] = (0..frfs).map(offset).collect();
            shared.push((r, b));
        }
        let both = baseline.residual_terms.iter().zip(&modelled.residual_terms);
        let terms = both.map(|(was, model)| std::array::from_fn(|k| was[k] - model[k])).collect();
        let signals_at_ends = modelled.signals_at_ends.clone();
        relative.offsets = Some(Offsets { residues: offsets, terms, signals_at_ends });
        let place = |modes: &RecordedModes, r: usize| {
            let residues = 2 * modes.modes.len() + 2 * r * frfs;
            [2 * r, 2 * r + 1].into_iter().chain(residues..residues + 2 * frfs)
        };
        let terms = |modes: &RecordedModes| {
            let first = 2 * modes.modes.len() * (1 + frfs);
            first..first + 2 * frfs
        };
        // (own place, the baseline's place, ratio of their scales)
        let mut places: Vec<(usize, usize, f64)> = Vec::new();
        for &(r, b) in &shared {
            let ratio = baseline.modes[b].scale / self.modes[r].scale;
            let both = place(self, r).zip(place(baseline, b)).enumerate();
            places.extend(both.map(|(k, (own, other))| (own, other, if k < 2 { 1.0 } else { ratio })));
        }
        for (k, (own, other)) in terms(self).zip(terms(baseline)).enumerate() {
            places.push((own, other, baseline.residual_scales[k % 2] / self.residual_scales[k % 2]));
        }
        let (n, m) = (self.count(), baseline.count());
        for &(i, a, by) in &places {
            for &(j, b, and) in &places {
                relative.covariance[i * n + j] += by * and * baseline.covariance[a * m + b];
            }
        }
        Some(relative)
    }
}
