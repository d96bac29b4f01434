//! Where the nodes of a beam body lie: at everything that is attached to it, and as close between as its
//! bending waves ask for.

use jointscope_fixture::{BeamBody, BodyKind, Effect, EffectKind, Fixture, Place};
use std::f64::consts::TAU;

/// Fewest and most elements of a deformable body between its attachments.
const ELEMENTS: [f64; 2] = [8.0, 64.0];

/// Element size in units of the bending wave (length over 2π) at [`HIGHEST`]: a natural frequency is then off
/// by 1e-7 or so. A finer mesh of a stiff body would only drown its slow modes in rounding.
const SIZE: f64 = 0.1;

/// Frequency in Hz up to which stiff bodies are meshed finely; the most flexible ones reach the most
/// elements.
const HIGHEST: f64 = 4000.0;

/// Breaks closer than this fraction of the element size share a node: very short elements would spoil the
/// modes of the damping matrix.
const MERGE: f64 = 0.2;

/// Abscissae of the nodes of every body, in the order of the fixture; none for a rigid body.
///
/// There is a node wherever something is attached, effects included, so that the mesh of the assembly without
/// effects is the same.
pub(crate) fn meshes(fixture: &Fixture) -> Vec<Vec<f64>> {
    (0..fixture.bodies().len()).map(|body| mesh(fixture, body)).collect()
}

fn mesh(fixture: &Fixture, body: usize) -> Vec<f64> {
    let BodyKind::Beam(beam) = &fixture.bodies()[body].kind else { return Vec::new() };
    let (from, to) = (beam.from.value, beam.to.value);
    let size = (to - from) / element_count(beam);
    let mut attached = attachments(fixture, body);
    attached.sort_by(f64::total_cmp);
    let mut breaks = vec![from];
    for x in attached {
        let last = breaks.last().copied().unwrap_or(from);
        if x > last + MERGE * size && x < to - MERGE * size {
            breaks.push(x);
        }
    }
    breaks.push(to);
    let mut nodes = vec![from];
    for span in breaks.windows(2) {
        let count = ((span[1] - span[0]) / size).ceil().max(1.0);
        let steps = count as usize;
        nodes.extend((1..=steps).map(|i| span[0] + (span[1] - span[0]) * i as f64 / count));
    }
    nodes
}

fn element_count(beam: &BeamBody) -> f64 {
    let bending_stiffness = beam.youngs_modulus.value * beam.second_moment.value;
    let omega = TAU * HIGHEST;
    let wave_number = (beam.mass_per_length.value * omega * omega / bending_stiffness).sqrt().sqrt();
    let needed = wave_number * beam.length() / SIZE;
    needed.ceil().clamp(ELEMENTS[0], ELEMENTS[1])
}

/// Abscissae on a body where joints, supports, masses, channels or effects act.
fn attachments(fixture: &Fixture, body: usize) -> Vec<f64> {
    let mut all = Vec::new();
    all.extend(fixture.points().iter().filter(|p| p.body == body).map(|p| p.x.value));
    for support in fixture.supports() {
        let (on, x) = fixture.support_place(support);
        if on == body {
            all.push(x);
        }
    }
    all.extend(fixture.bodies()[body].masses.iter().map(|m| m.x.value));
    let name = &fixture.bodies()[body].name;
    let acts_here = |effect: &&Effect| matches!(&effect.place, Place::Body(place) if place == name);
    let has_abscissa = |effect: &&Effect| {
        matches!(effect.kind, EffectKind::AddedMass | EffectKind::Support | EffectKind::AttachedResonator)
    };
    all.extend(fixture.physics().iter().filter(acts_here).filter(has_abscissa).map(|e| e.value(0)));
    all
}
