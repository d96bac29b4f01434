//! The ways to a diagnosis: by the noise of the lines, by the error of the model, by what has changed since a
//! baseline; and which of them a recording asks for.

use crate::departures::has_departed;
use crate::evidence::{self, explains, nothing_can_be_stated, upper_tail};
use crate::finding::{Finding, Tried};
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::held_out::Division;
use crate::location::{Location, located};
use crate::modal::{Explaining, Known, ModalJudgement, ModelError, without_imitations};
use crate::named::{findings, re_estimated, verdict};
use crate::options::{DiagnosisError, DiagnosisOptions};
use crate::search::Search;
use crate::settings::work::shares::{OF_DOUBTS, OF_HELD_OUT, OF_STEP_BY_LINES};
use crate::{Baseline, Hypothesis, Observation};
use jointscope_findings::{HeldOut, Verdict};
use jointscope_fixture::{Effect, Fixture};
use jointscope_spectra::SpectraError;

/// What a search that runs out of work leaves out, as `stopped` says it.
const UNSEEN: &str = "the judgement on what is held out";
const PLACES: &str = "the places of what is left";

/// The fixture as it is given.
#[derive(Clone, Copy)]
struct Given<'a> {
    fixture: &'a Fixture,
    /// Whether its bare numbers are exact.
    exact: bool,
}

impl Given<'_> {
    /// The fixture as it stands and refitted to what `fitter` sees.
    fn without_effects(self, fitter: &Fitter) -> Option<Search> {
        Search::without_effects(fitter, self.fixture, self.exact)
    }
}

/// What a search by lines of the whole recording sets out from.
enum Start<'a> {
    /// The fixture alone, or what the search finds that sees less.
    Anew,
    /// What was found among the modes.
    Modes(&'a ModalJudgement, Explaining),
    /// What was found among few names.
    Found(Box<Search>),
    /// It was made already.
    Searched(Box<Search>),
}

/// The diagnosis by the route that fits the recording.
pub(crate) fn judged(
    fitter: &Fitter,
    fixture: &Fixture,
    options: &DiagnosisOptions,
) -> Result<Parts, DiagnosisError> {
    let division = Division::of(fitter.observation, options)?;
    let given = Given { fixture, exact: options.exact };
    let refitted = given.without_effects(fitter).ok_or(DiagnosisError::Lines(SpectraError::NoLines))?;
    let from_found = |without_effects: Search, found: Search| {
        let start = Start::Found(Box::new(found));
        by_lines(fitter, without_effects, given, start, None, division.as_ref())
    };
    if let Some(found) = refitted.explained_by_odd_record(fitter) {
        return Ok(from_found(refitted, found));
    }
    let without_effects = refitted.clone().with_wrong_quantities(fitter);
    // Where the fixture as refitted leaves more than noise, the comparison by modes says whether the model
    // itself is in error: if it is, the noise of the lines decides nothing.
    let may_err = !fixture.model_error().is_exact();
    let modal = match may_err && without_effects.lacks_much(fitter, &without_effects.refitted) {
        true => fitter.observation.work().within(fitter.settings.modal.share, || {
            ModalJudgement::of(fitter, &without_effects.nominal.hypothesis, &without_effects.candidates, None)
        }),
        false => None,
    };
    // Modes lead to the nearest minimum where lines, peak beside peak, may end in another.
    let without_effects = match &modal {
        Some(modal) => Search { candidates: modal.candidates.clone(), ..without_effects }
            .refitted_from(fitter, &modal.stated[0]),
        None => refitted.refitted_widely(fitter).with_wrong_quantities(fitter),
    };
    let moved = modal.as_ref().filter(|modal| modal.is_unexplained());
    if let Some(found) = moved.and_then(|_| without_effects.explained_by_moved_sensor(fitter)) {
        return Ok(from_found(without_effects, found));
    }
    let parts = routed(fitter, &without_effects, given, modal.as_ref(), division.as_ref());
    // Where no name brings the lines down to their noise, and the refit does by departing from what is stated,
    // one quantity that is wrong may.
    let left = without_effects.refitted.chi2_per_dof(fitter.observation);
    let bends = left < evidence::explained(fitter.observation, fitter.settings)
        && has_departed(&without_effects.refitted.hypothesis);
    let short = parts.verdict != Verdict::Consistent && !explains(fitter, &parts.search.repaired, false);
    let bent = parts.verdict == Verdict::Unexplained && has_departed(&parts.search.repaired.hypothesis);
    let found = match bends && (short || bent) {
        true => without_effects.explained_by_wrong_quantity(fitter, !bent),
        false => None,
    };
    if let Some(found) = found {
        let with = Search { candidates: found.candidates.clone(), ..without_effects.clone() };
        let wrong = from_found(with, found);
        if wrong.verdict == Verdict::Explained && wrong.findings.len() == 1 {
            return Ok(wrong);
        }
    }
    Ok(match parts.verdict {
        Verdict::Unexplained => {
            as_located(fitter, without_effects, given, modal.as_ref(), division.as_ref(), parts)
        }
        _ => parts,
    })
}

