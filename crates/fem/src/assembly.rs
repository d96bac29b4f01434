//! Mass and stiffness of a mesh over its free equations.

use crate::brick::{self, EQUATIONS, NODES, gradient_in_space, shape};
use crate::{BrickOwner, FemError, Mesh};
use jointscope_linalg::{SparsePattern, SparseSymmetric};

/// Mass and stiffness of a mesh over its free equations.
pub struct Matrices {
    /// K, N/m.
    pub stiffness: SparseSymmetric,
    /// M, kg.
    pub mass: SparseSymmetric,
    /// Equation of each displacement, three a node; `None` where it is held.
    pub equations: Vec<Option<usize>>,
    /// Motions that strain nothing: of each connected piece, those that its supports allow.
    pub rigid: Vec<Vec<f64>>,
}

impl Matrices {
    /// Assembles a mesh. Held are displacements across the plane z = 0 of a mesh cut there, and what `held`
    /// says of (node's place, direction).
    ///
    /// # Errors
    /// An element with a Jacobian that is not positive.
    pub fn of(mesh: &Mesh, held: impl Fn([f64; 3], usize) -> bool) -> Result<Self, FemError> {
        let depth = mesh.nodes.iter().fold(0.0_f64, |m, n| m.max(n[2].abs()));
        let mut equations = Vec::with_capacity(3 * mesh.nodes.len());
        let mut order = 0;
        let mut any_held = false;
        for place in &mesh.nodes {
            for direction in 0..3 {
                let mirrored = !mesh.whole && direction == 2 && place[2].abs() <= 1e-9 * depth;
                let outside = held(*place, direction);
                any_held |= outside;
                equations.push((!mirrored && !outside).then_some(order));
                order += usize::from(!mirrored && !outside);
            }
        }
        let of_element = |nodes: &[usize; NODES]| -> Vec<Option<usize>> {
            nodes.iter().flat_map(|n| equations[3 * n..3 * n + 3].iter().copied()).collect()
        };
        let elements: Vec<Vec<Option<usize>>> = mesh.elements.iter().map(|e| of_element(&e.nodes)).collect();
        let coupled: Vec<Vec<usize>> =
            elements.iter().map(|e| e.iter().flatten().copied().collect()).collect();
        let pattern = SparsePattern::of_elements(order, coupled.iter().map(Vec::as_slice))?;
        drop(coupled);
        let (mut stiffness, mut mass) = (SparseSymmetric::zero(&pattern), SparseSymmetric::zero(&pattern));
        for (index, (element, equations)) in mesh.elements.iter().zip(&elements).enumerate() {
            let (k, m) = brick::matrices(&mesh.places(element), &mesh.materials[element.material])
                .map_err(|_| FemError::Degenerate { element: index })?;
            stiffness.add_element(equations, &k)?;
            mass.add_element(equations, &m)?;
        }
        let rigid = if any_held { Vec::new() } else { rigid_motions(mesh, &equations, order) };
        Ok(Matrices { stiffness, mass, equations, rigid })
    }

    /// Number of equations.
    pub fn order(&self) -> usize {
        self.stiffness.order()
    }

    /// Displacements of all nodes for a vector over the equations; zero where held.
    pub fn displacements(&self, vector: &[f64]) -> Vec<f64> {
        self.equations.iter().map(|equation| equation.map_or(0.0, |e| vector[e])).collect()
    }

    /// The functional that reads the transverse displacement (or the slope ∂v/∂x) of `part` at (x, y, 0), as
    /// (equation, weight).
    pub fn observation(
        &self,
        mesh: &Mesh,
        part: BrickOwner,
        x: f64,
        y: f64,
        slope: bool,
    ) -> Option<Vec<(usize, f64)>> {
        let (index, natural) = mesh.locate(part, x, y)?;
        let element = &mesh.elements[index];
        let weights = if slope {
            gradient_in_space(&mesh.places(element), natural).ok()?.0.map(|gradient| gradient[0])
        } else {
            shape(natural)
        };
        let entries = element.nodes.iter().zip(weights).filter(|(_, weight)| *weight != 0.0);
        Some(entries.filter_map(|(node, weight)| Some((self.equations[3 * node + 1]?, weight))).collect())
    }

