//! One site fitted: the scalar eliminated line by line, the fixture's tolerances yielding within their priors.
//!
//! On every line the complex scalar z is eliminated by weighted least squares over the FRFs (variable projection); what is left depends on the
//! tolerances, and on the abscissa where it is free, and is minimised by Gauss–Newton with the projected derivatives. The other effects of the
//! hypothesis keep their parameters.

use super::Site;
use super::pattern::{Course, Inversion, Pattern};
use crate::hypothesis::extent;
use crate::{Hypothesis, Observation};
use jointscope_fixture::Fixture;
use jointscope_linalg::solve_positive_definite;
use jointscope_lumped::Model;
use num_complex::Complex64;

/// Step of central differences in units of a coordinate, as in the fit of effects.
const DIFFERENCE: f64 = 2e-4;
/// Shares by which weights are softened on the way, on thinned lines; iterations for each.
const COARSE: [f64; 3] = [0.3, 0.1, 0.03];
pub(super) const COARSE_LINES: usize = 100;
const COARSE_ITERATIONS: usize = 4;
/// The last softening, on all lines, and iterations there and without any.
const FINE: f64 = 0.01;
const ITERATIONS: (usize, usize) = (4, 15);
/// Share of the objective, and gain, below which a fit has converged.
const CONVERGED: (f64, f64) = (3e-4, 0.1);
/// Steps made from old derivatives that gain less than this share of the one before call for new ones.
const SLOW: f64 = 0.2;
/// Damping beyond which no step is a gain.
const GIVEN_UP: f64 = 1e4;
/// Newton steps for a scalar that does not enter linearly, and starts besides its neighbour's and zero.
const NEWTON: usize = 12;
const STARTS: [f64; 3] = [-0.3, 0.5, 2.0];
/// Abscissae move in units of this share of a body.
const ABSCISSA_SHARE: f64 = 0.1;

/// A site and what is known there: the recording, where the fit set out.
#[derive(Clone, Copy)]
pub(super) struct Subject<'a> {
    pub observation: &'a Observation,
    pub site: &'a Site,
    /// Whether the abscissa of a body may move.
    pub moves: bool,
}

/// A hypothesis with a site's scalar at its best on every line.
#[derive(Debug, Clone)]
pub(super) struct State {
    pub hypothesis: Hypothesis,
    pub site: Site,
    /// The scalar z, line after line.
    pub scalars: Vec<Complex64>,
    pub inversions: Vec<Inversion>,
    /// What is modelled, line after line, FRF after FRF, and its derivative with respect to z.
    pub modelled: Vec<Complex64>,
    pub slopes: Vec<Complex64>,
}

/// A site's state at the optimum and the directions in which it may still yield.
pub(super) struct Yielded {
    pub state: State,
    /// Information about the coordinates with all scalars free, row-major; of the order of `Yielded::order`.
    pub information: Vec<f64>,
    /// Minus half the objective's gradient: what convergence has left.
    pub pull: Vec<f64>,
    /// dz/dq at fixed data, line after line, coordinate after coordinate.
    pub sensitivities: Vec<Complex64>,
    /// Σ w |slope|² by line: the information about z.
    pub weights: Vec<f64>,
    pub order: usize,
}

/// Derivatives of the modelled values by coordinate at fixed δ: line after line, FRF after FRF, coordinate after coordinate.
struct Jacobian {
    order: usize,
    values: Vec<Complex64>,
}

impl<'a> Subject<'a> {
    fn frfs(&self) -> usize {
        self.observation.pairs().len()
    }

    fn lines(&self) -> usize {
        self.observation.lines().len()
    }

    /// Weights line after line, softened about modelled values where these are given.
    fn weights(&self, softening: Option<(f64, &[Complex64])>) -> Vec<f64> {
        let (n, frfs) = (self.lines(), self.frfs());
        let of = |place: usize| {
            let index = place % frfs * n + place / frfs;
            match softening {
                Some((epsilon, modelled)) => self.observation.softened(index, modelled[place], epsilon),
                None => self.observation.weights()[index],
            }
        };
        (0..n * frfs).map(of).collect()
    }

