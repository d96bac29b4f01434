//! One row of the paper's tables as the program computes it: an example's FRFs from lumped model and solid,
//! decomposed and averaged.

use crate::TablesError;
use crate::example::Example;
use crate::paper::Elements;
use jointscope_decomposition::{Averages, MatrixAverage, Relation, Sides, decompose};
use jointscope_fem::{MeshOptions, ModeRange, Superposition, Twin};
use jointscope_fixture::BodyKind;
use jointscope_linalg::RealMatrix2;
use jointscope_lumped::{Assembly, Instrument, nominal_stiffness, synthesize};
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};

/// A model's averages over the example's band, by eq (7) and by the exact relation, signs included, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extracted {
    /// Eq (7).
    pub paper: MatrixAverage,
    /// k⁻¹ = R α21 H41⁻¹ β43 − β33 − R α22 Rᵀ.
    pub exact: MatrixAverage,
}

/// What the program makes of one example.
#[derive(Debug, Clone)]
pub struct ProgramRow {
    /// The example.
    pub example: Example,
    /// The joint's stiffness that the fixture states, on d = u_to − R·u_from.
    pub stiffness: RealMatrix2,
    /// C_IN on the interfaces' coordinates (40): elements (1,1), (1,2), (2,1), (2,2) of the 4×4 matrix.
    pub input: Elements,
    /// The lumped model.
    pub sim: Extracted,
    /// The twin of [`Example::solid`] with two modes, as in the paper.
    pub fem_two: Option<Extracted>,
    /// The finite-element twin with all modes and what lies beyond.
    pub fem_all: Option<Extracted>,
}

/// The lines of the paper: 0 to 1000 Hz, 2.5 Hz apart; nothing can be solved at 0 Hz.
fn paper_lines() -> Result<SpectralLines, TablesError> {
    Ok(SpectralLines::even(2.5, 2.5, 400)?)
}

/// The four FRFs that H41 is made of (23).
fn paper_pairs() -> [FrfPair; 4] {
    [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")].map(|(to, from)| FrfPair::transverse(to, from))
}

impl ProgramRow {
    /// Synthesises, decomposes and averages; with the finite-element twin where `mesh` is given.
    ///
    /// # Errors
    /// See [`TablesError`].
    pub fn of(example: Example, mesh: Option<&MeshOptions>) -> Result<Self, TablesError> {
        let (lines, pairs) = (paper_lines()?, paper_pairs());
        let sides =
            Sides::of(&example.fixture, None).map_err(jointscope_decomposition::DecompositionError::from)?;
        let stiffness = nominal_stiffness(&sides.joint().law, sides.length());
        let of = |frfs: &FrfSet| -> Result<Extracted, TablesError> {
            let average = |relation| -> Result<MatrixAverage, TablesError> {
                let spectrum = decompose(frfs, &sides, relation)?;
                Ok(Averages::of(&spectrum, Some(example.band), (stiffness, RealMatrix2::zero()))?.plain)
            };
            Ok(Extracted { paper: average(Relation::Paper)?, exact: average(Relation::Exact)? })
        };
        let sim = of(&synthesize(&example.fixture, &pairs, &lines, Instrument::Perfect)?)?;
        let (mut fem_two, mut fem_all) = (None, None);
        if let Some(mesh) = mesh {
            let twin = Twin::of(&example.fixture, mesh, ModeRange { at_least: 4, up_to: 2000.0 }, |_| {})?;
            fem_two = Some(of(&twin.frfs(&pairs, &lines, Superposition::First(2))?)?);
            fem_all = Some(of(&twin.frfs(&pairs, &lines, Superposition::Complete)?)?);
        }
        let input = damping_input(&example)?;
        Ok(ProgramRow { example, stiffness, input, sim, fem_two, fem_all })
    }

    /// Magnitudes of the elements of a matrix, as the tables print them.
    pub fn magnitudes(matrix: &RealMatrix2) -> Elements {
        [matrix.at(0, 0), matrix.at(0, 1), matrix.at(1, 0), matrix.at(1, 1)].map(f64::abs)
    }
}

/// C_IN (40): the block (y2, θ2) of the proportional damping matrix, carried from the centre of gravity to
/// the interface.
fn damping_input(example: &Example) -> Result<Elements, TablesError> {
    let fixture = &example.fixture;
    let assembly = Assembly::new(fixture, 1000.0)?;
    let (c, n) = (assembly.viscous_damping(), assembly.order());
    let near = &fixture.points()[fixture.joints()[0].from];
    let arm = match &fixture.bodies()[near.body].kind {
        BodyKind::Rigid(rigid) => rigid.x_cg.map_or(0.0, |x| x.value) - near.x.value,
        BodyKind::Beam(_) => 0.0,
    };
    let first = 2 * near.body;
    let [a, b, d] = [c[first * n + first], c[first * n + first + 1], c[(first + 1) * n + first + 1]];
    // y_cg = y2 + arm·θ2
    let cross = b + arm * a;
    Ok([a, cross, cross, d + 2.0 * arm * b + arm * arm * a])
}
