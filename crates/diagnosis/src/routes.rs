//! The ways to a diagnosis: by the noise of the lines, by the error of the model, by what has changed since a
//! baseline; and which of them a recording asks for.

mod by_lines;
mod by_modes;
mod parts;
mod since;

pub(crate) use parts::{Parts, chance};
pub(crate) use since::since;

use crate::Observation;
use crate::departures::{farthest, has_departed};
use crate::evidence::{self, explains, lacks_much};
use crate::fit::Fit;
use crate::fitter::Fitter;
use crate::held_out::Division;
use crate::modal::ModalJudgement;
use crate::moved_sensor::MovedSensor;
use crate::options::{DiagnosisError, DiagnosisOptions};
use crate::search::Search;
use crate::settings::effects::quantities::BEYOND_BELIEF;
use crate::settings::work::shares::OF_DOUBTS;
use by_lines::{Start, by_lines};
use by_modes::by_modes;
use jointscope_findings::Verdict;
use jointscope_fixture::{Effect, Fixture};
use jointscope_spectra::SpectraError;
use parts::Given;

/// A recording before its route is chosen.
struct Ground {
    without_effects: Search,
    modal: Option<ModalJudgement>,
}

impl Ground {
    /// The fixture refitted and compared by modes.
    fn of(given: Given, refitted: Search) -> Self {
        let fitter = given.fitter;
        let without_effects = refitted.clone().with_wrong_quantities(fitter);
        let modal = compared_by_modes(given, &without_effects);
        // Modes lead to the nearest minimum where lines, peak beside peak, may end in another.
        let Some(modal) = modal else {
            let without_effects = refitted.refitted_widely(fitter).with_wrong_quantities(fitter);
            return Ground { without_effects, modal: None };
        };
        let without_effects = Search { candidates: modal.candidates.clone(), ..without_effects };
        let starts = [&modal.stated[0], &modal.search.none.hypothesis];
        let without_effects =
            starts.iter().fold(without_effects, |at, start| at.refitted_from(fitter, start));
        let modal = modal.beside(fitter, &without_effects.refitted);
        let without_effects =
            if modal.misses_below { without_effects.refitted_widely(fitter) } else { without_effects };
        let modal = modal.beside(fitter, &without_effects.refitted);
        Ground { without_effects, modal: Some(modal) }
    }

    /// The diagnosis of a structure that no sensor loads in some FRFs only.
    fn decided(&self, given: Given) -> Parts {
        let modal = self.modal.as_ref();
        if let Some(modal) = modal.filter(|_| !given.lines_decide) {
            return by_modes(given, &self.without_effects, modal);
        }
        let parts = routed(given, &self.without_effects, modal);
        if let Some(wrong) = explained_by_wrong_quantity(given, &self.without_effects, &parts) {
            return wrong;
        }
        match parts.verdict {
            Verdict::Unexplained => as_located(given, self.without_effects.clone(), modal, parts),
            _ => parts,
        }
    }
}

/// The diagnosis by the route that fits the recording, where `lines_decide` if they explain it.
pub(crate) fn judged(
    fitter: &Fitter,
    fixture: &Fixture,
    options: &DiagnosisOptions,
    lines_decide: bool,
) -> Result<Parts, DiagnosisError> {
    let division = Division::of(fitter.observation, options)?;
    let exact = options.exact;
    let given = Given { fitter, fixture, exact, lines_decide, division: division.as_ref() };
    let refitted = refitted(given)?;
    if let Some(found) = refitted.explained_by_odd_record(fitter) {
        return Ok(from_found(given, refitted, found, None));
    }
    if lacks_much(fitter, &refitted.refitted)
        && let Some((sensor, unloaded)) = moved_sensor(fitter, &refitted)
    {
        return beside_sensor(given, options, refitted, (&sensor, &unloaded));
    }
    let ground = Ground::of(given, refitted);
    let Ground { without_effects, modal } = &ground;
    let moved = modal.as_ref().filter(|modal| lines_decide && modal.is_unexplained());
    if let Some(found) = moved.and_then(|_| without_effects.explained_by_moved_sensor(fitter, None)) {
        return Ok(from_found(given, ground.without_effects, found, None));
    }
    Ok(ground.decided(given))
}

