//! The dynamic stiffness of a uniform beam with distributed mass, by doubling a short element.
//!
//! A short element is as much stiffer as the cube of its share of the length, and what its mass adds is then
//! lost in the rounding of its stiffness: to 1e-11 of the whole beam's, which near a pole moves residues by
//! 1e-7. So what is doubled is what mass adds; the static stiffness of each length is known in closed form.

use super::two_ends::TwoEnds;
use crate::lanes::Lines;
use jointscope_beam::{consistent_mass, end_compliance};
use jointscope_linalg::Matrix2;

/// How often a short element is doubled.
const DOUBLINGS: usize = 4;

/// Real parts of what a beam is on every line.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct HeavyBeam {
    /// Static stiffness of an element at each doubling, without the complex factor of the modulus.
    short: [MirrorBeam<f64>; DOUBLINGS],
    /// Static stiffness of the whole.
    whole: MirrorBeam<f64>,
    /// Consistent mass of the first element.
    mass: MirrorBeam<f64>,
}

impl HeavyBeam {
    /// Of bending stiffness EI, shear stiffness where it shears, mass and length.
    pub(super) fn new(bending: f64, shear: Option<f64>, mass: f64, length: f64) -> Self {
        let of = |doublings: usize| length / f64::from(1u32 << doublings);
        let first = of(DOUBLINGS);
        HeavyBeam {
            short: std::array::from_fn(|level| MirrorBeam::at_rest(bending, shear, of(DOUBLINGS - level))),
            whole: MirrorBeam::at_rest(bending, shear, length),
            mass: MirrorBeam::of_mass(mass / length, first),
        }
    }

    /// On the motions of both ends at s, its modulus times a complex factor.
    #[inline(always)]
    pub(super) fn at<T: Lines>(&self, s: T, modulus: T) -> TwoEnds<T> {
        let scale = s * s * modulus.reciprocal();
        let mut added = self.mass.map(|mass| scale * mass);
        for short in &self.short {
            added = added.doubled(short);
        }
        let whole = self.whole.map(|rest| T::ONE * rest).plus(&added);
        whole.map(|element| modulus * element).between_both_ends()
    }
}

/// A matrix of a beam that is the same seen from either end, where a rotation of the one is the opposite of
/// the other's: near [[a, b], [b, d]], far [[a, −b], [−b, d]], cross [[p, q], [−q, t]].
#[derive(Debug, Clone, Copy, PartialEq)]
struct MirrorBeam<T> {
    a: T,
    b: T,
    d: T,
    p: T,
    q: T,
    t: T,
}

impl MirrorBeam<f64> {
    /// Static stiffness: `[−R, I]ᵀ k [−R, I]` of the end stiffness k.
    fn at_rest(bending: f64, shear: Option<f64>, length: f64) -> Self {
        let mut compliance = end_compliance(bending, length);
        compliance.0[0][0] += shear.map_or(0.0, |shear| length / shear);
        let [[k00, k01], [_, k11]] = compliance.inverse_unchecked().0;
        MirrorBeam { a: k00, b: -k01, d: k11, p: -k00, q: -k01, t: -(k01 * length + k11) }
    }

    /// Consistent mass.
    fn of_mass(mass_per_length: f64, length: f64) -> Self {
        let mass = consistent_mass(mass_per_length, length);
        let [near, [_, d, _, t]] = [mass[0], mass[1]];
        MirrorBeam { a: near[0], b: near[1], d, p: near[2], q: near[3], t }
    }
}

impl<T: Copy> MirrorBeam<T> {
    #[inline(always)]
    fn map<U>(self, of: impl Fn(T) -> U) -> MirrorBeam<U> {
        let MirrorBeam { a, b, d, p, q, t } = self;
        MirrorBeam { a: of(a), b: of(b), d: of(d), p: of(p), q: of(q), t: of(t) }
    }
}

impl<T: Lines> MirrorBeam<T> {
    #[inline(always)]
    fn plus(self, other: &Self) -> Self {
        let MirrorBeam { a, b, d, p, q, t } = *other;
        MirrorBeam {
            a: self.a + a,
            b: self.b + b,
            d: self.d + d,
            p: self.p + p,
            q: self.q + q,
            t: self.t + t,
        }
    }

