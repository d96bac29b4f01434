//! Maps of the misfit: by FRF and band, by place and band.

use jointscope_diagnosis::{BandMisfit, Fit};
use jointscope_wording::Says;

use super::subject::Subject;
use crate::format::plain;
use crate::section::Section;
use crate::table::{Cell, Table};

/// Places that are shown at the most; the page says how many there are.
const SHOWN: usize = 12;

pub(super) fn section(subject: &Subject) -> Section {
    let diagnosis = subject.diagnosis;
    let refitted = by_frf(subject, &diagnosis.search.refitted)
        .caption("Refitted within tolerances: χ² per value by FRF and band")
        .footnote(if diagnosis.model_error.is_some() {
            "1 is noise alone; shaded from there to 100, where the error of the model may well lead. A dash: no value of the band counts."
        } else {
            "1 is noise alone; shaded from there to 100. A dash: no value of the band counts."
        });
    let mut section = Section::new("Misfit").with(refitted);
    if !diagnosis.findings.is_empty() {
        let repaired = by_frf(subject, &diagnosis.search.repaired);
        section = section.with(repaired.caption("Repaired: χ² per value by FRF and band"));
    }
    match by_place(subject) {
        Some(map) => section.with(map),
        None => section,
    }
}

/// Name, χ² over all lines, χ² by band.
type Row = (String, Option<f64>, Vec<BandMisfit>);

fn map(corner: &str, bands: &[BandMisfit], rows: impl Iterator<Item = Row>) -> Table<Row> {
    let table = Table::of(rows).names(corner, |row| row.0.clone());
    let table = table.shaded("all lines", |row| Cell::misfit(row.1));
    bands.iter().enumerate().fold(table, |table, (index, band)| {
        let heading = format!("{} to {} Hz", plain(band.from, 4), plain(band.to, 4));
        table.shaded(heading, |row| Cell::misfit(row.2.get(index).and_then(|band| band.chi2_per_dof)))
    })
}

fn by_frf(subject: &Subject, fit: &Fit) -> Table<Row> {
    let misfit = subject.diagnosis.misfit(fit);
    let bands = misfit.first().map_or(&[][..], |frf| &frf.bands);
    map("FRF", bands, misfit.iter().map(|frf| (frf.frf.to_string(), frf.whole, frf.bands.clone())))
}

/// What each place leaves with one free value a line, the best place first.
fn by_place(subject: &Subject) -> Option<Table<Row>> {
    let locations = &subject.diagnosis.locations;
    let bands = &locations.first()?.bands;
    let rows = locations
        .iter()
        .take(SHOWN)
        .map(|location| (location.site.says(), Some(location.chi2_per_dof), location.bands.clone()));
    let shown = locations.len().min(SHOWN);
    let footnote = format!(
        "{shown} of {} places. At the right place one unknown a line explains all FRFs within their noise; a small mismatch is explained at \
         several.",
        locations.len()
    );
    Some(
        map("Place", bands, rows)
            .caption("What a place leaves unexplained, with one unknown value a line there and no law assumed: χ² per degree of freedom, best place first")
            .footnote(footnote),
    )
}
