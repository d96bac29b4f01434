//! What the fixture's own uncertainty does to the joint found, to first order.
//!
//! A quantity moves by a small share of its standard deviation, the sides and the FRFs across are read anew,
//! and the difference is scaled up to the whole deviation. Means over lines are taken again; the fit is not
//! repeated, its optimum follows in closed form ([`Optimum`]).

use crate::interfaces::left_over;
use crate::likelihood::Optimum;
use crate::settings::differences::TOLERANCE_STEP;
use crate::spectrum::{dynamic_stiffness_on, read_at_s};
use crate::{Compliances, CrossingFrfs, DecompositionError, IdlePoints, JointSpectrum, LikelihoodFit, Sides};
use jointscope_averaging::Band;
use jointscope_fixture::Fixture;
use jointscope_frf::fit_rigid_motion;
use jointscope_linalg::{ComplexMatrix2, RealMatrix2};
use jointscope_spectra::FrfSet;

/// By how much the joint found changes when one quantity of the fixture moves by its standard deviation, to
/// first order.
#[derive(Debug, Clone, PartialEq)]
pub struct ToleranceShare {
    /// Path of the quantity in the fixture file.
    pub path: String,
    /// Its standard deviation, SI.
    pub std: f64,
    /// Change of the plain averages of K and C.
    pub plain: (RealMatrix2, RealMatrix2),
    /// Change of the maximum-likelihood K and C.
    pub likelihood: Option<(RealMatrix2, RealMatrix2)>,
    /// Change of the interfaces' compliances (D11, D12, D22) and of the two of eq (6); of a beam joint only.
    pub compliance: Option<[f64; 5]>,
}

/// The shares of all quantities.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct ToleranceShares {
    /// One by quantity.
    pub shares: Vec<ToleranceShare>,
    /// Paths of quantities whose share could not be found: uncertainties leave them out.
    pub lost: Vec<String>,
}

/// A joint as found with the fixture at its stated values, from where tolerances move it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NominalResult<'a> {
    /// The FRFs with the variances that were used.
    pub frfs: &'a FrfSet,
    /// The fixture taken apart.
    pub sides: &'a Sides,
    /// What was found by line.
    pub spectrum: &'a JointSpectrum,
    /// The band averaged over.
    pub band: Band,
    /// The fit with the spectrum of the exact relation that it began with and the band fitted, all lines
    /// without.
    pub fit: Option<(&'a LikelihoodFit, &'a JointSpectrum, Option<Band>)>,
}

/// What every quantity of the fixture that has a standard deviation does to the joint found. `exact` takes
/// bare numbers of the fixture as exact.
///
/// A quantity whose change cannot be followed (sides without a finite response, a fit that leaves a
/// combination undetermined) is named among the lost ones.
///
/// # Errors
/// A recording that lacks FRFs.
pub(crate) fn tolerance_shares(
    of: &NominalResult,
    exact: bool,
) -> Result<ToleranceShares, DecompositionError> {
    let fixture = of.sides.fixture();
    let quantities = if exact { fixture.quantities_exact() } else { fixture.quantities() };
    let plan = CrossingFrfs::of(of.frfs, of.sides)?;
    let optimum =
        of.fit.and_then(|(fit, spectrum, band)| Optimum::of(of.frfs, (&plan, of.sides), spectrum, band, fit));
    let mean = mean(of, of.sides, &of.spectrum.h41.values, &of.spectrum.sides);
    let here = Stated { of, plan, mean, optimum };
    let idle = IdlePoints::of(fixture, of.frfs.pairs());
    let mut of_idle: Option<Option<ToleranceShare>> = None;
    let mut result = ToleranceShares::default();
    for (index, quantity) in quantities.iter().enumerate() {
        let Some(std) = quantity.std.filter(|s| *s > 0.0) else { continue };
        let moved = |share: f64| {
            let mut other = fixture.clone();
            other.set_quantities([(index, quantity.value + share * std)]);
            other
        };
        // All idle points do the same, nothing: what the first one does serves for all.
        let share = match idle.have(quantity.owner) {
            true => of_idle.get_or_insert_with(|| here.share(&moved)).clone(),
            false => here.share(&moved),
        };
        let Some(share) = share else {
            result.lost.push(quantity.path.clone());
            continue;
        };
        if of.fit.is_some() && share.likelihood.is_none() {
            result.lost.push(quantity.path.clone());
        }
        result.shares.push(ToleranceShare { path: quantity.path.clone(), std, ..share });
    }
    Ok(result)
}

