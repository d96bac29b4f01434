//! What was left out, what was remarked, and how hard the lines are to decompose.

use super::Subject;
use super::by_line::LINE_LIMIT;
use super::verdict::plain;
use crate::{Axis, Column, PageContext, Plot, Role, Section, Table, YRange};

pub(super) fn section(subject: &Subject, context: &PageContext) -> Section {
    let analysis = subject.analysis;
    let (masked, all) = (analysis.spectrum.masked.len(), analysis.spectrum.h41.lines.len());
    let mut section = Section::new("Left out");
    if masked == 0 {
        section = section.paragraph(format!("No line was masked: all {all} were solved."));
    } else {
        section = section
            .paragraph(format!(
                "{masked} of {all} lines {} masked.",
                if masked == 1 { "was" } else { "were" }
            ))
            .table(masked_table(subject));
    }
    section = section.notes(remarks(subject, context));
    section.plot(condition(subject))
}

fn masked_table(subject: &Subject) -> Table {
    let spectrum = &subject.analysis.spectrum;
    let hz = spectrum.h41.lines.hz();
    let columns = [Column::text("Why masked"), Column::numbers("Lines", ""), Column::text("Where")];
    let mut table = Table::new(columns);
    for (reason, count) in spectrum.masked_summary() {
        let lines: Vec<usize> =
            spectrum.masked.iter().filter(|(_, r)| *r == reason).map(|(line, _)| *line).collect();
        table = table.row([reason.why().to_owned(), count.to_string(), ranges(&lines, hz)]);
    }
    table
}

/// Runs of neighbouring lines, the first few in full: `0 Hz, 410 to 415 Hz and 3 more places`.
fn ranges(lines: &[usize], hz: &[f64]) -> String {
    const SHOWN: usize = 5;
    let runs: Vec<&[usize]> = lines.chunk_by(|a, b| a + 1 == *b).collect();
    let at = |line: &usize| hz.get(*line).copied().map_or_else(String::new, plain);
    let mut text: Vec<String> = runs
        .iter()
        .take(SHOWN)
        .map(|run| match run {
            [only] => format!("{} Hz", at(only)),
            [first, .., last] => format!("{} to {} Hz", at(first), at(last)),
            [] => String::new(),
        })
        .collect();
    if runs.len() > SHOWN {
        text.push(format!("{} more places", runs.len() - SHOWN));
    }
    text.join(", ")
}

fn remarks(subject: &Subject, context: &PageContext) -> Vec<String> {
    let mut remarks = Vec::new();
    let unused: Vec<String> = subject.analysis.plan.unused.iter().map(ToString::to_string).collect();
    if !unused.is_empty() {
        let noun = if unused.len() == 1 { "FRF does" } else { "FRFs do" };
        remarks.push(format!(
            "{} {noun} not cross the joint between the two blocks and {} not used: {}.",
            unused.len(),
            if unused.len() == 1 { "is" } else { "are" },
            unused.join(", ")
        ));
    }
    remarks.extend(context.notes.iter().cloned());
    remarks
}

fn condition(subject: &Subject) -> Plot {
    let spectrum = &subject.analysis.spectrum;
    let mut values = vec![None; spectrum.h41.lines.len()];
    for line in &spectrum.solved {
        values[line.line] = Some(line.condition);
    }
    let band = subject.analysis.averages.band;
    Plot::new("Condition", Axis::frequency(), Axis::logarithmic("Condition number", ""))
        .over(spectrum.h41.lines.hz())
        .line("worst element", Role::Measured, &values)
        .shaded("averaging band", band.from, band.to)
        .y_range(decades(&values))
        .height(180)
        .line_limit(LINE_LIMIT)
        .caption(
            "By how much relative errors of the FRFs and of the blocks' compliances are multiplied in the worst element of K, at \
             the most: where it is large, the blocks' own motion hides the joint.",
        )
}

/// Whole decades about the values, so that the axis is labelled with powers of ten.
fn decades(values: &[Option<f64>]) -> YRange {
    let logarithms = values.iter().flatten().filter(|v| v.is_finite() && **v > 0.0).map(|v| v.log10());
    let (low, high) =
        logarithms.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if low > high {
        return YRange::Full;
    }
    YRange::Fixed { low: 10f64.powf(low.floor()), high: 10f64.powf(high.ceil().max(low.floor() + 1.0)) }
}
