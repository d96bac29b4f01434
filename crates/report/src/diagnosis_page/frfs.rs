//! The FRFs: measured with their noise, and what the models make of them.

use jointscope_spectra::Dof;

use super::{SHOWN, Subject};
use crate::plot::{Curve, FrfPanes, Role, Style, YRange};
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
        let magnitude = panes
            .magnitude()
            .y_range(YRange::decades(panes.measured.iter().flatten().map(|v| v.norm())))
            .caption(match subject.diagnosis.model_error {
                Some(_) => {
                    "Magnitude; a model leaves the noise band by its error as well as by what it leaves out."
                }
                None => "Magnitude; where a model leaves the noise band, it leaves something out.",
            });
        let phase = panes.phase().caption("Phase, in the turn that the curves cross least.");
        section = section.plots(2, [magnitude, phase]);
    }
    section
}

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
fn models(subject: &Subject, index: usize) -> Vec<Curve> {
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
    let half = |weight: &f64| (*weight > 0.0).then(|| 1.96 / weight.sqrt());
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
        curves,
    }
}
