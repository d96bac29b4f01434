use crate::Observation;
use crate::freedom::{Freedom, freedoms};
use jointscope_fixture::{Effect, Fixture, FixtureError};
use jointscope_linalg::solve_positive_definite;
use jointscope_lumped::{Instrument, LumpedError, accelerances};
use jointscope_spectra::FrfPair;
use num_complex::Complex64;
use std::sync::Arc;

/// Why a hypothesis predicts nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PredictionError {
    /// Its quantities or parameters are impossible.
    #[error(transparent)]
    Fixture(#[from] FixtureError),
    /// Its model has no finite FRFs.
    #[error(transparent)]
    Model(#[from] LumpedError),
}

/// A quantity of the fixture that a fit may move.
#[derive(Debug, Clone, PartialEq)]
pub struct Tolerance {
    /// Position among the fixture's quantities.
    index: usize,
    /// Path in the file.
    pub path: String,
    /// The stated value.
    pub nominal: f64,
    /// One standard deviation of the prior; `None` where it is free.
    pub std: Option<f64>,
    /// The unit of a step.
    scale: f64,
    /// Whether it moves by its logarithm.
    relative: bool,
    /// Lowest coordinate: what must not be negative stops at zero.
    lowest: f64,
}

/// Relative deviation up to which a size moves by its logarithm.
const NARROW: f64 = 0.12;

impl Tolerance {
    fn new(index: usize, path: &str, nominal: f64, std: Option<f64>) -> Self {
        let scale = std.unwrap_or(if nominal != 0.0 { 0.1 * nominal.abs() } else { 1.0 });
        // Masses and stiffnesses trade against factors of each other: by their logarithms such a trade is a straight line.
        let place = ["x", "x_cg", "from", "to"].iter().any(|name| path.rsplit('/').next() == Some(name));
        let relative = !place && !path.contains("damping") && nominal > 0.0 && scale <= NARROW * nominal;
        let lowest = match !relative && nominal > 0.0 && path.contains("damping") {
            true => -nominal / scale,
            false => f64::NEG_INFINITY,
        };
        Tolerance { index, path: path.to_owned(), nominal, std, scale, relative, lowest }
    }

    /// The value at `coordinate` deviations from the nominal one.
    pub fn value(&self, coordinate: f64) -> f64 {
        match self.relative {
            true => self.nominal * (coordinate * self.scale / self.nominal).exp(),
            false => self.nominal + coordinate * self.scale,
        }
    }

    /// Whether it is known to no better than a tenth, damping apart.
    pub(crate) fn is_wide(&self) -> bool {
        let deviation = self.std.map_or(0.5, |std| std / self.nominal.abs().max(f64::MIN_POSITIVE));
        deviation >= 0.1
            && !self.path.contains("damping")
            && self.nominal != 0.0
            && !self.path.ends_with("/x")
    }
}

/// The fixture with quantities and effects to be fitted: coordinates in units of which one is a typical step.
#[derive(Debug, Clone)]
pub struct Hypothesis {
    // Thousands of neighbours share what none of them changes.
    fixture: Arc<Fixture>,
    tolerances: Arc<[Tolerance]>,
    effects: Arc<Vec<(Effect, Vec<Freedom>)>>,
    /// Coordinates that stay where they are.
    held: Vec<usize>,
    /// Coordinates: tolerances in deviations from the nominal values, then the effects' free parameters.
    pub(crate) coordinates: Vec<f64>,
}

impl Hypothesis {
    /// The fixture by itself, its own effects kept as they stand. `exact` takes bare numbers as exact.
    ///
    /// Young's modulus and second moment of one beam enter as a product alone: one of them carries the deviation of both.
    pub fn nominal(fixture: &Fixture, exact: bool) -> Self {
        let quantities = if exact { fixture.quantities_exact() } else { fixture.quantities() };
        let mut tolerances: Vec<Tolerance> = Vec::new();
        for (index, quantity) in quantities.iter().enumerate() {
            let std = match quantity.std {
                Some(std) if std <= 0.0 => continue,
                std => std,
            };
            let relative = |std: f64, value: f64| std / value.abs();
            if let Some(beam) = quantity.path.strip_suffix("second_moment") {
                let modulus = format!("{beam}youngs_modulus");
                if let Some(earlier) = tolerances.iter_mut().find(|t| t.path == modulus) {
                    let both = earlier.std.zip(std).map(|(a, b)| {
                        earlier.nominal * relative(a, earlier.nominal).hypot(relative(b, quantity.value))
                    });
                    *earlier = Tolerance::new(earlier.index, &modulus, earlier.nominal, both);
                    continue;
                }
            }
            tolerances.push(Tolerance::new(index, &quantity.path, quantity.value, std));
        }
        let coordinates = vec![0.0; tolerances.len()];
        Hypothesis {
            fixture: Arc::new(fixture.clone()),
            tolerances: tolerances.into(),
            effects: Arc::new(Vec::new()),
            held: Vec::new(),
            coordinates,
        }
    }

    /// The same with quantity `index` moved by `deviations`.
    pub(crate) fn moved(&self, index: usize, deviations: f64) -> Self {
        let mut other = self.clone();
        other.coordinates[index] += deviations;
        other
    }

    /// The same with one more effect, at the parameters it is given with.
    pub fn with(&self, effect: Effect) -> Self {
        let mut more = self.clone();
        let freedoms = freedoms(&self.fixture, &effect);
        for (freedom, quantity) in freedoms.iter().zip(&effect.parameters) {
            more.coordinates.extend(freedom.coordinate(quantity.value));
        }
        Arc::make_mut(&mut more.effects).push((effect, freedoms));
        more
    }

    /// The same without effect `index`.
    pub fn without(&self, index: usize) -> Self {
        let mut fewer = self.clone();
        let range = self.range_of(index);
        fewer.coordinates.drain(range);
        Arc::make_mut(&mut fewer.effects).remove(index);
        fewer
    }

    /// The same with the quantities of the fixture back at (or at those of) `other`; effects stay.
    pub fn with_tolerances_of(&self, other: &Hypothesis) -> Self {
        let mut moved = self.clone();
        let count = self.tolerances.len();
        moved.coordinates[..count].copy_from_slice(&other.coordinates[..count]);
        moved
    }

    /// The same with `effect` in the fixture itself, where nothing moves it; `None` where the fixture cannot have it.
    pub(crate) fn beside(&self, effect: Effect) -> Option<Self> {
        let mut physics = self.fixture.physics().to_vec();
        physics.push(effect);
        let fixture = Fixture::clone(&self.fixture).with_physics(physics).ok()?;
        Some(Hypothesis { fixture: Arc::new(fixture), ..self.clone() })
    }

    /// The same where `other`, of the same quantities and effects, stands.
    pub(crate) fn with_coordinates_of(&self, other: &Hypothesis) -> Self {
        Hypothesis { coordinates: other.coordinates.clone(), ..self.clone() }
    }

    /// The same with these coordinates (and no others) held where they are.
    pub(crate) fn holding(mut self, held: &[usize]) -> Self {
        self.held = held.to_vec();
        self
    }

    /// Whether a fit leaves coordinate `index` where it is.
    pub(crate) fn is_held(&self, index: usize) -> bool {
        self.held.contains(&index)
    }

    /// Number of effects.
    pub fn effect_count(&self) -> usize {
        self.effects.len()
    }

    /// Number of the effects' free parameters.
    pub fn effect_parameters(&self) -> usize {
        self.coordinates.len() - self.tolerances.len()
    }

    /// The quantities that may move.
    pub fn tolerances(&self) -> &[Tolerance] {
        &self.tolerances
    }

    /// Where tolerance `index` stands, in standard deviations (or tenths of its value where it is free): for masses and stiffnesses those of
    /// the logarithm.
    pub fn departure(&self, index: usize) -> f64 {
        self.coordinates[index]
    }

    /// Precision of the prior on coordinate `index`: 1 for a quantity with a deviation, 0 for what is free.
    pub(crate) fn prior(&self, index: usize) -> f64 {
        f64::from(self.tolerances.get(index).is_some_and(|t| t.std.is_some()))
    }

    /// Σ (departure/std)².
    pub fn penalty(&self) -> f64 {
        (0..self.tolerances.len()).map(|i| self.prior(i) * self.coordinates[i].powi(2)).sum()
    }

    /// Coordinates of effect `index` within the whole.
    pub(crate) fn range_of(&self, index: usize) -> std::ops::Range<usize> {
        let free = |e: &(Effect, Vec<Freedom>)| e.1.iter().filter(|f| **f != Freedom::Fixed).count();
        let start = self.tolerances.len() + self.effects[..index].iter().map(free).sum::<usize>();
        start..start + free(&self.effects[index])
    }

    /// The effects at their present parameters.
    pub fn effects(&self) -> Vec<Effect> {
        let mut at = self.tolerances.len();
        self.effects
            .iter()
            .map(|(effect, freedoms)| {
                let mut effect = effect.clone();
                for (freedom, quantity) in freedoms.iter().zip(&mut effect.parameters) {
                    if let Some(value) = freedom.value(self.coordinates.get(at).copied().unwrap_or(0.0)) {
                        quantity.value = value;
                        at += 1;
                    }
                }
                effect
            })
            .collect()
    }

    /// Derivative of each free parameter of effect `index` with respect to its coordinate, with the parameter's place in
    /// the effect.
    pub(crate) fn parameter_slopes(&self, index: usize) -> Vec<(usize, f64)> {
        let (_, freedoms) = &self.effects[index];
        let effect = &self.effects()[index];
        let slope = |(place, freedom): (usize, &Freedom)| match freedom {
            Freedom::Logarithm { .. } => Some((place, effect.value(place))),
            Freedom::Linear { scale, .. } => Some((place, *scale)),
            Freedom::Fixed => None,
        };
        freedoms.iter().enumerate().filter_map(slope).collect()
    }

    /// The fixture at the present quantities, its own effects and the fitted ones in its `physics`.
    ///
    /// # Errors
    /// Quantities or parameters that are impossible.
    pub fn to_fixture(&self) -> Result<Fixture, FixtureError> {
        let mut fixture = Fixture::clone(&self.fixture);
        let moved = self.tolerances.iter().zip(&self.coordinates);
        fixture.set_quantities(
            moved.map(|(tolerance, coordinate)| (tolerance.index, tolerance.value(*coordinate))),
        );
        let mut physics = self.fixture.physics().to_vec();
        physics.extend(self.effects());
        fixture.with_physics(physics)
    }

    /// The accelerances this hypothesis predicts for an observation, as its instruments would record them.
    ///
    /// # Errors
    /// Impossible quantities, or a model without finite FRFs.
    pub fn predict(&self, observation: &Observation) -> Result<Vec<Complex64>, PredictionError> {
        let fixture = self.to_fixture()?;
        Ok(accelerances(&fixture, observation.pairs(), observation.lines(), Instrument::AsRecorded)?)
    }

    /// What is predicted with coordinate `index` moved by `step`. FRFs that do not depend on it are not predicted again: they are
    /// those of `predicted`, or zero without.
    pub(crate) fn predict_moved(
        &self,
        index: usize,
        step: f64,
        predicted: Option<&[Complex64]>,
        observation: &Observation,
    ) -> Result<Vec<Complex64>, PredictionError> {
        let moved = self.moved(index, step);
        let Some(frfs) = self.depending(index, observation) else { return moved.predict(observation) };
        let count = observation.lines().len();
        let mut all =
            predicted.map_or_else(|| vec![Complex64::ZERO; observation.values().len()], <[_]>::to_vec);
        let pairs: Vec<FrfPair> = frfs.iter().map(|&i| observation.pairs()[i].clone()).collect();
        if !pairs.is_empty() {
            let fixture = moved.to_fixture()?;
            let some = accelerances(&fixture, &pairs, observation.lines(), Instrument::AsRecorded)?;
            for (values, &i) in some.chunks_exact(count).zip(&frfs) {
                all[i * count..(i + 1) * count].copy_from_slice(values);
            }
        }
        Ok(all)
    }

    /// The FRFs that coordinate `index` acts on, where that is told by its name: where a channel's point sits, if nothing but channels
    /// is there, matters to that channel's FRFs alone.
    fn depending(&self, index: usize, observation: &Observation) -> Option<Vec<usize>> {
        let path = &self.tolerances.get(index)?.path;
        let name = path.strip_prefix("points/")?.strip_suffix("/x")?;
        let place = self.fixture.points().iter().position(|point| point.name == name)?;
        let holds = self.fixture.joints().iter().any(|joint| joint.from == place || joint.to == place);
        if holds || !self.fixture.supports().is_empty() {
            return None;
        }
        let pairs = observation.pairs().iter().enumerate();
        let reads = |pair: &FrfPair| pair.response.point == name || pair.reference.point == name;
        Some(pairs.filter(|(_, pair)| reads(pair)).map(|(i, _)| i).collect())
    }

    /// Bounds of each coordinate.
    fn bounds(&self) -> Vec<(f64, f64)> {
        let mut all: Vec<(f64, f64)> = self.tolerances.iter().map(|t| (t.lowest, f64::INFINITY)).collect();
        for freedom in self.effects.iter().flat_map(|(_, freedoms)| freedoms) {
            match freedom {
                Freedom::Fixed => {}
                Freedom::Linear { scale, low, high } => all.push((low / scale, high / scale)),
                Freedom::Logarithm { low, high } => all.push((*low, *high)),
            }
        }
        all
    }

    /// Solves `matrix`·step = `right` (row-major, whole) within the bounds: a coordinate whose step would cross its bound
    /// stops there, and the others are solved for again.
    pub(crate) fn bounded_step(&self, matrix: &[f64], right: &[f64]) -> Option<Vec<f64>> {
        let n = right.len();
        let bounds = self.bounds();
        let mut stopped: Vec<Option<f64>> = vec![None; n];
        for _ in 0..4 {
            let free: Vec<usize> = (0..n).filter(|&m| stopped[m].is_none()).collect();
            let mut reduced = Vec::with_capacity(free.len() * free.len());
            let mut rest = Vec::with_capacity(free.len());
            for &i in &free {
                reduced.extend(free.iter().map(|&j| matrix[i * n + j]));
                let known: f64 = (0..n).filter_map(|j| stopped[j].map(|s| matrix[i * n + j] * s)).sum();
                rest.push(right[i] - known);
            }
            if !free.is_empty() && !solve_positive_definite(&mut reduced, &mut rest) {
                return None;
            }
            let mut crossed = false;
            for (&m, step) in free.iter().zip(&rest) {
                let target = self.coordinates[m] + step;
                let (low, high) = bounds[m];
                if target < low || target > high {
                    stopped[m] = Some(target.clamp(low, high) - self.coordinates[m]);
                    crossed = true;
                }
            }
            if !crossed {
                let mut step: Vec<f64> = stopped.iter().map(|s| s.unwrap_or(0.0)).collect();
                free.iter().zip(&rest).for_each(|(&m, value)| step[m] = *value);
                return Some(step);
            }
        }
        None
    }

    /// A step of size `size` of coordinate `index` that stays within its bounds.
    pub(crate) fn inward(&self, index: usize, size: f64) -> f64 {
        match self.bounds().get(index) {
            Some((_, high)) if self.coordinates[index] + size > *high => -size,
            _ => size,
        }
    }

    /// Moves by `step`, bounded parameters stopping at their bounds.
    pub(crate) fn stepped(&self, step: &[f64]) -> Self {
        let mut next = self.clone();
        for ((coordinate, step), (low, high)) in next.coordinates.iter_mut().zip(step).zip(self.bounds()) {
            *coordinate = (*coordinate + step).clamp(low, high);
        }
        next
    }
}
