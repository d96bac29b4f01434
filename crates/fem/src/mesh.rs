//! Meshes of 20-node bricks: blocks, strips and the layers between them.

use crate::brick::{Elasticity, NATURAL, NODES};
use crate::grading::{Ends, distinct, divide};
use crate::{FemError, MeshOptions};
use jointscope_fixture::{Fixture, Geometry};

/// What an element belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BrickOwner {
    /// A body, by index.
    Body(usize),
    /// A joint's strip, by index.
    Joint(usize),
    /// The layer at a joint's start (0) or end (1).
    Layer(usize, usize),
}

/// A brick of the mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Brick {
    /// Its nodes: corners of the lower face, of the upper face, then midsides below, above and upright, as in
    /// the C3D20 of CalculiX.
    pub nodes: [usize; NODES],
    /// Index of its material.
    pub material: usize,
    /// What it belongs to.
    pub part: BrickOwner,
}

/// The assembly as 20-node bricks; where it is cut along z = 0, the nodes there do not move across.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    /// Places of the nodes, m.
    pub nodes: Vec<[f64; 3]>,
    /// The elements.
    pub elements: Vec<Brick>,
    /// Materials by index, as in the fixture's geometry.
    pub materials: Vec<Elasticity>,
    /// Whether the depth is meshed on both sides of z = 0.
    pub whole: bool,
}

/// A box with what it is made of.
struct Solid {
    from: [f64; 3],
    to: [f64; 3],
    material: usize,
    part: BrickOwner,
}

impl Mesh {
    /// Meshes the fixture's geometry.
    ///
    /// # Errors
    /// A fixture without `geometry`, or options that make no mesh.
    pub fn of(fixture: &Fixture, options: &MeshOptions) -> Result<Self, FemError> {
        let geometry = fixture.geometry().ok_or(FemError::NoGeometry)?;
        options.check()?;
        let solids = solids(fixture, geometry);
        let lines =
            [x_lines(fixture, geometry, options), y_lines(geometry, options), z_lines(geometry, options)];
        let cells: usize = lines.iter().map(|l| l.len() - 1).product();
        if cells > MOST_CELLS {
            return Err(FemError::TooFine { elements: cells });
        }
        for (name, material) in &geometry.materials {
            let speed = (material.youngs_modulus.value / material.density.value).sqrt();
            if speed > FASTEST {
                return Err(FemError::Material { name: name.clone(), speed });
            }
        }
        let materials = geometry.materials.iter().map(|(_, m)| Elasticity {
            youngs_modulus: m.youngs_modulus.value,
            poisson_ratio: m.poisson_ratio.value,
            density: m.density.value,
            shear_factor: 1.0,
        });
        let mut mesh = Mesh::on_lines(&lines, &solids, materials.collect(), options.whole);
        options.without.apply(&mut mesh);
        Ok(mesh)
    }

    /// A box of one material, divided evenly: for checks against beam theory.
    pub fn of_box(size: [f64; 3], divisions: [usize; 3], material: Elasticity) -> Self {
        let line = |a: usize| {
            let count = divisions[a].max(1);
            (0..=count)
                .map(|i| size[a] * (i as f64 / count as f64 - if a == 2 { 0.5 } else { 0.0 }))
                .collect()
        };
        let solid = Solid {
            from: [0.0, 0.0, -0.5 * size[2]],
            to: [size[0], size[1], 0.5 * size[2]],
            material: 0,
            part: BrickOwner::Body(0),
        };
        Mesh::on_lines(&[line(0), line(1), line(2)], &[solid], vec![material], true)
    }

