//! ln ω of each mode in each FRF, taken apart into what goes with the response and what goes with the
//! reference: weighted least squares.

use jointscope_inference::{chi_squared_above, fisher_above};
use jointscope_linalg::Cholesky;

/// One FRF's word on one mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    pub mode: usize,
    pub response: usize,
    pub reference: usize,
    /// ln ω, less a constant of the mode.
    pub ln_omega: f64,
    pub variance: f64,
}

/// What all FRFs say of the modes' natural frequencies.
#[derive(Debug, Clone)]
pub(super) struct Table {
    pub cells: Vec<Cell>,
    /// Indices of the modes in the reference's list that they were taken from.
    pub modes: Vec<usize>,
    /// Half-width of each mode over its natural frequency: the damping ratio.
    pub half_widths: Vec<f64>,
    pub responses: usize,
    pub references: usize,
}

/// A weighted least-squares fit: parameters, what it leaves, covariance of the parameters (row-major).
pub(super) struct Fit {
    pub values: Vec<f64>,
    pub chi2: f64,
    pub covariance: Vec<f64>,
}

/// One equation: (unknown, coefficient) pairs, right side, variance.
pub(super) type Equation = (Vec<(usize, f64)>, f64, f64);

/// Share of the diagonal that makes normal equations definite where unknowns cannot be told apart.
const RIDGE: f64 = 1e-10;

impl Fit {
    pub(super) fn of(equations: &[Equation], unknowns: usize) -> Option<Self> {
        let mut normal = vec![0.0; unknowns * unknowns];
        let mut values = vec![0.0; unknowns];
        for (row, right, variance) in equations {
            for (i, a) in row {
                values[*i] += a * right / variance;
                for (j, b) in row {
                    normal[i * unknowns + j] += a * b / variance;
                }
            }
        }
        let largest = (0..unknowns).map(|i| normal[i * (unknowns + 1)]).fold(0.0, f64::max);
        for i in 0..unknowns {
            let own = &mut normal[i * (unknowns + 1)];
            // A column that is empty has no scale of its own.
            *own += RIDGE * if *own > 0.0 { *own } else { largest };
        }
        let cholesky = Cholesky::of(unknowns, &normal)?;
        cholesky.solve_in_place(&mut values);
        let left = |(row, right, variance): &Equation| {
            let fitted: f64 = row.iter().map(|(i, a)| a * values[*i]).sum();
            (right - fitted).powi(2) / variance
        };
        let chi2 = equations.iter().map(left).sum();
        Some(Fit { chi2, covariance: cholesky.inverse(), values })
    }
}

impl Table {
    /// Column of a response's constant for a mode.
    pub(super) fn constant(&self, cell: &Cell) -> usize {
        cell.mode * self.responses + cell.response
    }

    /// Number of such columns.
    pub(super) fn constants(&self) -> usize {
        self.modes.len() * self.responses
    }

    /// Equations with a constant for each response and mode, and `more` columns besides.
    pub(super) fn equations(&self, more: impl Fn(&Cell) -> Vec<(usize, f64)>) -> Vec<Equation> {
        let equation = |cell: &Cell| {
            let mut row = vec![(self.constant(cell), 1.0)];
            row.extend(more(cell));
            (row, cell.ln_omega, cell.variance)
        };
        self.cells.iter().map(equation).collect()
    }

    /// χ² of what each response's own constants leave, references that are alike (by `kept`) taken as one:
    /// the others have a constant of their own for each mode.
    pub(super) fn by_reference(&self, kept: impl Fn(usize) -> bool) -> Option<Fit> {
        let first = self.constants();
        let more = |cell: &Cell| match kept(cell.reference) {
            true => Vec::new(),
            false => vec![(first + cell.mode * self.references + cell.reference, 1.0)],
        };
        Fit::of(&self.equations(more), first + self.modes.len() * self.references)
    }

    /// The largest difference of a natural frequency among these references, as a share of the half-width.
    pub(super) fn farthest(&self, among: &[usize]) -> f64 {
        let Some(fit) = self.by_reference(|_| false) else { return f64::INFINITY };
        let first = self.constants();
        let mut farthest: f64 = 0.0;
        for (mode, half_width) in self.half_widths.iter().enumerate() {
            let is_seen = |&&own: &&usize| self.cells.iter().any(|c| c.mode == mode && c.reference == own);
            let seen: Vec<f64> = among
                .iter()
                .filter(is_seen)
                .map(|own| fit.values[first + mode * self.references + own])
                .collect();
            let (low, high) = seen
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
            farthest = farthest.max((high - low) / half_width);
        }
        farthest
    }

