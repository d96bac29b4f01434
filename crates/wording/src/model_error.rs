//! The verdict where the model's own error decides instead of the noise.

use crate::departures::remaining;
use crate::finding::{found, it};
use crate::format::significant;
use crate::misfit::{shows, varies};
use crate::numbers::{figures, listed, percent};
use crate::places::quantity_name;
use jointscope_diagnosis::{Diagnosis, ModalSettings, ModelError};
use jointscope_findings::Verdict;

/// Times by which an error has to become smaller to be told beside sizes.
const MUCH: f64 = 1.5;

/// The verdict on a fixture whose model, refitted and repaired, is off by `errors`.
pub(crate) fn verdict(diagnosis: &Diagnosis, [refitted, repaired]: &[ModelError; 2]) -> String {
    if let Some(baseline) = &diagnosis.baseline_error {
        return since(diagnosis, baseline, [refitted, repaired]);
    }
    let [missed_without, missed_with] = diagnosis.missed_beside_modes();
    let (without, with) = (off_by(refitted, missed_without), off_by(repaired, missed_with));
    let bent = farthest_quantity(diagnosis);
    match diagnosis.verdict {
        Verdict::Consistent => format!(
            "Nothing is left out that a name would explain: the model is off by {}, as such models are.",
            without
        ),
        Verdict::Explained if without == with && bent.is_empty() => format!(
            "The fixture leaves out {}: check {it}. With {it} less is off in gains of records, mass lines, upper residuals or phases; in the \
             modes themselves the model is off by {with} with {it} as without.{}",
            found(diagnosis),
            predicted(diagnosis),
            it = it(diagnosis)
        ),
        Verdict::Explained => format!(
            "The fixture leaves out {}: check {it}. Without {it} the model would be off by {}{}, with {it} by {}.{}",
            found(diagnosis),
            without,
            bent,
            with,
            predicted(diagnosis),
            it = it(diagnosis)
        ),
        Verdict::PartlyExplained if diagnosis.is_unnamed() => format!(
            "Something is left out that none of the effects known here accounts for: with the closest, {}, the model is off by {}, without it \
             by {}. What remains shows {}{}.",
            found(diagnosis),
            with,
            without,
            shows(diagnosis, &diagnosis.search.repaired),
            varies(diagnosis, &diagnosis.search.repaired)
        ),
        Verdict::PartlyExplained => format!(
            "The fixture leaves out {}, but that is not all: without {it} the model would be off by {}{}, with {it} by {}. What remains is {}; it \
             shows {}{}.",
            found(diagnosis),
            without,
            bent,
            with,
            excess(diagnosis, repaired),
            shows(diagnosis, &diagnosis.search.repaired),
            varies(diagnosis, &diagnosis.search.repaired),
            it = it(diagnosis)
        ),
        Verdict::Unexplained if refitted.is_none() && remaining(diagnosis).next().is_some() => format!(
            "Something is left out that none of the effects known here accounts for: so changed the model is off by {without}, and no effect \
             does that in its stead; without the change it shows {}{}.",
            shows(diagnosis, &diagnosis.search.nominal),
            varies(diagnosis, &diagnosis.search.nominal)
        ),
        Verdict::Unexplained => format!(
            "Something is left out that none of the effects known here accounts for: the model is off by {}, and no effect makes that much \
             smaller. That is {}; it shows {}{}.",
            without,
            excess(diagnosis, refitted),
            shows(diagnosis, &diagnosis.search.refitted),
            varies(diagnosis, &diagnosis.search.refitted)
        ),
    }
}

/// ` Lines that were never fitted are predicted to 0.23 % with it, to 6.1 % without.`, where that is much
/// better: sizes within what is usual do not show it.
fn predicted(diagnosis: &Diagnosis) -> String {
    let much = diagnosis.held_out.as_ref().filter(|own| own.nrmse_refitted > MUCH * own.nrmse_repaired);
    much.map_or_else(String::new, |own| {
        format!(
            " Lines that were never fitted are predicted to {} with {}, to {} without.",
            percent(own.nrmse_repaired),
            it(diagnosis),
            percent(own.nrmse_refitted)
        )
    })
}

