//! The verdict in a sentence: what is left out, or where what has no name sits and how it goes with frequency.

use super::names::named_with_size;
use super::numbers::{figures, listed, percent, plain, significant};
use super::swapped::swapped;
use crate::diagnosis::{Diagnosis, Finding, Verdict};
use crate::fit::Fit;
use crate::location::Location;
use jointscope_spectra::FrfPair;

/// Standard deviations beyond which a quantity is bent to imitate what is missing.
const BENT: f64 = 4.0;

/// χ² per real value of one FRF in bands: (from, to, χ²), Hz; nothing where no value of the band counts.
#[derive(Debug, Clone, PartialEq)]
pub struct FrfMisfit {
    /// The FRF.
    pub frf: FrfPair,
    /// Over all lines.
    pub whole: Option<f64>,
    /// By band, ascending.
    pub bands: Vec<(f64, f64, Option<f64>)>,
}

impl Diagnosis {
    /// The verdict in one plain sentence.
    pub fn says(&self) -> String {
        let [nominal, refitted, repaired] = self.chi2_per_dof();
        let [_, error_refitted, error_repaired] = self.nrmse();
        let found: Vec<String> = self.findings.iter().map(named_with_size).collect();
        match self.verdict {
            Verdict::Consistent if refitted < 0.5 * nominal => format!(
                "Nothing is left out: within its stated tolerances the fixture explains the FRFs down to their noise (χ² per degree of \
                 freedom {}, {} before the refit).",
                figures(refitted),
                figures(nominal)
            ),
            Verdict::Consistent => format!(
                "Nothing is left out: the fixture explains the FRFs down to their noise (χ² per degree of freedom {}).",
                figures(refitted)
            ),
            Verdict::Explained => format!(
                "The fixture leaves out {}; with {} the FRFs are explained down to their noise (χ² per degree of freedom {}; without {}{}; \
                 error {}, without {}).",
                listed(&found),
                if found.len() == 1 { "it" } else { "them" },
                figures(repaired),
                figures(refitted),
                self.bent(),
                percent(error_repaired),
                percent(error_refitted)
            ),
            Verdict::PartlyExplained if self.is_unnamed() => format!(
                "Something is left out that none of the effects known here accounts for: the closest, {}, takes χ² per degree of freedom from {} \
                 to {} only, and what is left sits {}{}.",
                listed(&found),
                figures(refitted),
                figures(repaired),
                self.sits(&self.search.repaired),
                self.varies(&self.search.repaired)
            ),
            Verdict::PartlyExplained => format!(
                "The fixture leaves out {}, but that is not all: χ² per degree of freedom falls from {} to {}, and what is left sits {}{}.",
                listed(&found),
                figures(refitted),
                figures(repaired),
                self.sits(&self.search.repaired),
                self.varies(&self.search.repaired)
            ),
            Verdict::Unexplained => format!(
                "Something is left out that none of the effects known here accounts for (χ² per degree of freedom {}): it sits {}{}.",
                figures(refitted),
                self.sits(&self.search.refitted),
                self.varies(&self.search.refitted)
            ),
        }
    }

    /// Whether no finding names the mismatch: there is none, or something that is not listed is likelier than any. Then the places, which assume
    /// no law, are what there is to see.
    pub fn is_unnamed(&self) -> bool {
        self.findings.iter().all(Finding::is_doubtful)
    }

    /// `, with bodies/A/mass bent by 33 standard deviations`, where the refit without effects takes a quantity far from what is stated.
    fn bent(&self) -> String {
        let refitted = &self.search.refitted.hypothesis;
        let stated =
            refitted.tolerances().iter().enumerate().filter(|(_, tolerance)| tolerance.std.is_some());
        let farthest = stated
            .map(|(index, tolerance)| (refitted.departure(index).abs(), tolerance))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        match farthest {
            Some((departure, tolerance)) if departure > BENT => {
                format!(", with {} bent by {} standard deviations", tolerance.path, significant(departure, 2))
            }
            _ => String::new(),
        }
    }

