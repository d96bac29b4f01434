//! The fixture from the side, with what was used of the test.

use super::subject::Subject;
use crate::drawing::SideView;
use crate::section::Section;

pub(super) fn section(subject: &Subject) -> Section {
    let (fixture, analysis) = (subject.fixture, subject.analysis);
    let used =
        analysis.plan.layout.channels.iter().filter_map(|(index, ..)| analysis.frfs.pairs().get(*index));
    let mut view = SideView::new(fixture, used);
    view.joints.push(&analysis.joint);
    let outlines = if subject.is_scalar() { "" } else { " The outlines of the blocks are sketched." };
    Section::new("Fixture").drawing(
        view.draw(),
        format!(
            "Side view: joint {} and the channels used to find it, responses (sensors) in blue and references \
             (hammer) in green.{outlines}",
            analysis.joint
        ),
    )
}