/// What a model is off by; `missed` is what it leaves of the FRFs' χ² though its modes have no error.
fn off_by(error: &ModelError, missed: Option<f64>) -> String {
    match missed {
        Some(chi2_per_dof) => format!(
            "nothing in its modes, and what the FRFs show besides (χ² per degree of freedom {}) lies in gains of records, mass lines or upper \
             residuals",
            figures(chi2_per_dof)
        ),
        None => sizes(error),
    }
}

/// What has changed since a baseline, on which the model is off by `baseline`; of the change it misses
/// `refitted` without the findings and `repaired` with.
fn since(diagnosis: &Diagnosis, baseline: &ModelError, [refitted, repaired]: [&ModelError; 2]) -> String {
    let change = match diagnosis.verdict {
        Verdict::Consistent => {
            "Nothing has changed since the baseline beyond what a repetition changes.".to_owned()
        }
        Verdict::Explained => format!(
            "Since the baseline this has changed: {}. Without {it} the change would be {}, with {it} what is left is {}.",
            found(diagnosis),
            sizes(refitted),
            sizes(repaired),
            it = it(diagnosis)
        ),
        Verdict::PartlyExplained => format!(
            "Since the baseline this has changed: {}; but that is not all: of a change of {} it leaves {}.",
            found(diagnosis),
            sizes(refitted),
            sizes(repaired)
        ),
        Verdict::Unexplained => format!(
            "Something has changed since the baseline that no single effect known here accounts for: {}.",
            sizes(refitted)
        ),
    };
    let alike = match diagnosis.verdict {
        Verdict::Consistent | Verdict::Unexplained => {
            diagnosis.baseline.as_ref().and_then(|baseline| baseline.common_change()).map(changed_alike)
        }
        Verdict::Explained | Verdict::PartlyExplained => None,
    };
    format!(
        "{change}{} On the baseline itself the calibrated model is off by {}.",
        alike.unwrap_or_default(),
        sizes(baseline)
    )
}

/// What changes all natural frequencies alike, ln of whose ratio is `change`, with a space before.
fn changed_alike(change: f64) -> String {
    let (frequencies, moduli) = (change.exp_m1(), (2.0 * change).exp_m1());
    let way = |share: f64| if share < 0.0 { "lower" } else { "higher" };
    format!(
        " All natural frequencies are {} by {} alike, as by moduli that are {} by {} everywhere: compare the temperatures of both tests.",
        way(frequencies),
        percent(frequencies.abs()),
        way(moduli),
        percent(moduli.abs())
    )
}

/// One kind of a model's error, for a table or a sentence.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorInWords {
    /// What is off.
    pub kind: &'static str,
    /// By how much; `None` where the recording shows no such error.
    pub size: Option<String>,
    /// The same with the interval of 95 %, where it was estimated.
    pub with_interval: String,
    /// By how much usual models are; what the fixture states, where it does.
    pub usual: String,
    /// Whether the fixture states it.
    pub is_stated: bool,
    /// Whether it is larger than an adequate model has it.
    pub large: bool,
}

/// A model's error by kind, and how far beside their points sensors sat and hammers struck.
pub fn error_in_words(error: &ModelError) -> [ErrorInWords; 4] {
    let settings = ModalSettings::default();
    let ModelError { frequency, damping, residue, strike, ci95, stated, usual_frequency, usual_strike } =
        error;
    let (usual, ci95) = (settings.usual, ci95.as_ref());
    let of_frequency = usual_frequency.unwrap_or(usual.frequency);
    let share = short as fn(f64) -> String;
    let kinds = [
        ("natural frequency", frequency, of_frequency, stated.frequency, ci95.map(|ci| ci.frequency), share),
        ("damping ratio", damping, usual.damping, stated.damping, ci95.map(|ci| ci.damping), share),
        ("residues", residue, ModelError::usual_residue(), stated.residue, ci95.map(|ci| ci.residue), share),
        (
            "places of sensors and impacts",
            strike,
            usual_strike.unwrap_or(usual.strike),
            None,
            ci95.map(|ci| ci.strike),
            millimetres,
        ),
    ];
    kinds.map(|(kind, size, usual, stated, interval, short)| {
        let usual = stated.unwrap_or(usual);
        let seen = (*size > 0.0).then(|| short(*size));
        let with_interval = match (&seen, interval) {
            (Some(seen), Some([low, high])) if low < high => {
                format!("{seen} ({} to {})", short(low), short(high))
            }
            (Some(seen), _) => seen.clone(),
            (None, Some([_, high])) => format!("none seen (below {})", short(high)),
            (None, None) => "none seen".to_owned(),
        };
        ErrorInWords {
            kind,
            size: seen,
            with_interval,
            usual: short(usual),
            is_stated: stated.is_some(),
            large: *size > settings.adequate.0 * usual,
        }
    })
}

