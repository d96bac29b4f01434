//! Sentences of a plan. They stand here and not in the crate of all other wording: a plan holds them, and
//! stands above it.

use crate::measure::Measure;
use crate::names::{NameNow, WeighedName};
use crate::settings::outcome::{BEYOND_DOUBT, SURE};
use crate::suggestion::{ExpectedInterval, Suggestion};
use jointscope_spectra::FrfPair;
use jointscope_wording::unit::Scale;
use jointscope_wording::{effect_name, listed};

pub(crate) fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

/// A probability that was drawn: a few hundred draws tell no more than that it is nearly one.
pub(crate) fn probability(share: f64) -> String {
    if share > 0.99 { "more than 99 %".to_owned() } else { percent(share) }
}

/// A number with three significant digits.
pub(crate) fn three(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exponent = value.abs().log10().floor() as i32;
    match exponent {
        -4..3 => format!("{value:.*}", (2 - exponent).max(0) as usize),
        3..5 => format!("{:.0}", (value / 10f64.powi(exponent - 2)).round() * 10f64.powi(exponent - 2)),
        _ => format!("{value:.2e}"),
    }
}

/// ln of odds, nats.
pub(crate) fn nats(value: f64) -> String {
    if value > BEYOND_DOUBT { format!("more than {BEYOND_DOUBT:.0}") } else { three(value) }
}

pub(crate) fn question(names: &[NameNow]) -> String {
    let each =
        names.iter().map(|name| format!("{} ({})", effect_name(&name.effect), percent(name.probability)));
    format!("Which is it: {}?", each.collect::<Vec<_>>().join(", or "))
}

/// What is to be done for a measurement.
pub(crate) fn to_do(measure: &Measure) -> String {
    let frfs = |frfs: &[FrfPair]| listed(&frfs.iter().map(ToString::to_string).collect::<Vec<_>>());
    let millimetres = |x: &f64| format!("{} mm", three(1e3 * x));
    match measure {
        Measure::Frf { frf } => {
            format!("Record FRF {frf}: hammer at {}, sensor at {}", frf.reference, frf.response)
        }
        Measure::Frfs { frfs: all } => format!("Record FRFs {}", frfs(all)),
        Measure::HammerAt { point, frfs: all } => {
            format!("Strike point {point} too, sensors as they are: FRFs {}", frfs(all))
        }
        Measure::SensorAt { point, frfs: all } => {
            format!("Put a sensor on point {point} too, hammer points as they are: FRFs {}", frfs(all))
        }
        Measure::Averages { times } => {
            format!("Record the same FRFs with {times} times as many averages in all")
        }
        Measure::AddedMass { mass, body, x, .. } => format!(
            "Fix a mass of {} g to body {body} at x = {} and record the same FRFs again",
            three(1e3 * mass),
            millimetres(x)
        ),
        Measure::HungFreely => {
            "Take the structure off its supports, hang it freely and record the same FRFs again".to_owned()
        }
        Measure::Quantity { path, std, unit } => {
            let verb = if *unit == "kg" { "Weigh" } else { "Measure" };
            let scale = Scale::of_stated([*std], unit);
            let to = format!("{} {}", three(scale.of(*std)), scale.unit());
            format!("{verb} {path} to ± {} (one standard deviation)", to.trim_end())
        }
    }
}

pub(crate) fn of_names(
    measure: &Measure,
    expected: f64,
    sure: f64,
    separates: &[[String; 2]],
    names: usize,
) -> String {
    let pairs = names * (names - 1) / 2;
    let separated = match separates.len() {
        0 => String::new(),
        _ if names == 2 => String::new(),
        all if all == pairs => "; it tells every two of the names apart".to_owned(),
        _ => {
            let each: Vec<String> = separates.iter().map(|[a, b]| format!("{a} from {b}")).collect();
            format!("; it tells {}", listed(&each))
        }
    };
    format!(
        "{}. With a probability of {} one name then has 90 % or more; ln of the odds against its nearest rival grows by {} on average{separated}.",
        to_do(measure),
        probability(sure),
        nats(expected)
    )
}

