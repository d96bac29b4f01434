//! The matrices of a joint: its elastic centre, its 4×4 form on both ends, what its uncertainty leaves of
//! them.

use crate::numbers::short;
use jointscope_beam::{Matrix4, from_end_stiffness};
use jointscope_comparison::Matrix;
use jointscope_inference::Z95;
use jointscope_linalg::Matrix2;
use serde::{Serialize, Serializer};

/// Share of √(c11·c22) to which centres agree where nothing is known of their uncertainty.
const ROUNDING: f64 = 1e-9;

/// The node of the finite-element model at one end of a joint.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointNode {
    /// The point's name in the fixture.
    pub point: String,
    /// The body's name.
    pub body: String,
    /// Abscissa, m.
    pub x: f64,
    /// Node number.
    pub node: u64,
}

/// Covariance of k11, k12, k22, c11, c12, c22.
pub type Covariance = [[f64; 6]; 6];

/// A joint between two nodes: matrices on d = u_to − R·u_from, u = (y, θ), R = [[1, L], [0, 1]], at the far
/// end, SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Its name.
    pub name: String,
    /// What the matrices are.
    pub says: String,
    /// The near end.
    pub from: JointNode,
    /// The far end.
    pub to: JointNode,
    /// L, m.
    pub length: f64,
    /// Whether the bodies do not rotate: only the elements (1,1) mean anything.
    pub scalar: bool,
    /// K, N/m to N·m/rad.
    pub stiffness: Matrix,
    /// C, N·s/m to N·m·s/rad; all zero where there is none.
    pub damping: Matrix,
    /// Imaginary part of K that does not depend on frequency, N/m to N·m/rad; all zero where there is none.
    pub structural: Matrix,
    /// Frequency at which a viscous joint in its stead loses as much, Hz, and the covariance of K and that
    /// imaginary part, where they are known.
    pub structural_at: Option<(f64, Covariance)>,
    /// Mass on (y, θ) of both ends, kg to kg·m², where the joint has any.
    pub mass: Option<Matrix4>,
    /// Standard deviations of K and C, where they are known.
    pub std: Option<(Matrix, Matrix)>,
    /// Covariance, where it is known.
    pub covariance: Option<Covariance>,
    /// K and C by frequency, where they are asked for, ascending.
    pub lines: Vec<JointAtFrequency>,
}

/// K and C of a joint at a frequency.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct JointAtFrequency {
    /// Hz.
    pub frequency: f64,
    /// K.
    pub stiffness: Matrix,
    /// C.
    pub damping: Matrix,
}

/// Where a force causes no rotation: there the matrix is diagonal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ElasticCentre {
    /// Its place from the far end along x, m: k12/k11.
    pub offset: f64,
    /// k11, N/m.
    pub translation: f64,
    /// k22 − k12²/k11, N·m/rad.
    pub rotation: f64,
}

impl ElasticCentre {
    /// Of a symmetric 2×2 matrix; none where k11 is not positive.
    pub fn of(matrix: &Matrix) -> Option<Self> {
        let [[k11, k12], [_, k22]] = *matrix;
        (k11 > 0.0).then(|| ElasticCentre {
            offset: k12 / k11,
            translation: k11,
            rotation: k22 - k12 * k12 / k11,
        })
    }
}

/// A symmetric matrix on the relative motion at another place, `offset` from the far end along x.
pub(crate) fn about(matrix: &Matrix, offset: f64) -> Matrix {
    let [[k11, k12], [_, k22]] = *matrix;
    let coupling = k12 - offset * k11;
    [[k11, coupling], [coupling, k22 - 2.0 * offset * k12 + offset * offset * k11]]
}

/// `[−R, I]ᵀ m [−R, I]`: a matrix on (y, θ) of the near end, (y, θ) of the far end.
pub fn both_ends(matrix: &Matrix, length: f64) -> Matrix4 {
    let [[a, b], [c, d]] = *matrix;
    let mut ends = from_end_stiffness(Matrix2::new(a, b, c, d), length);
    // Summed in another order on both sides of the diagonal, the last digit may differ.
    for i in 0..4 {
        for j in 0..i {
            ends[i][j] = ends[j][i];
        }
    }
    ends
}

