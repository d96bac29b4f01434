//! The elements of k and c that the likelihood is maximised over; where c would give out energy, c = v vᵀ
//! takes its place.

use jointscope_linalg::{Matrix2, RealMatrix2};

/// (k11, k12, k22, c11, c12, c22), or with c = v vᵀ on the boundary of what is passive.
#[derive(Debug, Clone, Copy)]
pub(super) struct Parameters {
    pub k: [f64; 3],
    pub c: [f64; 3],
    /// v, where c is v vᵀ.
    pub boundary: Option<[f64; 2]>,
    pub scalar: bool,
}

impl Parameters {
    /// `None` for a start that is no joint.
    pub(super) fn of(k: RealMatrix2, c: RealMatrix2, scalar: bool) -> Option<Self> {
        let elements = |m: RealMatrix2| {
            if scalar { [m.at(0, 0), 0.0, 0.0] } else { [m.at(0, 0), m.at(0, 1), m.at(1, 1)] }
        };
        let possible = k.at(0, 0) > 0.0 && (scalar || (k.at(1, 1) > 0.0 && k.determinant() > 0.0));
        possible.then_some(Parameters { k: elements(k), c: elements(c), boundary: None, scalar })
    }

    /// Which of the slots (k11, k12, k22, c11 or v1, c12 or v2, c22) are free.
    pub(super) fn active(&self) -> &'static [usize] {
        match (self.scalar, self.boundary) {
            (true, None) => &[0, 3],
            (true, Some(_)) => &[0],
            (false, None) => &[0, 1, 2, 3, 4, 5],
            (false, Some(_)) => &[0, 1, 2, 3, 4],
        }
    }

    /// Values of all slots from those of the free ones; zero of the others.
    pub(super) fn slots(&self, active: &[f64]) -> [f64; 6] {
        let mut slots = [0.0; 6];
        self.active().iter().zip(active).for_each(|(&m, value)| slots[m] = *value);
        slots
    }

    pub(super) fn stiffness(&self) -> RealMatrix2 {
        Matrix2::new(self.k[0], self.k[1], self.k[1], self.k[2])
    }

    pub(super) fn damping(&self) -> RealMatrix2 {
        Matrix2::new(self.c[0], self.c[1], self.c[1], self.c[2])
    }

    pub(super) fn is_passive(&self) -> bool {
        self.c[0] >= 0.0 && self.c[2] >= 0.0 && self.c[1] * self.c[1] <= self.c[0] * self.c[2]
    }

    /// The nearest c on the boundary, both dofs scaled to equal stiffness.
    pub(super) fn on_the_boundary(&self) -> Self {
        let unit = [self.k[0].sqrt(), self.k[2].sqrt()];
        if self.scalar {
            return Parameters { c: [0.0; 3], boundary: Some([0.0; 2]), ..*self };
        }
        let (a, b, d) = (
            self.c[0] / (unit[0] * unit[0]),
            self.c[1] / (unit[0] * unit[1]),
            self.c[2] / (unit[1] * unit[1]),
        );
        // The larger eigenvalue and its eigenvector; the smaller one is negative.
        let (mean, half) = (0.5 * (a + d), 0.5 * (a - d));
        let largest = (mean + half.hypot(b)).max(0.0);
        let angle = 0.5 * b.atan2(half);
        let v = [largest.sqrt() * angle.cos() * unit[0], largest.sqrt() * angle.sin() * unit[1]];
        Self::with_boundary(*self, v)
    }

    fn with_boundary(self, v: [f64; 2]) -> Self {
        Parameters { c: [v[0] * v[0], v[0] * v[1], v[1] * v[1]], boundary: Some(v), ..self }
    }

    /// Derivatives of (k11, k12, k22, c11, c12, c22) by the free slots, one row a slot.
    pub(super) fn derivatives(&self) -> Vec<[f64; 6]> {
        let row = |&slot: &usize| {
            let mut row = [0.0; 6];
            match (slot, self.boundary) {
                (3, Some([v1, v2])) => (row[3], row[4]) = (2.0 * v1, v2),
                (4, Some([v1, v2])) => (row[4], row[5]) = (v1, 2.0 * v2),
                _ => row[slot] = 1.0,
            }
            row
        };
        self.active().iter().map(row).collect()
    }

    /// Whether k differs by less than a share of √(k_ii k_jj).
    pub(super) fn is_near(&self, other: &Parameters, share: f64) -> bool {
        let root = [self.k[0], self.k[2]].map(|k| k.abs().sqrt());
        let units = [root[0] * root[0], root[0] * root[1], root[1] * root[1]];
        let units = if self.scalar { [units[0], f64::INFINITY, f64::INFINITY] } else { units };
        self.k.iter().zip(&other.k).zip(units).all(|((a, b), unit)| (a - b).abs() <= share * unit)
    }

    pub(super) fn stepped(&self, step: &[f64; 6]) -> Self {
        let mut next = *self;
        for m in 0..3 {
            next.k[m] += step[m];
            next.c[m] += step[m + 3];
        }
        match self.boundary {
            Some([v1, v2]) => next.with_boundary([v1 + step[3], v2 + step[4]]),
            None => next,
        }
    }
}
