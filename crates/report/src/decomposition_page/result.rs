//! Key figures and the table of all averages.

use jointscope_decomposition::{DynamicStiffnessPart, ElementFigure, JointEstimate, MatrixElement};

use super::subject::Subject;
use crate::format::{in_parts, quantity_in, significant};
use crate::section::{Card, Section};
use crate::table::Table;
use crate::tone::Tone;
use crate::unit::Scale;
use jointscope_wording::decomposition::{band, share};
use jointscope_wording::element::{meaning, method, symbol, unit};

pub(super) fn section(subject: &Subject) -> Section {
    let likelihood = JointEstimate::maximum_likelihood(subject.analysis);
    let all = JointEstimate::all_frfs(subject.analysis);
    let section = Section::new("Result")
        .paragraph(introduction(subject))
        .cards(cards(subject))
        .warnings(warning(subject));
    match likelihood {
        Some(fit) if subject.is_paper() => {
            section.with(means_table(subject, None, None)).with(likelihood_table(subject, &fit, all.as_ref()))
        }
        fit => section.with(means_table(subject, fit.as_ref(), all.as_ref().filter(|_| !subject.is_paper()))),
    }
}

fn introduction(subject: &Subject) -> String {
    let method = method(subject.best.method, subject.is_exact());
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
    DynamicStiffnessPart::ALL
        .into_iter()
        .flat_map(|part| MatrixElement::distinct(scalar).map(move |element| card(subject, part, element)))
        .collect()
}

fn card(subject: &Subject, part: DynamicStiffnessPart, element: MatrixElement) -> Card {
    let (best, unit) = (subject.best, unit(part, element));
    let figure = best.figure(part, element);
    let label = format!("{}, {}", symbol(part, element, best.paper), meaning(part, element));
    let mut notes = Vec::new();
    if figure.may_be_zero() {
        notes.push("cannot be told from zero".to_owned());
    }
    let nominal = subject.analysis.nominal_average(part, element, best.paper);
    let scale = Scale::for_values(nominal.into_iter().chain([figure.value, figure.total()]), unit);
    if let Some(nominal) = nominal {
        let text = quantity_in(nominal, None, &scale);
        match part {
            DynamicStiffnessPart::Stiffness if nominal != 0.0 && !figure.may_be_zero() => {
                notes.push(format!("{} of nominal {text}", share(figure.value / nominal)));
            }
            _ => notes.push(format!("nominal {text}")),
        }
    }
    Card::quantity_in(label, figure.value, figure.total(), &scale)
        .note(notes.join(" · "))
        .tone(figure.may_be_zero().then_some(Tone::Attention))
}

fn warning(subject: &Subject) -> Option<&'static str> {
    subject.analysis.judgement.damping_at_limit.then_some(
        "The FRFs ask for a damping that would give out energy; c is held at the limit of what a passive joint can do. Its \
         elements are tied to each other there, and their ± say little.",
    )
}

/// An element in the unit of its row.
struct Row {
    part: DynamicStiffnessPart,
    element: MatrixElement,
    /// The fixture's, SI.
    nominal: Option<f64>,
    scale: Scale,
}

impl Row {
    /// A row whose unit suits a reference value and the nominal one.
    fn new(part: DynamicStiffnessPart, element: MatrixElement, reference: f64, nominal: Option<f64>) -> Self {
        let scale = Scale::for_values(nominal.into_iter().chain([reference]), unit(part, element));
        Row { part, element, nominal, scale }
    }

    /// Value ± noise ± tolerance; `coarsest` (SI) sets the digits where it is larger than both.
    fn text(&self, estimate: &JointEstimate, coarsest: f64) -> String {
        let ElementFigure { value, noise, tolerance } = estimate.figure(self.part, self.element);
        let stds: Vec<f64> = [Some(noise), tolerance].into_iter().flatten().collect();
        in_parts(value, &stds, coarsest, &self.scale)
    }
}

fn table(rows: impl Iterator<Item = Row>, paper: bool) -> Table<Row> {
    Table::of(rows)
        .words("Element", |row| symbol(row.part, row.element, paper))
        .words("Unit", |row| row.scale.unit().to_owned())
}

fn with_nominal(table: Table<Row>) -> Table<Row> {
    table.numbers("Nominal", "", |row| {
        row.nominal.map_or_else(|| "–".to_owned(), |value| significant(row.scale.of(value), 4))
    })
}

