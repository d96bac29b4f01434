//! A side view of a fixture: bodies along x with their points, joints, supports, sensors and impacts, as inline SVG.

mod layout;
mod outline;
mod svg;

use std::collections::HashMap;

use jointscope_fixture::Fixture;
use jointscope_spectra::FrfPair;
use maud::Markup;

/// What a channel records.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum ChannelKind {
    /// The motion of its point.
    Response,
    /// The force of the hammer on its point.
    Reference,
}

/// A place to be pointed out, with a few words; not drawn where its abscissa is not finite.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Highlight {
    /// Abscissa, m.
    pub x: f64,
    /// Index of the body it lies on; between bodies where there is none.
    pub body: Option<usize>,
    /// What is there.
    pub label: String,
}

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

/// What is drawn of a fixture. Bodies that overlap in x are drawn one above the other.
#[derive(Debug, Clone)]
pub(crate) struct SideView<'a> {
    pub fixture: &'a Fixture,
    /// Each sensor and hammer point once, by the index of its point.
    pub channels: Vec<(usize, ChannelKind)>,
    /// Places to be pointed out.
    pub highlights: Vec<Highlight>,
    /// Names of the joints to be pointed out.
    pub joints: Vec<&'a str>,
}

impl<'a> SideView<'a> {
    /// A fixture with the sensors and hammer points of some FRFs.
    pub(crate) fn new<'f>(fixture: &'a Fixture, frfs: impl IntoIterator<Item = &'f FrfPair>) -> Self {
        let places: HashMap<&str, usize> =
            fixture.points().iter().enumerate().map(|(index, point)| (point.name.as_str(), index)).collect();
        let at = |name: &str| places.get(name).copied();
        let ends = frfs.into_iter().flat_map(|pair| {
            [(&pair.response, ChannelKind::Response), (&pair.reference, ChannelKind::Reference)]
        });
        let mut channels: Vec<_> =
            ends.filter_map(|(channel, kind)| Some((at(&channel.point)?, kind))).collect();
        channels.sort_unstable();
        channels.dedup();
        Self { fixture, channels, highlights: Vec::new(), joints: Vec::new() }
    }

    /// The drawing, in the colours of the page it stands in. It scales with its width; labels that would meet are put in rows of their own.
    pub(crate) fn draw(&self) -> Drawing {
        let of = |width, class| svg::draw(self, width, class);
        Drawing { wide: of(layout::WIDTH, "wide"), narrow: Some(of(layout::NARROW, "narrow")) }
    }
}
