//! One symmetric, passive k and c for the whole band, fitted to the FRFs themselves.

mod parameters;

use crate::averages::dynamic_stiffness;
use crate::{Compliances, DecompositionError, JointSpectrum, MeasurementPlan, Sides};
use jointscope_averaging::Band;
use jointscope_frf::{BlockChannel, BlockLayout};
use jointscope_inference::{Damping, LeastSquares, NormalEquations, Precision, Settings, descend, jackknife};
use jointscope_linalg::{self as linalg, ComplexMatrix2, Matrix2, RealMatrix2};
use jointscope_spectra::{Dof, FrfForm, FrfSet};
use num_complex::Complex64;
use parameters::Parameters;

/// The maximum-likelihood joint.
#[derive(Debug, Clone, PartialEq)]
pub struct LikelihoodFit {
    /// K, symmetric: N/m, N/rad, N·m/rad.
    pub stiffness: RealMatrix2,
    /// C, symmetric and passive (it never gives out energy): N·s/m, N·s/rad, N·m·s/rad.
    pub damping: RealMatrix2,
    /// Standard deviations of K.
    pub stiffness_std: RealMatrix2,
    /// Standard deviations of C.
    pub damping_std: RealMatrix2,
    /// Covariance of (k11, k12, k22, c11, c12, c22). As the deviations, it is widened by χ² per degree of freedom
    /// where that is above one.
    pub covariance: [[f64; 6]; 6],
    /// χ² per degree of freedom: 1 where a constant joint explains the FRFs within their noise.
    pub chi2_per_dof: f64,
    /// Covariance of (k11, k12, k22, c11, c12, c22) from how far they move when one of eight blocks of lines is left
    /// out (a jackknife): what a joint that is not quite constant, or a fixture that is not quite right, does to them.
    /// Zero where χ² gives no reason to look.
    pub model_covariance: [[f64; 6]; 6],
    /// Whether c would give out energy if it were free, and was held to c = v vᵀ.
    pub is_on_the_boundary: bool,
    /// Complex values fitted.
    pub values: usize,
}

/// χ² per degree of freedom above which a constant joint does not explain the FRFs within their noise.
const POOR_FIT: f64 = 1.3;
/// Rounds of the linear fit that finds the start.
const ROUNDS: usize = 12;
/// Near the optimum χ² is nearly quadratic: undamped steps converge within a few.
const DAMPING: Damping = Damping { initial: 1e-6, decrease: 0.03, least: 1e-15, raised: 0.0, most: 1e8 };

/// Fits a constant k + sc (s = iω, or δ + iω under an exponential window) to the FRFs across the joint on the lines in `band` (all usable ones without).
///
/// With X = (k⁻¹ + T)⁻¹, T = β33 + R α22 Rᵀ, an FRF is rational in k, and resonances make a trap of every poor start.
/// But (I − X T) k = X is linear: solved with the measured X and the last round's (I + T k)⁻¹ as weight, it leads
/// close to the optimum within a few rounds, from the spectrum's medians or from `nominal`.
/// Levenberg–Marquardt with analytic derivatives goes on from there and from the starts themselves; the lowest χ² is kept. Where c comes out giving off energy, it is fitted
/// again as c = v vᵀ, the boundary of what is passive.
///
/// The fit weighs every FRF by the variance it carries; FRFs without variances weigh alike. Where χ² says that a constant joint
/// does not explain the FRFs, a jackknife over the band says what that leaves uncertain.
///
/// # Errors
/// No usable line in the band, or FRFs that leave an element of k or c undetermined.
pub fn maximum_likelihood(
    frfs: &FrfSet,
    sides: &Sides,
    spectrum: &JointSpectrum,
    band: Option<Band>,
    nominal: Option<RealMatrix2>,
) -> Result<LikelihoodFit, DecompositionError> {
    let plan = MeasurementPlan::of(frfs, sides)?;
    let data = Data::new(frfs, (&plan.layout, sides), spectrum, band)?;
    let starts = [Some(start_of(spectrum)), nominal].into_iter().flatten();
    let fitted =
        starts.filter_map(|k| Parameters::of(k, k.scale(START_LOSS), spectrum.scalar)).flat_map(|start| {
            // The linear rounds mislead where the model is far from right; plain steps do where the start is.
            [data.fit(data.linear_rounds(spectrum, start)), data.fit(start)]
        });
    let best = |a: (f64, Parameters), b: (f64, Parameters)| if b.0 < a.0 { b } else { a };
    let (mut chi2, mut joint) = fitted
        .filter(|(chi2, joint)| chi2.is_finite() && joint.k[0] > 0.0)
        .reduce(best)
        .ok_or(DecompositionError::NoFit("no start gives finite FRFs"))?;
    if !joint.is_passive() {
        (chi2, joint) = data.fit(joint.on_the_boundary());
    }
    let mut fit = data.result(chi2, &joint)?;
    if fit.chi2_per_dof > EXPLAINED {
        fit.model_covariance = data.jackknife(&joint);
    }
    Ok(fit)
}

