//! What a reader of the modes should know.

use crate::Remarks;
use crate::format::significant;
use crate::joint::merging;
use jointscope_modes::{ModalAnalysis, Mode, UnevenScale};
use jointscope_spectra::{FrfPair, in_sentence};

/// How far to trust the modes.
impl Remarks for ModalAnalysis {
    fn remarks(&self) -> Vec<String> {
        let merged = self.merged_from.and_then(|recorded| merging(recorded, self.lines().len()));
        let mut all = Vec::new();
        if self.pairs().len() == 1 {
            all.push(
                "there is one FRF: no shape is told, modes with a node at either channel do not show, and whether the structure changed between records cannot be seen"
                    .to_owned(),
            );
        } else if !self.complete {
            all.push(
                "not every response was measured to every reference: the FRFs share their poles only, which tells close modes less well than a full matrix does"
                    .to_owned(),
            );
        }
        all.extend(self.uneven_scale().map(|uneven| of_uneven_scale(self.pairs(), &uneven)));
        for (frf, pair) in self.pairs().iter().enumerate() {
            if self.measured().values(frf).iter().all(|value| value.norm_sqr() == 0.0) {
                all.push(format!("FRF {pair} is zero on all lines: it was left out"));
            }
        }
        let scattered = self.noise.iter().filter(|n| n.is_by_scatter()).count();
        if scattered > 0 {
            let of_all = if scattered == self.noise.len() { "the".to_owned() } else { scattered.to_string() };
            all.push(format!(
                "no coherence and averages for {of_all} FRFs: their noise is what the modes leave of each"
            ));
        }
        all.extend(merged);
        if self.window_decay > 0.0 {
            all.push(format!(
                "the exponential window's decay of {} 1/s is taken off the damping ratios",
                significant(self.window_decay, 4)
            ));
        }
        let drifting: Vec<String> = self
            .modes
            .iter()
            .filter(|mode| mode.drift.is_some())
            .map(|mode| format!("{:.3}", mode.frequency))
            .collect();
        if !drifting.is_empty() {
            all.push(format!(
                "the resonances at {} Hz differ from FRF to FRF by more than noise, as when a structure warms up or a sensor's mass roves: no single pole fits them; frequency and \
                 damping ratio are means over the FRFs one by one, their ± the scatter of one more",
                drifting.join(", ")
            ));
        }
        if !self.is_explained() {
            let widened = match (drifting.len(), self.modes.len()) {
                (0, _) => "; every ± is widened by its root",
                (some, all) if some < all => "; the ± of the other modes are widened by its root",
                _ => "",
            };
            all.push(format!(
                "poles that all FRFs share leave {:.2} times the noise's variance in them{widened}",
                self.chi2_per_dof
            ));
        }
        all.extend(self.modes.iter().flat_map(of_mode));
        all
    }
}

fn of_uneven_scale(pairs: &[FrfPair], uneven: &UnevenScale) -> String {
    let of = |(frf, factor): &(usize, f64)| format!("{} by {}", pairs[*frf], significant(*factor, 3));
    let frfs: Vec<String> = uneven.frfs.iter().map(of).collect();
    let which = if frfs.len() == 1 { "one FRF is" } else { "one of these FRFs is" };
    format!(
        "modes are there twice, for {which} of another scale than the others make of it: {}; look at units, ranges and signs, and measure or convert it again",
        frfs.join(", ")
    )
}

fn of_mode(mode: &Mode) -> impl Iterator<Item = String> {
    let faint = (!mode.stands_out()).then(|| {
        format!(
            "the pole picked at {} Hz does not stand out of the noise: the FRFs are explained as well without it",
            in_sentence(mode.frequency)
        )
    });
    let vague = mode.is_vaguely_damped().then(|| {
        format!(
            "the damping ratio of the mode at {} Hz is known to {:.0} % only",
            in_sentence(mode.frequency),
            100.0 * mode.damping_std / mode.damping_ratio
        )
    });
    faint.into_iter().chain(vague)
}