    fn measured(&self, place: usize) -> Complex64 {
        self.observation.values()[place % self.frfs() * self.lines() + place / self.frfs()]
    }

    /// Calls `of` with every line's courses; `None` where the model is impossible.
    fn on_lines(
        &self,
        fixture: &Fixture,
        model: &Model,
        site: &Site,
        mut of: impl FnMut(usize, &[Course], Inversion),
    ) -> Option<()> {
        let mut pattern = Pattern::new(fixture, model, site, self.observation.pairs())?;
        let mut courses = vec![Course::default(); self.frfs()];
        for line in 0..self.lines() {
            let inversion = pattern.at(self.observation.lines().omega(line), &mut courses)?;
            of(line, &courses, inversion);
        }
        Some(())
    }

    fn model(&self, hypothesis: &Hypothesis) -> Option<(Fixture, Model)> {
        let fixture = hypothesis.to_fixture().ok()?;
        let hz = self.observation.lines().hz();
        let model = Model::new(&fixture, hz[hz.len() - 1]).ok()?;
        Some((fixture, model))
    }

    /// The scalars eliminated with the given weights.
    pub fn state(&self, hypothesis: &Hypothesis, site: &Site, weights: &[f64]) -> Option<State> {
        let (fixture, model) = self.model(hypothesis)?;
        self.state_on(hypothesis, &fixture, &model, site, weights)
    }

    fn state_on(
        &self,
        hypothesis: &Hypothesis,
        fixture: &Fixture,
        model: &Model,
        site: &Site,
        weights: &[f64],
    ) -> Option<State> {
        let frfs = self.frfs();
        let mut state = State {
            hypothesis: hypothesis.clone(),
            site: site.clone(),
            scalars: Vec::with_capacity(self.lines()),
            inversions: Vec::with_capacity(self.lines()),
            modelled: Vec::with_capacity(self.lines() * frfs),
            slopes: Vec::with_capacity(self.lines() * frfs),
        };
        let mut measured = vec![Complex64::ZERO; frfs];
        self.on_lines(fixture, model, site, |line, courses, inversion| {
            let places = line * frfs..(line + 1) * frfs;
            measured.iter_mut().zip(places.clone()).for_each(|(m, place)| *m = self.measured(place));
            let neighbour = state.scalars.last().copied().unwrap_or_default();
            let z = eliminated(courses, &measured, &weights[places], neighbour);
            state.scalars.push(z);
            state.inversions.push(inversion);
            state.modelled.extend(courses.iter().map(|c| c.at(z)));
            state.slopes.extend(courses.iter().map(|c| c.slope(z)));
        })?;
        state.modelled.iter().chain(&state.slopes).all(|v| v.is_finite()).then_some(state)
    }

    /// What the fixture by itself predicts, line after line.
    fn unmoved(&self, hypothesis: &Hypothesis, site: &Site) -> Option<Vec<Complex64>> {
        let (fixture, model) = self.model(hypothesis)?;
        let mut values = Vec::with_capacity(self.lines() * self.frfs());
        self.on_lines(&fixture, &model, site, |_, courses, _| {
            values.extend(courses.iter().map(|c| c.start))
        })?;
        Some(values)
    }

    fn chi2(&self, state: &State, weights: &[f64]) -> f64 {
        let terms = state.modelled.iter().enumerate().zip(weights);
        terms.map(|((place, value), weight)| weight * (self.measured(place) - value).norm_sqr()).sum()
    }

    fn objective(&self, state: &State, weights: &[f64]) -> f64 {
        self.chi2(state, weights) + tolerance_penalty(&state.hypothesis)
    }