/// The optimum next to `near`, for a recording or a fixture that differs a little from that of `near`: what the
/// difference does, without a jump to another minimum.
///
/// # Errors
/// As [`maximum_likelihood`].
pub(crate) fn continued(
    frfs: &FrfSet,
    sides: &Sides,
    spectrum: &JointSpectrum,
    band: Option<Band>,
    near: &LikelihoodFit,
) -> Result<LikelihoodFit, DecompositionError> {
    let plan = MeasurementPlan::of(frfs, sides)?;
    let data = Data::new(frfs, (&plan.layout, sides), spectrum, band)?;
    let start = Parameters::of(near.stiffness, near.damping, spectrum.scalar)
        .ok_or(DecompositionError::NoFit("the joint it starts from is none"))?;
    let start = if near.is_on_the_boundary { start.on_the_boundary() } else { start };
    let (chi2, joint) = data.fit(start);
    data.result(chi2, &joint)
}

impl LikelihoodFit {
    /// Whether one constant k and c explains the FRFs within their noise.
    pub fn explains(&self) -> bool {
        self.chi2_per_dof <= POOR_FIT
    }

    /// Standard deviations of K and C from [`LikelihoodFit::model_covariance`].
    pub fn model_std(&self) -> (RealMatrix2, RealMatrix2) {
        let std = |first: usize| {
            let s = |m: usize| self.model_covariance[first + m][first + m].sqrt();
            Matrix2::new(s(0), s(1), s(1), s(2))
        };
        (std(0), std(3))
    }
}

/// χ² per degree of freedom up to which a constant joint counts as explaining the FRFs: variances from few averages
/// are themselves known to a few per cent.
const EXPLAINED: f64 = 1.2;
/// Blocks of neighbouring lines that the jackknife leaves out in turn.
const BLOCKS: usize = 8;

/// c/k of the start, s: a loss factor of 0.6 % at 300 Hz.
const START_LOSS: f64 = 3e-6;

/// Robust start: medians over the solved lines.
fn start_of(spectrum: &JointSpectrum) -> RealMatrix2 {
    let at = |i: usize, j: usize| {
        let mut values: Vec<f64> = spectrum.solved.iter().map(|line| line.stiffness.at(i, j)).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let cross = 0.5 * (at(0, 1) + at(1, 0));
    Matrix2::new(at(0, 0), cross, cross, at(1, 1))
}

/// The FRFs to be fitted and everything in their model that does not change.
struct Data<'a> {
    sides: &'a Compliances,
    across: ComplexMatrix2,
    /// (line of the recording, s).
    lines: Vec<(usize, Complex64)>,
    rows: Vec<([f64; 2], [f64; 2])>,
    /// Receptances and variances, FRF after FRF within a line.
    measured: Vec<Complex64>,
    variance: Vec<f64>,
    scalar: bool,
}

