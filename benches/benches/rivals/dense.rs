//! Receptances by assembling and solving the dense dynamic stiffness on every line, as a plain program would.

use faer::linalg::solvers::Solve;
use jointscope_benches::cases::{ADDED_MASS, Attachments, RESONATOR, SOFTENED, SUPPORT, chain, ends};
use jointscope_lumped::{Assembly, Station};
use nalgebra::DMatrix;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Matrices of a chain with everything on it, and the rows that read and load it.
pub(crate) struct Dense {
    order: usize,
    mass: Vec<f64>,
    viscous: Vec<f64>,
    stiffness: Vec<f64>,
    supports: Vec<Vec<f64>>,
    added_mass: Option<Vec<f64>>,
    resonator: Option<Vec<f64>>,
    outputs: Vec<Vec<f64>>,
    inputs: Vec<Vec<f64>>,
}

impl Dense {
    /// The same model as [`chain`] describes, four FRFs between its ends.
    pub(crate) fn new(bodies: usize, attachments: Attachments) -> Self {
        let assembly =
            Assembly::new(&chain(bodies, Attachments::None), 1000.0).expect("the modes of a chain");
        let rows = |stations: &[Station]| -> Vec<Vec<f64>> {
            stations.iter().map(|s| assembly.station_row(s)).collect()
        };
        let (outputs, inputs) = ends(bodies);
        let centre = |body: usize| assembly.station_row(&Station::transverse(body, body as f64 * 0.125));
        let effects = attachments == Attachments::SupportsAndEffects;
        let mut stiffness = assembly.stiffness().to_vec();
        if effects {
            soften_first_joint(&mut stiffness, bodies);
        }
        let supports = if attachments == Attachments::None { &[][..] } else { &[inputs[0], outputs[0]] };
        Dense {
            order: assembly.order(),
            mass: assembly.mass().to_vec(),
            viscous: assembly.viscous_damping(),
            stiffness,
            supports: rows(supports),
            added_mass: effects.then(|| centre(0)),
            resonator: effects.then(|| centre(bodies - 1)),
            outputs: rows(&outputs),
            inputs: rows(&inputs),
        }
    }

    /// Calls `add(i, j, value)` for every contribution to Z(s) = s²M + sC + K and what is attached.
    fn assemble(&self, s: Complex64, mut add: impl FnMut(usize, usize, Complex64)) {
        let n = self.order;
        let squared = s * s;
        for i in 0..n {
            for j in 0..n {
                let k = i * n + j;
                add(i, j, squared * self.mass[k] + s * self.viscous[k] + self.stiffness[k]);
            }
        }
        let mut point = |row: &[f64], value: Complex64| {
            // The rows of a rigid body's points have two entries.
            for i in (0..n).filter(|&i| row[i] != 0.0) {
                for j in (0..n).filter(|&j| row[j] != 0.0) {
                    add(i, j, value * (row[i] * row[j]));
                }
            }
        };
        for row in &self.supports {
            point(row, SUPPORT.0 + s * SUPPORT.1);
        }
        if let Some(row) = &self.added_mass {
            point(row, squared * ADDED_MASS);
        }
        if let Some(row) = &self.resonator {
            let (mass, frequency, ratio) = RESONATOR;
            let omega = TAU * frequency;
            let spring = omega * omega + s * (2.0 * ratio * omega);
            point(row, squared * mass * spring / (squared + spring));
        }
    }

    /// The four receptances at one line by nalgebra's LU.
    pub(crate) fn nalgebra(&self, s: Complex64, values: &mut [Complex64]) {
        let n = self.order;
        let mut z = DMatrix::zeros(n, n);
        self.assemble(s, |i, j, value| z[(i, j)] += value);
        let loads = DMatrix::from_fn(n, self.inputs.len(), |i, c| Complex64::new(self.inputs[c][i], 0.0));
        let motion = z.lu().solve(&loads).expect("a damped chain is never singular");
        self.read(|i, column| motion[(i, column)], values);
    }

    /// The four receptances at one line by faer's LU.
    pub(crate) fn faer(&self, s: Complex64, values: &mut [Complex64]) {
        let n = self.order;
        let mut z = faer::Mat::<Complex64>::zeros(n, n);
        self.assemble(s, |i, j, value| z[(i, j)] += value);
        let loads = faer::Mat::from_fn(n, self.inputs.len(), |i, c| Complex64::new(self.inputs[c][i], 0.0));
        let motion = z.partial_piv_lu().solve(&loads);
        self.read(|i, column| motion[(i, column)], values);
    }

    fn read(&self, motion: impl Fn(usize, usize) -> Complex64, values: &mut [Complex64]) {
        for (o, row) in self.outputs.iter().enumerate() {
            for column in 0..self.inputs.len() {
                values[o * self.inputs.len() + column] =
                    row.iter().enumerate().map(|(i, t)| motion(i, column) * t).sum();
            }
        }
    }
}

/// The stiffness of joint J0 alone is what is left of a chain of two.
fn soften_first_joint(stiffness: &mut [f64], bodies: usize) {
    let order = 2 * bodies;
    let pair = Assembly::new(&chain(2, Attachments::None), 1000.0).expect("the modes of two blocks");
    for i in 0..4 {
        for j in 0..4 {
            stiffness[i * order + j] += (SOFTENED - 1.0) * pair.stiffness()[i * 4 + j];
        }
    }
}
