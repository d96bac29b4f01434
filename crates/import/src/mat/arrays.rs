//! Plain arrays: frequencies and complex values beside them, at the top of a file or within a structure.

use num_complex::Complex64;

use super::sink::Sink;
use super::value::Value;
use crate::function::{Values, function};
use crate::{ChannelPair, ImportError, PairError};

/// Structures in structures that are looked into.
const DEEPEST: usize = 4;

/// Reads the FRFs among variables; `prefix` is the path of the structure that holds them, with a point at its
/// end.
pub(super) fn read(prefix: &str, variables: &[&(String, Value)], sink: &mut Sink) -> Result<(), ImportError> {
    level(prefix, variables, sink, 0)
}

fn level(
    prefix: &str,
    variables: &[&(String, Value)],
    sink: &mut Sink,
    depth: usize,
) -> Result<(), ImportError> {
    if let Some((frequencies, unit)) = variables.iter().find_map(|(name, value)| frequencies(name, value)) {
        let long = |value: &Value| matches!(value, Value::Numbers { dims, im: Some(_), .. } if dims.contains(&frequencies.len()));
        let arrays: Vec<_> = variables.iter().filter(|(_, value)| long(value)).collect();
        for (name, value) in &arrays {
            let only = arrays.len() == 1;
            array(&format!("{prefix}{name}"), value, (&frequencies, unit), only, sink)?;
        }
    }
    for (name, value) in variables {
        if let Some(fields) = value.fields().filter(|_| depth < DEEPEST) {
            let inner: Vec<&(String, Value)> = fields.iter().collect();
            level(&format!("{prefix}{name}."), &inner, sink, depth + 1)?;
        }
    }
    Ok(())
}

/// A vector of frequencies by its name, and its unit.
fn frequencies(name: &str, value: &Value) -> Option<(Vec<f64>, &'static str)> {
    let unit = match name.to_lowercase().as_str() {
        "f" | "freq" | "freqs" | "frequency" | "frequencies" | "freq_hz" | "f_hz" | "frequency_hz" => "Hz",
        "omega" | "w" => "rad/s",
        _ => return None,
    };
    match value {
        Value::Numbers { dims, re, im: None }
            if re.len() > 1 && dims.iter().filter(|dim| **dim > 1).count() == 1 =>
        {
            Some((re.clone(), unit))
        }
        _ => None,
    }
}

/// One array: a function a column, or a slice of a matrix a line.
fn array(
    name: &str,
    value: &Value,
    (frequencies, unit): (&[f64], &str),
    only: bool,
    sink: &mut Sink,
) -> Result<(), ImportError> {
    let Value::Numbers { dims, re, im: Some(im) } = value else { return Ok(()) };
    let wrong = |problem: String| ImportError::Variable { variable: name.to_owned(), problem };
    let fits: Vec<usize> = (0..dims.len()).filter(|at| dims[*at] == frequencies.len()).collect();
    let along = match fits.as_slice() {
        [one] => *one,
        _ => {
            let problem = format!(
                "is {}: which of its dimensions is that of the {} frequencies is not clear; give functions as columns of their own length",
                value.what(),
                frequencies.len()
            );
            return Err(wrong(problem));
        }
    };
    if re.iter().chain(im).any(|value| !value.is_finite()) {
        return Err(wrong("a value is not finite; mask or remove it before export".into()));
    }
    let slices = slices(dims, along);
    let mut unnamed = None;
    let mut taken = 0;
    for slice in &slices {
        let key = match slice.index.as_slice() {
            _ if slices.len() == 1 => name.to_owned(),
            index => {
                format!("{name}({})", index.iter().map(|i| (i + 1).to_string()).collect::<Vec<_>>().join(","))
            }
        };
        let is_alone = slices.len() == 1;
        let Some((pair, label)) = channels(&key, name, (is_alone, is_alone && only), sink) else {
            unnamed.get_or_insert(key);
            continue;
        };
        taken += 1;
        let values = slice.at.iter().map(|at| Complex64::new(re[*at], im[*at])).collect();
        sink.file.datasets.push(function(&pair, (frequencies, unit), &label, &key, Values::Frf(values)));
    }
    match unnamed {
        // Where the analyst names some, the others are not wanted.
        Some(variable) if taken == 0 => {
            Err(ImportError::Pair { problem: PairError(variable.clone()), variable })
        }
        _ => Ok(()),
    }
}

