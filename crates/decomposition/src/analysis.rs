use crate::interfaces::interfaces_of_fit;
use crate::spectrum::scalar_stiffness;
use crate::{
    Averages, Decomposed, DecompositionError, Element, Interfaces, JointFit, JointFitOptions, JointSpectrum,
    Judgement, LikelihoodFit, MeasurementPlan, Method, Part, Relation, Sides, ToleranceShare,
    ToleranceShares, decompose, fit_joint, interfaces, maximum_likelihood, tolerance_shares,
};
use jointscope_averaging::Band;
use jointscope_fixture::{Fixture, Joint, JointLaw, Nature};
use jointscope_frf::KnownNoise;
use jointscope_frf::noise::NoiseSource;
use jointscope_linalg::{ComplexMatrix2, Matrix2, RealMatrix2};
use jointscope_lumped::{Model, Station};
use jointscope_spectra::FrfSet;
use num_complex::Complex64;
use serde::Serialize;

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
    /// Compare laws of the joint's stiffness and damping over frequency, which takes ten times as long as all else.
    pub laws: bool,
}

impl Default for AnalysisOptions {
    fn default() -> Self {
        AnalysisOptions { joint: None, relation: Relation::Exact, band: None, exact: false, laws: false }
    }
}

/// Where a joint's K and C act: on d = u_to − R·u_from over `length`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointEnds {
    /// L, m.
    pub length: f64,
    /// The near end.
    pub from: JointEnd,
    /// The far end.
    pub to: JointEnd,
}

/// One end of a joint.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointEnd {
    /// The point's name.
    pub point: String,
    /// Its body's name.
    pub body: String,
    /// Its abscissa, m.
    pub x: f64,
}

impl JointEnds {
    pub(crate) fn of(fixture: &Fixture, joint: &Joint) -> Self {
        let end = |point: usize| {
            let point = &fixture.points()[point];
            let body = fixture.bodies()[point.body].name.clone();
            JointEnd { point: point.name.clone(), body, x: point.x.value }
        };
        JointEnds { length: fixture.joint_length(joint), from: end(joint.from), to: end(joint.to) }
    }
}

/// A recording decomposed for a joint: everything that the file and the page say of it.
#[derive(Debug, Clone)]
pub struct Analysis {
    /// The joint's name.
    pub joint: String,
    /// Where K and C act.
    pub ends: JointEnds,
    /// The FRFs with the variances that were used.
    pub frfs: FrfSet,
    /// Where each FRF's variance came from.
    pub noise: Vec<NoiseSource>,
    /// Number of lines recorded, where they were merged.
    pub merged_from: Option<usize>,
    /// Which FRFs were used and from where.
    pub plan: MeasurementPlan,
    /// K and C by line.
    pub spectrum: JointSpectrum,
    /// Averages over the band.
    pub averages: Averages,
    /// The joint from all FRFs, the fixture moving within its tolerances, or why there is none.
    pub joint_fit: Result<JointFit, DecompositionError>,
    /// The maximum-likelihood joint from the FRFs across it, or why there is none.
    pub likelihood: Result<LikelihoodFit, DecompositionError>,
    /// The joint's interfaces, where it is a beam and a fit succeeded; see [`interfaces_rest_on`](Self::interfaces_rest_on).
    pub interfaces: Option<Interfaces>,
    /// What the fixture's tolerances do to the results.
    pub tolerances: Vec<ToleranceShare>,
    /// Quantities whose tolerance could not be followed; the deviations leave them out.
    pub lost_tolerances: Vec<String>,
    /// H41 and K + sC that the fixture as it stands predicts, by line of the recording.
    pub nominal: Vec<Option<(ComplexMatrix2, ComplexMatrix2)>>,
    /// The fixture's stiffness of the joint on d = u_to − R·u_from.
    pub nominal_stiffness: RealMatrix2,
    /// What the best estimate is worth.
    pub judgement: Judgement,
}

