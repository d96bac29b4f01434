//! One place of the search: the best linear unknowns there, χ², its gradient, and what the place tells of
//! poles and participations.

use jointscope_inference::NormalEquations;
use jointscope_linalg::Cholesky;
use num_complex::Complex64;

use super::poles::{Poles, Prior};
use crate::gram::{Gram, OF_MODE, Terms};
use crate::observed::Observed;
use crate::polynomial::normalize;
use crate::settings::likelihood::{MOST_GROWTH, MOST_HALF_WIDTHS};

/// What is linear, for given poles and participations.
#[derive(Debug, Clone)]
pub(super) struct RowSolution {
    /// Re and Im of each mode's entry of the row, then Re and Im of each residual term, column by column.
    pub unknowns: Vec<f64>,
    pub factor: Cholesky,
}

/// One place of the search with everything that is known there.
pub(super) struct Point {
    pub poles: Poles,
    pub terms: Terms,
    gram: Gram,
    pub rows: Vec<RowSolution>,
    pub chi2: f64,
    squared_departures: f64,
    /// For the parameters, all else eliminated.
    pub normal: NormalEquations,
    /// For each row of FRFs, the information between its linear unknowns and the parameters.
    pub mixed: Vec<Vec<f64>>,
}

impl Point {
    pub(super) fn of(
        observed: &Observed,
        mut poles: Poles,
        terms: Terms,
        prior: Option<&Prior>,
    ) -> Option<Self> {
        poles.participations.iter_mut().for_each(|l| normalize(l));
        let gram = Gram::of(observed, &poles.poles, terms);
        let count = poles.poles.len();
        let columns = observed.grid.columns;
        let parameters = 2 * columns * count;
        let mut point = Point {
            terms,
            rows: Vec::new(),
            chi2: 0.0,
            squared_departures: 0.0,
            normal: NormalEquations::zero(parameters),
            mixed: Vec::new(),
            gram,
            poles,
        };
        for frfs in &observed.grid.rows {
            point.add_row(frfs)?;
        }
        if let Some(prior) = prior {
            point.add_prior(prior);
        }
        point.hold_what_is_unknown();
        point.chi2.is_finite().then_some(point)
    }

    pub(super) fn target(&self) -> f64 {
        self.chi2 + self.squared_departures
    }

    /// The columns that a linear unknown of the row multiplies in the FRF of column `i`.
    fn linear_columns(&self, unknown: usize, i: usize) -> [(usize, f64); 2] {
        let (mode, part) = (unknown / 2, unknown % 2);
        let l = self.poles.participations[mode][i];
        let first = OF_MODE * mode;
        if part == 0 { [(first, l.re), (first + 1, l.im)] } else { [(first, -l.im), (first + 1, l.re)] }
    }

    /// Solves for the linear unknowns of a row of FRFs and adds what it tells of the parameters.
    fn add_row(&mut self, frfs: &[usize]) -> Option<()> {
        let count = self.poles.poles.len();
        let (shared, own) = (2 * count, 2 * self.terms.count());
        let size = shared + own * frfs.len();
        let term = |i: usize, k: usize| shared + own * i + k;
        let mut normal = vec![0.0; size * size];
        let mut right = vec![0.0; size];
        let mut squares = 0.0;
        let (data, first_term) = (self.gram.data(), self.gram.first_term());
        for (i, &frf) in frfs.iter().enumerate() {
            let mut unknowns: Vec<(usize, Vec<(usize, f64)>)> =
                (0..shared).map(|u| (u, self.linear_columns(u, i).to_vec())).collect();
            unknowns.extend((0..own).map(|k| (term(i, k), vec![(first_term + k, 1.0)])));
            for (a, left) in &unknowns {
                right[*a] += self.gram.product(frf, left, &[(data, 1.0)]);
                for (b, other) in unknowns.iter().filter(|(b, _)| b <= a) {
                    normal[a * size + b] += self.gram.product(frf, left, other);
                }
            }
            squares += self.gram.product(frf, &[(data, 1.0)], &[(data, 1.0)]);
        }
        // An unknown that nothing is measured of, as of a dead channel, is zero.
        for a in 0..size {
            if normal[a * size + a] <= 0.0 {
                normal[a * size + a] = 1.0;
            }
        }
        let factor = Cholesky::of(size, &normal)?;
        let mut solution = right.clone();
        factor.solve_in_place(&mut solution);
        let chi2 = squares - solution.iter().zip(&right).map(|(x, b)| x * b).sum::<f64>();
        self.chi2 += chi2.max(0.0);
        self.add_information(frfs, &solution, &factor);
        self.rows.push(RowSolution { unknowns: solution, factor });
        Some(())
    }

    /// The columns that the derivatives of the FRF of column `i` combine, by parameter, for a row's solution.
    fn derivatives(&self, solution: &[f64], i: usize) -> Vec<(usize, [(usize, f64); 2])> {
        let columns = self.poles.participations.first().map_or(1, Vec::len);
        let count = self.poles.poles.len();
        let mut all = Vec::with_capacity(4 * count);
        for (mode, pole) in self.poles.poles.iter().enumerate() {
            let entry = Complex64::new(solution[2 * mode], solution[2 * mode + 1]);
            let residue = entry * self.poles.participations[mode][i];
            let (c, d, sigma) = (OF_MODE * mode, OF_MODE * mode + 2, -pole.re);
            all.push((2 * mode, [(d, -residue.im * sigma), (d + 1, residue.re * sigma)]));
            all.push((2 * mode + 1, [(d, -residue.re * sigma), (d + 1, -residue.im * sigma)]));
            if columns > 1 {
                let first = 2 * count + 2 * (mode * columns + i) - 2 * mode;
                // The entry that is one stays so: parameters of the others, in order.
                let reference = reference_column(&self.poles.participations[mode]);
                if i != reference {
                    let first = first - if i > reference { 2 } else { 0 };
                    all.push((first, [(c, entry.re), (c + 1, entry.im)]));
                    all.push((first + 1, [(c, -entry.im), (c + 1, entry.re)]));
                }
            }
        }
        all
    }

