//! A modal analysis: orders fitted one after the other, stable poles selected, all refined by maximum
//! likelihood.

use jointscope_frf::KnownNoise;
use jointscope_frf::noise::NoiseSource;
use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;
use std::borrow::Cow;

use crate::gram::Terms;
use crate::likelihood::{Likelihood, Poles};
use crate::mode::{Mode, modes_of};
use crate::model::rebuilt;
use crate::moved::one_at_each_place;
use crate::noise;
use crate::observed::Observed;
use crate::polynomial::poles_by_order;
use crate::scatter::scatter;
use crate::selection::{candidates, is_inside, picked, prune};
use crate::settings::likelihood::MOST_STEPS;
use crate::settings::orders::{
    FEWEST_LINES, FEWEST_ORDERS, LEAST_HIGHEST_ORDER, LINES_PER_POLE, MOST_POLES, USUAL_POLES,
};
use crate::settings::quality::POOR_FIT;
use crate::settings::residual_terms::{MOST_TERMS, TERM_WORTH};
use crate::stabilization::{Track, follow};
use crate::{ChartPole, ModesError};

/// What the analyst may overrule.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModesOptions {
    /// Lines to use, Hz; all by default.
    pub band: Option<(f64, f64)>,
    /// Lowest and highest order of the chart's denominators.
    pub orders: Option<(usize, usize)>,
    /// Frequencies (Hz) of the chart's poles to take, in place of the automatic selection.
    pub pick: Vec<f64>,
}

/// Residual terms of one FRF: what modes below and above the band leave in it.
#[derive(Debug, Clone, PartialEq)]
pub struct ResidualTerms {
    /// Of the receptance over s⁻², s⁻⁴, …: the rigid motions and modes below the band, 1/kg, 1/(kg·s²), … for
    /// transverse channels.
    pub lower: Vec<Complex64>,
    /// Of the receptance over 1, s², …: the modes above the band, m/N, m·s²/N, ….
    pub upper: Vec<Complex64>,
}

/// Modes of a set of FRFs.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ModalAnalysis {
    /// The modes in the band, by ascending frequency.
    pub modes: Vec<Mode>,
    /// Modes just outside the band that were fitted for what they do inside it.
    pub outside: Vec<Mode>,
    /// The stabilisation chart, order after order.
    pub chart: Vec<ChartPole>,
    /// Lowest and highest order of the chart.
    pub orders: (usize, usize),
    /// Residual terms of each FRF.
    pub residual_terms: Vec<ResidualTerms>,
    /// Where each FRF's noise was taken from; empty where the set brought variances.
    pub noise: Vec<NoiseSource>,
    /// χ² per degree of freedom of the refined model: 1 where it explains the FRFs down to their noise.
    pub chi2_per_dof: f64,
    /// Number of columns of the matrix of FRFs, over which participations were told; 1 where it has gaps.
    pub columns: usize,
    /// Whether every response was measured to every reference.
    pub complete: bool,
    /// Number of lines recorded in the band, where they were merged.
    pub merged_from: Option<usize>,
    /// Decay of an exponential window over force and responses that was taken off the modes, 1/s; 0 without one.
    pub window_decay: f64,
    /// The FRFs used, as accelerances with their variances.
    measured: FrfSet,
    /// How many recorded lines each line stands for, and FRF after FRF each line's part of the squares that
    /// merging took out.
    stands_for: Vec<f64>,
    taken_out: Vec<f64>,
    /// The same rebuilt from the modes.
    rebuilt: Vec<Complex64>,
}

