//! The page of one decomposition: what the joint is, what that rests on, and how far to believe it.

mod all_frfs;
mod by_line;
mod fixture_view;
mod frfs;
mod interface_table;
mod interfaces_by_line;
mod joints;
mod omitted;
mod result;
mod shares;
mod subject;

use jointscope_decomposition::{Analysis, JointEstimate, Use};
use jointscope_fixture::Fixture;
use jointscope_pipeline::{Decomposition, Joints};
use jointscope_wording::decomposition;

use crate::context::PageContext;
use crate::report::Report;
use crate::section::Verdict;
use crate::tone::Tone;
use joints::joints_report;
use subject::Subject;

/// The page of the joint in a measurement, or of all joints.
pub fn joint_report(decomposition: &Decomposition, context: &PageContext) -> Report {
    match &decomposition.found {
        Joints::One(analysis) => decomposition_report(analysis, &decomposition.fixture, context),
        Joints::AtOnce(joints) => joints_report(joints, &decomposition.fixture, context),
    }
}

fn tone(analysis: &Analysis) -> Tone {
    match analysis.judgement.verdict {
        Use::Sound => Tone::Ok,
        Use::WithCare => Tone::Attention,
        _ => Tone::Problem,
    }
}

/// The page of a joint's decomposition: verdict, fixture, key figures with noise and tolerances apart, the
/// joint from all FRFs with its laws and tests, K and C by line, the FRFs behind them, interfaces as single
/// numbers and by line, what the tolerances do, what was left out.
///
/// `fixture` is the one that `analysis` was made with. The same input gives the same bytes.
pub fn decomposition_report(analysis: &Analysis, fixture: &Fixture, context: &PageContext) -> Report {
    let best = JointEstimate::best(analysis);
    let subject = Subject { analysis, fixture, best: &best };
    let title = format!("Joint {}: stiffness and damping", analysis.joint);
    let said = decomposition::JointSummary::of(analysis, fixture, &best);
    let verdict = Verdict { tone: tone(analysis), headline: said.headline, details: said.details };
    Report::of(
        context
            .page(title, context.subtitle(fixture), verdict)
            .sections(context.hits())
            .sections([fixture_view::section(&subject), result::section(&subject)])
            .sections(all_frfs::section(&subject))
            .sections(by_line::sections(&subject))
            .sections([frfs::section(&subject)])
            .sections(interface_table::section(&subject))
            .sections(interfaces_by_line::section(&subject))
            .sections([shares::section(&subject), omitted::section(&subject, context)]),
    )
}
