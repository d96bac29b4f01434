//! A side view of a fixture: bodies along x with their points, joints, supports, sensors and impacts, as
//! inline SVG.

mod layout;
mod outline;
mod side_view;
mod svg;

pub(crate) use side_view::{Highlight, SideView};

use maud::Markup;

/// An SVG image, and another of the same for narrow windows if there is one.
#[derive(Debug, Clone)]
pub(crate) struct Drawing {
    pub wide: Markup,
    pub narrow: Option<Markup>,
}

impl From<Markup> for Drawing {
    fn from(wide: Markup) -> Self {
        Drawing { wide, narrow: None }
    }
}

impl SideView<'_> {
    /// The drawing, in the colours of the page it stands in. It scales with its width; labels that would meet
    /// are put in rows of their own.
    pub(crate) fn draw(&self) -> Drawing {
        let of = |width, class| svg::draw(self, width, class);
        Drawing { wide: of(layout::WIDTH, "wide"), narrow: Some(of(layout::NARROW, "narrow")) }
    }
}
