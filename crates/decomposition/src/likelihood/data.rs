//! The FRFs across a joint and what their model needs of the sides, prepared once for all lines.

use super::parameters::Parameters;
use super::sums::{OfLine, Sums};
use crate::averages::dynamic_stiffness;
use crate::settings::constant_joint::{LINEAR_ROUNDS, LINEAR_SETTLED};
use crate::settings::noise::UNKNOWN_NOISE;
use crate::{Compliances, DecompositionError, JointSpectrum, Sides};
use jointscope_averaging::Band;
use jointscope_frf::BlockLayout;
use jointscope_inference::NormalEquations;
use jointscope_linalg::{ComplexMatrix2, Matrix2};
use jointscope_spectra::{FrfForm, FrfSet};
use num_complex::Complex64;
use std::ops::Range;

/// A line: X = (k⁻¹ + T)⁻¹ with T = β33 + R α22 Rᵀ, and H41 = β43 X R α21.
struct Line {
    /// Its place in the recording.
    index: usize,
    s: Complex64,
    /// T.
    total: ComplexMatrix2,
    /// R α21.
    load: ComplexMatrix2,
    beta43: ComplexMatrix2,
}

/// The FRFs to be fitted and everything in their model that does not change.
pub(super) struct Data {
    lines: Vec<Line>,
    /// (response, reference) of each FRF on the blocks' motions.
    rows: Vec<([f64; 2], [f64; 2])>,
    /// Receptances and weights 2/σ², FRF after FRF within a line: the noise of a complex value has half of
    /// its variance in each part.
    measured: Vec<Complex64>,
    weights: Vec<f64>,
    scalar: bool,
}

/// The data without some lines.
pub(super) struct Part<'a> {
    data: &'a Data,
    left_out: Range<usize>,
}

/// What the linear rounds need of a line: β43 (I − X T) and β43 X with the measured X; nothing where a matrix
/// is singular.
pub(super) struct Linear(Vec<Option<[ComplexMatrix2; 2]>>);

impl Data {
    pub(super) fn new(
        frfs: &FrfSet,
        (layout, taken_apart): (&BlockLayout, &Sides),
        spectrum: &JointSpectrum,
        band: Option<Band>,
    ) -> Result<Self, DecompositionError> {
        let lines = lines_of(spectrum, band);
        Self::on(frfs, (layout, taken_apart), &spectrum.sides, &lines, spectrum.scalar)
    }

    /// The same for other sides than those that the spectrum was found with.
    pub(super) fn on(
        frfs: &FrfSet,
        (layout, taken_apart): (&BlockLayout, &Sides),
        sides: &Compliances,
        lines: &[usize],
        scalar: bool,
    ) -> Result<Self, DecompositionError> {
        if lines.is_empty() {
            return Err(DecompositionError::NoFit("the band holds no usable spectral line"));
        }
        let count = lines.len() * layout.channels.len();
        let across = crate::Relation::Exact.transport(sides.length);
        let mut data = Data {
            lines: Vec::with_capacity(lines.len()),
            rows: layout.channels.iter().map(|(_, out, input)| (out.row(), input.row())).collect(),
            measured: Vec::with_capacity(count),
            weights: Vec::with_capacity(count),
            scalar,
        };
        for &line in lines {
            let s = taken_apart.s(frfs.lines().omega(line));
            // Solved lines lie above 0 Hz.
            let integrated = frfs.form().factor_to(FrfForm::Receptance, s.im).unwrap_or(Complex64::ONE);
            let factor = integrated * taken_apart.integrated_at_s(s.im);
            for (index, ..) in &layout.channels {
                let value = frfs.values(*index)[line] * factor;
                let variance = frfs.variance(*index).map_or(0.0, |v| v[line]) * factor.norm_sqr();
                let unknown = UNKNOWN_NOISE * UNKNOWN_NOISE * value.norm_sqr();
                data.measured.push(value);
                data.weights.push(2.0 / if variance > 0.0 { variance } else { unknown });
            }
            data.lines.push(Line {
                index: line,
                s,
                total: sides.beta33[line] + across * sides.alpha22[line] * across.transpose(),
                load: across * sides.alpha21[line],
                beta43: sides.beta43[line],
            });
        }
        Ok(data)
    }

