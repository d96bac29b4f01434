//! The page of names that a further test weighed: what it is, and what each test says of every name.

use jointscope_fixture::Fixture;
use jointscope_plan::Weighed;
use jointscope_wording::effect_name;

use crate::context::PageContext;
use crate::drawing::SideView;
use crate::error::PageError;
use crate::format::{percent, significant};
use crate::section::Section;
use crate::table::{Cell, Table};
use crate::tone::Tone;

/// How dark the cell of a sure name is, %.
const DARKEST: f64 = 70.0;

/// The page of names that a further test weighed, as one self-contained HTML file; `state` is the fixture of
/// that test.
///
/// # Errors
/// None that names can cause.
pub fn weighed_page(weighed: &Weighed, state: &Fixture, context: &PageContext) -> Result<String, PageError> {
    let tone = match weighed.is_met && weighed.is_settled() {
        true => Tone::Ok,
        false => Tone::Attention,
    };
    context
        .page(
            "Plan: two tests together",
            context.subtitle(state),
            context.verdict(tone, weighed.says.clone(), weighed.remarks.iter().cloned()),
        )
        .sections([names(weighed, state)])
        .to_html()
}

fn names(weighed: &Weighed, state: &Fixture) -> Section {
    let cell = |probability: f64| Cell::Shaded(percent(probability, 1), DARKEST * probability);
    let table = Table::of(&weighed.names)
        .words("Name", |name| effect_name(&name.effect))
        .shaded("Both tests", |name| cell(name.probability))
        .shaded("First alone", |name| cell(name.before))
        .footnote(format!(
            "What is missing to 100 % is for what no name covers. The best name leaves χ² per degree of freedom of {} of the further test.",
            significant(weighed.chi2_per_dof, 3)
        ));
    Section::new("The names, by both tests")
        .drawing(
            SideView::new(state, &weighed.recorded).draw(),
            "Side view of the structure as the further test had it, responses (sensors) in blue and references (hammer) in green.",
        )
        .with(table)
}
