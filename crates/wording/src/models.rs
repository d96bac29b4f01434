//! Joints of models over measured ones, in words.

use crate::ratio::percents;
use jointscope_comparison::{Comparison, Kind, ModelIs, ModelRatio, ModelRatios, Number, Ratio, Source};

/// What a joint is of.
pub fn source(source: Source) -> &'static str {
    match source {
        Source::Simulation => "simulation",
        Source::Measurement => "measurement",
        Source::FiniteElements => "finite elements",
    }
}

/// How many ratios agree with 1, and where a model is stiffer or softer, more or less damped than what was
/// measured; nothing where no model is set against a measurement.
pub fn sentence(all: &[ModelRatios]) -> Option<String> {
    if all.is_empty() {
        return None;
    }
    let (agreeing, known) = ModelRatios::agreement(all);
    let count = match (agreeing, known) {
        (_, 0) => return Some("no number of a model has a ratio to the measured one".to_owned()),
        (1, 1) => {
            "the one ratio of a model to the measurement agrees with 1 within its 95 % interval".to_owned()
        }
        (n, m) if n == m => {
            format!("all {m} ratios of models to the measurement agree with 1 within their 95 % intervals")
        }
        (1, m) => {
            format!("1 of {m} ratios of models to the measurement agrees with 1 within its 95 % interval")
        }
        (n, m) => {
            format!("{n} of {m} ratios of models to the measurement agree with 1 within their 95 % intervals")
        }
    };
    // That a wide interval has 1 in it is no praise of the model.
    let widest = agreeing_ratios(all).max_by(|(_, a), (_, b)| width(a).total_cmp(&width(b)));
    let widest = widest
        .filter(|_| agreeing > 1)
        .map(|(name, ratio)| format!(", the widest of these being {name}, {}", percents(&ratio)));
    let count = count + &widest.unwrap_or_default();
    let departing: Vec<String> = all.iter().filter_map(departures).collect();
    Some(std::iter::once(count).chain(departing).collect::<Vec<_>>().join("; "))
}

/// Ratios that agree with 1, and what they are of: `K22 of fem / exp`.
fn agreeing_ratios(all: &[ModelRatios]) -> impl Iterator<Item = (String, Ratio)> {
    let each = all.iter().flat_map(|model| model.numbers.iter().map(move |number| (model, number)));
    each.filter(|(_, number)| number.model_is == Some(ModelIs::AsMeasured)).filter_map(|(model, number)| {
        Some((format!("{} of {}", number.element, OverOne::heading(model)), number.ratio?))
    })
}

/// Of its 95 % interval.
fn width(ratio: &Ratio) -> f64 {
    ratio.ci95[1] - ratio.ci95[0]
}

/// `fem is softer than exp by K11, K12, and less damped by C11`.
fn departures(one: &ModelRatios) -> Option<String> {
    let by = |kind, is, words: [&'static str; 2]| {
        let named = one.numbers.iter().filter(|n| n.of == kind && n.model_is == Some(is));
        let names: Vec<&str> = named.map(|number| number.element.as_str()).collect();
        (!names.is_empty()).then(|| (words, names.join(", ")))
    };
    let parts = [
        by(Kind::Stiffness, ModelIs::Larger, ["stiffer", "than"]),
        by(Kind::Stiffness, ModelIs::Smaller, ["softer", "than"]),
        by(Kind::Stiffness, ModelIs::Different, ["different", "from"]),
        by(Kind::Damping, ModelIs::Larger, ["more damped", "than"]),
        by(Kind::Damping, ModelIs::Smaller, ["less damped", "than"]),
        by(Kind::Damping, ModelIs::Different, ["different", "from"]),
    ];
    let parts: Vec<String> = parts
        .into_iter()
        .flatten()
        .enumerate()
        .map(|(place, ([word, than], names))| match place {
            0 => format!("{word} {than} {} by {names}", one.measurement),
            _ => format!("{word} by {names}"),
        })
        .collect();
    (!parts.is_empty()).then(|| format!("{} is {}", one.model, parts.join(", and ")))
}