/// Whether every element is zero.
pub(crate) fn is_zero(matrix: &Matrix) -> bool {
    matrix.iter().flatten().all(|element| *element == 0.0)
}

/// Equal elements off the diagonal: their mean.
pub(crate) fn symmetric(matrix: &Matrix) -> Matrix {
    let [[a, b], [c, d]] = *matrix;
    let mean = 0.5 * (b + c);
    [[a, mean], [mean, d]]
}

/// How far the centre of C, or of the structural damping, is from that of K.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CentreAgreement {
    /// c12 − (k12/k11)·c11: zero where both share their centre.
    pub coupling: f64,
    /// Its standard deviation, where it is known.
    pub std: Option<f64>,
    /// Whether they share it within their uncertainty.
    pub agrees: bool,
}

impl Joint {
    /// Elastic centre of K.
    pub(crate) fn centre(&self) -> Option<ElasticCentre> {
        ElasticCentre::of(&self.stiffness)
    }

    /// What to know of a K that is not positive definite.
    pub(crate) fn indefinite(&self) -> Option<String> {
        let [[k11, k12], [_, k22]] = self.stiffness;
        let what = match (k11 > 0.0, self.scalar || k11 * k22 - k12 * k12 > 0.0) {
            (true, true) => return None,
            (false, _) => "k11 is not positive, so there is no elastic centre",
            (true, false) => "k11*k22 - k12^2 is not positive",
        };
        Some(format!(
            "joint {}: K is not positive definite ({what}): some motion meets no force from it or is driven by it, so a model with it may be unstable",
            self.name
        ))
    }

    /// Abscissa of the elastic centre, m.
    pub(crate) fn centre_x(&self) -> Option<f64> {
        self.centre().map(|centre| self.to.x + centre.offset)
    }

    /// Standard deviation of the centre's offset, m, to first order.
    pub fn centre_std(&self) -> Option<f64> {
        let [[k11, k12], _] = self.stiffness;
        let gradient = [-k12 / (k11 * k11), 1.0 / k11, 0.0, 0.0, 0.0, 0.0];
        self.propagated(&gradient)
    }

    /// Whether C acts about the centre of K, within its uncertainty.
    pub(crate) fn damping_centre(&self) -> Option<CentreAgreement> {
        self.centre_agreement(&self.damping, |gradient| self.propagated(gradient))
    }

    /// Whether a matrix acts about the centre of K; `propagated` has the deviation for a gradient in K and in
    /// the matrix.
    fn centre_agreement(
        &self,
        matrix: &Matrix,
        propagated: impl Fn(&[f64; 6]) -> Option<f64>,
    ) -> Option<CentreAgreement> {
        let centre = self.centre()?;
        let [[k11, k12], _] = self.stiffness;
        let [[c11, c12], [_, c22]] = *matrix;
        let coupling = c12 - centre.offset * c11;
        let gradient = [k12 / (k11 * k11) * c11, -c11 / k11, 0.0, -centre.offset, 1.0, 0.0];
        let std = propagated(&gradient);
        let rounding = ROUNDING * (c11.abs() * c22.abs()).sqrt().max(c12.abs());
        let limit = std.map_or(0.0, |std| Z95 * std).max(rounding);
        Some(CentreAgreement { coupling, std, agrees: coupling.abs() <= limit })
    }

    /// Whether the structural damping acts about the centre of K, within its uncertainty.
    pub(crate) fn structural_centre(&self) -> Option<CentreAgreement> {
        let covariance = self.structural_at.map(|(_, covariance)| covariance);
        self.centre_agreement(&self.structural, |gradient| Some(propagated(&covariance?, gradient)))
    }

