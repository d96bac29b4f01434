//! Poly-reference least-squares complex-frequency estimator: H(ω) ≈ B(z) A(z)⁻¹ in matrix fractions of
//! z = exp(iωT).
//!
//! For every row of FRFs the numerator is eliminated from the normal equations (Guillaume et al. 2003,
//! Peeters et al. 2004). All of their blocks are Toeplitz in the powers of z, so the lines are gone through
//! once for the highest order. The blocks of lower orders are leading blocks of those, and so are their
//! Cholesky factors: the reduced equations of the next order follow from those before by one product of rows.

use jointscope_linalg::{LuWorkspace, complex_eigenvalues};
use num_complex::Complex64;
use std::f64::consts::TAU;

use crate::observed::Observed;
use crate::settings::orders::{BAND_ARC, UNDAMPED_GROWTH};

/// The lines on the unit circle.
#[derive(Debug, Clone, Copy)]
struct Circle {
    first: f64,
    period: f64,
    /// Distance of the lines, rad/s.
    spacing: f64,
}

impl Circle {
    fn of(omegas: &[f64]) -> Self {
        let (first, last) = (omegas[0], omegas[omegas.len() - 1]);
        let band = (last - first).max(f64::MIN_POSITIVE);
        let spacing = band / omegas.len().saturating_sub(1).max(1) as f64;
        Circle { first, period: TAU * BAND_ARC / band, spacing }
    }

    fn at(&self, omega: f64) -> Complex64 {
        Complex64::from_polar(1.0, (omega - self.first) * self.period)
    }

    /// Whether a frequency lies within the lines: beyond them what hardly grows writes what is out of the
    /// band, and is no mode.
    fn holds(&self, omega: f64) -> bool {
        (0.0..=TAU * BAND_ARC).contains(&((omega - self.first) * self.period))
    }

    /// The pole λ of z = exp((λ − iω₁)T).
    fn pole(&self, z: Complex64) -> Complex64 {
        let before = -0.5 * TAU * (1.0 - BAND_ARC);
        let turn = if z.arg() < before { z.arg() + TAU } else { z.arg() };
        Complex64::new(z.norm().ln() / self.period, self.first + turn / self.period)
    }
}

/// Poles of one order of the denominator, in s (rad/s), with their participations over the columns.
#[derive(Debug, Clone)]
pub(crate) struct OrderPoles {
    pub order: usize,
    pub poles: Vec<(Complex64, Vec<Complex64>)>,
}

/// Poles that are damped, or hardly grow, of every order from `orders.0` to `orders.1`; orders whose
/// equations are singular are left out.
pub(crate) fn poles_by_order(observed: &Observed, orders: (usize, usize)) -> Vec<OrderPoles> {
    let mut equations = Equations::of(observed, orders.1);
    let mut all = Vec::new();
    for order in 0..=orders.1 {
        equations.raise(order);
        if order >= orders.0.max(1)
            && let Some(poles) = equations.poles(order)
        {
            all.push(OrderPoles { order, poles });
        }
    }
    all
}

struct Equations {
    circle: Circle,
    columns: usize,
    size: usize,
    /// Σ over the rows of FRFs of the blocks of the denominator, reduced by the numerators up to the order
    /// raised to.
    reduced: Vec<Complex64>,
    /// L⁻¹S of each row of FRFs: (order + 1) rows of `size` entries.
    eliminated: Vec<Vec<Complex64>>,
    lu: LuWorkspace,
}

/// Toeplitz coefficients of a row of FRFs, sums over the lines of powers of z.
struct Toeplitz {
    /// Of the weights.
    r: Vec<Complex64>,
    /// Of H, with positive and with negative powers.
    s: Vec<Complex64>,
    /// Of HᴴH.
    t: Vec<Complex64>,
}

