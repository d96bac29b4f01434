//! FRFs and coherences of other formats as functions of a universal file.

use jointscope_uff::{Abscissa, Axis, Data, Dataset58, FunctionType, data_type};
use num_complex::Complex64;

use crate::ChannelPair;

/// The function of a pair over frequencies. What it measures its unit label says, or nobody: `m/s^2/N`,
/// `g per N`.
pub(crate) fn function(
    pair: &ChannelPair,
    frequencies: (&[f64], &str),
    unit: &str,
    name: &str,
    values: Values,
) -> Dataset58 {
    let (motion, force) = match unit.split_once(" per ") {
        Some((motion, force)) => (motion.trim(), force.trim()),
        None => (unit.trim(), ""),
    };
    let label = |text: &str| if text.is_empty() { "NONE".to_owned() } else { text.to_owned() };
    let axis = |units: &str| Axis::new(data_type::UNKNOWN, "NONE", &label(units));
    let (function, data, ordinate, denominator) = match values {
        Values::Frf(values) => {
            (FunctionType::FrequencyResponse, Data::Complex(values), axis(motion), axis(force))
        }
        Values::Coherence(values) => {
            let ordinate = Axis::new(data_type::GENERAL, "Coherence", "NONE");
            (FunctionType::Coherence, Data::Real(values), ordinate, Axis::default())
        }
    };
    let mut dataset = Dataset58 {
        function,
        response: pair.response.clone(),
        reference: pair.reference.clone(),
        abscissa_axis: Axis::new(data_type::FREQUENCY, "Frequency", frequencies.1),
        ordinate_axis: ordinate,
        denominator_axis: denominator,
        ..Dataset58::new(Abscissa::Uneven(frequencies.0.to_vec()), data)
    };
    dataset.id_lines[0] = name.chars().map(|c| if c.is_control() { ' ' } else { c }).take(80).collect();
    dataset
}

/// What a function holds.
pub(crate) enum Values {
    Frf(Vec<Complex64>),
    Coherence(Vec<f64>),
}
