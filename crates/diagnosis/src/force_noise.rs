//! What noise of the force makes of FRFs that were estimated as H1: they fall short, and nothing may be named
//! for that.
//!
//! H1 = S_xf/S_ff has the noise of the force in S_ff alone, so it is too small by the share b of that noise
//! in S_ff, whatever the response does. Coherence says how large b may be: 1 − γ² is b and what the noise of
//! the response adds. All FRFs of a reference are struck by the same hammer, so b is no more than the least 1
//! − γ² among them, and how much of that it is, one share for the whole test, the FRFs have to tell. Where a
//! soft tip's blow dies away b grows smoothly over many lines, as a filter's or a mass' effect does, and the
//! variances know nothing of it.

use crate::Observation;
use crate::evidence::explained;
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::penalty::needed_gain;
use crate::settings::lines::force_noise::MOST_SHORTFALL;

/// Shares of the possible shortfall at which the fixture is refitted; the best lies where the parabola
/// through them has its least.
const SHARES: [f64; 3] = [0.0, 0.5, 1.0];

/// FRFs that fall short, as a hypothesis has it that is fitted to them.
pub(crate) struct Shortfall {
    /// What is left of each value.
    kept: Vec<f64>,
    /// The largest shortfall on a line, relative.
    pub largest: f64,
    /// The hypothesis fitted to the corrected FRFs.
    fit: Fit,
    /// Objective of its fit to FRFs that do not fall short.
    before: f64,
}

/// By how much each value may fall short at the most; `None` where coherence or averages are missing.
fn possible(observation: &Observation) -> Option<Vec<f64>> {
    let (frfs, count) = (observation.frfs(), observation.lines().len());
    let mut own = Vec::with_capacity(observation.values().len());
    for index in 0..observation.pairs().len() {
        observation.coherence(index)?;
        let degrees = f64::from(frfs.averages(index).filter(|averages| *averages > 1)? - 1);
        let weights = &observation.weights()[index * count..][..count];
        // 1 − γ² as the smoothed variance has it: line by line it scatters as that would.
        own.extend(weights.iter().zip(frfs.values(index)).map(|(weight, value)| {
            let noise = degrees * 2.0 / (weight * value.norm_sqr());
            if noise.is_finite() { noise / (1.0 + noise) } else { 1.0 }
        }));
    }
    let pairs = observation.pairs();
    let least = |index: usize, line: usize| {
        let alike = (0..pairs.len()).filter(|other| pairs[*other].reference == pairs[index].reference);
        alike.map(|other| own[other * count + line]).fold(MOST_SHORTFALL, f64::min)
    };
    Some(
        (0..pairs.len())
            .flat_map(|index| (0..count).map(move |line| (index, line)))
            .map(|(i, l)| least(i, l))
            .collect(),
    )
}

impl Shortfall {
    /// The most likely one beside what was fitted; `None` where coherence rules out that this matters, or
    /// that it leaves no more than noise: residuals become no smaller than by what the FRFs are changed by.
    pub(crate) fn beside(fitter: &Fitter, fit: &Fit) -> Option<Self> {
        let (observation, hypothesis) = (fitter.observation, &fit.hypothesis);
        let possible = possible(observation)?;
        let squares = observation.values().iter().zip(&possible).zip(observation.weights());
        let most: f64 = squares.map(|((value, short), weight)| weight * (short * value).norm_sqr()).sum();
        let noise = explained(observation, fitter.settings) * observation.degrees() as f64;
        if most < fitter.settings.selection.penalty || fit.objective.sqrt() - most.sqrt() > noise.sqrt() {
            return None;
        }
        let kept = |share: f64| -> Vec<f64> { possible.iter().map(|short| 1.0 - share * short).collect() };
        let at = |share: f64| {
            let corrected = observation.divided_by(&kept(share))?;
            fitter.on(&corrected).local(hypothesis, None, f64::INFINITY)
        };
        let fits: Vec<Fit> = SHARES.into_iter().map(at).collect::<Option<_>>()?;
        let [none, half, all] = [0, 1, 2].map(|index| fits[index].objective);
        let bend = none - 2.0 * half + all;
        let share = if bend > 0.0 { (0.5 + 0.25 * (none - all) / bend).clamp(0.0, 1.0) } else { 1.0 };
        let largest = share * possible.iter().copied().fold(0.0, f64::max);
        Some(Shortfall { kept: kept(share), largest, fit: at(share)?, before: none })
    }

    /// Whether it earns its parameter and leaves no more than noise.
    pub(crate) fn explains(&self, fitter: &Fitter) -> bool {
        let settings = &fitter.settings.selection;
        let needed = needed_gain(settings, settings.parameter_penalty, 1);
        let left = self.fit.chi2_per_dof(fitter.observation);
        self.before - self.fit.objective > needed && left < explained(fitter.observation, fitter.settings)
    }

    /// Objective of the fit beside which it was told, the FRFs corrected.
    pub(crate) fn left(&self) -> f64 {
        self.fit.objective
    }

    /// The FRFs as they would be without it.
    pub(crate) fn corrected(&self, observation: &Observation) -> Option<Observation> {
        observation.divided_by(&self.kept)
    }
}