    /// Strain energy of a displacement field over its kinetic energy at 1 rad/s: its eigenvalue by Rayleigh's
    /// quotient, (rad/s)², the strains taken element by element so that rigid motions come out as what they
    /// are.
    pub fn rayleigh_quotient(&self, mesh: &Mesh, vector: &[f64]) -> f64 {
        let displacement = self.displacements(vector);
        let mut energy = 0.0;
        for element in &mesh.elements {
            let mut own = [0.0; EQUATIONS];
            for (place, node) in element.nodes.iter().enumerate() {
                own[3 * place..3 * place + 3].copy_from_slice(&displacement[3 * node..3 * node + 3]);
            }
            // Elements were found to be sound when they were assembled.
            energy += brick::strain_energy(&mesh.places(element), &mesh.materials[element.material], &own)
                .unwrap_or(f64::INFINITY);
        }
        energy / self.mass.quadratic(vector)
    }
}

/// Motions without strain of each connected piece: u, v and the rotation in the plane; w and the other
/// rotations where the depth is whole.
fn rigid_motions(mesh: &Mesh, equations: &[Option<usize>], order: usize) -> Vec<Vec<f64>> {
    let pieces = pieces(mesh);
    let motions: &[usize] = if mesh.whole { &[0, 1, 2, 3, 4, 5] } else { &[0, 1, 5] };
    let count = pieces.iter().max().map_or(0, |last| last + 1);
    let mut rigid = Vec::new();
    for piece in 0..count {
        let members: Vec<usize> = (0..pieces.len()).filter(|n| pieces[*n] == piece).collect();
        let centre =
            [0, 1, 2].map(|a| members.iter().map(|n| mesh.nodes[*n][a]).sum::<f64>() / members.len() as f64);
        for &motion in motions {
            let mut vector = vec![0.0; order];
            for &node in &members {
                let x = [0, 1, 2]
                    .map(|a| mesh.nodes[node][a] - if mesh.whole || a < 2 { centre[a] } else { 0.0 });
                for (a, value) in rigid_motion(motion, x).into_iter().enumerate() {
                    if let Some(equation) = equations[3 * node + a] {
                        vector[equation] = value;
                    }
                }
            }
            rigid.push(vector);
        }
    }
    rigid
}

/// Translations along x, y, z, and rotations about them.
pub(crate) fn rigid_motion(motion: usize, x: [f64; 3]) -> [f64; 3] {
    let mut u = [0.0; 3];
    if motion < 3 {
        u[motion] = 1.0;
    } else {
        let (a, b) = ((motion + 1) % 3, (motion + 2) % 3);
        (u[a], u[b]) = (-x[b], x[a]);
    }
    u
}

/// The connected piece that each node belongs to, numbered from 0.
fn pieces(mesh: &Mesh) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..mesh.nodes.len()).collect();
    fn root(parent: &mut [usize], mut node: usize) -> usize {
        while parent[node] != node {
            parent[node] = parent[parent[node]];
            node = parent[node];
        }
        node
    }
    for element in &mesh.elements {
        for node in &element.nodes[1..] {
            let (one, other) = (root(&mut parent, element.nodes[0]), root(&mut parent, *node));
            parent[one.max(other)] = one.min(other);
        }
    }
    let mut numbers = vec![usize::MAX; mesh.nodes.len()];
    let mut next = 0;
    (0..mesh.nodes.len())
        .map(|node| {
            let root = root(&mut parent, node);
            if numbers[root] == usize::MAX {
                numbers[root] = next;
                next += 1;
            }
            numbers[root]
        })
        .collect()
}