impl ModalAnalysis {
    /// Finds the modes of a set of FRFs. Variances that the set carries are believed; without, they come from
    /// coherence and averages, or from the scatter of the lines.
    ///
    /// # Errors
    /// See [`ModesError`].
    pub fn of(frfs: &FrfSet, options: &ModesOptions) -> Result<Self, ModesError> {
        let InUse { observed, measured, noise, merged_from, taken_out } = InUse::of(frfs, options)?;
        let orders = orders(&observed, options)?;
        let recorded = merged_from.unwrap_or(observed.lines());
        let spacing = (observed.omegas[observed.lines() - 1] - observed.omegas[0]) / (recorded - 1) as f64;
        let by_order = poles_by_order(&observed, orders);
        let (chart, tracks) = follow(&by_order, spacing);
        let nothing = ModesError::NothingStable {
            from: measured.lines().hz()[0],
            to: measured.lines().hz()[observed.lines() - 1],
            lowest: orders.0,
            highest: orders.1,
        };
        let start = start(&tracks, by_order.len(), &observed, options)?;
        if start.poles.is_empty() {
            return Err(nothing);
        }
        let condensed = observed.condensed(&start.poles);
        let by_hand = !options.pick.is_empty();
        let mut fit = refine(&condensed, start, by_hand)?;
        if merged_from.is_some() && !by_hand {
            fit = one_at_each_place(&condensed, fit);
        }
        let (observed, condensed, fit) = if noise.iter().any(|source| source.is_by_scatter()) {
            with_residual_noise(observed, condensed, fit, &noise)
        } else {
            (observed, condensed, fit)
        };
        if !fit.poles.poles.iter().any(|pole| is_inside(pole, &observed)) {
            return Err(nothing);
        }
        let scatter = scatter(&condensed, &fit);
        let (modes, outside) = modes_of(&condensed, &fit, &scatter, measured.pairs());
        let rebuilt = rebuild(&observed, &fit, &condensed);
        let measured = measured.with_variance(observed.variances())?;
        Ok(ModalAnalysis {
            modes,
            outside,
            chart,
            orders,
            residual_terms: residual_terms(&fit, &condensed),
            noise,
            chi2_per_dof: fit.chi2_per_dof(&condensed),
            columns: observed.grid.columns,
            complete: !observed.grid.row_channels.is_empty(),
            merged_from,
            window_decay: 0.0,
            measured,
            stands_for: observed.stands_for,
            taken_out,
            rebuilt,
        })
    }

    /// The same with the structure's own modes, where force and responses were under an exponential window of
    /// this decay (1/s): FRFs are then taken at s = decay + iω, and every pole reads as much farther left. What
    /// is rebuilt stays as it was recorded.
    #[must_use]
    pub fn without_window(mut self, decay: f64) -> Self {
        self.window_decay += decay;
        self.modes.iter_mut().chain(&mut self.outside).for_each(|mode| mode.take_off(decay));
        self
    }

    /// The FRFs.
    pub fn pairs(&self) -> &[FrfPair] {
        self.measured.pairs()
    }

    /// The lines in use.
    pub fn lines(&self) -> &SpectralLines {
        self.measured.lines()
    }

    /// The FRFs in use: accelerances with their variances.
    pub fn measured(&self) -> &FrfSet {
        &self.measured
    }

    /// An FRF rebuilt from modes and residual terms, as accelerance.
    pub fn rebuilt(&self, frf: usize) -> &[Complex64] {
        let n = self.lines().len();
        &self.rebuilt[frf * n..(frf + 1) * n]
    }

    /// √(Σ|rebuilt − measured|²/Σ|measured|²) of each FRF over the lines on which it was measured, as
    /// accelerance.
    pub fn relative_errors(&self) -> Vec<f64> {
        let error = |frf: usize| {
            let (model, data) = (self.rebuilt(frf), self.measured.values(frf));
            let n = self.stands_for.len();
            let over_lines = |square: &dyn Fn(usize) -> f64| -> f64 {
                let lines = (0..n).filter(|&line| self.measured.is_measured(frf, line));
                lines.map(|line| square(line) * self.stands_for[line]).sum()
            };
            let left = over_lines(&|line| (model[line] - data[line]).norm_sqr());
            let kept = over_lines(&|line| data[line].norm_sqr());
            let taken_out: f64 = self.taken_out[frf * n..(frf + 1) * n].iter().sum();
            let (apart, size) = (left + taken_out, kept + taken_out);
            if size > 0.0 { (apart / size).sqrt() } else { 0.0 }
        };
        (0..self.pairs().len()).map(error).collect()
    }

