//! What a recording cannot tell apart, and what it cannot show, before anything is diagnosed.

use crate::sensitivity::{Direction, Sensitivity, WHOLE};
use crate::strength::{self, strength, with_strength};
use crate::{Name, VISIBLE};
use jointscope_diagnosis::{Observation, catalogue};
use jointscope_fixture::{Effect, Fixture};
use jointscope_spectra::FrfSet;
use serde::Serialize;
use std::fmt;

/// Angle below which two names are listed as alike, degrees.
const ALIKE: f64 = 25.0;
/// Times that the strength of a weak effect is found again at itself: each halves its error.
const AGAIN: usize = 8;
/// Turns below which what one name does beyond the tolerances is rounding: there is nothing to compare.
const ROUNDING: f64 = 1e-9;

/// A name at a place, and the smallest effect that shows there.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SmallestShown {
    /// The name.
    pub name: Name,
    /// The parameter.
    pub parameter: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The parameter of an effect that costs a fit without it Δχ² = [`VISIBLE`], at the best abscissa or
    /// frequency tried; infinite where nothing shows.
    pub shows: f64,
    /// The same were every quantity of the fixture known exactly.
    pub shows_if_exact: f64,
    /// Whether effects of a larger parameter are weaker.
    #[serde(rename = "upper")]
    pub is_upper: bool,
    /// Share of what the effect does that quantities within their tolerances can do as well.
    pub imitated: f64,
}

/// Two names that do nearly the same.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Alike {
    /// The names.
    pub names: [Name; 2],
    /// Angle between what they do to the FRFs, in units of the noise, degrees: 0 is the same.
    pub angle: f64,
    /// The same after the quantities of the fixture have yielded within their tolerances.
    pub angle_beyond_tolerances: f64,
    /// Δχ² that the first must cost before a fit of the second is worse by [`VISIBLE`].
    pub told_apart_from: f64,
}

/// The limits of one fixture and one test.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Limits {
    /// Every name, in the order of the catalogue.
    pub smallest: Vec<SmallestShown>,
    /// Pairs that lie within 25° of each other beyond the tolerances, the closest first.
    pub alike: Vec<Alike>,
}

struct Signature {
    name: Name,
    effects: Vec<Effect>,
    directions: Vec<Direction>,
}

impl Limits {
    /// The limits of a recording with coherence against the fixture that describes it, by what small effects
    /// would do.
    ///
    /// `None` where the recording has no coherence, or the fixture predicts no finite FRFs.
    pub fn of(fixture: &Fixture, recorded: &FrfSet) -> Option<Self> {
        let observation = Observation::new(recorded, |_| true).ok()?;
        // Noise from scatter takes a peak for noise, and would hide what peaks show.
        (0..recorded.pairs().len()).all(|index| recorded.coherence(index).is_some()).then_some(())?;
        let weights = observation.weights().iter().copied();
        let sensitivity = Sensitivity::of(fixture, fixture, observation.frfs(), weights)?;
        let mut signatures = Vec::new();
        for candidate in catalogue(fixture, &observation) {
            let effects = candidate.directions.iter().map(|parameters| {
                Effect::new(candidate.kind, candidate.place.clone(), candidate.dof, parameters)
            });
            let both: Vec<(Effect, Direction)> = effects
                .filter_map(|effect| sensitivity.direction(&effect).map(|direction| (effect, direction)))
                .collect();
            let (effects, directions): (Vec<_>, Vec<_>) = both.into_iter().unzip();
            if let Some(name) = effects.first().map(Name::of) {
                signatures.push(Signature { name, effects, directions });
            }
        }
        let smallest = signatures.iter().map(|signature| signature.smallest(&sensitivity)).collect();
        let mut alike = Vec::new();
        for (index, first) in signatures.iter().enumerate() {
            alike.extend(signatures[..index].iter().filter_map(|second| first.beside(second)));
        }
        alike.sort_by(|a, b| a.angle_beyond_tolerances.total_cmp(&b.angle_beyond_tolerances));
        Some(Limits { smallest, alike })
    }
}