    /// What the reader must know of the test itself, a plain sentence each: too few FRFs, noise that had to be estimated.
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        let pairs = self.observation.pairs();
        if let [only] = pairs {
            remarks.push(format!(
                "There is one FRF only, {only}: it shows whether the fixture explains it, and which laws would; it cannot say where \
                 something sits, for one free value a line at any place explains one FRF, and nothing can be held out. Record at least \
                 one more response or reference point."
            ));
        }
        let noise = self.observation.noise().iter().zip(pairs);
        let scatter: Vec<String> = noise
            .filter(|(source, _)| **source == jointscope_frf::noise::NoiseSource::Scatter)
            .map(|(_, pair)| pair.to_string())
            .collect();
        if !scatter.is_empty() {
            remarks.push(format!(
                "The noise of {} was estimated from the scatter over neighbouring lines, for want of coherence over several averages: χ² \
                 and intervals are that much less certain.",
                if scatter.len() == pairs.len() { "all FRFs".to_owned() } else { listed(&scatter) }
            ));
        }
        if let Ok(fixture) = self.search.nominal.hypothesis.to_fixture() {
            remarks.extend(swapped(&self.findings, &fixture));
        }
        remarks.extend(self.observation.remarks());
        if self.residual_correlation.abs() > 0.2 {
            remarks.push(format!(
                "What the best model leaves is not white (neighbouring lines correlate by {:.2}): gains count for that much less \
                 and intervals are wider, as far as that is all there is to it.",
                self.residual_correlation
            ));
        }
        remarks
    }

    /// χ² per real value that `fit` leaves, by FRF and band (the bands of [`Diagnosis::mismatch`]).
    pub fn misfit(&self, fit: &Fit) -> Vec<FrfMisfit> {
        let (hz, n) = (self.observation.lines().hz(), self.observation.lines().len());
        let (values, weights) = (self.observation.values(), self.observation.weights());
        let mean = |index: usize, lines: std::ops::Range<usize>| {
            let (mut sum, mut count) = (0.0, 0_usize);
            for at in lines.map(|line| index * n + line) {
                if weights[at] > 0.0 {
                    sum += weights[at] * (values[at] - fit.predicted[at]).norm_sqr();
                    count += 2;
                }
            }
            (count > 0).then(|| sum / count as f64)
        };
        let of = |(index, mismatch): (usize, &crate::diagnosis::FrfMismatch)| {
            let bands = mismatch.bands.iter().map(|&(from, to, _)| {
                let lines = hz.partition_point(|f| *f < from)..hz.partition_point(|f| *f <= to);
                (from, to, mean(index, lines))
            });
            FrfMisfit { frf: mismatch.frf.clone(), whole: mean(index, 0..n), bands: bands.collect() }
        };
        self.mismatch.iter().enumerate().map(of).collect()
    }

    /// `mostly in FRF 4/1 from 180 to 240 Hz`.
    fn sits(&self, fit: &Fit) -> String {
        let misfit = self.misfit(fit);
        let worst = misfit
            .iter()
            .flat_map(|frf| {
                frf.bands.iter().filter_map(|(from, to, chi2)| Some((&frf.frf, *from, *to, (*chi2)?)))
            })
            .max_by(|a, b| a.3.total_cmp(&b.3));
        let best_place = self.locations.first().filter(|_| self.is_unnamed());
        let place = best_place.map_or_else(String::new, |location| {
            format!(
                "; of all single places {} would explain most (χ² per degree of freedom {})",
                location.site.says(),
                figures(location.chi2_per_dof)
            )
        });
        match worst {
            Some((frf, from, to, _)) => {
                format!("most clearly in FRF {frf} from {} to {}{place}", plain(from, "Hz"), plain(to, "Hz"))
            }
            None => format!("in no line that counts{place}"),
        }
    }

    /// How the mismatch goes with frequency: by δ(ω) of the best place, or by the relative error at both ends of the band.
    fn varies(&self, fit: &Fit) -> String {
        let delta = self.locations.first().filter(|_| self.is_unnamed()).and_then(Location::variation);
        if let Some(variation) = delta {
            return format!(", where what is missing, δ(ω), {variation}");
        }
        let (hz, n) = (self.observation.lines().hz(), self.observation.lines().len());
        let error = |lines: std::ops::Range<usize>| {
            let (mut left, mut size) = (0.0, 0.0);
            for index in 0..self.observation.pairs().len() {
                for at in lines.clone().map(|line| index * n + line) {
                    left += (self.observation.values()[at] - fit.predicted[at]).norm_sqr();
                    size += self.observation.values()[at].norm_sqr();
                }
            }
            (left / size).sqrt()
        };
        let third = n / 3;
        if third == 0 {
            return String::new();
        }
        let (low, high) = (error(0..third), error(n - third..n));
        let ends = format!(
            "{} below {}, {} above {}",
            percent(low),
            plain(hz[third - 1], "Hz"),
            percent(high),
            plain(hz[n - third], "Hz")
        );
        match high / low {
            ratio if ratio > 2.0 => format!(", and grows with frequency (relative error {ends})"),
            ratio if ratio < 0.5 => format!(", and falls with frequency (relative error {ends})"),
            _ => format!(", and is about as large at both ends of the band (relative error {ends})"),
        }
    }
}
