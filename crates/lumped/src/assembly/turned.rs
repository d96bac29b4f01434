//! Modes that were found beside a basis.

/// How modes differ from the basis beside which they were found.
#[derive(Debug, Clone)]
pub(super) struct Turned {
    pub(super) eigenvalues: Vec<f64>,
    /// What shapes are multiplied by at each coordinate before they mix.
    pub(super) scales: Vec<f64>,
    /// c_kr, a row over r for each k; nothing where the matrices are the same.
    pub(super) mixing: Vec<f64>,
}

impl Turned {
    /// What entries of a row that reads coordinates, by their place, read of the basis.
    pub(super) fn scale(&self, entries: &mut [(usize, f64)]) {
        entries.iter_mut().for_each(|(place, t)| *t *= self.scales[*place]);
    }

    /// Adds `weight` times the participation of a motion, which the basis itself answers with `own`.
    pub(super) fn add(&self, own: &[f64], weight: f64, all: &mut [f64]) {
        all.iter_mut().zip(own).for_each(|(all, own)| *all += weight * own);
        for (row, own) in self.mixing.chunks_exact(own.len()).zip(own) {
            let share = weight * own;
            all.iter_mut().zip(row).for_each(|(all, c)| *all += share * c);
        }
    }
}
