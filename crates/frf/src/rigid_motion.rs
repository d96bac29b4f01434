//! Deflection and rotation of a rigid block from its sensors, and force and moment from its hits (equations
//! 19 to 23).

use jointscope_linalg::{ComplexMatrix2, LeastSquares, LeastSquaresError, Matrix2};
use jointscope_spectra::{Dof, FrfForm, FrfSet, SpectraError, SpectralLines};
use num_complex::Complex64;

/// Where a channel sits on its block, seen from the block's reference point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlockChannel {
    /// Abscissa minus the reference point's, m.
    pub offset: f64,
    /// Translation (force) or rotation (moment).
    pub dof: Dof,
}

impl BlockChannel {
    /// The row t that reads the channel from the block's (y, θ): (1, offset) or (0, 1).
    pub fn row(&self) -> [f64; 2] {
        match self.dof {
            Dof::Translation => [1.0, self.offset],
            Dof::Rotation => [0.0, 1.0],
        }
    }
}

/// Which FRFs of a set tell the motion of one block due to loads on another, and from where.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockLayout {
    /// Index of each FRF in its set, where its response and its reference are.
    pub channels: Vec<(usize, BlockChannel, BlockChannel)>,
    /// Whether the responding block and the loaded one rotate; blocks that do not have one coordinate.
    pub rotate: [bool; 2],
}

/// Why a line of a measurement cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MaskReason {
    /// An accelerance has no displacement there.
    ZeroFrequency,
    /// Too few FRFs have any coherence there.
    NoCoherence,
    /// The values leave a motion undetermined.
    Undetermined,
    /// The matrix of FRFs has no inverse there.
    SingularFrf,
}

impl MaskReason {
    /// The reason in a few words.
    pub fn why(self) -> &'static str {
        match self {
            MaskReason::ZeroFrequency => "no displacement at 0 Hz",
            MaskReason::NoCoherence => "zero coherence, or no value, leaves too few FRFs",
            MaskReason::Undetermined => "the FRFs leave a motion undetermined",
            MaskReason::SingularFrf => "the FRF matrix is singular",
        }
    }
}

/// Why the motion of a block cannot be found at all.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RigidMotionError {
    /// The sensors or hits cannot tell displacement from rotation.
    #[error("the {what} on the block leave its rotation undetermined: two different abscissae are needed")]
    OnePlace {
        /// `sensors` or `hammer points`.
        what: &'static str,
    },
    /// Too few FRFs.
    #[error("{found} FRFs cannot determine the {needed} elements of the FRF matrix")]
    TooFew {
        /// FRFs given.
        found: usize,
        /// Elements to be found.
        needed: usize,
    },
    /// The set cannot be turned into receptances.
    #[error(transparent)]
    Spectra(#[from] SpectraError),
}

/// Receptances of one block's (y, θ) due to (force, moment) on another, by line, with covariance.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockFrf {
    /// The spectral lines.
    pub lines: SpectralLines,
    /// The 2×2 receptance matrix by line: m/N, m/(N·m); rad/N, rad/(N·m). Zero where masked.
    pub values: Vec<ComplexMatrix2>,
    /// Covariance E[δh δh̄ᵀ] of the elements (11, 12, 21, 22) by line; real, since the noise is circular.
    /// Absent where the set carries no variances.
    pub covariance: Option<Vec<[[f64; 4]; 4]>>,
    /// Lines that cannot be used, by index, ascending.
    pub masked: Vec<(usize, MaskReason)>,
    /// FRFs beyond those needed, a line.
    pub surplus: usize,
    /// χ² of the rigid motion by line (2 × surplus degrees of freedom), zero where masked or without
    /// surplus. With no variances it is relative: Σ|residual|² over Σ|FRF|².
    pub residual: Vec<f64>,
}

impl BlockFrf {
    /// χ² per degree of freedom over all usable lines: about 1 where the blocks moved rigidly and the
    /// variances are right; `None` without surplus FRFs or variances.
    pub fn rigidity(&self) -> Option<f64> {
        let used = self.lines.len() - self.masked.len();
        if self.surplus == 0 || self.covariance.is_none() || used == 0 {
            return None;
        }
        Some(self.residual.iter().sum::<f64>() / (2.0 * self.surplus as f64 * used as f64))
    }
}