/// `0.05 % in natural frequency and 0.3 % in residues`, kinds that are not there left out.
pub(crate) fn sizes(error: &ModelError) -> String {
    let as_stated = |error: &ErrorInWords| if error.is_stated && !error.large { " (as stated)" } else { "" };
    let told = |error: ErrorInWords| {
        Some(format!("{} in {}{}", error.size.as_ref()?, error.kind, as_stated(&error)))
    };
    let told: Vec<String> = error_in_words(error).into_iter().filter_map(told).collect();
    if told.is_empty() { "no more than the noise".to_owned() } else { listed(&told) }
}

/// Why what is left is more than the error of a usual model.
fn excess(diagnosis: &Diagnosis, error: &ModelError) -> String {
    let large: Vec<ErrorInWords> = error_in_words(error).into_iter().filter(|error| error.large).collect();
    let than = if large.iter().all(|error| error.is_stated) { "stated" } else { "usual" };
    let told: Vec<String> = large
        .iter()
        .map(|error| format!("in {} ({} {})", error.kind, known_by(error), error.usual))
        .collect();
    match (told.is_empty(), remaining(diagnosis).next().is_some()) {
        (false, _) => format!("larger than {than} {}", listed(&told)),
        (true, true) => "not larger than usual, but for the departure".to_owned(),
        (true, false) => {
            "larger than usual in gains of records, mass lines, upper residuals or phases, not in the modes themselves"
                .to_owned()
        }
    }
}

/// Where the size comes from that an error is held against.
fn known_by(error: &ErrorInWords) -> &'static str {
    if error.is_stated { "stated" } else { "usually" }
}

/// ` (and the mass of A 33 standard deviations from what is stated)`, where the refit without effects takes a
/// quantity that far and the effects bring it back.
fn farthest_quantity(diagnosis: &Diagnosis) -> String {
    let bent = diagnosis
        .farthest_quantity()
        .filter(|(path, _)| remaining(diagnosis).all(|departure| departure.path != *path));
    bent.map_or_else(String::new, |(path, deviations)| {
        format!(
            " (and {} {} standard deviations from what is stated)",
            quantity_name(path),
            significant(deviations, 2)
        )
    })
}

/// Two digits of a length in m, as millimetres.
fn millimetres(length: f64) -> String {
    format!("{} mm", significant(1e3 * length, 2))
}