    /// The unit in which the abscissa moves, where it does.
    fn abscissa_unit(&self, fixture: &Fixture) -> Option<(f64, f64, f64)> {
        let Site::Body { body, .. } = self.site else { return None };
        let body = fixture.bodies().iter().position(|b| b.name == *body)?;
        if !self.moves || !super::sites::turns(fixture, body) {
            return None;
        }
        let (low, high) = extent(fixture, body);
        Some((ABSCISSA_SHARE * (high - low).max(1e-6), low, high))
    }

    /// Differences at fixed δ: the scalar follows δ as bᵀZ⁻¹b changes. Central ones where uncertainties are to be stated; forward ones, at
    /// half the price, show the way well enough.
    fn jacobian(&self, at: &State, central: bool) -> Option<Jacobian> {
        let (fixture, model) = self.model(&at.hypothesis)?;
        let abscissa = self.abscissa_unit(&fixture);
        let tolerances = at.hypothesis.tolerances().len();
        let order = tolerances + usize::from(abscissa.is_some());
        let frfs = self.frfs();
        let mut values = vec![Complex64::ZERO; self.lines() * frfs * order];
        let signs: &[f64] = if central { &[1.0, -1.0] } else { &[1.0] };
        let width = signs.len() as f64 * DIFFERENCE;
        for coordinate in 0..order {
            for sign in signs {
                let mut add = |line: usize, courses: &[Course], inversion: Inversion| {
                    let z = at.scalars[line];
                    let z = z / (1.0 + (inversion.feedback - at.inversions[line].feedback) * z);
                    for (k, course) in courses.iter().enumerate() {
                        let place = line * frfs + k;
                        let from = if central { Complex64::ZERO } else { at.modelled[place] };
                        values[place * order + coordinate] += (course.at(z) - from) * (sign / width);
                    }
                };
                if coordinate < tolerances {
                    let mut moved = at.hypothesis.clone();
                    moved.coordinates[coordinate] += sign * DIFFERENCE;
                    let (fixture, model) = self.model(&moved)?;
                    self.on_lines(&fixture, &model, &at.site, &mut add)?;
                } else if let (Some((unit, ..)), Site::Body { body, x }) = (abscissa, &at.site) {
                    let site = Site::Body { body: body.clone(), x: x + sign * DIFFERENCE * unit };
                    self.on_lines(&fixture, &model, &site, &mut add)?;
                }
            }
        }
        values.iter().all(|v| v.is_finite()).then_some(Jacobian { order, values })
    }

    /// The projected normal matrix with priors, and its right side.
    fn normal(
        &self,
        at: &State,
        slopes: &[Complex64],
        jacobian: &Jacobian,
        weights: &[f64],
    ) -> (Vec<f64>, Vec<f64>) {
        let (n, frfs) = (jacobian.order, self.frfs());
        let mut matrix = vec![0.0; n * n];
        let mut right = vec![0.0; n];
        let mut rows = vec![0.0; 2 * n];
        let mut along = vec![Complex64::ZERO; n];
        for line in 0..self.lines() {
            let mut size = 0.0;
            along.fill(Complex64::ZERO);
            let mut residual_along = Complex64::ZERO;
            for place in line * frfs..(line + 1) * frfs {
                let weight = weights[place];
                if weight == 0.0 {
                    continue;
                }
                let derivatives = &jacobian.values[place * n..(place + 1) * n];
                let residual = self.measured(place) - at.modelled[place];
                let slope = slopes[place];
                let weighted = slope.conj() * weight;
                size += weight * slope.norm_sqr();
                residual_along += weighted * residual;
                along.iter_mut().zip(derivatives).for_each(|(sum, d)| *sum += weighted * d);
                let (re, im) = rows.split_at_mut(n);
                for ((re, im), d) in re.iter_mut().zip(im.iter_mut()).zip(derivatives) {
                    (*re, *im) = (d.re * weight.sqrt(), d.im * weight.sqrt());
                }
                add_rows(&mut matrix, &mut right, &rows, residual * weight.sqrt(), 1.0);
            }
            if size > 0.0 {
                let (re, im) = rows.split_at_mut(n);
                for ((re, im), d) in re.iter_mut().zip(im.iter_mut()).zip(&along) {
                    (*re, *im) = (d.re / size.sqrt(), d.im / size.sqrt());
                }
                add_rows(&mut matrix, &mut right, &rows, residual_along / size.sqrt(), -1.0);
            }
        }
        for a in 0..at.hypothesis.tolerances().len() {
            let prior = at.hypothesis.prior(a);
            matrix[a * n + a] += prior;
            right[a] -= prior * at.hypothesis.coordinates[a];
        }
        for a in 0..n {
            for b in a + 1..n {
                matrix[a * n + b] = matrix[b * n + a];
            }
        }
        (matrix, right)
    }

