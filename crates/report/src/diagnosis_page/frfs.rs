//! The FRFs: measured with their noise, and what the models make of them.

use num_complex::Complex64;

use super::{LINE_LIMIT, SHOWN, Subject};
use crate::phase::{degrees, in_the_quietest_turn};
use crate::{Axis, Plot, Role, Section, YRange};

pub(super) fn section(subject: &Subject) -> Section {
    let observation = &subject.diagnosis.observation;
    let shown = shown(subject);
    let names: Vec<&str> = subject.models().iter().map(|(name, _)| *name).collect();
    let all = observation.pairs().len();
    let some = if shown.len() < all {
        format!(" Shown are the {} of {all} FRFs that the refitted fixture explains worst.", shown.len())
    } else {
        String::new()
    };
    let mut section = Section::new("FRFs").paragraph(format!(
        "Accelerances as measured, with the 95 % band of their noise, and as the models predict them: {}.{some}",
        names.join(", ")
    ));
    for index in shown {
        section = section.plots(2, [magnitude(subject, index), phase(subject, index)]);
    }
    section
}

/// Indices of the FRFs to show: all, or those with the largest misfit, in the order of the recording.
fn shown(subject: &Subject) -> Vec<usize> {
    let misfit = subject.diagnosis.misfit(&subject.diagnosis.search.refitted);
    let mut order: Vec<usize> = (0..misfit.len()).collect();
    let size = |index: usize| misfit[index].whole.unwrap_or(0.0);
    order.sort_by(|a, b| size(*b).total_cmp(&size(*a)));
    order.truncate(SHOWN);
    order.sort_unstable();
    order
}

fn role(model: &str) -> Role {
    match model {
        "nominal" => Role::Nominal,
        "refitted" => Role::Reference,
        _ => Role::Highlight,
    }
}

fn unit(subject: &Subject, index: usize) -> &'static str {
    use jointscope_spectra::Dof;
    let pair = &subject.diagnosis.observation.pairs()[index];
    match (pair.response.dof, pair.reference.dof) {
        (Dof::Translation, Dof::Translation) => "(m/s^2)/N",
        (Dof::Translation, Dof::Rotation) => "(m/s^2)/(N*m)",
        (Dof::Rotation, Dof::Translation) => "(rad/s^2)/N",
        (Dof::Rotation, Dof::Rotation) => "(rad/s^2)/(N*m)",
    }
}

fn magnitude(subject: &Subject, index: usize) -> Plot {
    let observation = &subject.diagnosis.observation;
    let n = observation.lines().len();
    let lines = index * n..(index + 1) * n;
    let measured = &observation.values()[lines.clone()];
    // Each part of a value has half its variance, and the modulus takes one part of the noise.
    let half = |weight: f64| (weight > 0.0).then(|| 1.96 / weight.sqrt());
    let weights = &observation.weights()[lines.clone()];
    let low = measured
        .iter()
        .zip(weights)
        .map(|(v, w)| half(*w).map(|half| (v.norm() - half).max(0.05 * v.norm())));
    let high = measured.iter().zip(weights).map(|(v, w)| half(*w).map(|half| v.norm() + half));
    let name = observation.pairs()[index].to_string();
    let mut plot = Plot::new(
        format!("FRF {name}"),
        Axis::frequency(),
        Axis::logarithmic(format!("|H {name}|"), unit(subject, index)),
    )
    .over(observation.lines().hz())
    .band("noise, 95 %", Role::Uncertainty, low, high)
    .line("measured", Role::Measured, measured.iter().map(|v| v.norm()));
    for (name, fit) in subject.models() {
        let values = fit.predicted[lines.clone()].iter().map(|v| v.norm());
        plot = if name == "repaired" {
            plot.line(name, role(name), values)
        } else {
            plot.dashed(name, role(name), values)
        };
    }
    plot.height(220)
        .y_range(decades(measured))
        .line_limit(LINE_LIMIT)
        .caption("Magnitude; where a model leaves the noise band, it leaves something out.")
}

/// Whole decades about the measured values: a model's sharp antiresonance does not squash them, and the axis is labelled with powers of ten.
fn decades(measured: &[Complex64]) -> YRange {
    let logarithms = measured.iter().map(|v| v.norm().log10()).filter(|v| v.is_finite());
    let (low, high) =
        logarithms.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if low > high {
        return YRange::Full;
    }
    let (low, high) = ((low - 0.1).floor(), (high + 0.1).ceil());
    YRange::Fixed { low: 10f64.powf(low), high: 10f64.powf(high) }
}

fn phase(subject: &Subject, index: usize) -> Plot {
    let observation = &subject.diagnosis.observation;
    let n = observation.lines().len();
    let lines = index * n..(index + 1) * n;
    let of = |values: &[Complex64]| degrees(values[lines.clone()].iter().map(|v| Some(*v)));
    let mut measured = of(observation.values());
    let models = subject.models();
    let mut curves: Vec<Vec<Option<f64>>> = models.iter().map(|(_, fit)| of(&fit.predicted)).collect();
    let mut all: Vec<&mut Vec<Option<f64>>> = std::iter::once(&mut measured).chain(&mut curves).collect();
    in_the_quietest_turn(&mut all);
    let name = observation.pairs()[index].to_string();
    let mut plot = Plot::new(
        format!("Phase of FRF {name}"),
        Axis::frequency(),
        Axis::linear(format!("arg H {name}"), "°"),
    )
    .over(observation.lines().hz())
    .line("measured", Role::Measured, measured);
    for ((name, _), values) in models.into_iter().zip(curves) {
        plot = if name == "repaired" {
            plot.line(name, role(name), values)
        } else {
            plot.dashed(name, role(name), values)
        };
    }
    plot.height(220).line_limit(LINE_LIMIT).caption("Phase, in the turn that the curves cross least.")
}
