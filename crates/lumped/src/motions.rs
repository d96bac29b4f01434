//! The motions between which receptances are needed.

use crate::term_station::TermStation;
use crate::{Model, Station};

/// Participations of what is read, of what is pushed and of what changes act through, a row over the modes
/// each.
#[derive(Debug, Clone)]
pub(crate) struct Motions {
    pub outputs: Vec<Vec<f64>>,
    pub inputs: Vec<Vec<f64>>,
    pub change: Vec<Vec<f64>>,
}

impl Motions {
    pub(crate) fn of(model: &Model, outputs: &[Station], inputs: &[Station]) -> Self {
        let single = |all: &[Station]| -> Vec<Vec<f64>> {
            all.iter().map(|station| model.participation(&TermStation::single(*station))).collect()
        };
        Motions {
            outputs: single(outputs),
            inputs: single(inputs),
            change: model.terms().stations.iter().map(|station| model.participation(station)).collect(),
        }
    }

    /// The pairs of motions whose G is needed: the wanted ones, then G_oV, G_VV, G_Vi where there is a
    /// change.
    pub(crate) fn entries(&self, wanted: &[(usize, usize)]) -> Vec<[usize; 2]> {
        let (outputs, inputs, rank) = (self.outputs.len(), self.inputs.len(), self.change.len());
        let (first_input, first_change) = (outputs, outputs + inputs);
        let mut all: Vec<[usize; 2]> = wanted.iter().map(|&(o, i)| [o, first_input + i]).collect();
        if rank > 0 {
            all.extend((0..outputs).flat_map(|o| (0..rank).map(move |v| [o, first_change + v])));
            all.extend((0..rank).flat_map(|v| (0..rank).map(move |w| [first_change + v, first_change + w])));
            all.extend((0..rank).flat_map(|v| (0..inputs).map(move |i| [first_change + v, first_input + i])));
        }
        all
    }

    /// All of them by the numbers of [`Motions::entries`].
    pub(crate) fn all(&self) -> Vec<&[f64]> {
        self.outputs.iter().chain(&self.inputs).chain(&self.change).map(Vec::as_slice).collect()
    }
}
