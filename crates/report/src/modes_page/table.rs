//! The modes in numbers.

use jointscope_modes::ModalAnalysis;
use jointscope_wording::counted;

use crate::format::{QuantityText, fixed, quantity, significant};
use crate::section::Section;
use crate::table::{Cell, Table};

pub(super) fn modes(analysis: &ModalAnalysis) -> Section {
    let number = |value: f64, std: f64| QuantityText::new(value, std, "").number;
    let or_dash = |text: Option<String>| text.unwrap_or_else(|| "–".to_owned());
    let table = Table::of(analysis.modes.iter().enumerate())
        .words("Mode", |(index, _)| (index + 1).to_string())
        .numbers("Natural frequency", "Hz", |(_, m)| number(m.frequency, m.frequency_std))
        .numbers("Damping ratio", "%", |(_, m)| number(100.0 * m.damping_ratio, 100.0 * m.damping_std))
        .numbers("Drift among FRFs", "mHz", |(_, m)| {
            or_dash(m.drift.as_ref().map(|drift| significant(1e3 * drift.frequency, 2)))
        })
        .numbers("Phase collinearity", "", |(_, m)| fixed(m.phase_collinearity, 3))
        .numbers("Modal mass", "kg", |(_, m)| or_dash(m.modal_mass.map(|mass| significant(mass, 3))))
        .footnote(
            "±: one standard deviation, of the noise of the FRFs and of what the modes do not explain; for a mode that drifts, the scatter of one more FRF. Phase collinearity is 1 where all \
             residues are in phase or in opposition. Modal mass is for a shape whose largest entry is 1, told by driving points only.",
        );
    let outside: Vec<String> =
        analysis.outside.iter().map(|mode| quantity(mode.frequency, mode.frequency_std, "Hz")).collect();
    let section = Section::new("Modes").with(table);
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
    let map = (0..count).fold(Table::of(0..count).names("MAC, %", |row| heads(*row)), |map, column| {
        map.shaded(heads(column), |row| Cell::share(mac[row * count + column]))
    });
    Section::new("Auto-MAC")
        .paragraph(
            "How alike the residues of every two modes are over the FRFs: 100 % on the diagonal. Two modes with much in common off it are not told apart by these channels.",
        )
        .with(map)
}

pub(super) fn residuals(analysis: &ModalAnalysis) -> Section {
    let real = |terms: &[num_complex::Complex64]| {
        terms.first().map_or("–".to_owned(), |term| quantity(term.re, None, ""))
    };
    let frfs = analysis.pairs().iter().zip(analysis.relative_errors()).zip(&analysis.residual_terms);
    let table = Table::of(frfs)
        .words("FRF", |((pair, _), _)| pair.to_string())
        .numbers("Relative error, rebuilt", "%", |((_, error), _)| significant(100.0 * error, 2))
        .numbers("Lower residual", "1/kg", |(_, terms)| real(&terms.lower))
        .numbers("Upper residual", "m/N", |(_, terms)| real(&terms.upper));
    let (lower, upper) =
        analysis.residual_terms.first().map_or((0, 0), |terms| (terms.lower.len(), terms.upper.len()));
    Section::new("Residual terms").with(table.footnote(format!(
        "Receptance beyond the modes: lower/s² + upper, real parts. In use are {} in 1/s², 1/s⁴, … and {upper} in 1, s², …, as many as χ² pays for; χ² per degree of \
         freedom is {}. Relative error: √(Σ|rebuilt − measured|²/Σ|measured|²), as accelerance.",
        counted(lower, "term"),
        significant(analysis.chi2_per_dof, 4)
    )))
}
