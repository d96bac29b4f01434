//! What the bodies of a fixture are: inertia, extent.

use jointscope_fixture::{BodyKind, Fixture};

/// Moment of inertia of a body about its middle, kg·m²; zero of one that does not rotate.
pub(crate) fn inertia_of(fixture: &Fixture, body: usize) -> f64 {
    match &fixture.bodies()[body].kind {
        BodyKind::Rigid(rigid) => rigid.inertia.filter(|_| rigid.rotates).map_or(0.0, |q| q.value),
        BodyKind::Beam(beam) => {
            let length = beam.length();
            beam.mass_per_length.value * length.powi(3) / 12.0
        }
    }
}

/// Radius of gyration of a block about its middle, m; `None` of a beam and of what does not turn.
pub(crate) fn radius_of_gyration(fixture: &Fixture, body: usize) -> Option<f64> {
    let BodyKind::Rigid(rigid) = &fixture.bodies()[body].kind else { return None };
    let squared = inertia_of(fixture, body) / rigid.mass.value;
    (squared > 0.0 && squared.is_finite()).then(|| squared.sqrt())
}

/// Whether a body has slopes.
pub(crate) fn turns(fixture: &Fixture, body: usize) -> bool {
    fixture.bodies()[body].kind.rotates()
}

/// Abscissae between which something may sit on a body: a bar of its mass and inertia, and its points.
pub(crate) fn extent(fixture: &Fixture, body: usize) -> (f64, f64) {
    let points = fixture.points().iter().filter(|p| p.body == body).map(|p| p.x.value);
    let (low, high) = points.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    match &fixture.bodies()[body].kind {
        BodyKind::Beam(beam) => (beam.from.value, beam.to.value),
        BodyKind::Rigid(rigid) => match (rigid.rotates, rigid.x_cg, rigid.inertia) {
            (true, Some(x_cg), Some(inertia)) => {
                let half = (3.0 * inertia.value / rigid.mass.value).sqrt();
                (low.min(x_cg.value - half), high.max(x_cg.value + half))
            }
            // Any place of it is as good; one where the structure is can be shown.
            _ if low.is_finite() => (low, high),
            _ => (0.0, 0.0),
        },
    }
}