/// Channels and unit of a function: as the map states them, or else by the array's own name where it is the
/// array's only one, or the file's.
fn channels(
    key: &str,
    array: &str,
    (of_array, of_file): (bool, bool),
    sink: &mut Sink,
) -> Option<(ChannelPair, String)> {
    let entry = sink.map.of_name(key);
    if let Some((used, entry)) = entry.or_else(|| sink.map.of_file(sink.file_name).filter(|_| of_file)) {
        sink.used.insert(used);
        return Some((entry.pair.clone(), entry.unit.clone().unwrap_or_default()));
    }
    let pair = pair_of(array.rsplit('.').next().unwrap_or(array)).filter(|_| of_array)?;
    let stated = sink.map.of_pair(&pair);
    sink.used.extend(stated.map(|(used, _)| used));
    Some((pair, stated.and_then(|(_, entry)| entry.unit.clone()).unwrap_or_default()))
}

/// The values of one function within an array.
struct Slice {
    /// Its indices along the other dimensions, from 0, those of length one left out.
    index: Vec<usize>,
    at: Vec<usize>,
}

/// All functions along one dimension of an array in column-major order.
fn slices(dims: &[usize], along: usize) -> Vec<Slice> {
    let stride: usize = dims[..along].iter().product();
    let others: Vec<usize> = (0..dims.len()).filter(|at| *at != along).collect();
    let count: usize = others.iter().map(|at| dims[*at]).product();
    (0..count)
        .map(|number| {
            let (mut left, mut start, mut index) = (number, 0, Vec::new());
            for at in &others {
                let here = left % dims[*at];
                left /= dims[*at];
                start += here * dims[..*at].iter().product::<usize>();
                if dims[*at] > 1 {
                    index.push(here);
                }
            }
            Slice { index, at: (0..dims[along]).map(|line| start + line * stride).collect() }
        })
        .collect()
}

/// `H_4_1`, `frf_4_1`, `H4_1`: the FRF 4/1.
fn pair_of(name: &str) -> Option<ChannelPair> {
    let lower = name.to_lowercase();
    let rest = ["frf", "h"].iter().find_map(|start| lower.strip_prefix(start))?;
    let (response, reference) = rest.trim_start_matches('_').split_once('_')?;
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    (digits(response) && digits(reference))
        .then(|| ChannelPair::parse(&format!("{response}/{reference}")).ok())?
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variables_are_named_for_their_frf_or_not() {
        assert_eq!(pair_of("H_4_1").unwrap().to_string(), "4:+y/1:+y");
        assert_eq!(pair_of("frf_12_3").unwrap().to_string(), "12:+y/3:+y");
        assert_eq!(pair_of("H4_1").unwrap().to_string(), "4:+y/1:+y");
        assert!(["H", "H41", "Y_4_1", "H_a_b", "H_4_1_2"].iter().all(|name| pair_of(name).is_none()));
    }

    #[test]
    fn slices_of_a_matrix_run_along_the_lines() {
        // 2 responses, 1 reference, 3 lines.
        let found = slices(&[2, 1, 3], 2);
        assert_eq!(found.len(), 2);
        assert_eq!((found[1].index.clone(), found[1].at.clone()), (vec![1], vec![1, 3, 5]));
        let columns = slices(&[3, 2], 0);
        assert_eq!((columns[1].index.clone(), columns[1].at.clone()), (vec![1], vec![3, 4, 5]));
    }
}
