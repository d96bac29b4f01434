//! The fixture from the side, with what was used of the test.

use super::Subject;
use crate::Section;
use crate::drawing::FixtureDrawing;

pub(super) fn section(subject: &Subject) -> Section {
    let (fixture, analysis) = (subject.fixture, subject.analysis);
    let used =
        analysis.plan.layout.channels.iter().filter_map(|(index, ..)| analysis.frfs.pairs().get(*index));
    let mut drawing = FixtureDrawing::of_fixture(fixture, used);
    for joint in &mut drawing.joints {
        joint.highlight = joint.name == analysis.joint;
    }
    let scale_words = if subject.is_scalar() { "" } else { " The outlines of the blocks are sketched." };
    Section::new("Fixture").drawing(
        drawing.to_svg(),
        format!(
            "Side view: joint {} and the channels used to find it, responses (sensors) in blue and references \
             (hammer) in green.{scale_words}",
            analysis.joint
        ),
    )
}
