//! The FRFs: measured with their noise, and what the models make of them.

use jointscope_inference::Z95;
use std::cmp::Ordering;

use jointscope_spectra::Dof;

use super::subject::Subject;
use crate::format::{plain, significant};
use crate::plot::{Curve, FrfPanes, Plot, Role, Style};
use crate::section::Section;

pub(super) fn section(subject: &Subject) -> Section {
    let (shown, some) = (shown(subject), shown_of(subject));
    let names: Vec<&str> = subject.models().iter().map(|(name, _)| *name).collect();
    let mut section = Section::new("FRFs").paragraph(format!(
        "Accelerances as measured, with the 95 % band of their noise, and as the models predict them: {}.{some}",
        names.join(", ")
    ));
    for index in shown {
        let panes = panes(subject, index, models(subject, index));
        let magnitude = panes.magnitude().caption(judged(subject, index));
        let phase = panes.phase().caption("Phase, in the turn that the curves cross least; a curve that crosses it is followed a little way.");
        section = section
            .plots(2, with_held_out(subject, index, [magnitude, phase].into_iter().chain(panes.below())));
    }
    section
}

/// What the models leave of an FRF, and where most of it sits.
pub(super) fn judged(subject: &Subject, index: usize) -> String {
    let diagnosis = subject.diagnosis;
    let models = subject.models().into_iter().skip(1).filter_map(|(name, fit)| {
        let misfit = diagnosis.misfit(fit).swap_remove(index);
        Some((name, significant(misfit.whole?, 3), misfit))
    });
    let models: Vec<_> = models.collect();
    let chi2: Vec<String> = models.iter().map(|(name, chi2, _)| format!("{name} {chi2}")).collect();
    let worst = models.last().and_then(|(_, _, misfit)| {
        let bands = misfit.bands.iter().filter(|band| band.chi2_per_dof.is_some());
        bands.max_by(|a, b| a.chi2_per_dof.partial_cmp(&b.chi2_per_dof).unwrap_or(Ordering::Equal))
    });
    let most = worst.map_or_else(String::new, |band| {
        format!(", most from {} to {} Hz", plain(band.from, 4), plain(band.to, 4))
    });
    let own = if diagnosis.model_error.is_some() { ", the model's own error in it" } else { "" };
    format!("Magnitude. χ² per value (1 is noise{own}): {}{most}.", chi2.join(", "))
}

/// The plots of an FRF with what no fit of the held-out judgement saw shaded; the first one's legend tells
/// it.
pub(super) fn with_held_out(subject: &Subject, index: usize, plots: impl Iterator<Item = Plot>) -> Vec<Plot> {
    let label = |at: usize| if at == 0 { "held out" } else { "" };
    plots.enumerate().map(|(at, plot)| held_out(subject, index, plot, label(at))).collect()
}

fn held_out(subject: &Subject, index: usize, plot: Plot, label: &str) -> Plot {
    let observation = &subject.diagnosis.observation;
    let (hz, pair) = (observation.lines().hz(), format!("frf {}", observation.pairs()[index]));
    let held_out = subject.diagnosis.held_out.iter().flat_map(|held_out| &held_out.what);
    held_out.fold(plot, |plot, what| {
        let ends = what.strip_prefix("band ").and_then(|band| band.split_once(':'));
        match ends.map(|(from, to)| (from.parse(), to.parse())) {
            Some((Ok(from), Ok(to))) => plot.shaded(label, from, to),
            _ if *what == pair => plot.shaded(label, hz[0], hz[hz.len() - 1]),
            _ => plot,
        }
    })
}

/// FRFs that are shown at the most; the page says how many there are.
const SHOWN: usize = 16;

/// Indices of the FRFs to show: all, or those with the largest misfit, in the order of the recording.
pub(super) fn shown(subject: &Subject) -> Vec<usize> {
    let misfit = subject.diagnosis.misfit(&subject.diagnosis.search.refitted);
    let mut order: Vec<usize> = (0..misfit.len()).collect();
    let size = |index: usize| misfit[index].whole.unwrap_or(0.0);
    order.sort_by(|a, b| size(*b).total_cmp(&size(*a)));
    order.truncate(SHOWN);
    order.sort_unstable();
    order
}

/// Which FRFs are shown, where that is not all.
pub(super) fn shown_of(subject: &Subject) -> String {
    let all = subject.diagnosis.observation.pairs().len();
    if all <= SHOWN {
        return String::new();
    }
    format!(" Shown are the {SHOWN} of {all} FRFs that the refitted fixture explains worst.")
}

/// Colour and line of a model.
fn look(model: &str) -> (Role, Style) {
    match model {
        "nominal" => (Role::Nominal, Style::Dashed),
        "refitted" => (Role::Reference, Style::Dashed),
        _ => (Role::Highlight, Style::Line),
    }
}

/// What the models make of an FRF.
pub(super) fn models(subject: &Subject, index: usize) -> Vec<Curve> {
    let n = subject.diagnosis.observation.lines().len();
    let curve = |(label, fit): (&'static str, &jointscope_diagnosis::Fit)| {
        let (role, style) = look(label);
        let values = fit.predicted[index * n..(index + 1) * n].iter().map(|v| Some(*v)).collect();
        Curve { label, role, style, values }
    };
    subject.models().into_iter().map(curve).collect()
}

/// An FRF as measured, with other curves beside it.
pub(super) fn panes<'a>(subject: &Subject<'a>, index: usize, curves: Vec<Curve>) -> FrfPanes<'a> {
    let observation = &subject.diagnosis.observation;
    let (pair, n) = (&observation.pairs()[index], observation.lines().len());
    let lines = index * n..(index + 1) * n;
    // Each part of a value has half its variance, and the modulus takes one part of the noise.
    let half = |weight: &f64| (*weight > 0.0).then(|| Z95 / weight.sqrt());
    FrfPanes {
        title: format!("FRF {pair}"),
        phase_title: format!("Phase of FRF {pair}"),
        symbol: format!("H {pair}"),
        unit: match (pair.response.dof, pair.reference.dof) {
            (Dof::Translation, Dof::Translation) => "(m/s^2)/N",
            (Dof::Translation, Dof::Rotation) => "(m/s^2)/(N*m)",
            (Dof::Rotation, Dof::Translation) => "(rad/s^2)/N",
            (Dof::Rotation, Dof::Rotation) => "(rad/s^2)/(N*m)",
        },
        hz: observation.lines().hz(),
        measured: observation.values()[lines.clone()].iter().map(|v| Some(*v)).collect(),
        noise: observation.weights()[lines.clone()].iter().map(half).collect(),
        coherence: observation.coherence(index),
        curves,
    }
}
