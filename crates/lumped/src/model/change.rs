//! How a model changes with its fixture, to first order.

use super::{BendingCoordinate, Model, bending_coordinates};
use crate::assembly::AssemblyChange;
use crate::denominator::Denominator;
use crate::term_station::TermStation;
use crate::terms::Terms;
use jointscope_fixture::Fixture;
use num_complex::Complex64;

/// Changes of a model, divided by the step from one fixture to the other.
#[derive(Debug, Clone)]
pub(crate) struct ModelChange {
    step: f64,
    assembly: AssemblyChange,
    /// After the step.
    bending: Vec<BendingCoordinate>,
    /// After the step.
    pub terms: Terms,
    /// Of each mode, those of bending blocks last.
    pub denominators: Vec<Denominator>,
}

impl Model {
    /// What a `step` changes that leads from `fixture`, whose model this is, to `moved`; `None` where that
    /// cannot be told from this model.
    pub(crate) fn change(&self, fixture: &Fixture, moved: &Fixture, step: f64) -> Option<ModelChange> {
        let bending = bending_coordinates(moved);
        let flexible: Vec<bool> =
            (0..moved.bodies().len()).map(|body| bending.iter().any(|b| b.body == body)).collect();
        let terms = Terms::of(moved, &flexible);
        let is_same = bending.len() == self.bending.len()
            && terms.stations.len() == self.terms.stations.len()
            && terms.elements() == self.terms.elements();
        let assembly = if is_same { self.assembly.change(fixture, moved, step)? } else { return None };
        let own =
            assembly.eigenvalues.iter().zip(&assembly.damping).map(|(eigenvalue, damping)| Denominator {
                stiffness: Complex64::new(*eigenvalue, damping.structural),
                viscous: damping.viscous,
            });
        let of_bending = self.bending.iter().zip(&bending).map(|(before, after)| Denominator {
            stiffness: Complex64::new((after.eigenvalue - before.eigenvalue) / step, 0.0),
            viscous: (after.viscous - before.viscous) / step,
        });
        let denominators = own.chain(of_bending).collect();
        Some(ModelChange { step, assembly, bending, terms, denominators })
    }

    /// The change of the `participation` of a motion that is `before`, and `after` the step.
    pub(crate) fn participation_change(
        &self,
        change: &ModelChange,
        participation: &[f64],
        [before, after]: [&TermStation; 2],
    ) -> Vec<f64> {
        let of_modes = &participation[..self.assembly.order()];
        let mut all =
            self.assembly.participation_change(&change.assembly, of_modes, before.parts(), after.parts());
        for (here, there) in self.bending.iter().zip(&change.bending) {
            all.push((there.motion(after) - here.motion(before)) / change.step);
        }
        all
    }

    /// How many modes there are, those of bending blocks included.
    pub(crate) fn modes(&self) -> usize {
        self.assembly.order() + self.bending.len()
    }

    /// How many of the modes are those of the assembly: the first ones.
    pub(crate) fn assembly_modes(&self) -> usize {
        self.assembly.order()
    }
}