/// The diagnosis by lines or by modes, whichever the comparison by modes calls for. What explains the modes
/// is stated where lines find nothing: for good where it leaves little of them or these come down to the
/// noise by quantities far off alone, else as a part.
fn routed(
    fitter: &Fitter,
    without_effects: &Search,
    given: Given,
    modal: Option<&ModalJudgement>,
    division: Option<&Division>,
) -> Parts {
    let by_lines = |start: Start| by_lines(fitter, without_effects.clone(), given, start, modal, division);
    let Some(modal) = modal.filter(|modal| !modal.needs_nothing()) else { return by_lines(Start::Anew) };
    let Some((start, is_near)) = from_modes(fitter, without_effects, modal) else {
        return by_modes(fitter, without_effects, modal, division);
    };
    let parts = by_lines(start);
    if parts.verdict != Verdict::Unexplained || !modal.names_all() {
        return parts;
    }
    let left = parts.search.refitted.chi2_per_dof(fitter.observation);
    let bent = left < evidence::explained(fitter.observation, fitter.settings);
    match is_near || bent {
        true => by_modes(fitter, without_effects, modal, division),
        false => by_modes(fitter, without_effects, &modal.doubted(), division),
    }
}

/// Where lines set out from after a comparison by modes, and whether what explains the modes leaves little of
/// the lines; `None` where lines have no say.
fn from_modes<'a>(
    fitter: &Fitter,
    without_effects: &Search,
    modal: &'a ModalJudgement,
) -> Option<(Start<'a>, bool)> {
    // What explains the lines down to their noise without any error of the model needs none: found among the
    // modes, or, where these are dubious, by a search on lines.
    if let Some(exact) = modal.exact(fitter) {
        return (!modal.tells_from(fitter, &exact.fit.hypothesis))
            .then_some((Start::Modes(modal, exact), true));
    }
    // Where errors of the usual size do not explain the modes, these may have rested in a false minimum, and
    // the names that they hold most probable, or quantities that are wrong, explain the lines down to their
    // noise.
    if let Some(found) = without_effects.explained_among(fitter, modal.in_question(fitter)) {
        return Some((Start::Found(Box::new(found)), false));
    }
    // Where a free fit that needed all it may leaves no doubt of the names, lines find nothing better. Where
    // modes find none and lines lack little, one of all names may do.
    let little = fitter.settings.modal.slight * fitter.observation.degrees() as f64;
    let may = (modal.is_dubious(fitter)
        || modal.is_unexplained() && without_effects.refitted.objective < little)
        && !modal.stands_out(fitter)
        && fitter.observation.work().allows("what lines would find");
    let search = || Search::searched(fitter, without_effects.clone());
    let searched = may.then(|| fitter.observation.work().within_rest(OF_DOUBTS, search));
    let explained = searched.as_ref().is_some_and(|search| explains(fitter, &search.repaired, true));
    // Modes that need no error of the model, or that do not tell all there is, beside lines that are not
    // explained: it is not the modes of the model that are in error.
    let tells_all = !modal.is_incomplete_but_usable(fitter) || modal.has_no_rival(fitter);
    let not_in_error = modal.search.best.exact || modal.has_right_modes() || !tells_all;
    if !explained && !not_in_error {
        return None;
    }
    let nearly = if explained { None } else { modal.nearly_exact(fitter) };
    Some(match (nearly, searched) {
        (Some(nearly), _) => (Start::Modes(modal, nearly), true),
        (None, Some(search)) => (Start::Searched(Box::new(search)), false),
        (None, None) => (Start::Anew, false),
    })
}

