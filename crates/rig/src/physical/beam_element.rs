//! The laboratory's beams: stiffness and mass of an element.

use super::{Assembly, Law, Row, Station};
use crate::StructureError;

/// A straight beam element of uniform section: Timoshenko's, or Euler–Bernoulli's where the shear stiffness
/// is infinite and the rotary inertia zero.
///
/// Everything follows from the element held at its left end and loaded at its right end by a force F and a
/// moment M: deflection and rotation at x are
/// v = F·((L·x²/2 − x³/6)/EI + x/κGA) + M·x²/2EI and ψ = F·(L·x − x²/2)/EI + M·x/EI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamElement {
    /// Length L, m.
    pub length: f64,
    /// Bending stiffness EI, N·m².
    pub bending_stiffness: f64,
    /// Shear stiffness κGA, N; infinite for Euler–Bernoulli.
    pub shear_stiffness: f64,
    /// Mass per length, kg/m.
    pub mass_per_length: f64,
    /// Rotary inertia per length ρI, kg·m.
    pub rotary_inertia: f64,
}

/// Abscissae on (0, 1) and weights of the four-point Gauss rule, exact to degree seven: products of cubics
/// need six.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

impl BeamElement {
    /// Deflection and rotation at `x` per unit of F and of M at the right end: `[[v_F, v_M], [ψ_F, ψ_M]]`.
    fn cantilever(&self, x: f64) -> [[f64; 2]; 2] {
        let (l, ei) = (self.length, self.bending_stiffness);
        [
            [x * x * (l / 2.0 - x / 6.0) / ei + x / self.shear_stiffness, x * x / (2.0 * ei)],
            [x * (l - x / 2.0) / ei, x / ei],
        ]
    }

    /// The 2×2 stiffness on d = u_right − R·u_left, row by row: the inverse of the cantilever's flexibility.
    ///
    /// # Errors
    /// A length or a stiffness that is not above zero.
    pub(crate) fn end_stiffness(&self) -> Result<[[f64; 2]; 2], StructureError> {
        let above_zero = |what, value: f64| {
            let needed = "a value above zero";
            if value > 0.0 { Ok(()) } else { Err(StructureError::Impossible { what, value, needed }) }
        };
        above_zero("an element length", self.length)?;
        above_zero("a bending stiffness", self.bending_stiffness)?;
        above_zero("a shear stiffness", self.shear_stiffness)?;
        let [[a, b], [c, d]] = self.cantilever(self.length);
        let determinant = a * d - b * c;
        Ok([[d / determinant, -b / determinant], [-c / determinant, a / determinant]])
    }

    /// Deflection and rotation at `x` as combinations of (y, θ) of the left and of the right end.
    ///
    /// # Errors
    /// As [`BeamElement::end_stiffness`].
    pub(crate) fn shapes(&self, x: f64) -> Result<[[f64; 4]; 2], StructureError> {
        let k = self.end_stiffness()?;
        let bent = self.cantilever(x);
        // d = u_right − R·u_left as a combination of the four end motions.
        let relative = [[-1.0, -self.length, 1.0, 0.0], [0.0, -1.0, 0.0, 1.0]];
        let rigid = [[1.0, x, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]];
        let mut shapes = rigid;
        for i in 0..2 {
            for j in 0..4 {
                for a in 0..2 {
                    for b in 0..2 {
                        shapes[i][j] += bent[i][a] * k[a][b] * relative[b][j];
                    }
                }
            }
        }
        Ok(shapes)
    }

    /// The consistent mass matrix on (y, θ) of the left and the right end, row by row.
    ///
    /// # Errors
    /// As [`BeamElement::end_stiffness`].
    pub(crate) fn consistent_mass(&self) -> Result<[f64; 16], StructureError> {
        let mut mass = [0.0; 16];
        for (abscissa, weight) in GAUSS {
            let [deflection, rotation] = self.shapes(abscissa * self.length)?;
            let dx = weight * self.length;
            for i in 0..4 {
                for j in 0..4 {
                    mass[4 * i + j] += dx
                        * (self.mass_per_length * deflection[i] * deflection[j]
                            + self.rotary_inertia * rotation[i] * rotation[j]);
                }
            }
        }
        Ok(mass)
    }

