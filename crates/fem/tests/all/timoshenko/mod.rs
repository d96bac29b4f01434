//! A uniform Timoshenko beam solved exactly: the transfer matrix of (v, ψ, M, Q) over its length.

use jointscope_fem::Elasticity;
use std::f64::consts::TAU;

/// How a beam is held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Ends {
    /// Clamped at its start, free at its end.
    Clamped,
    /// Free at both.
    Free,
}

pub(crate) struct Beam {
    length: f64,
    bending: f64,
    shear: f64,
    mass: f64,
    rotary: f64,
}

impl Beam {
    /// A box along x that bends in y, with the shear coefficient 5/6 of a rectangle at ν = 0.
    pub(crate) fn of_box(size: [f64; 3], material: &Elasticity) -> Self {
        let (area, second) = (size[1] * size[2], size[2] * size[1].powi(3) / 12.0);
        let shear_modulus = 0.5 * material.youngs_modulus / (1.0 + material.poisson_ratio);
        Beam {
            length: size[0],
            bending: material.youngs_modulus * second,
            shear: 5.0 / 6.0 * shear_modulus * area,
            mass: material.density * area,
            rotary: material.density * second,
        }
    }

    /// The first natural frequencies, Hz, where the determinant of the end conditions changes sign.
    pub(crate) fn frequencies(&self, ends: Ends, count: usize) -> Vec<f64> {
        // A tenth of the first frequency of a slender free or clamped beam.
        let unit = (self.bending / self.mass).sqrt() / self.length.powi(2) / TAU;
        let step = 0.1 * unit;
        let mut found = Vec::new();
        let (mut low, mut value) = (unit, self.determinant(unit, ends));
        while found.len() < count {
            let high = low + step;
            let next = self.determinant(high, ends);
            if value * next < 0.0 {
                let (mut a, mut b) = (low, high);
                for _ in 0..80 {
                    let middle = 0.5 * (a + b);
                    if value * self.determinant(middle, ends) < 0.0 { b = middle } else { a = middle }
                }
                found.push(a);
            }
            (low, value) = (high, next);
        }
        found
    }

    fn determinant(&self, hz: f64, ends: Ends) -> f64 {
        let t = self.transfer((TAU * hz).powi(2));
        let columns = match ends {
            Ends::Clamped => [2, 3],
            Ends::Free => [0, 1],
        };
        t[2][columns[0]] * t[3][columns[1]] - t[2][columns[1]] * t[3][columns[0]]
    }

    /// exp(A L) of v' = ψ + Q/κGA, ψ' = M/EI, M' = −Q − ρI ω² ψ, Q' = −ρA ω² v, each scaled to the size of a
    /// slender beam's.
    fn transfer(&self, omega2: f64) -> [[f64; 4]; 4] {
        let l = self.length;
        let scale = [l, 1.0, self.bending / l, self.bending / (l * l)];
        let mut a = [[0.0; 4]; 4];
        a[0][1] = 1.0;
        a[0][3] = 1.0 / self.shear;
        a[1][2] = 1.0 / self.bending;
        a[2][1] = -self.rotary * omega2;
        a[2][3] = -1.0;
        a[3][0] = -self.mass * omega2;
        for (i, row) in a.iter_mut().enumerate() {
            for (j, value) in row.iter_mut().enumerate() {
                *value *= l * scale[j] / scale[i] / 256.0;
            }
        }
        let mut sum = identity();
        let mut term = identity();
        for n in 1..20 {
            term = product(&term, &a).map(|row| row.map(|v| v / f64::from(n)));
            (0..4).for_each(|i| (0..4).for_each(|j| sum[i][j] += term[i][j]));
        }
        (0..8).for_each(|_| sum = product(&sum, &sum));
        sum
    }
}

fn identity() -> [[f64; 4]; 4] {
    let mut one = [[0.0; 4]; 4];
    (0..4).for_each(|i| one[i][i] = 1.0);
    one
}

fn product(a: &[[f64; 4]; 4], b: &[[f64; 4]; 4]) -> [[f64; 4]; 4] {
    [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| (0..4).map(|k| a[i][k] * b[k][j]).sum()))
}
