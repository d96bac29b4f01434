//! One function of a file, read for what it is to the test: its lines, values, level and averages.

use jointscope_spectra::{FrfForm, SpectralLines};
use jointscope_uff::{Abscissa, Axis, Data, Dataset58, FunctionType};
use num_complex::Complex64;

use crate::ordinate::hertz;
use crate::{FileChannel, FunctionError, FunctionPlace, HeldAmplitude, Source};

/// A function and where it stands.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Function<'a> {
    /// Name of its file.
    pub source: &'a str,
    /// Its position among the file's functions, from 0.
    pub index: usize,
    pub dataset: &'a Dataset58,
}

/// The functions of all files.
pub(crate) fn functions(sources: &[Source]) -> impl Iterator<Item = Function<'_>> {
    sources.iter().flat_map(|source| {
        let datasets = source.file.datasets.iter().enumerate();
        datasets.map(|(index, dataset)| Function { source: &source.name, index, dataset })
    })
}

impl<'a> Function<'a> {
    pub(crate) fn response(&self) -> FileChannel {
        FileChannel::from(&self.dataset.response)
    }

    pub(crate) fn reference(&self) -> FileChannel {
        FileChannel::from(&self.dataset.reference)
    }

    /// What it is, in messages.
    pub(crate) fn what(&self) -> &'static str {
        match self.dataset.function {
            FunctionType::FrequencyResponse => "FRF",
            FunctionType::Coherence => "coherence",
            FunctionType::TimeResponse => "time history",
            _ => "function",
        }
    }

    pub(crate) fn place(&self) -> Box<FunctionPlace> {
        let (what, response) = (self.what(), self.response());
        let what = match self.dataset.function {
            FunctionType::TimeResponse => format!("{what} of {response}"),
            _ => format!("{what} {response}/{}", self.reference()),
        };
        Box::new(FunctionPlace { source: self.source.to_owned(), function: self.index + 1, what })
    }

    /// Refuses a function that holds fewer points than its header states.
    pub(crate) fn whole(&self) -> Result<(), FunctionError> {
        match self.dataset.stated_points {
            None => Ok(()),
            Some(stated) => Err(FunctionError::Short { stated, found: self.dataset.data.len() }),
        }
    }

    /// Held amplitude, ID line 4.
    pub(crate) fn level(&self) -> Option<HeldAmplitude> {
        HeldAmplitude::parse(&self.dataset.id_lines[3])
    }

    /// Number of averages, ID line 5.
    pub(crate) fn averages(&self) -> Result<Option<u32>, FunctionError> {
        let line = &self.dataset.id_lines[4];
        let mut words = line.split_whitespace();
        if !words.next().is_some_and(|word| word.eq_ignore_ascii_case("averages")) {
            return Ok(None);
        }
        match (words.next().and_then(|word| word.parse().ok()), words.next()) {
            (Some(count @ 1..), None) => Ok(Some(count)),
            _ => Err(FunctionError::Averages(line.clone())),
        }
    }

    /// Decay of the exponential window that lies on force and response, 1/s; ID line 3:
    /// `exponential window 12.5 1/s`. 0 where it speaks of something else.
    pub(crate) fn window_decay(&self) -> Result<f64, FunctionError> {
        let line = &self.dataset.id_lines[2];
        let Some(rest) = line.to_lowercase().trim().strip_prefix("exponential window").map(str::to_owned)
        else {
            return Ok(0.0);
        };
        let mut words = rest.split_whitespace();
        match (words.next().and_then(|word| word.parse::<f64>().ok()), words.next(), words.next()) {
            (Some(decay), Some("1/s"), None) if decay.is_finite() && decay >= 0.0 => Ok(decay),
            _ => Err(FunctionError::Window(line.clone())),
        }
    }

    /// Complex values.
    pub(crate) fn complex(&self) -> Result<&'a [Complex64], FunctionError> {
        match &self.dataset.data {
            Data::Complex(values) => Ok(values),
            Data::Real(_) => Err(FunctionError::NoPhase),
        }
    }

    /// Values of a coherence; analysers store some as complex numbers without imaginary part.
    pub(crate) fn coherence(&self) -> Result<Vec<f64>, FunctionError> {
        match &self.dataset.data {
            Data::Real(values) => Ok(values.clone()),
            Data::Complex(values) if values.iter().all(|value| value.im == 0.0) => {
                Ok(values.iter().map(|value| value.re).collect())
            }
            Data::Complex(_) => Err(FunctionError::ComplexCoherence),
        }
    }
}

/// Appends accelerances, from values of another form: `factor` brings them to SI and along y.
pub(crate) fn append_accelerances(
    all: &mut Vec<Complex64>,
    values: &[Complex64],
    form: FrfForm,
    factor: f64,
    lines: &SpectralLines,
) {
    match form {
        FrfForm::Accelerance => all.extend(values.iter().map(|value| value * factor)),
        // iω times.
        FrfForm::Mobility => all.extend(values.iter().zip(lines.omegas()).map(|(value, omega)| {
            let scale = factor * omega;
            Complex64::new(-value.im * scale, value.re * scale)
        })),
        // (iω)² times.
        FrfForm::Receptance => all.extend(
            values.iter().zip(lines.omegas()).map(|(value, omega)| value * (-factor * omega * omega)),
        ),
    }
}

/// Spectral lines of functions, built once for all functions on the same abscissa.
#[derive(Default)]
pub(crate) struct LinesCache<'a> {
    last: Option<(&'a Abscissa, &'a Axis, SpectralLines)>,
}

impl<'a> LinesCache<'a> {
    pub(crate) fn lines(&mut self, dataset: &'a Dataset58) -> Result<SpectralLines, FunctionError> {
        let (abscissa, axis) = (&dataset.abscissa, &dataset.abscissa_axis);
        if let Some((last, last_axis, lines)) = &self.last
            && (*last, *last_axis) == (abscissa, axis)
        {
            return Ok(lines.clone());
        }
        let factor = hertz(axis)?;
        let mut frequencies = abscissa.values();
        if factor != 1.0 {
            frequencies.iter_mut().for_each(|frequency| *frequency *= factor);
        }
        let lines = SpectralLines::new(frequencies).map_err(FunctionError::Lines)?;
        self.last = Some((abscissa, axis, lines.clone()));
        Ok(lines)
    }
}