    /// Fits from each of several hypotheses with softened weights on thinned lines, of each from the most promising of `sites`, and on from
    /// the best of their ends on all lines.
    pub fn reached(&self, starts: &[&Hypothesis], sites: &[Site], thinned: &Observation) -> Option<State> {
        let coarse = Subject { observation: thinned, ..*self };
        let ends = starts.iter().filter_map(|start| {
            let site = coarse.promising(start, sites)?;
            coarse.softly_fitted(start, site)
        });
        let (_, state) = ends.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let plain = self.weights(None);
        let near = self.state(&state.hypothesis, &state.site, &plain)?;
        let weights = self.weights(Some((FINE, &near.modelled)));
        let state = self.improved(near, &weights, ITERATIONS.0)?;
        self.improved(state, &plain, ITERATIONS.1)
    }

    /// Fits from a hypothesis near the goal.
    pub fn approached(&self, start: &Hypothesis) -> Option<State> {
        let weights = self.weights(None);
        let state = self.state(start, self.site, &weights)?;
        self.improved(state, &weights, ITERATIONS.1)
    }

    fn softly_fitted(&self, start: &Hypothesis, site: &Site) -> Option<(f64, State)> {
        let unmoved = self.unmoved(start, site)?;
        let mut weights = self.weights(Some((COARSE[0], &unmoved)));
        let mut state = self.state(start, site, &weights)?;
        for epsilon in COARSE {
            weights = self.weights(Some((epsilon, &state.modelled)));
            state = self.improved(state, &weights, COARSE_ITERATIONS)?;
        }
        Some((self.objective(&state, &weights), state))
    }

    fn improved(&self, start: State, weights: &[f64], iterations: usize) -> Option<State> {
        // The scalars are those of other weights.
        let mut state = self.state(&start.hypothesis, &start.site, weights)?;
        let mut damping = 1e-6;
        let mut before = self.objective(&state, weights);
        let mut jacobian = self.jacobian(&state, false)?;
        let (mut fresh, mut last) = (true, f64::INFINITY);
        for _ in 0..iterations {
            let (matrix, right) = self.normal(&state, &state.slopes, &jacobian, weights);
            let next = self.step(&state, &matrix, &right, weights, before, &mut damping);
            let gain = next.as_ref().map_or(0.0, |(_, after)| before - after);
            if let Some(next) = next {
                (state, before) = next;
            }
            let converged = gain < CONVERGED.1.max(CONVERGED.0 * before);
            if converged && fresh {
                break;
            }
            fresh = converged || gain < SLOW * last;
            last = if fresh { f64::INFINITY } else { gain };
            if fresh {
                jacobian = self.jacobian(&state, false)?;
            }
        }
        Some(state)
    }

    /// The first damped step that lowers the objective.
    fn step(
        &self,
        from: &State,
        matrix: &[f64],
        right: &[f64],
        weights: &[f64],
        before: f64,
        damping: &mut f64,
    ) -> Option<(State, f64)> {
        let n = right.len();
        while *damping < GIVEN_UP {
            let mut damped = matrix.to_vec();
            (0..n).for_each(|a| damped[a * n + a] *= 1.0 + *damping);
            let mut step = right.to_vec();
            if solve_positive_definite(&mut damped, &mut step) {
                let (hypothesis, site) = self.moved(from, &step)?;
                if let Some(next) = self.state(&hypothesis, &site, weights) {
                    let after = self.objective(&next, weights);
                    if after < before {
                        *damping = (*damping * 0.1).max(1e-9);
                        return Some((next, after));
                    }
                }
            }
            *damping *= 10.0;
        }
        *damping = 1e-3;
        None
    }