/// Two digits of a per cent, without the zeros that say nothing.
fn short(share: f64) -> String {
    let text = percent(share);
    match text.strip_suffix(" %").filter(|number| number.contains('.')) {
        Some(number) => format!("{} %", number.trim_end_matches('0').trim_end_matches('.')),
        None => text,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::Says;
    use jointscope_diagnosis::{Departure, DiagnosisOptions, ErrorIntervals, Finding, FrfEvidence};
    use jointscope_findings::Estimate;
    use jointscope_fixture::{Effect, EffectKind, Fixture, Place, StatedError};
    use jointscope_lumped::{Instrument, synthesize};
    use jointscope_spectra::{FrfPair, SpectralLines};

    /// Two storeys that leave nothing out.
    fn diagnosis() -> Diagnosis {
        let fixture = Fixture::from_json(
            r#"{ "bodies": { "low": { "mass": {"value": 3.5, "std": 0.07}, "rotates": false },
                             "high": { "mass": {"value": 6.0, "std": 0.006}, "rotates": false } },
                 "points": { "1": { "body": "low", "x": 0 }, "2": { "body": "high", "x": 0.18 } },
                 "joints": { "C": { "from": "1", "to": "2", "stiffness": [[{"value": 3.4e6, "std": 2e4}, 0], [0, 0]] } },
                 "damping": { "modal_ratios": [{"value": 0.02, "std": 0.004}] } }"#,
        )
        .unwrap();
        let pairs = [FrfPair::transverse("1", "1"), FrfPair::transverse("2", "1")];
        let lines = SpectralLines::even(20.0, 5.0, 77).unwrap();
        let frfs = synthesize(&fixture, &pairs, &lines, Instrument::AsRecorded).unwrap();
        let variance = frfs.all_values().iter().map(|value| 1e-4 * value.norm_sqr()).collect();
        Diagnosis::of(&fixture, &frfs.with_variance(variance).unwrap(), &DiagnosisOptions::default()).unwrap()
    }

    fn error(frequency: f64, damping: f64, residue: f64) -> ModelError {
        ModelError { frequency, damping, residue, ..ModelError::default() }
    }

    fn judged(verdict: Verdict, refitted: ModelError, repaired: ModelError) -> Diagnosis {
        Diagnosis { verdict, model_error: Some([refitted, repaired]), ..diagnosis() }
    }

    fn mass(probability: f64) -> Finding {
        let kind = EffectKind::AddedMass;
        let values = [0.18, 0.05];
        let parameters = kind.spec().parameters.iter().zip(values);
        Finding {
            effect: Effect::new(kind, Place::Body("high".into()), None, &values),
            estimates: parameters
                .map(|(p, value)| Estimate::of(*p, None, value).within(0.01 * value))
                .collect(),
            probability,
            alternatives: Vec::new(),
            evidence: FrfEvidence { gain: 70.0, elsewhere: Vec::new(), measured: None },
        }
    }

    fn departure(path: &str, deviations: f64) -> Departure {
        let repaired = 3.5 + 0.07 * deviations;
        Departure { path: path.into(), stated: 3.5, std: 0.07, refitted: 4.3, repaired, deviations }
    }

    #[track_caller]
    fn says(diagnosis: &Diagnosis, parts: &[&str], not: &[&str]) {
        let said = diagnosis.says();
        assert!(said.ends_with('.') && !said.contains("NaN"), "{said}");
        parts.iter().for_each(|part| assert!(said.contains(part), "`{part}` is missing from: {said}"));
        not.iter().for_each(|part| assert!(!said.contains(part), "`{part}` is said in: {said}"));
    }

    #[test]
    fn a_usual_error_of_the_model_is_told_by_its_kinds_and_calls_for_no_name() {
        let usual = error(5e-4, 0.0, 0.003);
        let diagnosis = judged(Verdict::Consistent, usual, usual);
        assert_eq!(
            diagnosis.says(),
            "Nothing is left out that a name would explain: the model is off by 0.05 % in natural frequency and 0.3 % in residues, as such \
             models are."
        );
    }

    #[test]
    fn a_finding_is_told_by_the_error_of_the_model_without_it_and_with_it() {
        let mut diagnosis = judged(Verdict::Explained, error(0.014, 0.05, 0.02), error(0.004, 0.0, 0.0));
        diagnosis.findings = vec![mass(0.9)];
        says(
            &diagnosis,
            &[
                "The fixture leaves out added mass on body high (50.00 g): check it.",
                "Without it the model would be off by 1.4 % in natural frequency, 5 % in damping ratio and 2 % in residues, with it by 0.4 % in \
                 natural frequency.",
            ],
            &["χ²", "noise", "departure"],
        );
    }

    #[test]
    fn a_finding_that_leaves_the_modes_as_far_off_is_told_by_what_else_it_makes_up_for() {
        let unmoved = error(0.0085, 0.0, 0.0055);
        let mut diagnosis = judged(Verdict::Explained, unmoved, unmoved);
        diagnosis.findings = vec![mass(0.9)];
        says(
            &diagnosis,
            &[
                "or phases; in the modes themselves the model is off by 0.85 % in natural frequency and 0.55 % in residues with it as without.",
            ],
            &["Without it"],
        );
        // Where it spares the fixture a departure, that is what it makes up for.
        let stated = &diagnosis.stated[0];
        let step: Vec<f64> =
            (0..stated.coordinates().len()).map(|index| if index == 0 { 20.0 } else { 0.0 }).collect();
        diagnosis.stated[0] = stated.stepped(&step);
        says(
            &diagnosis,
            &["Without it the model", "standard deviations from what is stated"],
            &["With it less"],
        );
    }

    #[test]
    fn an_error_that_vanishes_with_the_finding_is_no_more_than_noise() {
        let mut diagnosis = judged(Verdict::Explained, error(0.014, 0.0, 0.0), ModelError::default());
        diagnosis.findings = vec![mass(0.9), mass(0.9)];
        says(&diagnosis, &["check them. Without them", "with them by no more than the noise."], &["0 %"]);
    }

    #[test]
    fn what_the_frfs_show_besides_modes_without_error_is_never_called_noise() {
        let mut diagnosis = judged(Verdict::Consistent, ModelError::default(), ModelError::default());
        diagnosis.search.refitted.chi2 = 900.0 * diagnosis.observation.degrees() as f64;
        says(
            &diagnosis,
            &["off by nothing in its modes", "(χ² per degree of freedom 900) lies in gains of records"],
            &["noise"],
        );
    }

    #[test]
    fn what_remains_beside_a_finding_is_told_as_larger_than_usual_and_by_where_it_shows() {
        let mut diagnosis = judged(Verdict::PartlyExplained, error(0.06, 0.0, 0.02), error(0.01, 0.3, 0.0));
        diagnosis.findings = vec![mass(0.9)];
        says(
            &diagnosis,
            &[
                "but that is not all",
                "with it by 1 % in natural frequency and 30 % in damping ratio.",
                "What remains is larger than usual in natural frequency (usually 0.3 %) and in damping ratio (usually 10 %)",
                "most clearly in FRF",
            ],
            &["χ²"],
        );
        diagnosis.findings = vec![mass(0.2)];
        says(
            &diagnosis,
            &["none of the effects known here", "with the closest, added mass on body high (50.00 g)"],
            &["χ²"],
        );
    }

    #[test]
    fn an_error_is_held_against_what_models_of_its_kind_are_wrong_by() {
        let of_storeys = |frequency| ModelError { usual_frequency: Some(0.01), ..error(frequency, 0.0, 0.0) };
        let [told, ..] = error_in_words(&of_storeys(0.015));
        assert!(!told.large && told.usual == "1 %", "{told:?}");
        let [told, ..] = error_in_words(&error(0.015, 0.0, 0.0));
        assert!(told.large && told.usual == "0.3 %", "{told:?}");
        says(
            &judged(Verdict::Unexplained, of_storeys(0.03), of_storeys(0.03)),
            &["larger than usual in natural frequency (usually 1 %)"],
            &[],
        );
    }

    #[test]
    fn an_error_without_a_name_is_told_with_its_size_and_where_to_look() {
        let odd = error(0.0064, 0.0, 0.0014);
        says(
            &judged(Verdict::Unexplained, odd, odd),
            &[
                "the model is off by 0.64 % in natural frequency and 0.14 % in residues, and no effect makes that much smaller",
                "larger than usual in natural frequency (usually 0.3 %)",
                "most clearly in FRF",
            ],
            &["χ²"],
        );
        let usual = error(0.001, 0.0, 0.001);
        says(
            &judged(Verdict::Unexplained, usual, usual),
            &["in gains of records, mass lines, upper residuals or phases"],
            &[],
        );
    }

    #[test]
    fn a_departure_that_leaves_no_error_is_what_is_left_out_and_no_error_is_said_to_stay() {
        let mut diagnosis = judged(Verdict::Unexplained, ModelError::default(), ModelError::default());
        diagnosis.departures = vec![departure("joints/J/stiffness/0/0", -11.0)];
        says(
            &diagnosis,
            &["so changed the model is off by no more than the noise, and no effect does that in its stead"],
            &["makes that much smaller", "not larger than usual"],
        );
    }

    #[test]
    fn what_the_fixture_states_is_told_as_stated_and_what_is_larger_as_that() {
        let stated = StatedError { frequency: Some(0.003), ..StatedError::default() };
        let told = ModelError { stated, ..error(0.003, 0.0, 0.002) };
        let off = "the model is off by 0.3 % in natural frequency (as stated) and 0.2 % in residues, as such";
        says(&judged(Verdict::Consistent, told, told), &[off], &[]);
        let farther = ModelError { stated, ..error(0.012, 0.0, 0.002) };
        let off = "the model is off by 1.2 % in natural frequency and 0.2 % in residues";
        let than = "larger than stated in natural frequency (stated 0.3 %)";
        says(&judged(Verdict::Unexplained, farther, farther), &[off, than], &["as stated", "usual"]);
    }

    #[test]
    fn an_interval_stands_beside_a_size_and_beside_none() {
        let interval = [0.001, 0.004];
        let ci95 = ErrorIntervals {
            frequency: interval,
            damping: [0.0, 0.05],
            residue: [0.01; 2],
            strike: [4e-4, 0.0023],
        };
        let error = ModelError { ci95: Some(ci95), strike: 0.0011, ..error(0.002, 0.0, 0.01) };
        let told = error_in_words(&error).map(|error| error.with_interval);
        let strike = "1.1 mm (0.40 mm to 2.3 mm)";
        assert_eq!(told, ["0.2 % (0.1 % to 0.4 %)", "none seen (below 5 %)", "1 %", strike]);
        let off = "0.2 % in natural frequency, 1 % in residues and 1.1 mm in places of sensors and impacts";
        assert_eq!(sizes(&error), off);
    }

    #[test]
    fn a_quantity_far_from_what_is_stated_goes_before_everything_else() {
        let usual = error(5e-4, 0.0, 0.0);
        let mut diagnosis = judged(Verdict::Unexplained, usual, usual);
        diagnosis.departures = vec![departure("bodies/low/mass", 10.4), departure("points/1/x", -6.0)];
        let said = diagnosis.says();
        let first = "bodies/low/mass would have to be 4.23 kg, 10 standard deviations from the stated 3.50 kg (also too far from what is stated: \
                     points/1/x): measure them again, or take it as a sign of what is left out. Something is left out";
        assert!(said.starts_with(first), "{said}");
        says(&diagnosis, &["not larger than usual, but for the departure"], &[]);
    }

    #[test]
    fn a_departure_that_the_findings_take_away_is_told_with_the_model_that_lacks_them_only() {
        let mut diagnosis = judged(Verdict::Explained, error(0.014, 0.0, 0.0), error(0.001, 0.0, 0.0));
        diagnosis.findings = vec![mass(0.9)];
        diagnosis.departures = vec![departure("bodies/low/mass", 0.3)];
        says(&diagnosis, &["The fixture leaves out added mass"], &["would have to be"]);
        diagnosis.departures = vec![departure("bodies/low/mass", 5.0)];
        says(
            &diagnosis,
            &["bodies/low/mass would have to be 3.85 kg", "what was found does not account for it"],
            &[],
        );
    }

    #[test]
    fn where_the_noise_decides_a_departure_keeps_the_fixture_from_being_within_its_tolerances() {
        let mut diagnosis = diagnosis();
        assert_eq!((diagnosis.verdict, diagnosis.model_error), (Verdict::Consistent, None));
        says(&diagnosis, &["Nothing is left out", "down to their noise"], &[]);
        diagnosis.departures = vec![departure("bodies/low/mass", 10.4)];
        diagnosis.verdict = Verdict::Unexplained;
        says(
            &diagnosis,
            &[
                "bodies/low/mass would have to be 4.23 kg, 10 standard deviations from the stated 3.50 kg: measure it again. No effect is needed \
                 besides",
                "down to their noise (χ² per degree of freedom",
            ],
            &["within its stated tolerances", "Nothing is left out"],
        );
    }
}
