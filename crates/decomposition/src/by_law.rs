//! What K and C by line would be if the joint were as it was fitted.

use crate::Analysis;
use crate::inertia::inertia_of_ends;
use crate::interface_spectrum::{interfaces_behind, stiffness_and_damping};
use crate::spectrum::dynamic_stiffness_on;
use jointscope_beam::transport;
use jointscope_linalg::{ComplexMatrix2, RealMatrix2};
use num_complex::Complex64;

impl Analysis {
    /// K and C that the spectrum's relation makes of the joint from all FRFs on a line of the recording, its
    /// mass included: lines are solved as if the joint had none, so that they hold its inertia. The fixture
    /// is taken as stated, as it is for the lines themselves.
    ///
    /// `None` without such a fit, at 0 Hz, and where a matrix is singular.
    pub fn fitted_at(&self, line: usize) -> Option<(RealMatrix2, RealMatrix2)> {
        let fit = self.joint_fit.as_ref().ok()?;
        let (spectrum, omega) = (&self.spectrum, self.spectrum.h41.lines.omega(line));
        if omega <= 0.0 {
            return None;
        }
        let s = Complex64::new(spectrum.decay, omega);
        let sides = &spectrum.sides;
        let inertia = inertia_of_ends(fit.mass.map_or(0.0, |(mass, _)| mass), sides.length, s);
        let receptances = [sides.alpha21[line], sides.alpha22[line], sides.beta33[line], sides.beta43[line]];
        let h41 = coupled(fit.follows.fit.dynamic_stiffness(s), inertia, receptances, sides.length)?;
        let found = dynamic_stiffness_on(spectrum, h41, sides, line);
        found.is_finite().then(|| spectrum.stiffness_and_damping(line, found))
    }

    /// K and C that the [interfaces by line](Self::interface_spectrum) would have if the joint were as it was
    /// fitted: of the translation, of the near and of the far rotation.
    ///
    /// `None` without such a fit or without interfaces by line, at 0 Hz, and where a matrix is singular.
    pub fn fitted_interfaces_at(&self, line: usize) -> Option<[(f64, f64); 3]> {
        let (of_beam, fit) = (self.interface_spectrum.as_ref()?, self.joint_fit.as_ref().ok()?);
        let omega = self.spectrum.h41.lines.omega(line);
        if omega <= 0.0 {
            return None;
        }
        let s = Complex64::new(self.spectrum.decay, omega);
        let left = fit.follows.fit.dynamic_stiffness(s).inverse()? - of_beam.beam.to_complex();
        let springs = interfaces_behind(left, self.spectrum.sides.length)
            .map(|compliance| stiffness_and_damping(compliance.inv(), s));
        springs.iter().all(|(k, c)| k.is_finite() && c.is_finite()).then_some(springs)
    }
}

/// H41 of two sides on a joint of dynamic stiffness Z on d = u_to − R·u_from with s²M on its ends: forces on
/// the ends are −(TᵀZT + s²M) u, T = [−R, I].
fn coupled(
    z: ComplexMatrix2,
    inertia: [[ComplexMatrix2; 2]; 2],
    [alpha21, alpha22, beta33, beta43]: [ComplexMatrix2; 4],
    length: f64,
) -> Option<ComplexMatrix2> {
    let (across, one) = (transport(length).to_complex(), ComplexMatrix2::identity());
    let near = across.transpose() * z * across + inertia[0][0];
    let near_by_far = inertia[0][1] - across.transpose() * z;
    let far_by_near = inertia[1][0] - z * across;
    let far = z + inertia[1][1];
    // u_to by u_from, then u_from by the loads on its side.
    let follows = ComplexMatrix2::zero() - (one + beta33 * far).inverse()? * beta33 * far_by_near;
    let from = (one + alpha22 * (near + near_by_far * follows)).inverse()? * alpha21;
    Some(ComplexMatrix2::zero() - beta43 * (far_by_near + far * follows) * from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Relation;
    use jointscope_linalg::Matrix2;

    fn matrix(of: [[f64; 2]; 4]) -> ComplexMatrix2 {
        let [a, b, c, d] = of.map(|[re, im]| Complex64::new(re, im));
        Matrix2::new(a, b, c, d)
    }

    /// Receptances of a free rigid block about a point, with a little damping.
    fn block(mass: f64, arm: f64) -> ComplexMatrix2 {
        let s2 = Complex64::new(-1.0e6, 2.0e3);
        let (y, r) = (1.0 / (s2 * mass), 1.0 / (s2 * mass * 1e-3));
        Matrix2::new(y + r * (arm * arm), r * arm, r * arm, r)
    }

    #[test]
    fn without_a_mass_the_relation_gives_the_joint_back() {
        let z = matrix([[2e6, 9e3], [-7e4, -300.0], [-7e4, -300.0], [4e3, 20.0]]);
        let (a, b, length) = (block(1.1, 0.03), block(1.5, -0.02), 0.07);
        let receptances = [a, a, b, b];
        let none = [[ComplexMatrix2::zero(); 2]; 2];
        let h41 = coupled(z, none, receptances, length).unwrap();
        let synthesized = Relation::synthesize(z, a, a, b, b, length).unwrap();
        let back = Relation::Exact.decompose(h41, a, a, b, b, length).unwrap();
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            assert!((h41.at(i, j) - synthesized.at(i, j)).norm() < 1e-9 * synthesized.at(i, j).norm());
            assert!((back.at(i, j) - z.at(i, j)).norm() < 1e-6 * z.at(i, j).norm(), "{i}{j}");
        }
    }

    #[test]
    fn mass_on_the_far_end_is_that_of_a_far_block_as_much_heavier() {
        let z = matrix([[2e6, 9e3], [-7e4, -300.0], [-7e4, -300.0], [4e3, 20.0]]);
        let (a, length, s2) = (block(1.1, 0.03), 0.07, Complex64::new(-1.0e6, 2.0e3));
        let (light, heavier) = (block(1.5, 0.0), block(1.6, 0.0));
        // The block's moment of inertia about its point is a thousandth of its mass.
        let mut own = [[ComplexMatrix2::zero(); 2]; 2];
        own[1][1] = Matrix2::new(s2 * 0.1, Complex64::ZERO, Complex64::ZERO, s2 * 0.1e-3);
        let with = coupled(z, own, [a, a, light, light], length).unwrap();
        let expected = Relation::synthesize(z, a, a, heavier, heavier, length).unwrap();
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let error = (with.at(i, j) - expected.at(i, j)).norm();
            assert!(error < 1e-9 * expected.at(i, j).norm(), "{i}{j}: {error}");
        }
    }
}
