//! The 20-node serendipity brick: shape functions, stiffness and consistent mass.

/// Nodes of an element.
pub(crate) const NODES: usize = 20;

/// Equations of an element: three displacements a node, node after node.
pub(crate) const EQUATIONS: usize = 3 * NODES;

/// Natural coordinates of the nodes: corners of the lower face, of the upper face, midsides of the lower
/// face, of the upper face, of the upright edges. This is the order of Abaqus' and CalculiX' C3D20.
pub(crate) const NATURAL: [[f64; 3]; NODES] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [0.0, -1.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, -1.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [-1.0, 0.0, 1.0],
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
];

/// Elastic constants of an isotropic material in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elasticity {
    /// Young's modulus, N/m².
    pub youngs_modulus: f64,
    /// Poisson's ratio.
    pub poisson_ratio: f64,
    /// Density, kg/m³.
    pub density: f64,
    /// Factor of the shear modulus in the plane x, y; one for a real material.
    pub shear_factor: f64,
}

impl Elasticity {
    /// Lamé's constants λ and μ, N/m².
    fn lame(&self) -> (f64, f64) {
        let (e, nu) = (self.youngs_modulus, self.poisson_ratio);
        (e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 * e / (1.0 + nu))
    }
}

/// Shape functions N_i at natural coordinates.
pub(crate) fn shape(at: [f64; 3]) -> [f64; NODES] {
    NATURAL.map(|node| {
        let factor = |a: usize| if node[a] == 0.0 { 1.0 - at[a] * at[a] } else { 1.0 + node[a] * at[a] };
        let product = factor(0) * factor(1) * factor(2);
        if is_corner(&node) {
            let sum: f64 = (0..3).map(|a| node[a] * at[a]).sum();
            0.125 * product * (sum - 2.0)
        } else {
            0.25 * product
        }
    })
}

/// ∂N_i/∂ξ_a at natural coordinates.
pub(crate) fn shape_gradient(at: [f64; 3]) -> [[f64; 3]; NODES] {
    NATURAL.map(|node| {
        let factor = |a: usize| if node[a] == 0.0 { 1.0 - at[a] * at[a] } else { 1.0 + node[a] * at[a] };
        let slope = |a: usize| if node[a] == 0.0 { -2.0 * at[a] } else { node[a] };
        let f = [factor(0), factor(1), factor(2)];
        let product_slope = |a: usize| slope(a) * f[(a + 1) % 3] * f[(a + 2) % 3];
        if is_corner(&node) {
            let sum: f64 = (0..3).map(|a| node[a] * at[a]).sum();
            let product = f[0] * f[1] * f[2];
            [0, 1, 2].map(|a| 0.125 * (product_slope(a) * (sum - 2.0) + product * node[a]))
        } else {
            [0, 1, 2].map(|a| 0.25 * product_slope(a))
        }
    })
}

fn is_corner(node: &[f64; 3]) -> bool {
    node.iter().all(|x| *x != 0.0)
}

/// Three Gauss points a direction: exact for the stiffness and the mass of a box.
const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

/// An element with a Jacobian that is not positive somewhere: its nodes are out of order or too distorted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Degenerate;

/// Gradients ∂N_i/∂x_a of the shape functions in space, and the Jacobian's determinant (m³ per natural
/// volume).
pub(crate) fn gradient_in_space(
    nodes: &[[f64; 3]; NODES],
    at: [f64; 3],
) -> Result<([[f64; 3]; NODES], f64), Degenerate> {
    let natural = shape_gradient(at);
    // J_ab = ∂x_b/∂ξ_a
    let mut j = [[0.0; 3]; 3];
    for (gradient, node) in natural.iter().zip(nodes) {
        for a in 0..3 {
            for b in 0..3 {
                j[a][b] += gradient[a] * node[b];
            }
        }
    }
    let cofactor = |a: usize, b: usize| {
        let (a1, a2, b1, b2) = ((a + 1) % 3, (a + 2) % 3, (b + 1) % 3, (b + 2) % 3);
        j[a1][b1] * j[a2][b2] - j[a1][b2] * j[a2][b1]
    };
    let determinant = (0..3).map(|b| j[0][b] * cofactor(0, b)).sum::<f64>();
    if !(determinant > 0.0 && determinant.is_finite()) {
        return Err(Degenerate);
    }
    // ∂N/∂x_b = Σ_a (J⁻¹)_ba ∂N/∂ξ_a, (J⁻¹)_ba = cofactor(a, b) / det
    let inverse: [[f64; 3]; 3] = [0, 1, 2].map(|b| [0, 1, 2].map(|a| cofactor(a, b) / determinant));
    let gradients = natural.map(|g| [0, 1, 2].map(|b| (0..3).map(|a| inverse[b][a] * g[a]).sum()));
    Ok((gradients, determinant))
}

