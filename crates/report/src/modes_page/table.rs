//! The modes in numbers.

use jointscope_modes::ModalAnalysis;

use crate::format::{QuantityText, fixed, quantity, significant};
use crate::{Column, HeatMap, Section, Table};

pub(super) fn modes(analysis: &ModalAnalysis) -> Section {
    let columns = [
        Column::text("Mode"),
        Column::numbers("Natural frequency", "Hz"),
        Column::numbers("Damping ratio", "%"),
        Column::numbers("Drift among FRFs", "mHz"),
        Column::numbers("Phase collinearity", ""),
        Column::numbers("Modal mass", "kg"),
    ];
    let mut table = Table::new(columns);
    for (index, mode) in analysis.modes.iter().enumerate() {
        let number = |value: f64, std: f64| QuantityText::new(value, std, "").number;
        table = table.row([
            (index + 1).to_string(),
            number(mode.frequency, mode.frequency_std),
            number(100.0 * mode.damping_ratio, 100.0 * mode.damping_std),
            mode.drift.as_ref().map_or("–".to_owned(), |d| significant(1e3 * d.frequency, 2)),
            fixed(mode.phase_collinearity, 3),
            mode.modal_mass.map_or("–".to_owned(), |mass| significant(mass, 3)),
        ]);
    }
    let table = table.footnote(
        "±: one standard deviation, of the noise of the FRFs and of what the modes do not explain; for a mode that drifts, the scatter of one more FRF. Phase collinearity is 1 where all \
         residues are in phase or in opposition. Modal mass is for a shape whose largest entry is 1, told by driving points only.",
    );
    let outside: Vec<String> =
        analysis.outside.iter().map(|mode| quantity(mode.frequency, mode.frequency_std, "Hz")).collect();
    let section = Section::new("Modes").table(table);
    if outside.is_empty() {
        return section;
    }
    section.notes([format!(
        "fitted besides, outside of the band, for what they do inside it: {}",
        outside.join(", ")
    )])
}

pub(super) fn auto_mac(analysis: &ModalAnalysis) -> Section {
    let heads =
        |index: usize| format!("{} · {} Hz", index + 1, significant(analysis.modes[index].frequency, 4));
    let count = analysis.modes.len();
    let mac = analysis.auto_mac();
    let mut map = HeatMap::new("MAC, %", (0..count).map(heads));
    for row in 0..count {
        map = map.row(heads(row), (0..count).map(|column| Some(100.0 * mac[row * count + column])));
    }
    Section::new("Auto-MAC")
        .paragraph(
            "How alike the residues of every two modes are over the FRFs: 100 % on the diagonal. Two modes with much in common off it are not told apart by these channels.",
        )
        .heat_map(map)
}

pub(super) fn residuals(analysis: &ModalAnalysis) -> Section {
    let errors = analysis.relative_errors();
    let columns = [
        Column::text("FRF"),
        Column::numbers("Relative error, rebuilt", "%"),
        Column::numbers("Lower residual", "1/kg"),
        Column::numbers("Upper residual", "m/N"),
    ];
    let mut table = Table::new(columns);
    for ((pair, error), terms) in analysis.pairs().iter().zip(errors).zip(&analysis.residual_terms) {
        let real = |terms: &[num_complex::Complex64]| {
            terms.first().map_or("–".to_owned(), |term| quantity(term.re, None, ""))
        };
        table = table.row([
            pair.to_string(),
            significant(100.0 * error, 2),
            real(&terms.lower),
            real(&terms.upper),
        ]);
    }
    let (lower, upper) =
        analysis.residual_terms.first().map_or((0, 0), |terms| (terms.lower.len(), terms.upper.len()));
    Section::new("Residual terms").table(table.footnote(format!(
        "Receptance beyond the modes: lower/s² + upper, real parts. In use are {lower} term{} in 1/s², 1/s⁴, … and {upper} in 1, s², …, as many as χ² pays for; χ² per degree of \
         freedom is {}. Relative error: √(Σ|rebuilt − measured|²/Σ|measured|²), as accelerance.",
        if lower == 1 { "" } else { "s" },
        significant(analysis.chi2_per_dof, 4)
    )))
}