    /// Parts of a mode's cells that no response and no reference connects.
    fn parts(&self, mode: usize) -> (usize, usize, usize) {
        let nodes = self.responses + self.references;
        let mut part: Vec<usize> = (0..nodes).collect();
        let mut used = vec![false; nodes];
        for cell in self.cells.iter().filter(|cell| cell.mode == mode) {
            let (a, b) = (cell.response, self.responses + cell.reference);
            (used[a], used[b]) = (true, true);
            let (from, to) = (part[b], part[a]);
            part.iter_mut().filter(|p| **p == from).for_each(|p| *p = to);
        }
        let count = |range: std::ops::Range<usize>| range.filter(|&node| used[node]).count();
        let mut parts: Vec<usize> = (0..nodes).filter(|&node| used[node]).map(|node| part[node]).collect();
        parts.sort_unstable();
        parts.dedup();
        (count(0..self.responses), count(self.responses..nodes), parts.len())
    }

    /// Degrees of freedom of what references differ by, and of what is left beside responses and references.
    pub(super) fn degrees(&self) -> (usize, usize) {
        let (mut of_references, mut left) = (0, 0);
        for mode in 0..self.modes.len() {
            let cells = self.cells.iter().filter(|cell| cell.mode == mode).count();
            let (responses, references, parts) = self.parts(mode);
            of_references += references - parts;
            left += cells + parts - responses - references;
        }
        (of_references, left)
    }

    /// Responses of one reference, at the most. Where they were recorded in the same hits they share the
    /// noise of the force, and all of them together tell a natural frequency no better than one. Whether they
    /// were no recording says: variances of what goes with references are multiplied by this number, which is
    /// the most that any correlation makes of them.
    pub(super) fn shared(&self) -> f64 {
        let responses = |mode: usize, reference: usize| {
            self.cells.iter().filter(|cell| cell.mode == mode && cell.reference == reference).count()
        };
        let all = (0..self.modes.len()).flat_map(|m| (0..self.references).map(move |r| (m, r)));
        all.map(|(mode, reference)| responses(mode, reference)).max().unwrap_or(1).max(1) as f64
    }

    /// What variances have to be multiplied by for FRFs that agree neither by response nor by reference; at
    /// least 1.
    pub(super) fn inflation(&self) -> f64 {
        let (_, left) = self.degrees();
        match self.by_reference(|_| false) {
            Some(fit) if left > 0 => (fit.chi2 / left as f64).max(1.0),
            _ => 1.0,
        }
    }

    /// Probability by chance of references that differ as much beside what goes with the responses; `None`
    /// where nothing tells one from the other.
    pub(super) fn chance(&self) -> Option<f64> {
        let (of_references, left) = self.degrees();
        if of_references == 0 {
            return None;
        }
        let (all, own) = (self.by_reference(|_| true)?, self.by_reference(|_| false)?);
        let between = (all.chi2 - own.chi2).max(0.0) / self.shared();
        Some(chance(between, of_references, self.inflation(), left))
    }
}

/// Probability of a χ² as large: by the variances as stated, or where they had to be inflated, by the ratio
/// to what `left` degrees of freedom leave.
pub(super) fn chance(chi2: f64, degrees: usize, inflation: f64, left: usize) -> f64 {
    let (degrees, left) = (degrees as f64, left as f64);
    match inflation > 1.0 {
        true => fisher_above(chi2 / (degrees * inflation), degrees, left),
        false => chi_squared_above(chi2, degrees),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(references: usize, value: impl Fn(usize, usize) -> Option<f64>) -> Table {
        let all = (0..3).flat_map(|o| (0..references).map(move |i| (o, i)));
        let cell = |(response, reference): (usize, usize)| {
            let ln_omega = value(response, reference)?;
            Some(Cell { mode: 0, response, reference, ln_omega, variance: 1e-8 })
        };
        Table {
            cells: all.filter_map(cell).collect(),
            modes: vec![0],
            half_widths: vec![0.01],
            responses: 3,
            references,
        }
    }

    #[test]
    fn what_goes_with_the_response_is_no_drift() {
        let roving = table(2, |response, _| Some(0.01 * response as f64));
        assert_eq!(roving.degrees(), (1, 2));
        assert!(roving.chance().unwrap() > 0.99);
        let drift = table(2, |response, reference| Some(0.01 * response as f64 + 1e-3 * reference as f64));
        assert!(drift.chance().unwrap() < 1e-9);
    }

    #[test]
    fn where_each_response_has_a_reference_of_its_own_nothing_tells_them_apart() {
        let diagonal =
            table(3, |response, reference| (response == reference).then_some(0.01 * response as f64));
        assert_eq!(diagonal.degrees(), (0, 0));
        assert_eq!(diagonal.chance(), None);
    }

    #[test]
    fn frfs_that_agree_neither_by_response_nor_by_reference_widen_what_chance_may_do() {
        let scattered = |response: usize, reference: usize| {
            Some(1e-3 * [[0.3, -1.1], [1.2, 0.1], [-0.4, 0.9]][response][reference])
        };
        let chance = table(2, scattered).chance().unwrap();
        assert!(chance > 0.05, "{chance}");
    }
}