impl Toeplitz {
    fn of(observed: &Observed, frfs: &[usize], circle: &Circle, powers: usize) -> Self {
        let (p, n) = (observed.grid.columns, observed.lines());
        let mut power = vec![Complex64::ZERO; powers];
        let mut row = vec![Complex64::ZERO; p];
        let mut r = vec![Complex64::ZERO; powers];
        let mut s = vec![Complex64::ZERO; 2 * p * powers];
        let mut t = vec![Complex64::ZERO; p * p * powers];
        for line in 0..n {
            // One weight for a row, that of its noisiest entry.
            let weight = frfs.iter().map(|&f| observed.weights[f * n + line]).fold(f64::INFINITY, f64::min);
            if weight <= 0.0 {
                continue;
            }
            let z = circle.at(observed.omegas[line]);
            let mut current = Complex64::from(weight);
            for value in &mut power {
                *value = current;
                current *= z;
            }
            for (value, &f) in row.iter_mut().zip(frfs) {
                *value = observed.values[f * n + line];
            }
            add(&mut r, &power, Complex64::ONE);
            for (i, h) in row.iter().enumerate() {
                add(&mut s[2 * i * powers..][..powers], &power, *h);
                // Conjugated, the negative powers.
                add(&mut s[(2 * i + 1) * powers..][..powers], &power, h.conj());
                for (j, g) in row.iter().enumerate() {
                    add(&mut t[(i * p + j) * powers..][..powers], &power, h.conj() * g);
                }
            }
        }
        Toeplitz { r, s, t }
    }
}

impl Equations {
    fn of(observed: &Observed, highest: usize) -> Self {
        let p = observed.grid.columns;
        let powers = highest + 1;
        let size = powers * p;
        let circle = Circle::of(&observed.omegas);
        let mut reduced = vec![Complex64::ZERO; size * size];
        let mut eliminated = Vec::with_capacity(observed.grid.rows.len());
        for frfs in &observed.grid.rows {
            let Toeplitz { r, s, t } = Toeplitz::of(observed, frfs, &circle, powers);
            // Element (a, b) of the normal equations carries z^(b − a).
            let toeplitz_s = |a: usize, b: usize, i: usize| {
                if b >= a { s[2 * i * powers + b - a] } else { s[(2 * i + 1) * powers + a - b].conj() }
            };
            for a in 0..powers {
                for b in 0..powers {
                    for i in 0..p {
                        for j in 0..p {
                            let element = if b >= a {
                                t[(i * p + j) * powers + b - a]
                            } else {
                                t[(j * p + i) * powers + a - b].conj()
                            };
                            reduced[(a * p + i) * size + b * p + j] += element;
                        }
                    }
                }
            }
            let mut q = vec![Complex64::ZERO; powers * size];
            for a in 0..powers {
                for b in 0..powers {
                    for i in 0..p {
                        q[a * size + b * p + i] = toeplitz_s(a, b, i);
                    }
                }
            }
            forward_substitute(&r, &mut q, size);
            eliminated.push(q);
        }
        Equations { circle, columns: p, size, reduced, eliminated, lu: LuWorkspace::new() }
    }

    /// Eliminates the numerators' coefficient of power `order`.
    fn raise(&mut self, order: usize) {
        let size = self.size;
        for q in &self.eliminated {
            let row = &q[order * size..(order + 1) * size];
            for (left, target) in row.iter().zip(self.reduced.chunks_exact_mut(size)) {
                let factor = -left.conj();
                add(target, row, factor);
            }
        }
    }

    /// The damped poles of an order, with A₀ = I: poles that are mere arithmetic then come out undamped
    /// (Cauberghe et al. 2005).
    fn poles(&mut self, order: usize) -> Option<Vec<(Complex64, Vec<Complex64>)>> {
        let (p, size) = (self.columns, self.size);
        let unknowns = order * p;
        let reduced = &self.reduced;
        self.lu
            .factorize(unknowns, |a| {
                for (i, row) in a.chunks_exact_mut(unknowns).enumerate() {
                    row.copy_from_slice(&reduced[(p + i) * size + p..][..unknowns]);
                }
            })
            .ok()?;
        let mut coefficients: Vec<Complex64> =
            (0..unknowns * p).map(|k| -reduced[(p + k / p) * size + k % p]).collect();
        self.lu.solve_columns_in_place(&mut coefficients, p);
        // uⁿI + A₁uⁿ⁻¹ + … + Aₙ = 0 of u = 1/z, in companion form.
        let mut companion = vec![Complex64::ZERO; unknowns * unknowns];
        for block in 0..order {
            for i in 0..p {
                for j in 0..p {
                    companion[i * unknowns + block * p + j] = -coefficients[(block * p + i) * p + j];
                }
            }
        }
        for i in p..unknowns {
            companion[i * unknowns + i - p] = Complex64::ONE;
        }
        let roots = complex_eigenvalues(unknowns, &companion).ok()?;
        let mut poles = Vec::new();
        for u in roots {
            let pole = self.circle.pole(u.inv());
            let hardly_grows = pole.re < UNDAMPED_GROWTH * self.circle.spacing && self.circle.holds(pole.im);
            if (pole.re < 0.0 || hardly_grows) && pole.is_finite() && pole.im > 0.0 {
                let decaying = Complex64::new(-pole.re.abs(), pole.im);
                poles.push((decaying, self.participation(&coefficients, order, u)));
            }
        }
        poles.sort_by(|a, b| a.0.im.total_cmp(&b.0.im));
        Some(poles)
    }

