//! What the strip's footings yield, from a static solve of the solid.
//!
//! A lumped strip seen from its far end has the flexibility C = [[L³/3EI, L²/2EI], [L²/2EI, L/EI]] + c₁·[[L²,
//! L], [L, 1]] + c₂·[[0, 0], [0, 1]] + c_s·[[1, 0], [0, 0]], c₁ and c₂ being the rotational compliances of
//! its footings and c_s that of its shear. The solid's C under a moment and under a force tells them apart.

use super::assembly::Assembly;
use super::footings::Footings;
use crate::GenerationError;
use jointscope_fem::Twin;

/// Shares of a block's length, from its outer end, at which forces act, and at which its motion is read.
const LOADED: [f64; 2] = [0.05, 0.65];
const READ: [f64; 2] = [0.25, 0.45];

impl Footings {
    /// Those of a solid's twin.
    pub(super) fn of(assembly: &Assembly, twin: &Twin) -> Result<Self, GenerationError> {
        let flexibility = Flexibility::of(assembly, twin)?;
        let strip = &assembly.strip;
        let (length, bending) = (strip.length, assembly.factor * strip.modulus() * strip.second_moment());
        let start = (flexibility.coupled - length.powi(2) / (2.0 * bending)) / length;
        Ok(Footings {
            rotation: [start, flexibility.rotation - length / bending - start],
            across: flexibility.translation - length.powi(3) / (3.0 * bending) - length * length * start,
        })
    }
}

/// The joint's flexibility at its far end.
struct Flexibility {
    translation: f64,
    coupled: f64,
    rotation: f64,
}

impl Flexibility {
    fn of(assembly: &Assembly, twin: &Twin) -> Result<Self, GenerationError> {
        let [a, b] = &assembly.blocks;
        let far = b.left;
        let at = |shares: [f64; 2]| [shares.map(|s| a.at(s)), shares.map(|s| b.at(1.0 - s))];
        let ([on_a, on_b], [from_a, from_b]) = (at(LOADED), at(READ));
        // Two forces with this resultant and moment about the strip's far end.
        let pair = |on: [f64; 2], force: f64, moment: f64| {
            let second = (moment - force * (on[0] - far)) / (on[1] - on[0]);
            [force - second, second]
        };
        let moved = |force: f64, moment: f64| -> Result<[f64; 2], GenerationError> {
            let [on_b_first, on_b_second] = pair(on_b, force, moment);
            let [on_a_first, on_a_second] = pair(on_a, -force, -moment);
            let forces = [
                (0, on_a[0], on_a_first),
                (0, on_a[1], on_a_second),
                (1, on_b[0], on_b_first),
                (1, on_b[1], on_b_second),
            ];
            let places = [(0, from_a[0]), (0, from_a[1]), (1, from_b[0]), (1, from_b[1])];
            let read = twin.deflections(&forces, &places)?;
            // Either block's line, continued to the strip's far end.
            let line = |x: [f64; 2], y: [f64; 2]| {
                let slope = (y[1] - y[0]) / (x[1] - x[0]);
                [y[0] + slope * (far - x[0]), slope]
            };
            let (a, b) = (line(from_a, [read[0], read[1]]), line(from_b, [read[2], read[3]]));
            Ok([b[0] - a[0], b[1] - a[1]])
        };
        let ([coupled, rotation], [translation, _]) = (moved(0.0, 1.0)?, moved(1.0, 0.0)?);
        Ok(Flexibility { translation, coupled, rotation })
    }
}
