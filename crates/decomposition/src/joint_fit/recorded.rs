//! The FRFs that a joint is fitted to: every one whose channels the fixture has, as accelerances with
//! weights.

use crate::settings::noise::{EXPLAINED, UNKNOWN_NOISE};
use jointscope_averaging::Band;
use jointscope_fixture::Fixture;
use jointscope_inference::{Parameter, autocorrelation, inflated_weight, variance_inflation};
use jointscope_lumped::{Instrument, MeasuringChain, window_decay};
use jointscope_spectra::{Channel, FrfForm, FrfPair, FrfSet};
use num_complex::Complex64;

/// Values and weights, FRF after FRF.
#[derive(Debug, Clone)]
pub(super) struct Recorded {
    /// The FRFs in use on the lines in use, accelerances.
    pub frfs: FrfSet,
    pub pairs: Vec<FrfPair>,
    /// s = δ + iω of the lines in use.
    pub s: Vec<Complex64>,
    /// Highest line of the recording, Hz.
    pub highest: f64,
    pub values: Vec<Complex64>,
    /// 2/σ²; zero where a value says nothing.
    pub weights: Vec<f64>,
    /// (response, reference) of each FRF among the distinct channels, and one FRF that each channel is taken
    /// from.
    pub channels: Vec<(usize, usize)>,
    pub responses: Vec<usize>,
    pub references: Vec<usize>,
}

impl Recorded {
    /// `None` where nothing can be used.
    pub(super) fn of(frfs: &FrfSet, fixture: &Fixture, band: Option<Band>) -> Option<Self> {
        let decay = window_decay(fixture);
        let readable = |pair: &FrfPair| {
            let chain = MeasuringChain::of(fixture, std::slice::from_ref(pair), Instrument::AsRecorded);
            chain.is_ok_and(|chain| chain.readings.iter().all(|reading| reading.load.is_none()))
        };
        let used: Vec<usize> = (0..frfs.pairs().len()).filter(|&i| readable(&frfs.pairs()[i])).collect();
        let hz = frfs.lines().hz();
        let inside = |hz: f64| hz > 0.0 && band.is_none_or(|band| band.contains(hz));
        let lines: Vec<usize> = (0..hz.len()).filter(|&line| inside(hz[line])).collect();
        let on_lines = frfs.on_lines(|line| inside(hz[line]))?.of_frfs(|index| used.contains(&index))?;
        let mut recorded = Recorded {
            frfs: on_lines.to_form(FrfForm::Accelerance).ok()?,
            pairs: used.iter().map(|&index| frfs.pairs()[index].clone()).collect(),
            s: lines.iter().map(|&line| Complex64::new(decay, frfs.lines().omega(line))).collect(),
            highest: hz[hz.len() - 1],
            values: Vec::with_capacity(used.len() * lines.len()),
            weights: Vec::with_capacity(used.len() * lines.len()),
            channels: Vec::new(),
            responses: Vec::new(),
            references: Vec::new(),
        };
        for &index in &used {
            let (values, variance) = (frfs.values(index), frfs.variance(index));
            for &line in &lines {
                let factor = frfs.form().factor_to(FrfForm::Accelerance, frfs.lines().omega(line))?;
                let value = values[line] * factor;
                let variance = match variance {
                    Some(variance) => variance[line] * factor.norm_sqr(),
                    None => UNKNOWN_NOISE * UNKNOWN_NOISE * value.norm_sqr(),
                };
                recorded.values.push(value);
                let told = frfs.is_measured(index, line) && variance > 0.0;
                recorded.weights.push(if told { 2.0 / variance } else { 0.0 });
            }
        }
        recorded.list_channels();
        recorded.weights.iter().any(|weight| *weight > 0.0).then_some(recorded)
    }

    fn list_channels(&mut self) {
        let place = |seen: &mut Vec<usize>, pairs: &[FrfPair], index: usize, of: fn(&FrfPair) -> &Channel| {
            seen.iter().position(|&other| of(&pairs[other]) == of(&pairs[index])).unwrap_or_else(|| {
                seen.push(index);
                seen.len() - 1
            })
        };
        for index in 0..self.pairs.len() {
            let response = place(&mut self.responses, &self.pairs, index, |pair| &pair.response);
            let reference = place(&mut self.references, &self.pairs, index, |pair| &pair.reference);
            self.channels.push((response, reference));
        }
    }

    /// Circular frequency in the middle of the lines, rad/s.
    pub(super) fn middle(&self) -> f64 {
        self.s.iter().map(|s| s.im).sum::<f64>() / self.s.len() as f64
    }

    /// What is left of the values.
    pub(super) fn residual(&self, predicted: &[Complex64]) -> Vec<Complex64> {
        self.values.iter().zip(predicted).map(|(m, p)| m - p).collect()
    }

    /// χ² with these weights, and what is known of the coordinates beforehand.
    pub(super) fn objective(
        &self,
        predicted: &[Complex64],
        weights: &[f64],
        (parameters, coordinates): (&[Parameter], &[f64]),
    ) -> f64 {
        let terms = self.values.iter().zip(predicted).zip(weights);
        let chi2: f64 = terms.map(|((m, p), weight)| weight * (m - p).norm_sqr()).sum();
        let departures =
            parameters.iter().zip(coordinates).map(|(parameter, at)| parameter.squared_departure(*at));
        chi2 + departures.sum::<f64>()
    }

    /// Σ w|a|² of a change of the values.
    pub(super) fn size(&self, change: &[Complex64]) -> f64 {
        change.iter().zip(&self.weights).map(|(value, weight)| weight * value.norm_sqr()).sum()
    }

    /// Weights with this share of the signal counted as noise besides.
    pub(super) fn weights_with(&self, share: f64) -> Vec<f64> {
        let values = self.values.iter().zip(&self.weights);
        values.map(|(value, weight)| inflated_weight(*weight, value.norm_sqr(), share)).collect()
    }

    /// An objective over what is left of the values by parameters, the first `own` of which are not the
    /// fixture's.
    pub(super) fn per_degree(&self, objective: f64, own: usize, parameters: &[Parameter]) -> f64 {
        // Priors count one degree for each quantity that has one.
        let quantities = parameters.iter().skip(own);
        let free = own + quantities.filter(|parameter| parameter.precision == 0.0).count();
        objective / self.degrees().saturating_sub(free).max(1) as f64
    }

    /// What the noise is multiplied by so that it explains what is left, correlated from line to line as that
    /// is.
    pub(super) fn inflation(&self, per_degree: f64, predicted: &[Complex64]) -> f64 {
        if per_degree <= EXPLAINED {
            return 1.0;
        }
        let residual = self.residual(predicted).into_iter().zip(&self.weights);
        let normalised: Vec<Complex64> = residual.map(|(r, weight)| r * weight.sqrt()).collect();
        variance_inflation(per_degree, autocorrelation(&normalised, self.s.len()))
    }

    /// Number of real values that count.
    pub(super) fn degrees(&self) -> usize {
        2 * self.weights.iter().filter(|weight| **weight > 0.0).count()
    }
}
