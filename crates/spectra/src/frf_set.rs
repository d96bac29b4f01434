//! FRFs of one test on common lines: channels, pairs of them, values FRF after FRF, variances.

use crate::{FrfForm, SpectraError, SpectralLines};
use num_complex::Complex64;
use serde::{Deserialize, Serialize, Serializer};
use std::fmt;

/// A degree of freedom of the planar motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Dof {
    /// Transverse displacement y, or a transverse force.
    Translation,
    /// Rotation θ from x to y, or a moment.
    Rotation,
}

impl Dof {
    /// The word used in fixture files: `translation` or `rotation`.
    pub fn name(self) -> &'static str {
        match self {
            Dof::Translation => "translation",
            Dof::Rotation => "rotation",
        }
    }
}

/// A measuring channel: a named point and a degree of freedom there.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Channel {
    /// The point's name in the fixture.
    pub point: String,
    /// What moves or acts there.
    pub dof: Dof,
}

impl Channel {
    /// A transverse channel (an accelerometer, a hammer hit).
    pub fn transverse(point: impl Into<String>) -> Self {
        Channel { point: point.into(), dof: Dof::Translation }
    }

    /// A rotational channel (a rotation sensor, a moment).
    pub fn rotational(point: impl Into<String>) -> Self {
        Channel { point: point.into(), dof: Dof::Rotation }
    }

    /// Whether the channel shows as `name`: the point's name, or `point:theta`.
    pub fn is_named(&self, name: &str) -> bool {
        match self.dof {
            Dof::Translation => self.point == name,
            Dof::Rotation => name.strip_suffix(":theta") == Some(self.point.as_str()),
        }
    }
}

impl fmt::Display for Channel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.dof {
            Dof::Translation => write!(f, "{}", self.point),
            Dof::Rotation => write!(f, "{}:theta", self.point),
        }
    }
}

impl Serialize for Channel {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Response and reference of an FRF; shown as `4/1`.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FrfPair {
    /// Where the motion is measured.
    pub response: Channel,
    /// Where the force acts.
    pub reference: Channel,
}

impl FrfPair {
    /// An FRF from `reference` to `response`.
    pub fn new(response: Channel, reference: Channel) -> Self {
        FrfPair { response, reference }
    }

    /// The FRF between two transverse channels, as in `4/1`.
    pub fn transverse(response: &str, reference: &str) -> Self {
        FrfPair::new(Channel::transverse(response), Channel::transverse(reference))
    }

    /// Whether the FRF shows as `name`, as `4/1` does.
    pub fn is_named(&self, name: &str) -> bool {
        // A point's name may hold a stroke itself.
        name.match_indices('/')
            .any(|(at, _)| self.response.is_named(&name[..at]) && self.reference.is_named(&name[at + 1..]))
    }
}

impl fmt::Display for FrfPair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.response, self.reference)
    }
}

impl Serialize for FrfPair {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// FRFs of one test on common spectral lines: all lines of the first FRF, then of the second, …,
/// in one contiguous block, all in one form.
#[derive(Debug, Clone, PartialEq)]
pub struct FrfSet {
    lines: SpectralLines,
    form: FrfForm,
    pairs: Vec<FrfPair>,
    values: Vec<Complex64>,
    variance: Option<Vec<f64>>,
    coherence: Vec<Option<Vec<f64>>>,
    averages: Vec<Option<u32>>,
}

impl FrfSet {
    /// A set from its values, FRF after FRF.
    ///
    /// # Errors
    /// A wrong number of values, a value that is not finite, an FRF given twice.
    pub fn new(
        lines: SpectralLines,
        form: FrfForm,
        pairs: Vec<FrfPair>,
        values: Vec<Complex64>,
    ) -> Result<Self, SpectraError> {
        if values.len() != pairs.len() * lines.len() {
            return Err(SpectraError::Size { frfs: pairs.len(), lines: lines.len(), found: values.len() });
        }
        if let Some(index) = values.iter().position(|v| !v.is_finite()) {
            return Err(SpectraError::NotFinite {
                frf: pairs[index / lines.len()].to_string(),
                frequency: lines.hz()[index % lines.len()],
            });
        }
        if let Some(i) = (1..pairs.len()).find(|&i| pairs[..i].contains(&pairs[i])) {
            return Err(SpectraError::Twice(pairs[i].to_string()));
        }
        let count = pairs.len();
        Ok(FrfSet {
            lines,
            form,
            pairs,
            values,
            variance: None,
            coherence: vec![None; count],
            averages: vec![None; count],
        })
    }

    /// The spectral lines.
    pub fn lines(&self) -> &SpectralLines {
        &self.lines
    }

    /// Receptance, mobility or accelerance.
    pub fn form(&self) -> FrfForm {
        self.form
    }

    /// The FRFs' responses and references, in the order of the values.
    pub fn pairs(&self) -> &[FrfPair] {
        &self.pairs
    }