/// The fixture as it stands and refitted.
fn refitted(given: Given) -> Result<Search, DiagnosisError> {
    given.without_effects().ok_or(DiagnosisError::Lines(SpectraError::NoLines))
}

/// The sensor that makes natural frequencies differ from response to response, if one does, and the recording
/// without it.
fn moved_sensor(fitter: &Fitter, refitted: &Search) -> Option<(MovedSensor, Observation)> {
    fitter.watch.stage("comparing natural frequencies from response to response");
    let nominal = &refitted.nominal.hypothesis;
    let sensor = MovedSensor::of(fitter.observation, nominal, &refitted.candidates)?;
    let unloaded = sensor.load.taken_off(fitter.observation)?;
    Some((sensor, unloaded))
}

/// The diagnosis with a `sensor` that loads the structure in some FRFs only, so that the poles all of them
/// share are of no structure: by lines where it explains them down to their noise, alone or beside what is
/// found in the recording without it, `unloaded`, else beside that.
fn beside_sensor(
    given: Given,
    options: &DiagnosisOptions,
    as_loaded: Search,
    (sensor, unloaded): (&MovedSensor, &Observation),
) -> Result<Parts, DiagnosisError> {
    let fitter = given.fitter;
    if let Some(found) = as_loaded.explained_by_moved_sensor(fitter, Some(sensor.effect())) {
        return Ok(from_found(given, as_loaded, found, None));
    }
    let division = Division::of(unloaded, options)?;
    let without = Given { fitter: &fitter.on(unloaded), division: division.as_ref(), ..given };
    let without = Ground::of(without, refitted(without)?).decided(without);
    // What leaves little of the lines beside it is for them to find.
    let both = without.search.repaired.hypothesis.with(sensor.effect().clone());
    let slight = fitter.settings.modal.slight * fitter.observation.degrees() as f64;
    if let Some(repaired) = fitter.local(&both, None, slight).filter(|fit| fit.objective < slight) {
        let found = Search { repaired, ..as_loaded.clone() };
        let parts = from_found(given, as_loaded.clone(), found, None);
        if parts.verdict == Verdict::Explained {
            return Ok(parts);
        }
    }
    Ok(sensor.beside(fitter, (as_loaded, without), given.division))
}

/// The diagnosis by lines that sets out from what was found among few names.
fn from_found(given: Given, without_effects: Search, found: Search, modal: Option<&ModalJudgement>) -> Parts {
    by_lines(given, without_effects, Start::Found(Box::new(found)), modal)
}

/// The comparison by modes where the fixture as refitted leaves more than noise: it says whether the model
/// itself is in error, and if it is, the noise of the lines decides nothing.
fn compared_by_modes(given: Given, without_effects: &Search) -> Option<ModalJudgement> {
    let Given { fitter, fixture, .. } = given;
    let may_err = !fixture.model_error().is_exact();
    if !may_err || !lacks_much(fitter, &without_effects.refitted) {
        return None;
    }
    fitter.observation.work().within(fitter.settings.modal.share, || {
        ModalJudgement::of(fitter, &without_effects.nominal.hypothesis, &without_effects.candidates, None)
    })
}

