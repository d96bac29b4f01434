//! A recording decomposed for a joint: all that was found.

use crate::{
    Averages, CrossingFrfs, DecompositionError, DynamicStiffnessPart, InterfaceSpectrum, Interfaces,
    JointEnds, JointFit, JointSpectrum, Judgement, LikelihoodFit, MatrixElement, Method, Relation,
    ToleranceShare,
};
use jointscope_frf::noise::NoiseSource;
use jointscope_linalg::{ComplexMatrix2, RealMatrix2};
use jointscope_spectra::FrfSet;

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
    pub plan: CrossingFrfs,
    /// K and C by line.
    pub spectrum: JointSpectrum,
    /// Averages over the band.
    pub averages: Averages,
    /// The joint from all FRFs, the fixture moving within its tolerances, or why there is none.
    pub joint_fit: Result<JointFit, DecompositionError>,
    /// The maximum-likelihood joint from the FRFs across it, or why there is none.
    pub likelihood: Result<LikelihoodFit, DecompositionError>,
    /// The joint's interfaces, where it is a beam and a fit succeeded; see
    /// [`interfaces_rest_on`](Self::interfaces_rest_on).
    pub interfaces: Option<Interfaces>,
    /// The same line by line, by the exact relation; of a beam between blocks that rotate.
    pub interface_spectrum: Option<InterfaceSpectrum>,
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
    /// Whether K and C by line, which know of no mass of the joint, hold one that the joint from all FRFs
    /// has: the two are not to be compared.
    pub fn lines_hold_mass(&self) -> bool {
        self.joint_fit.as_ref().is_ok_and(|fit| fit.mass.is_some())
    }

    /// The fit that the interfaces are taken from, and whether it explains the FRFs: the joint from all FRFs,
    /// or that from the FRFs across where it alone does.
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

    /// What the fixture as it stands predicts for an element at a line of the recording; nothing where that
    /// is not known.
    pub fn nominal_at(&self, line: usize, part: DynamicStiffnessPart, element: MatrixElement) -> Option<f64> {
        let (_, joint) = self.nominal.get(line)?.as_ref().filter(|_| !self.spectrum.scalar)?;
        Some(element.of(&part.of(self.spectrum.stiffness_and_damping(line, *joint))))
    }

    /// The fixture's element over the averaging band, on the lines that the averages were taken over.
    ///
    /// For the exact relation a stiffness is the joint's own; what eq (7) (`paper`) makes of it, and every
    /// damping, is a mean over lines.
    pub fn nominal_average(
        &self,
        part: DynamicStiffnessPart,
        element: MatrixElement,
        paper: bool,
    ) -> Option<f64> {
        if part == DynamicStiffnessPart::Stiffness && !paper {
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

/// The fit that interfaces are taken from.
pub(crate) enum InterfaceSource<'a> {
    AllFrfs(&'a JointFit),
    Across(&'a LikelihoodFit),
}

pub(crate) fn interfaces_rest_on<'a, E>(
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