    pub(super) fn lines(&self) -> usize {
        self.lines.len()
    }

    pub(super) fn values(&self) -> usize {
        self.measured.len()
    }

    pub(super) fn whole(&self) -> Part<'_> {
        self.without(0..0)
    }

    pub(super) fn without(&self, left_out: Range<usize>) -> Part<'_> {
        Part { data: self, left_out }
    }

    /// Each FRF with its weight and value on a line.
    fn on_line(&self, index: usize) -> impl Iterator<Item = (&([f64; 2], [f64; 2]), f64, Complex64)> {
        let here = index * self.rows.len()..(index + 1) * self.rows.len();
        let values = self.weights[here.clone()].iter().zip(&self.measured[here]);
        self.rows.iter().zip(values).map(|(row, (weight, value))| (row, *weight, *value))
    }

    /// (I + k T)⁻¹ and (I + T k)⁻¹, which need no inverse of k; of a scalar joint, which has none, of its
    /// element alone.
    fn inverses(&self, joint: ComplexMatrix2, total: ComplexMatrix2) -> Option<[ComplexMatrix2; 2]> {
        if self.scalar {
            let factor = (joint.at(0, 0) * total.at(0, 0) + 1.0).inv();
            return factor.is_finite().then(|| [of_scalar(factor); 2]);
        }
        let identity = ComplexMatrix2::identity();
        let (left, right) = (identity + joint * total, identity + total * joint);
        // Both have one determinant.
        let factor = left.determinant().inv();
        let inverse = |m: ComplexMatrix2| {
            Matrix2::new(m.at(1, 1) * factor, -m.at(0, 1) * factor, -m.at(1, 0) * factor, m.at(0, 0) * factor)
        };
        factor.is_finite().then(|| [inverse(left), inverse(right)])
    }

    pub(super) fn linear(&self, spectrum: &JointSpectrum) -> Linear {
        let of_line = |line: &Line| {
            let measured = spectrum.h41.values[line.index];
            let x = if self.scalar {
                let x = measured.at(0, 0) / (line.beta43.at(0, 0) * line.load.at(0, 0));
                x.is_finite().then(|| of_scalar(x))?
            } else {
                line.beta43.inverse()? * measured * line.load.inverse()?
            };
            Some([line.beta43 * (ComplexMatrix2::identity() - x * line.total), line.beta43 * x])
        };
        Linear(self.lines.iter().map(of_line).collect())
    }

    /// Rounds of the linear problem t_pᵀ β43 [X − (I − X T) k] (I + T k₀)⁻¹ R α21 t_q = 0 for k, k₀ being the
    /// last round's.
    pub(super) fn linear_rounds(&self, linear: &Linear, start: Parameters) -> Parameters {
        let mut current = start;
        for _ in 0..LINEAR_ROUNDS {
            let joint_of = (current.stiffness(), current.damping());
            let mut sums = Sums::default();
            for (index, (line, measured)) in self.lines.iter().zip(&linear.0).enumerate() {
                let Some([left, known]) = measured else { continue };
                let joint = dynamic_stiffness(joint_of, line.s);
                let Some([_, right]) = self.inverses(joint, line.total) else { continue };
                let right = right * line.load;
                let mut own = OfLine::default();
                for ((out, input), weight, _) in self.on_line(index) {
                    let b = times_column(&right, input);
                    let [c, d] = row_times(out, known);
                    own.add(weight, c * b[0] + d * b[1], row_times(out, left), b);
                }
                sums.add(line.s, &own);
            }
            let equations: NormalEquations = sums.equations(&current);
            let Some(solution) = equations.step(0.0).map(|active| current.slots(&active)) else { break };
            if !solution.iter().all(|v| v.is_finite()) {
                break;
            }
            let [k, c] = [0, 3].map(|first| std::array::from_fn(|m| solution[first + m]));
            let next = Parameters { k, c, ..current };
            let is_settled = next.is_near(&current, LINEAR_SETTLED);
            current = next;
            if is_settled {
                break;
            }
        }
        current
    }
}

