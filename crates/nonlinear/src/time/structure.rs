//! A fixture as a system to be stepped through time.

use super::kernel::{Element, MOST_ELEMENTS, MOST_STATES, Output, System};
use super::law::RestoringLaw;
use crate::settings::simulation::UNFELT_MODE;
use crate::{ChannelError, SimulationError};
use jointscope_fixture::{Dof, Effect, EffectKind, Fixture, Place, Point, Side};
use jointscope_hits::MeasuredMotion;
use jointscope_lumped::{StateSpace, Station};
use jointscope_spectra::Channel;

/// What a sensor reads: where and which motion.
pub(crate) type Reading = (Channel, MeasuredMotion);

/// The assembly over time with its amplitude-dependent elements.
pub(crate) struct Structure<'a> {
    fixture: &'a Fixture,
    space: StateSpace,
    elements: Vec<Element>,
}

impl<'a> Structure<'a> {
    /// The fixture with all its structural effects, for motions up to `highest_hz`.
    pub(crate) fn new(fixture: &'a Fixture, highest_hz: f64) -> Result<Self, SimulationError> {
        let mut structure =
            Structure { fixture, space: StateSpace::new(fixture, highest_hz)?, elements: Vec::new() };
        for effect in fixture.physics() {
            if let (Some(law), Place::Joint(joint)) = (RestoringLaw::of(effect), &effect.place)
                && let Some((motion, load)) = structure.across(joint, effect.dof.unwrap_or(Dof::Translation))
            {
                structure.elements.push(Element { law, load, motion });
            }
        }
        match structure.elements.len() {
            count if count > MOST_ELEMENTS => Err(SimulationError::TooManyElements(count, MOST_ELEMENTS)),
            _ => Ok(structure),
        }
    }

    /// One component of the motion across a joint: the row over all states that reads it, and the load of a
    /// force pair of 1 that drives it.
    pub(crate) fn across(&self, joint: &str, dof: Dof) -> Option<(Vec<f64>, Vec<f64>)> {
        let [deflection, rotation] = self.space.across(joint)?;
        Some(if dof == Dof::Rotation { rotation } else { deflection })
    }

    /// The load over all states of a force of 1 at `struck`.
    pub(crate) fn load(&self, struck: &Channel) -> Result<Vec<f64>, SimulationError> {
        Ok(self.space.load(&station(self.fixture, struck, Side::Reference)?))
    }

    /// The system under a load, read by `readings` and by rows over all states of the assembly. Rigid motions
    /// that nothing holds and no element feels are no states of it: their accelerations follow from the force
    /// at once.
    pub(crate) fn system(
        &self,
        load: Vec<f64>,
        readings: &[Reading],
        rows: &[Vec<f64>],
    ) -> Result<System, SimulationError> {
        let mut outputs = Vec::with_capacity(readings.len() + rows.len());
        for (channel, motion) in readings {
            let station = station(self.fixture, channel, Side::Response)?;
            outputs.push(match motion {
                MeasuredMotion::Displacement => self.plain(self.space.displacement(&station)),
                MeasuredMotion::Velocity => self.plain(self.space.velocity(&station)),
                MeasuredMotion::Acceleration => self.acceleration(&self.space.velocity(&station), &load),
            });
        }
        outputs.extend(rows.iter().map(|row| self.plain(row.clone())));
        self.reduced(load, outputs)
    }

    fn plain(&self, row: Vec<f64>) -> Output {
        Output { row, force: 0.0, elements: vec![0.0; self.elements.len()] }
    }

    /// The rate of a velocity: its row times A, with what force and elements add at once.
    fn acceleration(&self, velocity: &[f64], load: &[f64]) -> Output {
        let n = self.space.states();
        let mut row = vec![0.0; n];
        for (factor, line) in velocity.iter().zip(self.space.matrix().chunks_exact(n)) {
            if *factor != 0.0 {
                row.iter_mut().zip(line).for_each(|(to, a)| *to += factor * a);
            }
        }
        let along = |load: &[f64]| velocity.iter().zip(load).map(|(v, b)| v * b).sum();
        Output { row, force: along(load), elements: self.elements.iter().map(|e| along(&e.load)).collect() }
    }

    fn reduced(&self, load: Vec<f64>, outputs: Vec<Output>) -> Result<System, SimulationError> {
        let (size, n) = (self.space.states(), self.space.coordinates());
        let matrix = self.space.matrix();
        let largest = |row: &[f64]| row.iter().fold(0.0, |most: f64, v| v.abs().max(most));
        let felt = |r: usize| {
            let element = |e: &Element| e.motion[r].abs() > UNFELT_MODE * largest(&e.motion);
            self.elements.iter().any(element)
                || outputs.iter().any(|o| o.row[r] != 0.0 || o.row[n + r] != 0.0)
        };
        let still = |r: usize| {
            let own = |i: usize, j: usize| i == r && j == n + r;
            let empty = (0..size).all(|k| {
                matrix[(n + r) * size + k] == 0.0
                    && (own(k, n + r) || matrix[k * size + n + r] == 0.0)
                    && matrix[k * size + r] == 0.0
            });
            empty && !felt(r)
        };
        let dropped: Vec<bool> = (0..n).map(still).collect();
        let kept: Vec<usize> = (0..size).filter(|i| *i >= 2 * n || !dropped[i % n]).collect();
        if kept.len() > MOST_STATES {
            return Err(SimulationError::TooManyStates { modes: kept.len() / 2, most: MOST_STATES / 2 });
        }
        let pick = |values: &[f64]| kept.iter().map(|&i| values[i]).collect::<Vec<f64>>();
        let element = |e: &Element| Element { law: e.law, load: pick(&e.load), motion: pick(&e.motion) };
        Ok(System {
            matrix: kept.iter().flat_map(|&i| pick(&matrix[i * size..(i + 1) * size])).collect(),
            load: pick(&load),
            elements: self.elements.iter().map(element).collect(),
            outputs: outputs.into_iter().map(|o| Output { row: pick(&o.row), ..o }).collect(),
        })
    }
}

/// The body, abscissa and direction of a channel.
pub(crate) fn station(fixture: &Fixture, channel: &Channel, side: Side) -> Result<Station, ChannelError> {
    let known = || fixture.points().iter().map(|p| p.name.as_str()).collect::<Vec<_>>().join(", ");
    let point = fixture
        .point(&channel.point)
        .ok_or_else(|| ChannelError::UnknownPoint { point: channel.point.clone(), known: known() })?;
    if channel.dof == Dof::Rotation && !fixture.bodies()[point.body].kind.rotates() {
        return Err(ChannelError::NoRotation(channel.point.clone()));
    }
    Ok(Station { body: point.body, x: abscissa_m(fixture, point, side), dof: channel.dof })
}

/// Where a point really lies: as stated, moved by what the fixture says of it.
pub(crate) fn abscissa_m(fixture: &Fixture, point: &Point, side: Side) -> f64 {
    let is_here = |effect: &&Effect| {
        effect.kind == EffectKind::PointOffset && effect.place.holds_channel(&point.name, side)
    };
    point.x.value + fixture.effects().filter(is_here).map(|e| e.value(0)).sum::<f64>()
}

/// The effects of one kind at one place.
pub(crate) fn effects(fixture: &Fixture, kind: EffectKind, place: Place) -> impl Iterator<Item = &Effect> {
    fixture.effects().filter(move |e| e.kind == kind && e.place == place)
}
