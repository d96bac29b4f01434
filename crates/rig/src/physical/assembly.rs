//! The laboratory's structure as matrices: laws between stations, put together by motion.

use super::{Row, Station};
use num_complex::Complex64;

/// How an element's restoring force follows its static stiffness: K(s) = K·(1 + ratio·sτ/(1 + sτ) + iη), or
/// K·sᵅ where it has an exponent.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Law {
    /// Loss factor η of structural damping (eq 17).
    pub loss_factor: f64,
    /// Added stiffness at high frequency, relative, of a standard linear solid.
    pub relaxation_ratio: f64,
    /// Its relaxation time τ, s.
    pub relaxation_time: f64,
    /// Exponent α of a springpot; zero of all else.
    pub exponent: f64,
}

impl Law {
    /// A spring and nothing else.
    pub const ELASTIC: Law =
        Law { loss_factor: 0.0, relaxation_ratio: 0.0, relaxation_time: 0.0, exponent: 0.0 };

    /// The part of K(s)/K beyond one, at s in rad/s.
    pub(crate) fn excess(&self, s: Complex64) -> Complex64 {
        if self.exponent != 0.0 {
            let (size, angle) = s.to_polar();
            return Complex64::from_polar(size.powf(self.exponent), self.exponent * angle) - 1.0;
        }
        let s_tau = s * self.relaxation_time;
        self.relaxation_ratio * s_tau / (1.0 + s_tau) + Complex64::new(0.0, self.loss_factor)
    }
}

/// A matrix as a list of additions to its elements.
type Additions = Vec<(usize, usize, f64)>;

/// Masses, springs, dashpots and elements on a common set of coordinates.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Assembly {
    order: usize,
    mass: Additions,
    damping: Additions,
    stiffness: Additions,
    lawful: Vec<(Law, Additions)>,
}

impl Assembly {
    /// An assembly without coordinates.
    pub fn new() -> Self {
        Self::default()
    }

    /// Number of coordinates.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Adds a coordinate and returns its index.
    pub(crate) fn coordinate(&mut self) -> usize {
        self.order += 1;
        self.order - 1
    }

    /// Adds a node: two coordinates, transverse and rotation.
    pub fn node(&mut self) -> Station {
        Station::node(self.coordinate(), self.coordinate())
    }

    /// An inertia (kg, or kg·m² on a rotation) that follows a motion.
    pub(crate) fn inertia(&mut self, motion: &Row, inertia: f64) {
        add(&mut self.mass, std::slice::from_ref(motion), &[inertia]);
    }

    /// A mass matrix, row by row, on several motions.
    pub(crate) fn masses(&mut self, motions: &[Row], matrix: &[f64]) {
        add(&mut self.mass, motions, matrix);
    }

    /// A spring (N/m, N·m/rad) that resists a motion according to `law`.
    pub fn spring(&mut self, motion: &Row, stiffness: f64, law: Law) {
        self.springs(std::slice::from_ref(motion), &[stiffness], law);
    }

    /// A stiffness matrix, row by row, on several motions.
    pub(crate) fn springs(&mut self, motions: &[Row], matrix: &[f64], law: Law) {
        add(&mut self.stiffness, motions, matrix);
        if law == Law::ELASTIC {
            return;
        }
        let group = match self.lawful.iter().position(|(known, _)| *known == law) {
            Some(group) => group,
            None => {
                self.lawful.push((law, Additions::new()));
                self.lawful.len() - 1
            }
        };
        add(&mut self.lawful[group].1, motions, matrix);
    }

    /// A dashpot (N·s/m, N·m·s/rad) that resists a motion.
    pub(crate) fn dashpot(&mut self, motion: &Row, damping: f64) {
        add(&mut self.damping, std::slice::from_ref(motion), &[damping]);
    }

    /// A viscous damping matrix, row by row, on several motions.
    pub(crate) fn dashpots(&mut self, motions: &[Row], matrix: &[f64]) {
        add(&mut self.damping, motions, matrix);
    }

    /// The dense mass matrix, row by row.
    pub(crate) fn mass_matrix(&self) -> Vec<f64> {
        dense(self.order, &self.mass)
    }

