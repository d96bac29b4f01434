//! Which sensor's mass makes natural frequencies differ from response to response.
//!
//! Of each mode k the responses r show ln ω = c + s(m) with noise: s is what the mass m does to the model
//! there, c whatever the model is off by, the same in all of them and eliminated. What is left,
//! Σ (ln ω − c − s)²/(σ² + (ε·s)²), has a χ² distribution; ε is what the model's shapes make s uncertain by.

use super::by_response::{OfResponse, Seen, by_response, loads};
use super::unloaded::{Load, Share};
use crate::candidate::Candidate;
use crate::settings::moved_sensor::{
    EXPLAINED, FACTOR_ROUNDS, GAINED, MOST, OTHERWISE, REPEATS, SHAPES, STATED_LEFT, STEPS,
};
use crate::{Hypothesis, Observation};
use jointscope_fixture::{Effect, EffectKind};

/// What a sensor's mass makes of a recording's modes.
#[derive(Debug, Clone)]
pub(crate) struct MovedSensor {
    /// Where it sits, and its mass, and the structure without it.
    pub(crate) load: Load,
    /// Standard deviation of the mass, kg.
    pub(super) deviation: f64,
    pub(super) probability: f64,
    /// Other places of it, with their probability.
    pub(super) alternatives: Vec<(Effect, f64)>,
    /// What χ² of the natural frequencies loses for it.
    pub(super) gained: f64,
}

impl MovedSensor {
    /// Where it sits, and its mass.
    pub(crate) fn effect(&self) -> &Effect {
        &self.load.sensors[0]
    }
}

/// One mode in one response: what is seen, and what a hypothesis makes of it.
#[derive(Clone, Copy)]
struct Datum {
    seen: Seen,
    shift: f64,
}

impl Datum {
    fn weight(&self) -> f64 {
        (self.seen.deviation.powi(2) + REPEATS.powi(2) + (SHAPES * self.shift).powi(2)).recip()
    }
}

impl Datum {
    /// The share of the sensor's load by the model that it is, if the structure's own ln ω is so far from the
    /// model's, and its deviation. As far as the shape there may be off, the pole tells.
    fn share(&self, frequency: f64) -> [f64; 2] {
        let (noise, off) = (self.seen.deviation.powi(2) + REPEATS.powi(2), (SHAPES * self.shift).powi(2));
        let told = off / (off + noise);
        let share = 1.0 + told * (self.seen.difference - self.shift - frequency) / self.shift;
        let std = (told * noise).sqrt() / self.shift.abs();
        if share.is_finite() && std.is_finite() { [share, std] } else { [1.0, SHAPES] }
    }
}

/// Weighted means over the data of each mode.
fn means(data: &[Datum], modes: usize, value: impl Fn(&Datum) -> f64) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); modes];
    for datum in data {
        let (weight, sum) = &mut sums[datum.seen.mode];
        *weight += datum.weight();
        *sum += datum.weight() * value(datum);
    }
    sums.into_iter().map(|(weight, sum)| if weight > 0.0 { sum / weight } else { 0.0 }).collect()
}

/// Weighted sum over all data of the products of two values, each less the mean of its mode.
fn product(data: &[Datum], modes: usize, a: impl Fn(&Datum) -> f64, b: impl Fn(&Datum) -> f64) -> f64 {
    let (of_a, of_b) = (means(data, modes, &a), means(data, modes, &b));
    let of = |d: &Datum| d.weight() * (a(d) - of_a[d.seen.mode]) * (b(d) - of_b[d.seen.mode]);
    data.iter().map(of).sum()
}

impl Load {
    /// Of sensors of which the `responses` show these `data`, of modes with these natural frequencies.
    fn of(sensors: Vec<Effect>, responses: &Responses, data: &[Datum], omegas: &[f64]) -> Self {
        let frequency = means(data, omegas.len(), |d| d.seen.difference - d.shift);
        let damping = means(data, omegas.len(), |d| d.seen.damping);
        let mut data = data.iter();
        let of_response = |own: &OfResponse| {
            let shown = data.by_ref().take(own.seen().count());
            let of_mode = |d: &Datum| {
                let mode = d.seen.mode;
                Share::of(omegas[mode].ln() + frequency[mode], d.share(frequency[mode]), d.seen.ratio)
            };
            (own.response.clone(), shown.map(of_mode).collect())
        };
        let shares = responses.all.iter().map(of_response).collect();
        let off = omegas.iter().zip(frequency.iter().zip(&damping)).map(|(omega, (c, d))| [*omega, *c, *d]);
        Load { sensors, model: responses.model.clone(), off: off.collect(), shares }
    }
}

/// A hypothesis with the mass that suits it best.
struct Fitted {
    effect: Effect,
    data: Vec<Datum>,
    /// Information on the mass relative to itself.
    information: f64,
    chi2: f64,
    /// χ² without the mass, by the same weights.
    without: f64,
}

/// The responses of a recording beside a model.
struct Responses<'a> {
    model: &'a Hypothesis,
    all: &'a [OfResponse],
    modes: usize,
}