    /// Puts the element between two stations, its stiffness following `law`.
    ///
    /// # Errors
    /// A length or a stiffness that is not above zero.
    pub fn assemble(
        &self,
        assembly: &mut Assembly,
        left: &Station,
        right: &Station,
        law: Law,
    ) -> Result<(), StructureError> {
        let [[a, b], [c, d]] = self.end_stiffness()?;
        assembly.springs(&right.relative_to(left, self.length), &[a, b, c, d], law);
        if self.mass_per_length != 0.0 || self.rotary_inertia != 0.0 {
            let motions = [left.y.clone(), left.theta.clone(), right.y.clone(), right.theta.clone()];
            assembly.masses(&motions, &self.consistent_mass()?);
        }
        Ok(())
    }

    /// The station at `x` between the ends of the element.
    ///
    /// # Errors
    /// As [`BeamElement::end_stiffness`].
    pub(crate) fn station_at(
        &self,
        x: f64,
        left: &Station,
        right: &Station,
    ) -> Result<Station, StructureError> {
        let combine = |factors: [f64; 4]| {
            Row::zero()
                .plus(factors[0], &left.y)
                .plus(factors[1], &left.theta)
                .plus(factors[2], &right.y)
                .plus(factors[3], &right.theta)
        };
        let [deflection, rotation] = self.shapes(x)?;
        Ok(Station { y: combine(deflection), theta: combine(rotation) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEEL: BeamElement = BeamElement {
        length: 0.2,
        bending_stiffness: 70.0,
        shear_stiffness: f64::INFINITY,
        mass_per_length: 1.3,
        rotary_inertia: 0.0,
    };

    #[test]
    fn without_shear_the_matrices_are_those_of_the_textbook() {
        let (l, ei, m): (f64, f64, f64) = (0.2, 70.0, 1.3);
        let k = STEEL.end_stiffness().unwrap();
        let expected = [[12.0 * ei / l.powi(3), -6.0 * ei / (l * l)], [-6.0 * ei / (l * l), 4.0 * ei / l]];
        for i in 0..2 {
            for j in 0..2 {
                assert!((k[i][j] / expected[i][j] - 1.0).abs() < 1e-12, "k{i}{j} = {}", k[i][j]);
            }
        }
        let mass = STEEL.consistent_mass().unwrap();
        let unit = m * l / 420.0;
        let row = [156.0 * unit, 22.0 * l * unit, 54.0 * unit, -13.0 * l * unit];
        for j in 0..4 {
            assert!((mass[j] / row[j] - 1.0).abs() < 1e-12, "m0{j} = {} instead of {}", mass[j], row[j]);
        }
    }

    #[test]
    fn a_rigid_rotation_carries_the_whole_mass_and_the_rotary_inertia() {
        let element = BeamElement { shear_stiffness: 4e5, rotary_inertia: 2e-3, ..STEEL };
        let mass = element.consistent_mass().unwrap();
        let rotation = [0.0, 1.0, element.length, 1.0];
        let energy: f64 =
            (0..4).flat_map(|i| (0..4).map(move |j| rotation[i] * mass[4 * i + j] * rotation[j])).sum();
        let expected = 1.3 * 0.2_f64.powi(3) / 3.0 + 2e-3 * 0.2;
        assert!((energy / expected - 1.0).abs() < 1e-12, "{energy} instead of {expected}");
    }

    #[test]
    fn an_element_without_length_is_refused() {
        let answer = BeamElement { length: 0.0, ..STEEL }.end_stiffness().unwrap_err();
        assert_eq!(answer.to_string(), "an element length of 0 is impossible: a value above zero is needed");
    }
}
