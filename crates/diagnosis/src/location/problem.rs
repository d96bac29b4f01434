//! A site as it is fitted: its scalar free on every line or bound to a law, the fixture's tolerances yielding
//! within their priors.
//!
//! The other effects of the hypothesis keep their parameters.

use super::Site;
use super::laws::{Law, Line};
use super::pattern::{Inversion, Pattern, RationalResponse};
use super::recorded::Recorded;
use super::scalar::eliminated;
use crate::Hypothesis;
use crate::bodies::{extent, turns};
use crate::settings::Settings;
use crate::settings::effects::bounds::ABSCISSA_UNIT;
use jointscope_fixture::Fixture;
use jointscope_lumped::Model;
use num_complex::Complex64;

/// A site and the recording that it should explain.
#[derive(Clone, Copy)]
pub(super) struct Problem<'a> {
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

/// What a fit of a site moves.
#[derive(Debug, Clone)]
pub(super) struct Parameters {
    pub hypothesis: Hypothesis,
    pub site: Site,
    /// The law's parameters.
    pub of_law: Vec<f64>,
}

/// Parameters with the site's scalar on every line and what is modelled with it.
#[derive(Debug, Clone)]
pub(super) struct Iterate {
    pub parameters: Parameters,
    /// The scalar z, line after line.
    pub scalars: Vec<Complex64>,
    pub inversions: Vec<Inversion>,
    /// What is modelled, line after line, FRF after FRF, and its derivative with respect to z.
    pub modelled: Vec<Complex64>,
    pub slopes: Vec<Complex64>,
}

impl Problem<'_> {
    /// The settings of the search.
    pub(super) fn settings(&self) -> &Settings {
        self.recorded.settings
    }

    /// The fixture and its model at a hypothesis; `None` where it is impossible.
    pub(super) fn model(&self, hypothesis: &Hypothesis) -> Option<Modelled> {
        let fixture = hypothesis.to_fixture().ok()?;
        let model = Model::new(&fixture, *self.recorded.observation.lines().hz().last()?).ok()?;
        Some(Modelled { fixture, model })
    }

    /// Calls `of` with every line's responses; `None` where the site does not exist there.
    pub(super) fn on_lines(
        &self,
        Modelled { fixture, model }: &Modelled,
        site: &Site,
        mut of: impl FnMut(usize, &[RationalResponse], Inversion),
    ) -> Option<()> {
        let mut pattern = Pattern::new(fixture, model, site, self.recorded.observation.pairs())?;
        let mut responses = vec![RationalResponse::default(); self.recorded.frfs()];
        for (line, omega) in self.recorded.omegas.iter().enumerate() {
            let inversion = pattern.at(*omega, &mut responses)?;
            of(line, &responses, inversion);
        }
        Some(())
    }

    /// The scalar that the law means on a line.
    pub(super) fn bound(
        &self,
        law: &Law,
        parameters: &[f64],
        line: usize,
        inversion: &Inversion,
    ) -> Complex64 {
        let line = Line { omega: self.recorded.omegas[line], driving: inversion.driving };
        inversion.scalar((law.value)(line, parameters))
    }

    /// The iterate at `parameters`, free scalars at their best for the given weights.
    pub(super) fn state(&self, parameters: &Parameters, weights: &[f64]) -> Option<Iterate> {
        self.state_on(&self.model(&parameters.hypothesis)?, parameters, weights)
    }

    /// As [`Problem::state`], with their model given.
    pub(super) fn state_on(
        &self,
        modelled: &Modelled,
        parameters: &Parameters,
        weights: &[f64],
    ) -> Option<Iterate> {
        let (lines, values) = (self.recorded.lines(), weights.len());
        let mut state = Iterate {
            parameters: parameters.clone(),
            scalars: Vec::with_capacity(lines),
            inversions: Vec::with_capacity(lines),
            modelled: Vec::with_capacity(values),
            slopes: Vec::with_capacity(values),
        };
        self.on_lines(modelled, &parameters.site, |line, responses, inversion| {
            let z = match &self.law {
                Some(law) => self.bound(law, &parameters.of_law, line, &inversion),
                None => {
                    let places = self.recorded.places(line);
                    let neighbour = state.scalars.last().copied().unwrap_or_default();
                    eliminated(
                        responses,
                        &self.recorded.measured[places.clone()],
                        &weights[places],
                        neighbour,
                    )
                }
            };
            state.scalars.push(z);
            state.inversions.push(inversion);
            for response in responses {
                let (value, slope) = response.with_slope(z);
                state.modelled.push(value);
                state.slopes.push(slope);
            }
        })?;
        state.modelled.iter().chain(&state.slopes).all(|v| v.is_finite()).then_some(state)
    }

    /// What is minimised: χ² and the tolerances' priors.
    pub(super) fn objective(&self, state: &Iterate, weights: &[f64]) -> f64 {
        let terms = state.modelled.iter().zip(&self.recorded.measured).zip(weights);
        let chi2: f64 = terms.map(|((value, measured), weight)| weight * (measured - value).norm_sqr()).sum();
        chi2 + state.parameters.squared_departures()
    }

    /// The unit in which the abscissa moves, where it does, and its bounds.
    pub(super) fn abscissa(&self, parameters: &Parameters) -> Option<(f64, f64, f64)> {
        let Site::Body { body, .. } = &parameters.site else { return None };
        if !self.moves {
            return None;
        }
        let fixture = parameters.hypothesis.to_fixture().ok()?;
        let body = fixture.bodies().iter().position(|b| b.name == *body)?;
        if !turns(&fixture, body) {
            return None;
        }
        let (low, high) = extent(&fixture, body);
        Some((ABSCISSA_UNIT * (high - low).max(1e-6), low, high))
    }

    /// The parameters moved by a step of tolerances, abscissa and parameters, as far as bounds let it.
    pub(super) fn moved(&self, from: &Parameters, step: &[f64]) -> Parameters {
        let tolerances = from.hypothesis.tolerances().len().min(step.len());
        let (own, rest) = step.split_at(tolerances);
        let mut whole = own.to_vec();
        whole.resize(from.hypothesis.coordinates.len(), 0.0);
        let mut to = Parameters { hypothesis: from.hypothesis.stepped(&whole), ..from.clone() };
        let mut rest = rest.iter();
        if let Some((unit, low, high)) = self.abscissa(from)
            && let (Site::Body { x, .. }, Some(step)) = (&mut to.site, rest.next())
        {
            *x = (*x + step * unit).clamp(low, high);
        }
        to.of_law.iter_mut().zip(rest).for_each(|(parameter, step)| *parameter += step);
        to
    }
}

impl Parameters {
    /// A free scalar at `site`.
    pub(super) fn free(hypothesis: &Hypothesis, site: &Site) -> Self {
        Parameters { hypothesis: hypothesis.clone(), site: site.clone(), of_law: Vec::new() }
    }

    /// What the priors charge.
    pub(super) fn squared_departures(&self) -> f64 {
        let tolerances = 0..self.hypothesis.tolerances().len();
        tolerances.map(|a| self.hypothesis.prior(a) * self.hypothesis.coordinates[a].powi(2)).sum()
    }
}
