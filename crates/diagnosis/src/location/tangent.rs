//! How a site's modelled FRFs follow the tolerances, the abscissa and a law's parameters.

use super::Site;
use super::pattern::{Inversion, RationalResponse};
use super::problem::{Iterate, Modelled, Problem};
use crate::Hypothesis;
use crate::settings::location::differences::PARAMETER_STEP;
use jointscope_inference::{NormalEquations, dot};
use num_complex::Complex64;

/// Parameters that a law may have.
const MOST: usize = 4;

/// Derivatives of the modelled values at a fixed component (or a fixed law): coordinate after coordinate,
/// then line after line, FRF after FRF.
#[derive(Clone)]
pub(super) struct Tangent {
    pub order: usize,
    values: Vec<Complex64>,
}

impl Tangent {
    /// The derivatives by one coordinate.
    pub(super) fn column(&self, coordinate: usize) -> &[Complex64] {
        let places = self.values.len() / self.order.max(1);
        &self.values[coordinate * places..(coordinate + 1) * places]
    }
}

impl Problem<'_> {
    /// The models a step up each tolerance from a hypothesis: what all sites' derivatives there have in
    /// common.
    pub(super) fn surroundings(&self, hypothesis: &Hypothesis) -> Option<Vec<Modelled>> {
        let beside = |a| self.model(&hypothesis.moved(a, self.settings().fit.difference));
        (0..hypothesis.tolerances().len()).map(beside).collect()
    }

    /// Differences about a state. A free scalar follows its component δ as bᵀZ⁻¹b changes. `central` ones
    /// where uncertainties are to be stated; forward ones, at half the cost, show the way well enough.
    pub(super) fn tangent(&self, at: &Iterate, central: bool) -> Option<Tangent> {
        if !central {
            return self.tangent_amid(at, &self.surroundings(&at.parameters.hypothesis)?);
        }
        let width = 0.5 / self.settings().fit.difference;
        let up = self.differences(at, &self.surroundings(&at.parameters.hypothesis)?, 1.0, width)?;
        let down = (0..at.parameters.hypothesis.tolerances().len())
            .map(|a| self.model(&at.parameters.hypothesis.moved(a, -self.settings().fit.difference)))
            .collect::<Option<Vec<Modelled>>>()?;
        let down = self.differences(at, &down, -1.0, width)?;
        let values = up.iter().zip(down).map(|(u, d)| u - d).collect();
        self.completed(at, values)
    }

    /// Forward differences about a state of which the surroundings are known.
    pub(super) fn tangent_amid(&self, at: &Iterate, surroundings: &[Modelled]) -> Option<Tangent> {
        let mut values = self.differences(at, surroundings, 1.0, 1.0 / self.settings().fit.difference)?;
        for column in values.chunks_exact_mut(at.modelled.len()) {
            column
                .iter_mut()
                .zip(&at.modelled)
                .for_each(|(sum, from)| *sum -= from / self.settings().fit.difference);
        }
        self.completed(at, values)
    }

    fn completed(&self, at: &Iterate, mut values: Vec<Complex64>) -> Option<Tangent> {
        self.by_parameters(at, &mut values);
        let order = values.len() / at.modelled.len().max(1);
        values.iter().all(|v| v.is_finite()).then_some(Tangent { order, values })
    }

    /// What is modelled in the surroundings, and on that side of the abscissa where it moves, times `factor`.
    fn differences(
        &self,
        at: &Iterate,
        surroundings: &[Modelled],
        sign: f64,
        factor: f64,
    ) -> Option<Vec<Complex64>> {
        let (frfs, places) = (self.recorded.frfs(), at.modelled.len());
        let abscissa = self.abscissa(&at.parameters);
        let mut values =
            vec![Complex64::ZERO; places * (surroundings.len() + usize::from(abscissa.is_some()))];
        let mut fill = |coordinate: usize, modelled: &Modelled, site: &Site| {
            let column = &mut values[coordinate * places..(coordinate + 1) * places];
            self.on_lines(modelled, site, |line, responses: &[RationalResponse], inversion| {
                let z = self.follows(at, line, &inversion);
                let column = &mut column[line * frfs..(line + 1) * frfs];
                column.iter_mut().zip(responses).for_each(|(to, response)| *to = response.at(z) * factor);
            })
        };
        for (coordinate, modelled) in surroundings.iter().enumerate() {
            fill(coordinate, modelled, &at.parameters.site)?;
        }
        if let (Some((unit, ..)), Site::Body { body, x }) = (abscissa, &at.parameters.site) {
            let site = Site::Body { body: body.clone(), x: x + sign * self.settings().fit.difference * unit };
            fill(surroundings.len(), &self.model(&at.parameters.hypothesis)?, &site)?;
        }
        Some(values)
    }

    /// The scalar when everything else has moved.
    fn follows(&self, at: &Iterate, line: usize, inversion: &Inversion) -> Complex64 {
        match &self.law {
            Some(law) => self.bound(law, &at.parameters.of_law, line, inversion),
            None => {
                let z = at.scalars[line];
                z / (1.0 + (inversion.feedback - at.inversions[line].feedback) * z)
            }
        }
    }

    fn by_parameters(&self, at: &Iterate, values: &mut Vec<Complex64>) {
        let Some(law) = &self.law else { return };
        let places = at.modelled.len();
        let mut moved = [0.0; MOST];
        let count = at.parameters.of_law.len().min(MOST);
        let own = values.len();
        values.resize(own + count * places, Complex64::ZERO);
        for (p, column) in values[own..].chunks_exact_mut(places).enumerate() {
            moved[..count].copy_from_slice(&at.parameters.of_law[..count]);
            let step = PARAMETER_STEP * moved[p].abs().max(1e-9);
            let centre = moved[p];
            for (line, inversion) in at.inversions.iter().enumerate() {
                moved[p] = centre + step;
                let up = self.bound(law, &moved[..count], line, inversion);
                moved[p] = centre - step;
                let down = self.bound(law, &moved[..count], line, inversion);
                let slope = (up - down) / (2.0 * step);
                let places = self.recorded.places(line);
                column[places.clone()].iter_mut().zip(&at.slopes[places]).for_each(|(d, s)| *d = s * slope);
            }
        }
    }

    /// The normal matrix with priors, what a free scalar takes up projected out.
    pub(super) fn normal(&self, at: &Iterate, tangent: &Tangent, weights: &[f64]) -> NormalEquations {
        let n = tangent.order;
        let roots: Vec<f64> = weights.iter().map(|w| w.sqrt()).collect();
        let units = if self.law.is_none() { self.units(at, &roots) } else { Vec::new() };
        let width = 2 * roots.len();
        // Real and imaginary parts side by side, coordinate after coordinate, the residual last.
        let mut whitened = vec![0.0; (n + 1) * width];
        for (a, whitened) in whitened.chunks_exact_mut(width).enumerate() {
            if a < n {
                let whitened = whitened.chunks_exact_mut(2).zip(tangent.column(a)).zip(&roots);
                whitened
                    .for_each(|((to, value), root)| to.copy_from_slice(&[value.re * root, value.im * root]));
            } else {
                let residual = self.recorded.measured.iter().zip(&at.modelled).map(|(m, value)| m - value);
                let whitened = whitened.chunks_exact_mut(2).zip(residual).zip(&roots);
                whitened
                    .for_each(|((to, value), root)| to.copy_from_slice(&[value.re * root, value.im * root]));
            }
            project_out(&units, self.recorded.frfs(), whitened);
        }
        let column = |a: usize| &whitened[a * width..(a + 1) * width];
        let mut normal = NormalEquations::zero(n);
        for a in 0..n {
            normal.right[a] = dot(column(a), column(n));
            for b in 0..=a {
                let value = dot(column(a), column(b));
                normal.information[a * n + b] = value;
                normal.information[b * n + a] = value;
            }
        }
        let hypothesis = &at.parameters.hypothesis;
        for a in 0..hypothesis.tolerances().len() {
            normal.add_prior(a, hypothesis.prior(a), hypothesis.coordinates[a]);
        }
        normal
    }

    /// The direction of each line's free scalar among the whitened values, of length one; zero where the
    /// pattern vanishes.
    fn units(&self, at: &Iterate, roots: &[f64]) -> Vec<Complex64> {
        let mut units: Vec<Complex64> = at.slopes.iter().zip(roots).map(|(s, root)| s * *root).collect();
        for line in units.chunks_exact_mut(self.recorded.frfs()) {
            let size: f64 = line.iter().map(|u| u.norm_sqr()).sum();
            let scale = if size > 0.0 { 1.0 / size.sqrt() } else { 0.0 };
            line.iter_mut().for_each(|u| *u *= scale);
        }
        units
    }
}

/// Takes out of whitened values, line by line, what lies along `units`.
fn project_out(units: &[Complex64], frfs: usize, whitened: &mut [f64]) {
    for (own, unit) in whitened.chunks_exact_mut(2 * frfs).zip(units.chunks_exact(frfs)) {
        let (mut re, mut im) = (0.0, 0.0);
        for (v, u) in own.chunks_exact(2).zip(unit) {
            re += u.re * v[0] + u.im * v[1];
            im += u.re * v[1] - u.im * v[0];
        }
        for (v, u) in own.chunks_exact_mut(2).zip(unit) {
            v[0] -= u.re * re - u.im * im;
            v[1] -= u.re * im + u.im * re;
        }
    }
}
