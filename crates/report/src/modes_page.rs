//! The page of a modal analysis: the chart that the poles were chosen from, the modes, and the FRFs rebuilt
//! from them.

mod chart;
mod frfs;
mod shapes;
mod table;

use jointscope_fixture::Fixture;
use jointscope_modes::ModalAnalysis;
use jointscope_spectra::FrfSet;
use jointscope_wording::{Remarks, counted};

use crate::context::PageContext;
use crate::report::Report;
use crate::section::Section;
use crate::tone::Tone;

/// The page of a modal analysis: stabilisation chart, table of modes, shapes, auto-MAC, residual terms, and
/// rebuilt FRFs over measured ones.
///
/// `fixture` tells where the channels are, if there is one, `matches` what was found of its elastic modes,
/// one sentence each, and `modelled` are its FRFs on the channels and lines in use. The same input gives the
/// same bytes.
pub fn modes_report(
    analysis: &ModalAnalysis,
    fixture: Option<&Fixture>,
    (matches, modelled): (&[String], Option<&FrfSet>),
    context: &PageContext,
) -> Report {
    let hz = analysis.lines().hz();
    // To a tenth of a millihertz: lines carry rounding of their own.
    let rounded = |hz: f64| (1e4 * hz).round() / 1e4;
    let headline = format!(
        "{} from {} to {} Hz",
        counted(analysis.modes.len(), "mode"),
        rounded(hz[0]),
        rounded(hz[hz.len() - 1])
    );
    let remarks = analysis.remarks();
    let tone = if remarks.is_empty() { Tone::Ok } else { Tone::Attention };
    let verdict = context.verdict(tone, headline, remarks);
    let matched = Section::new("The fixture's elastic modes").notes(matches);
    Report::of(
        context
            .page(
                "Modes: natural frequencies, damping ratios, shapes",
                context.recordings(fixture.is_some()),
                verdict,
            )
            .sections([table::modes(analysis)])
            .sections((!matches.is_empty()).then_some(matched))
            .sections([
                chart::section(analysis, modelled),
                shapes::section(analysis, fixture),
                table::auto_mac(analysis),
                frfs::section(analysis),
                table::residuals(analysis),
            ]),
    )
}
