//! The page of a modal analysis: the chart that the poles were chosen from, the modes, and the FRFs rebuilt from them.

mod chart;
mod frfs;
mod shapes;
mod table;

use jointscope_fixture::Fixture;
use jointscope_modes::ModalAnalysis;

use crate::{Page, PageContext, PageError, Section, Verdict};

/// Lines beyond which panes are drawn thinned, so that a page of long recordings stays small.
const LINE_LIMIT: usize = 2_000;
/// FRFs and shapes that are shown at the most; the page says how many there are.
const SHOWN: usize = 12;

/// The page of a modal analysis as one self-contained HTML file: stabilisation chart, table of modes, shapes, auto-MAC, residual terms, and rebuilt FRFs over measured
/// ones.
///
/// `fixture` tells where the channels are, if there is one, and `matches` what was found of its elastic modes, one sentence each. The same input gives the same
/// bytes.
///
/// # Errors
/// An analysis whose lists do not fit its spectral lines.
pub fn modes_page(
    analysis: &ModalAnalysis,
    fixture: Option<&Fixture>,
    matches: &[String],
    context: &PageContext,
) -> Result<String, PageError> {
    let count = analysis.modes.len();
    let hz = analysis.lines().hz();
    // To a tenth of a millihertz: lines carry rounding of their own.
    let rounded = |hz: f64| (1e4 * hz).round() / 1e4;
    let headline = format!(
        "{count} mode{} from {} to {} Hz",
        if count == 1 { "" } else { "s" },
        rounded(hz[0]),
        rounded(hz[hz.len() - 1])
    );
    let remarks: Vec<String> = analysis.remarks();
    let verdict = if remarks.is_empty() { Verdict::ok(headline) } else { Verdict::attention(headline) };
    let verdict = remarks.into_iter().chain(context.notes.iter().cloned()).fold(verdict, Verdict::detail);
    let mut page = Page::new("Modes: natural frequencies, damping ratios, shapes")
        .subtitle(context.recordings(fixture.is_some()))
        .verdict(verdict)
        .section(table::modes(analysis));
    if !matches.is_empty() {
        page = page.section(Section::new("The fixture's elastic modes").notes(matches.to_vec()));
    }
    page.section(chart::section(analysis))
        .section(shapes::section(analysis, fixture))
        .section(table::auto_mac(analysis))
        .section(frfs::section(analysis))
        .section(table::residuals(analysis))
        .foot(context.foot())
        .to_html()
}
