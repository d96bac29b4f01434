//! The diagnosis where the noise of the lines decides.

use super::by_modes::by_modes;
use super::parts::{Given, Parts, chance};
use crate::evidence::nothing_can_be_stated;
use crate::finding::Finding;
use crate::fitter::Fitter;
use crate::held_out::JUDGEMENT_STEP;
use crate::location::{LOCATION_STEP, Location, located};
use crate::modal::{Explaining, ModalJudgement, without_imitations};
use crate::named::{findings, verdict};
use crate::search::Search;
use crate::settings::work::shares::OF_STEP_BY_LINES;
use jointscope_findings::Verdict;

/// What a search by lines of the whole recording sets out from.
pub(super) enum Start<'a> {
    /// The fixture alone, or what the search finds that sees less.
    Anew,
    /// What was found among the modes.
    Modes(&'a ModalJudgement, Explaining),
    /// What was found among few names.
    Found(Box<Search>),
    /// It was made already.
    Searched(Box<Search>),
}

impl<'a> Start<'a> {
    /// The comparison by modes that it comes from.
    fn modes(&self) -> Option<&'a ModalJudgement> {
        match self {
            Start::Modes(modal, _) => Some(modal),
            _ => None,
        }
    }
}

/// The diagnosis where the noise of the lines decides, unless what they ask for imitates an error of the
/// model.
pub(super) fn by_lines(
    given: Given,
    without_effects: Search,
    start: Start,
    modal: Option<&ModalJudgement>,
) -> Parts {
    let fitter = given.fitter;
    // What sees less goes first where nothing is known, and the whole recording only has to confirm or
    // correct it.
    let anew = matches!(start, Start::Anew);
    let first = if anew { on_what_is_seen(given, None) } else { None };
    let set_out_from = start.modes();
    let mut search = searched(fitter, without_effects, start, first.as_ref(), modal);
    if let Some(fewer) = without_imitations(fitter, &search, modal) {
        match explaining(modal) {
            Some(modal) => return by_modes(given, &search, modal),
            None => search = fewer,
        }
    }
    let findings = found_among(fitter, &mut search);
    if let Some(modal) = modal.filter(|modal| modal.tells_from(fitter, &search.repaired.hypothesis)) {
        return by_modes(given, &search, modal);
    }
    let findings = without_doubtful(fitter, &mut search, findings);
    let findings = beside_errors_of_modes(fitter, &search, modal, findings);
    let blind = if anew { first } else { on_what_is_seen(given, set_out_from) };
    let held_out =
        given.division.zip(blind).and_then(|(d, blind)| d.judge(&blind, &search, fitter.observation));
    let locations = places_of_what_is_left(fitter, &search);
    let verdict = verdict(fitter, &search, &findings);
    let tried =
        modal.filter(|_| verdict == Verdict::Unexplained).map_or_else(Vec::new, ModalJudgement::tried);
    Parts {
        verdict,
        findings,
        locations,
        held_out,
        search,
        stated: None,
        model_error: None,
        baseline_error: None,
        baseline: None,
        tried,
    }
}

/// The comparison by modes, where it explains the recording.
fn explaining(modal: Option<&ModalJudgement>) -> Option<&ModalJudgement> {
    modal.filter(|modal| modal.explains())
}

/// The search of the whole recording. `first` is that of what is not held out, where it went before.
fn searched(
    fitter: &Fitter,
    without_effects: Search,
    start: Start,
    first: Option<&Search>,
    modal: Option<&ModalJudgement>,
) -> Search {
    fitter.watch.stage("searching the whole recording");
    let explains = explaining(modal).is_some();
    // Modes that explain the recording decide as soon as lines ask for what these do not need.
    let imitates = |search: &Search| explains && without_imitations(fitter, search, modal).is_some();
    fitter.observation.work().within_rest(OF_STEP_BY_LINES, || match (start, first) {
        (Start::Searched(search), _) => *search,
        (Start::Modes(modal, explaining), _) => {
            searched_from_modes(fitter, without_effects, (modal, explaining), imitates)
        }
        (Start::Found(found), _) => Search::continued(fitter, without_effects, &found),
        (Start::Anew, Some(first)) => Search::continued_until(fitter, without_effects, first, imitates),
        (Start::Anew, None) => Search::searched(fitter, without_effects),
    })
}