/// That a fixture with the joint free is not the structure recorded.
pub(crate) fn not_met() -> String {
    "The fixture does not meet the recording even with the joint free, so that an interval about this fit says nothing: `jointscope decompose` finds the joint with its damping, `jointscope diagnose` what the \
     fixture leaves out; plan with a fixture that states it"
        .to_owned()
}

pub(crate) fn of_interval(measure: &Measure, interval: &ExpectedInterval) -> String {
    let reaches = if interval.reaches { ", as narrow as wanted" } else { "" };
    let scale = Scale::for_values(interval.now.into_iter().chain([interval.then]), interval.unit);
    let unit = scale.unit();
    let now =
        interval.now.map_or_else(String::new, |now| format!(", after ± {} {unit} now", three(scale.of(now))));
    format!(
        "{}. The 95 % interval of {} is then ± {} {unit}{reaches}{now}.",
        to_do(measure),
        interval.element,
        three(scale.of(interval.then)),
    )
}

pub(crate) fn comes_to(names: &[NameNow], suggestions: &[Suggestion], not_by_frfs: &[[String; 2]]) -> String {
    let pairs: Vec<String> = not_by_frfs.iter().map(|[a, b]| format!("{a} from {b}")).collect();
    let by_frfs = match (pairs.is_empty(), names.len()) {
        (true, _) => String::new(),
        (false, 2) => " No FRF of this test separates them.".to_owned(),
        (false, _) => format!(" No FRF of this test separates {}.", listed(&pairs)),
    };
    match suggestions.first() {
        None => format!("Nothing that was considered tells the names apart.{by_frfs}"),
        Some(best) => format!(
            "{}: with a probability of {} one name then has 90 % or more.{by_frfs}",
            best.to_do,
            probability(best.sure.unwrap_or(0.0))
        ),
    }
}

/// What two tests say together.
pub(crate) fn weighed(names: &[WeighedName], chi2_per_dof: f64, is_met: bool) -> String {
    let Some(first) = names.first() else { return String::new() };
    let left = 1.0 - names.iter().map(|name| name.probability).sum::<f64>();
    if !is_met {
        return format!(
            "No name meets the further test: {} comes nearest and leaves χ² per degree of freedom of {}, so that something else differs between the tests, or was left out of both ({} for what no name covers). \
             See whether the second fixture states the mass, its place, the supports and the damping of that state, and diagnose the second test by itself.",
            effect_name(&first.effect),
            three(chi2_per_dof),
            percent(left)
        );
    }
    let is = effect_name(&first.effect);
    let before = percent(first.before);
    if first.probability >= SURE {
        return format!(
            "With both tests it is {is} ({}, after {before} without the further test).",
            probability(first.probability)
        );
    }
    format!(
        "The further test does not settle it: {is} has {} then, after {before} without it.",
        percent(first.probability)
    )
}

/// Names that the present test cannot have, and another one can.
pub(crate) fn added_names() -> String {
    "As long as the hammer strikes one point, the force of all references does what that reference does: it is a name too, as probable"
        .to_owned()
}

/// Names that need no further measurement.
pub(crate) fn sure_already(names: &[NameNow]) -> Option<String> {
    let first = names.first().filter(|first| first.probability >= SURE)?;
    Some(format!(
        "{} is sure already ({}): a further measurement confirms it, or finds that it was wrong",
        effect_name(&first.effect),
        percent(first.probability)
    ))
}

pub(crate) fn remarks(suggestions: &[Suggestion], inflation: f64, with_model_error: bool) -> Vec<String> {
    let mut all = Vec::new();
    if with_model_error {
        all.push(
            "The names were weighed by modes, with an error of the model: that counts as noise of every measurement to come. Promises are rough then, and unproved"
                .to_owned(),
        );
    }
    let any = |holds: fn(&Measure) -> bool| suggestions.iter().any(|suggestion| holds(&suggestion.action));
    if any(Measure::changes_the_structure) {
        all.push(
            "With a mass, or off its supports, the structure is another one: state that in a copy of the fixture, under physics or supports, and give both tests together with --second-test"
                .to_owned(),
        );
    }
    if inflation > 1.05 {
        all.push(format!(
            "The noise of measurements to come is taken {} times as large in variance as coherence or scatter state it, which is what the present residuals show",
            three(inflation)
        ));
    }
    all
}
