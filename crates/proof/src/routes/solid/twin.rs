//! The solid's FRFs: its finite-element twin with all switched off that is not concealed.

use crate::GenerationError;
use jointscope_fem::{Brick, BrickOwner, Mesh, MeshOptions, ModeRange, Omissions, Superposition, Twin};
use jointscope_fixture::{Effect, EffectKind, Fixture, Place};
use jointscope_spectra::{Channel, FrfForm, FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;
use serde::{Deserialize, Serialize};

/// What of the solid is left on, of all that the lumped model leaves out.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Shown {
    /// The strip weighs what it weighs.
    pub strip_mass: bool,
    /// The strip shears, with this modulus (N/m²).
    pub strip_shear: Option<f64>,
    /// The layer shears, with this modulus (N/m²).
    pub layer_shear: Option<f64>,
}

/// Frequencies within 0.1 % of those on a mesh twice as fine. A strip that cannot shear needs many elements
/// along it; its corners do not count, since the blocks hardly yield.
pub(crate) const MESH: MeshOptions = MeshOptions {
    corner: 4,
    along: 32,
    across: 1,
    growth: 8.0,
    whole: false,
    without: Omissions { joint_mass: true, shear: true, plate_action: true, block_flexibility: true },
};

/// Factor by which blocks are stiffer than the twin's own omission makes them, which leaves a hundredth of
/// the footing: as much as 0.1 % of the second frequency.
const STIFFER: f64 = 10.0;
/// Factor by which strips and layers weigh less than the twin's own omission leaves them: a hundredth of a
/// strip was found by its name.
const LIGHTER: f64 = 0.01;
/// Modes up to this multiple of the last line.
const MODES: f64 = 2.0;

/// The modes of a solid fixture.
pub(super) fn twin(
    solid: &Fixture,
    shown: &Shown,
    options: &MeshOptions,
    last_line: f64,
) -> Result<Twin, GenerationError> {
    let mut mesh = Mesh::of(solid, options)?;
    restore(&mut mesh, options, shown);
    let range = ModeRange { at_least: 4, up_to: MODES * last_line };
    Ok(Twin::of_mesh(solid, mesh, range, |_| ())?)
}

/// Gives strip and layer back what is concealed in them, and takes more of the rest from them and from the
/// blocks.
fn restore(mesh: &mut Mesh, options: &MeshOptions, shown: &Shown) {
    // Without omissions a mesh has its materials as they are; with them, as they are first.
    let sets = if options.without == Omissions::default() { 1 } else { 3 };
    let plain = mesh.materials.len() / sets;
    let mut changed: Vec<usize> = Vec::new();
    for index in 0..mesh.elements.len() {
        let Brick { part, material, .. } = mesh.elements[index];
        let mut own = mesh.materials[material];
        let (weighs, shear) = match part {
            BrickOwner::Joint(_) => (shown.strip_mass, shown.strip_shear),
            BrickOwner::Layer(..) => (false, shown.layer_shear),
            BrickOwner::Body(_) => {
                own.youngs_modulus *= STIFFER;
                (false, None)
            }
        };
        own.density = match (part, weighs) {
            (BrickOwner::Body(_), _) => own.density,
            (_, true) => mesh.materials[material % plain].density,
            (_, false) => LIGHTER * own.density,
        };
        if let Some(modulus) = shear {
            // Poisson's ratio is switched off, so that the shear modulus is half of Young's.
            own.shear_factor = 2.0 * modulus / own.youngs_modulus;
        }
        let known = changed.iter().copied().find(|known| mesh.materials[*known] == own);
        let position = known.unwrap_or_else(|| {
            mesh.materials.push(own);
            changed.push(mesh.materials.len() - 1);
            mesh.materials.len() - 1
        });
        mesh.elements[index].material = position;
    }
}

/// Accelerances as the measuring chain of `effects` reads them: gains, delays, points elsewhere.
pub(in crate::routes) fn read(
    twin: &Twin,
    effects: &[Effect],
    pairs: &[FrfPair],
    lines: &SpectralLines,
) -> Result<FrfSet, GenerationError> {
    let displaced = |channel: &Channel| {
        let moved = |effect: &Effect| {
            effect.kind == EffectKind::PointOffset && effect.place == Place::Point(channel.point.clone())
        };
        match effects.iter().any(moved) {
            true => Channel { point: displaced_name(&channel.point), ..channel.clone() },
            false => channel.clone(),
        }
    };
    let asked: Vec<FrfPair> =
        pairs.iter().map(|p| FrfPair::new(displaced(&p.response), displaced(&p.reference))).collect();
    let solved = twin.frfs(&asked, lines, Superposition::Complete)?.to_form(FrfForm::Accelerance)?;
    let mut values: Vec<Complex64> = solved.all_values().to_vec();
    for (pair, values) in pairs.iter().zip(values.chunks_mut(lines.len())) {
        for effect in effects {
            let side = match &effect.place {
                Place::Response(name) if *name == pair.response.to_string() => 1,
                Place::Reference(name) if *name == pair.reference.to_string() => -1,
                _ => continue,
            };
            for (value, omega) in values.iter_mut().zip(lines.omegas()) {
                *value *= match effect.kind {
                    EffectKind::ChannelGain => Complex64::from(effect.value(0).powi(side)),
                    EffectKind::ChannelDelay => {
                        Complex64::from_polar(1.0, -f64::from(side) * omega * effect.value(0))
                    }
                    _ => Complex64::ONE,
                };
            }
        }
    }
    Ok(FrfSet::new(lines.clone(), FrfForm::Accelerance, pairs.to_vec(), values)?)
}

/// What the solid calls the place at which a point is really read.
pub(super) fn displaced_name(point: &str) -> String {
    format!("10{point}")
}
