//! Key figures and the table of all averages.

use super::Subject;
use super::element::{Element, Kind};
use super::estimate::{Estimate, Figure};
use super::verdict::{band, share};
use crate::format::{NOT_DETERMINED, fixed, quantity, significant};
use crate::{Card, Column, Scale, Section, Table, Tone};

/// A determinant of c this small against c₁₁·c₂₂ lies on the boundary of what is passive.
const ON_THE_BOUNDARY: f64 = 1e-9;

pub(super) fn sections(subject: &Subject) -> Vec<Section> {
    let likelihood = Estimate::maximum_likelihood(subject.analysis);
    let mut section = Section::new("Result").paragraph(introduction(subject)).cards(cards(subject));
    section = section.warnings(warnings(subject));
    if subject.is_paper() {
        section = section.table(means_table(subject, None));
        if let Some(likelihood) = likelihood {
            section = section.table(likelihood_table(subject, &likelihood));
        }
    } else {
        section = section.table(means_table(subject, likelihood.as_ref()));
    }
    vec![section]
}

fn introduction(subject: &Subject) -> String {
    let method = subject.best.method.words();
    let which = if subject.best.paper { "the matrices of eq (7)" } else { "the joint" };
    let signs = if subject.is_scalar() {
        "k and c act between the displacements of the two bodies."
    } else {
        "k and c act on the relative motion d = u_to − R·u_from at the joint's far end, u = (y, θ), θ positive from x to y."
    };
    let signs = if subject.best.paper { "Signs are those of eq (7)." } else { signs };
    format!(
        "Best estimate of {which}: {method}. ± is one standard deviation, noise and the fixture's tolerances together. {signs}"
    )
}

fn cards(subject: &Subject) -> Vec<Card> {
    let scalar = subject.is_scalar();
    [Kind::Stiffness, Kind::Damping]
        .into_iter()
        .flat_map(|kind| Element::distinct(scalar).map(move |element| card(subject, kind, element)))
        .collect()
}

fn card(subject: &Subject, kind: Kind, element: Element) -> Card {
    let (best, unit) = (subject.best, kind.unit(element));
    let figure = best.figure(kind, element);
    let label = format!("{}, {}", kind.symbol(element, best.paper), kind.meaning(element));
    let mut notes = Vec::new();
    if figure.may_be_zero() {
        notes.push("cannot be told from zero".to_owned());
    }
    if let Some(nominal) = kind.nominal_average(subject.analysis, element, best.paper) {
        let text = quantity(nominal, None, unit);
        match kind {
            Kind::Stiffness if nominal != 0.0 && !figure.may_be_zero() => {
                notes.push(format!("{} of nominal {text}", share(figure.value / nominal)));
            }
            _ => notes.push(format!("nominal {text}")),
        }
    }
    let card = Card::quantity(label, figure.value, figure.total(), unit).note(notes.join(" · "));
    if figure.may_be_zero() { card.tone(Tone::Attention) } else { card }
}

fn warnings(subject: &Subject) -> Vec<String> {
    let mut warnings = Vec::new();
    if let Ok(fit) = &subject.analysis.likelihood {
        let c = &fit.damping;
        let product = c.at(0, 0) * c.at(1, 1);
        let on_boundary = if subject.is_scalar() {
            c.at(0, 0) == 0.0
        } else {
            c.determinant() <= ON_THE_BOUNDARY * product
        };
        if on_boundary {
            warnings.push(
                "The FRFs ask for a damping that would give out energy; c is held at the limit of what a passive joint can do. Its \
                 elements are tied to each other there, and their ± say little."
                    .to_owned(),
            );
        }
    }
    warnings
}

/// Means over the band, and the maximum-likelihood joint where it is of the same relation.
fn means_table(subject: &Subject, likelihood: Option<&Estimate>) -> Table {
    let analysis = subject.analysis;
    let paper = subject.is_paper();
    let plain = Estimate::plain(analysis);
    let weighted = Estimate::weighted(analysis);
    let mut columns = vec![
        Column::text("Element"),
        Column::text("Unit"),
        Column::numbers("Plain mean (eq 35, 42)", ""),
        Column::numbers("Weighted mean", ""),
    ];
    if likelihood.is_some() {
        columns.push(Column::numbers("Maximum likelihood", ""));
    }
    columns.push(Column::numbers("Nominal", ""));
    let caption = format!(
        "{} by {}: value ± noise (of the fit: and misfit) ± tolerances; means over {}, {} lines",
        if paper { "K and C" } else { "k and c" },
        subject.relation_words(),
        band(subject),
        analysis.averages.lines
    );
    let mut table = Table::new(columns).caption(caption);
    for kind in [Kind::Stiffness, Kind::Damping] {
        for &element in Element::all(subject.is_scalar()) {
            let plain = plain.figure(kind, element);
            let weighted = weighted.map(|mean| mean.figure(kind, element));
            let fitted = likelihood.map(|fit| fit.figure(kind, element));
            let nominal = kind.nominal_average(analysis, element, paper);
            let reference = fitted.or(weighted).unwrap_or(plain);
            let scale = scale(kind, element, [Some(reference.value), nominal]);
            let mut cells = vec![
                kind.symbol(element, paper),
                scale.unit().to_owned(),
                figure_text(&plain, &scale, 0.0),
                weighted.map_or_else(
                    || "–".to_owned(),
                    |figure| figure_text(&figure, &scale, plain.tolerance.unwrap_or(0.0)),
                ),
            ];
            cells.extend(fitted.map(|figure| figure_text(&figure, &scale, 0.0)));
            cells.push(nominal_text(nominal, &scale));
            table = table.row(cells);
        }
    }
    footnotes(table, subject, likelihood.is_some())
}