/// Lines of the recording that are fitted.
pub(super) fn lines_of(spectrum: &JointSpectrum, band: Option<Band>) -> Vec<usize> {
    let inside = |hz: f64| band.is_none_or(|b| b.contains(hz));
    spectrum.solved.iter().filter(|l| inside(l.frequency)).map(|l| l.line).collect()
}

impl Part<'_> {
    /// χ²; infinite where a line has no finite response.
    pub(super) fn chi2(&self, parameters: &Parameters) -> f64 {
        let mut chi2 = 0.0;
        let finite = self.visit(parameters, |_, own| {
            chi2 += own.residuals().map(|(_, weight, residual)| weight * residual.norm_sqr()).sum::<f64>();
        });
        if finite { chi2 } else { f64::INFINITY }
    }

    /// The sums of all lines; `None` where one has no finite response.
    pub(super) fn sums(&self, parameters: &Parameters) -> Option<Sums> {
        let mut sums = Sums::default();
        let finite = self.visit(parameters, |s, own| {
            let mut line = OfLine::default();
            for (row, weight, residual) in own.residuals() {
                sums.chi2 += weight * residual.norm_sqr();
                line.add(weight, residual, row_times(&row.0, &own.left), times_column(&own.right, &row.1));
            }
            sums.add(s, &line);
        });
        finite.then_some(sums)
    }

    /// Minus half of the gradient by the free parameters; `None` where a line has no finite response.
    pub(super) fn right(&self, parameters: &Parameters) -> Option<Vec<f64>> {
        let mut sums = Sums::default();
        let finite = self.visit(parameters, |s, own| {
            let mut line = OfLine::default();
            for (row, weight, residual) in own.residuals() {
                let (a, b) = (row_times(&row.0, &own.left), times_column(&own.right, &row.1));
                line.add_right(weight, residual, a, b);
            }
            sums.add_right(s, &line);
        });
        finite.then(|| sums.right(parameters))
    }

    /// Shows each line's model to `each`; false where one is not finite.
    fn visit(&self, parameters: &Parameters, mut each: impl FnMut(Complex64, &Modelled)) -> bool {
        let data = self.data;
        let joint_of = (parameters.stiffness(), parameters.damping());
        for (index, line) in data.lines.iter().enumerate() {
            if self.left_out.contains(&index) {
                continue;
            }
            let joint = dynamic_stiffness(joint_of, line.s);
            let Some([left, right]) = data.inverses(joint, line.total) else { return false };
            let (left, right) = (line.beta43 * left, right * line.load);
            each(line.s, &Modelled { data, index, h41: left * joint * line.load, left, right });
        }
        true
    }
}

/// A line's model, and for derivatives A = β43 X k⁻¹ and B = k⁻¹ X R α21 (δH41 = A δk B).
struct Modelled<'a> {
    data: &'a Data,
    index: usize,
    h41: ComplexMatrix2,
    left: ComplexMatrix2,
    right: ComplexMatrix2,
}

impl Modelled<'_> {
    fn residuals(&self) -> impl Iterator<Item = (&([f64; 2], [f64; 2]), f64, Complex64)> {
        self.data.on_line(self.index).map(|(row, weight, measured)| {
            let [a, b] = times_column(&self.h41, &row.1);
            (row, weight, measured - (a * row.0[0] + b * row.0[1]))
        })
    }
}

fn of_scalar(value: Complex64) -> ComplexMatrix2 {
    let zero = Complex64::ZERO;
    Matrix2::new(value, zero, zero, zero)
}

fn row_times(row: &[f64; 2], m: &ComplexMatrix2) -> [Complex64; 2] {
    [m.at(0, 0) * row[0] + m.at(1, 0) * row[1], m.at(0, 1) * row[0] + m.at(1, 1) * row[1]]
}

fn times_column(m: &ComplexMatrix2, column: &[f64; 2]) -> [Complex64; 2] {
    [m.at(0, 0) * column[0] + m.at(0, 1) * column[1], m.at(1, 0) * column[0] + m.at(1, 1) * column[1]]
}
