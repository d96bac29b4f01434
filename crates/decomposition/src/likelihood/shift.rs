//! How the fitted joint follows a change of what it was fitted to, to first order.
//!
//! At an optimum the gradient g of χ² by the parameters θ is zero. Where a quantity q of the fixture moves,
//! the optimum moves so that it stays zero: dθ/dq = −H⁻¹ ∂g/∂q, H being the second derivatives of χ². No fit
//! is repeated.

use super::LikelihoodFit;
use super::data::{Data, lines_of};
use super::parameters::Parameters;
use crate::settings::differences::GRADIENT_STEP;
use crate::{Compliances, CrossingFrfs, JointSpectrum, Sides};
use jointscope_averaging::Band;
use jointscope_linalg::{Cholesky, Matrix2, RealMatrix2};
use jointscope_spectra::FrfSet;

/// The fit at its optimum.
pub(crate) struct Optimum<'a> {
    frfs: &'a FrfSet,
    lines: Vec<usize>,
    at: Parameters,
    /// Minus half of the gradient: zero but for what the fit has left.
    right: Vec<f64>,
    /// Half of the second derivatives.
    curvature: Cholesky,
}

impl<'a> Optimum<'a> {
    /// `None` where the FRFs leave a combination of the parameters undetermined.
    pub(crate) fn of(
        frfs: &'a FrfSet,
        (plan, sides): (&CrossingFrfs, &Sides),
        spectrum: &JointSpectrum,
        band: Option<Band>,
        fit: &LikelihoodFit,
    ) -> Option<Self> {
        let lines = lines_of(spectrum, band);
        let data = Data::on(frfs, (&plan.layout, sides), &spectrum.sides, &lines, spectrum.scalar).ok()?;
        let at = Parameters::of(fit.stiffness, fit.damping, spectrum.scalar)?;
        let at = if fit.is_on_the_boundary { at.on_the_boundary() } else { at };
        let equations = data.whole().sums(&at)?.equations(&at);
        let gauss_newton = Cholesky::of(equations.order, &equations.information)?;
        let curvature = curvature(&data, (&at, &equations.right), &gauss_newton).unwrap_or(gauss_newton);
        Some(Optimum { frfs, lines, at, right: equations.right, curvature })
    }

    /// By how much k and c move with sides that differ by a little; `None` where these have no finite
    /// response.
    pub(crate) fn moved(
        &self,
        (plan, sides): (&CrossingFrfs, &Sides),
        compliances: &Compliances,
    ) -> Option<(RealMatrix2, RealMatrix2)> {
        let scalar = self.at.scalar;
        let data = Data::on(self.frfs, (&plan.layout, sides), compliances, &self.lines, scalar).ok()?;
        let mut step = data.whole().right(&self.at)?;
        step.iter_mut().zip(&self.right).for_each(|(there, here)| *there -= here);
        self.curvature.solve_in_place(&mut step);
        let mut moved = [0.0; 6];
        for (row, step) in self.at.derivatives().iter().zip(&step) {
            moved.iter_mut().zip(row).for_each(|(moved, by)| *moved += by * step);
        }
        let matrix =
            |first: usize| Matrix2::new(moved[first], moved[first + 1], moved[first + 1], moved[first + 2]);
        moved.iter().all(|value| value.is_finite()).then(|| (matrix(0), matrix(3)))
    }
}

/// Half of the second derivatives of χ², by forward differences of the gradient; `None` where they are not
/// positive definite.
fn curvature(data: &Data, (at, here): (&Parameters, &[f64]), gauss_newton: &Cholesky) -> Option<Cholesky> {
    let n = gauss_newton.order();
    let covariance = gauss_newton.inverse();
    let mut all = vec![0.0; n * n];
    for m in 0..n {
        let mut active = vec![0.0; n];
        active[m] = GRADIENT_STEP * covariance[m * n + m].sqrt();
        let moved = at.stepped(&at.slots(&active));
        let there = data.whole().right(&moved)?;
        for k in 0..n {
            let by = (here[k] - there[k]) / active[m];
            all[m * n + k] += 0.5 * by;
            all[k * n + m] += 0.5 * by;
        }
    }
    Cholesky::of(n, &all)
}