/// Where joints are said to be of a model and none of a measurement: that nothing is set against anything.
pub fn without_measurement(comparison: &Comparison) -> Option<String> {
    let has = |wanted: fn(Source) -> bool| comparison.joints.iter().any(|j| j.source.is_some_and(wanted));
    (has(Source::is_model) && !has(|source| !source.is_model())).then(|| {
        "no joint is said to be of a measurement (`--as exp=DIR`), so that no model is set against one"
            .to_owned()
    })
}

/// Ratios of all models to one measured joint.
#[derive(Debug)]
pub struct OverOne<'a> {
    /// The measured joint.
    pub measurement: &'a str,
    /// By model.
    pub models: Vec<&'a ModelRatios>,
    /// The numbers that any of them has, in their order.
    pub elements: Vec<&'a str>,
}

impl OverOne<'_> {
    /// What a model has of a number.
    pub fn ratio<'b>(model: &'b ModelRatios, element: &str) -> Option<&'b ModelRatio> {
        model.numbers.iter().find(|number| number.element == element)
    }

    /// Heading of a model's column: `fem / exp`.
    pub fn heading(model: &ModelRatios) -> String {
        format!("{} / {}", model.model, model.measurement)
    }

    /// A ratio with its interval, or a dash.
    pub fn cell(model: &ModelRatios, element: &str) -> String {
        let ratio = Self::ratio(model, element).and_then(|number| number.ratio);
        ratio.map_or("–".to_owned(), |ratio| percents(&ratio))
    }
}

/// The numbers that have no ratio to the measured joint's, and why, if there are any.
pub fn without_ratio(comparison: &Comparison, over: &OverOne) -> Option<String> {
    let has_none = |element: &String| {
        over.models.iter().all(|model| OverOne::ratio(model, element).is_none_or(|n| n.ratio.is_none()))
    };
    let names: Vec<String> =
        comparison.numbers.iter().map(|number| Number::name(*number)).filter(has_none).collect();
    (!names.is_empty()).then(|| {
        format!(
            "{} of {} cannot be told from zero, or nothing tells how sure it is: no ratio to it is known",
            names.join(", "),
            over.measurement
        )
    })
}

/// The ratios by measured joint, a table each.
pub fn by_measurement(comparison: &Comparison) -> Vec<OverOne<'_>> {
    let mut all: Vec<OverOne<'_>> = Vec::new();
    for ratios in &comparison.models {
        match all.iter_mut().find(|over| over.measurement == ratios.measurement) {
            Some(over) => over.models.push(ratios),
            None => all.push(OverOne {
                measurement: &ratios.measurement,
                models: vec![ratios],
                elements: Vec::new(),
            }),
        }
    }
    for over in &mut all {
        let names = comparison.numbers.iter().map(|number| number.name());
        over.elements = names
            .filter_map(|name| {
                let found = over.models.iter().find_map(|model| OverOne::ratio(model, &name))?;
                Some(found.element.as_str())
            })
            .collect();
    }
    all
}

/// The sentence and the tables for a terminal: a column a model, a row a number.
pub(crate) fn lines(comparison: &Comparison) -> Vec<String> {
    let mut lines: Vec<String> =
        sentence(&comparison.models).into_iter().chain(without_measurement(comparison)).collect();
    for over in by_measurement(comparison) {
        let mut columns: Vec<Vec<String>> =
            vec![std::iter::once("").chain(over.elements.iter().copied()).map(str::to_owned).collect()];
        columns.extend(over.models.iter().map(|model| {
            let cells = over.elements.iter().map(|element| OverOne::cell(model, element));
            std::iter::once(OverOne::heading(model)).chain(cells).collect()
        }));
        let width = |column: &[String]| column.iter().map(|cell| cell.chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = columns.iter().map(|column| width(column)).collect();
        lines.extend((0..=over.elements.len()).map(|row| {
            let cells = columns.iter().zip(&widths).map(|(column, width)| format!("{:<width$}", column[row]));
            format!("  {}", cells.collect::<Vec<_>>().join("  ").trim_end())
        }));
        lines.extend(without_ratio(comparison, &over).map(|text| format!("  {text}")));
    }
    lines
}
