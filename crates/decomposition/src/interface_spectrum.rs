//! The interfaces line by line (eq 6): the complex compliance D(ω) = k_J⁻¹ − k_E⁻¹, and the springs and
//! dashpots behind it.
//!
//! With a translation t, a rotation r₂ at the near end and r₃ at the far end, D = [[t + r₂L², r₂L], [r₂L,
//! r₂ + r₃]]: four complex elements for three unknowns. The surplus is reciprocity, D12 = D21. Least squares
//! with the covariance of D's noise on a line use it; what they leave, D12 − D21 over its deviation, is a
//! check of the line.

mod left_over;
mod line;

pub(crate) use left_over::interfaces_behind;
pub(crate) use line::stiffness_and_damping;
pub use line::{LineCompliance, LineSpring, Spread};

use crate::Relation;
use crate::settings::interfaces::HIDDEN_BY_NOISE;
use crate::spectrum::{JointSpectrum, counted};
use jointscope_beam::end_compliance;
use jointscope_frf::MaskReason;
use jointscope_linalg::RealMatrix2;
use left_over::left_over_on;
use line::spring;
use num_complex::Complex64;

/// An interface on one spectral line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineInterface {
    /// What it adds to the beam's compliance.
    pub compliance: LineCompliance,
    /// The spring and dashpot behind it; `None` where the compliance is within its noise, so that the line
    /// tells no stiffness.
    pub spring: Option<LineSpring>,
}

/// The interfaces on one spectral line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InterfaceLine {
    /// Index of the line in the recording.
    pub line: usize,
    /// Its frequency, Hz.
    pub frequency: f64,
    /// D11, D12 = D21 and D22 of the compliance that the beam leaves: m/N, 1/N, rad/(N·m).
    pub compliance: [LineCompliance; 3],
    /// Translation of both interfaces together, t₂ + t₃, m/N.
    pub translation: LineInterface,
    /// Rotation at the near end (point 2), r₂, rad/(N·m).
    pub near_rotation: LineInterface,
    /// Rotation at the far end (point 3), r₃, rad/(N·m).
    pub far_rotation: LineInterface,
    /// χ² of D12 = D21, of two degrees of freedom; `None` where the FRFs carry no variances.
    pub asymmetry: Option<f64>,
}

impl InterfaceLine {
    /// Translation of both together, rotation at the near end and at the far end.
    pub fn all(&self) -> [&LineInterface; 3] {
        [&self.translation, &self.near_rotation, &self.far_rotation]
    }

    fn all_mut(&mut self) -> [&mut LineInterface; 3] {
        [&mut self.translation, &mut self.near_rotation, &mut self.far_rotation]
    }
}

/// Why a line tells nothing of the interfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InterfaceMask {
    /// The joint itself has no K and C there.
    Unsolved(MaskReason),
    /// Noise may take the determinant of the matrix that D inverts (H41 but for factors, where the joint has
    /// no mass) to zero: the error is not of first order.
    Noise,
}

impl InterfaceMask {
    /// The reason in a few words.
    pub fn why(self) -> &'static str {
        match self {
            InterfaceMask::Unsolved(reason) => reason.why(),
            InterfaceMask::Noise => "noise hides the inverse of the FRF matrix",
        }
    }
}

/// The interfaces of a joint over the lines of a recording.
///
/// The beam has no losses: those of a real one count as the interfaces'.
#[derive(Debug, Clone, PartialEq)]
pub struct InterfaceSpectrum {
    /// k_E⁻¹, the compliance of the beam that D leaves out.
    pub beam: RealMatrix2,
    /// The joint's mass whose inertia was taken out, kg.
    pub mass: f64,
    /// Lines that were solved, ascending.
    pub lines: Vec<InterfaceLine>,
    /// Lines that were not, by index, ascending.
    pub masked: Vec<(usize, InterfaceMask)>,
}

impl InterfaceSpectrum {
    /// Why lines are masked, with their counts; empty where none is.
    pub fn masked_summary(&self) -> Vec<(InterfaceMask, usize)> {
        counted(&self.masked)
    }

    /// Solved lines on which the compliance is within its noise: of the translation, of the near and of the
    /// far rotation.
    pub fn within_noise(&self) -> [usize; 3] {
        std::array::from_fn(|of| self.lines.iter().filter(|line| line.all()[of].spring.is_none()).count())
    }