    /// The dense viscous damping matrix, row by row.
    pub(crate) fn damping_matrix(&self) -> Vec<f64> {
        dense(self.order, &self.damping)
    }

    /// The dense static stiffness matrix, row by row.
    pub(crate) fn stiffness_matrix(&self) -> Vec<f64> {
        dense(self.order, &self.stiffness)
    }

    /// The assembly on other coordinates, of which each of `basis` is a shape over the present ones: every
    /// matrix A becomes VᵀAV.
    pub(crate) fn on_shapes(&self, basis: &[Vec<f64>]) -> Assembly {
        let count = basis.len();
        let turned = |additions: &Additions| -> Additions {
            let mut matrix = vec![0.0; count * count];
            for &(i, j, value) in additions {
                for (a, left) in basis.iter().enumerate().filter(|(_, shape)| shape[i] != 0.0) {
                    for (b, right) in basis.iter().enumerate() {
                        matrix[a * count + b] += left[i] * value * right[j];
                    }
                }
            }
            let entries = matrix.into_iter().enumerate().filter(|(_, value)| *value != 0.0);
            entries.map(|(at, value)| (at / count, at % count, value)).collect()
        };
        Assembly {
            order: count,
            mass: turned(&self.mass),
            damping: turned(&self.damping),
            stiffness: turned(&self.stiffness),
            lawful: self.lawful.iter().map(|(law, additions)| (*law, turned(additions))).collect(),
        }
    }

    /// Multiplies every element of the damping by a factor of its row and its column.
    pub(crate) fn scale_damping(&mut self, factor: impl Fn(usize, usize) -> f64) {
        self.damping.iter_mut().for_each(|(i, j, value)| *value *= factor(*i, *j));
    }

    /// Writes the dynamic stiffness Z(s) = s²M + sC + K(s), row by row, over `into`.
    pub fn dynamic_stiffness(&self, s: Complex64, into: &mut [Complex64]) {
        into.fill(Complex64::ZERO);
        let n = self.order;
        let mut scatter = |additions: &Additions, factor: Complex64| {
            for &(i, j, value) in additions {
                into[i * n + j] += factor * value;
            }
        };
        scatter(&self.stiffness, Complex64::ONE);
        scatter(&self.mass, s * s);
        scatter(&self.damping, s);
        for (law, additions) in &self.lawful {
            scatter(additions, law.excess(s));
        }
    }
}

/// Adds Bᵀ·matrix·B, the rows of B being the motions.
fn add(additions: &mut Additions, motions: &[Row], matrix: &[f64]) {
    for (a, row) in motions.iter().enumerate() {
        for (b, column) in motions.iter().enumerate() {
            let value = matrix[a * motions.len() + b];
            if value == 0.0 {
                continue;
            }
            for &(i, factor_i) in row.terms() {
                additions
                    .extend(column.terms().iter().map(|&(j, factor_j)| (i, j, factor_i * value * factor_j)));
            }
        }
    }
}

fn dense(order: usize, additions: &Additions) -> Vec<f64> {
    let mut matrix = vec![0.0; order * order];
    for &(i, j, value) in additions {
        matrix[i * order + j] += value;
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mass_off_the_reference_couples_translation_and_rotation() {
        let mut assembly = Assembly::new();
        let reference = assembly.node();
        assembly.inertia(&reference.rigidly_at(0.5).y, 2.0);
        assert_eq!(assembly.mass_matrix(), [2.0, 1.0, 1.0, 0.5]);
    }

    #[test]
    fn a_standard_linear_solid_is_soft_when_slow_and_stiff_when_fast() {
        let law = Law { relaxation_ratio: 0.6, relaxation_time: 1e-3, ..Law::ELASTIC };
        assert!(law.excess(Complex64::new(0.0, 1e-3)).norm() < 1e-6);
        assert!((law.excess(Complex64::new(0.0, 1e9)) - 0.6).norm() < 1e-5);
        let middle = law.excess(Complex64::new(0.0, 1e3));
        assert!((middle - Complex64::new(0.3, 0.3)).norm() < 1e-12);
    }
}