/// What nothing explained, once more from the laws that were read at the places which explain most of it:
/// where free scalars find a way, a search is to find it too.
fn as_located(
    fitter: &Fitter,
    without_effects: Search,
    given: Given,
    modal: Option<&ModalJudgement>,
    division: Option<&Division>,
    parts: Parts,
) -> Parts {
    let part = fitter.settings.location.part * without_effects.refitted.objective;
    let degrees = fitter.observation.degrees() as f64;
    let places = parts.locations.iter().filter(|place| place.chi2_per_dof * degrees < part);
    let effects = places.flat_map(|place| place.effects(&without_effects.candidates, given.fixture));
    let fit = |effect: Effect| fitter.local(&without_effects.nominal.hypothesis.with(effect), None, part);
    let fits = effects.filter_map(fit).filter(|fit| fit.objective < part);
    let Some(repaired) = fits.min_by(|a, b| a.objective.total_cmp(&b.objective)) else { return parts };
    let found = Box::new(Search { repaired, ..without_effects.clone() });
    let again = by_lines(fitter, without_effects, given, Start::Found(found), modal, division);
    if again.verdict == Verdict::Unexplained { parts } else { again }
}

/// What a route decides. `Diagnosis::of_parts` adds what follows from it.
pub(crate) struct Parts {
    pub verdict: Verdict,
    pub search: Search,
    /// What is said of the quantities of the refitted and the repaired model, where these are to predict.
    pub stated: Option<[Hypothesis; 2]>,
    pub findings: Vec<Finding>,
    pub locations: Vec<Location>,
    pub held_out: Option<HeldOut>,
    pub model_error: Option<[ModelError; 2]>,
    pub baseline_error: Option<ModelError>,
    pub baseline: Option<Baseline>,
    pub tried: Vec<Tried>,
}

impl Parts {
    /// The same on all FRFs of a recording of which a part was searched: models that were fitted to lines are
    /// fitted to all of them.
    pub(crate) fn on_all(mut self, fitter: &Fitter) -> Self {
        let by_lines = self.model_error.is_none();
        let again = |fit: &Fit| match by_lines {
            true => fitter.local(&fit.hypothesis, None, f64::INFINITY),
            false => Fit::at(fit.hypothesis.clone(), fitter.observation),
        };
        let Search { nominal, refitted, repaired, candidates, told_apart, is_sure } = self.search;
        let nominal = Fit::at(nominal.hypothesis.clone(), fitter.observation).unwrap_or(nominal);
        let refitted = again(&refitted).unwrap_or(refitted);
        let repaired = again(&repaired).unwrap_or(repaired);
        self.search = Search { nominal, refitted, repaired, candidates, told_apart, is_sure };
        if by_lines {
            self.findings = re_estimated(fitter, &self.search, self.findings);
            self.verdict = verdict(fitter, &self.search, &self.findings);
        }
        self
    }
}

/// χ² per degree of freedom that a fit leaves, and the probability of one as large by chance.
pub(crate) fn chance(observation: &Observation, fit: &Fit) -> (f64, f64) {
    let chi2_per_dof = fit.chi2_per_dof(observation);
    (chi2_per_dof, upper_tail(observation.excess(chi2_per_dof)))
}