    /// χ² per degree of freedom of D12 = D21 over all solved lines; about 1 where reciprocity holds and
    /// variances are right. `None` without variances.
    pub fn asymmetry(&self) -> Option<f64> {
        let all: Option<Vec<f64>> = self.lines.iter().map(|line| line.asymmetry).collect();
        all.filter(|all| !all.is_empty()).map(|all| all.iter().sum::<f64>() / (2.0 * all.len() as f64))
    }
}

/// The interfaces by line of a joint whose beam has EI `bending_stiffness` (N·m²), from a spectrum by the
/// exact relation.
///
/// `mass` is the joint's own, kg, uniform over its length; its inertia at the joint's ends is taken out.
///
/// `None` of a spectrum by eq (7), whose k is not on the ends' coordinates, and of blocks that do not rotate,
/// which tell one element only.
pub fn interface_spectrum(
    spectrum: &JointSpectrum,
    bending_stiffness: f64,
    mass: f64,
) -> Option<InterfaceSpectrum> {
    let length = spectrum.sides.length;
    if spectrum.scalar || spectrum.relation == Relation::Paper || length <= 0.0 {
        return None;
    }
    let beam = end_compliance(bending_stiffness, length);
    let not_solved = |&(line, reason): &(usize, MaskReason)| (line, InterfaceMask::Unsolved(reason));
    let mut masked: Vec<_> = spectrum.masked.iter().map(not_solved).collect();
    let mut lines = Vec::with_capacity(spectrum.solved.len());
    for solved in &spectrum.solved {
        match interface_line(spectrum, solved.line, beam, mass) {
            Ok(line) => lines.push(line),
            Err(mask) => masked.push((solved.line, mask)),
        }
    }
    masked.sort_by_key(|(line, _)| *line);
    let mut found = InterfaceSpectrum { beam, mass, lines, masked };
    found.state_springs(spectrum);
    Some(found)
}

impl InterfaceSpectrum {
    /// Springs and dashpots, of the lines that tell them.
    fn state_springs(&mut self, spectrum: &JointSpectrum) {
        for of in 0..3 {
            let compliances: Vec<LineCompliance> =
                self.lines.iter().map(|line| line.all()[of].compliance).collect();
            for (at, line) in self.lines.iter_mut().enumerate() {
                let s = Complex64::new(spectrum.decay, spectrum.h41.lines.omega(line.line));
                line.all_mut()[of].spring = spring(&compliances, at, s);
            }
        }
    }

    /// The same with what is not known of the fixture: each of `moved` is the spectrum as it is read, the
    /// beam's EI (N·m²) and the joint's mass (kg), when one quantity is off by a `share` of its standard
    /// deviation, all of them independent.
    pub(crate) fn with_tolerances(
        mut self,
        spectrum: &JointSpectrum,
        moved: impl IntoIterator<Item = (JointSpectrum, f64, f64)>,
        share: f64,
    ) -> Self {
        for (read, bending_stiffness, mass) in moved {
            let beam = end_compliance(bending_stiffness, read.sides.length);
            for line in &mut self.lines {
                let Some(left) = left_over_on(&read, line.line, beam, mass) else { continue };
                let there = left.interfaces(read.sides.length);
                for (interface, there) in line.all_mut().into_iter().zip(there) {
                    let error = (there.value - interface.compliance.value) / share;
                    interface.compliance.tolerance = interface.compliance.tolerance.with(error);
                }
            }
        }
        self.state_springs(spectrum);
        self
    }
}

fn interface_line(
    spectrum: &JointSpectrum,
    line: usize,
    beam: RealMatrix2,
    mass: f64,
) -> Result<InterfaceLine, InterfaceMask> {
    let length = spectrum.sides.length;
    let all =
        left_over_on(spectrum, line, beam, mass).ok_or(InterfaceMask::Unsolved(MaskReason::SingularFrf))?;
    if all.noise.as_ref().is_some_and(|noise| noise.share_of_determinant() > HIDDEN_BY_NOISE) {
        return Err(InterfaceMask::Noise);
    }
    let [translation, near_rotation, far_rotation] =
        all.interfaces(length).map(|compliance| LineInterface { compliance, spring: None });
    Ok(InterfaceLine {
        line,
        frequency: spectrum.h41.lines.hz()[line],
        compliance: [[1.0, 0.0, 0.0, 0.0], [0.0, 0.5, 0.5, 0.0], [0.0, 0.0, 0.0, 1.0]]
            .map(|weights| all.reciprocal(weights)),
        translation,
        near_rotation,
        far_rotation,
        asymmetry: all.asymmetry(),
    })
}
