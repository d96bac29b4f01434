//! FRFs: measured, and rebuilt from the modes.

use jointscope_modes::ModalAnalysis;

use super::SHOWN;
use crate::plot::{Curve, FrfPanes, Role, Style};
use crate::section::Section;

pub(super) fn section(analysis: &ModalAnalysis) -> Section {
    let errors = analysis.relative_errors();
    let mut shown: Vec<usize> = (0..errors.len()).collect();
    shown.sort_by(|a, b| errors[*b].total_cmp(&errors[*a]));
    shown.truncate(SHOWN);
    shown.sort_unstable();
    let some = if shown.len() < errors.len() {
        format!(" Shown are the {} of {} that are met worst.", shown.len(), errors.len())
    } else {
        String::new()
    };
    let section = Section::new("FRFs").paragraph(format!(
        "Accelerances as measured with the 95 % band of their noise, and rebuilt from modes and residual terms.{some}"
    ));
    shown.into_iter().fold(section, |section, frf| {
        let panes = panes(analysis, frf);
        section.plots(2, [panes.magnitude(), panes.phase()].into_iter().chain(panes.residuals()))
    })
}

fn panes(analysis: &ModalAnalysis, frf: usize) -> FrfPanes<'_> {
    let (measured, name) = (analysis.measured(), analysis.pairs()[frf].to_string());
    // Each part of a value has half its variance, and the modulus takes one part of the noise.
    let half = |variance: &f64| Some(1.96 * (0.5 * variance).sqrt());
    let values = analysis.rebuilt(frf).iter().map(|value| Some(*value)).collect();
    FrfPanes {
        title: format!("FRF {name}"),
        phase_title: format!("Phase of FRF {name}"),
        symbol: format!("H {name}"),
        unit: "(m/s^2)/N",
        hz: analysis.lines().hz(),
        measured: measured.values(frf).iter().map(|value| Some(*value)).collect(),
        noise: measured.variance(frf).unwrap_or_default().iter().map(half).collect(),
        curves: vec![Curve { label: "rebuilt", role: Role::Highlight, style: Style::Dashed, values }],
    }
}
