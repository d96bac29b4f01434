//! What a diagnosis shows besides its findings: where the mismatch sits, how it goes with frequency, what
//! else the reader must know.

use crate::departures::{Departure, farthest};
use crate::diagnosis::Diagnosis;
use crate::evidence::explained;
use crate::finding::{Finding, Tried};
use crate::fit::Fit;
use crate::held_out::JUDGEMENT_STEP;
use crate::location::{BandMisfit, Location};
use crate::mismatch::{BandShare, FrfMismatch};
use crate::odd_record::OddRecord;
use crate::settings::Settings;
use crate::settings::effects::quantities::DEPARTED;
use crate::settings::statements::findings::{EXCHANGED_WITHIN, LEAST_BY_CHANCE};
use crate::settings::statements::odd_record::LEFT;
use crate::settings::statements::residuals::{NOT_WHITE, UNEVEN};
use crate::settings::statements::variation::{
    FEWEST_LINES, KNOWN, LEAST_VARIANCE, NO_POWER, ONE_PART, ONE_PHASE,
};
use jointscope_findings::Verdict;
use jointscope_fixture::{EffectKind, Place};
use jointscope_spectra::FrfPair;
use serde::Serialize;

/// χ² per real value of one FRF, over all lines and in bands; nothing where no value counts.
#[derive(Debug, Clone, PartialEq)]
pub struct FrfMisfit {
    /// The FRF.
    pub frf: FrfPair,
    /// Over all lines.
    pub whole: Option<f64>,
    /// By band, ascending.
    pub bands: Vec<BandMisfit>,
}

/// Relative errors at the two ends of the band.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EndErrors {
    /// √(Σ|H_model − H_measured|²/Σ|H_measured|²) of the lowest third of the lines.
    pub low: f64,
    /// Highest of them, Hz.
    pub below: f64,
    /// The same of the highest third.
    pub high: f64,
    /// Lowest of them, Hz.
    pub above: f64,
}

/// How something goes with frequency.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Trend {
    /// It grows.
    Grows,
    /// It falls.
    Falls,
    /// It is about the same at both ends.
    Level,
}

/// How δ(ω) varies, with no physics named.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Variation {
    /// Exponent n of |δ| ∝ ωⁿ; `None` where δ follows no power of frequency.
    pub power: Option<f64>,
    /// Its phase.
    pub phase: Phase,
}

/// The phase that most of δ(ω) has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs)]
pub enum Phase {
    RealPositive,
    RealNegative,
    ImaginaryPositive,
    ImaginaryNegative,
    /// Real and imaginary part are of about one size.
    Mixed,
    /// It changes over the band.
    Changing,
}

impl EndErrors {
    /// How the error goes with frequency.
    pub fn trend(&self) -> Trend {
        match self.high / self.low {
            ratio if ratio > UNEVEN => Trend::Grows,
            ratio if ratio < 1.0 / UNEVEN => Trend::Falls,
            _ => Trend::Level,
        }
    }
}

impl Diagnosis {
    /// χ² per degree of freedom that the refitted and the repaired model leave where it is more than noise
    /// and their modes have no error all the same: what is left is then in what modes do not tell, gains of
    /// single records, mass lines, upper residuals. `None` where there is no such thing, or lines decided.
    pub fn missed_beside_modes(&self) -> [Option<f64>; 2] {
        let Some(errors) = &self.model_error else { return [None; 2] };
        let [_, refitted, repaired] = self.chi2_per_dof();
        let most = explained(&self.observation, &Settings::default());
        [0, 1].map(|model| {
            let left = [refitted, repaired][model];
            (errors[model].is_none() && left > most).then_some(left)
        })
    }

    /// Whether no finding names the mismatch: there is none, or something that is not listed is likelier than
    /// any. Then the places, which assume no law, are what there is to see.
    pub fn is_unnamed(&self) -> bool {
        self.findings.iter().all(Finding::is_doubtful)
    }

    /// What came nearest to a finding where nothing is needed, and the share of tests in which one of all
    /// names does as well by chance, if that is little: a Bayes factor of b or more has under the null
    /// hypothesis a probability of 1/b at the most (Markov's inequality), for each of the names.
    pub fn nearest_by_chance(&self) -> Option<(&Tried, f64)> {
        let consistent = self.verdict == Verdict::Consistent;
        let nearest = self.tried.first().filter(|_| consistent)?;
        let by_chance = self.search.candidates.len() as f64 * (-nearest.ln_gain).exp();
        (by_chance < LEAST_BY_CHANCE).then_some((nearest, by_chance))
    }

    /// Whether the work ended before the judgement on what no fit saw.
    pub fn ended_before_judgement(&self) -> bool {
        self.stopped.contains(&JUDGEMENT_STEP)
    }

    /// The one record that is another multiple of what the fixture makes of it than the others, where what
    /// was found leaves much of the FRFs.
    pub fn odd_record(&self) -> Option<OddRecord> {
        let [_, missed, misses] = self.nrmse();
        let is_missed = !matches!(self.verdict, Verdict::Consistent | Verdict::Explained)
            && misses > LEFT * missed
            && self.baseline.is_none();
        let Self { observation, search, .. } = self;
        let odd = || OddRecord::of(observation.pairs(), observation.values(), &search.nominal.predicted);
        is_missed.then(odd).flatten()
    }

    /// What was tried where nothing explains the recording, the nearest first; empty where something does.
    pub fn tried_in_vain(&self) -> &[Tried] {
        let in_vain = self.verdict == Verdict::Unexplained && self.findings.is_empty();
        if in_vain { &self.tried } else { &[] }
    }

