//! A site as it is fitted: its scalar free on every line or bound to a law, the fixture's tolerances yielding within their priors.
//!
//! The other effects of the hypothesis keep their parameters.

use super::Site;
use super::laws::{Law, Line};
use super::pattern::{Course, Inversion, Pattern};
use super::recorded::Recorded;
use super::scalar::eliminated;
use super::sites::turns;
use crate::Hypothesis;
use crate::freedom::extent;
use jointscope_fixture::Fixture;
use jointscope_lumped::Model;
use num_complex::Complex64;

/// Abscissae move in units of this share of a body.
const ABSCISSA_SHARE: f64 = 0.1;

/// A site and the recording that it should explain.
#[derive(Clone, Copy)]
pub(super) struct Subject<'a> {
    pub recorded: &'a Recorded<'a>,
    /// Whether the abscissa of a body may move.
    pub moves: bool,
    /// The law that the component follows; without one the scalar is free on every line.
    pub law: Option<Law>,
}

/// A fixture and its model.
pub(super) struct Modelled {
    pub fixture: Fixture,
    model: Model,
}

/// Where the fixture and a site stand.
#[derive(Debug, Clone)]
pub(super) struct Stand {
    pub hypothesis: Hypothesis,
    pub site: Site,
    /// The law's parameters.
    pub parameters: Vec<f64>,
}

/// A stand with the site's scalar on every line and what is modelled with it.
#[derive(Debug, Clone)]
pub(super) struct State {
    pub stand: Stand,
    /// The scalar z, line after line.
    pub scalars: Vec<Complex64>,
    pub inversions: Vec<Inversion>,
    /// What is modelled, line after line, FRF after FRF, and its derivative with respect to z.
    pub modelled: Vec<Complex64>,
    pub slopes: Vec<Complex64>,
}

impl Subject<'_> {
    /// The fixture and its model at a hypothesis; `None` where it is impossible.
    pub fn model(&self, hypothesis: &Hypothesis) -> Option<Modelled> {
        let fixture = hypothesis.to_fixture().ok()?;
        let model = Model::new(&fixture, *self.recorded.observation.lines().hz().last()?).ok()?;
        Some(Modelled { fixture, model })
    }

    /// Calls `of` with every line's courses; `None` where the site does not exist there.
    pub fn on_lines(
        &self,
        Modelled { fixture, model }: &Modelled,
        site: &Site,
        mut of: impl FnMut(usize, &[Course], Inversion),
    ) -> Option<()> {
        let mut pattern = Pattern::new(fixture, model, site, self.recorded.observation.pairs())?;
        let mut courses = vec![Course::default(); self.recorded.frfs()];
        for (line, omega) in self.recorded.omegas.iter().enumerate() {
            let inversion = pattern.at(*omega, &mut courses)?;
            of(line, &courses, inversion);
        }
        Some(())
    }

    /// The scalar that the law means on a line.
    pub fn bound(&self, law: &Law, parameters: &[f64], line: usize, inversion: &Inversion) -> Complex64 {
        let line = Line { omega: self.recorded.omegas[line], driving: inversion.driving };
        inversion.scalar((law.value)(line, parameters))
    }

    /// The state where `stand` is, free scalars at their best for the given weights.
    pub fn state(&self, stand: &Stand, weights: &[f64]) -> Option<State> {
        self.state_on(&self.model(&stand.hypothesis)?, stand, weights)
    }

    /// As [`Subject::state`], with the stand's model given.
    pub fn state_on(&self, modelled: &Modelled, stand: &Stand, weights: &[f64]) -> Option<State> {
        let (lines, values) = (self.recorded.lines(), weights.len());
        let mut state = State {
            stand: stand.clone(),
            scalars: Vec::with_capacity(lines),
            inversions: Vec::with_capacity(lines),
            modelled: Vec::with_capacity(values),
            slopes: Vec::with_capacity(values),
        };
        self.on_lines(modelled, &stand.site, |line, courses, inversion| {
            let z = match &self.law {
                Some(law) => self.bound(law, &stand.parameters, line, &inversion),
                None => {
                    let places = self.recorded.places(line);
                    let neighbour = state.scalars.last().copied().unwrap_or_default();
                    eliminated(courses, &self.recorded.measured[places.clone()], &weights[places], neighbour)
                }
            };
            state.scalars.push(z);
            state.inversions.push(inversion);
            for course in courses {
                let (value, slope) = course.with_slope(z);
                state.modelled.push(value);
                state.slopes.push(slope);
            }
        })?;
        state.modelled.iter().chain(&state.slopes).all(|v| v.is_finite()).then_some(state)
    }

    /// What is minimised: χ² and the tolerances' priors.
    pub fn objective(&self, state: &State, weights: &[f64]) -> f64 {
        let terms = state.modelled.iter().zip(&self.recorded.measured).zip(weights);
        let chi2: f64 = terms.map(|((value, measured), weight)| weight * (measured - value).norm_sqr()).sum();
        chi2 + state.stand.penalty()
    }

    /// The unit in which the abscissa moves, where it does, and its bounds.
    pub fn abscissa(&self, stand: &Stand) -> Option<(f64, f64, f64)> {
        let Site::Body { body, .. } = &stand.site else { return None };
        if !self.moves {
            return None;
        }
        let fixture = stand.hypothesis.to_fixture().ok()?;
        let body = fixture.bodies().iter().position(|b| b.name == *body)?;
        if !turns(&fixture, body) {
            return None;
        }
        let (low, high) = extent(&fixture, body);
        Some((ABSCISSA_SHARE * (high - low).max(1e-6), low, high))
    }

    /// The stand moved by a step of tolerances, abscissa and parameters, as far as bounds let it.
    pub fn moved(&self, from: &Stand, step: &[f64]) -> Stand {
        let tolerances = from.hypothesis.tolerances().len().min(step.len());
        let (own, rest) = step.split_at(tolerances);
        let mut whole = own.to_vec();
        whole.resize(from.hypothesis.coordinates.len(), 0.0);
        let mut to = Stand { hypothesis: from.hypothesis.stepped(&whole), ..from.clone() };
        let mut rest = rest.iter();
        if let Some((unit, low, high)) = self.abscissa(from)
            && let (Site::Body { x, .. }, Some(step)) = (&mut to.site, rest.next())
        {
            *x = (*x + step * unit).clamp(low, high);
        }
        to.parameters.iter_mut().zip(rest).for_each(|(parameter, step)| *parameter += step);
        to
    }
}

impl Stand {
    /// A free scalar at `site`.
    pub fn free(hypothesis: &Hypothesis, site: &Site) -> Self {
        Stand { hypothesis: hypothesis.clone(), site: site.clone(), parameters: Vec::new() }
    }

    /// What the priors charge.
    pub fn penalty(&self) -> f64 {
        let tolerances = 0..self.hypothesis.tolerances().len();
        tolerances.map(|a| self.hypothesis.prior(a) * self.hypothesis.coordinates[a].powi(2)).sum()
    }
}