    /// w with wᵀA(u) = 0, largest entry one: how strongly the mode shows in each column.
    fn participation(&mut self, coefficients: &[Complex64], order: usize, u: Complex64) -> Vec<Complex64> {
        let p = self.columns;
        if p == 1 {
            return vec![Complex64::ONE];
        }
        let mut a = vec![Complex64::ZERO; p * p];
        let mut power = Complex64::ONE;
        for i in 0..p {
            a[i * p + i] = Complex64::ONE;
        }
        let inverse = u.inv();
        for block in 0..order {
            power *= inverse;
            for (entry, coefficient) in a.iter_mut().zip(&coefficients[block * p * p..]) {
                *entry += power * coefficient;
            }
        }
        let norm = a.iter().map(|e| e.norm()).fold(0.0, f64::max);
        let mut w: Vec<Complex64> = (0..p).map(|i| Complex64::new(1.0, 0.1 * i as f64)).collect();
        // Inverse iteration; the shift keeps an exactly singular matrix solvable.
        let solvable = self.lu.factorize(p, |to| {
            for i in 0..p {
                for j in 0..p {
                    to[i * p + j] = a[j * p + i] + if i == j { norm * 1e-12 } else { 0.0 };
                }
            }
        });
        if solvable.is_ok() {
            for _ in 0..3 {
                self.lu.solve_in_place(&mut w);
                normalize(&mut w);
            }
        }
        normalize(&mut w);
        w
    }
}

/// Scales so that the largest entry is one.
pub(crate) fn normalize(vector: &mut [Complex64]) {
    let largest =
        vector.iter().copied().fold(Complex64::ZERO, |l, v| if v.norm() > l.norm() { v } else { l });
    if largest.norm() > 0.0 && largest.is_finite() {
        vector.iter_mut().for_each(|v| *v /= largest);
    }
}

fn add(to: &mut [Complex64], from: &[Complex64], factor: Complex64) {
    for (target, value) in to.iter_mut().zip(from) {
        *target += factor * value;
    }
}

/// Overwrites the rows of `q` by L⁻¹q, with L the Cholesky factor of the Hermitian Toeplitz matrix that has
/// `first` as first row.
fn forward_substitute(first: &[Complex64], q: &mut [Complex64], width: usize) {
    let n = first.len();
    let mut lower = vec![Complex64::ZERO; n * n];
    for i in 0..n {
        for j in 0..=i {
            let dot: Complex64 = (0..j).map(|k| lower[i * n + k] * lower[j * n + k].conj()).sum();
            let rest = first[i - j].conj() - dot;
            lower[i * n + j] = if i == j {
                // Fewer lines than powers leave nothing of a pivot: what hangs on it is left out.
                Complex64::from(if rest.re > 1e-13 * first[0].re { rest.re.sqrt() } else { f64::INFINITY })
            } else {
                rest / lower[j * n + j].re
            };
        }
    }
    for i in 0..n {
        let (above, rest) = q.split_at_mut(i * width);
        let row = &mut rest[..width];
        for (j, upper) in above.chunks_exact(width).enumerate() {
            add(row, upper, -lower[i * n + j]);
        }
        let inverse = 1.0 / lower[i * n + i].re;
        row.iter_mut().for_each(|v| *v *= inverse);
    }
}
