//! Where sensors sit and hammers strike: how a model's residues move with that.
//!
//! A hammer strikes within a millimetre of its point, and a sensor is wider than that. Along a block that
//! turns about a node 30 mm away this is 3 % of a residue: far more than the shapes of a model are wrong by,
//! and nothing that it is wrong about. An error of this kind is one displacement of each channel, common to
//! all of its FRFs and modes, that changes residues by the slopes of the shapes.

use crate::errors::{STRIKE, SharedFeatures, put};
use crate::matching::Pairing;
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
    /// Of sensors and of impacts about the modes `modelled` of a fixture; `None` where no body turns, whose
    /// points then move alike, and where a pole cannot be followed.
    pub fn of(fixture: &Fixture, recorded: &RecordedModes, modelled: &ModelledModes) -> Option<[Self; 2]> {
        if fixture.bodies().iter().all(|body| !body.kind.rotates()) {
            return None;
        }
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
    fn sharing(&self, recorded: &RecordedModes) -> Vec<Vec<usize>> {
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
}

impl SharedFeatures {
    /// The same where sensors sit and hammers strike beside their points, with `slopes` of the model's
    /// features by that.
    pub fn with_strikes(
        mut self,
        recorded: &RecordedModes,
        (pairing, modelled): (&Pairing, &ModelledModes),
        slopes: &[StrikeSlopes; 2],
    ) -> Self {
        let (n, frfs, matched) = (self.count(), recorded.frfs(), pairing.pairs.len());
        let first = self.first_residue + 2 * matched * frfs;
        for side in slopes {
            for sharing in side.sharing(recorded) {
                let mut of_channel = Vec::new();
                for frf in sharing {
                    for (k, &(r, m)) in pairing.pairs.iter().enumerate() {
                        let at = self.first_residue + 2 * k * frfs + 2 * frf;
                        let slope = side.residues[m][frf] / recorded.modes[r].scale;
                        of_channel.extend([(at, slope.re), (at + 1, slope.im)]);
                    }
                    for (term, slope) in side.terms[frf].into_iter().enumerate() {
                        of_channel.push((first + 2 * frf + term, slope / recorded.residual_scales[term]));
                    }
                }
                for &(i, a) in &of_channel {
                    of_channel.iter().for_each(|&(j, b)| put(&mut self.kinds[STRIKE], n, (i, j), a * b));
                }
            }
        }
        let [of_sensor, of_impacts] = slopes;
        for (k, &(r, m)) in pairing.pairs.iter().enumerate() {
            for frf in 0..frfs {
                let at = (self.first_residue + 2 * k * frfs + 2 * frf) * (n + 1);
                let [residue, sensor, impacts] = [
                    modelled.modes[m].residues[frf],
                    of_sensor.residues[m][frf],
                    of_impacts.residues[m][frf],
                ]
                .map(|value| value.re / recorded.modes[r].scale);
                // φ_o'·φ_i' of the residue φ_o·φ_i.
                let together = sensor * impacts / residue;
                if together.is_finite() {
                    self.struck[0].push((at, together.powi(2)));
                }
                self.struck[1].push((at, sensor.powi(2) + impacts.powi(2)));
            }
        }
        self
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
