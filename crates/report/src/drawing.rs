//! A side view of a fixture: bodies along x with their points, joints, supports, sensors and impacts, as inline SVG.
//!
//! ```
//! use jointscope_report::drawing::{Body, Channel, ChannelKind, FixtureDrawing, Joint, Point};
//!
//! let svg = FixtureDrawing {
//!     bodies: vec![Body::block("A", -0.060, 0.0), Body::block("B", 0.065, 0.125)],
//!     points: vec![
//!         Point::new("1", -0.060, 0), Point::new("2", 0.0, 0),
//!         Point::new("3", 0.065, 1), Point::new("4", 0.125, 1),
//!     ],
//!     joints: vec![Joint::beam("J", 1, 2)],
//!     channels: vec![
//!         Channel { point: 0, kind: ChannelKind::Reference },
//!         Channel { point: 3, kind: ChannelKind::Response },
//!     ],
//!     ..FixtureDrawing::default()
//! }
//! .to_svg();
//! assert!(svg.as_str().starts_with("<svg"));
//! ```

mod layout;
mod of_fixture;
mod svg;

/// Markup of an SVG image that may stand in a page as it is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Svg(String);

impl Svg {
    /// Takes markup on trust: it goes into the page unescaped, so no text from outside may be in it unless escaped already.
    pub fn trusted(markup: impl Into<String>) -> Self {
        Self(markup.into())
    }

    /// The markup.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

/// What is drawn of a fixture. Abscissae are in metres; indices point into the lists of this struct, and what points nowhere, or lies at no finite abscissa, is left out.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FixtureDrawing {
    /// The bodies. Those that overlap in x are drawn one above the other.
    pub bodies: Vec<Body>,
    /// Named places on bodies.
    pub points: Vec<Point>,
    /// What connects two points.
    pub joints: Vec<Joint>,
    /// Springs to ground.
    pub supports: Vec<Support>,
    /// Where is measured and where is struck.
    pub channels: Vec<Channel>,
    /// Places to be pointed out.
    pub highlights: Vec<Highlight>,
}

/// A block or a slender beam.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Its name in the fixture file.
    pub name: String,
    /// Abscissa of its left end, m.
    pub from: f64,
    /// Abscissa of its right end, m.
    pub to: f64,
    /// Whether it has the degree of freedom θ besides y.
    pub rotates: bool,
    /// Whether it is a slender, deformable beam.
    pub is_beam: bool,
}

impl Body {
    /// A block that moves in y and θ.
    pub fn block(name: impl Into<String>, from: f64, to: f64) -> Self {
        Self { name: name.into(), from, to, rotates: true, is_beam: false }
    }

    /// A slender, deformable beam.
    pub fn beam(name: impl Into<String>, from: f64, to: f64) -> Self {
        Self { is_beam: true, ..Self::block(name, from, to) }
    }
}

/// A named place on a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Its name, which is the node number of the recordings.
    pub name: String,
    /// Abscissa, m.
    pub x: f64,
    /// Index of the body.
    pub body: usize,
}

impl Point {
    /// A point at an abscissa (m) on the body of this index.
    pub fn new(name: impl Into<String>, x: f64, body: usize) -> Self {
        Self { name: name.into(), x, body }
    }
}

/// A joint between two points.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Its name in the fixture file.
    pub name: String,
    /// Index of the point at its near end.
    pub from: usize,
    /// Index of the point at its far end.
    pub to: usize,
    /// Drawn as a thin beam; a spring otherwise.
    pub is_beam: bool,
    /// Drawn in the colour of what the reader must look at.
    pub highlight: bool,
}

impl Joint {
    /// A beam between the points of these indices.
    pub fn beam(name: impl Into<String>, from: usize, to: usize) -> Self {
        Self { name: name.into(), from, to, is_beam: true, highlight: false }
    }

    /// A joint of given stiffness between the points of these indices, drawn as a spring.
    pub fn spring(name: impl Into<String>, from: usize, to: usize) -> Self {
        Self { is_beam: false, ..Self::beam(name, from, to) }
    }
}

/// A support to ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// Abscissa, m.
    pub x: f64,
    /// Index of the body.
    pub body: usize,
}

/// What a channel records.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ChannelKind {
    /// The motion of its point.
    Response,
    /// The force of the hammer on its point.
    Reference,
}

/// A sensor or an impact at a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Channel {
    /// Index of the point.
    pub point: usize,
    /// What is recorded there.
    pub kind: ChannelKind,
}

/// A place to be pointed out, with a few words.
#[derive(Debug, Clone, PartialEq)]
pub struct Highlight {
    /// Abscissa, m.
    pub x: f64,
    /// Index of the body it lies on; between bodies where there is none.
    pub body: Option<usize>,
    /// What is there.
    pub label: String,
}

impl FixtureDrawing {
    /// The drawing, in the colours of the page it stands in. It scales with its width; labels that would meet are put in rows of their own.
    pub fn to_svg(&self) -> Svg {
        Svg(svg::draw(self))
    }
}