    fn moved(&self, from: &State, step: &[f64]) -> Option<(Hypothesis, Site)> {
        let mut hypothesis = from.hypothesis.clone();
        let tolerances = hypothesis.tolerances().len();
        hypothesis.coordinates.iter_mut().zip(step).take(tolerances).for_each(|(c, s)| *c += s);
        let mut site = from.site.clone();
        if let (Site::Body { x, .. }, Some(step)) = (&mut site, step.get(tolerances)) {
            let fixture = hypothesis.to_fixture().ok()?;
            let (unit, low, high) = self.abscissa_unit(&fixture)?;
            *x = (*x + step * unit).clamp(low, high);
        }
        Some((hypothesis, site))
    }

    /// The state with what is known of its scalars and how they hang on the tolerances; `exactly` where that will be told.
    pub fn finished(&self, state: State, exactly: bool) -> Option<Yielded> {
        let jacobian = self.jacobian(&state, exactly)?;
        let slopes = state.slopes.clone();
        Some(self.yielded(state, &slopes, &jacobian))
    }

    /// As [`Subject::finished`], everything made linear about given scalars instead of the state's own noisy ones.
    pub fn finished_about(&self, mut state: State, scalars: Vec<Complex64>) -> Option<Yielded> {
        let (fixture, model) = self.model(&state.hypothesis)?;
        let mut held = State { scalars, modelled: Vec::new(), slopes: Vec::new(), ..state.clone() };
        let mut values = Vec::with_capacity(state.modelled.len());
        self.on_lines(&fixture, &model, &state.site, |line, courses, _| {
            let z = held.scalars[line];
            values.extend(courses.iter().map(|c| (c.at(z), c.slope(z))));
        })?;
        (held.modelled, held.slopes) = values.into_iter().unzip();
        let jacobian = self.jacobian(&held, true)?;
        let (frfs, weights) = (self.frfs(), self.weights(None));
        for line in 0..self.lines() {
            let places = line * frfs..(line + 1) * frfs;
            let size: f64 = places.clone().map(|p| weights[p] * held.slopes[p].norm_sqr()).sum();
            let residual =
                |p: usize| held.slopes[p].conj() * (self.measured(p) - held.modelled[p]) * weights[p];
            let along: Complex64 = places.clone().map(residual).sum();
            let step = if size > 0.0 { along / size } else { Complex64::ZERO };
            state.scalars[line] = held.scalars[line] + step;
            places.for_each(|p| state.modelled[p] = held.modelled[p] + held.slopes[p] * step);
        }
        Some(self.yielded(state, &held.slopes, &jacobian))
    }

    fn yielded(&self, state: State, slopes: &[Complex64], jacobian: &Jacobian) -> Yielded {
        let weights = &self.weights(None);
        let (information, pull) = self.normal(&state, slopes, jacobian, weights);
        let (order, frfs) = (jacobian.order, self.frfs());
        let mut sizes = Vec::with_capacity(self.lines());
        let mut sensitivities = vec![Complex64::ZERO; self.lines() * order];
        for line in 0..self.lines() {
            let places = line * frfs..(line + 1) * frfs;
            let size: f64 = places.clone().map(|p| weights[p] * slopes[p].norm_sqr()).sum();
            sizes.push(size);
            if size > 0.0 {
                let row = &mut sensitivities[line * order..(line + 1) * order];
                for place in places {
                    let along = slopes[place].conj() * (weights[place] / size);
                    let derivatives = &jacobian.values[place * order..(place + 1) * order];
                    row.iter_mut().zip(derivatives).for_each(|(sum, d)| *sum -= along * d);
                }
            }
        }
        Yielded { state, information, pull, sensitivities, weights: sizes, order }
    }