/// What one quantity that is wrong makes of a recording that no name brings down to the noise of its lines,
/// where the refit does by departing from what is stated, and that quantity explains it alone.
fn explained_by_wrong_quantity(given: Given, without_effects: &Search, parts: &Parts) -> Option<Parts> {
    let fitter = given.fitter;
    let refitted = &without_effects.refitted;
    let left = refitted.chi2_per_dof(fitter.observation);
    let bends =
        left < evidence::explained(fitter.observation, fitter.settings) && has_departed(&refitted.hypothesis);
    let short = parts.verdict != Verdict::Consistent && !explains(fitter, &parts.search.repaired, false);
    let bent = parts.verdict == Verdict::Unexplained && has_departed(&parts.search.repaired.hypothesis);
    if !bends || !(short || bent) {
        return None;
    }
    let found = without_effects.explained_by_wrong_quantity(fitter, !bent)?;
    let with = Search { candidates: found.candidates.clone(), ..without_effects.clone() };
    let wrong = from_found(given, with, found, None);
    (wrong.verdict == Verdict::Explained && wrong.findings.len() == 1).then_some(wrong)
}

/// The diagnosis by lines or by modes, whichever the comparison by modes calls for. What explains the modes
/// is stated where lines find nothing: for good where it leaves little of them or these come down to the
/// noise by quantities far off alone, else as a part.
fn routed(given: Given, without_effects: &Search, modal: Option<&ModalJudgement>) -> Parts {
    let fitter = given.fitter;
    let by_lines = |start: Start| by_lines(given, without_effects.clone(), start, modal);
    let Some(modal) = modal.filter(|modal| !modal.needs_nothing()) else { return by_lines(Start::Anew) };
    if let Some(law) = modal.with_its_law_in_question()
        && let Some((start, _)) = from_modes(fitter, without_effects, &law)
    {
        let parts = by_lines(start);
        if parts.verdict == Verdict::Explained {
            return parts;
        }
    }
    let Some((start, is_near)) = from_modes(fitter, without_effects, modal) else {
        return by_modes(given, without_effects, modal);
    };
    let parts = by_lines(start);
    if parts.verdict != Verdict::Unexplained {
        return parts;
    }
    if !modal.names_all() {
        let modal = modal.where_incomplete(fitter);
        return match modal.explains() || is_bent_in_vain(fitter, &parts.search.repaired) {
            true => by_modes(given, without_effects, &modal),
            false => parts,
        };
    }
    let left = parts.search.refitted.chi2_per_dof(fitter.observation);
    let bent = left < evidence::explained(fitter.observation, fitter.settings);
    match is_near || bent {
        true => by_modes(given, without_effects, modal),
        false => by_modes(given, without_effects, &modal.doubted()),
    }
}

/// Whether quantities were taken beyond all belief, and lines are far from explained all the same: what errors
/// the modes need is worth more than where these quantities went.
fn is_bent_in_vain(fitter: &Fitter, repaired: &Fit) -> bool {
    let bent = farthest(&repaired.hypothesis).is_some_and(|(_, deviations)| deviations > BEYOND_BELIEF);
    bent && repaired.chi2_per_dof(fitter.observation)
        > evidence::explained(fitter.observation, fitter.settings)
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
    let tells_all =
        !(modal.misses_below || modal.is_incomplete_but_usable(fitter)) || modal.has_no_rival(fitter);
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
fn as_located(given: Given, without_effects: Search, modal: Option<&ModalJudgement>, parts: Parts) -> Parts {
    let fitter = given.fitter;
    let part = fitter.settings.location.part * without_effects.refitted.objective;
    let degrees = fitter.observation.degrees() as f64;
    let places = parts.locations.iter().filter(|place| place.chi2_per_dof * degrees < part);
    let effects = places.flat_map(|place| place.effects(&without_effects.candidates, given.fixture));
    let fit = |effect: Effect| fitter.local(&without_effects.nominal.hypothesis.with(effect), None, part);
    let fits = effects.filter_map(fit).filter(|fit| fit.objective < part);
    let Some(repaired) = fits.min_by(|a, b| a.objective.total_cmp(&b.objective)) else { return parts };
    let found = Search { repaired, ..without_effects.clone() };
    let again = from_found(given, without_effects, found, modal);
    if again.verdict == Verdict::Unexplained { parts } else { again }
}
