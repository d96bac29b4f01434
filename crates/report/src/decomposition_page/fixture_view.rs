//! The fixture from the side, with what was used of the test.

use jointscope_fixture::{BodyKind, Fixture, JointLaw, RigidBody};

use super::Subject;
use crate::Section;
use crate::drawing::{Body, Channel, ChannelKind, FixtureDrawing, Joint, Point, Support};

pub(super) fn section(subject: &Subject) -> Section {
    let (fixture, analysis) = (subject.fixture, subject.analysis);
    let drawing = FixtureDrawing {
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
                highlight: joint.name == analysis.joint,
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
        channels: channels(subject),
        highlights: Vec::new(),
    };
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

/// Each sensor and hammer point of the FRFs in use, once.
fn channels(subject: &Subject) -> Vec<Channel> {
    let analysis = subject.analysis;
    let at = |name: &str| subject.fixture.points().iter().position(|point| point.name == name);
    let mut used: Vec<(usize, ChannelKind)> = Vec::new();
    for (index, ..) in &analysis.plan.layout.channels {
        let Some(pair) = analysis.frfs.pairs().get(*index) else { continue };
        let ends = [(&pair.response, ChannelKind::Response), (&pair.reference, ChannelKind::Reference)];
        used.extend(ends.into_iter().filter_map(|(channel, kind)| Some((at(&channel.point)?, kind))));
    }
    used.sort_unstable();
    used.dedup();
    used.into_iter().map(|(point, kind)| Channel { point, kind }).collect()
}