impl Responses<'_> {
    /// What sensors make of all modes; `None` where these cannot be followed.
    fn data(&self, sensors: &[Effect]) -> Option<Vec<Datum>> {
        let loaded = sensors.iter().fold(self.model.clone(), |model, sensor| model.with(sensor.clone()));
        let fixture = loaded.to_fixture().ok()?;
        let mut data = Vec::new();
        for own in self.all {
            let shifts = match sensors.iter().any(|sensor| loads(&sensor.place, &own.response)) {
                true => own.shifts(&fixture)?,
                false => vec![0.0; own.seen().count()],
            };
            data.extend(own.seen().zip(shifts).map(|(seen, shift)| Datum { seen, shift }));
        }
        Some(data)
    }

    /// The mass of a name that makes the differences between responses; `None` where none does.
    fn fitted(&self, name: &Candidate) -> Option<Fitted> {
        let sensor = |mass| Effect::new(EffectKind::SensorMass, name.place.clone(), None, &[mass]);
        let starts = || name.starts.iter().map(|start| start[0]);
        let mut mass = starts().reduce(f64::min)?;
        let most = MOST * starts().reduce(f64::max)?;
        let shift = |d: &Datum| d.shift;
        let difference = |d: &Datum| d.seen.difference;
        for _ in 0..STEPS {
            let data = self.data(&[sensor(mass)])?;
            let information = product(&data, self.modes, shift, shift);
            let times = product(&data, self.modes, shift, difference) / information;
            if !(times.is_finite() && times > 0.0 && times * mass < most) {
                return None;
            }
            mass *= times;
        }
        let data = self.data(&[sensor(mass)])?;
        let left = |d: &Datum| d.seen.difference - d.shift;
        Some(Fitted {
            effect: sensor(mass),
            information: product(&data, self.modes, shift, shift),
            chi2: product(&data, self.modes, left, left),
            without: product(&data, self.modes, difference, difference),
            data,
        })
    }

    /// χ² where each response differs from the others by one factor of all its frequencies, as temperature
    /// or a test on another day makes it.
    fn of_factors(&self, data: &[Datum]) -> f64 {
        let of_response: Vec<usize> =
            self.all.iter().enumerate().flat_map(|(r, own)| own.seen().map(move |_| r)).collect();
        let mut factors = vec![0.0; self.all.len()];
        let left = |factors: &[f64]| -> Vec<Datum> {
            let less = |(datum, r): (&Datum, &usize)| {
                let difference = datum.seen.difference - factors[*r];
                Datum { seen: Seen { difference, ..datum.seen }, ..*datum }
            };
            data.iter().zip(&of_response).map(less).collect()
        };
        let difference = |d: &Datum| d.seen.difference;
        for _ in 0..FACTOR_ROUNDS {
            let rest = left(&factors);
            let means = means(&rest, self.modes, difference);
            for (response, factor) in factors.iter_mut().enumerate() {
                let own = rest.iter().zip(&of_response).filter(|(_, r)| **r == response);
                let (sum, weight) = own.fold((0.0, 0.0), |(sum, weight), (d, _)| {
                    (sum + d.weight() * (difference(d) - means[d.seen.mode]), weight + d.weight())
                });
                *factor += if weight > 0.0 { sum / weight } else { 0.0 };
            }
        }
        product(&left(&factors), self.modes, difference, difference)
    }
}

impl MovedSensor {
    /// The sensor among these `names` that a recording's modes show; `model` is the structure without it.
    /// `None` where natural frequencies do not differ from response to response, or not as a sensor's mass
    /// makes them differ.
    pub(crate) fn of(observation: &Observation, model: &Hypothesis, names: &[Candidate]) -> Option<Self> {
        let (all, omegas) = by_response(observation, model)?;
        let responses = Responses { model, all: &all, modes: omegas.len() };
        let sensors = names.iter().filter(|name| name.kind == EffectKind::SensorMass);
        let mut fits: Vec<Fitted> = sensors.filter_map(|name| responses.fitted(name)).collect();
        fits.sort_by(|a, b| a.chi2.total_cmp(&b.chi2));
        let best = fits.first()?;
        let compared = best.data.len().saturating_sub(omegas.len() + 1);
        let inflation = (best.chi2 / compared.max(1) as f64).max(1.0);
        let gained = (best.without - best.chi2) / inflation;
        if gained < GAINED || best.chi2 > EXPLAINED * best.without && inflation > 1.0 {
            return None;
        }
        let weight = |chi2: f64| (0.5 * (best.chi2 - chi2) / inflation).exp();
        let factors = responses.of_factors(&best.data) + 2.0 * all.len().saturating_sub(2) as f64;
        let [unlisted, alike] = OTHERWISE;
        let sensors: f64 = fits.iter().map(|fit| weight(fit.chi2)).sum();
        let alike = alike * weight(factors);
        if alike > sensors {
            return None;
        }
        let named = |fit: &Fitted| (fit.effect.clone(), weight(fit.chi2) / (sensors + unlisted + alike));
        let (effect, probability) = named(best);
        Some(MovedSensor {
            deviation: effect.value(0) * (inflation / best.information).sqrt(),
            alternatives: fits[1..].iter().map(named).filter(|(_, p)| *p > unlisted).collect(),
            load: Load::of(vec![effect], &responses, &best.data, &omegas),
            gained,
            probability,
        })
    }
}

impl Load {
    /// Sensors that a fixture states, where natural frequencies differ from response to response as these make
    /// them differ; `model` is the structure without them.
    pub(crate) fn stated(observation: &Observation, model: &Hypothesis, sensors: &[Effect]) -> Option<Self> {
        let (all, omegas) = by_response(observation, model)?;
        let responses = Responses { model, all: &all, modes: omegas.len() };
        let data = responses.data(sensors)?;
        let chi2 = |of: &dyn Fn(&Datum) -> f64| product(&data, omegas.len(), of, of);
        let (without, left) = (chi2(&|d| d.seen.difference), chi2(&|d| d.seen.difference - d.shift));
        // It is known to be there; what else is left out may change the shapes by which it is judged.
        let is_seen = without - left >= GAINED && left <= STATED_LEFT * without;
        is_seen.then(|| Load::of(sensors.to_vec(), &responses, &data, &omegas))
    }
}