    /// What mass adds to two elements end to end, of what it adds to each; `rest` is an element's static
    /// stiffness.
    ///
    /// Eliminating the motion between them takes x·y/(2z) off each element of the matrix, z being a or d:
    /// far + near, which is to be inverted, is diagonal. What mass adds to that is (x₀·δy + y₀·δx + δx·δy −
    /// (x₀y₀/z₀)·δz)/(2z), x₀, y₀ and z₀ at rest, which subtracts nothing that is large.
    #[inline(always)]
    fn doubled(self, rest: &MirrorBeam<f64>) -> Self {
        let MirrorBeam { a, b, d, p, q, t } = self;
        let (twice_a, twice_d) = ((T::ONE * rest.a + a) * 2.0, (T::ONE * rest.d + d) * 2.0);
        let inverse = (twice_a * twice_d).reciprocal();
        let (of_motion, of_rotation) = (twice_d * inverse, twice_a * inverse);
        let by_motion = |(x0, x): (f64, T), (y0, y): (f64, T)| {
            (y * x0 + x * y0 + x * y - a * (x0 * y0 / rest.a)) * of_motion
        };
        let by_rotation = |(x0, x): (f64, T), (y0, y): (f64, T)| {
            (y * x0 + x * y0 + x * y - d * (x0 * y0 / rest.d)) * of_rotation
        };
        let (p, q, t) = ((rest.p, p), (rest.q, q), (rest.t, t));
        let (pp, qq_m, pq) = (by_motion(p, p), by_motion(q, q), by_motion(p, q));
        let (qq_r, tt, qt) = (by_rotation(q, q), by_rotation(t, t), by_rotation(q, t));
        MirrorBeam {
            a: a - pp - qq_r,
            b: b + pq - qt,
            d: d - qq_m - tt,
            p: qq_r - pp,
            q: -(pq + qt),
            t: qq_m - tt,
        }
    }

    #[inline(always)]
    fn between_both_ends(self) -> TwoEnds<T> {
        let MirrorBeam { a, b, d, p, q, t } = self;
        TwoEnds {
            near: Matrix2::new(a, b, b, d),
            cross: Matrix2::new(p, q, -q, t),
            far: Matrix2::new(a, -b, -b, d),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_complex::Complex64;

    #[test]
    fn what_mass_adds_is_known_to_every_digit_however_little_it_is() {
        // Six numbers at a frequency and a little above it: what differs is the mass's share, (1 + ε)² − 1 of
        // it, with no steps of rounding between.
        let beam = HeavyBeam::new(160.0, Some(3e6), 0.08, 0.04);
        let at = |omega: f64| {
            let ends = beam.at(Complex64::new(0.0, omega), Complex64::new(1.0, 0.004));
            [0, 1, 2, 3].map(|i| ends.at(i, i))
        };
        let at_rest = beam.at(Complex64::new(0.0, 1e-3), Complex64::new(1.0, 0.004));
        let omega = 4000.0;
        let (one, other) = (at(omega), at(omega * (1.0 + 1e-6)));
        for (i, (one, other)) in one.iter().zip(&other).enumerate() {
            // To first order in the mass, which the fourth power of frequency corrects by less than a
            // hundredth.
            let expected = 2e-6 * (one - at_rest.at(i, i));
            let found = other - one;
            assert!((found / expected - 1.0).norm() < 0.02, "{i}: {found} against {expected}");
        }
        // Steps of 1e-10 of the frequency, which move 1e11 N/m of a short element by less than its last
        // digit, still show one slope.
        let step = |k: f64| (at(omega * (1.0 + k * 1e-10))[0] - one[0]) / k;
        let steps: Vec<f64> = (1..9).map(|k| step(f64::from(k)).re).collect();
        for (k, found) in steps.iter().enumerate() {
            assert!((found / steps[7] - 1.0).abs() < 0.05, "step {k}: {found} against {}", steps[7]);
        }
    }

    #[test]
    fn static_stiffness_doubles_into_that_of_twice_the_length() {
        let (short, long) =
            (MirrorBeam::at_rest(50.0, Some(2e6), 0.01), MirrorBeam::at_rest(50.0, Some(2e6), 0.02));
        let MirrorBeam { a, b, d, p, q, t } = short;
        let expected = [
            (a - p * p / (2.0 * a) - q * q / (2.0 * d), long.a),
            (b + p * q / (2.0 * a) - q * t / (2.0 * d), long.b),
            (d - q * q / (2.0 * a) - t * t / (2.0 * d), long.d),
            (q * q / (2.0 * d) - p * p / (2.0 * a), long.p),
            (-(p * q / (2.0 * a) + q * t / (2.0 * d)), long.q),
            (q * q / (2.0 * a) - t * t / (2.0 * d), long.t),
        ];
        for (index, (doubled, long)) in expected.iter().enumerate() {
            assert!((doubled / long - 1.0).abs() < 1e-9, "{index}: {doubled} against {long}");
        }
    }
}