/// Means over the band, and the maximum-likelihood joint where it is of the same relation.
fn means_table(
    subject: &Subject,
    likelihood: Option<&JointEstimate>,
    all: Option<&JointEstimate>,
) -> Table<Row> {
    let (analysis, paper) = (subject.analysis, subject.is_paper());
    let (plain, weighted) = (JointEstimate::plain(analysis), JointEstimate::weighted(analysis));
    let reference = all.or(likelihood).or(weighted.as_ref()).unwrap_or(&plain);
    let rows = DynamicStiffnessPart::ALL.into_iter().flat_map(|part| {
        MatrixElement::all(subject.is_scalar()).iter().map(move |&element| {
            let nominal = analysis.nominal_average(part, element, paper);
            Row::new(part, element, reference.figure(part, element).value, nominal)
        })
    });
    // Tolerances of the weighted mean are much those of the plain one.
    let coarsest = |row: &Row| plain.figure(row.part, row.element).tolerance.unwrap_or(0.0);
    let mut table = table(rows, paper)
        .numbers("Plain mean (eq 35, 42)", "", |row| row.text(&plain, 0.0))
        .numbers("Weighted mean", "", |row| {
            weighted.map_or_else(|| "–".to_owned(), |mean| row.text(&mean, coarsest(row)))
        })
        .caption(format!(
            "{} by {}: value ± noise (of the fit: and misfit) ± tolerances; means over {}, {} lines",
            if paper { "K and C" } else { "k and c" },
            subject.relation_words(),
            band(subject.analysis),
            analysis.averages.lines
        ));
    if let Some(fit) = likelihood {
        table = table.numbers("FRFs across", "", |row| row.text(fit, 0.0));
    }
    if let Some(fit) = all {
        table = table.numbers("All FRFs", "", |row| row.text(fit, 0.0));
    }
    footnotes(subject, likelihood.is_some()).into_iter().fold(with_nominal(table), Table::footnote)
}

fn footnotes(subject: &Subject, with_likelihood: bool) -> Vec<&'static str> {
    let mut notes = Vec::new();
    if with_likelihood && !subject.is_scalar() {
        notes.push(match subject.is_exact() {
            true => "FRFs across: maximum likelihood from those alone; all FRFs: from the others as well; the fixture taken as exact.",
            false => {
                "FRFs across: maximum likelihood from those alone, the fixture as stated; all FRFs: with the fixture moving within its tolerances, noise and \
                 tolerances in one ±."
            }
        });
        notes.push(
            "Fitted k and c are symmetric by construction; 21 repeats 12. The means are not held to that: what 12 \
             and 21 differ by beyond their ± is an error of the model or the test.",
        );
    }
    if JointEstimate::weighted(subject.analysis).is_some() {
        notes.push(
            "Tolerances act on the weighted mean much as on the plain one; they are not worked out for it.",
        );
    }
    if !subject.is_scalar() {
        notes.push(if subject.is_paper() {
            "Nominal: what eq (7) makes of the fixture as it stands, a mean over the same lines."
        } else {
            "Nominal: the fixture's joint; its c is its share of the fixture's damping, a mean over the same lines."
        });
    }
    notes
}

/// The exact joint beside the matrices of eq (7).
fn likelihood_table(
    subject: &Subject,
    likelihood: &JointEstimate,
    all: Option<&JointEstimate>,
) -> Table<Row> {
    let rows = DynamicStiffnessPart::ALL.into_iter().flat_map(|part| {
        MatrixElement::distinct(subject.is_scalar()).map(move |element| {
            let nominal = subject.analysis.nominal_average(part, element, false);
            let nominal = nominal.filter(|_| part == DynamicStiffnessPart::Stiffness);
            Row::new(part, element, likelihood.figure(part, element).value, nominal)
        })
    });
    let mut table = table(rows, false).numbers("FRFs across", "", |row| row.text(likelihood, 0.0));
    if let Some(all) = all {
        table = table.numbers("All FRFs", "", |row| row.text(all, 0.0));
    }
    with_nominal(table).caption("The exact joint's k and c, fitted to the FRFs: value ± noise and misfit ± tolerances (not eq 7, and not to be compared with it element by element)")
}
