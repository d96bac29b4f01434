//! The diagnosis of what has changed since a baseline: by modes, and by lines where these do not tell it.

use super::by_modes::judged_by_modes;
use super::judged;
use super::parts::{Given, Parts};
use crate::evidence;
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::held_out::Division;
use crate::modal::{Known, ModalJudgement};
use crate::options::{DiagnosisError, DiagnosisOptions};
use crate::search::Search;
use crate::settings::statements::baseline::{LEFT_BY_BASELINE, LEFT_UNKNOWN, MISSES};
use crate::{Baseline, Hypothesis, Observation};
use jointscope_findings::Verdict;
use jointscope_fixture::{Fixture, Spread};
use jointscope_spectra::FrfPair;

/// The diagnosis of what has changed since a baseline.
pub(crate) fn since(
    fitter: &Fitter,
    baseline: Observation,
    fixture: &Fixture,
    options: &DiagnosisOptions,
) -> Result<Parts, DiagnosisError> {
    let exact = options.exact;
    let division = Division::of(fitter.observation, options)?;
    let as_stated = Search::as_stated(fitter, fixture, exact).ok_or(DiagnosisError::Baseline)?;
    let since = |fitter: &Fitter, baseline: &Observation, known: Option<&Known>| {
        let nominal = &as_stated.nominal.hypothesis;
        ModalJudgement::since(fitter, baseline, nominal, &as_stated.candidates, known)
    };
    let judged = since(fitter, &baseline, None);
    let (modal, before) = judged.ok_or(DiagnosisError::Baseline)?;
    let calibrated = Fit::at(before.calibrated, &baseline).ok_or(DiagnosisError::Baseline)?;
    let without = |part: &Fitter, known: &Known| {
        let seen = |pair: &FrfPair| part.observation.pairs().contains(pair);
        Some(since(part, &baseline.reduced(|_| true, seen)?, Some(known))?.0)
    };
    let given = Given { fitter, fixture, exact, lines_decide: false, division: division.as_ref() };
    let states = (&baseline, &calibrated.hypothesis);
    let by_lines = changed_by_lines(given, (&as_stated.nominal, &modal), states, options)?;
    let parts = by_lines.unwrap_or_else(|| judged_by_modes(given, &as_stated, &modal, &without));
    let baseline = Baseline { observation: baseline, calibrated, modes: before.modes };
    Ok(Parts { baseline_error: Some(before.error), baseline: Some(baseline), ..parts })
}

/// The fixture as the lines of a `baseline` have it, where what modes tell has changed does not explain the lines
/// now: where it leaves no more than noise of the baseline's, and misses much of these.
fn calibrated_on_lines(
    fitter: &Fitter,
    modal: &ModalJudgement,
    (baseline, by_modes): (&Observation, &Hypothesis),
) -> Option<Hypothesis> {
    let leaves = |hypothesis: &Hypothesis, observation: &Observation| {
        let left = Fit::at(hypothesis.clone(), observation)?.chi2_per_dof(observation);
        Some((left, evidence::explained(observation, fitter.settings)))
    };
    let (changed, noise) = leaves(&modal.stated[1], fitter.observation)?;
    if modal.names_all() && changed < noise {
        return None;
    }
    let then = fitter.on(baseline).local(by_modes, None, f64::INFINITY)?.hypothesis;
    let (left, noise) = leaves(&then, baseline)?;
    let (now, _) = leaves(&then, fitter.observation)?;
    (left < noise && now > MISSES).then_some(then)
}

/// What explains the lines down to their noise beside the fixture as the baseline's have it, and is beyond what a
/// repetition shows, where modes do not tell it; `None` where nothing does.
fn changed_by_lines(
    Given { fitter, fixture, exact, .. }: Given,
    (nominal, modal): (&Fit, &ModalJudgement),
    (baseline, by_modes): (&Observation, &Hypothesis),
    options: &DiagnosisOptions,
) -> Result<Option<Parts>, DiagnosisError> {
    let Some(calibrated) = calibrated_on_lines(fitter, modal, (baseline, by_modes)) else { return Ok(None) };
    let Ok(then) = calibrated.to_fixture() else { return Ok(None) };
    let then = known_by_baseline(then, exact);
    let alone = DiagnosisOptions { baseline: None, exact: true, ..options.clone() };
    let found = judged(fitter, &then, &alone, true)?;
    if found.verdict != Verdict::Explained || found.model_error.is_some() {
        return Ok(None);
    }
    // What is said of quantities is said against what is stated.
    let as_stated = |fit: &Fit| Fit::at(fit.hypothesis.in_fixture(fixture, exact), fitter.observation);
    let (Some(refitted), Some(repaired)) =
        (as_stated(&found.search.refitted), as_stated(&found.search.repaired))
    else {
        return Ok(None);
    };
    if !modal.is_beyond_repetition(&fitter.settings.modal, [&calibrated, &repaired.hypothesis]) {
        return Ok(None);
    }
    let stated = [&refitted, &repaired].map(|fit| fit.hypothesis.clone());
    let search = Search { nominal: nominal.clone(), refitted, repaired, ..found.search };
    Ok(Some(Parts { stated: Some(stated), search, ..found }))
}

/// A fixture whose quantities a baseline has put where they are: each known that much better than it is stated.
fn known_by_baseline(mut fixture: Fixture, exact: bool) -> Fixture {
    let stated = if exact { fixture.quantities_exact() } else { fixture.quantities() };
    for (known, stated) in fixture.quantities_mut().into_iter().zip(&stated) {
        let deviation = stated.std.map_or(LEFT_UNKNOWN * stated.value.abs(), |std| LEFT_BY_BASELINE * std);
        known.quantity.spread = Spread::Stated(deviation);
    }
    fixture
}
