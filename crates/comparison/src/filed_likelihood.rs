//! What FRFs tell of a joint's numbers and of the fixture's quantities, as `stiffness.json` has it.

use jointscope_inference::QuadraticLikelihood;
use serde::{Deserialize, Serialize};

/// The likelihood of the joint's numbers and of the quantities, Gaussian about a point, without the
/// quantities' priors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FiledLikelihood {
    /// The numbers, `k11` … or, of several joints, `J/k11` …; the quantities come after them.
    pub elements: Vec<String>,
    /// Where it is taken.
    pub at: Vec<f64>,
    /// Gradient of ln L there.
    pub gradient: Vec<f64>,
    /// Minus the second derivatives of ln L: the lower triangle by rows.
    pub information: Vec<Vec<f64>>,
}

/// Names of the six numbers.
pub(crate) const ELEMENTS: [&str; 6] = ["k11", "k12", "k22", "c11", "c12", "c22"];

impl FiledLikelihood {
    /// Of these numbers and of quantities after them.
    pub(crate) fn of(elements: Vec<String>, likelihood: &QuadraticLikelihood) -> Self {
        let n = likelihood.order();
        let information = (0..n).map(|i| likelihood.information[i * n..=i * n + i].to_vec()).collect();
        FiledLikelihood {
            elements,
            at: likelihood.at.clone(),
            gradient: likelihood.gradient.clone(),
            information,
        }
    }

    /// With its information as a whole matrix; nothing where it is not of `n` parameters.
    pub(crate) fn whole(&self, n: usize) -> Option<QuadraticLikelihood> {
        let triangular = self.information.iter().enumerate().all(|(i, row)| row.len() == i + 1);
        if !triangular || [self.at.len(), self.gradient.len(), self.information.len()] != [n; 3] {
            return None;
        }
        let rows = &self.information;
        let entry = |e: usize| rows[(e / n).max(e % n)][(e / n).min(e % n)];
        Some(QuadraticLikelihood {
            at: self.at.clone(),
            gradient: self.gradient.clone(),
            information: (0..n * n).map(entry).collect(),
        })
    }

    /// Of the numbers of one joint, by their places among the six, and after them of so many quantities;
    /// nothing where it does not fit them.
    pub(crate) fn of_six(&self, quantities: usize) -> Option<(Vec<usize>, QuadraticLikelihood)> {
        let place = |name: &String| ELEMENTS.iter().position(|element| element == name);
        let slots: Vec<usize> = self.elements.iter().map(place).collect::<Option<_>>()?;
        let is_repeated = (1..slots.len()).any(|i| slots[..i].contains(&slots[i]));
        if slots.is_empty() || is_repeated {
            return None;
        }
        let likelihood = self.whole(slots.len() + quantities)?;
        Some((slots, likelihood))
    }
}
