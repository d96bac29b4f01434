//! The complex mode indicator function: how many modes there are, and where.

use jointscope_modes::ModeIndicator;
use jointscope_spectra::FrfSet;

use crate::plot::{Axis, Plot, Role, Style, YRange};

/// Curves that are drawn at the most.
const DRAWN: usize = 4;
/// Share of the largest singular value below which another is rounding.
const ROUNDING: f64 = 1e-12;
const NAMES: [&str; DRAWN] = ["σ₁", "σ₂", "σ₃", "σ₄"];

/// The indicator of measured FRFs, and beside it that of a fixture's on the same lines; nothing of FRFs that
/// make no matrix.
pub(crate) fn plot(measured: &FrfSet, fixture: Option<&FrfSet>) -> Option<Plot> {
    let indicator = ModeIndicator::of(measured)?;
    let unit = if indicator.responses[0].dof.name() == "rotation" { "(rad/s^2)/(N*m)" } else { "(m/s^2)/N" };
    let axis = Axis::logarithmic("singular values", unit);
    let plot = Plot::new("Mode indicator (CMIF)", Axis::frequency(), axis).over(measured.lines().hz());
    let sources = [
        (Some(indicator.clone()), "measured", Style::Line),
        (fixture.and_then(ModeIndicator::of), "fixture", Style::Dashed),
    ];
    let curves =
        sources.iter().filter_map(|(indicator, what, style)| Some((indicator.as_ref()?, what, style)));
    let plot = curves.fold(plot, |plot, (indicator, what, style)| {
        let first = &indicator.curves[0];
        let named = indicator.curves.iter().zip(NAMES).enumerate();
        named.fold(plot, |plot, (place, (curve, name))| {
            let drawn =
                curve.iter().zip(first).map(|(value, first)| (*value > ROUNDING * first).then_some(*value));
            plot.series(*style, format!("{name} {what}"), Role::Trace(place), drawn)
        })
    });
    let drawn = indicator.curves.iter().take(DRAWN).flatten().copied().filter(|value| *value > 0.0);
    Some(plot.masked(0).y_range(YRange::decades(drawn)).height(220).caption(caption(&indicator, measured)))
}

/// Which FRFs it is of, and how it is read.
fn caption(indicator: &ModeIndicator, measured: &FrfSet) -> String {
    let (used, all) = (indicator.frfs(), measured.pairs().len());
    let of = match (indicator.responses.len(), indicator.references.len()) {
        (responses, 1) => format!("{responses} by one reference"),
        (responses, references) => format!("{responses} by {references} references"),
    };
    let part = match used < all {
        true => format!(", the {used} of {all} FRFs between which none is missing"),
        false => String::new(),
    };
    let reading = match indicator.curves.len() {
        1 => {
            "Of one reference or response it is the root of the FRFs' summed squares: each peak is one mode or several."
        }
        _ => {
            "Each peak of the first is a mode; where two modes are close to each other, the second peaks as well."
        }
    };
    let some = if indicator.curves.len() > DRAWN { " The largest four are drawn." } else { "" };
    format!("Singular values of the matrix of FRFs, responses {of}{part}. {reading}{some}")
}
