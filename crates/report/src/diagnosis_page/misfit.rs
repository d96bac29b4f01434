//! Maps of the misfit: by FRF and band, by place and band.

use jointscope_diagnosis::Fit;

use super::{SHOWN, Subject};
use crate::format::significant;
use crate::{HeatMap, Section};

pub(super) fn section(subject: &Subject) -> Section {
    let diagnosis = subject.diagnosis;
    let mut section = Section::new("Misfit").heat_map(
        by_frf(subject, &diagnosis.search.refitted)
            .caption("Refitted within tolerances: χ² per value by FRF and band")
            .footnote("1 is noise alone; shaded from there to 100. A dash: no value of the band counts."),
    );
    if !diagnosis.findings.is_empty() {
        section = section.heat_map(
            by_frf(subject, &diagnosis.search.repaired).caption("Repaired: χ² per value by FRF and band"),
        );
    }
    if let Some(map) = by_place(subject) {
        section = section.heat_map(map);
    }
    section
}

fn by_frf(subject: &Subject, fit: &Fit) -> HeatMap {
    let misfit = subject.diagnosis.misfit(fit);
    let bands = misfit.first().map_or_else(Vec::new, |frf| frf.bands.clone());
    let columns = bands.iter().map(|(from, to, _)| band(*from, *to));
    let map = HeatMap::new("FRF", std::iter::once("all lines".to_owned()).chain(columns));
    misfit.iter().fold(map, |map, frf| {
        let values = std::iter::once(frf.whole).chain(frf.bands.iter().map(|(_, _, chi2)| *chi2));
        map.row(frf.frf.to_string(), values)
    })
}

/// What each place leaves with one free value a line, the best place first.
fn by_place(subject: &Subject) -> Option<HeatMap> {
    let locations = &subject.diagnosis.locations;
    let bands = &locations.first()?.bands;
    let columns = bands.iter().map(|(from, to, _)| band(*from, *to));
    let mut map = HeatMap::new("Place", std::iter::once("all lines".to_owned()).chain(columns));
    for location in locations.iter().take(SHOWN) {
        let mut values: Vec<Option<f64>> = vec![Some(location.chi2_per_dof)];
        values.extend(location.bands.iter().map(|(_, _, chi2)| Some(*chi2)));
        values.resize(bands.len() + 1, None);
        map = map.row(location.site.says(), values);
    }
    let shown = locations.len().min(SHOWN);
    Some(
        map.caption("What a place leaves unexplained, with one unknown value a line there and no law assumed: χ² per degree of freedom, best place first")
            .footnote(format!(
                "{shown} of {} places. At the right place one unknown a line explains all FRFs within their noise; a small mismatch is explained at \
                 several.",
                locations.len()
            )),
    )
}

fn band(from: f64, to: f64) -> String {
    format!("{} to {} Hz", plain(from), plain(to))
}

/// Four digits, without the zeros that say nothing.
fn plain(hz: f64) -> String {
    let text = significant(hz, 4);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
