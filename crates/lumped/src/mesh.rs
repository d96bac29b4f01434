//! Finite-element mesh of a deformable body.

use crate::condensed::{LONGEST, Stretch};
use jointscope_beam::shape_functions;
use jointscope_spectra::Dof;
use std::f64::consts::TAU;

/// Longest element, as βh at the highest line: Hermite elements are then right to about 1e-6 in frequency.
const ELEMENT_WAVE: f64 = 0.35;
/// Fewest elements of a body, for bodies that hardly bend within the band.
const FEWEST: f64 = 8.0;
/// Parts of an element to which nodes are rounded at attachments that do not turn the beam: one that moves a
/// little leaves the mesh, and with it the modes, as they are. What an element yields to a force between node
/// and attachment is less than a hundredth of what it does at its middle; to a moment it would not be.
const PARTS: f64 = 8.0;
/// A node is set at an attachment only if no other is nearer than this many of those parts: very short
/// elements ruin the eigenproblem's accuracy.
const NEAREST: f64 = 2.0;
/// Most elements of a body: its modes come from a dense eigenproblem.
pub(crate) const MOST: usize = 256;

/// Nodes of a beam, ascending, m.
#[derive(Debug, Clone)]
pub(crate) struct Mesh {
    pub nodes: Vec<f64>,
    /// Nodes as shares of the length.
    pub unit: Vec<f64>,
    /// Which nodes stretches end at: where something is attached, and in between.
    ends: Vec<usize>,
    /// EI/κGA, m², by which sections turn less than the beam slopes; zero without shear.
    pub shear: f64,
}

/// Where something holds a beam.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Attachment {
    /// m.
    pub x: f64,
    /// Whether it acts against rotation too.
    pub turns: bool,
}

impl Mesh {
    /// Meshes the beam from `from` to `to` with EI and mass per length, fine enough for `highest_hz`, with
    /// nodes all but at the `attachments` in their order of importance.
    ///
    /// # Errors
    /// The number of elements that would be needed, where that is more than [`MOST`].
    pub(crate) fn new(
        from: f64,
        to: f64,
        bending_stiffness: f64,
        mass_per_length: f64,
        highest_hz: f64,
        attachments: &[Attachment],
    ) -> Result<Self, f64> {
        let omega = TAU * highest_hz;
        let wave_number = (omega * omega * mass_per_length / bending_stiffness).sqrt().sqrt();
        let longest = ((to - from) / FEWEST).min(ELEMENT_WAVE / wave_number.max(1e-9));
        let needed = (to - from) / longest;
        if needed.is_nan() || needed > MOST as f64 {
            return Err(needed);
        }
        // In parts of an equal division of the whole length.
        let elements = needed.ceil();
        let parts = PARTS * elements;
        let part = |at: &Attachment| {
            let exact = parts * (at.x - from) / (to - from);
            if at.turns { exact } else { exact.round() }
        };
        let mut nodes = vec![0.0, parts];
        for at in attachments.iter().map(part) {
            if nodes.iter().all(|n| (n - at).abs() >= NEAREST) && at > 0.0 && at < parts {
                nodes.push(at);
            }
        }
        nodes.sort_by(f64::total_cmp);
        let (mut mesh, mut ends) = (vec![0.0], vec![0]);
        for pair in nodes.windows(2) {
            let count = ((pair[1] - pair[0]) / PARTS).ceil();
            let (before, elements) = (mesh.len() - 1, count as usize);
            mesh.extend((1..=elements).map(|i| pair[0] + (pair[1] - pair[0]) * i as f64 / count));
            let stretches = elements.div_ceil(LONGEST);
            ends.extend((1..=stretches).map(|i| before + i * elements / stretches));
        }
        let unit: Vec<f64> = mesh.iter().map(|node| node / parts).collect();
        let nodes = unit.iter().map(|share| from + (to - from) * share).collect();
        Ok(Mesh { nodes, unit, ends, shear: 0.0 })
    }

    /// All elements in stretches, of a beam whose coordinates begin with `first`.
    pub(crate) fn stretches(&self, first: usize) -> impl Iterator<Item = Stretch> {
        let stretch = move |pair: &[usize]| Stretch {
            first: first + 2 * pair[0],
            nodes: self.nodes[pair[0]..=pair[1]].to_vec(),
        };
        self.ends.windows(2).map(stretch)
    }

    /// m.
    pub(crate) fn length(&self) -> f64 {
        self.nodes[self.nodes.len() - 1] - self.nodes[0]
    }

    /// Number of coordinates: y and θ of each node.
    pub(crate) fn coordinates(&self) -> usize {
        2 * self.nodes.len()
    }