    /// The joint for programs without structural damping: with the viscous damping that loses as much at the
    /// frequency that is known, which the notes say; the same where there is none to replace or no such
    /// frequency.
    pub(crate) fn without_structural(&self, notes: &mut Vec<String>) -> Self {
        let mut joint = self.clone();
        let Some((hz, _)) = joint.structural_at.take().filter(|_| !is_zero(&self.structural)) else {
            return joint;
        };
        joint.structural = [[0.0; 2]; 2];
        for (row, structural) in joint.damping.iter_mut().zip(&self.structural) {
            row.iter_mut().zip(structural).for_each(|(c, h)| *c += h / (std::f64::consts::TAU * hz));
        }
        notes.push(format!(
            "joint {}: its structural damping H, which is the same at all frequencies, is written as the viscous damping H/omega that loses as much at {} Hz: more above, less below; scale it for another frequency",
            self.name,
            short(hz)
        ));
        joint
    }

    /// Standard deviations of the structural damping, where they are known.
    pub(crate) fn structural_std(&self) -> Option<Matrix> {
        let (_, covariance) = self.structural_at?;
        let std = |i: usize| covariance[i][i].max(0.0).sqrt();
        Some([[std(3), std(4)], [std(4), std(5)]])
    }

    /// Standard deviation of a function of K and C with this gradient; without a covariance as if their
    /// errors were independent.
    fn propagated(&self, gradient: &[f64; 6]) -> Option<f64> {
        if let Some(covariance) = &self.covariance {
            return Some(propagated(covariance, gradient));
        }
        let (k, c) = self.std?;
        let std = [k[0][0], k[0][1], k[1][1], c[0][0], c[0][1], c[1][1]];
        Some(std.iter().zip(gradient).map(|(s, g)| (s * g).powi(2)).sum::<f64>().sqrt())
    }
}

/// Standard deviation of a function of six numbers with this gradient.
fn propagated(covariance: &Covariance, gradient: &[f64; 6]) -> f64 {
    let product = |row: &[f64; 6]| row.iter().zip(gradient).map(|(c, g)| c * g).sum::<f64>();
    let variance: f64 = covariance.iter().zip(gradient).map(|(row, g)| g * product(row)).sum();
    variance.max(0.0).sqrt()
}

/// Deviations of K and C.
#[derive(Serialize)]
struct Pair<M> {
    stiffness: M,
    damping: M,
}

/// The matrices on the motions of both ends.
#[derive(Serialize)]
struct BothEnds {
    order: [&'static str; 4],
    stiffness: Matrix4,
    damping: Matrix4,
    #[serde(skip_serializing_if = "Option::is_none")]
    structural_damping: Option<Matrix4>,
    #[serde(skip_serializing_if = "Option::is_none")]
    mass: Option<Matrix4>,
}

/// A joint as a file has it.
#[derive(Serialize)]
struct Written<'a> {
    name: &'a str,
    says: &'a str,
    from: &'a JointNode,
    to: &'a JointNode,
    length: f64,
    rotates: bool,
    stiffness: Matrix,
    damping: Matrix,
    #[serde(skip_serializing_if = "Option::is_none")]
    structural_damping: Option<Matrix>,
    #[serde(skip_serializing_if = "Option::is_none")]
    std: Option<Pair<Matrix>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    covariance: Option<&'a Covariance>,
    #[serde(skip_serializing_if = "Option::is_none")]
    elastic_centre: Option<ElasticCentre>,
    both_ends: BothEnds,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    lines: &'a [JointAtFrequency],
}

impl Serialize for Joint {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let structural = (!is_zero(&self.structural)).then_some(self.structural);
        Written {
            name: &self.name,
            says: &self.says,
            from: &self.from,
            to: &self.to,
            length: self.length,
            rotates: !self.scalar,
            stiffness: self.stiffness,
            damping: self.damping,
            structural_damping: structural,
            std: self.std.map(|(stiffness, damping)| Pair { stiffness, damping }),
            covariance: self.covariance.as_ref(),
            elastic_centre: self.centre(),
            both_ends: BothEnds {
                order: ["y from", "theta from", "y to", "theta to"],
                stiffness: both_ends(&self.stiffness, self.length),
                damping: both_ends(&self.damping, self.length),
                structural_damping: structural.map(|matrix| both_ends(&matrix, self.length)),
                mass: self.mass,
            },
            lines: &self.lines,
        }
        .serialize(serializer)
    }
}
