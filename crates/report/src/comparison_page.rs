//! The page of several joints side by side: who is stiffer, how sure that is, and their spectra in common plots.

use jointscope_comparison::{Comparison, Decomposed, ELEMENTS, ElementRanking, Kind, Matrix};

use crate::context::PageContext;
use crate::error::PageError;
use crate::format::{in_column, percent};
use crate::plot::{Axis, Plot, Role, Span, YRange};
use crate::section::{Section, Tone, Verdict};
use crate::table::Table;
use crate::unit::Scale;

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
    context
        .page(format!("{} joints side by side", names.len()), names.join(" · "), verdict(comparison))
        .sections([order_section(comparison), value_section(comparison)])
        .sections([Kind::Stiffness, Kind::Damping].map(|kind| spectra_section(comparison, kind)))
        .to_html()
}

fn symbol(entry: &ElementRanking) -> String {
    name_of(entry.kind, entry.element)
}

fn name_of(kind: Kind, (i, j): (usize, usize)) -> String {
    const DIGITS: [&str; 2] = ["₁", "₂"];
    format!("{}{}{}", kind.symbol(), DIGITS[i], DIGITS[j])
}

fn order_words(comparison: &Comparison, entry: &ElementRanking) -> String {
    let signs = entry.ranking.adjacent.iter().map(|p| if *p >= SURE { " < " } else { " ≲ " });
    let names = entry.ranking.order.iter().map(|index| comparison.joints[*index].name.as_str());
    std::iter::once("").chain(signs).zip(names).flat_map(|(sign, name)| [sign, name]).collect()
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
    let tone = if settled.len() == 4 { Tone::Ok } else { Tone::Attention };
    Verdict { tone, headline, details: vec![detail] }
}

fn order_section(comparison: &Comparison) -> Section {
    let each = |entry: &ElementRanking| entry.ranking.adjacent.iter().map(|p| sure(*p)).collect::<Vec<_>>();
    let table = Table::of(&comparison.rankings)
        .words("element", |entry| symbol(entry))
        .words("from the smallest magnitude to the largest", |entry| order_words(comparison, entry))
        .words("whole order right", |entry| sure(entry.ranking.probability))
        .words("each larger than the one before", |entry| each(entry).join(", "))
        .footnote("≲ : less than 95 % sure. Standard deviations are taken as normal and independent from joint to joint.");
    Section::new("Rank order")
        .paragraph(format!(
            "Orders of magnitude by {}. Tolerances that two tests share, such as those of the same blocks, move both values alike; taken as \
             independent they make an order look less sure than it is.",
            comparison.estimate_words()
        ))
        .with(table)
}

fn value_section(comparison: &Comparison) -> Section {
    let table = |kind: Kind| {
        let table = Table::of(0..comparison.joints.len())
            .words("joint", |&joint| comparison.joints[joint].name.clone());
        let table = ELEMENTS.iter().fold(table, |table, &element| {
            let values = (0..comparison.joints.len()).map(|j| kind.of(&comparison.estimate(j), element).0);
            let scale = Scale::for_values(values, kind.unit(element));
            table.numbers(name_of(kind, element), scale.unit(), |&joint| {
                let (value, std) = kind.of(&comparison.estimate(joint), element);
                in_column(value, std, &scale)
            })
        });
        table.footnote("± one standard deviation: noise, the fixture's tolerances, and what a constant joint leaves unexplained")
    };
    Section::new("Values").with(table(Kind::Stiffness)).with(table(Kind::Damping))
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

fn at(kind: Kind, stiffness: &Matrix, damping: &Matrix, (i, j): (usize, usize)) -> f64 {
    match kind {
        Kind::Stiffness => stiffness[i][j],
        Kind::Damping => damping[i][j],
    }
}

fn plot(comparison: &Comparison, kind: Kind, element: (usize, usize)) -> Plot {
    let of = |k: &Matrix, c: &Matrix| at(kind, k, c, element);
    let symbol = name_of(kind, element);
    let mut plot =
        Plot::new(symbol.clone(), Axis::frequency(), Axis::linear(symbol.clone(), kind.unit(element)));
    for (index, joint) in comparison.joints.iter().enumerate() {
        let role = Role::Trace(index);
        plot = plot.over(joint.lines.iter().map(|line| line.frequency));
        let edge = |sign: f64| {
            joint.lines.iter().map(move |line| {
                let (k, c) = line.std?;
                Some(of(&line.stiffness, &line.damping) + sign * 1.96 * of(&k, &c))
            })
        };
        if joint.lines.iter().any(|line| line.std.is_some()) {
            plot = plot.band(format!("{}, 95 %", joint.name), role, edge(-1.0), edge(1.0));
        }
        let values = joint.lines.iter().map(|line| of(&line.stiffness, &line.damping));
        plot = plot.line(&joint.name, role, values);
    }
    for (index, joint) in comparison.joints.iter().enumerate() {
        let level = kind.of(&comparison.estimate(index), element).0;
        plot = plot.horizontal(format!("{}, estimate", joint.name), Role::Trace(index), level);
    }
    let names: Vec<&str> = comparison.joints.iter().map(|joint| joint.name.as_str()).collect();
    let caption = format!("{symbol} of {}.", names.join(", "));
    plot.y_range(range(comparison, kind, element)).masked(0).caption(caption)
}

/// What is drawn at first: the estimates and the middle of the lines in the joints' averaging bands, which poles and noise would squash.
fn range(comparison: &Comparison, kind: Kind, element: (usize, usize)) -> YRange {
    let of_joint = |(index, joint): (usize, &Decomposed)| {
        let inside = joint.lines.iter().filter(|l| (joint.band.0..=joint.band.1).contains(&l.frequency));
        let values = inside.map(|line| at(kind, &line.stiffness, &line.damping, element));
        let level = kind.of(&comparison.estimate(index), element).0;
        Span::percentiles(values, YRange::ROBUST).and(Span::of([level]))
    };
    let span = comparison.joints.iter().enumerate().map(of_joint).fold(Span::default(), Span::and);
    YRange::about(span, (0.4 * span.width()).max(0.02 * span.magnitude()))
}

/// A probability as a percentage that never claims to be certain of what was found by drawing.
fn sure(probability: f64) -> String {
    if probability > 0.999 { "> 99.9 %".to_owned() } else { percent(probability, 1) }
}