fn footnotes(table: Table, subject: &Subject, with_likelihood: bool) -> Table {
    let mut table = table;
    if with_likelihood && !subject.is_scalar() {
        table = table.footnote(
            "The maximum-likelihood k and c are symmetric by construction; 21 repeats 12. The means are not held to that: what 12 \
             and 21 differ by beyond their ± is an error of the model or the test.",
        );
    }
    if Estimate::weighted(subject.analysis).is_some() {
        table = table.footnote(
            "Tolerances act on the weighted mean much as on the plain one; they are not worked out for it.",
        );
    }
    if !subject.is_scalar() {
        let what = if subject.is_paper() {
            "what eq (7) makes of the fixture as it stands, a mean over the same lines"
        } else {
            "the fixture's joint; its c is its share of the fixture's damping, a mean over the same lines"
        };
        table = table.footnote(format!("Nominal: {what}."));
    }
    table
}

/// The exact joint beside the matrices of eq (7).
fn likelihood_table(subject: &Subject, likelihood: &Estimate) -> Table {
    let columns = [
        Column::text("Element"),
        Column::text("Unit"),
        Column::numbers("Maximum likelihood", ""),
        Column::numbers("Nominal", ""),
    ];
    let mut table = Table::new(columns)
        .caption("The exact joint's k and c, fitted to the FRFs: value ± noise and misfit ± tolerances (not eq 7, and not to be compared with it element by element)");
    for kind in [Kind::Stiffness, Kind::Damping] {
        for element in Element::distinct(subject.is_scalar()) {
            let figure = likelihood.figure(kind, element);
            let nominal = match kind {
                Kind::Stiffness => kind.nominal_average(subject.analysis, element, false),
                Kind::Damping => None,
            };
            let scale = scale(kind, element, [Some(figure.value), nominal]);
            table = table.row([
                kind.symbol(element, false),
                scale.unit().to_owned(),
                figure_text(&figure, &scale, 0.0),
                nominal_text(nominal, &scale),
            ]);
        }
    }
    table
}

fn scale(kind: Kind, element: Element, values: [Option<f64>; 2]) -> Scale {
    Scale::for_values(values.into_iter().flatten(), kind.unit(element))
}

fn nominal_text(nominal: Option<f64>, scale: &Scale) -> String {
    nominal.map_or_else(|| "–".to_owned(), |value| significant(scale.of(value), 4))
}

/// `1.432 ± 0.012 ± 0.031`: the larger of noise, tolerance and `coarsest` (SI) sets the digits, either keeps one of its own at
/// least.
fn figure_text(figure: &Figure, scale: &Scale, coarsest: f64) -> String {
    if !figure.value.is_finite() {
        return NOT_DETERMINED.to_owned();
    }
    let stds: Vec<f64> = [Some(figure.noise), figure.tolerance]
        .into_iter()
        .flatten()
        .map(|std| scale.of(std))
        .filter(|std| std.is_finite())
        .collect();
    let largest = stds.iter().fold(scale.of(coarsest), |a, b| a.max(*b));
    if largest <= 0.0 {
        return significant(scale.of(figure.value), 4);
    }
    let decimals = decimals(largest, 2).clamp(0, 8);
    let mut text = fixed(scale.of(figure.value), decimals as usize);
    for std in stds {
        let own = if std > 0.0 { decimals.max(decimals_of(std)) } else { decimals };
        text.push_str(&format!(" ± {}", fixed(std, own.clamp(0, 8) as usize)));
    }
    text
}

/// Decimals that show so many significant digits.
fn decimals(value: f64, digits: i32) -> i32 {
    digits - 1 - value.log10().floor() as i32
}

fn decimals_of(value: f64) -> i32 {
    decimals(value, 1)
}
