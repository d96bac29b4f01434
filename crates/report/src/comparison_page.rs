//! The page of several joints side by side: who is stiffer, how sure that is, and their spectra in common plots.

use jointscope_comparison::{Comparison, ELEMENTS, ElementRanking, Kind, Matrix};

use crate::format::{in_column, percent};
use crate::{Axis, Column, Page, PageContext, PageError, Plot, Role, Scale, Section, Table, Verdict, YRange};

/// An order less probable than this is called open.
const SURE: f64 = 0.95;

/// The page of a comparison as one self-contained HTML file: orders with probabilities, values, and the spectra of K and C (Figures 5–9).
///
/// The same input gives the same bytes.
///
/// # Errors
/// Joints whose lists do not fit their spectral lines.
pub fn comparison_page(comparison: &Comparison, context: &PageContext) -> Result<String, PageError> {
    let names: Vec<&str> = comparison.joints.iter().map(|joint| joint.name.as_str()).collect();
    let mut page = Page::new(format!("{} joints side by side", names.len()))
        .subtitle(names.join(" · "))
        .verdict(verdict(comparison))
        .section(order_section(comparison))
        .section(value_section(comparison));
    for kind in [Kind::Stiffness, Kind::Damping] {
        page = page.section(spectra_section(comparison, kind));
    }
    page.foot(context.foot()).to_html()
}

fn symbol(entry: &ElementRanking) -> String {
    name_of(entry.kind, entry.element)
}

fn name_of(kind: Kind, (i, j): (usize, usize)) -> String {
    const DIGITS: [&str; 2] = ["₁", "₂"];
    format!("{}{}{}", kind.symbol(), DIGITS[i], DIGITS[j])
}

fn order_words(comparison: &Comparison, entry: &ElementRanking) -> String {
    let name = |index: &usize| comparison.joints[*index].name.as_str();
    let mut words = String::new();
    for (place, index) in entry.ranking.order.iter().enumerate() {
        if place > 0 {
            let sure = entry.ranking.adjacent[place - 1] >= SURE;
            words.push_str(if sure { " < " } else { " ≲ " });
        }
        words.push_str(name(index));
    }
    words
}

fn verdict(comparison: &Comparison) -> Verdict {
    let stiffness = || comparison.rankings.iter().filter(|entry| entry.kind == Kind::Stiffness);
    let settled: Vec<String> =
        stiffness().filter(|entry| entry.ranking.probability >= SURE).map(symbol).collect();
    let headline = match comparison.rankings.first() {
        Some(first) => format!(
            "By {}, from the most compliant to the stiffest: {} (right with a probability of {}).",
            symbol(first),
            order_words(comparison, first),
            sure(first.ranking.probability)
        ),
        None => "There is nothing to compare.".to_owned(),
    };
    let detail = match settled.len() {
        0 => "No element of K orders all joints with a probability of 95 %.".to_owned(),
        4 => "All elements of K order the joints with a probability of 95 % or more.".to_owned(),
        _ => format!(
            "The whole order is sure (95 %) by {}; by the other elements of K it is open.",
            settled.join(", ")
        ),
    };
    let verdict = if settled.len() == 4 { Verdict::ok(headline) } else { Verdict::attention(headline) };
    verdict.detail(detail)
}

fn order_section(comparison: &Comparison) -> Section {
    let mut table = Table::new([
        Column::text("element"),
        Column::text("from the smallest magnitude to the largest"),
        Column::text("whole order right"),
        Column::text("each larger than the one before"),
    ]);
    for entry in &comparison.rankings {
        let adjacent: Vec<String> = entry.ranking.adjacent.iter().map(|p| sure(*p)).collect();
        table = table.row([
            symbol(entry),
            order_words(comparison, entry),
            sure(entry.ranking.probability),
            adjacent.join(", "),
        ]);
    }
    let table = table.footnote("≲ : less than 95 % sure. Standard deviations are taken as normal and independent from joint to joint.");
    Section::new("Rank order")
        .paragraph(format!(
            "Orders of magnitude by {}. Tolerances that two tests share, such as those of the same blocks, move both values alike; taken as \
             independent they make an order look less sure than it is.",
            comparison.estimate_words()
        ))
        .table(table)
}