    fn on_lines(lines: &[Vec<f64>; 3], solids: &[Solid], materials: Vec<Elasticity>, whole: bool) -> Self {
        let counts = [0, 1, 2].map(|a| lines[a].len() - 1);
        let fine = counts.map(|count| 2 * count + 1);
        let mut numbers = vec![usize::MAX; fine[0] * fine[1] * fine[2]];
        let index = |at: [usize; 3]| (at[0] * fine[1] + at[1]) * fine[2] + at[2];
        let mut cells = Vec::new();
        for i in 0..counts[0] {
            for j in 0..counts[1] {
                for k in 0..counts[2] {
                    let centre =
                        [0, 1, 2].map(|a| 0.5 * (lines[a][[i, j, k][a]] + lines[a][[i, j, k][a] + 1]));
                    let inside = |s: &&Solid| (0..3).all(|a| centre[a] > s.from[a] && centre[a] < s.to[a]);
                    if let Some(solid) = solids.iter().find(inside) {
                        let places = NATURAL
                            .map(|n| index([0, 1, 2].map(|a| 2 * [i, j, k][a] + (n[a] + 1.0) as usize)));
                        places.iter().for_each(|place| numbers[*place] = 0);
                        cells.push((places, solid));
                    }
                }
            }
        }
        let coordinate = |a: usize, half: usize| {
            if half.is_multiple_of(2) {
                lines[a][half / 2]
            } else {
                0.5 * (lines[a][half / 2] + lines[a][half / 2 + 1])
            }
        };
        let mut nodes = Vec::new();
        for i in 0..fine[0] {
            for j in 0..fine[1] {
                for k in 0..fine[2] {
                    let number = &mut numbers[index([i, j, k])];
                    if *number == 0 {
                        *number = nodes.len();
                        nodes.push([coordinate(0, i), coordinate(1, j), coordinate(2, k)]);
                    }
                }
            }
        }
        let element = |(places, solid): ([usize; NODES], &Solid)| Brick {
            nodes: places.map(|place| numbers[place]),
            material: solid.material,
            part: solid.part,
        };
        let elements = cells.into_iter().map(element).collect();
        Mesh { nodes, elements, materials, whole }
    }

    /// The nodes of an element, in space.
    pub fn places(&self, element: &Brick) -> [[f64; 3]; NODES] {
        element.nodes.map(|node| self.nodes[node])
    }

    /// The element of `part` at (x, y, 0), and where it is in natural coordinates; the nearest one for a
    /// place outside.
    pub fn locate(&self, part: BrickOwner, x: f64, y: f64) -> Option<(usize, [f64; 3])> {
        let mut best: Option<(f64, usize, [f64; 3])> = None;
        for (index, element) in self.elements.iter().enumerate().filter(|(_, e)| e.part == part) {
            let (low, high) = (self.nodes[element.nodes[0]], self.nodes[element.nodes[6]]);
            let natural = [0, 1, 2].map(|a| 2.0 * ([x, y, 0.0][a] - low[a]) / (high[a] - low[a]) - 1.0);
            let clamped = [0, 1, 2].map(|a| natural[a].clamp(-1.0, 1.0));
            let outside: f64 =
                (0..3).map(|a| (0.5 * (natural[a] - clamped[a]) * (high[a] - low[a])).powi(2)).sum();
            if best.is_none_or(|(distance, ..)| outside < distance) {
                best = Some((outside, index, clamped));
            }
        }
        best.map(|(_, index, natural)| (index, natural))
    }
}

/// Speed of sound in a material at the most, m/s, fifty times that of diamond: above, the modes lose their
/// digits.
const FASTEST: f64 = 1e6;

/// More elements than any machine here factorises.
const MOST_CELLS: usize = 200_000;

fn solids(fixture: &Fixture, geometry: &Geometry) -> Vec<Solid> {
    let boxed = |x: [f64; 2], y: f64, height: f64, depth: f64, material: usize, part: BrickOwner| Solid {
        from: [x[0], y - 0.5 * height, -0.5 * depth],
        to: [x[1], y + 0.5 * height, 0.5 * depth],
        material,
        part,
    };
    let bodies = geometry.bodies.iter().enumerate().map(|(index, body)| {
        let x = [body.from.value, body.to.value];
        boxed(x, body.y.value, body.height.value, body.depth.value, body.material, BrickOwner::Body(index))
    });
    let mut solids: Vec<Solid> = bodies.collect();
    for (index, strip) in geometry.joints.iter().enumerate() {
        let [start, end] = strip_ends(fixture, geometry, index);
        let layer = |side: usize| strip.interfaces[side].as_ref().map_or(0.0, |layer| layer.thickness.value);
        let (inner, outer) =
            ([start + layer(0), end - layer(1)], [[start, start + layer(0)], [end - layer(1), end]]);
        let section = |x: [f64; 2], material: usize, part: BrickOwner| {
            boxed(x, strip.y.value, strip.thickness.value, strip.width.value, material, part)
        };
        solids.push(section(inner, strip.material, BrickOwner::Joint(index)));
        for (side, interface) in strip.interfaces.iter().enumerate() {
            if let Some(interface) = interface {
                solids.push(section(outer[side], interface.material, BrickOwner::Layer(index, side)));
            }
        }
    }
    solids
}

/// Faces between which a strip lies.
fn strip_ends(fixture: &Fixture, geometry: &Geometry, joint: usize) -> [f64; 2] {
    let joint = &fixture.joints()[joint];
    let body = |point: usize| &geometry.bodies[fixture.points()[point].body];
    [body(joint.from).to.value, body(joint.to).from.value]
}

