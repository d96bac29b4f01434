//! From the FRFs of an assembly to its joint: every step of a decomposition.

use crate::analysis::{InterfaceSource, interfaces_rest_on};
use crate::interface_tolerances::interfaces_with_tolerances;
use crate::interfaces::interfaces_of_fit;
use crate::spectrum::scalar_stiffness;
use crate::{
    Analysis, Averages, CrossingFrfs, DecompositionError, Interfaces, JointEnds, JointFit, JointFitOptions,
    JointSpectrum, Judgement, LikelihoodFit, NominalResult, Relation, Sides, ToleranceShare, ToleranceShares,
    decompose, fit_joint, interfaces, maximum_likelihood, tolerance_shares,
};
use jointscope_averaging::Band;
use jointscope_fixture::{Fixture, JointLaw, Nature};
use jointscope_frf::KnownNoise;
use jointscope_linalg::{ComplexMatrix2, Matrix2, RealMatrix2};
use jointscope_lumped::{Model, Station};
use jointscope_spectra::FrfSet;
use num_complex::Complex64;

/// What to decompose and how.
#[derive(Debug, Clone, PartialEq)]
pub struct AnalysisOptions {
    /// The joint to find; may be left out where the fixture has one.
    pub joint: Option<String>,
    /// The relation by which K(ω) and C(ω) are found.
    pub relation: Relation,
    /// The band of averages and of the fit; the quietest one and all lines where it is left out.
    pub band: Option<Band>,
    /// Take the fixture's bare numbers as exact.
    pub exact: bool,
    /// Compare laws of the joint's stiffness and damping over frequency, which takes ten times as long as all
    /// else.
    pub laws: bool,
}

impl Default for AnalysisOptions {
    fn default() -> Self {
        AnalysisOptions { joint: None, relation: Relation::Exact, band: None, exact: false, laws: false }
    }
}

impl AnalysisOptions {
    /// What a fit to all FRFs is asked for.
    pub fn of_fit(&self) -> JointFitOptions {
        JointFitOptions { band: self.band, exact: self.exact, laws: self.laws }
    }
}

impl Analysis {
    /// Decomposes `frfs` for a joint of `fixture`.
    ///
    /// Variances are estimated from coherence and averages where the set has them, from its scatter
    /// elsewhere; those that the set carries already are kept. Lines of long recordings are merged
    /// ([`KnownNoise`]).
    ///
    /// # Errors
    /// See [`DecompositionError`].
    pub fn of(
        fixture: &Fixture,
        frfs: &FrfSet,
        options: &AnalysisOptions,
    ) -> Result<Self, DecompositionError> {
        let sides = Sides::of(fixture, options.joint.as_deref())?;
        let plan = CrossingFrfs::of(frfs, &sides)?;
        let KnownNoise { frfs, noise, merged_from, .. } =
            KnownNoise::of(frfs, options.band.map(|band| (band.from, band.to)))
                .map_err(jointscope_frf::RigidMotionError::from)?;
        let joint = sides.joint().name.clone();
        let spectrum = decompose(&frfs, &sides, options.relation)?;
        // Fit and weights rest on the exact relation, whichever is shown.
        let of_paper = match options.relation {
            Relation::Exact => None,
            Relation::Paper => Some(decompose(&frfs, &sides, Relation::Exact)?),
        };
        let exact = of_paper.as_ref().unwrap_or(&spectrum);
        let nominal_stiffness = jointscope_lumped::nominal_stiffness(&sides.joint().law, sides.length());
        let likelihood = maximum_likelihood(&frfs, &sides, exact, options.band, Some(nominal_stiffness));
        let near = likelihood.as_ref().ok();
        let joint_fit = fit_joint(&frfs, &sides, exact.scalar, near, nominal_stiffness, options.of_fit());
        let model = near.map_or((nominal_stiffness, RealMatrix2::zero()), |fit| (fit.stiffness, fit.damping));
        let averages = Averages::of(&spectrum, options.band, model)?;
        let fitted = near.map(|fit| (fit, exact, options.band));
        let decomposed = NominalResult {
            frfs: &frfs,
            sides: &sides,
            spectrum: &spectrum,
            band: averages.band,
            fit: fitted,
        };
        let ToleranceShares { shares: tolerances, lost: lost_tolerances } =
            tolerance_shares(&decomposed, options.exact)?;
        let interfaces = interfaces_rest_on(&joint_fit, &likelihood).and_then(|fit| match fit {
            InterfaceSource::AllFrfs(fit) => fitted_interfaces(fit, &sides, options.exact),
            InterfaceSource::Across(fit) => joint_interfaces(fit, &sides, &tolerances),
        });
        let mass = joint_fit.as_ref().ok().and_then(|fit| fit.mass).unwrap_or_default();
        let interface_spectrum = interfaces_with_tolerances(&frfs, &sides, exact, mass, options.exact);
        let nominal = predicted(&sides, &plan, &spectrum)?;
        let mut analysis = Analysis {
            joint,
            ends: JointEnds::of(sides.fixture(), sides.joint()),
            frfs,
            noise,
            merged_from,
            plan,
            spectrum,
            averages,
            joint_fit,
            likelihood,
            interfaces,
            interface_spectrum,
            tolerances,
            lost_tolerances,
            nominal,
            nominal_stiffness,
            judgement: Judgement::default(),
        };
        analysis.judgement = Judgement::of(&analysis, fixture);
        Ok(analysis)
    }
}