    fn add_information(&mut self, frfs: &[usize], solution: &[f64], factor: &Cholesky) {
        let parameters = self.normal.order;
        let count = self.poles.poles.len();
        let (shared, own) = (2 * count, 2 * self.terms.count());
        let size = factor.order();
        // Rows: parameters; columns: linear unknowns.
        let mut mixed = vec![0.0; parameters * size];
        let (data, first_term) = (self.gram.data(), self.gram.first_term());
        for (i, &frf) in frfs.iter().enumerate() {
            let derivatives = self.derivatives(solution, i);
            let mut residual: Vec<(usize, f64)> = vec![(data, 1.0)];
            for unknown in 0..shared {
                let part = self.linear_columns(unknown, i);
                residual.extend(part.map(|(column, factor)| (column, -factor * solution[unknown])));
            }
            residual.extend((0..own).map(|k| (first_term + k, -solution[shared + own * i + k])));
            for (a, left) in &derivatives {
                self.normal.right[*a] += self.gram.product(frf, left, &residual);
                for (b, other) in derivatives.iter().filter(|(b, _)| b <= a) {
                    let value = self.gram.product(frf, left, other);
                    self.normal.information[a * parameters + b] += value;
                }
                for unknown in 0..shared {
                    mixed[a * size + unknown] +=
                        self.gram.product(frf, left, &self.linear_columns(unknown, i));
                }
                for k in 0..own {
                    mixed[a * size + shared + own * i + k] +=
                        self.gram.product(frf, left, &[(first_term + k, 1.0)]);
                }
            }
        }
        // A_nn − A_nl A_ll⁻¹ A_ln.
        let mut reduced = mixed.clone();
        reduced.chunks_exact_mut(size).for_each(|row| factor.solve_lower_in_place(row));
        for a in 0..parameters {
            for b in 0..=a {
                let dot: f64 = reduced[a * size..(a + 1) * size]
                    .iter()
                    .zip(&reduced[b * size..(b + 1) * size])
                    .map(|(x, y)| x * y)
                    .sum();
                self.normal.information[a * parameters + b] -= dot;
            }
        }
        self.mixed.push(mixed);
    }

    fn add_prior(&mut self, prior: &Prior) {
        let parameters = self.normal.order;
        for (mode, (pole, centre)) in self.poles.poles.iter().zip(&prior.poles).enumerate() {
            // In half-widths of the centre, so that a narrow pole is held no tighter.
            let scale = pole.re / centre.re;
            let away = [(pole.im - centre.im) / -centre.re, (pole.re / centre.re).ln()];
            for (k, (away, std)) in away.into_iter().zip([prior.std.0, prior.std.1]).enumerate() {
                let (index, scale) = (2 * mode + k, if k == 0 { scale } else { 1.0 });
                self.squared_departures += (away / std).powi(2);
                self.normal.right[index] -= scale * away / (std * std);
                self.normal.information[index * parameters + index] += (scale / std).powi(2);
            }
        }
    }

    /// A parameter that nothing is known of, such as the pole of a mode without an entry anywhere, stays
    /// where it is.
    fn hold_what_is_unknown(&mut self) {
        let parameters = self.normal.order;
        for index in 0..parameters {
            let diagonal = &mut self.normal.information[index * parameters + index];
            if *diagonal <= 0.0 || diagonal.is_nan() {
                *diagonal = f64::MIN_POSITIVE.sqrt();
                self.normal.right[index] = 0.0;
            }
        }
    }

    /// The parameters a step further; no pole moves by more than a few half-widths at once.
    pub(super) fn moved(&self, step: &[f64]) -> Poles {
        let mut poles = self.poles.clone();
        let count = poles.poles.len();
        let columns = poles.participations.first().map_or(1, Vec::len);
        for (mode, pole) in poles.poles.iter_mut().enumerate() {
            let sigma = -pole.re;
            let (along, growth) = (
                step[2 * mode].clamp(-MOST_HALF_WIDTHS, MOST_HALF_WIDTHS),
                step[2 * mode + 1].clamp(-MOST_GROWTH, MOST_GROWTH),
            );
            *pole = Complex64::new(-sigma * growth.exp(), pole.im + sigma * along);
        }
        for mode in 0..count {
            let reference = reference_column(&poles.participations[mode]);
            let mut next = 2 * count + 2 * mode * (columns - 1);
            for i in (0..columns).filter(|i| *i != reference) {
                poles.participations[mode][i] += Complex64::new(step[next], step[next + 1]);
                next += 2;
            }
        }
        poles
    }
}

/// Index of the largest entry, the one that is held at one.
fn reference_column(participation: &[Complex64]) -> usize {
    let size = |i: usize| participation[i].norm_sqr();
    (1..participation.len()).fold(0, |best, i| if size(i) > size(best) { i } else { best })
}