type Matrices = (RealMatrix2, RealMatrix2);

/// What the fixture as stated makes of the recording.
struct Stated<'a> {
    of: &'a NominalResult<'a>,
    plan: CrossingFrfs,
    mean: Matrices,
    optimum: Option<Optimum<'a>>,
}

impl Stated<'_> {
    /// The share of a quantity of which `moved` gives the fixture with it off by a number of standard
    /// deviations; its path and deviation are left open.
    fn share(&self, moved: &dyn Fn(f64) -> Fixture) -> Option<ToleranceShare> {
        let (plain, likelihood) = self.change(&moved(TOLERANCE_STEP))?;
        let compliance = likelihood.zip(self.of.fit).and_then(|((k, _), (fit, ..))| {
            let at = |sign: f64| of_interfaces(&moved(sign), self.of.sides, fit.stiffness + k.scale(sign));
            at(1.0).zip(at(-1.0)).map(|(up, down)| std::array::from_fn(|e| 0.5 * (up[e] - down[e])))
        });
        Some(ToleranceShare { path: String::new(), std: 0.0, plain, likelihood, compliance })
    }

    /// Changes of the plain averages and of the fit by a standard deviation, from a fixture in which a
    /// quantity is moved by a small share of it.
    fn change(&self, fixture: &Fixture) -> Option<(Matrices, Option<Matrices>)> {
        let of = self.of;
        let sides = Sides::of(fixture, Some(&of.sides.joint().name)).ok()?;
        let plan = CrossingFrfs::of(of.frfs, &sides).ok()?;
        let (loaded, responding) = (&plan.loaded, &plan.responding);
        let compliances =
            sides.compliances(of.frfs.lines(), (loaded.0, loaded.1), (responding.0, responding.1)).ok()?;
        let reads_alike = plan.layout == self.plan.layout && sides.decay() == of.sides.decay();
        let read = match reads_alike {
            true => None,
            false => Some(read_at_s(fit_rigid_motion(of.frfs, &plan.layout).ok()?, &sides)),
        };
        let h41 = read.as_ref().unwrap_or(&of.spectrum.h41);
        let there = mean(of, &sides, &h41.values, &compliances);
        let scaled = |a: RealMatrix2, b: RealMatrix2| (a - b).scale(1.0 / TOLERANCE_STEP);
        let plain = (scaled(there.0, self.mean.0), scaled(there.1, self.mean.1));
        if !(plain.0.is_finite() && plain.1.is_finite()) {
            return None;
        }
        let optimum = self.optimum.as_ref();
        let fitted = optimum.and_then(|optimum| optimum.moved((&plan, &sides), &compliances));
        Some((plain, fitted.map(|(k, c)| (k.scale(1.0 / TOLERANCE_STEP), c.scale(1.0 / TOLERANCE_STEP)))))
    }
}

/// Plain means of K and C over the lines that the averages were taken over.
fn mean(of: &NominalResult, sides: &Sides, h41: &[ComplexMatrix2], compliances: &Compliances) -> Matrices {
    let spectrum = of.spectrum;
    let lines = spectrum.solved.iter().filter(|line| of.band.contains(line.frequency));
    let (mut k, mut c, mut count) = (RealMatrix2::zero(), RealMatrix2::zero(), 0.0);
    for solved in lines {
        let dynamic = dynamic_stiffness_on(spectrum, h41[solved.line], compliances, solved.line);
        let omega = spectrum.h41.lines.omega(solved.line);
        let damping = dynamic.im().scale(1.0 / omega);
        k = k + (dynamic.re() - damping.scale(sides.decay()));
        c = c + damping;
        count += 1.0;
    }
    (k.scale(1.0 / count), c.scale(1.0 / count))
}

/// What the beam of a fixture does not account for in a joint of this stiffness; nothing where the joint is
/// no beam.
fn of_interfaces(fixture: &Fixture, sides: &Sides, stiffness: RealMatrix2) -> Option<[f64; 5]> {
    let joint = &fixture.joints()[sides.joint_index()];
    left_over(stiffness, joint.law.bending_stiffness()?, fixture.joint_length(joint))
}