/// The diagnosis where the noise of the lines decides, unless what they ask for imitates an error of the
/// model.
fn by_lines(
    fitter: &Fitter,
    without_effects: Search,
    given: Given,
    start: Start,
    modal: Option<&ModalJudgement>,
    division: Option<&Division>,
) -> Parts {
    let Fitter { observation, settings, .. } = *fitter;
    let on_what_is_seen = |of_whole: Option<&ModalJudgement>| {
        let division = division.filter(|_| observation.work().allows(UNSEEN))?;
        blind(&fitter.on(&division.seen), given, of_whole)
    };
    // What sees less goes first where nothing is known, and the whole recording only has to confirm or
    // correct it.
    let anew = matches!(start, Start::Anew);
    let first = if anew { on_what_is_seen(None) } else { None };
    fitter.watch.stage("searching the whole recording");
    let set_out_from = if let Start::Modes(modal, _) = &start { Some(*modal) } else { None };
    let explaining = modal.filter(|modal| modal.explains());
    // Modes that explain the recording decide as soon as lines ask for what these do not need.
    let imitates =
        |search: &Search| explaining.is_some() && without_imitations(fitter, search, modal).is_some();
    let mut search = observation.work().within_rest(OF_STEP_BY_LINES, || match (start, &first) {
        (Start::Searched(search), _) => *search,
        (Start::Modes(modal, Explaining { fit, is_sure }), _) => {
            let among_modes = modal.search_on(observation, &without_effects, &modal.stated);
            let among_modes = Search { repaired: fit, ..among_modes };
            let as_sure = Search { is_sure, ..without_effects };
            let mut search = Search::continued_until(fitter, as_sure, &among_modes, imitates);
            search.told_apart =
                modal.told_from(&search.repaired.hypothesis, &search.candidates, settings.modal.bases.1);
            search
        }
        (Start::Found(found), _) => Search::continued(fitter, without_effects, &found),
        (Start::Anew, Some(first)) => Search::continued_until(fitter, without_effects, first, imitates),
        (Start::Anew, None) => Search::searched(fitter, without_effects),
    });
    if let Some(fewer) = without_imitations(fitter, &search, modal) {
        match explaining {
            Some(modal) => return by_modes(fitter, &search, modal, division),
            None => search = fewer,
        }
    }
    let findings = match nothing_can_be_stated(fitter, &search.repaired, search.candidates.len()) {
        true => Vec::new(),
        false => observation.work().within_rest(OF_STEP_BY_LINES, || findings(fitter, &mut search)),
    };
    if let Some(modal) = modal.filter(|modal| modal.tells_from(fitter, &search.repaired.hypothesis)) {
        return by_modes(fitter, &search, modal, division);
    }
    // What the best hypotheses leave may say that none of them is right: they would only adapt the model to
    // the recording.
    let doubtful = findings.iter().any(|finding| finding.stated() < settings.evidence.stated);
    let findings = if doubtful { Vec::new() } else { findings };
    if findings.is_empty() {
        search.repaired = search.refitted.clone();
    }
    let findings = match modal {
        Some(modal) if !findings.is_empty() => {
            let found = &search.repaired.hypothesis;
            let findings = modal.with_errors_of_modes(fitter, found, &search.candidates, findings);
            modal.with_its_own_name(fitter, findings)
        }
        _ => findings,
    };
    let blind = if anew { first } else { on_what_is_seen(set_out_from) };
    let held_out = division.zip(blind).and_then(|(d, blind)| d.judge(&blind, &search, observation));
    let unlikely = chance(observation, &search.refitted).1 < settings.evidence.located;
    let locations = match unlikely && observation.work().allows(PLACES) {
        true => {
            fitter.watch.stage("locating what is left");
            located(*fitter, &search.nominal.hypothesis, &search.refitted)
        }
        false => Vec::new(),
    };
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

/// The search that does not see what is held out: that must not have chosen the names either. Where the
/// search of the whole recording set out from its modes, `of_whole`, it may try the names that these told.
fn blind(fitter: &Fitter, given: Given, of_whole: Option<&ModalJudgement>) -> Option<Search> {
    fitter.watch.stage("searching without the lines that are held out");
    let refitted = given.without_effects(fitter)?;
    if let Some(found) = refitted.explained_by_odd_record(fitter) {
        return Some(Search::continued(fitter, refitted, &found));
    }
    let refitted = if of_whole.is_none() { refitted.refitted_widely(fitter) } else { refitted };
    let without_effects = refitted.with_wrong_quantities(fitter);
    let modal = of_whole.and_then(|whole| {
        let names = whole.known(&fitter.settings.modal);
        let Search { nominal, candidates, .. } = &without_effects;
        ModalJudgement::of(fitter, &nominal.hypothesis, candidates, Some(&names))
    });
    let found = modal.and_then(|modal| {
        let Explaining { fit, is_sure } = modal.exact(fitter)?;
        let among_modes = modal.search_on(fitter.observation, &without_effects, &modal.stated);
        Some((Search { repaired: fit, ..among_modes }, is_sure))
    });
    Some(match found {
        Some((among_modes, is_sure)) => {
            Search::continued(fitter, Search { is_sure, ..without_effects }, &among_modes)
        }
        None => Search::searched(fitter, without_effects),
    })
}

/// The diagnosis where the model's own error decides. `on_lines` is what lines made of the recording: the
/// fixture refitted, or a search.
fn by_modes(
    fitter: &Fitter,
    on_lines: &Search,
    modal: &ModalJudgement,
    division: Option<&Division>,
) -> Parts {
    let Fitter { observation, settings, .. } = *fitter;
    let work = observation.work();
    let (modal, search) = modal.predicted(fitter, on_lines);
    let judge = |division: &Division| {
        fitter.watch.stage("comparing by modes without what is held out");
        let blind = fitter.on(&division.seen);
        // Of what names nothing, only the refitted fixture is judged.
        let named = search.repaired.hypothesis.effect_count() > 0;
        let names = if named { modal.known(&settings.modal) } else { Known::default() };
        let judged =
            ModalJudgement::of(&blind, &on_lines.nominal.hypothesis, &on_lines.candidates, Some(&names))?;
        let (_, blind) = judged.predicted(&blind, on_lines);
        division.judge(&blind, &search, observation)
    };
    let division = division.filter(|_| work.allows(UNSEEN));
    let held_out = division.and_then(|division| work.within_rest(OF_HELD_OUT, || judge(division)));
    let locations = match modal.verdict {
        Verdict::Unexplained if work.allows(PLACES) => {
            let refitted = Fit::at(modal.stated[0].clone(), observation);
            located(*fitter, &search.nominal.hypothesis, refitted.as_ref().unwrap_or(&search.refitted))
        }
        _ => Vec::new(),
    };
    Parts {
        verdict: modal.verdict,
        findings: modal.findings(&search.candidates),
        locations,
        held_out,
        search,
        stated: Some(modal.stated.clone()),
        model_error: Some(modal.errors),
        baseline_error: None,
        baseline: None,
        tried: modal.tried(),
    }
}

/// The diagnosis of what has changed since a baseline.
pub(crate) fn since(
    fitter: &Fitter,
    baseline: Observation,
    fixture: &Fixture,
    exact: bool,
) -> Result<Parts, DiagnosisError> {
    let as_stated = Search::as_stated(fitter, fixture, exact).ok_or(DiagnosisError::Baseline)?;
    let judged =
        ModalJudgement::since(fitter, &baseline, &as_stated.nominal.hypothesis, &as_stated.candidates);
    let (modal, before) = judged.ok_or(DiagnosisError::Baseline)?;
    let calibrated = Fit::at(before.calibrated, &baseline).ok_or(DiagnosisError::Baseline)?;
    let parts = by_modes(fitter, &as_stated, &modal, None);
    let baseline = Baseline { observation: baseline, calibrated, modes: before.modes };
    Ok(Parts { baseline_error: Some(before.error), baseline: Some(baseline), ..parts })
}