/// Finds H, row (y, θ) of the responding block, column (force, moment) on the loaded block, from FRFs
/// H_pq = t_pᵀ H t_q by weighted least squares, line by line (eq 23 with any number of FRFs).
///
/// Weights are one over the variances that `frfs` carries; without variances, all equal. An FRF counts at a
/// line only where its coherence, if recorded, is above zero. With exactly as many FRFs as elements the
/// answer is that of the paper's differences (eq 19, 22, 23).
///
/// # Errors
/// See [`RigidMotionError`]. Single lines that cannot be solved are masked instead.
pub fn fit_rigid_motion(frfs: &FrfSet, layout: &BlockLayout) -> Result<BlockFrf, RigidMotionError> {
    let unknown = elements(layout.rotate);
    check_geometry(layout, unknown.len())?;
    let count = frfs.lines().len();
    let mut result = BlockFrf {
        values: vec![Matrix2::zero(); count],
        covariance: frfs.variance(0).map(|_| vec![[[0.0; 4]; 4]; count]),
        masked: Vec::new(),
        surplus: layout.channels.len() - unknown.len(),
        residual: vec![0.0; count],
        lines: frfs.lines().clone(),
    };
    let mut fit = LineFit::new(frfs, layout, unknown);
    for line in 0..count {
        match fit.solve(line) {
            Ok(left) => fit.write(line, left, &mut result),
            Err(reason) => result.masked.push((line, reason)),
        }
    }
    Ok(result)
}

/// The elements of H that are to be found: row and column.
fn elements([responding, loaded]: [bool; 2]) -> Vec<(usize, usize)> {
    (0..1 + usize::from(responding)).flat_map(|i| (0..1 + usize::from(loaded)).map(move |j| (i, j))).collect()
}

/// The least squares problem of one line after the other.
struct LineFit<'a> {
    frfs: &'a FrfSet,
    layout: &'a BlockLayout,
    unknown: Vec<(usize, usize)>,
    /// By FRF, what each unknown element contributes to it.
    design: Vec<Vec<f64>>,
    problem: LeastSquares,
    solution: Vec<Complex64>,
}

/// Weighted sums of squares on a line.
struct Left {
    residual: f64,
    values: f64,
}

impl<'a> LineFit<'a> {
    fn new(frfs: &'a FrfSet, layout: &'a BlockLayout, unknown: Vec<(usize, usize)>) -> Self {
        let coefficients = |(_, response, reference): &(usize, BlockChannel, BlockChannel)| -> Vec<f64> {
            let (out, input) = (response.row(), reference.row());
            unknown.iter().map(|&(i, j)| out[i] * input[j]).collect()
        };
        let design = layout.channels.iter().map(coefficients).collect();
        let solution = vec![Complex64::ZERO; unknown.len()];
        LineFit { frfs, layout, unknown, design, problem: LeastSquares::new(), solution }
    }

    /// Solves a line, or says why it cannot be used.
    fn solve(&mut self, line: usize) -> Result<Left, MaskReason> {
        let omega = self.frfs.lines().omega(line);
        let factor = self.frfs.form().factor_to(FrfForm::Receptance, omega);
        let factor = factor.ok_or(MaskReason::ZeroFrequency)?;
        self.problem.begin(self.unknown.len());
        let mut size = 0.0;
        for ((index, ..), coefficients) in self.layout.channels.iter().zip(&self.design) {
            let value = self.frfs.values(*index)[line] * factor;
            let weight = weight(self.frfs, (*index, line), factor.norm_sqr());
            size += weight * value.norm_sqr();
            self.problem.equation(coefficients, value, weight);
        }
        match self.problem.solve(&mut self.solution) {
            Ok(residual) => Ok(Left { residual, values: size }),
            Err(LeastSquaresError::TooFewEquations { .. }) => Err(MaskReason::NoCoherence),
            Err(_) => Err(MaskReason::Undetermined),
        }
    }

    /// Writes the line solved last.
    fn write(&self, line: usize, left: Left, result: &mut BlockFrf) {
        for (&(i, j), value) in self.unknown.iter().zip(&self.solution) {
            result.values[line].0[i][j] = *value;
        }
        if let Some(covariance) = &mut result.covariance {
            for (a, &(i, j)) in self.unknown.iter().enumerate() {
                for (b, &(k, l)) in self.unknown.iter().enumerate() {
                    covariance[line][2 * i + j][2 * k + l] = self.problem.covariance(a, b);
                }
            }
            // The noise of a complex value has two degrees of freedom, each with half of its variance.
            result.residual[line] = 2.0 * left.residual;
        } else if left.values > 0.0 {
            result.residual[line] = left.residual / left.values;
        }
    }
}

