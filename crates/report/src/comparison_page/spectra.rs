//! The spectra of all joints in common plots: K and C (Figures 5–9), and the assemblies' H41 (Figure 4).

use jointscope_comparison::{Comparison, Decomposed, Kind, Line, Matrix, Source};
use jointscope_inference::Z95;
use jointscope_wording::models::source;

use super::elements::{DIGITS, elements, name_of};
use crate::plot::{Axis, Plot, Role, Span, Style, YRange};
use crate::section::Section;

/// Units of H41.
const COMPLIANCE: [[&str; 2]; 2] = [["m/N", "1/N"], ["rad/N", "rad/(N*m)"]];

/// How a joint's lines are drawn, so that models are told from measurements without colours (Figures 4–9).
fn style(joint: &Decomposed) -> Style {
    match joint.source {
        Some(Source::Simulation) => Style::Dashed,
        Some(Source::FiniteElements) => Style::Dotted,
        Some(Source::Measurement) | None => Style::Line,
    }
}

/// The joints with their places, models last: a line of dots is lost below a measurement's noise, not above
/// it.
fn in_drawing_order(comparison: &Comparison) -> impl Iterator<Item = (usize, &Decomposed)> {
    let all = || comparison.joints.iter().enumerate();
    let is_model = |joint: &Decomposed| joint.source.is_some_and(Source::is_model);
    all().filter(move |(_, joint)| !is_model(joint)).chain(all().filter(move |(_, joint)| is_model(joint)))
}

/// The joint in the legend, with what it is of: `fem (finite elements)`.
fn label(joint: &Decomposed) -> String {
    match joint.source {
        Some(of) => format!("{} ({})", joint.name, source(of)),
        None => joint.name.clone(),
    }
}

/// What the dashes stand for, where there are any.
fn dashes(comparison: &Comparison) -> &'static str {
    match comparison.joints.iter().any(|joint| joint.source.is_some()) {
        true => {
            " Lines of a measurement are full, those of a simulation dashed, those of finite elements dotted."
        }
        false => "",
    }
}

/// |H41| of each assembly; nothing where no file has it.
pub(super) fn compliance_section(comparison: &Comparison) -> Option<Section> {
    let has = |joint: &Decomposed| joint.lines.iter().any(|line| line.h41.is_some());
    if !comparison.joints.iter().any(has) {
        return None;
    }
    let elements = elements(comparison);
    let plots = elements.iter().map(|&(i, j)| {
        let symbol = format!("H41{}{}", DIGITS[i], DIGITS[j]);
        let axis = Axis::logarithmic(format!("|{symbol}|"), COMPLIANCE[i][j]);
        let mut plot = Plot::new(symbol.clone(), Axis::frequency(), axis);
        for (index, joint) in in_drawing_order(comparison) {
            let size = |line: &Line| line.h41.map(|h41| h41[i][j][0].hypot(h41[i][j][1]));
            plot = plot.over(joint.lines.iter().map(|line| line.frequency));
            plot = plot.series(style(joint), label(joint), Role::Trace(index), joint.lines.iter().map(size));
        }
        plot.masked(0).caption(format!("|{symbol}| of the assemblies."))
    });
    let columns = if elements.len() == 1 { 1 } else { 2 };
    Some(
        Section::new("Assemblies")
            .paragraph(format!(
                "Receptance H41 of each assembly: the motion of the far block due to force and moment on the near one, at the reference points of its decomposition.{}",
                dashes(comparison)
            ))
            .plots(columns, plots),
    )
}

/// K or C of all joints by line; nothing where no file has lines.
pub(super) fn spectra_section(comparison: &Comparison, kind: Kind) -> Option<Section> {
    if comparison.joints.iter().all(|joint| joint.lines.is_empty()) {
        return None;
    }
    let word = match kind {
        Kind::Stiffness => "Stiffness by line",
        Kind::Damping => "Damping by line",
    };
    let relation = match comparison.relation.as_str() {
        "paper" => "eq (7), signs included; its peaks are its own",
        _ => "the exact relation",
    };
    let elements = elements(comparison);
    let section = Section::new(word)
        .paragraph(format!(
            "By {relation}. Bands are 95 % intervals from noise alone, horizontal dashes the estimates; gaps are masked lines.{}",
            dashes(comparison)
        ))
        .plots(elements.len().min(2), elements.iter().map(|&element| plot(comparison, kind, element)));
    Some(section)
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
    for (index, joint) in in_drawing_order(comparison) {
        let role = Role::Trace(index);
        plot = plot.over(joint.lines.iter().map(|line| line.frequency));
        let edge = |sign: f64| {
            joint.lines.iter().map(move |line| {
                let (k, c) = line.std?;
                Some(of(&line.stiffness, &line.damping) + sign * Z95 * of(&k, &c))
            })
        };
        if joint.lines.iter().any(|line| line.std.is_some()) {
            plot = plot.band(format!("{}, 95 %", joint.name), role, edge(-1.0), edge(1.0));
        }
        let values = joint.lines.iter().map(|line| of(&line.stiffness, &line.damping));
        plot = plot.series(style(joint), label(joint), role, values);
    }
    for (index, joint) in comparison.joints.iter().enumerate() {
        let level = kind.of(&comparison.estimate(index), element).0;
        plot = plot.horizontal(format!("{}, estimate", joint.name), Role::Trace(index), level);
    }
    if let Some(level) = nominal(comparison, kind, element) {
        plot = plot.horizontal("fixture", Role::Reference, level);
    }
    let names: Vec<&str> = comparison.joints.iter().map(|joint| joint.name.as_str()).collect();
    let caption = format!("{symbol} of {}.", names.join(", "));
    plot.y_range(range(comparison, kind, element)).masked(0).caption(caption)
}

/// What the fixture's own joint has, where all fixtures say the same.
fn nominal(comparison: &Comparison, kind: Kind, (i, j): (usize, usize)) -> Option<f64> {
    let of = |joint: &Decomposed| {
        let nominal = joint.nominal.as_ref()?;
        match kind {
            Kind::Stiffness => nominal.stiffness[i][j],
            Kind::Damping => nominal.damping[i][j],
        }
    };
    let (first, others) = comparison.joints.split_first()?;
    let level = of(first)?;
    let same = |other: f64| (other - level).abs() <= SAME * level.abs();
    others.iter().all(|joint| of(joint).is_some_and(same)).then_some(level)
}

/// Relative difference up to which levels are drawn as one line.
const SAME: f64 = 1e-3;

/// What is drawn at first: the estimates and the middle of the lines in the joints' averaging bands, which
/// poles and noise would squash.
fn range(comparison: &Comparison, kind: Kind, element: (usize, usize)) -> YRange {
    let of_joint = |(index, joint): (usize, &Decomposed)| {
        let (from, to) = joint.average.map_or((0.0, f64::INFINITY), |average| average.band);
        let inside = joint.lines.iter().filter(|line| (from..=to).contains(&line.frequency));
        let values = inside.map(|line| at(kind, &line.stiffness, &line.damping, element));
        let level = kind.of(&comparison.estimate(index), element).0;
        Span::percentiles(values, YRange::ROBUST).and(Span::of([level]))
    };
    let span = comparison.joints.iter().enumerate().map(of_joint).fold(Span::default(), Span::and);
    YRange::about(span, (0.4 * span.width()).max(0.02 * span.magnitude()))
}