impl Analysis {
    /// Decomposes `frfs` for a joint of `fixture`.
    ///
    /// Variances are estimated from coherence and averages where the set has them, from its scatter elsewhere; those
    /// that the set carries already are kept. Lines of long recordings are merged ([`KnownNoise`]).
    ///
    /// # Errors
    /// See [`DecompositionError`].
    pub fn of(
        fixture: &Fixture,
        frfs: &FrfSet,
        options: &AnalysisOptions,
    ) -> Result<Self, DecompositionError> {
        let sides = Sides::of(fixture, options.joint.as_deref())?;
        let plan = MeasurementPlan::of(frfs, &sides)?;
        let KnownNoise { frfs, noise, merged_from } =
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
        let fit_options = JointFitOptions { band: options.band, exact: options.exact, laws: options.laws };
        let near = likelihood.as_ref().ok();
        let joint_fit = fit_joint(&frfs, &sides, exact.scalar, near, nominal_stiffness, fit_options);
        let model = match &likelihood {
            Ok(fit) => (fit.stiffness, fit.damping),
            Err(_) => (nominal_stiffness, RealMatrix2::zero()),
        };
        let averages = Averages::of(&spectrum, options.band, model)?;
        let fitted = likelihood.as_ref().ok().map(|fit| (fit, exact, options.band));
        let decomposed =
            Decomposed { frfs: &frfs, sides: &sides, spectrum: &spectrum, band: averages.band, fit: fitted };
        let ToleranceShares { shares: tolerances, lost: lost_tolerances } =
            tolerance_shares(&decomposed, options.exact)?;
        let interfaces = match interfaces_rest_on(&joint_fit, &likelihood) {
            Some(InterfaceSource::AllFrfs(fit)) => fitted_interfaces(fit, &sides, options.exact),
            Some(InterfaceSource::Across(fit)) => joint_interfaces(fit, &sides, &tolerances),
            None => None,
        };
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
            tolerances,
            lost_tolerances,
            nominal,
            nominal_stiffness,
            judgement: Judgement::default(),
        };
        analysis.judgement = Judgement::of(&analysis, fixture);
        Ok(analysis)
    }

    /// Whether K and C by line, which know of no mass of the joint, hold one that the joint from all FRFs has: the two are not to be compared.
    pub fn lines_hold_mass(&self) -> bool {
        self.joint_fit.as_ref().is_ok_and(|fit| fit.mass.is_some())
    }

    /// The fit that the interfaces are taken from, and whether it explains the FRFs: the joint from all FRFs, or that from the FRFs across where
    /// it alone does.
    pub fn interfaces_rest_on(&self) -> Option<(Method, bool)> {
        self.interfaces.as_ref()?;
        Some(match interfaces_rest_on(&self.joint_fit, &self.likelihood)? {
            InterfaceSource::AllFrfs(fit) => (Method::AllFrfs, fit.explains()),
            InterfaceSource::Across(fit) => (Method::MaximumLikelihood, fit.explains()),
        })
    }

    /// Standard deviations that the fixture's tolerances give the plain averages of K and C.
    pub fn tolerance_of_averages(&self) -> (RealMatrix2, RealMatrix2) {
        root_of_squares(self.tolerances.iter().map(|share| share.plain))
    }

    /// Standard deviations that the fixture's tolerances give the maximum-likelihood K and C.
    pub fn tolerance_of_likelihood(&self) -> (RealMatrix2, RealMatrix2) {
        root_of_squares(self.tolerances.iter().filter_map(|share| share.likelihood))
    }

    /// What the fixture as it stands predicts for an element at a line of the recording; nothing where that is not known.
    pub fn nominal_at(&self, line: usize, part: Part, element: Element) -> Option<f64> {
        let (_, joint) = self.nominal.get(line)?.as_ref().filter(|_| !self.spectrum.scalar)?;
        Some(element.of(&part.of(self.spectrum.stiffness_and_damping(line, *joint))))
    }

    /// The fixture's element over the averaging band, on the lines that the averages were taken over.
    ///
    /// For the exact relation a stiffness is the joint's own; what eq (7) (`paper`) makes of it, and every damping, is a mean over lines.
    pub fn nominal_average(&self, part: Part, element: Element, paper: bool) -> Option<f64> {
        if part == Part::Stiffness && !paper {
            return Some(element.of(&self.nominal_stiffness));
        }
        // The nominal curves are those of the spectrum's own relation.
        if paper != (self.spectrum.relation == Relation::Paper) {
            return None;
        }
        let lines = self.spectrum.solved.iter().filter(|l| self.averages.band.contains(l.frequency));
        let values: Vec<f64> = lines.filter_map(|line| self.nominal_at(line.line, part, element)).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    }

    /// Number of solved lines whose intervals noise makes only indicative.
    pub fn noisy_lines(&self) -> usize {
        self.spectrum.solved.iter().filter(|line| line.is_noisy()).count()
    }
}