/// The search that begins with what explains the modes, until it finds what only `imitates` an error of the
/// model.
fn searched_from_modes(
    fitter: &Fitter,
    without_effects: Search,
    (modal, Explaining { fit, is_sure }): (&ModalJudgement, Explaining),
    imitates: impl Fn(&Search) -> bool,
) -> Search {
    let among_modes = modal.search_on(fitter.observation, &without_effects, &modal.stated);
    let among_modes = Search { repaired: fit, ..among_modes };
    let as_sure = Search { is_sure, ..without_effects };
    let mut search = Search::continued_until(fitter, as_sure, &among_modes, imitates);
    let bases = fitter.settings.modal.bases.1;
    search.told_apart = modal.told_from(&search.repaired.hypothesis, &search.candidates, bases);
    search
}

/// What a search found, with probabilities; nothing where all of it is too improbable to be stated.
fn found_among(fitter: &Fitter, search: &mut Search) -> Vec<Finding> {
    if nothing_can_be_stated(fitter, &search.repaired, search.candidates.len()) {
        return Vec::new();
    }
    fitter.observation.work().within_rest(OF_STEP_BY_LINES, || findings(fitter, search))
}

/// The findings, or none where one of them is too improbable to be stated. Without any the fixture as
/// refitted is the repaired one.
fn without_doubtful(fitter: &Fitter, search: &mut Search, findings: Vec<Finding>) -> Vec<Finding> {
    // What the best hypotheses leave may say that none of them is right: they would only adapt the model to
    // the recording.
    let doubtful = findings.iter().any(|finding| finding.stated() < fitter.settings.evidence.stated);
    let findings = if doubtful { Vec::new() } else { findings };
    if findings.is_empty() {
        search.repaired = search.refitted.clone();
    }
    findings
}

/// The findings with what a comparison by modes says of their intervals and of their names.
fn beside_errors_of_modes(
    fitter: &Fitter,
    search: &Search,
    modal: Option<&ModalJudgement>,
    findings: Vec<Finding>,
) -> Vec<Finding> {
    match modal {
        Some(modal) if !findings.is_empty() => {
            let found = &search.repaired.hypothesis;
            let findings = modal.with_errors_of_modes(fitter, found, &search.candidates, findings);
            modal.with_its_own_name(fitter, findings)
        }
        _ => findings,
    }
}

/// The places of what the refitted fixture leaves, where that is more than chance.
fn places_of_what_is_left(fitter: &Fitter, search: &Search) -> Vec<Location> {
    let observation = fitter.observation;
    let unlikely = chance(observation, &search.refitted).1 < fitter.settings.evidence.located;
    if !unlikely || !observation.work().allows(LOCATION_STEP) {
        return Vec::new();
    }
    fitter.watch.stage("locating what is left");
    located(*fitter, &search.nominal.hypothesis, &search.refitted)
}

/// The search that does not see what is held out: that must not have chosen the names either. Where the
/// search of the whole recording set out from its modes, `of_whole`, it may try the names that these told.
fn on_what_is_seen(given: Given, of_whole: Option<&ModalJudgement>) -> Option<Search> {
    let work = given.fitter.observation.work();
    let division = given.division.filter(|_| work.allows(JUDGEMENT_STEP))?;
    let fitter = &given.fitter.on(&division.seen);
    fitter.watch.stage("searching without the lines that are held out");
    let refitted = Given { fitter, ..given }.without_effects()?;
    if let Some(found) = refitted.explained_by_odd_record(fitter) {
        return Some(Search::continued(fitter, refitted, &found));
    }
    let refitted = if of_whole.is_none() { refitted.refitted_widely(fitter) } else { refitted };
    let without_effects = refitted.with_wrong_quantities(fitter);
    Some(match of_whole.and_then(|whole| found_among_modes(fitter, &without_effects, whole)) {
        Some((among_modes, is_sure)) => {
            Search::continued(fitter, Search { is_sure, ..without_effects }, &among_modes)
        }
        None => Search::searched(fitter, without_effects),
    })
}

/// What explains the modes of what is not held out among the names that the whole recording's told, and
/// whether it is sure.
fn found_among_modes(
    fitter: &Fitter,
    without_effects: &Search,
    whole: &ModalJudgement,
) -> Option<(Search, bool)> {
    let names = whole.known(&fitter.settings.modal);
    let Search { nominal, candidates, .. } = without_effects;
    let modal = ModalJudgement::of(fitter, &nominal.hypothesis, candidates, Some(&names))?;
    let Explaining { fit, is_sure } = modal.exact(fitter)?;
    let among_modes = modal.search_on(fitter.observation, without_effects, &modal.stated);
    Some((Search { repaired: fit, ..among_modes }, is_sure))
}
