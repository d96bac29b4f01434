//! FRFs: measured, and rebuilt from the modes.

use jointscope_modes::ModalAnalysis;

use crate::plot::{Curve, FrfPanes, Role, Style, worst};
use crate::section::Section;

/// FRFs and shapes that are shown at the most; the page says how many there are.
pub(super) const SHOWN: usize = 12;

pub(super) fn section(analysis: &ModalAnalysis) -> Section {
    let errors = analysis.relative_errors();
    let shown = worst(&errors, SHOWN);
    let some = if shown.len() < errors.len() {
        format!(" Shown are the {} of {} that are met worst.", shown.len(), errors.len())
    } else {
        String::new()
    };
    let section = Section::new("FRFs").paragraph(format!(
        "Accelerances as measured with the 95 % band of their noise, and rebuilt from modes and residual terms.{some}"
    ));
    shown.into_iter().fold(section, |section, frf| {
        let values = analysis.rebuilt(frf).iter().map(|value| Some(*value)).collect();
        let rebuilt = Curve { label: "rebuilt", role: Role::Highlight, style: Style::Dashed, values };
        let panes = FrfPanes::recorded(analysis.measured(), frf, vec![rebuilt]);
        section.plots(2, panes.all())
    })
}
