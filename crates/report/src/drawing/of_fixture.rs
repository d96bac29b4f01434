//! What a fixture file says, as it is drawn.

use jointscope_fixture::{BodyKind, Fixture, JointLaw, RigidBody};
use jointscope_spectra::FrfPair;

use super::{Body, Channel, ChannelKind, FixtureDrawing, Joint, Point, Support};

impl FixtureDrawing {
    /// Bodies, points, joints and supports of a fixture, with the sensors and hammer points of some FRFs.
    pub fn of_fixture<'a>(fixture: &Fixture, frfs: impl IntoIterator<Item = &'a FrfPair>) -> Self {
        FixtureDrawing {
            bodies: bodies(fixture),
            points: fixture.points().iter().map(|p| Point::new(&p.name, p.x.value, p.body)).collect(),
            joints: fixture
                .joints()
                .iter()
                .map(|joint| Joint {
                    name: joint.name.clone(),
                    from: joint.from,
                    to: joint.to,
                    is_beam: matches!(joint.law, JointLaw::Beam { .. }),
                    highlight: false,
                })
                .collect(),
            supports: fixture
                .supports()
                .iter()
                .map(|support| {
                    let (body, x) = fixture.support_place(support);
                    Support { x, body }
                })
                .collect(),
            channels: channels(fixture, frfs),
            highlights: Vec::new(),
        }
    }
}

/// Blocks reach over their points and as far beyond the centre of gravity as before it, where no other body stands.
fn bodies(fixture: &Fixture) -> Vec<Body> {
    let hulls: Vec<(f64, f64)> = (0..fixture.bodies().len()).map(|body| hull(fixture, body)).collect();
    fixture
        .bodies()
        .iter()
        .enumerate()
        .map(|(index, body)| match &body.kind {
            BodyKind::Beam(beam) => Body::beam(&body.name, beam.from.value, beam.to.value),
            BodyKind::Rigid(rigid) => {
                let whole = mirrored(hulls[index], rigid);
                let free = hulls
                    .iter()
                    .enumerate()
                    .all(|(other, hull)| other == index || whole.1 <= hull.0 || whole.0 >= hull.1);
                let (from, to) = if free { whole } else { hulls[index] };
                Body { rotates: rigid.rotates, ..Body::block(&body.name, from, to) }
            }
        })
        .collect()
}

/// From the first to the last of what is known to lie on a body.
fn hull(fixture: &Fixture, body: usize) -> (f64, f64) {
    let points = fixture.points().iter().filter(|point| point.body == body).map(|point| point.x.value);
    let kind = &fixture.bodies()[body].kind;
    let own: Vec<f64> = match kind {
        BodyKind::Beam(beam) => vec![beam.from.value, beam.to.value],
        BodyKind::Rigid(rigid) => rigid.x_cg.iter().map(|x| x.value).collect(),
    };
    points
        .chain(own)
        .chain(fixture.bodies()[body].masses.iter().map(|mass| mass.x.value))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

fn mirrored((from, to): (f64, f64), rigid: &RigidBody) -> (f64, f64) {
    match (&rigid.x_cg, rigid.rotates) {
        (Some(centre), true) => {
            let reach = (centre.value - from).max(to - centre.value);
            (centre.value - reach, centre.value + reach)
        }
        _ => (from, to),
    }
}

/// Each sensor and hammer point of the FRFs, once.
fn channels<'a>(fixture: &Fixture, frfs: impl IntoIterator<Item = &'a FrfPair>) -> Vec<Channel> {
    let at = |name: &str| fixture.points().iter().position(|point| point.name == name);
    let mut used: Vec<(usize, ChannelKind)> = Vec::new();
    for pair in frfs {
        let ends = [(&pair.response, ChannelKind::Response), (&pair.reference, ChannelKind::Reference)];
        used.extend(ends.into_iter().filter_map(|(channel, kind)| Some((at(&channel.point)?, kind))));
    }
    used.sort_unstable();
    used.dedup();
    used.into_iter().map(|(point, kind)| Channel { point, kind }).collect()
}
