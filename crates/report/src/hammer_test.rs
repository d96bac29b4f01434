//! The hits behind the FRFs: force over time, its spectrum, coherence, and which hits were rejected and why.

use jointscope_estimation::{Excitation, Fault, HitReport};
use jointscope_hits::Hit;
use jointscope_pipeline::HammerTest;
use jointscope_spectra::Channel;
use jointscope_wording::Says;

use crate::format::{fixed, significant};
use crate::plot::{Axis, Plot, Role, Style, YRange};
use crate::section::{Block, Section};
use crate::table::Table;
use crate::tone::Tone;

/// Hits drawn at one struck point at the most, and struck points.
const SHOWN: usize = 12;
/// Widths of the pulse drawn before and after it.
const BEFORE: f64 = 3.0;
const AFTER: f64 = 10.0;

pub(crate) fn section(test: &HammerTest) -> Section {
    let estimate = &test.estimate;
    let used = estimate.hits.iter().filter(|hit| hit.used).count();
    let mut points: Vec<&Channel> = Vec::new();
    for hit in &estimate.hits {
        if !points.contains(&&hit.struck) {
            points.push(&hit.struck);
        }
    }
    let names: Vec<String> = points.iter().map(|point| point.to_string()).collect();
    let mut section = Section::new("Hits")
        .paragraph(format!(
            "{} of {} hits are used, at {}. The FRFs below are averages over them.",
            used,
            estimate.hits.len(),
            names.join(", ")
        ))
        .with(table(&estimate.hits));
    for point in points.iter().take(SHOWN) {
        let excitation = estimate.excitations.iter().find(|e| e.struck == **point);
        let mut plots = vec![force(test, point)];
        plots.extend(excitation.map(|e| spectrum(test, e)));
        plots.extend(excitation.and_then(|e| coherence(test, e)));
        section = section.plots(plots.len().min(3), plots);
    }
    if points.len() > SHOWN {
        section =
            section.paragraph(format!("The first {SHOWN} of {} struck points are drawn.", points.len()));
    }
    section.notes(estimate.remarks.iter().map(Says::says))
}

fn table(hits: &[HitReport]) -> impl Into<Block> {
    Table::of(hits)
        .words("Hit", |hit| hit.number.to_string())
        .words("Struck", |hit| hit.struck.to_string())
        .numbers("Peak force", "N", |hit| significant(hit.peak_force, 4))
        .numbers("Contact", "ms", |hit| fixed(1e3 * hit.width, 2))
        .words("Used", |hit| match (hit.used, hit.why()) {
            (true, None) => "yes".to_owned(),
            (true, Some(why)) => format!("yes, though: {why}"),
            (false, why) => format!("no: {}", why.unwrap_or_default()),
        })
        .marked(|hit| (!hit.used || hit.why().is_some()).then_some(Tone::Attention))
        .footnote("Contact: the time for which the force is above a twentieth of its peak.")
}

/// Force over time at one struck point, peaks upon each other.
fn force(test: &HammerTest, struck: &Channel) -> Plot {
    let (time, force) = (Axis::linear("Time after the peak", "ms"), Axis::linear("Force", "N"));
    let mut plot = Plot::new(format!("Force at {struck}"), time, force).alone();
    let all: Vec<(&Hit, &HitReport)> =
        test.hits.iter().zip(&test.estimate.hits).filter(|(hit, _)| hit.struck() == struck).collect();
    // Rejected hits are what the reader must see.
    let shown = all.iter().filter(|(_, r)| !r.used).chain(all.iter().filter(|(_, r)| r.used)).take(SHOWN);
    let width = all.iter().map(|(_, report)| report.width).fold(0.0, f64::max);
    for (index, (hit, report)) in shown.enumerate() {
        let (times, values) = about_the_peak(hit, report, width);
        let (style, role, rejected) = match report.used {
            true => (Style::Line, Role::Trace(index), ""),
            false => (Style::Dashed, Role::Highlight, ", rejected"),
        };
        plot = plot.over(times).series(style, format!("hit {}{rejected}", hit.number()), role, values);
    }
    plot.caption(match all.len() {
        count if count > SHOWN => format!("{SHOWN} of {count} hits, rejected ones first and dashed."),
        _ => "All hits, rejected ones dashed.".to_owned(),
    })
}

/// Times in ms about the hit's peak, as far as the pulse and a second strike reach, and the force then.
fn about_the_peak(hit: &Hit, report: &HitReport, width: f64) -> (Vec<f64>, Vec<f64>) {
    let force = hit.force();
    let peak = (0..force.len()).fold(0, |best, i| if force[i].abs() > force[best].abs() { i } else { best });
    let second = report.faults.iter().map(|fault| match fault {
        Fault::DoubleHit { after, .. } => 1.3 * after,
        _ => 0.0,
    });
    let second = second.fold(0.0, f64::max);
    let samples = |seconds: f64| (seconds / hit.interval()).ceil() as usize;
    let from = peak.saturating_sub(samples((BEFORE * width).max(second)));
    let to = (peak + samples((AFTER * width).max(second)) + 1).min(force.len());
    let time = |i: usize| 1e3 * hit.interval() * (i as f64 - peak as f64);
    ((from..to).map(time).collect(), force[from..to].to_vec())
}

fn spectrum(test: &HammerTest, excitation: &Excitation) -> Plot {
    let hz = &test.estimate.frfs.lines().hz()[1..];
    let title = format!("Spectrum of the force at {}", excitation.struck);
    Plot::new(title, Axis::frequency(), Axis::logarithmic("|F|", "N*s"))
        .over(hz)
        .line("force, root mean square", Role::Measured, &excitation.spectrum[1..])
        .horizontal("its noise", Role::Reference, excitation.noise)
        .shaded("lines in use", hz[0], excitation.usable_to)
        .alone()
        .caption(format!(
            "The hammer excites up to {} Hz; the force's noise makes H1 by the textbook read low by {} % at the most.",
            fixed(excitation.usable_to, 0),
            significant(100.0 * excitation.h1_bias, 2)
        ))
}

/// Coherence of the responses to one struck point; `None` of a single hit.
fn coherence(test: &HammerTest, excitation: &Excitation) -> Option<Plot> {
    let frfs = &test.estimate.frfs;
    let hz = &frfs.lines().hz()[1..];
    let last = hz.iter().rposition(|hz| *hz <= excitation.usable_to).unwrap_or(0);
    let title = format!("Coherence of the responses to {}", excitation.struck);
    let plot = Plot::new(title, Axis::frequency(), Axis::linear("γ²", "")).over(&hz[..=last]);
    let pairs = frfs.pairs().iter().enumerate().filter(|(_, pair)| pair.reference == excitation.struck);
    let measured: Vec<_> =
        pairs.filter_map(|(index, pair)| Some((pair.to_string(), frfs.coherence(index)?))).collect();
    let hits = excitation.hits.len();
    (!measured.is_empty()).then(|| {
        let traces = measured.into_iter().take(SHOWN).enumerate();
        traces
            .fold(plot, |plot, (trace, (name, coherence))| {
                plot.line(name, Role::Trace(trace), &coherence[1..=last + 1])
            })
            .y_range(YRange::Fixed { low: 0.0, high: 1.02 })
            .alone()
            .caption(format!("Coherence of {hits} hits on the lines in use; below 1 the hits disagree."))
    })
}
