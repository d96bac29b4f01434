//! One kind of effect at one place: a name that a diagnosis can give.

use crate::settings::effects::bounds::{LEAST_FACTOR, MOST_FACTOR};
use jointscope_fixture::{Dof, Effect, EffectKind, Motion, ParameterRange, Place, SizeLaw};

/// One kind of effect at one place (and dof): a name that a diagnosis can give, with starts for its
/// parameters.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// The kind.
    pub kind: EffectKind,
    /// The place.
    pub place: Place,
    /// The degree of freedom, for kinds that have one.
    pub dof: Option<Dof>,
    /// Parameters to start from: sizes, signs, abscissae, frequencies.
    pub starts: Vec<Vec<f64>>,
    /// Parameters of effects so small that what they do is proportional to their size, one for each abscissa,
    /// frequency or time.
    pub directions: Vec<Vec<f64>>,
}

impl Candidate {
    /// The effect at start `index`.
    pub fn effect(&self, index: usize) -> Effect {
        Effect::new(self.kind, self.place.clone(), self.dof, &self.starts[index])
    }

    /// The effect that is `times` as large as direction `index`; `None` where there is none of that sign.
    ///
    /// Large means what it does to the FRFs to first order: a mass, a deviation, a compliance.
    pub(crate) fn scaled(&self, index: usize, times: f64) -> Option<Effect> {
        let effect = Effect::new(self.kind, self.place.clone(), self.dof, &self.directions[index]);
        scaled(&effect, times)
    }

    /// Whether `effect` goes by this name.
    pub fn names(&self, effect: &Effect) -> bool {
        self.kind == effect.kind && self.place == effect.place && self.dof == effect.dof
    }
}

/// The effect made `times` as large in what it does to the FRFs to first order; `None` where none of its kind
/// has that sign.
pub(crate) fn scaled(effect: &Effect, times: f64) -> Option<Effect> {
    let spec = effect.kind.spec();
    let (size, leading) = (spec.size, &spec.parameters[spec.size.parameter]);
    let either_sign = size.law == SizeLaw::FromOne || matches!(leading.motion, Motion::Signed(_));
    if !either_sign && times <= 0.0 {
        return None;
    }
    let before = effect.value(size.parameter);
    let mut after = size.law.scaled(before, times);
    if leading.range == ParameterRange::Positive && either_sign {
        after = after.clamp(LEAST_FACTOR, MOST_FACTOR);
    }
    let mut other = effect.clone();
    other.parameters[size.parameter].value = after;
    if let Some(dashpot) = size.dashpot {
        other.parameters[dashpot].value *= after / before;
    }
    Some(other)
}

/// The candidate with these starts, and with a direction for each of their shapes.
pub(crate) fn candidate(
    kind: EffectKind,
    place: Place,
    dof: Option<Dof>,
    starts: Vec<Vec<f64>>,
) -> Candidate {
    // Of starts that differ in size alone the first serves as direction, made small.
    let mut directions: Vec<Vec<f64>> = Vec::new();
    for start in &starts {
        let small = made_small(kind, start, &starts);
        if !directions.iter().any(|d| d == &small) {
            directions.push(small);
        }
    }
    Candidate { kind, place, dof, starts, directions }
}

/// The start's shape (abscissa, frequency, time) with a size that depends on its kind alone, too small to
/// bend anything.
fn made_small(kind: EffectKind, start: &[f64], all: &[Vec<f64>]) -> Vec<f64> {
    let size = kind.spec().size;
    let largest = all.iter().map(|start| start[size.parameter]).fold(0.0, f64::max);
    let mut small = start.to_vec();
    small[size.parameter] = match size.law {
        SizeLaw::Value | SizeLaw::FromStated => size.tiny,
        SizeLaw::FromOne => 1.0 + size.tiny,
        SizeLaw::Inverse | SizeLaw::InverseSquare => size.tiny * largest,
    };
    if let Some(dashpot) = size.dashpot {
        small[dashpot] = 0.0;
    }
    small
}
