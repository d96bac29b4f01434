//! Places along a body: where a search sets out, and when two places are one.

use crate::Hypothesis;
use crate::candidate::Candidate;
use jointscope_fixture::{Effect, Fixture, Motion, Place};

/// Index of the parameter that says where along its body an effect sits, if it has one.
pub(crate) fn abscissa(effect: &Effect) -> Option<usize> {
    let at =
        effect.kind.spec().parameters.iter().position(|parameter| parameter.motion == Motion::AlongBody)?;
    effect.has_parameter(at).then_some(at)
}

/// Where the last effect of a hypothesis sits along its body.
pub(crate) fn place_of_last(hypothesis: &Hypothesis) -> Option<f64> {
    let effect = hypothesis.effects().pop()?;
    Some(effect.value(abscissa(&effect)?))
}

/// Whether an effect sits on a body that bends.
pub(crate) fn is_on_beam(fixture: &Fixture, effect: &Effect) -> bool {
    let Place::Body(name) = &effect.place else { return false };
    let mut bodies = fixture.bodies().iter();
    bodies.any(|body| body.name == *name && body.kind.is_beam())
}

/// The abscissae of an effect's name.
#[derive(Debug, Clone)]
pub(crate) struct Abscissae {
    /// Index of the parameter.
    pub at: usize,
    /// Where a search of the name sets out, ascending.
    pub places: Vec<f64>,
    /// Least distance of two places: what comes to rest nearer than halfway to where the next search set out
    /// is at the same one.
    apart: f64,
}

impl Abscissae {
    /// Those of an effect that goes by the name `candidate`; `None` where it has none.
    pub(crate) fn of(candidate: &Candidate, effect: &Effect) -> Option<Self> {
        let at = abscissa(effect)?;
        let mut places: Vec<f64> = candidate.starts.iter().map(|start| start[at]).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        let apart = places.windows(2).map(|pair| 0.5 * (pair[1] - pair[0])).fold(f64::INFINITY, f64::min);
        Some(Abscissae { at, places, apart })
    }

    /// Whether two abscissae are two places.
    pub(crate) fn are_apart(&self, one: f64, other: f64) -> bool {
        (one - other).abs() >= self.apart
    }

    /// Of fits of one name, the most probable first, those at places of their own beside `taken`.
    pub(crate) fn each_once<T>(&self, taken: f64, fits: Vec<T>, place: impl Fn(&T) -> Option<f64>) -> Vec<T> {
        let mut taken = vec![taken];
        let is_new = |fit: &T| {
            let own = place(fit).filter(|own| taken.iter().all(|other| self.are_apart(*own, *other)));
            taken.extend(own);
            own.is_some()
        };
        fits.into_iter().filter(is_new).collect()
    }
}