impl Signature {
    fn smallest(&self, sensitivity: &Sensitivity<'_>) -> SmallestShown {
        let largest = |information: &dyn Fn(&Direction) -> f64| {
            self.directions.iter().map(information).fold(0.0, f64::max)
        };
        let (whole, left) = (largest(&|d| d.whole(d)), largest(&|d| d.beyond_tolerances(d)));
        let shown =
            |information: &dyn Fn(&Direction) -> f64| match self.strength(sensitivity, information, whole) {
                Some(strength) => strength::stated(self.name.kind, strength),
                None if strength::is_inverse(self.name.kind) => 0.0,
                None => f64::INFINITY,
            };
        let (parameter, unit) = strength::parameter(self.name.kind, self.name.dof);
        SmallestShown {
            name: self.name.clone(),
            parameter,
            unit,
            shows: shown(&|d| d.beyond_tolerances(d)),
            shows_if_exact: shown(&|d| d.whole(d)),
            is_upper: strength::is_inverse(self.name.kind),
            imitated: if whole > 0.0 { (1.0 - left / whole).clamp(0.0, 1.0) } else { 1.0 },
        }
    }

    /// The strength that costs a fit without the effect [`VISIBLE`], `information` being Δχ² by its square;
    /// `None` where nothing shows.
    ///
    /// By first order; where that is of a stronger effect than this, again at the strength itself: a damped
    /// resonance far above the band delays, which falls with its frequency and not with the square.
    fn strength(
        &self,
        sensitivity: &Sensitivity<'_>,
        information: &dyn Fn(&Direction) -> f64,
        whole: f64,
    ) -> Option<f64> {
        let all = self.effects.iter().zip(&self.directions).map(|(effect, d)| (effect, information(d)));
        let (effect, most) = all.max_by(|(_, a), (_, b)| a.total_cmp(b))?;
        if most <= ROUNDING * whole {
            return None;
        }
        let mut shown = (VISIBLE / most).sqrt();
        for _ in 0..AGAIN {
            if whole * shown * shown >= WHOLE {
                break;
            }
            let as_strong = with_strength(effect, shown * strength(effect).signum());
            let at = sensitivity.direction_as_it_is(&as_strong).map(|direction| information(&direction));
            let Some(at) = at.filter(|at| *at > 0.0) else { break };
            shown = (VISIBLE / at).sqrt();
        }
        Some(shown)
    }

    /// The closest of both names' directions; `None` where they are told apart easily.
    fn beside(&self, other: &Signature) -> Option<Alike> {
        let mut closest: Option<(f64, f64)> = None;
        for a in &self.directions {
            for b in &other.directions {
                let product = |f: &dyn Fn(&Direction, &Direction) -> f64| {
                    let (aa, bb) = (f(a, a), f(b, b));
                    // The sign does not count: an effect of the other sign is one of the same name, or none.
                    (aa > 0.0 && bb > 0.0).then(|| (f(a, b).abs() / (aa * bb).sqrt()).min(1.0))
                };
                let shows = |d: &Direction| d.beyond_tolerances(d) > ROUNDING * d.whole(d);
                if !(shows(a) && shows(b)) {
                    continue;
                }
                let (Some(whole), Some(left)) =
                    (product(&Direction::whole), product(&Direction::beyond_tolerances))
                else {
                    continue;
                };
                if closest.is_none_or(|(_, most)| left > most) {
                    closest = Some((whole, left));
                }
            }
        }
        let (whole, left) = closest?;
        let angle = left.acos().to_degrees();
        (angle < ALIKE).then(|| Alike {
            names: [other.name.clone(), self.name.clone()],
            angle: whole.acos().to_degrees(),
            angle_beyond_tolerances: angle,
            told_apart_from: VISIBLE / (1.0 - left * left).max(1e-15),
        })
    }
}

impl fmt::Display for Limits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "smallest effect that shows (Δχ² = {VISIBLE}), were every quantity exact, share imitated within tolerances:"
        )?;
        for SmallestShown { name, parameter, unit, shows, shows_if_exact, is_upper, imitated } in
            &self.smallest
        {
            let (name, relation) = (name.to_string(), if *is_upper { "≤" } else { "≥" });
            let exact = format!("({shows_if_exact:.2e}) {imitated:.4}");
            writeln!(f, "  {name:<44} {parameter} {relation} {shows:.2e} {unit} {exact}")?;
        }
        writeln!(
            f,
            "\nnames that do nearly the same: angle, angle beyond tolerances in degrees, Δχ² from which they are told apart:"
        )?;
        for Alike { names: [a, b], angle, angle_beyond_tolerances, told_apart_from } in &self.alike {
            writeln!(f, "  {a} | {b}: {angle:.2} {angle_beyond_tolerances:.2} {told_apart_from:.1e}")?;
        }
        Ok(())
    }
}
