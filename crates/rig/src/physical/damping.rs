//! Damping of the laboratory's structures: loss factors, Rayleigh's matrix, and the matrix that gives modes
//! their stated ratios.

use super::{Assembly, Row};
use crate::StructureError;
use jointscope_fixture::{Damping, Quantity, RatiosOf};
use jointscope_linalg::generalized_symmetric_eigen;

/// An eigenvalue below this fraction of the largest belongs to a rigid motion.
pub(crate) const RIGID: f64 = 1e-12;
/// Share of a mode's strain energy in bodies and joints below which its frequency is the suspension's.
const LEAST_STRAIN: f64 = 0.05;

/// The loss factor that bodies and joints carry by the fixture's damping.
pub(crate) fn loss_factor(damping: &Damping) -> f64 {
    match damping {
        Damping::LossFactor(factor) => factor.value,
        Damping::Undamped | Damping::ModalRatios { .. } | Damping::Rayleigh { .. } => 0.0,
    }
}

/// Adds the viscous damping of the fixture to `assembly`: that of `free`, the assembly without effects and
/// supports, or of `supported`, the same on its supports, on the coordinates that all share, which come first
/// in each.
pub(crate) fn add_viscous(
    assembly: &mut Assembly,
    free: &Assembly,
    supported: &Assembly,
    damping: &Damping,
) -> Result<(), StructureError> {
    let matrix = match damping {
        Damping::Undamped | Damping::LossFactor(_) => return Ok(()),
        Damping::Rayleigh { mass, stiffness } => {
            let (m, k) = (free.mass_matrix(), free.stiffness_matrix());
            m.iter().zip(&k).map(|(m, k)| mass.value * m + stiffness.value * k).collect()
        }
        Damping::ModalRatios { ratios, of: RatiosOf::Free } => modal_matrix(free, free, ratios)?,
        Damping::ModalRatios { ratios, of: RatiosOf::AsItStands } => modal_matrix(supported, free, ratios)?,
    };
    let motions: Vec<Row> = (0..free.order()).map(Row::coordinate).collect();
    assembly.dashpots(&motions, &matrix);
    Ok(())
}

/// C = Σ (2ζ_r ω_r − φᵀC_sφ)(Mφ_r)(Mφ_r)ᵀ over the elastic modes of `supported`, whose supports' dashpots C_s
/// are in the structure already and count among what a test reads; rigid modes are undamped, and so are those
/// that strain next to nothing of the `free` assembly, unless all do.
fn modal_matrix(
    supported: &Assembly,
    free: &Assembly,
    ratios: &[Quantity],
) -> Result<Vec<f64>, StructureError> {
    let n = supported.order();
    let mass = supported.mass_matrix();
    let mut damping = vec![0.0; n * n];
    let Some(last) = ratios.last() else { return Ok(damping) };
    let basis = generalized_symmetric_eigen(n, &mass, &supported.stiffness_matrix())?;
    let (own_springs, own_dashpots) = (free.stiffness_matrix(), free.damping_matrix());
    let all_dashpots = supported.damping_matrix();
    let quadratic = |matrix: &[f64], shape: &[f64]| -> f64 {
        (0..n * n).map(|e| shape[e / n] * matrix[e] * shape[e % n]).sum()
    };
    let largest = basis.eigenvalues().last().copied().unwrap_or(0.0);
    let moves = |r: &usize| basis.eigenvalues()[*r] > RIGID * largest;
    let strains =
        |r: &usize| quadratic(&own_springs, basis.shape(*r)) > LEAST_STRAIN * basis.eigenvalues()[*r];
    let mut elastic: Vec<usize> = (0..n).filter(moves).filter(strains).collect();
    if elastic.is_empty() {
        elastic = (0..n).filter(moves).collect();
    }
    for (which, r) in elastic.into_iter().enumerate() {
        let ratio = ratios.get(which).unwrap_or(last).value;
        let shape = basis.shape(r);
        let momentum: Vec<f64> = (0..n).map(|i| (0..n).map(|j| mass[i * n + j] * shape[j]).sum()).collect();
        let supports = quadratic(&all_dashpots, shape) - quadratic(&own_dashpots, shape);
        let factor = (2.0 * ratio * basis.eigenvalues()[r].sqrt() - supports).max(0.0);
        for i in 0..n {
            for j in 0..n {
                damping[i * n + j] += factor * momentum[i] * momentum[j];
            }
        }
    }
    Ok(damping)
}
