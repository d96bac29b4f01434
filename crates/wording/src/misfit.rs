//! What a model leaves of the FRFs: where it shows most, and how it goes with frequency.

use crate::Says;
use crate::numbers::{figures, percent, plain};
use crate::places::variation;
use jointscope_diagnosis::{Diagnosis, Fit, Location, Trend};

/// `most clearly in FRF 4/1 from 180 Hz to 240 Hz`, and the best place.
pub(crate) fn shows(diagnosis: &Diagnosis, fit: &Fit) -> String {
    format!("{}{}", most_clearly(diagnosis, fit), diagnosis.best_place().map_or_else(String::new, best))
}

fn best(location: &Location) -> String {
    format!("; of all single places {} would explain most", location.site.says())
}

fn most_clearly(diagnosis: &Diagnosis, fit: &Fit) -> String {
    match diagnosis.worst_band(fit) {
        Some((frf, band)) => {
            format!("most clearly in FRF {frf} from {} to {}", plain(band.from, "Hz"), plain(band.to, "Hz"))
        }
        None => "in no line that counts".to_owned(),
    }
}

/// How the mismatch goes with frequency: by δ(ω) of the best place, or by the relative error at both ends of
/// the band.
pub(crate) fn varies(diagnosis: &Diagnosis, fit: &Fit) -> String {
    if let Some(variation) = diagnosis.best_place().and_then(variation) {
        return format!(", where what is missing, δ(ω), {variation}");
    }
    let Some(errors) = diagnosis.end_errors(fit) else { return String::new() };
    let course = match errors.trend() {
        Trend::Grows => "grows with frequency",
        Trend::Falls => "falls with frequency",
        Trend::Level => "is about as large at both ends of the band",
    };
    format!(
        ", and {course} (relative error {} below {}, {} above {})",
        percent(errors.low),
        plain(errors.below, "Hz"),
        percent(errors.high),
        plain(errors.above, "Hz")
    )
}

/// `most clearly in FRF 4/1 from 180 Hz to 240 Hz`, and the best place with what it leaves.
pub(crate) fn sits(diagnosis: &Diagnosis, fit: &Fit) -> String {
    let place = diagnosis.best_place().map_or_else(String::new, |location| {
        format!("{} (χ² per degree of freedom {})", best(location), figures(location.chi2_per_dof))
    });
    format!("{}{place}", most_clearly(diagnosis, fit))
}
