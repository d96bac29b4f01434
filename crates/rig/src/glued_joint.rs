//! A hammer test of two steel blocks joined by a steel strip that is glued between them.
//!
//! The analyst believes in a massless beam held firmly at both ends ([`FIXTURE`]). The structure has a strip
//! with mass, shear and rotary inertia, and a layer of epoxy at each end that yields in translation and
//! rotation.

use crate::physical::add_viscous;
use crate::tolerance::drawn_within_tolerance;
use crate::universal_file::{FileError, Precision, to_bytes};
use crate::{
    Assembly, BeamElement, HammerError, HammerSetup, Law, Row, Station, Structure, StructureError, generator,
    read,
};
use jointscope_fixture::{BodyKind, Fixture, JointLaw};
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};
use std::f64::consts::TAU;

/// What the analyst believes, as a fixture file.
pub const FIXTURE: &str = include_str!("glued_joint/fixture.json");

/// Seed of the shipped recording.
pub const SEED: u64 = 20_240_611;

/// Cross-section of the strip, m.
const WIDTH: f64 = 0.030;
const THICKNESS: f64 = 0.005;

/// Elements of the strip.
const ELEMENTS: usize = 24;

/// Steel: density (kg/m³), shear modulus (N/m²), shear coefficient of a rectangle.
const DENSITY: f64 = 7850.0;
const SHEAR_MODULUS: f64 = 8.0e10;
const SHEAR_COEFFICIENT: f64 = 5.0 / 6.0;

/// Epoxy: Young's and shear modulus (N/m²), and its loss factor at a frequency (Hz); the layers are viscous.
const EPOXY_MODULUS: f64 = 3.0e9;
const EPOXY_SHEAR_MODULUS: f64 = 1.1e9;
const EPOXY_LOSS: f64 = 0.03;
const EPOXY_LOSS_AT: f64 = 300.0;

/// Thickness of the layers at points 2 and 3, m.
const LAYERS: [f64; 2] = [1.3e-4, 1.7e-4];