fn root_of_squares(shares: impl Iterator<Item = (RealMatrix2, RealMatrix2)>) -> (RealMatrix2, RealMatrix2) {
    let mut sums = (RealMatrix2::zero(), RealMatrix2::zero());
    for (k, c) in shares {
        sums.0 = sums.0 + k.map(|e| e * e);
        sums.1 = sums.1 + c.map(|e| e * e);
    }
    (sums.0.map(f64::sqrt), sums.1.map(f64::sqrt))
}

enum InterfaceSource<'a> {
    AllFrfs(&'a JointFit),
    Across(&'a LikelihoodFit),
}

fn interfaces_rest_on<'a, E>(
    all: &'a Result<JointFit, E>,
    across: &'a Result<LikelihoodFit, E>,
) -> Option<InterfaceSource<'a>> {
    match (all.as_ref().ok(), across.as_ref().ok()) {
        (Some(all), Some(across)) if !all.explains() && across.explains() => {
            Some(InterfaceSource::Across(across))
        }
        (Some(all), _) => Some(InterfaceSource::AllFrfs(all)),
        (None, across) => across.map(InterfaceSource::Across),
    }
}

/// Of the joint from all FRFs, whose covariance holds every tolerance but those of the beam's own EI.
fn fitted_interfaces(fit: &JointFit, sides: &Sides, exact: bool) -> Option<Interfaces> {
    let JointLaw::Beam { youngs_modulus, second_moment } = &sides.joint().law else { return None };
    let covariance = std::array::from_fn(|m| std::array::from_fn(|n| fit.covariance[m][n]));
    let bending_stiffness = youngs_modulus.value * second_moment.value;
    let known = [(youngs_modulus, Nature::YoungsModulus), (second_moment, Nature::SecondMoment)]
        .map(|(quantity, nature)| quantity.std(nature, exact).unwrap_or(0.0) / quantity.value);
    // What a beam and the springs at its ends are together is known at rest; what a law adds over frequency is inertia along the beam, or relaxation.
    interfaces_of_fit(
        fit.follows.fit.stiffness,
        covariance,
        (bending_stiffness, bending_stiffness * known[0].hypot(known[1])),
        &fit.length,
    )
}

fn joint_interfaces(fit: &LikelihoodFit, sides: &Sides, tolerances: &[ToleranceShare]) -> Option<Interfaces> {
    let JointLaw::Beam { youngs_modulus, second_moment } = &sides.joint().law else { return None };
    let covariance =
        std::array::from_fn(|m| std::array::from_fn(|n| fit.covariance[m][n] + fit.model_covariance[m][n]));
    let shifts: Vec<[f64; 5]> = tolerances.iter().filter_map(|share| share.compliance).collect();
    let bending_stiffness = youngs_modulus.value * second_moment.value;
    interfaces(fit.stiffness, covariance, bending_stiffness, sides.length(), &shifts)
}

/// H41 of the whole fixture between the plan's reference points, and what the spectrum's relation makes of it.
fn predicted(
    sides: &Sides,
    plan: &MeasurementPlan,
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
