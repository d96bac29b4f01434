//! The FRFs behind the joint: H41 of the blocks, coherence and noise of each recorded FRF.

use jointscope_spectra::FrfSet;
use num_complex::Complex64;

use super::Subject;
use super::by_line::LINE_LIMIT;
use super::element::Element;
use crate::phase::{degrees, in_the_quietest_turn};
use crate::{Axis, Plot, Role, Section};

const UNITS: [&str; 4] = ["m/N", "m/(N*m)", "rad/N", "rad/(N*m)"];

pub(super) fn section(subject: &Subject) -> Section {
    let elements = Element::all(subject.is_scalar());
    let columns = if subject.is_scalar() { 1 } else { 2 };
    let hz = subject.analysis.spectrum.h41.lines.hz();
    let mut section = Section::new("FRFs").paragraph(introduction(subject));
    section = section.plots(columns, elements.iter().map(|element| magnitude(subject, *element, hz)));
    section = section.plots(columns, elements.iter().map(|element| phase(subject, *element, hz)));
    let quality: Vec<Plot> = [coherence(subject), noise(subject)].into_iter().flatten().collect();
    if quality.is_empty() { section } else { section.plots(quality.len(), quality) }
}

fn introduction(subject: &Subject) -> String {
    let plan = &subject.analysis.plan;
    let (out, input) = (&plan.responding.2, &plan.loaded.2);
    if subject.is_scalar() {
        return format!(
            "Receptance of point {out} per force at point {input}, measured and as the fixture predicts it."
        );
    }
    format!(
        "H41 is the receptance matrix from the loaded block (reference point {input}) to the responding one (reference point \
         {out}), found from all FRFs across the joint together: displacement y and rotation θ per force F and moment M. Dashed: \
         what the fixture as it stands predicts."
    )
}

/// `y at 4 per F at 1`.
fn name(subject: &Subject, element: Element) -> String {
    let plan = &subject.analysis.plan;
    let motion = if element.row == 0 { "y" } else { "θ" };
    let load = if element.column == 0 { "F" } else { "M" };
    format!("H{}: {motion} at {} per {load} at {}", element.index, plan.responding.2, plan.loaded.2)
}

fn measured(subject: &Subject, element: Element) -> Vec<Option<Complex64>> {
    let h41 = &subject.analysis.spectrum.h41;
    let mut values: Vec<Option<Complex64>> =
        h41.values.iter().map(|h| Some(h.at(element.row, element.column))).collect();
    for (line, _) in &subject.analysis.spectrum.masked {
        if let Some(value) = values.get_mut(*line) {
            *value = None;
        }
    }
    values
}

fn nominal(subject: &Subject, element: Element) -> Vec<Option<Complex64>> {
    let nominal = subject.analysis.nominal.iter();
    nominal.map(|line| line.as_ref().map(|(h41, _)| h41.at(element.row, element.column))).collect()
}

fn magnitude(subject: &Subject, element: Element, hz: &[f64]) -> Plot {
    let size = |values: Vec<Option<Complex64>>| values.into_iter().map(|v| v.map(|v| v.norm()));
    let symbol = format!("|H{}|", element.index);
    let axis = Axis::logarithmic(symbol, UNITS[2 * element.row + element.column]);
    Plot::new(name(subject, element), Axis::frequency(), axis)
        .over(hz)
        .line("measured", Role::Measured, size(measured(subject, element)))
        .dashed("nominal", Role::Nominal, size(nominal(subject, element)))
        .height(200)
        .line_limit(LINE_LIMIT)
        .caption("Magnitude; where the peaks stand apart, the assembly is not as the fixture says.")
}

fn phase(subject: &Subject, element: Element, hz: &[f64]) -> Plot {
    let (mut measured, mut nominal) =
        (degrees(measured(subject, element)), degrees(nominal(subject, element)));
    in_the_quietest_turn(&mut [&mut measured, &mut nominal]);
    let axis = Axis::linear(format!("arg H{}", element.index), "°");
    Plot::new(format!("Phase of H{}", element.index), Axis::frequency(), axis)
        .over(hz)
        .line("measured", Role::Measured, measured)
        .dashed("nominal", Role::Nominal, nominal)
        .height(180)
        .line_limit(LINE_LIMIT)
        .caption("Phase, in the turn that the curves cross least.")
}

/// FRFs in use, with their indices.
fn used<'a>(subject: &'a Subject) -> impl Iterator<Item = (usize, String)> + 'a {
    let frfs = &subject.analysis.frfs;
    let channels = subject.analysis.plan.layout.channels.iter();
    channels.filter_map(|(index, ..)| Some((*index, frfs.pairs().get(*index)?.to_string())))
}

fn coherence(subject: &Subject) -> Option<Plot> {
    let frfs = &subject.analysis.frfs;
    let axis = Axis::linear("γ²", "");
    let mut plot = Plot::new("Coherence", Axis::frequency(), axis).over(frfs.lines().hz());
    let mut any = false;
    for (trace, (index, name)) in used(subject).enumerate() {
        if let Some(coherence) = frfs.coherence(index) {
            any = true;
            plot = plot.line(name, Role::Trace(trace), coherence);
        }
    }
    let caption = "Coherence of each FRF in use, as recorded; it falls where the response is small or noisy.";
    any.then(|| plot.height(200).line_limit(LINE_LIMIT).caption(caption))
}

fn noise(subject: &Subject) -> Option<Plot> {
    let frfs = &subject.analysis.frfs;
    let axis = Axis::logarithmic("σ/|H|", "");
    let mut plot = Plot::new("Noise to signal", Axis::frequency(), axis).over(frfs.lines().hz());
    let mut any = false;
    for (trace, (index, name)) in used(subject).enumerate() {
        if let Some(ratio) = noise_to_signal(frfs, index) {
            any = true;
            plot = plot.line(name, Role::Trace(trace), ratio);
        }
    }
    let caption = "Standard deviation of each FRF in use over its magnitude: 10⁻² is one per cent noise.";
    any.then(|| plot.height(200).line_limit(LINE_LIMIT).robust().caption(caption))
}

fn noise_to_signal(frfs: &FrfSet, index: usize) -> Option<Vec<Option<f64>>> {
    let values = frfs.values(index).iter();
    let ratio = |(value, variance): (&Complex64, &f64)| {
        let size = value.norm();
        (size > 0.0 && *variance > 0.0).then(|| variance.sqrt() / size)
    };
    Some(values.zip(frfs.variance(index)?).map(ratio).collect())
}