    /// Adds the shape-function values at `x` to `row`, which covers the body's coordinates. Beyond the
    /// ends the beam goes on along its tangent.
    pub(crate) fn interpolate(&self, x: f64, dof: Dof, row: &mut [f64]) {
        let last = self.nodes.len() - 2;
        let element = self.nodes.partition_point(|&n| n <= x).saturating_sub(1).min(last);
        let (left, right) = (self.nodes[element], self.nodes[element + 1]);
        let inside = x.clamp(left, right);
        let [deflection, slope] = match self.shear {
            0.0 => shape_functions(inside - left, right - left),
            shear => sheared_functions(inside - left, right - left, shear),
        };
        for k in 0..4 {
            row[2 * element + k] += match dof {
                Dof::Translation => deflection[k] + slope[k] * (x - inside),
                Dof::Rotation => slope[k],
            };
        }
    }
}

/// As [`shape_functions`], of an element that shears: its deflection, and the rotation of its section.
fn sheared_functions(position: f64, length: f64, shear: f64) -> [[f64; 4]; 2] {
    let (l, t) = (length, position / length);
    let ratio = 12.0 * shear / (l * l);
    let factor = 1.0 / (1.0 + ratio);
    let bubble = 0.5 * ratio * t * (1.0 - t);
    [
        [
            1.0 - 3.0 * t * t + 2.0 * t.powi(3) + ratio * (1.0 - t),
            l * (t - 2.0 * t * t + t.powi(3) + bubble),
            3.0 * t * t - 2.0 * t.powi(3) + ratio * t,
            l * (t.powi(3) - t * t - bubble),
        ],
        [
            6.0 * (t * t - t) / l,
            1.0 - 4.0 * t + 3.0 * t * t + ratio * (1.0 - t),
            6.0 * (t - t * t) / l,
            3.0 * t * t - 2.0 * t + ratio * t,
        ],
    ]
    .map(|row| row.map(|value| factor * value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_element_that_shears_hardly_bends_as_one_that_does_not_and_moves_rigidly() {
        let stiff = sheared_functions(0.03, 0.1, 1e-12);
        let plain = shape_functions(0.03, 0.1);
        assert!((0..4).all(|k| (stiff[0][k] - plain[0][k]).abs() < 1e-7 && (stiff[1][k] - plain[1][k]).abs() < 1e-5));
        // y = 2 + 3x, θ = 3 at both ends.
        let rigid = [2.0, 3.0, 2.3, 3.0];
        let soft = sheared_functions(0.03, 0.1, 0.02);
        let read = |row: [f64; 4]| row.iter().zip(rigid).map(|(n, u)| n * u).sum::<f64>();
        assert!((read(soft[0]) - 2.09).abs() < 1e-12 && (read(soft[1]) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn nodes_sit_at_attachments_that_turn_the_beam_unless_two_are_all_but_the_same() {
        let turning = [0.333, 0.3331, 0.9999].map(|x| Attachment { x, turns: true });
        let mesh = Mesh::new(0.0, 1.0, 1e3, 1.0, 100.0, &turning).unwrap();
        let has = |x: f64| mesh.nodes.iter().any(|node| (node - x).abs() < 1e-12);
        assert!(has(0.333) && !has(0.3331) && !has(0.9999));
        assert!(mesh.nodes.windows(2).all(|w| w[1] > w[0]));
    }

    #[test]
    fn a_support_that_moves_a_little_leaves_the_mesh_as_it_is() {
        let mesh = |x| Mesh::new(0.0, 1.0, 1e3, 1.0, 100.0, &[Attachment { x, turns: false }]).unwrap();
        assert_eq!(mesh(0.333).unit, mesh(0.334).unit);
        let near = |x: f64| mesh(x).nodes.iter().map(|node| (node - x).abs()).fold(1.0, f64::min);
        assert!(
            (0..50).all(|k| near(0.2 + 0.01 * f64::from(k)) < 0.009),
            "an element is an eighth, a part a sixty-fourth"
        );
    }

    #[test]
    fn a_beam_that_bends_too_easily_for_its_band_is_told_instead_of_meshed() {
        let elements = Mesh::new(0.0, 1.0, 1e-12, 1.0, 1e3, &[]).map(|_| ()).unwrap_err();
        assert!(elements > 1e5, "{elements}");
    }

    #[test]
    fn a_higher_band_asks_for_more_elements() {
        let count = |hz| Mesh::new(0.0, 1.0, 1e3, 1.0, hz, &[]).unwrap().nodes.len();
        assert!(count(5000.0) > 2 * count(500.0));
    }
}