impl<'a> Data<'a> {
    fn new(
        frfs: &FrfSet,
        (layout, taken_apart): (&BlockLayout, &Sides),
        spectrum: &'a JointSpectrum,
        band: Option<Band>,
    ) -> Result<Self, DecompositionError> {
        let inside = |hz: f64| band.is_none_or(|b| b.contains(hz));
        let lines: Vec<(usize, Complex64)> = spectrum
            .solved
            .iter()
            .filter(|l| inside(l.frequency))
            .map(|l| (l.line, taken_apart.s(frfs.lines().omega(l.line))))
            .collect();
        if lines.is_empty() {
            return Err(DecompositionError::NoFit("the band holds no usable spectral line"));
        }
        let row = |seat: &BlockChannel| match seat.dof {
            Dof::Translation => [1.0, seat.offset],
            Dof::Rotation => [0.0, 1.0],
        };
        let mut data = Data {
            sides: &spectrum.sides,
            across: crate::Relation::Exact.transport(spectrum.sides.length),
            rows: layout.channels.iter().map(|(_, out, input)| (row(out), row(input))).collect(),
            measured: Vec::with_capacity(lines.len() * layout.channels.len()),
            variance: Vec::with_capacity(lines.len() * layout.channels.len()),
            scalar: spectrum.scalar,
            lines,
        };
        for &(line, s) in &data.lines {
            // Solved lines lie above 0 Hz.
            let integrated = frfs.form().factor_to(FrfForm::Receptance, s.im).unwrap_or(Complex64::ONE);
            let factor = integrated * taken_apart.integrated_at_s(s.im);
            for (index, ..) in &layout.channels {
                let value = frfs.values(*index)[line] * factor;
                let variance = frfs.variance(*index).map_or(0.0, |v| v[line]) * factor.norm_sqr();
                data.measured.push(value);
                data.variance.push(if variance > 0.0 { variance } else { 1e-6 * value.norm_sqr() });
            }
        }
        Ok(data)
    }

    /// Model receptances of one line and, for derivatives, A = β43 X k⁻¹ and B = k⁻¹ X R α21 (δH41 = A δk B).
    fn model(
        &self,
        joint: ComplexMatrix2,
        line: usize,
    ) -> Option<(ComplexMatrix2, ComplexMatrix2, ComplexMatrix2)> {
        let s = self.sides;
        let near = self.across * s.alpha22[line] * self.across.transpose();
        let load = self.across * s.alpha21[line];
        // X k⁻¹ = (I + k (β33 + R α22 Rᵀ))⁻¹ needs no inverse of k, which a scalar joint does not have.
        let total = s.beta33[line] + near;
        let (left, right) = if self.scalar {
            let factor = (joint.at(0, 0) * total.at(0, 0) + 1.0).inv();
            let unit = Matrix2::new(factor, Complex64::ZERO, Complex64::ZERO, Complex64::ZERO);
            (s.beta43[line] * unit, unit * load)
        } else {
            let left = (ComplexMatrix2::identity() + joint * total).inverse()?;
            let right = (ComplexMatrix2::identity() + total * joint).inverse()?;
            (s.beta43[line] * left, right * load)
        };
        Some((left * joint * load, left, right))
    }

    /// χ²; every weight, residual and derivative by (k11, k12, k22, c11, c12, c22) is shown to `each`.
    fn visit(&self, parameters: &Parameters, mut each: impl FnMut(f64, Complex64, &[Complex64; 6])) -> f64 {
        let (k, c) = (parameters.stiffness(), parameters.damping());
        let channels = self.rows.len();
        let mut chi2 = 0.0;
        for (index, &(line, s)) in self.lines.iter().enumerate() {
            let joint = dynamic_stiffness((k, c), s);
            let Some((h41, left, right)) = self.model(joint, line) else { return f64::INFINITY };
            for (channel, (out, input)) in self.rows.iter().enumerate() {
                let at = index * channels + channel;
                let residual = self.measured[at] - bilinear(out, &h41, input);
                // The noise of a complex value has half of its variance in each part.
                let weight = 2.0 / self.variance[at];
                chi2 += weight * residual.norm_sqr();
                each(weight, residual, &derivatives(s, row_times(out, &left), times_column(&right, input)));
            }
        }
        chi2
    }

