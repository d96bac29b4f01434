//! The judgement on lines and FRFs that no fit saw.

use crate::fit::Fit;
use crate::search::Search;
use crate::settings::lines::held_out::{BANDS, FEWEST_FRFS, FEWEST_WIDTHS};
use crate::{DiagnosisError, DiagnosisOptions, Hypothesis, Observation};
use jointscope_findings::HeldOut;
use jointscope_spectra::FrfPair;

/// This step, as [`Diagnosis::stopped`](crate::Diagnosis::stopped) names it where the work did not suffice
/// for it.
pub(crate) const JUDGEMENT_STEP: &str = "the judgement on what is held out";

/// A recording divided into what a search may see, and what it is judged on.
pub(crate) struct Division {
    /// The observation without the held-out bands and FRFs.
    pub seen: Observation,
    what: Vec<String>,
    /// Whether each value of the whole observation is held out.
    unseen: Vec<bool>,
}

impl Division {
    /// Holds out two bands and the FRFs that are asked for. `None` where there are too few lines for that.
    pub(crate) fn of(
        observation: &Observation,
        options: &DiagnosisOptions,
    ) -> Result<Option<Self>, DiagnosisError> {
        let frfs = held_out_frfs(observation, options)?;
        let hz = observation.lines().hz();
        let n = hz.len();
        let width = ((n as f64 * options.settings.evidence.held_out) as usize).max(1);
        if n < FEWEST_WIDTHS * width {
            return Ok(None);
        }
        let bands = BANDS
            .map(|at| ((n as f64 * at) as usize, width))
            .map(|(from, width)| (hz[from], hz[from + width]));
        let outside = |line: f64| !bands.iter().any(|(from, to)| line >= *from && line <= *to);
        let Some(seen) = observation.reduced(outside, |pair| !frfs.contains(pair)) else { return Ok(None) };
        let what = bands
            .iter()
            .map(|(from, to)| format!("band {from}:{to}"))
            .chain(frfs.iter().map(|p| format!("frf {p}")));
        let unseen = observation.pairs().iter().flat_map(|pair| {
            let whole = frfs.contains(pair);
            hz.iter().map(move |line| whole || !outside(*line))
        });
        Ok(Some(Division { what: what.collect(), unseen: unseen.collect(), seen }))
    }

    /// How well the outcome of a search that was given [`Division::seen`] alone predicts the rest. Where
    /// nothing is named of `found` in the whole recording, nothing is repaired.
    pub(crate) fn judge(&self, blind: &Search, found: &Search, observation: &Observation) -> Option<HeldOut> {
        let error = |fit: &Fit| -> Option<f64> {
            let predicted = fit.hypothesis.predict(observation).ok()?;
            let unseen = (0..self.unseen.len()).filter(|at| self.unseen[*at]);
            Some(observation.nrmse_of(&predicted, unseen))
        };
        let named = found.repaired.hypothesis.effect_count() > 0;
        let repaired = if named { &blind.repaired } else { &blind.refitted };
        Some(HeldOut {
            what: self.what.clone(),
            nrmse_refitted: error(&blind.refitted)?,
            nrmse_repaired: error(repaired)?,
            same_findings: Some(same_names(&repaired.hypothesis, &found.repaired.hypothesis)),
        })
    }
}

fn held_out_frfs(
    observation: &Observation,
    options: &DiagnosisOptions,
) -> Result<Vec<FrfPair>, DiagnosisError> {
    let pairs = observation.pairs();
    if let Some(missing) = options.hold_out.iter().find(|pair| !pairs.contains(pair)) {
        return Err(DiagnosisError::HoldOut(missing.to_string()));
    }
    match (options.hold_out.as_slice(), pairs) {
        ([], [.., last]) if pairs.len() >= FEWEST_FRFS => Ok(vec![last.clone()]),
        ([], _) => Ok(Vec::new()),
        (named, _) if named.len() >= pairs.len() => Err(DiagnosisError::HoldOut(named[0].to_string())),
        (named, _) => Ok(named.to_vec()),
    }
}

/// Whether two hypotheses have the same kinds of effects at the same places.
fn same_names(a: &Hypothesis, b: &Hypothesis) -> bool {
    let names = |h: &Hypothesis| {
        let mut all: Vec<_> = h.effects().into_iter().map(|e| (e.kind, e.place, e.dof)).collect();
        all.sort();
        all
    };
    names(a) == names(b)
}