/// Stiffness and consistent mass of an element with these nodes, row-major of order [`EQUATIONS`], by 3×3×3
/// Gauss points.
pub(crate) fn matrices(
    nodes: &[[f64; 3]; NODES],
    material: &Elasticity,
) -> Result<(Vec<f64>, Vec<f64>), Degenerate> {
    let (lambda, mu) = material.lame();
    let mut stiffness = vec![0.0; EQUATIONS * EQUATIONS];
    let mut mass = [[0.0; NODES]; NODES];
    for (x, wx) in GAUSS {
        for (y, wy) in GAUSS {
            for (z, wz) in GAUSS {
                let (g, determinant) = gradient_in_space(nodes, [x, y, z])?;
                let n = shape([x, y, z]);
                let weight = wx * wy * wz * determinant;
                for i in 0..NODES {
                    for k in 0..=i {
                        mass[i][k] += weight * material.density * n[i] * n[k];
                        // ∫ λ ∂_a N_i ∂_b N_k + μ (∂_b N_i ∂_a N_k + δ_ab ∇N_i·∇N_k)
                        let laplace: f64 = (0..3).map(|a| g[i][a] * g[k][a]).sum();
                        let extra_shear = (material.shear_factor - 1.0) * mu;
                        for a in 0..3 {
                            for b in 0..3 {
                                let mut value = lambda * g[i][a] * g[k][b] + mu * g[i][b] * g[k][a];
                                if a == b {
                                    value += mu * laplace;
                                }
                                if a < 2 && b < 2 {
                                    // γ_xy = ∂u/∂y + ∂v/∂x
                                    value += extra_shear * g[i][1 - a] * g[k][1 - b];
                                }
                                stiffness[(3 * i + a) * EQUATIONS + 3 * k + b] += weight * value;
                            }
                        }
                    }
                }
            }
        }
    }
    let mut full_mass = vec![0.0; EQUATIONS * EQUATIONS];
    for i in 0..EQUATIONS {
        for k in 0..EQUATIONS {
            if k / 3 > i / 3 {
                stiffness[i * EQUATIONS + k] = stiffness[k * EQUATIONS + i];
            }
            if i % 3 == k % 3 {
                let (row, column) = ((i / 3).max(k / 3), (i / 3).min(k / 3));
                full_mass[i * EQUATIONS + k] = mass[row][column];
            }
        }
    }
    Ok((stiffness, full_mass))
}

