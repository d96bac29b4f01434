//! What a test of the structure would record: predictions of names on the lines and with the noise of a
//! measurement to come.

use crate::expected_noise::ExpectedNoise;
use crate::model_error::ModelErrorNoise;
use crate::products::{Predicted, Products};
use crate::settings::noise::MOST_VALUES;
use jointscope_diagnosis::{Hypothesis, Linearisation, Observation};
use jointscope_fixture::Fixture;
use jointscope_inference::each;
use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};

/// The structure as it is to be tested.
pub(crate) struct PlannedTest {
    /// The fixture, with the deviations of all points that are considered.
    pub fixture: Fixture,
    /// Whether bare numbers are exact.
    pub exact: bool,
    /// The lines of a measurement to come.
    pub lines: SpectralLines,
    /// Its noise.
    pub noise: ExpectedNoise,
    /// Variance inflation: what the residuals of the present measurement show beyond their noise, those to
    /// come will show too.
    pub inflation: f64,
    /// What an error of the model adds, where names were weighed with one.
    pub model_error: Option<ModelErrorNoise>,
}

impl PlannedTest {
    /// What each name predicts of FRFs, and their products by FRF; `None` where one of them predicts none.
    pub(crate) fn products(&self, names: &[Hypothesis], pairs: &[FrfPair]) -> Option<Vec<Products>> {
        // Of a longer set lines would be left out.
        let together = (MOST_VALUES / self.lines.len()).max(1);
        let few: Vec<&[FrfPair]> = pairs.chunks(together).collect();
        let parts = each(&few, |pairs| self.products_of_few(names, pairs));
        let parts: Vec<Vec<Products>> = parts.into_iter().collect::<Option<_>>()?;
        Some(parts.concat())
    }

    fn products_of_few(&self, names: &[Hypothesis], pairs: &[FrfPair]) -> Option<Vec<Products>> {
        let blank = vec![Default::default(); pairs.len() * self.lines.len()];
        let frfs = FrfSet::new(self.lines.clone(), FrfForm::Accelerance, pairs.to_vec(), blank).ok()?;
        let count = self.lines.len();
        let frfs = frfs.with_variance(vec![1.0; pairs.len() * count]).ok()?;
        let observation = Observation::new(&frfs, |_| true).ok()?;
        let predicted = predicted(names, &observation)?;
        let more = match &self.model_error {
            Some(model_error) => {
                let (first, values) = (names.first()?, &predicted.first()?.values);
                model_error.variance(first, pairs, observation.lines(), values)?
            }
            None => vec![0.0; pairs.len() * count],
        };
        let per_pair = observation.lines().len();
        let products = (0..pairs.len()).map(|index| {
            let range = index * per_pair..(index + 1) * per_pair;
            let square = |at: usize| {
                predicted.iter().map(|name| name.values[at].norm_sqr()).sum::<f64>() / predicted.len() as f64
            };
            let squares: Vec<f64> = range.clone().map(square).collect();
            let weight = |(variance, more): (f64, &f64)| match variance > 0.0 {
                true => 2.0 / (variance * self.inflation + more),
                false => 0.0,
            };
            let variance = self.noise.variance(&squares).into_iter();
            let weights: Vec<f64> = variance.zip(&more[range.clone()]).map(weight).collect();
            Products::of(&predicted, range, &weights)
        });
        Some(products.collect())
    }

    /// The products of a measurement that was made.
    pub(crate) fn products_of(&self, names: &[Hypothesis], observation: &Observation) -> Option<Products> {
        let predicted = predicted(names, observation)?;
        let weights: Vec<f64> = observation.weights().iter().map(|w| w / self.inflation).collect();
        Some(Products::of(&predicted, 0..weights.len(), &weights))
    }
}

fn predicted(names: &[Hypothesis], observation: &Observation) -> Option<Vec<Predicted>> {
    let of = |name: &Hypothesis| {
        let values = name.predict(observation).ok()?;
        Some(Predicted { values, derivatives: Linearisation::of(name, observation).derivatives })
    };
    names.iter().map(of).collect()
}