/// Divides between `stops`; `fine` gives the element size at a stop, where it is to be small, `longest` the
/// largest size of an interval.
fn lines(
    stops: Vec<f64>,
    fine: impl Fn(f64) -> Option<f64>,
    longest: impl Fn(f64, f64) -> f64,
    growth: f64,
) -> Vec<f64> {
    let stops = distinct(stops);
    let mut lines = Vec::new();
    for pair in stops.windows(2) {
        lines.push(pair[0]);
        let ends = Ends { start: fine(pair[0]), end: fine(pair[1]) };
        lines.extend(divide(pair[0], pair[1], ends, growth, longest(pair[0], pair[1])));
    }
    lines.extend(stops.last());
    lines
}

fn x_lines(fixture: &Fixture, geometry: &Geometry, options: &MeshOptions) -> Vec<f64> {
    let mut stops: Vec<f64> = geometry.bodies.iter().flat_map(|b| [b.from.value, b.to.value]).collect();
    // Where strips and layers end, with the element size there; strips, with the longest element in them.
    let mut fine: Vec<(f64, f64)> = Vec::new();
    let mut strips: Vec<([f64; 2], f64)> = Vec::new();
    for (index, strip) in geometry.joints.iter().enumerate() {
        let [start, end] = strip_ends(fixture, geometry, index);
        let size = strip.thickness.value / options.corner as f64;
        let mut inner = [start, end];
        for (side, sign) in [(0, 1.0), (1, -1.0)] {
            fine.push((inner[side], size));
            if let Some(layer) = &strip.interfaces[side] {
                inner[side] += sign * layer.thickness.value;
                fine.push((inner[side], size));
            }
        }
        stops.extend([start, end, inner[0], inner[1]]);
        strips.push(([start, end], (end - start) / options.along as f64));
    }
    let near = |x: f64| {
        fine.iter()
            .filter(|(at, _)| (at - x).abs() < 1e-9 * (1.0 + x.abs()))
            .map(|(_, size)| *size)
            .reduce(f64::min)
    };
    let longest = |from: f64, to: f64| {
        let inside = |([start, end], _): &&([f64; 2], f64)| from >= start - 1e-12 && to <= end + 1e-12;
        strips
            .iter()
            .filter(inside)
            .map(|(_, longest)| *longest)
            .reduce(f64::min)
            .unwrap_or(0.5 * (to - from))
    };
    lines(stops, near, longest, options.growth)
}

fn y_lines(geometry: &Geometry, options: &MeshOptions) -> Vec<f64> {
    let faces = |y: f64, height: f64| [y - 0.5 * height, y + 0.5 * height];
    let mut stops: Vec<f64> = geometry.bodies.iter().flat_map(|b| faces(b.y.value, b.height.value)).collect();
    let strips: Vec<([f64; 2], f64)> = geometry
        .joints
        .iter()
        .map(|j| (faces(j.y.value, j.thickness.value), j.thickness.value / options.corner as f64))
        .collect();
    stops.extend(strips.iter().flat_map(|(faces, _)| *faces));
    let near = |y: f64| {
        let touches =
            |(faces, _): &&([f64; 2], f64)| faces.iter().any(|f| (f - y).abs() < 1e-9 * (1.0 + y.abs()));
        strips.iter().filter(touches).map(|(_, size)| *size).reduce(f64::min)
    };
    // Bending is cubic along the strip and linear through it: an element or two through the thickness are
    // enough for that.
    let longest = |from: f64, to: f64| 0.5 * (to - from);
    lines(stops, near, longest, options.growth)
}

fn z_lines(geometry: &Geometry, options: &MeshOptions) -> Vec<f64> {
    let mut stops = vec![0.0];
    stops.extend(geometry.bodies.iter().map(|b| 0.5 * b.depth.value));
    let strips: Vec<(f64, f64)> = geometry
        .joints
        .iter()
        .map(|j| (0.5 * j.width.value, 0.5 * j.width.value / options.across as f64))
        .collect();
    stops.extend(strips.iter().map(|(half, _)| *half));
    let near = |z: f64| {
        strips.iter().filter(|(half, _)| (half - z).abs() < 1e-9).map(|(_, size)| *size).reduce(f64::min)
    };
    let longest = |_: f64, to: f64| {
        let within = |(half, _): &&(f64, f64)| to <= half + 1e-12;
        strips.iter().filter(within).map(|(_, size)| *size).reduce(f64::min).unwrap_or(0.5 * to)
    };
    let half = lines(stops, near, longest, options.growth);
    if !options.whole {
        return half;
    }
    half[1..].iter().rev().map(|z| -z).chain(half.iter().copied()).collect()
}
