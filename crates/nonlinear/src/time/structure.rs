//! A fixture as a system to be stepped through time.

use super::kernel::{Element, MOST_ELEMENTS, MOST_STATES, Output, System};
use super::law::RestoringLaw;
use crate::SimulationError;
use jointscope_fixture::{BodyKind, Dof, EffectKind, Fixture, Place};
use jointscope_hits::Motion;
use jointscope_lumped::{StateSpace, Station};
use jointscope_spectra::Channel;

/// What a sensor reads: where and which motion.
pub(crate) type Reading = (Channel, Motion);

/// The assembly over time with its amplitude-dependent elements.
pub(crate) struct Structure<'a> {
    fixture: &'a Fixture,
    space: StateSpace,
    elements: Vec<Element>,
}

/// Share of an element's largest participation below which a mode does not move it.
const UNMOVED: f64 = 1e-9;

impl<'a> Structure<'a> {
    /// The fixture with all its structural effects, for motions up to `highest_hz`.
    pub fn new(fixture: &'a Fixture, highest_hz: f64) -> Result<Self, SimulationError> {
        let space = StateSpace::new(fixture, highest_hz)?;
        let mut elements = Vec::new();
        for effect in fixture.physics() {
            let (Some(law), Place::Joint(joint)) = (RestoringLaw::of(effect), &effect.place) else {
                continue;
            };
            let Some(across) = space.across(joint) else { continue };
            let [deflection, rotation] = across;
            let (motion, load) = if effect.dof == Some(Dof::Rotation) { rotation } else { deflection };
            elements.push(Element { law, load, motion });
        }
        if elements.len() > MOST_ELEMENTS {
            return Err(SimulationError::TooManyElements { count: elements.len(), most: MOST_ELEMENTS });
        }
        Ok(Structure { fixture, space, elements })
    }

    /// Deflection and rotation across a joint: the row over all states that reads it, and the load of a force pair of 1 that drives it.
    pub fn across(&self, joint: &str) -> Option<[(Vec<f64>, Vec<f64>); 2]> {
        self.space.across(joint)
    }

    /// The system struck at `struck` and read by `readings`. Rigid motions that nothing holds and no element feels are no states of it:
    /// their accelerations follow from the force at once.
    pub fn system(&self, struck: &Channel, readings: &[Reading]) -> Result<System, SimulationError> {
        self.system_with(struck, readings, &[])
    }

    /// The system struck at `struck`, read by `readings` and by rows over all states of the assembly.
    pub fn system_with(
        &self,
        struck: &Channel,
        readings: &[Reading],
        rows: &[Vec<f64>],
    ) -> Result<System, SimulationError> {
        self.system_loaded(self.space.load(&self.station(struck)?), readings, rows)
    }

    /// The system under a load over all states of the assembly, read as in [`Structure::system_with`].
    pub fn system_loaded(
        &self,
        load: Vec<f64>,
        readings: &[Reading],
        rows: &[Vec<f64>],
    ) -> Result<System, SimulationError> {
        let mut outputs = Vec::with_capacity(readings.len() + rows.len());
        for (channel, motion) in readings {
            let station = self.station(channel)?;
            outputs.push(match motion {
                Motion::Displacement => self.plain(self.space.displacement(&station)),
                Motion::Velocity => self.plain(self.space.velocity(&station)),
                Motion::Acceleration => self.acceleration(&self.space.velocity(&station), &load),
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
            let element = |e: &Element| e.motion[r].abs() > UNMOVED * largest(&e.motion);
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
            return Err(SimulationError::TooManyStates { states: kept.len(), most: MOST_STATES });
        }
        let pick = |values: &[f64]| kept.iter().map(|&i| values[i]).collect::<Vec<f64>>();
        let elements = self.elements.iter().map(|e| Element {
            law: e.law,
            load: pick(&e.load),
            motion: pick(&e.motion),
        });
        Ok(System {
            matrix: kept.iter().flat_map(|&i| pick(&matrix[i * size..(i + 1) * size])).collect(),
            load: pick(&load),
            elements: elements.collect(),
            outputs: outputs.into_iter().map(|o| Output { row: pick(&o.row), ..o }).collect(),
        })
    }

    /// Where a channel really sits: its point, moved by what the fixture says of it.
    fn station(&self, channel: &Channel) -> Result<Station, SimulationError> {
        let fixture = self.fixture;
        let point = fixture.point(&channel.point).ok_or_else(|| SimulationError::UnknownPoint {
            point: channel.point.clone(),
            known: fixture.points().iter().map(|p| p.name.as_str()).collect::<Vec<_>>().join(", "),
        })?;
        let turns = !matches!(&fixture.bodies()[point.body].kind, BodyKind::Rigid(rigid) if !rigid.rotates);
        if channel.dof == Dof::Rotation && !turns {
            return Err(SimulationError::NoRotation { point: channel.point.clone() });
        }
        let moved = fixture.physics().iter().filter(|e| {
            e.kind == EffectKind::PointOffset && matches!(&e.place, Place::Point(name) if *name == point.name)
        });
        let offset: f64 = moved.map(|e| e.value(0)).sum();
        Ok(Station { body: point.body, x: point.x.value + offset, dof: channel.dof })
    }
}