    /// Whether poles that all FRFs share explain them down to their noise; if not, deviations are widened.
    pub fn is_explained(&self) -> bool {
        self.chi2_per_dof <= POOR_FIT
    }

    /// MAC of every two modes over the FRFs' residues, row-major: 1 on the diagonal, small elsewhere where
    /// the channels tell the shapes apart.
    pub fn auto_mac(&self) -> Vec<f64> {
        let n = self.modes.len();
        (0..n * n).map(|k| crate::mac(&self.modes[k / n].residues, &self.modes[k % n].residues)).collect()
    }
}

/// What is analysed: the lines in the band.
struct InUse {
    observed: Observed,
    /// Accelerances with their variances.
    measured: FrfSet,
    noise: Vec<NoiseSource>,
    /// Number of lines recorded, where they were merged.
    merged_from: Option<usize>,
    /// FRF after FRF, by line, what merging took out.
    taken_out: Vec<f64>,
}

impl InUse {
    fn of(frfs: &FrfSet, options: &ModesOptions) -> Result<Self, ModesError> {
        let hz = frfs.lines().hz();
        let too_few = |lines| ModesError::TooFewLines {
            lines,
            from: hz[0],
            to: hz[hz.len() - 1],
            needed: FEWEST_LINES,
        };
        let wanted = |hz: f64| hz > 0.0 && options.band.is_none_or(|(from, to)| hz >= from && hz <= to);
        let accelerances = match frfs.form() {
            FrfForm::Accelerance => Cow::Borrowed(frfs),
            _ => Cow::Owned(frfs.to_form(FrfForm::Accelerance)?),
        };
        let KnownNoise { frfs, noise, merged_from, stands_for, taken_out } =
            KnownNoise::of(&accelerances, options.band)?;
        let kept: Vec<bool> = frfs.lines().hz().iter().map(|hz| wanted(*hz)).collect();
        let pick = |all: Vec<f64>| -> Vec<f64> {
            all.into_iter().zip(kept.iter().cycle()).filter(|(_, kept)| **kept).map(|(v, _)| v).collect()
        };
        let measured = frfs.on_lines(|line| kept[line]).ok_or(too_few(0))?;
        let observed = Observed::of(&measured, &pick(stands_for)).ok_or(too_few(0))?;
        if observed.lines() < FEWEST_LINES {
            return Err(too_few(observed.lines()));
        }
        if observed.values.iter().all(|v| v.norm_sqr() == 0.0) {
            return Err(ModesError::Silent);
        }
        let recorded = || hz.iter().filter(|hz| wanted(**hz)).count();
        let merged_from = merged_from.map(|_| recorded()).filter(|recorded| *recorded > observed.lines());
        Ok(InUse { observed, measured, noise, merged_from, taken_out: pick(taken_out) })
    }
}

fn orders(observed: &Observed, options: &ModesOptions) -> Result<(usize, usize), ModesError> {
    let p = observed.grid.columns;
    // As many equations as unknowns of a row's denominator and numerator.
    let determined = (observed.lines() * observed.grid.rows.len() * p)
        .saturating_sub(1)
        .div_euclid(p * p + observed.grid.rows.len() * p)
        .max(1)
        .min(observed.lines().saturating_sub(2).max(1));
    let most = determined.min((MOST_POLES / p).max(1));
    match options.orders {
        Some((from, to)) if to < from + FEWEST_ORDERS - 1 && options.pick.is_empty() => {
            Err(ModesError::FewOrders { from, to, needed: FEWEST_ORDERS })
        }
        Some((from, to)) if from >= 1 && from <= to && to <= most => Ok((from, to)),
        Some((from, to)) => Err(ModesError::Orders { from, to, most }),
        None => {
            let highest = (USUAL_POLES / p)
                .max(LEAST_HIGHEST_ORDER)
                .min(observed.lines() / LINES_PER_POLE)
                .min(most)
                .max(1);
            Ok((2.min(highest), highest))
        }
    }
}

fn start(
    tracks: &[Track],
    orders: usize,
    observed: &Observed,
    options: &ModesOptions,
) -> Result<Poles, ModesError> {
    if options.pick.is_empty() {
        return Ok(candidates(tracks, orders, observed));
    }
    picked(tracks, &options.pick, observed)
        .map_err(|(picked, nearest)| ModesError::NothingThere { picked, nearest })
}

