//! From where to where the bodies of a fixture reach: the file says it of beams only.

use jointscope_fixture::{BodyKind, Fixture, RigidBody};

use crate::plot::Span;

/// Both ends of every body, m. Blocks reach over their points and as far beyond the centre of gravity as
/// before it, where no other body stands.
pub(super) fn outlines(fixture: &Fixture) -> Vec<(f64, f64)> {
    let hulls: Vec<(f64, f64)> = (0..fixture.bodies().len()).map(|body| hull(fixture, body)).collect();
    let outline = |(index, body): (usize, &jointscope_fixture::Body)| match &body.kind {
        BodyKind::Beam(beam) => (beam.from.value, beam.to.value),
        BodyKind::Rigid(rigid) => {
            let (from, to) = mirrored(hulls[index], rigid);
            let others = hulls.iter().enumerate().filter(|(other, _)| *other != index);
            let is_free = others.into_iter().all(|(_, (a, b))| !(to > *a && from < *b));
            if is_free { (from, to) } else { hulls[index] }
        }
    };
    fixture.bodies().iter().enumerate().map(outline).collect()
}

/// From the first to the last of what is known to lie on a body; nowhere where nothing is.
fn hull(fixture: &Fixture, index: usize) -> (f64, f64) {
    let body = &fixture.bodies()[index];
    let points = fixture.points().iter().filter(|point| point.body == index).map(|point| &point.x);
    let own: Vec<_> = match &body.kind {
        BodyKind::Beam(beam) => vec![&beam.from, &beam.to],
        BodyKind::Rigid(rigid) => rigid.x_cg.iter().collect(),
    };
    let all = points.chain(own).chain(body.masses.iter().map(|mass| &mass.x));
    Span::of(all.map(|x| x.value)).0.unwrap_or((f64::NAN, f64::NAN))
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