/// Strain energy (twice, J) of a displacement field given node by node, from the strains at the Gauss points:
/// a rigid motion has none but for rounding squared, where the element's matrix would leave rounding itself.
pub(crate) fn strain_energy(
    nodes: &[[f64; 3]; NODES],
    material: &Elasticity,
    displacement: &[f64; EQUATIONS],
) -> Result<f64, Degenerate> {
    let (lambda, mu) = material.lame();
    let mut energy = 0.0;
    for (x, wx) in GAUSS {
        for (y, wy) in GAUSS {
            for (z, wz) in GAUSS {
                let (g, determinant) = gradient_in_space(nodes, [x, y, z])?;
                let slope =
                    |a: usize, b: usize| (0..NODES).map(|i| displacement[3 * i + a] * g[i][b]).sum::<f64>();
                let strain: [[f64; 3]; 3] =
                    [0, 1, 2].map(|a| [0, 1, 2].map(|b| 0.5 * (slope(a, b) + slope(b, a))));
                let trace = strain[0][0] + strain[1][1] + strain[2][2];
                let squares: f64 = strain.iter().flatten().map(|e| e * e).sum();
                let extra_shear = 4.0 * (material.shear_factor - 1.0) * mu * strain[0][1] * strain[0][1];
                energy +=
                    wx * wy * wz * determinant * (lambda * trace * trace + 2.0 * mu * squares + extra_shear);
            }
        }
    }
    Ok(energy)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::rigid_motion;
    use proptest::prelude::*;

    const STEEL: Elasticity =
        Elasticity { youngs_modulus: 2.07e11, poisson_ratio: 0.3, density: 7850.0, shear_factor: 1.7 };

    /// A box whose corners were pushed about, its midside nodes halfway along the edges.
    fn distorted(push: &[f64]) -> [[f64; 3]; NODES] {
        let mut nodes = NATURAL.map(|n| n.map(|x| 0.01 * x));
        for (i, push) in push.chunks(3).enumerate() {
            (0..3).for_each(|a| nodes[i][a] += 0.002 * push[a]);
        }
        for i in 8..NODES {
            let ends: Vec<usize> = (0..8)
                .filter(|c| (0..3).all(|a| NATURAL[i][a] == 0.0 || NATURAL[i][a] == NATURAL[*c][a]))
                .collect();
            nodes[i] = [0, 1, 2].map(|a| 0.5 * (nodes[ends[0]][a] + nodes[ends[1]][a]));
        }
        nodes
    }

    #[test]
    fn a_shape_function_is_one_at_its_node_and_zero_at_the_others() {
        for (i, at) in NATURAL.iter().enumerate() {
            for (k, value) in shape(*at).iter().enumerate() {
                assert!((value - f64::from(i == k)).abs() < 1e-15, "N{k} at node {i}: {value}");
            }
        }
    }

    #[test]
    fn a_mirrored_element_is_refused() {
        let nodes = NATURAL.map(|[x, y, z]| [-x, y, z]);
        assert_eq!(matrices(&nodes, &STEEL).err(), Some(Degenerate));
    }

    proptest! {
        #[test]
        fn gradients_are_the_slopes_of_the_shape_functions(at in prop::array::uniform3(-0.9f64..0.9)) {
            let gradient = shape_gradient(at);
            for a in 0..3 {
                let (mut up, mut down) = (at, at);
                up[a] += 1e-5;
                down[a] -= 1e-5;
                for ((g, u), d) in gradient.iter().zip(shape(up)).zip(shape(down)) {
                    prop_assert!((g[a] - (u - d) / 2e-5).abs() < 1e-8);
                }
            }
        }

        #[test]
        fn the_energy_of_the_strains_is_that_of_the_matrix(push in prop::collection::vec(-1.0f64..1.0, 24), u in prop::collection::vec(-1e-3f64..1e-3, EQUATIONS)) {
            let nodes = distorted(&push);
            let (stiffness, _) = matrices(&nodes, &STEEL).unwrap();
            let quadratic: f64 = stiffness.chunks(EQUATIONS).zip(&u).map(|(row, v)| v * row.iter().zip(&u).map(|(k, u)| k * u).sum::<f64>()).sum();
            let own: [f64; EQUATIONS] = u.try_into().unwrap();
            prop_assert!((strain_energy(&nodes, &STEEL, &own).unwrap() / quadratic - 1.0).abs() < 1e-10);
        }

        #[test]
        fn a_distorted_element_has_its_mass_and_no_energy_in_rigid_motions(push in prop::collection::vec(-1.0f64..1.0, 24)) {
            let nodes = distorted(&push);
            let (stiffness, mass) = matrices(&nodes, &STEEL).unwrap();
            let volume: f64 = {
                let mut sum = 0.0;
                for (x, wx) in GAUSS { for (y, wy) in GAUSS { for (z, wz) in GAUSS {
                    sum += wx * wy * wz * gradient_in_space(&nodes, [x, y, z]).unwrap().1;
                } } }
                sum
            };
            let total: f64 = (0..EQUATIONS).step_by(3).map(|i| (0..EQUATIONS).step_by(3).map(|k| mass[i * EQUATIONS + k]).sum::<f64>()).sum();
            prop_assert!((total / (STEEL.density * volume) - 1.0).abs() < 1e-12);
            let largest = stiffness.iter().fold(0.0_f64, |m, k| m.max(k.abs()));
            for motion in 0..6 {
                let displacement: Vec<f64> = nodes.iter().flat_map(|x| rigid_motion(motion, *x)).collect();
                for row in stiffness.chunks(EQUATIONS) {
                    let force: f64 = row.iter().zip(&displacement).map(|(k, u)| k * u).sum();
                    prop_assert!(force.abs() < 1e-12 * largest, "motion {}: {} N", motion, force);
                }
                let own: [f64; EQUATIONS] = displacement.try_into().unwrap();
                prop_assert!(strain_energy(&nodes, &STEEL, &own).unwrap() < 1e-24 * largest);
            }
        }
    }
}