/// Selection by worth (not of poles picked by hand) and the most likely poles, with as many residual terms as
/// pay.
fn refine(observed: &Observed, start: Poles, by_hand: bool) -> Result<Likelihood, ModesError> {
    let undetermined = ModesError::Undetermined { modes: start.poles.len(), lines: observed.lines() };
    let search = |poles: Poles, terms: Terms| {
        if by_hand {
            return Likelihood::search(observed, poles, terms, MOST_STEPS, None);
        }
        prune(observed, poles, terms, true)
    };
    let screened = if by_hand {
        start
    } else {
        prune(observed, start, Terms::USUAL, false).ok_or(undetermined.clone())?.poles
    };
    let mut best = search(screened, Terms::USUAL).ok_or(undetermined)?;
    while best.terms.count() < MOST_TERMS {
        let Terms { lower, upper } = best.terms;
        let more = [Terms { lower, upper: upper + 1 }, Terms { lower: lower + 1, upper }];
        let fits = more.into_iter().filter_map(|terms| search(best.poles.clone(), terms));
        let Some(next) = fits.min_by(|a, b| a.chi2.total_cmp(&b.chi2)) else { break };
        let scale = next.chi2_per_dof(observed).max(1.0);
        let needed = 2.0 * TERM_WORTH * observed.frfs() as f64 * (observed.degrees() as f64).ln();
        if best.chi2 - next.chi2 < scale * needed {
            break;
        }
        best = next;
    }
    Ok(best)
}

/// The set with the noise that the modes leave in it, for FRFs of which nothing else tells the noise, and the
/// most likely poles for that; with the old ones where nothing changes.
fn with_residual_noise(
    observed: Observed,
    condensed: Observed,
    fit: Likelihood,
    noise: &[NoiseSource],
) -> (Observed, Observed, Likelihood) {
    let n = observed.lines();
    let mut better = observed.clone();
    let by_scatter: Vec<usize> = (0..noise.len()).filter(|&frf| noise[frf].is_by_scatter()).collect();
    for (frf, variances) in noise::variances(&observed, &condensed, &fit, &by_scatter) {
        for (weight, variance) in better.weights[frf * n..(frf + 1) * n].iter_mut().zip(variances) {
            *weight = if *weight > 0.0 { 1.0 / variance } else { 0.0 };
        }
    }
    let again = better.condensed(&fit.poles.poles);
    match Likelihood::search(&again, fit.poles.clone(), fit.terms, MOST_STEPS, None) {
        Some(refitted) => (better, again, refitted),
        None => (observed, condensed, fit),
    }
}

fn rebuild(observed: &Observed, fit: &Likelihood, condensed: &Observed) -> Vec<Complex64> {
    let highest = condensed.omegas[condensed.lines() - 1];
    let n = observed.lines();
    let mut all = vec![Complex64::ZERO; observed.values.len()];
    for (row, frfs) in observed.grid.rows.iter().enumerate() {
        for (column, &frf) in frfs.iter().enumerate() {
            let values = rebuilt(&observed.omegas, fit, frf, row, column, highest);
            all[frf * n..(frf + 1) * n].copy_from_slice(&values);
        }
    }
    all
}

/// Residual terms of the receptance from those of the accelerance at its highest line: (ω/ω_h)²ᵏ = (−1)ᵏ
/// s²ᵏ/ω_h²ᵏ.
fn residual_terms(fit: &Likelihood, condensed: &Observed) -> Vec<ResidualTerms> {
    let highest = condensed.omegas[condensed.lines() - 1];
    let of = |terms: &Vec<Complex64>| {
        let si = |(size, power): (&Complex64, i32)| size * (-highest * highest).powi(-power);
        let mut all: Vec<Complex64> = terms.iter().zip(fit.terms.powers()).map(si).collect();
        let upper = all.split_off(fit.terms.lower);
        ResidualTerms { lower: all, upper }
    };
    fit.residual_terms.iter().map(of).collect()
}