    /// Index of an FRF.
    pub fn index_of(&self, pair: &FrfPair) -> Option<usize> {
        self.pairs.iter().position(|p| p == pair)
    }

    /// The values of FRF `index` on all lines.
    pub fn values(&self, index: usize) -> &[Complex64] {
        &self.values[index * self.lines.len()..(index + 1) * self.lines.len()]
    }

    /// All values, FRF after FRF.
    pub fn all_values(&self) -> &[Complex64] {
        &self.values
    }

    /// Variance E|ε|² of the complex values of FRF `index`, in the square of the set's unit; half of
    /// it belongs to the real part, half to the imaginary part.
    pub fn variance(&self, index: usize) -> Option<&[f64]> {
        let n = self.lines.len();
        self.variance.as_deref().map(|v| &v[index * n..(index + 1) * n])
    }

    /// Attaches variances E|ε|², FRF after FRF.
    ///
    /// # Errors
    /// A wrong number of them, a negative or non-finite one.
    pub fn with_variance(mut self, variance: Vec<f64>) -> Result<Self, SpectraError> {
        if variance.len() != self.values.len() {
            return Err(SpectraError::Size {
                frfs: self.pairs.len(),
                lines: self.lines.len(),
                found: variance.len(),
            });
        }
        if let Some(index) = variance.iter().position(|v| !v.is_finite() || *v < 0.0) {
            return Err(SpectraError::BadVariance {
                frf: self.pairs[index / self.lines.len()].to_string(),
                frequency: self.lines.hz()[index % self.lines.len()],
                variance: variance[index],
            });
        }
        self.variance = Some(variance);
        Ok(self)
    }

    /// Ordinary coherence γ² of FRF `index` by line, where it was recorded.
    pub fn coherence(&self, index: usize) -> Option<&[f64]> {
        self.coherence[index].as_deref()
    }

    /// Whether FRF `index` has a value on a line: one of exactly zero is none, which files hold where nothing
    /// was recorded.
    pub fn has_value(&self, index: usize, line: usize) -> bool {
        self.values(index)[line] != Complex64::ZERO
    }

    /// Whether that was measured: one without coherence was not.
    pub fn is_measured(&self, index: usize, line: usize) -> bool {
        self.has_value(index, line) && self.coherence(index).is_none_or(|c| c[line] > 0.0)
    }

    /// Attaches the coherence of FRF `index`.
    ///
    /// # Errors
    /// A wrong number of values.
    pub fn set_coherence(&mut self, index: usize, coherence: Vec<f64>) -> Result<(), SpectraError> {
        if coherence.len() != self.lines.len() {
            return Err(SpectraError::Size { frfs: 1, lines: self.lines.len(), found: coherence.len() });
        }
        self.coherence[index] = Some(coherence);
        Ok(())
    }

    /// Number of averages (hits) behind FRF `index`, where it was recorded.
    pub fn averages(&self, index: usize) -> Option<u32> {
        self.averages[index]
    }

    /// States the number of averages behind FRF `index`.
    pub fn set_averages(&mut self, index: usize, averages: Option<u32>) {
        self.averages[index] = averages;
    }

    /// The set in another form, variances included; coherence does not change.
    ///
    /// # Errors
    /// [`SpectraError::NothingAtZero`] where a line at 0 Hz would have to be integrated.
    pub fn to_form(&self, target: FrfForm) -> Result<Self, SpectraError> {
        let mut converted = self.clone();
        converted.form = target;
        let n = self.lines.len();
        for (line, omega) in self.lines.omegas().enumerate() {
            let factor =
                self.form.factor_to(target, omega).ok_or(SpectraError::NothingAtZero(target.name()))?;
            for index in (line..self.values.len()).step_by(n) {
                converted.values[index] *= factor;
                if let Some(variance) = &mut converted.variance {
                    variance[index] *= factor.norm_sqr();
                }
            }
        }
        Ok(converted)
    }

    /// The set with other values, by their place and what they were: FRF after FRF. Variances go with the
    /// square of the size, coherence does not change.
    pub fn with_values(mut self, value: impl Fn(usize, Complex64) -> Complex64) -> Self {
        for (at, old) in self.values.iter_mut().enumerate() {
            let new = value(at, *old);
            if let Some(variance) = &mut self.variance
                && *old != Complex64::ZERO
            {
                variance[at] *= new.norm_sqr() / old.norm_sqr();
            }
            *old = new;
        }
        self
    }

    /// The set with so much added to its values, FRF after FRF: as well known as before.
    pub fn plus(mut self, added: &[Complex64]) -> Self {
        self.values.iter_mut().zip(added).for_each(|(value, added)| *value += added);
        self
    }

    /// The set at other frequencies, as many as it has lines.
    pub fn with_lines(mut self, lines: SpectralLines) -> Self {
        if lines.len() == self.lines.len() {
            self.lines = lines;
        }
        self
    }

