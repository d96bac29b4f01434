//! Where sensors sit and hammers strike: how a model's residues move with that.
//!
//! A hammer strikes within a millimetre of its point, and a sensor is wider than that. Along a block that
//! turns about a node 30 mm away this is 3 % of a residue: far more than the shapes of a model are wrong by,
//! and nothing that it is wrong about. An error of this kind is one displacement of each channel, common to
//! all of its FRFs and modes, that changes residues by the slopes of the shapes.

use crate::modelled::ModelledModes;
use crate::recorded::RecordedModes;
use crate::settings::strikes::STEP;
use jointscope_fixture::{BodyKind, Effect, EffectKind, Fixture, Place, Side};
use jointscope_spectra::{Channel, FrfPair};
use num_complex::Complex64;

/// How a model's features move, for a metre, as all sensors or all impacts of a test move along the
/// structure: each FRF's with its own.
#[derive(Debug, Clone, PartialEq)]
pub struct StrikeSlopes {
    side: Side,
    /// By mode of the model and FRF.
    residues: Vec<Vec<Complex64>>,
    /// Mass line and upper residual, by FRF.
    terms: Vec<[f64; 2]>,
}

/// The channel of an FRF on one side.
fn channel(pair: &FrfPair, side: Side) -> &Channel {
    match side {
        Side::Response => &pair.response,
        Side::Reference => &pair.reference,
    }
}

impl StrikeSlopes {
    /// Of sensors and of impacts about the modes `modelled` of a fixture; `None` where a pole cannot be
    /// followed.
    pub fn of(fixture: &Fixture, recorded: &RecordedModes, modelled: &ModelledModes) -> Option<[Self; 2]> {
        let slopes = |side: Side| {
            let moved =
                ModelledModes::after_step(&displaced(fixture, recorded, side)?, recorded, (None, modelled))?;
            let residues = modelled.modes.iter().zip(&moved.modes).map(|(here, there)| {
                here.residues.iter().zip(&there.residues).map(|(a, b)| (b - a) / STEP).collect()
            });
            let terms = modelled.residual_terms.iter().zip(&moved.residual_terms);
            let terms = terms.map(|(a, b)| std::array::from_fn(|k| (b[k] - a[k]) / STEP));
            Some(StrikeSlopes { side, residues: residues.collect(), terms: terms.collect() })
        };
        Some([slopes(Side::Response)?, slopes(Side::Reference)?])
    }

    /// FRFs that share a channel on this side.
    pub(crate) fn sharing(&self, recorded: &RecordedModes) -> Vec<Vec<usize>> {
        let mut channels: Vec<(&Channel, Vec<usize>)> = Vec::new();
        for (frf, pair) in recorded.pairs.iter().enumerate() {
            let own = channel(pair, self.side);
            match channels.iter_mut().find(|(other, _)| *other == own) {
                Some((_, frfs)) => frfs.push(frf),
                None => channels.push((own, vec![frf])),
            }
        }
        channels.into_iter().map(|(_, frfs)| frfs).collect()
    }

    /// Of the residue of a mode in an FRF.
    pub(crate) fn residue(&self, mode: usize, frf: usize) -> Complex64 {
        self.residues[mode][frf]
    }

    /// Of mass line and upper residual of an FRF.
    pub(crate) fn terms(&self, frf: usize) -> [f64; 2] {
        self.terms[frf]
    }
}

/// The fixture with every channel of one side a step further along, or back where a beam ends.
fn displaced(fixture: &Fixture, recorded: &RecordedModes, side: Side) -> Option<Fixture> {
    let mut names: Vec<&str> = recorded.pairs.iter().map(|pair| channel(pair, side).point.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let effect = |name: &&str| {
        let point = fixture.point(name)?;
        let beyond = match &fixture.bodies()[point.body].kind {
            BodyKind::Beam(beam) => point.x.value + STEP > beam.to.value,
            _ => false,
        };
        let place = match side {
            Side::Response => Place::Response(name.to_string()),
            Side::Reference => Place::Reference(name.to_string()),
        };
        Some(Effect::new(EffectKind::PointOffset, place, None, &[if beyond { -STEP } else { STEP }]))
    };
    let mut physics = fixture.physics().to_vec();
    physics.extend(names.iter().map(effect).collect::<Option<Vec<_>>>()?);
    fixture.clone().with_physics(physics).ok()
}