fn value_section(comparison: &Comparison) -> Section {
    let mut section = Section::new("Values");
    for kind in [Kind::Stiffness, Kind::Damping] {
        let scales: Vec<Scale> = ELEMENTS
            .iter()
            .map(|element| {
                let values = comparison.joints.iter().map(|j| kind.of(comparison.estimate(j), *element).0);
                Scale::for_values(values, kind.unit(*element))
            })
            .collect();
        let mut columns = vec![Column::text("joint")];
        columns.extend(
            ELEMENTS
                .iter()
                .zip(&scales)
                .map(|(element, scale)| Column::numbers(name_of(kind, *element), scale.unit())),
        );
        let mut table = Table::new(columns);
        for joint in &comparison.joints {
            let cell = |(element, scale): (&(usize, usize), &Scale)| {
                let (value, std) = kind.of(comparison.estimate(joint), *element);
                in_column(value, std, scale)
            };
            let mut cells = vec![joint.name.clone()];
            cells.extend(ELEMENTS.iter().zip(&scales).map(cell));
            table = table.row(cells);
        }
        section = section.table(table.footnote("± one standard deviation: noise, the fixture's tolerances, and what a constant joint leaves unexplained"));
    }
    section
}

fn spectra_section(comparison: &Comparison, kind: Kind) -> Section {
    let word = match kind {
        Kind::Stiffness => "Stiffness by line",
        Kind::Damping => "Damping by line",
    };
    let relation = match comparison.relation.as_str() {
        "paper" => "eq (7), signs included; its peaks are its own",
        _ => "the exact relation",
    };
    Section::new(word)
        .paragraph(format!(
            "By {relation}. Bands are 95 % intervals from noise alone; gaps are masked lines."
        ))
        .plots(2, ELEMENTS.map(|element| plot(comparison, kind, element)))
}

fn plot(comparison: &Comparison, kind: Kind, element: (usize, usize)) -> Plot {
    let (i, j) = element;
    let of = |k: &Matrix, c: &Matrix| match kind {
        Kind::Stiffness => k[i][j],
        Kind::Damping => c[i][j],
    };
    let symbol = name_of(kind, element);
    let mut plot =
        Plot::new(symbol.clone(), Axis::frequency(), Axis::linear(symbol.clone(), kind.unit(element)));
    for (index, joint) in comparison.joints.iter().enumerate() {
        let role = Role::Trace(index);
        plot = plot.over(joint.lines.iter().map(|line| line.frequency));
        let edge = |sign: f64| {
            let value = move |line: &jointscope_comparison::Line| {
                let (k, c) = line.std?;
                Some(of(&line.stiffness, &line.damping) + sign * 1.96 * of(&k, &c))
            };
            joint.lines.iter().map(value).collect::<Vec<Option<f64>>>()
        };
        if joint.lines.iter().any(|line| line.std.is_some()) {
            plot = plot.band(format!("{}, 95 %", joint.name), role, edge(-1.0), edge(1.0));
        }
        plot = plot.line(
            joint.name.clone(),
            role,
            joint.lines.iter().map(|line| of(&line.stiffness, &line.damping)),
        );
    }
    for (index, joint) in comparison.joints.iter().enumerate() {
        let level = kind.of(comparison.estimate(joint), element).0;
        plot = plot.horizontal(format!("{}, estimate", joint.name), Role::Trace(index), level);
    }
    let names: Vec<&str> = comparison.joints.iter().map(|joint| joint.name.as_str()).collect();
    let range = range(comparison, kind, element);
    plot.y_range(range).masked(0).line_limit(2_000).caption(format!("{symbol} of {}.", names.join(", ")))
}

/// What is drawn at first: the estimates and the middle of the lines in the joints' averaging bands, which poles and noise would squash.
fn range(comparison: &Comparison, kind: Kind, (i, j): (usize, usize)) -> YRange {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for joint in &comparison.joints {
        let level = kind.of(comparison.estimate(joint), (i, j)).0;
        let inside =
            joint.lines.iter().filter(|l| l.frequency >= joint.band.0 && l.frequency <= joint.band.1);
        let mut values: Vec<f64> = inside
            .map(|line| match kind {
                Kind::Stiffness => line.stiffness[i][j],
                Kind::Damping => line.damping[i][j],
            })
            .collect();
        values.sort_by(f64::total_cmp);
        let at = |share: f64| values.get((share * values.len().saturating_sub(1) as f64) as usize).copied();
        for value in [Some(level), at(0.1), at(0.9)].into_iter().flatten() {
            (low, high) = (low.min(value), high.max(value));
        }
    }
    let room = (0.4 * (high - low)).max(0.02 * low.abs().max(high.abs()));
    if room > 0.0 && room.is_finite() {
        YRange::Fixed { low: low - room, high: high + room }
    } else {
        YRange::robust()
    }
}

/// A probability as a percentage that never claims to be certain of what was found by drawing.
fn sure(probability: f64) -> String {
    if probability > 0.999 { "> 99.9 %".to_owned() } else { percent(probability, 1) }
}
