//! The page of one decomposition: what the joint is, what that rests on, and how far to believe it.

mod by_line;
mod element;
mod estimate;
mod fixture_view;
mod frfs;
mod interface_table;
mod omitted;
mod result;
mod shares;
mod verdict;

use jointscope_decomposition::{Analysis, Relation};
use jointscope_fixture::{Fixture, Joint, JointLaw};

use crate::hammer_test;
use crate::{Page, PageContext, PageError, Section};
use estimate::Estimate;

/// What the sections of the page are made from.
#[derive(Clone, Copy)]
struct Subject<'a> {
    analysis: &'a Analysis,
    fixture: &'a Fixture,
    best: &'a Estimate,
}

impl<'a> Subject<'a> {
    fn joint(&self) -> Option<&'a Joint> {
        self.fixture.joint(&self.analysis.joint)
    }

    fn is_paper(&self) -> bool {
        self.analysis.spectrum.relation == Relation::Paper
    }

    fn is_scalar(&self) -> bool {
        self.analysis.spectrum.scalar
    }

    /// Whose the nominal stiffness is.
    fn nominal_owner(&self) -> &'static str {
        match self.joint().map(|joint| &joint.law) {
            Some(JointLaw::Beam { .. }) => "the nominal beam's",
            _ => "the fixture's",
        }
    }

    /// What K by line is called in captions.
    fn relation_words(&self) -> &'static str {
        if self.is_paper() { "eq (7)" } else { "the exact relation" }
    }
}

/// The page of a joint's decomposition as one self-contained HTML file: verdict, fixture, key figures with noise and
/// tolerances apart, K and C by line, the FRFs behind them, interfaces, what the tolerances do, what was left out.
///
/// `fixture` is the one that `analysis` was made with. The same input gives the same bytes.
///
/// # Errors
/// An analysis whose lists do not fit its spectral lines.
pub fn decomposition_page(
    analysis: &Analysis,
    fixture: &Fixture,
    context: &PageContext,
) -> Result<String, PageError> {
    let best = Estimate::best(analysis);
    let subject = Subject { analysis, fixture, best: &best };
    let mut page = Page::new(format!("Joint {}: stiffness and damping", analysis.joint))
        .subtitle(context.subtitle(fixture))
        .verdict(verdict::verdict(&subject));
    if let Some(test) = &context.hits {
        page = page.section(hammer_test::section(test));
    }
    page = page.section(fixture_view::section(&subject));
    for section in result::sections(&subject) {
        page = page.section(section);
    }
    for section in by_line::sections(&subject) {
        page = page.section(section);
    }
    page = page.section(frfs::section(&subject));
    let others: [Option<Section>; 3] = [
        interface_table::section(&subject),
        shares::section(&subject),
        Some(omitted::section(&subject, context)),
    ];
    for section in others.into_iter().flatten() {
        page = page.section(section);
    }
    page.foot(context.foot()).to_html()
}