    /// The set under other labels, as many as it has FRFs.
    pub fn with_pairs(mut self, pairs: Vec<FrfPair>) -> Self {
        if pairs.len() == self.pairs.len() {
            self.pairs = pairs;
        }
        self
    }

    /// The set of the FRFs of which `keep` holds true, by index; `None` where that leaves none.
    pub fn of_frfs(&self, keep: impl Fn(usize) -> bool) -> Option<Self> {
        let kept: Vec<usize> = (0..self.pairs.len()).filter(|&index| keep(index)).collect();
        if kept.is_empty() {
            return None;
        }
        let variance = |&index: &usize| self.variance(index).map(<[f64]>::to_vec);
        let variance: Option<Vec<Vec<f64>>> = kept.iter().map(variance).collect();
        Some(FrfSet {
            lines: self.lines.clone(),
            form: self.form,
            pairs: kept.iter().map(|&index| self.pairs[index].clone()).collect(),
            values: kept.iter().flat_map(|&index| self.values(index)).copied().collect(),
            variance: variance.map(|all| all.concat()),
            coherence: kept.iter().map(|&index| self.coherence[index].clone()).collect(),
            averages: kept.iter().map(|&index| self.averages[index]).collect(),
        })
    }

    /// The set on the lines of which `keep` holds true, by index; `None` where that leaves none.
    pub fn on_lines(&self, keep: impl Fn(usize) -> bool + Copy) -> Option<Self> {
        let lines = self.lines.retain(keep)?;
        let n = self.lines.len();
        fn pick<T: Copy>(all: &[T], n: usize, keep: impl Fn(usize) -> bool) -> Vec<T> {
            all.iter().enumerate().filter(|(i, _)| keep(i % n)).map(|(_, v)| *v).collect()
        }
        Some(FrfSet {
            values: pick(&self.values, n, keep),
            variance: self.variance.as_ref().map(|v| pick(v, n, keep)),
            coherence: self.coherence.iter().map(|c| c.as_ref().map(|c| pick(c, n, keep))).collect(),
            averages: self.averages.clone(),
            pairs: self.pairs.clone(),
            form: self.form,
            lines,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn set(values: Vec<Complex64>) -> Result<FrfSet, SpectraError> {
        let lines = SpectralLines::new(vec![1.0, 2.0, 4.0])?;
        let pairs = vec![FrfPair::transverse("4", "1"), FrfPair::transverse("3", "1")];
        FrfSet::new(lines, FrfForm::Accelerance, pairs, values)
    }

    #[test]
    fn a_missing_value_is_named_by_frf_and_frequency() {
        let mut values = vec![Complex64::ONE; 6];
        values[4] = Complex64::new(f64::NAN, 0.0);
        let error = set(values).unwrap_err();
        assert_eq!(error.to_string(), "FRF 3/1 holds a value that is not a finite number at 2 Hz");
    }

    #[test]
    fn an_frf_given_twice_is_refused() {
        let lines = SpectralLines::new(vec![1.0]).unwrap();
        let pairs = vec![FrfPair::transverse("4", "1"); 2];
        let answer = FrfSet::new(lines, FrfForm::Mobility, pairs, vec![Complex64::ONE; 2]);
        assert_eq!(answer.unwrap_err(), SpectraError::Twice("4/1".into()));
    }

    #[test]
    fn dropping_lines_keeps_every_frf_with_its_variance_and_coherence() {
        let values: Vec<_> = (0..6).map(|i| Complex64::new(i as f64, 0.0)).collect();
        let mut all = set(values).unwrap().with_variance((0..6).map(f64::from).collect()).unwrap();
        all.set_coherence(1, vec![0.1, 0.2, 0.3]).unwrap();
        let kept = all.on_lines(|i| i != 1).unwrap();
        assert_eq!(kept.lines().hz(), [1.0, 4.0]);
        assert_eq!(kept.values(1), [Complex64::new(3.0, 0.0), Complex64::new(5.0, 0.0)]);
        assert_eq!(kept.variance(1), Some([3.0, 5.0].as_slice()));
        assert_eq!(kept.coherence(1), Some([0.1, 0.3].as_slice()));
        assert!(all.on_lines(|_| false).is_none());
    }

    proptest! {
        #[test]
        fn the_three_forms_convert_into_each_other_and_back(re in -1e3f64..1e3, im in -1e3f64..1e3, variance in 0.0f64..10.0) {
            let start = set(vec![Complex64::new(re, im); 6]).unwrap().with_variance(vec![variance; 6]).unwrap();
            let there = start.to_form(FrfForm::Receptance).unwrap().to_form(FrfForm::Mobility).unwrap();
            let back = there.to_form(FrfForm::Accelerance).unwrap();
            for i in 0..6 {
                prop_assert!((back.all_values()[i] - start.all_values()[i]).norm() <= 1e-12 * start.all_values()[i].norm());
            }
            prop_assert!((back.variance(1).unwrap()[2] - variance).abs() <= 1e-12 * variance);
        }
    }
}
