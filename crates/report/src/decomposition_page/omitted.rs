//! What was left out, what was remarked, and how hard the lines are to decompose.

use super::subject::Subject;
use crate::context::PageContext;
use crate::plot::{AVERAGING_BAND, Axis, Plot, Role, YRange};
use crate::section::{Block, Section};
use crate::table::Table;
use jointscope_wording::decomposition::plain;

pub(super) fn section(subject: &Subject, context: &PageContext) -> Section {
    let analysis = subject.analysis;
    let (masked, all) = (analysis.spectrum.masked.len(), analysis.spectrum.h41.lines.len());
    let section = Section::new("Left out");
    let section = match masked {
        0 => section.paragraph(format!("No line was masked: all {all} were solved.")),
        _ => {
            let verb = if masked == 1 { "was" } else { "were" };
            section.paragraph(format!("{masked} of {all} lines {verb} masked.")).with(masked_table(subject))
        }
    };
    section.notes(remarks(subject, context)).plot(condition(subject))
}

fn masked_table(subject: &Subject) -> impl Into<Block> {
    let spectrum = &subject.analysis.spectrum;
    Table::of(spectrum.masked_summary())
        .words("Why masked", |(reason, _)| reason.why())
        .numbers("Lines", "", |(_, count)| count.to_string())
        .words("Where", |(reason, _)| {
            let lines = spectrum.masked.iter().filter(|(_, r)| r == reason).map(|(line, _)| *line);
            ranges(&lines.collect::<Vec<_>>(), spectrum.h41.lines.hz())
        })
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
            "{} {noun} not cross the joint between the two blocks and {} not part of K and C by line: {}.",
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
        .shaded(AVERAGING_BAND, band.from, band.to)
        .y_range(YRange::decades(values.iter().flatten().copied()))
        .height(180)
        .caption(
            "By how much relative errors of the FRFs and of the blocks' compliances are multiplied in the worst element of K, at \
             the most: where it is large, the blocks' own motion hides the joint.",
        )
}