    /// The place that explains most of a mismatch without a name.
    pub fn best_place(&self) -> Option<&Location> {
        self.locations.first().filter(|_| self.is_unnamed())
    }

    /// Whether what the best model leaves is as random from line to line as noise is.
    pub fn is_white(&self) -> bool {
        self.residual_correlation.abs() <= NOT_WHITE
    }

    /// Whether all that is amiss are quantities far from what is stated: with them there, the FRFs are
    /// explained down to their noise.
    pub fn is_only_departed(&self) -> bool {
        let limit = explained(&self.observation, &Settings::default());
        self.verdict == Verdict::Unexplained
            && self.model_error.is_none()
            && self.departures.iter().any(Departure::remains)
            && self.search.repaired.chi2_per_dof(&self.observation) < limit
    }

    /// The quantity that the refit without effects took farthest from what is stated, and by how many
    /// standard deviations, where that is beyond belief.
    pub fn farthest_quantity(&self) -> Option<(&str, f64)> {
        farthest(&self.stated[0]).filter(|(_, deviations)| *deviations > DEPARTED)
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
        let of = |(index, mismatch): (usize, &FrfMismatch)| {
            let bands = mismatch.bands.iter().map(|&BandShare { from, to, .. }| {
                let lines = hz.partition_point(|f| *f < from)..hz.partition_point(|f| *f <= to);
                BandMisfit { from, to, chi2_per_dof: mean(index, lines) }
            });
            FrfMisfit { frf: mismatch.frf.clone(), whole: mean(index, 0..n), bands: bands.collect() }
        };
        self.mismatch.iter().enumerate().map(of).collect()
    }

    /// The FRF and band in which `fit` leaves most.
    pub fn worst_band(&self, fit: &Fit) -> Option<(FrfPair, BandMisfit)> {
        let misfit = self.misfit(fit);
        let all = misfit.iter().flat_map(|frf| frf.bands.iter().map(move |band| (&frf.frf, band)));
        let counted = all.filter_map(|(frf, band)| Some((frf, band, band.chi2_per_dof?)));
        let worst = counted.max_by(|a, b| a.2.total_cmp(&b.2));
        worst.map(|(frf, band, _)| (frf.clone(), *band))
    }

    /// The relative errors that `fit` leaves at the ends of the band; `None` with fewer than three lines.
    pub fn end_errors(&self, fit: &Fit) -> Option<EndErrors> {
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
        (third > 0).then(|| EndErrors {
            low: error(0..third),
            below: hz[third - 1],
            high: error(n - third..n),
            above: hz[n - third],
        })
    }

    /// Pairs of points whose offsets lead each to the place of the other: channels that were swapped.
    pub fn swapped_points(&self) -> Vec<[&str; 2]> {
        let Ok(fixture) = self.search.nominal.hypothesis.to_fixture() else { return Vec::new() };
        let offsets = self.findings.iter().filter(|finding| finding.effect.kind == EffectKind::PointOffset);
        let moved: Vec<(&str, usize, f64, f64)> = offsets
            .filter_map(|finding| match &finding.effect.place {
                Place::Point(name) => {
                    let point = fixture.point(name)?;
                    let x = point.x.value;
                    Some((name.as_str(), point.body, x, x + finding.effect.value(0)))
                }
                _ => None,
            })
            .collect();
        let mut pairs = Vec::new();
        for (index, a) in moved.iter().enumerate() {
            for b in &moved[index + 1..] {
                let near = |to: f64, at: f64| (to - at).abs() <= EXCHANGED_WITHIN * (a.2 - b.2).abs();
                if a.1 == b.1 && near(a.3, b.2) && near(b.3, a.2) {
                    pairs.push([a.0, b.0]);
                }
            }
        }
        pairs
    }
}

impl Location {
    /// How δ(ω) varies with frequency; `None` where too few lines determine it.
    pub fn variation(&self) -> Option<Variation> {
        let known: Vec<_> = self
            .delta
            .iter()
            .filter(|d| d.frequency > 0.0 && d.std > 0.0 && d.value.norm() > KNOWN * d.std)
            .collect();
        if known.len() < FEWEST_LINES {
            return None;
        }
        // ln|δ| over ln f, weighted by how well it is known.
        let points: Vec<(f64, f64, f64)> = known
            .iter()
            .map(|d| {
                let (size, share) = (d.value.norm(), d.std / d.value.norm());
                (d.frequency.ln(), size.ln(), 1.0 / (share * share + LEAST_VARIANCE))
            })
            .collect();
        let total: f64 = points.iter().map(|p| p.2).sum();
        let mean =
            |of: &dyn Fn(&(f64, f64, f64)) -> f64| points.iter().map(|p| p.2 * of(p)).sum::<f64>() / total;
        let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
        let spread = mean(&|p| (p.0 - x).powi(2));
        if spread <= 0.0 {
            return None;
        }
        let power = mean(&|p| (p.0 - x) * (p.1 - y)) / spread;
        let scatter = mean(&|p| (p.1 - y - power * (p.0 - x)).powi(2)).sqrt();
        let sum: num_complex::Complex64 = known.iter().map(|d| d.value / d.value.norm()).sum();
        let direction = sum / known.len() as f64;
        let (re, im) = (direction.re, direction.im);
        let phase = if direction.norm() < ONE_PHASE {
            Phase::Changing
        } else if re.abs() > ONE_PART * im.abs() {
            if re > 0.0 { Phase::RealPositive } else { Phase::RealNegative }
        } else if im.abs() > ONE_PART * re.abs() {
            if im > 0.0 { Phase::ImaginaryPositive } else { Phase::ImaginaryNegative }
        } else {
            Phase::Mixed
        };
        Some(Variation { power: (scatter <= NO_POWER).then_some(power), phase })
    }
}