    /// Rounds of the linear problem t_pᵀ β43 [X − (I − X T) k] (I + T k₀)⁻¹ R α21 t_q = 0 for k, k₀ being the last round's.
    fn linear_rounds(&self, spectrum: &JointSpectrum, start: Parameters) -> Parameters {
        let mut current = start;
        for _ in 0..ROUNDS {
            let mut normal = NormalEquations::zero(current.active().len());
            for (index, &(line, s)) in self.lines.iter().enumerate() {
                let Some(x) = self.measured_coupling(&spectrum.h41.values[line], line) else { continue };
                let sides = self.sides;
                let total = sides.beta33[line] + self.across * sides.alpha22[line] * self.across.transpose();
                let joint = dynamic_stiffness((current.stiffness(), current.damping()), s);
                let Some((_, _, right)) = self.model(joint, line) else { continue };
                let left = sides.beta43[line] * (ComplexMatrix2::identity() - x * total);
                let known = sides.beta43[line] * x * right;
                for (channel, (out, input)) in self.rows.iter().enumerate() {
                    let weight = 2.0 / self.variance[index * self.rows.len() + channel];
                    let by_kc = derivatives(s, row_times(out, &left), times_column(&right, input));
                    normal.add_complex(weight, bilinear(out, &known, input), &current.of_active(&by_kc));
                }
            }
            let Some(solution) = normal.step(0.0).map(|active| current.slots(&active)) else { break };
            let next = Parameters {
                k: [solution[0], solution[1], solution[2]],
                c: [solution[3], solution[4], solution[5]],
                ..current
            };
            if !solution.iter().all(|v| v.is_finite()) {
                break;
            }
            current = next;
        }
        current
    }

    /// X = β43⁻¹ H41 (R α21)⁻¹; `None` where a matrix is singular.
    fn measured_coupling(&self, h41: &ComplexMatrix2, line: usize) -> Option<ComplexMatrix2> {
        let (beta43, load) = (self.sides.beta43[line], self.across * self.sides.alpha21[line]);
        if self.scalar {
            let x = h41.at(0, 0) / (beta43.at(0, 0) * load.at(0, 0));
            let zero = Complex64::ZERO;
            return x.is_finite().then_some(Matrix2::new(x, zero, zero, zero));
        }
        Some(beta43.inverse()? * *h41 * load.inverse()?)
    }

    /// χ² and parameters at the optimum next to `start`.
    fn fit(&self, start: Parameters) -> (f64, Parameters) {
        let settings = Settings { damping: DAMPING, ..Settings::default() };
        descend(self, self.placed(start), None, &settings).map_or((f64::INFINITY, start), |fit| fit.point)
    }

    fn placed(&self, parameters: Parameters) -> (f64, Parameters) {
        (self.visit(&parameters, |_, _, _| {}), parameters)
    }

    /// The spread of the fits without each of the blocks, as a covariance of the fit to all.
    fn jackknife(&self, at: &Parameters) -> [[f64; 6]; 6] {
        let channels = self.rows.len();
        let blocks = BLOCKS.min(self.lines.len());
        let fits: Vec<Vec<f64>> = (0..blocks)
            .map(|block| {
                let edge = |b: usize| b * self.lines.len() / blocks;
                let (from, to) = (edge(block), edge(block + 1));
                let outside = |i: &usize| *i < from || *i >= to;
                let values = |i: &usize| outside(&(i / channels));
                let pick = |all: &[f64]| (0..all.len()).filter(values).map(|i| all[i]).collect();
                let rest = Data {
                    sides: self.sides,
                    across: self.across,
                    lines: (0..self.lines.len()).filter(outside).map(|i| self.lines[i]).collect(),
                    rows: self.rows.clone(),
                    measured: (0..self.measured.len()).filter(values).map(|i| self.measured[i]).collect(),
                    variance: pick(&self.variance),
                    scalar: self.scalar,
                };
                let Parameters { k, c, .. } = rest.fit(*at).1;
                [k, c].concat()
            })
            .collect();
        let spread = jackknife(&fits);
        std::array::from_fn(|m| std::array::from_fn(|n| spread.at(m, n)))
    }