/// The four FRFs of the test.
const PAIRS: [(&str, &str); 4] = [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")];

/// Why the test could not be simulated.
#[derive(Debug, thiserror::Error)]
pub enum GluedJointError {
    /// The structure.
    #[error(transparent)]
    Structure(#[from] StructureError),
    /// The hammer.
    #[error(transparent)]
    Hammer(#[from] HammerError),
    /// The recording.
    #[error(transparent)]
    File(#[from] FileError),
    /// The fixture is not the pair of blocks that this test is about.
    #[error("the fixture of the glued joint needs blocks A and B and one beam")]
    OtherFixture,
}

/// A layer of glue between a block and the strip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    /// Transverse stiffness (shear of the layer), N/m.
    pub translation: f64,
    /// Rotational stiffness (the layer pulled on one side, pressed on the other), N·m/rad.
    pub rotation: f64,
    /// Seconds by which a stiffness is multiplied to give its dashpot.
    pub viscosity: f64,
}

impl Layer {
    /// A layer of `thickness` (m) over the strip's cross-section.
    pub(crate) fn of_epoxy(thickness: f64) -> Self {
        let area = WIDTH * THICKNESS;
        let second_moment = WIDTH * THICKNESS.powi(3) / 12.0;
        Layer {
            translation: EPOXY_SHEAR_MODULUS * area / thickness,
            rotation: EPOXY_MODULUS * second_moment / thickness,
            viscosity: EPOXY_LOSS / (TAU * EPOXY_LOSS_AT),
        }
    }

    fn assemble(&self, assembly: &mut Assembly, block: &Station, strip: &Station) {
        for (stiffness, slip) in
            [(self.translation, strip.y.minus(&block.y)), (self.rotation, strip.theta.minus(&block.theta))]
        {
            assembly.spring(&slip, stiffness, Law::ELASTIC);
            assembly.dashpot(&slip, stiffness * self.viscosity);
        }
    }
}

/// The test: what was believed, what is true, what was recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct GluedJoint {
    /// What the analyst believes.
    pub fixture: Fixture,
    /// The same quantities as they really are.
    pub truth: Fixture,
    /// The layers at points 2 and 3.
    pub layers: [Layer; 2],
    /// The strip, of its full length.
    pub strip: BeamElement,
    /// The structure that was struck.
    pub structure: Structure,
    /// The hammer test.
    pub hammer: HammerSetup,
}

impl GluedJoint {
    /// The structure and the test of a seed.
    ///
    /// # Errors
    /// See [`GluedJointError`]; none with the shipped fixture.
    pub fn new(seed: u64) -> Result<Self, GluedJointError> {
        let fixture = Fixture::from_json(FIXTURE).map_err(StructureError::from)?;
        let truth = drawn_within_tolerance(&fixture, &mut generator(seed))?;
        let layers = LAYERS.map(Layer::of_epoxy);
        let strip = strip(&truth)?;
        let structure = assemble(&truth, &strip, &layers)?;
        let hammer = HammerSetup {
            averages: 8,
            noise_response: 0.01,
            noise_force: 0.003,
            corner: 1000.0,
            spread: 0.25,
            common_hits: false,
            seed,
        };
        Ok(GluedJoint { fixture, truth, layers, strip, structure, hammer })
    }

    /// What the test would read without noise, 2.5 to 1000 Hz.
    ///
    /// # Errors
    /// See [`GluedJointError`].
    pub(crate) fn noise_free(&self) -> Result<FrfSet, GluedJointError> {
        let lines = SpectralLines::even(2.5, 2.5, 400).map_err(StructureError::from)?;
        let pairs = PAIRS.map(|(response, reference)| FrfPair::transverse(response, reference));
        Ok(read(&self.structure, &[], &pairs, &lines)?)
    }

    /// The joint's static stiffness on d = u_to − R·u_from: as believed, and as it is.
    ///
    /// # Errors
    /// See [`GluedJointError`].
    pub fn static_stiffness(&self) -> Result<[[[f64; 2]; 2]; 2], GluedJointError> {
        let believed = BeamElement { shear_stiffness: f64::INFINITY, ..strip(&self.fixture)? };
        let length = self.strip.length;
        let mut flexibility = inverse(self.strip.end_stiffness()?);
        let [near, far] = self.layers;
        // The layer at the near end is seen through the strip's length.
        let turned = 1.0 / near.rotation;
        flexibility[0][0] += 1.0 / far.translation + 1.0 / near.translation + length * length * turned;
        flexibility[0][1] += length * turned;
        flexibility[1][0] += length * turned;
        flexibility[1][1] += 1.0 / far.rotation + turned;
        Ok([believed.end_stiffness()?, inverse(flexibility)])
    }

    /// The files of the example: `fixture.json`, `hammer-test.uff`, `README.md`.
    ///
    /// # Errors
    /// See [`GluedJointError`].
    pub fn files(&self) -> Result<[(&'static str, Vec<u8>); 3], GluedJointError> {
        let recording = self.hammer.measure(&self.noise_free()?)?;
        Ok([
            ("fixture.json", FIXTURE.as_bytes().to_vec()),
            ("hammer-test.uff", to_bytes("glued joint, hammer test", &recording, Precision::Single)?),
            ("README.md", self.readme()?.into_bytes()),
        ])
    }

    fn readme(&self) -> Result<String, GluedJointError> {
        let [believed, real] = self.static_stiffness()?;
        let frequencies = self.structure.natural_frequencies()?;
        let elastic: Vec<String> =
            frequencies.iter().filter(|f| **f > 1.0 && **f < 5000.0).map(|f| format!("{f:.1}")).collect();
        let [near, far] = self.layers;
        let layer = |point: &str, thickness: f64, layer: Layer| {
            format!(
                "| {point} | {:.2} mm | {:.3e} | {:.0} | {:.2} | {:.4} |\n",
                thickness * 1e3,
                layer.translation,
                layer.rotation,
                layer.translation * layer.viscosity,
                layer.rotation * layer.viscosity
            )
        };
        let mut quantities = String::new();
        for (stated, real) in self.fixture.quantities().iter().zip(self.truth.quantities()) {
            quantities += &format!("| `{}` | {:.6e} | {:.6e} |\n", stated.path, stated.value, real.value);
        }
        Ok(format!(
            include_str!("glued_joint/readme.txt"),
            seed = self.hammer.seed,
            elements = ELEMENTS,
            mass = self.strip.mass_per_length * self.strip.length,
            shear = self.strip.shear_stiffness,
            rotary = self.strip.rotary_inertia,
            layers = layer("2", LAYERS[0], near) + &layer("3", LAYERS[1], far),
            loss = EPOXY_LOSS,
            loss_at = EPOXY_LOSS_AT,
            believed_11 = believed[0][0],
            real_11 = real[0][0],
            believed_12 = believed[0][1],
            real_12 = real[0][1],
            believed_22 = believed[1][1],
            real_22 = real[1][1],
            elastic = elastic.join(", "),
            averages = self.hammer.averages,
            noise_response = self.hammer.noise_response * 100.0,
            noise_force = self.hammer.noise_force * 100.0,
            spread = self.hammer.spread * 100.0,
            corner = self.hammer.corner,
            quantities = quantities,
        ))
    }
}

fn inverse([[a, b], [c, d]]: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let determinant = a * d - b * c;
    [[d / determinant, -b / determinant], [-c / determinant, a / determinant]]
}

/// The strip between points 2 and 3, of its full length.
fn strip(fixture: &Fixture) -> Result<BeamElement, GluedJointError> {
    let joint = fixture.joints().first().ok_or(GluedJointError::OtherFixture)?;
    let JointLaw::Beam { youngs_modulus, second_moment } = &joint.law else {
        return Err(GluedJointError::OtherFixture);
    };
    let area = WIDTH * THICKNESS;
    Ok(BeamElement {
        length: fixture.joint_length(joint),
        bending_stiffness: youngs_modulus.value * second_moment.value,
        shear_stiffness: SHEAR_COEFFICIENT * SHEAR_MODULUS * area,
        mass_per_length: DENSITY * area,
        rotary_inertia: DENSITY * second_moment.value,
    })
}

/// Blocks, layers and meshed strip; what is lost elsewhere (cables, suspension, air) damps the blocks as the
/// fixture's ratios say.
fn assemble(truth: &Fixture, strip: &BeamElement, layers: &[Layer; 2]) -> Result<Structure, GluedJointError> {
    let point = |name: &str| truth.point(name).map(|p| p.x.value).ok_or(GluedJointError::OtherFixture);
    let (x2, x3) = (point("2")?, point("3")?);
    let (mut assembly, [a, b]) = blocks(truth)?;
    let mut firm = assembly.clone();
    let ideal =
        BeamElement { shear_stiffness: f64::INFINITY, mass_per_length: 0.0, rotary_inertia: 0.0, ..*strip };
    ideal.assemble(&mut firm, &a.rigidly_at(x2), &b.rigidly_at(x3), Law::ELASTIC)?;

    let mut left = assembly.node();
    layers[0].assemble(&mut assembly, &a.rigidly_at(x2), &left);
    let element = BeamElement { length: strip.length / ELEMENTS as f64, ..*strip };
    for _ in 0..ELEMENTS {
        let right = assembly.node();
        element.assemble(&mut assembly, &left, &right, Law::ELASTIC)?;
        left = right;
    }
    layers[1].assemble(&mut assembly, &b.rigidly_at(x3), &left);
    // Free: it has no supports.
    add_viscous(&mut assembly, &firm, &firm, truth.damping())?;

    let (x1, x4) = (point("1")?, point("4")?);
    let points =
        [("1", a.rigidly_at(x1)), ("2", a.rigidly_at(x2)), ("3", b.rigidly_at(x3)), ("4", b.rigidly_at(x4))];
    Ok(Structure::new(assembly, points.map(|(name, station)| (name.to_string(), station))))
}

/// Blocks A and B, each as its station at x = 0.
fn blocks(truth: &Fixture) -> Result<(Assembly, [Station; 2]), GluedJointError> {
    let mut assembly = Assembly::new();
    let mut block = |name: &str| {
        let Some(BodyKind::Rigid(rigid)) = truth.body(name).map(|body| &body.kind) else {
            return Err(GluedJointError::OtherFixture);
        };
        let (Some(inertia), Some(x_cg)) = (rigid.inertia, rigid.x_cg) else {
            return Err(GluedJointError::OtherFixture);
        };
        let origin = assembly.node();
        let centre: Row = origin.rigidly_at(x_cg.value).y;
        assembly.inertia(&centre, rigid.mass.value);
        assembly.inertia(&origin.theta, inertia.value);
        Ok(origin)
    };
    let blocks = [block("A")?, block("B")?];
    Ok((assembly, blocks))
}
