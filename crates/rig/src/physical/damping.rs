use super::{Assembly, Row};
use crate::StructureError;
use jointscope_fixture::{Damping, Quantity};
use jointscope_linalg::generalized_symmetric_eigen;

/// An eigenvalue below this fraction of the largest belongs to a rigid motion.
const RIGID: f64 = 1e-12;

/// The loss factor that bodies and joints carry by the fixture's damping.
pub(crate) fn loss_factor(damping: &Damping) -> f64 {
    match damping {
        Damping::LossFactor(factor) => factor.value,
        Damping::Undamped | Damping::ModalRatios(_) | Damping::Rayleigh { .. } => 0.0,
    }
}

/// Adds the viscous damping of the fixture to `assembly`: that of `free`, the assembly without effects and
/// supports, on the coordinates that both share, which come first in each.
pub(crate) fn add_viscous(
    assembly: &mut Assembly,
    free: &Assembly,
    damping: &Damping,
) -> Result<(), StructureError> {
    let matrix = match damping {
        Damping::Undamped | Damping::LossFactor(_) => return Ok(()),
        Damping::Rayleigh { mass, stiffness } => {
            let (m, k) = (free.mass_matrix(), free.stiffness_matrix());
            m.iter().zip(&k).map(|(m, k)| mass.value * m + stiffness.value * k).collect()
        }
        Damping::ModalRatios(ratios) => modal_matrix(free, ratios)?,
    };
    let motions: Vec<Row> = (0..free.order()).map(Row::coordinate).collect();
    assembly.dashpots(&motions, &matrix);
    Ok(())
}

/// C = Σ 2ζ_r ω_r (Mφ_r)(Mφ_r)ᵀ over the elastic modes, the rigid ones being undamped.
fn modal_matrix(free: &Assembly, ratios: &[Quantity]) -> Result<Vec<f64>, StructureError> {
    let n = free.order();
    let mass = free.mass_matrix();
    let mut damping = vec![0.0; n * n];
    let Some(last) = ratios.last() else { return Ok(damping) };
    let basis = generalized_symmetric_eigen(n, &mass, &free.stiffness_matrix())?;
    let largest = basis.eigenvalues().last().copied().unwrap_or(0.0);
    let elastic = (0..n).filter(|&r| basis.eigenvalues()[r] > RIGID * largest);
    for (which, r) in elastic.enumerate() {
        let ratio = ratios.get(which).unwrap_or(last).value;
        let shape = basis.shape(r);
        let momentum: Vec<f64> = (0..n).map(|i| (0..n).map(|j| mass[i * n + j] * shape[j]).sum()).collect();
        let factor = 2.0 * ratio * basis.eigenvalues()[r].sqrt();
        for i in 0..n {
            for j in 0..n {
                damping[i * n + j] += factor * momentum[i] * momentum[j];
            }
        }
    }
    Ok(damping)
}
