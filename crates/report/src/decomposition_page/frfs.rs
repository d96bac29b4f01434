//! The FRFs behind the joint: H41 of the blocks, coherence and noise of each recorded FRF.

use jointscope_decomposition::MatrixElement;
use jointscope_linalg::ComplexMatrix2;
use jointscope_spectra::FrfSet;
use num_complex::Complex64;

use super::subject::Subject;
use crate::plot::{Axis, Curve, FrfPanes, Plot, Role, Style, Values, YRange, over_unity};
use crate::section::Section;
use jointscope_wording::element::index;

const UNITS: [&str; 4] = ["m/N", "m/(N*m)", "rad/N", "rad/(N*m)"];

pub(super) fn section(subject: &Subject) -> Section {
    let elements = MatrixElement::all(subject.is_scalar());
    let columns = if subject.is_scalar() { 1 } else { 2 };
    let panes: Vec<FrfPanes> = elements.iter().map(|element| panes(subject, *element)).collect();
    let magnitudes = panes.iter().map(|panes| {
        let caption = "Magnitude; where the peaks stand apart, the assembly is not as the fixture says.";
        panes.magnitude().height(200).caption(caption)
    });
    let phases = panes
        .iter()
        .map(|panes| panes.phase().height(180).caption("Phase, in the turn that the curves cross least; a curve that crosses it is followed a little way."));
    let section = Section::new("FRFs")
        .paragraph(introduction(subject))
        .plots(columns, magnitudes)
        .plots(columns, phases);
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

/// H41's element, measured (gaps where lines are masked) and as the fixture predicts it.
fn panes<'a>(subject: &Subject<'a>, element: MatrixElement) -> FrfPanes<'a> {
    let analysis = subject.analysis;
    let (plan, h41) = (&analysis.plan, &analysis.spectrum.h41);
    let motion = if element.row == 0 { "y" } else { "θ" };
    let load = if element.column == 0 { "F" } else { "M" };
    let symbol = format!("H{}", index(element));
    let at = |h: &ComplexMatrix2| Some(h.at(element.row, element.column));
    let mut measured: Vec<Option<Complex64>> = h41.values.iter().map(at).collect();
    for (line, _) in &analysis.spectrum.masked {
        measured[*line] = None;
    }
    let values = analysis.nominal.iter().map(|line| line.as_ref().and_then(|(h41, _)| at(h41))).collect();
    FrfPanes {
        title: format!("{symbol}: {motion} at {} per {load} at {}", plan.responding.2, plan.loaded.2),
        phase_title: format!("Phase of {symbol}"),
        symbol,
        unit: UNITS[2 * element.row + element.column],
        hz: h41.lines.hz(),
        measured,
        noise: Vec::new(),
        coherence: None,
        curves: vec![Curve { label: "nominal", role: Role::Nominal, style: Style::Dashed, values }],
    }
}

/// A curve of each FRF in use that has one.
fn of_each<T: Values>(subject: &Subject, plot: Plot, curve: impl Fn(usize) -> Option<T>) -> Option<Plot> {
    let frfs = &subject.analysis.frfs;
    let used = subject.analysis.plan.layout.channels.iter().map(|(index, ..)| *index);
    let named = used.filter_map(|index| Some((frfs.pairs().get(index)?.to_string(), curve(index)?)));
    let curves: Vec<(String, T)> = named.collect();
    let plot = plot.height(200).over(frfs.lines().hz());
    (!curves.is_empty()).then(|| {
        curves
            .into_iter()
            .enumerate()
            .fold(plot, |plot, (trace, (name, values))| plot.line(name, Role::Trace(trace), values))
    })
}

fn coherence(subject: &Subject) -> Option<Plot> {
    let plot = over_unity("Coherence", "γ²")
        .caption("Coherence of each FRF in use, as recorded; it falls where the response is small or noisy. A line where it is 0 is not used.");
    of_each(subject, plot, |index| subject.analysis.frfs.coherence(index))
}

fn noise(subject: &Subject) -> Option<Plot> {
    let plot = Plot::new("Noise to signal", Axis::frequency(), Axis::logarithmic("σ/|H|", ""))
        .y_range(YRange::Robust)
        .caption("Standard deviation of each FRF in use over its magnitude: 10⁻² is one per cent noise.");
    of_each(subject, plot, |index| noise_to_signal(&subject.analysis.frfs, index))
}

fn noise_to_signal(frfs: &FrfSet, index: usize) -> Option<Vec<Option<f64>>> {
    let values = frfs.values(index).iter();
    let ratio = |(value, variance): (&Complex64, &f64)| {
        let size = value.norm();
        (size > 0.0 && *variance > 0.0).then(|| variance.sqrt() / size)
    };
    Some(values.zip(frfs.variance(index)?).map(ratio).collect())
}