    fn result(&self, chi2: f64, fitted: &Parameters) -> Result<LikelihoodFit, DecompositionError> {
        // Deviations are those of free elements, on the boundary too.
        let active = Parameters { boundary: None, ..*fitted }.active();
        let mut problem = linalg::LeastSquares::new();
        problem.begin(active.len());
        self.visit(fitted, |weight, residual, by_kc| {
            let re: Vec<f64> = active.iter().map(|&m| by_kc[m].re).collect();
            let im: Vec<f64> = active.iter().map(|&m| by_kc[m].im).collect();
            problem.equation(&re, Complex64::new(residual.re, 0.0), weight);
            problem.equation(&im, Complex64::new(residual.im, 0.0), weight);
        });
        let mut unused = vec![Complex64::ZERO; active.len()];
        problem
            .solve(&mut unused)
            .map_err(|_| DecompositionError::NoFit("the FRFs leave an element of k or c undetermined"))?;
        let degrees = (2 * self.measured.len()).saturating_sub(active.len()).max(1);
        let chi2_per_dof = chi2 / degrees as f64;
        let widening = chi2_per_dof.max(1.0);
        let mut covariance = [[0.0; 6]; 6];
        for (a, &m) in active.iter().enumerate() {
            for (b, &n) in active.iter().enumerate() {
                covariance[m][n] = problem.covariance(a, b) * widening;
            }
        }
        let std = |first: usize| {
            let s = |m: usize| covariance[first + m][first + m].sqrt();
            Matrix2::new(s(0), s(1), s(1), s(2))
        };
        Ok(LikelihoodFit {
            stiffness: fitted.stiffness(),
            damping: fitted.damping(),
            stiffness_std: std(0),
            damping_std: std(3),
            covariance,
            chi2_per_dof,
            is_on_the_boundary: fitted.boundary.is_some(),
            model_covariance: [[0.0; 6]; 6],
            values: self.measured.len(),
        })
    }
}

impl LeastSquares for Data<'_> {
    /// χ² and parameters.
    type Point = (f64, Parameters);
    type Weights = ();
    type Derivatives = ();
    type Equations = NormalEquations;
    const FIXED_WEIGHTS: bool = true;

    fn weights(&self, _: &Self::Point) {}

    fn objective(&self, (chi2, _): &Self::Point, _: &()) -> f64 {
        *chi2
    }

    /// In closed form, and taken with the residuals.
    fn derivatives(&self, _: &Self::Point, _: Precision) -> Option<()> {
        Some(())
    }

    fn equations(&self, (_, current): &Self::Point, _: &(), _: &()) -> NormalEquations {
        let mut normal = NormalEquations::zero(current.active().len());
        self.visit(current, |weight, residual, by_kc| {
            normal.add_complex(weight, residual, &current.of_active(&current.chain(by_kc)));
        });
        normal
    }

    fn stepped(
        &self,
        (_, from): &Self::Point,
        normal: &NormalEquations,
        damping: f64,
    ) -> Option<Self::Point> {
        let step = normal.step(damping)?;
        Some(self.placed(from.stepped(&from.slots(&step))))
    }
}

/// Derivatives of aᵀ (k + sc) b by (k11, k12, k22, c11, c12, c22), both matrices symmetric.
fn derivatives(s: Complex64, a: [Complex64; 2], b: [Complex64; 2]) -> [Complex64; 6] {
    let by_k = [a[0] * b[0], a[0] * b[1] + a[1] * b[0], a[1] * b[1]];
    [by_k[0], by_k[1], by_k[2], s * by_k[0], s * by_k[1], s * by_k[2]]
}

fn row_times(row: &[f64; 2], m: &ComplexMatrix2) -> [Complex64; 2] {
    [0, 1].map(|j| m.at(0, j) * row[0] + m.at(1, j) * row[1])
}

fn times_column(m: &ComplexMatrix2, column: &[f64; 2]) -> [Complex64; 2] {
    [0, 1].map(|i| m.at(i, 0) * column[0] + m.at(i, 1) * column[1])
}

fn bilinear(out: &[f64; 2], h: &ComplexMatrix2, input: &[f64; 2]) -> Complex64 {
    let column = times_column(h, input);
    column[0] * out[0] + column[1] * out[1]
}
