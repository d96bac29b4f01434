//! An assembly with its effects: modes, participations, and the low-rank terms that are added line by line.

mod change;

use crate::assembly::Rows;
use crate::bar::BarShape;
use crate::denominator::Denominator;
use crate::effects::{Action, actions};
use crate::term_station::TermStation;
use crate::terms::Terms;
use crate::{Assembly, LumpedError};
use jointscope_fixture::{BodyKind, Fixture};
use jointscope_spectra::Dof;
use num_complex::Complex64;

/// The assembly with its supports and structural effects, ready to give receptances.
///
/// Effects of the measuring chain are not in it: they belong to a recording, see [`crate::synthesize`].
#[derive(Debug, Clone)]
pub struct Model {
    assembly: Assembly,
    bending: Vec<BendingCoordinate>,
    terms: Terms,
    pub(crate) highest_hz: f64,
}

/// The first bending mode of a block that was taken as rigid.
#[derive(Debug, Clone)]
struct BendingCoordinate {
    body: usize,
    shape: BarShape,
    modal_mass: f64,
    eigenvalue: f64,
    viscous: f64,
}

impl Model {
    /// Models the fixture with its structural effects, beams meshed for lines up to `highest_hz`.
    ///
    /// # Errors
    /// Modes that cannot be computed; an effect that depends on amplitude.
    pub fn new(fixture: &Fixture, highest_hz: f64) -> Result<Self, LumpedError> {
        refuse_nonlinear(fixture)?;
        Self::linear_part(fixture, highest_hz)
    }

    /// As [`Model::new`], effects that depend on amplitude left aside.
    pub(crate) fn linear_part(fixture: &Fixture, highest_hz: f64) -> Result<Self, LumpedError> {
        Ok(Self::with(Assembly::condensed(fixture, highest_hz)?, fixture, highest_hz))
    }

    /// The model of a fixture `moved` by next to nothing from this one's, modes to first order where they
    /// follow from those at hand, given also coordinate after coordinate: for derivatives alone.
    ///
    /// # Errors
    /// Those of [`Model::new`].
    pub(crate) fn beside(&self, here: (&Fixture, &Rows), moved: &Fixture) -> Result<Self, LumpedError> {
        refuse_nonlinear(moved)?;
        let assembly = match self.assembly.beside(here, moved, self.highest_hz) {
            Some(assembly) => assembly,
            None => Assembly::condensed(moved, self.highest_hz)?,
        };
        Ok(Self::with(assembly, moved, self.highest_hz))
    }

    /// Whether models of fixtures next to this one may take their modes from its own.
    pub(crate) fn has_neighbours(fixture: &Fixture) -> bool {
        Assembly::has_neighbours(fixture)
    }

    pub(crate) fn is_first_order(&self) -> bool {
        self.assembly.is_first_order()
    }

    fn with(assembly: Assembly, fixture: &Fixture, highest_hz: f64) -> Self {
        let bending = bending_coordinates(fixture);
        let flexible: Vec<bool> =
            (0..fixture.bodies().len()).map(|body| bending.iter().any(|b| b.body == body)).collect();
        Model { assembly, bending, terms: Terms::of(fixture, &flexible), highest_hz }
    }

    /// The amplitudes of its modes at each coordinate.
    pub(crate) fn rows(&self) -> Rows {
        self.assembly.rows()
    }

    /// What is not a proportional part of the free assembly.
    pub(crate) fn terms(&self) -> &Terms {
        &self.terms
    }

    /// How the assembly is damped.
    pub(crate) fn damping_law(&self) -> &jointscope_damping::DampingLaw {
        self.assembly.damping_law()
    }

    pub(crate) fn participation(&self, station: &TermStation) -> Vec<f64> {
        let mut all = vec![0.0; self.assembly.order() + self.bending.len()];
        for (weight, part) in station.parts() {
            self.assembly.add_participation(part, *weight, &mut all[..self.assembly.order()]);
        }
        let bending = all[self.assembly.order()..].iter_mut().zip(&self.bending);
        bending.for_each(|(value, mode)| *value = mode.motion(station));
        all
    }

    pub(crate) fn denominators(&self) -> Vec<Denominator> {
        let assembly = self.assembly.eigenvalues().iter().zip(self.assembly.mode_damping());
        let assembly = assembly.map(|(&eigenvalue, damping)| Denominator {
            stiffness: Complex64::new(eigenvalue, damping.structural),
            viscous: damping.viscous,
        });
        let bending = self
            .bending
            .iter()
            .map(|b| Denominator { stiffness: Complex64::new(b.eigenvalue, 0.0), viscous: b.viscous });
        assembly.chain(bending).collect()
    }
}

fn refuse_nonlinear(fixture: &Fixture) -> Result<(), LumpedError> {
    match fixture.physics().iter().enumerate().find(|(_, e)| e.kind.is_nonlinear()) {
        Some((index, effect)) => Err(LumpedError::NonLinear { index, kind: effect.kind.name() }),
        None => Ok(()),
    }
}

impl BendingCoordinate {
    /// What it contributes to a motion, for a modal mass of one.
    fn motion(&self, station: &TermStation) -> f64 {
        let of = |(weight, part): &(f64, crate::Station)| {
            let (deflection, slope) = self.shape.at(part.x);
            weight * if part.dof == Dof::Translation { deflection } else { slope } / self.modal_mass.sqrt()
        };
        let own = station.parts().filter(|(_, part)| !station.rigid_only && part.body == self.body);
        own.fold(0.0, |sum, part| sum + of(part))
    }
}

fn bending_coordinates(fixture: &Fixture) -> Vec<BendingCoordinate> {
    let of = |action| {
        let Action::Bending { body, omega, ratio } = action else { return None };
        let BodyKind::Rigid(rigid) = &fixture.bodies()[body].kind else { return None };
        let inertia = rigid.inertia.map_or(0.0, |q| q.value);
        Some(BendingCoordinate {
            body,
            shape: BarShape::new(rigid.mass.value, inertia, rigid.x_cg.map_or(0.0, |q| q.value)),
            modal_mass: rigid.mass.value,
            eigenvalue: omega * omega,
            viscous: 2.0 * ratio * omega,
        })
    };
    actions(fixture).filter_map(of).collect()
}