/// Of the joint from all FRFs, whose covariance holds every tolerance but those of the beam's own EI.
fn fitted_interfaces(fit: &JointFit, sides: &Sides, exact: bool) -> Option<Interfaces> {
    let JointLaw::Beam { youngs_modulus, second_moment } = &sides.joint().law else { return None };
    let covariance = std::array::from_fn(|m| std::array::from_fn(|n| fit.covariance[m][n]));
    let bending_stiffness = youngs_modulus.value * second_moment.value;
    let known = [(youngs_modulus, Nature::YoungsModulus), (second_moment, Nature::SecondMoment)]
        .map(|(quantity, nature)| quantity.std(nature, exact).unwrap_or(0.0) / quantity.value);
    // What a beam and the springs at its ends are together is known at rest; what a law adds over frequency
    // is inertia along the beam, or relaxation.
    interfaces_of_fit(
        fit.follows.fit.stiffness,
        covariance,
        (bending_stiffness, bending_stiffness * known[0].hypot(known[1])),
        &fit.length,
    )
}

fn joint_interfaces(fit: &LikelihoodFit, sides: &Sides, tolerances: &[ToleranceShare]) -> Option<Interfaces> {
    let bending_stiffness = sides.joint().law.bending_stiffness()?;
    let covariance =
        std::array::from_fn(|m| std::array::from_fn(|n| fit.covariance[m][n] + fit.model_covariance[m][n]));
    let shifts: Vec<[f64; 5]> = tolerances.iter().filter_map(|share| share.compliance).collect();
    interfaces(fit.stiffness, covariance, bending_stiffness, sides.length(), &shifts)
}

/// H41 of the whole fixture between the plan's reference points, and what the spectrum's relation makes of
/// it.
fn predicted(
    sides: &Sides,
    plan: &CrossingFrfs,
    spectrum: &JointSpectrum,
) -> Result<Vec<Option<(ComplexMatrix2, ComplexMatrix2)>>, DecompositionError> {
    let lines = &spectrum.h41.lines;
    let model = Model::new(sides.fixture(), lines.hz()[lines.len() - 1])?;
    let outputs = Station::both(plan.responding.0, plan.responding.1);
    let inputs = Station::both(plan.loaded.0, plan.loaded.1);
    let mut receptances = model.receptances(&outputs, &inputs);
    let mut values = [Complex64::ZERO; 4];
    let s = &spectrum.sides;
    let predicted = (0..lines.len()).map(|line| {
        if lines.hz()[line] == 0.0 || !receptances.at(sides.s(lines.omega(line)), &mut values) {
            return None;
        }
        let h41 = Matrix2::new(values[0], values[1], values[2], values[3]);
        if spectrum.scalar {
            return Some((h41, scalar_stiffness(spectrum.relation, h41, s, line)));
        }
        let (a21, a22, b33, b43) = (s.alpha21[line], s.alpha22[line], s.beta33[line], s.beta43[line]);
        Some((h41, spectrum.relation.decompose(h41, a21, a22, b33, b43, s.length)?))
    });
    Ok(predicted.collect())
}