    /// Of several sites the one that leaves least with weights softened about what the fixture alone predicts, nothing yielding.
    fn promising<'b>(&self, start: &Hypothesis, sites: &'b [Site]) -> Option<&'b Site> {
        if let [only] = sites {
            return Some(only);
        }
        let weights = self.weights(Some((COARSE[0], &self.unmoved(start, self.site)?)));
        let left = |site: &'b Site| Some((self.chi2(&self.state(start, site, &weights)?, &weights), site));
        sites.iter().filter_map(left).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, site)| site)
    }

    /// The state at other tolerances (and another abscissa), by departures in units of the coordinates.
    pub fn departed(&self, from: &State, departures: &[f64]) -> Option<State> {
        let (hypothesis, site) = self.moved(from, departures)?;
        self.state(&hypothesis, &site, &self.weights(None))
    }

    /// What is minimised, at a state.
    pub fn plain_objective(&self, state: &State) -> f64 {
        self.objective(state, &self.weights(None))
    }
}

/// Adds sign·(rowᵀ row) of the real and the imaginary row to the lower triangle, and sign·rowᵀ residual to the right side.
fn add_rows(matrix: &mut [f64], right: &mut [f64], rows: &[f64], residual: Complex64, sign: f64) {
    let n = right.len();
    let (re, im) = rows.split_at(n);
    for a in 0..n {
        let (x, y) = (sign * re[a], sign * im[a]);
        right[a] += x * residual.re + y * residual.im;
        let row = &mut matrix[a * n..a * n + a + 1];
        for ((element, re), im) in row.iter_mut().zip(re).zip(im) {
            *element += x * re + y * im;
        }
    }
}

fn tolerance_penalty(hypothesis: &Hypothesis) -> f64 {
    (0..hypothesis.tolerances().len()).map(|a| hypothesis.prior(a) * hypothesis.coordinates[a].powi(2)).sum()
}

/// The scalar that fits the line's FRFs best; zero where the pattern vanishes.
fn eliminated(
    courses: &[Course],
    measured: &[Complex64],
    weights: &[f64],
    neighbour: Complex64,
) -> Complex64 {
    if courses.iter().all(Course::is_linear) {
        return newton(courses, measured, weights, Complex64::ZERO, 1).0;
    }
    let mut best = newton(courses, measured, weights, Complex64::ZERO, NEWTON);
    let others = [neighbour].into_iter().chain(STARTS.map(|re| Complex64::new(re, 0.0)));
    for start in others.filter(|start| *start != Complex64::ZERO) {
        let other = newton(courses, measured, weights, start, NEWTON);
        if other.1 < best.1 {
            best = other;
        }
    }
    best.0
}

/// Gauss–Newton steps for the scalar, halved where they lose; with what is left of the weighted squares.
fn newton(
    courses: &[Course],
    measured: &[Complex64],
    weights: &[f64],
    start: Complex64,
    steps: usize,
) -> (Complex64, f64) {
    let left = |z: Complex64| -> f64 {
        let terms = courses.iter().zip(measured).zip(weights);
        terms.map(|((c, m), w)| w * (m - c.at(z)).norm_sqr()).sum()
    };
    let mut z = start;
    let mut lowest = left(z);
    for _ in 0..steps {
        let (mut size, mut along) = (0.0, Complex64::ZERO);
        for ((course, measured), weight) in courses.iter().zip(measured).zip(weights) {
            let slope = course.slope(z);
            size += weight * slope.norm_sqr();
            along += slope.conj() * *weight * (measured - course.at(z));
        }
        if size.is_nan() || size <= 0.0 {
            break;
        }
        let mut step = along / size;
        let mut better = None;
        for _ in 0..6 {
            let value = left(z + step);
            if value < lowest {
                better = Some(value);
                break;
            }
            step *= 0.5;
        }
        let Some(value) = better else { break };
        z += step;
        let gain = lowest - value;
        lowest = value;
        if gain < 1e-9 * lowest {
            break;
        }
    }
    (z, lowest)
}