/// Weight of an FRF's receptance on a line, `scale` times the variance being that of the receptance; zero
/// where it was not measured.
fn weight(frfs: &FrfSet, (index, line): (usize, usize), scale: f64) -> f64 {
    match frfs.variance(index) {
        _ if !frfs.is_measured(index, line) => 0.0,
        Some(variance) if variance[line] > 0.0 => 1.0 / (variance[line] * scale),
        Some(_) | None => 1.0,
    }
}

fn check_geometry(layout: &BlockLayout, needed: usize) -> Result<(), RigidMotionError> {
    let spans = |channels: Vec<BlockChannel>| {
        let turned = channels.iter().any(|c| c.dof == Dof::Rotation);
        let moved: Vec<f64> =
            channels.iter().filter(|c| c.dof == Dof::Translation).map(|c| c.offset).collect();
        let apart = moved.iter().any(|x| (x - moved[0]).abs() > 1e-9);
        apart || (turned && !moved.is_empty())
    };
    if layout.rotate[0] && !spans(layout.channels.iter().map(|c| c.1).collect()) {
        return Err(RigidMotionError::OnePlace { what: "sensors" });
    }
    if layout.rotate[1] && !spans(layout.channels.iter().map(|c| c.2).collect()) {
        return Err(RigidMotionError::OnePlace { what: "hammer points" });
    }
    if layout.channels.len() < needed {
        return Err(RigidMotionError::TooFew { found: layout.channels.len(), needed });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_spectra::FrfPair;

    const SENSORS: [f64; 3] = [0.0, -0.06, -0.03];
    const HITS: [f64; 3] = [0.0, 0.058, 0.02];

    fn channel(offset: f64) -> BlockChannel {
        BlockChannel { offset, dof: Dof::Translation }
    }

    fn layout(sensors: &[f64], hits: &[f64]) -> BlockLayout {
        let mut channels = Vec::new();
        for &hit in hits {
            for &sensor in sensors {
                channels.push((channels.len(), channel(sensor), channel(hit)));
            }
        }
        BlockLayout { channels, rotate: [true, true] }
    }

    /// Receptances of a known matrix at the given channels, `error` added to the last one.
    fn frfs(known: ComplexMatrix2, sensors: &[f64], hits: &[f64], error: f64) -> FrfSet {
        let mut pairs = Vec::new();
        let mut values = Vec::new();
        for (q, hit) in hits.iter().enumerate() {
            for (p, sensor) in sensors.iter().enumerate() {
                pairs.push(FrfPair::transverse(&format!("s{p}"), &format!("h{q}")));
                let row = |j: usize| known.at(0, j) + known.at(1, j) * *sensor;
                values.push(row(0) + row(1) * *hit);
            }
        }
        if let Some(last) = values.last_mut() {
            *last += error;
        }
        let lines = SpectralLines::new(vec![100.0]).unwrap();
        FrfSet::new(lines, FrfForm::Receptance, pairs, values).unwrap()
    }

    fn known() -> ComplexMatrix2 {
        let c = Complex64::new;
        Matrix2::new(c(1.0, 0.2), c(-0.3, 4.0), c(5.0, -2.0), c(30.0, 11.0))
    }

    /// H41 from the responses at points 4 and 3 to a force at 1 and to one at 2, `sensors` from 3 to 4 and
    /// `hits` from 1 to 2, m: rotations are differences of sensors (19), moments differences of forces (22,
    /// 23).
    fn by_differences(
        per_force_1: [Complex64; 2],
        per_force_2: [Complex64; 2],
        sensors: f64,
        hits: f64,
    ) -> ComplexMatrix2 {
        let rotation = |[right, left]: [Complex64; 2]| (right - left) / sensors;
        let per_moment = |at_2: Complex64, at_1: Complex64| (at_2 - at_1) / hits;
        Matrix2::new(
            per_force_1[0],
            per_moment(per_force_2[0], per_force_1[0]),
            rotation(per_force_1),
            per_moment(rotation(per_force_2), rotation(per_force_1)),
        )
    }

    #[test]
    fn four_frfs_are_the_exactly_determined_case_of_eq_23() {
        let set =
            frfs(known(), &SENSORS[..2], &HITS[..2], 0.01).with_variance(vec![1.0, 9.0, 4.0, 0.5]).unwrap();
        let fit = fit_rigid_motion(&set, &layout(&SENSORS[..2], &HITS[..2])).unwrap();
        let v = |i: usize| set.values(i)[0];
        let direct = by_differences([v(0), v(1)], [v(2), v(3)], 0.06, 0.058);
        assert!((fit.values[0] - direct).norm_squared().sqrt() < 1e-11);
        assert_eq!((fit.surplus, fit.rigidity()), (0, None));
    }

    #[test]
    fn nine_frfs_that_agree_leave_no_residual_and_one_that_disagrees_leaves_one() {
        let all = layout(&SENSORS, &HITS);
        let fit = |error| {
            let set = frfs(known(), &SENSORS, &HITS, error).with_variance(vec![1e-6; 9]).unwrap();
            fit_rigid_motion(&set, &all).unwrap()
        };
        assert!((fit(0.0).values[0] - known()).norm_squared().sqrt() < 1e-10);
        assert!(fit(0.0).rigidity().unwrap() < 1e-12);
        assert!(fit(0.01).rigidity().unwrap() > 5.0, "{:?}", fit(0.01).rigidity());
    }

    #[test]
    fn accelerances_are_turned_into_displacements() {
        let set = frfs(known(), &SENSORS[..2], &HITS[..2], 0.0);
        let fit =
            fit_rigid_motion(&set.to_form(FrfForm::Accelerance).unwrap(), &layout(&SENSORS[..2], &HITS[..2]));
        assert!((fit.unwrap().values[0] - known()).norm_squared().sqrt() < 1e-10);
    }

    #[test]
    fn sensors_all_at_one_abscissa_are_refused_by_name() {
        let set = frfs(known(), &[0.01, 0.01], &HITS[..2], 0.0);
        let error = fit_rigid_motion(&set, &layout(&[0.01, 0.01], &HITS[..2])).unwrap_err();
        assert_eq!(error, RigidMotionError::OnePlace { what: "sensors" });
    }

    #[test]
    fn a_line_without_coherence_is_masked_and_a_surplus_frf_without_it_is_not_missed() {
        let mut four = frfs(known(), &SENSORS[..2], &HITS[..2], 0.0);
        four.set_coherence(1, vec![0.0]).unwrap();
        let fit = fit_rigid_motion(&four, &layout(&SENSORS[..2], &HITS[..2])).unwrap();
        assert_eq!(fit.masked, [(0, MaskReason::NoCoherence)]);
        let mut nine = frfs(known(), &SENSORS, &HITS, 0.5);
        nine.set_coherence(8, vec![0.0]).unwrap();
        let fit = fit_rigid_motion(&nine, &layout(&SENSORS, &HITS)).unwrap();
        assert!(fit.masked.is_empty() && (fit.values[0] - known()).norm_squared().sqrt() < 1e-10);
    }

    #[test]
    fn a_rotation_sensor_and_one_accelerometer_do_as_well_as_two_accelerometers() {
        let set = frfs(known(), &[0.0, 1.0], &HITS[..2], 0.0);
        // The difference of readings 1 m apart is the rotation in radians.
        let mut values = set.all_values().to_vec();
        values[1] = values[1] - values[0];
        values[3] = values[3] - values[2];
        let set = FrfSet::new(set.lines().clone(), set.form(), set.pairs().to_vec(), values).unwrap();
        let mut layout = layout(&[0.0, 0.0], &HITS[..2]);
        layout.channels[1].1.dof = Dof::Rotation;
        layout.channels[3].1.dof = Dof::Rotation;
        let fit = fit_rigid_motion(&set, &layout).unwrap();
        assert!((fit.values[0] - known()).norm_squared().sqrt() < 1e-10);
    }

    #[test]
    fn storeys_need_one_frf_each() {
        let lines = SpectralLines::new(vec![10.0]).unwrap();
        let set = FrfSet::new(
            lines,
            FrfForm::Receptance,
            vec![FrfPair::transverse("2", "1")],
            vec![Complex64::new(0.3, 0.1)],
        );
        let layout = BlockLayout { channels: vec![(0, channel(0.0), channel(0.0))], rotate: [false, false] };
        let fit = fit_rigid_motion(&set.unwrap(), &layout).unwrap();
        assert_eq!(fit.values[0].at(0, 0), Complex64::new(0.3, 0.1));
    }
}
