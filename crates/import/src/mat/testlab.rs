//! The structure that Simcenter Testlab exports.

use jointscope_uff::{Dataset58, FunctionType};
use num_complex::Complex64;

use super::Sink;
use super::value::Value;
use crate::function::{Values, function};
use crate::pair::{channel, direction};
use crate::{ChannelPair, ImportError, PairError};
use jointscope_uff::{Data, Node};

/// Whether a variable is a block of functions.
pub(super) fn is_block(value: &Value) -> bool {
    value.field("x_values").is_some() && value.field("y_values.values").is_some()
}

/// Reads a block: one function a column.
pub(super) fn read(variable: &str, block: &Value, sink: &mut Sink) -> Result<(), ImportError> {
    let wrong =
        |problem: &str| ImportError::Variable { variable: variable.to_owned(), problem: problem.to_owned() };
    let Some(Value::Numbers { re, im, .. }) = block.field("y_values.values") else {
        return Err(wrong("`y_values.values` holds no numbers; export it again"));
    };
    let lines = lines(block).ok_or_else(|| {
        wrong("`x_values` holds no start_value, increment and number_of_values; export it again")
    })?;
    if lines.is_empty() || !re.len().is_multiple_of(lines.len()) || re.is_empty() {
        let problem = format!(
            "{} values do not make functions of {} lines (x_values.number_of_values); export it again",
            re.len(),
            lines.len()
        );
        return Err(ImportError::Variable { variable: variable.to_owned(), problem });
    }
    let text = |path: &str| block.field(path).map(Value::texts).unwrap_or_default();
    let x_unit = text("x_values.quantity.label").into_iter().next().unwrap_or_default();
    if matches!(x_unit.trim(), "s" | "ms") {
        return Err(wrong("holds time histories; export them as UFF (dataset 58)"));
    }
    let unit = text("y_values.quantity.label").into_iter().next().unwrap_or_default();
    let factor = match block.field("y_values.quantity.unit_transformation.factor") {
        None => 1.0,
        Some(factor) => {
            factor.number().filter(|factor| factor.is_finite() && *factor > 0.0).ok_or_else(|| {
                wrong("the factor of `y_values.quantity.unit_transformation` is no number above zero")
            })?
        }
    };
    let names = text("function_record.name");
    let columns = re.len() / lines.len();
    for at in 0..columns {
        let range = at * lines.len()..(at + 1) * lines.len();
        let key = if columns == 1 { variable.to_owned() } else { format!("{variable}({})", at + 1) };
        let name = names.get(at).cloned().unwrap_or_default();
        if re[range.clone()]
            .iter()
            .chain(im.iter().flat_map(|im| &im[range.clone()]))
            .any(|value| !value.is_finite())
        {
            return Err(ImportError::Variable {
                variable: key,
                problem: "a value is not finite; mask or remove it before export".into(),
            });
        }
        let entry = sink.map.of_name(&key).or_else(|| sink.map.of_name(&name));
        let entry = entry.or_else(|| sink.map.of_file(sink.file_name).filter(|_| columns == 1));
        let pair = match entry {
            Some((used, entry)) => {
                sink.used.insert(used);
                entry.pair.clone()
            }
            None => match (pair_of(&name), im) {
                (Some(pair), _) => pair,
                // What is no FRF is told of, and nobody asks for its nodes.
                (None, None) => ChannelPair { response: Node::default(), reference: Node::default() },
                (None, Some(_)) => {
                    return Err(ImportError::Pair { variable: key, problem: PairError(name) });
                }
            },
        };
        let title = if name.is_empty() { &key } else { &name };
        let dataset = match im {
            Some(im) => {
                let values = re[range.clone()].iter().zip(&im[range]);
                let values = values.map(|(re, im)| Complex64::new(re * factor, im * factor)).collect();
                function(&pair, (&lines, &x_unit), &unit, title, Values::Frf(values))
            }
            None => {
                real(&pair, (&lines, &x_unit), &unit, title, re[range].iter().map(|v| v * factor).collect())
            }
        };
        sink.file.datasets.push(dataset);
    }
    Ok(())
}

/// Real functions: coherences by their name, anything else of no stated type.
fn real(pair: &ChannelPair, lines: (&[f64], &str), unit: &str, name: &str, values: Vec<f64>) -> Dataset58 {
    let coherence = name.to_lowercase().contains("coherence");
    let mut dataset = function(pair, lines, unit, name, Values::Coherence(values));
    if !coherence {
        dataset.function = FunctionType::General;
        dataset.ordinate_axis.units = if unit.is_empty() { "NONE".to_owned() } else { unit.to_owned() };
        debug_assert!(matches!(dataset.data, Data::Real(_)));
    }
    dataset
}

fn lines(block: &Value) -> Option<Vec<f64>> {
    if let Some(Value::Numbers { re, .. }) =
        block.field("x_values.values").filter(|v| matches!(v, Value::Numbers { re, .. } if !re.is_empty()))
    {
        return Some(re.clone());
    }
    let number = |field: &str| block.field(&format!("x_values.{field}")).and_then(Value::number);
    let (start, step, count) = (number("start_value")?, number("increment")?, number("number_of_values")?);
    let count = (0.0..1e9).contains(&count).then_some(count as usize)?;
    let Some(Value::Numbers { re, .. }) = block.field("y_values.values") else { return None };
    // No more lines than values: a wild count allocates nothing.
    (count <= re.len()).then(|| (0..count).map(|line| start + line as f64 * step).collect())
}

/// `FRF 4:+Z/1:+Z`, `4/1`, `FRF beam:4:+Z/beam:1:+Z`: the last two parts of each side are node and direction.
fn pair_of(name: &str) -> Option<ChannelPair> {
    let (left, right) = name.split_once('/')?;
    let side = |text: &str| {
        let mut parts = text.trim().rsplit(':').map(str::trim);
        let last = parts.next()?;
        match direction(last) {
            Some(direction) => {
                let node: i64 = parts.next()?.parse().ok().filter(|number| *number >= 0)?;
                Some(Node::new(node, direction))
            }
            None => channel(last),
        }
    };
    let response = side(left.split_whitespace().last()?)?;
    let reference = side(right.split_whitespace().next()?)?;
    Some(ChannelPair { response, reference })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_functions_hold_node_and_direction_or_nothing() {
        let check = |name: &str, expected: Option<&str>| {
            assert_eq!(pair_of(name).map(|pair| pair.to_string()).as_deref(), expected, "{name}");
        };
        check("FRF 4:+Z/1:-Z", Some("4:+z/1:-z"));
        check("FRF beam:4:+Z/beam:1:+X (H1)", Some("4:+z/1:+x"));
        check("4/1", Some("4:+y/1:+y"));
        check("FRF Point4:+Z/Point1:+Z", None);
        check("FRF A02X", None);
    }
}
