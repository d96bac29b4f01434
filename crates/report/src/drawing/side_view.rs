//! What is drawn of a fixture.

use std::collections::HashMap;

use jointscope_fixture::Fixture;
use jointscope_spectra::FrfPair;

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
}
