//! The structure that Simcenter Testlab exports.

use jointscope_uff::{Dataset58, FunctionType};
use num_complex::Complex64;

use super::sink::Sink;
use super::value::Value;
use crate::function::{Values, function};
use crate::pair::{channel, direction};
use crate::{ChannelPair, ImportError, PairError};
use jointscope_uff::{Data, Node};

/// Whether a variable is a block of functions.
pub(super) fn is_block(value: &Value) -> bool {
    value.field("x_values").is_some() && value.field("y_values.values").is_some()
}

/// Reads a block: one function a column, or a row where only the rows are as long as its lines.
pub(super) fn read(variable: &str, block: &Value, sink: &mut Sink) -> Result<(), ImportError> {
    let functions = Functions::of(block)
        .map_err(|problem| ImportError::Variable { variable: variable.to_owned(), problem })?;
    let names = texts(block, "function_record.name");
    let count = functions.count();
    for at in 0..count {
        let key = if count == 1 { variable.to_owned() } else { format!("{variable}({})", at + 1) };
        let name = names.get(at).cloned().unwrap_or_default();
        let dataset = functions.dataset(at, (&key, &name), sink)?;
        sink.file.datasets.push(dataset);
    }
    Ok(())
}

/// The functions of a block, one after the other.
struct Functions {
    lines: Vec<f64>,
    re: Vec<f64>,
    im: Option<Vec<f64>>,
    x_unit: String,
    unit: String,
    /// What values have to be multiplied by to be in their unit.
    factor: f64,
}

impl Functions {
    /// The functions; else what is wrong with the block.
    fn of(block: &Value) -> Result<Self, String> {
        let Some(Value::Numbers { dims, re, im }) = block.field("y_values.values") else {
            return Err("`y_values.values` holds no numbers; export it again".to_owned());
        };
        let lines = lines(block).ok_or_else(|| {
            "`x_values` holds no start_value, increment and number_of_values; export it again".to_owned()
        })?;
        let Some(by_column) = by_column(dims, lines.len()).filter(|_| !re.is_empty()) else {
            let size = dims.iter().map(usize::to_string).collect::<Vec<_>>().join("×");
            return Err(format!(
                "{size} values do not make functions of {} lines (x_values.number_of_values); export it again",
                lines.len()
            ));
        };
        let turned = |values: &[f64]| transposed(values, re.len() / lines.len());
        let (re, im) = match by_column {
            true => (re.clone(), im.clone()),
            false => (turned(re), im.as_deref().map(turned)),
        };
        let x_unit = first_text(block, "x_values.quantity.label");
        if matches!(x_unit.trim(), "s" | "ms") {
            return Err("holds time histories; export them as UFF (dataset 58)".to_owned());
        }
        let unit = first_text(block, "y_values.quantity.label");
        let factor = factor(block, &unit)?;
        Ok(Functions { lines, re, im, x_unit, unit, factor })
    }

    fn count(&self) -> usize {
        self.re.len() / self.lines.len()
    }

    /// One of the functions by its index, its key and its name.
    fn dataset(
        &self,
        at: usize,
        (key, name): (&str, &str),
        sink: &mut Sink,
    ) -> Result<Dataset58, ImportError> {
        let range = at * self.lines.len()..(at + 1) * self.lines.len();
        let (re, im) = (&self.re[range.clone()], self.im.as_ref().map(|im| &im[range]));
        if re.iter().chain(im.into_iter().flatten()).any(|value| !value.is_finite()) {
            let problem = "a value is not finite; mask or remove it before export".into();
            return Err(ImportError::Variable { variable: key.to_owned(), problem });
        }
        let pair = match (channels(key, name, self.count() == 1, sink), im) {
            (Some(pair), _) => pair,
            // What is no FRF is told of, and nobody asks for its nodes.
            (None, None) => ChannelPair { response: Node::default(), reference: Node::default() },
            (None, Some(_)) => {
                let problem = PairError(name.to_owned());
                return Err(ImportError::Pair { variable: key.to_owned(), problem });
            }
        };
        let title = if name.is_empty() { key } else { name };
        let (axis, factor) = ((self.lines.as_slice(), self.x_unit.as_str()), self.factor);
        Ok(match im {
            Some(im) => {
                let values = re.iter().zip(im).map(|(re, im)| Complex64::new(re * factor, im * factor));
                function(&pair, axis, &self.unit, title, Values::Frf(values.collect()))
            }
            None => real(&pair, axis, &self.unit, title, re.iter().map(|v| v * factor).collect()),
        })
    }
}

fn texts(block: &Value, path: &str) -> Vec<String> {
    block.field(path).map(Value::texts).unwrap_or_default()
}

fn first_text(block: &Value, path: &str) -> String {
    texts(block, path).into_iter().next().unwrap_or_default()
}

/// What values have to be multiplied by to be in the unit of their label; else what is wrong.
fn factor(block: &Value, unit: &str) -> Result<f64, String> {
    let Some(factor) = block.field("y_values.quantity.unit_transformation.factor") else { return Ok(1.0) };
    let factor = factor.number().filter(|factor| factor.is_finite() && *factor > 0.0).ok_or_else(|| {
        "the factor of `y_values.quantity.unit_transformation` is no number above zero".to_owned()
    })?;
    // Values are stored in SI: the factor brings them to the unit of the label, or one of the two is wrong.
    match si_of(unit) {
        Some(si) if (factor * si - 1.0).abs() > DISPUTED => Err(format!(
            "the factor {factor} of `y_values.quantity.unit_transformation` does not bring SI values to `{unit}`, as {:.6} would; export it again in SI units, or as UFF (dataset 58)",
            si.recip()
        )),
        _ => Ok(factor),
    }
}

/// Channels of a function: as the map states them by its names, or the file's where it is the only one, or as
/// its own name has them.
fn channels(key: &str, name: &str, of_file: bool, sink: &mut Sink) -> Option<ChannelPair> {
    let entry = sink.map.of_name(key).or_else(|| sink.map.of_name(name));
    match entry.or_else(|| sink.map.of_file(sink.file_name).filter(|_| of_file)) {
        Some((used, entry)) => {
            sink.used.insert(used);
            Some(entry.pair.clone())
        }
        None => pair_of(name),
    }
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

/// Relative departure from which a factor is not that of its label.
const DISPUTED: f64 = 1e-2;

/// Whether functions are the columns of a matrix, or its rows; `None` where neither are so many lines long.
fn by_column(dims: &[usize], lines: usize) -> Option<bool> {
    let longer: Vec<usize> = dims.iter().copied().filter(|size| *size != 1).collect();
    match (lines, dims, longer.as_slice()) {
        (0, ..) => None,
        // One function, or functions of one line.
        (_, _, []) => (lines == 1).then_some(true),
        (_, _, [one]) if *one == lines || lines == 1 => Some(true),
        (_, [rows, ..], _) if *rows == lines => Some(true),
        (_, [_, columns], _) if *columns == lines => Some(false),
        _ => None,
    }
}

/// A matrix of so many rows, column after column, as its rows, one after the other.
fn transposed(values: &[f64], rows: usize) -> Vec<f64> {
    let columns = values.len() / rows.max(1);
    (0..rows).flat_map(|row| (0..columns).map(move |column| values[column * rows + row])).collect()
}

/// SI units in one of a label such as `g/N`, `(m/s^2)/N` or `mm/s²/kN`; `None` where a name in it is not
/// known here.
fn si_of(label: &str) -> Option<f64> {
    let text: String =
        label.replace('²', "^2").chars().filter(|c| !c.is_whitespace() && !"()[]".contains(*c)).collect();
    let mut si = 1.0;
    for (place, part) in text.split('/').enumerate() {
        let (name, power) = match part.strip_suffix("^2").or_else(|| part.strip_suffix("s2").map(|_| "s")) {
            Some(name) => (name, 2),
            None => (part, 1),
        };
        let factor: f64 = match name {
            "m" | "s" | "N" | "rad" => 1.0,
            "g" | "gn" => 9.80665,
            "mm" | "mN" => 1e-3,
            "cm" => 1e-2,
            "um" | "µm" | "μm" => 1e-6,
            "in" => 0.0254,
            "ft" => 0.3048,
            "kN" => 1e3,
            "lbf" => 4.448_221_615_260_5,
            _ => return None,
        };
        si *= factor.powi(if place == 0 { power } else { -power });
    }
    Some(si)
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

    fn block(rows: usize, columns: usize, factor: Option<f64>, label: &str) -> Value {
        let number = |value: f64| Value::Numbers { dims: vec![1, 1], re: vec![value], im: None };
        let of = |fields: Vec<(&str, Value)>| {
            Value::Structs(vec![fields.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()])
        };
        // Function 0 of three lines reads 0, 1, 2, function 1 reads 10, 11, 12.
        let value = |row: usize, column: usize| match rows {
            3 => 10.0 * column as f64 + row as f64,
            _ => 10.0 * row as f64 + column as f64,
        };
        let re: Vec<f64> = (0..columns).flat_map(|c| (0..rows).map(move |r| value(r, c))).collect();
        let im = Some(vec![0.0; re.len()]);
        let mut quantity = vec![("label", Value::Text(vec![label.to_owned()]))];
        quantity.extend(factor.map(|f| ("unit_transformation", of(vec![("factor", number(f))]))));
        of(vec![
            (
                "x_values",
                of(vec![
                    ("start_value", number(10.0)),
                    ("increment", number(1.0)),
                    ("number_of_values", number(3.0)),
                ]),
            ),
            (
                "y_values",
                of(vec![
                    ("values", Value::Numbers { dims: vec![rows, columns], re, im }),
                    ("quantity", of(quantity)),
                ]),
            ),
            ("function_record", of(vec![("name", Value::Text(vec!["4/1".into(), "3/1".into()]))])),
        ])
    }

    fn values(block: &Value) -> Result<Vec<Vec<f64>>, String> {
        let mut used = std::collections::BTreeSet::new();
        let map = crate::ColumnMap::default();
        let mut sink =
            Sink { file: jointscope_uff::UffFile::default(), map: &map, used: &mut used, file_name: "a.mat" };
        read("FRF", block, &mut sink).map_err(|error| error.to_string())?;
        let of = |dataset: &Dataset58| match &dataset.data {
            Data::Complex(values) => values.iter().map(|value| value.re).collect(),
            _ => Vec::new(),
        };
        Ok(sink.file.datasets.iter().map(of).collect())
    }

    #[test]
    fn functions_are_the_columns_of_a_block_or_its_rows_where_those_are_as_long_as_its_lines() {
        let expected = vec![vec![0.0, 1.0, 2.0], vec![10.0, 11.0, 12.0]];
        for (rows, columns) in [(3, 2), (2, 3)] {
            assert_eq!(
                values(&block(rows, columns, None, "m/s^2/N")).as_ref(),
                Ok(&expected),
                "{rows}×{columns}"
            );
        }
        for (rows, columns) in [(1, 3), (3, 1)] {
            assert_eq!(values(&block(rows, columns, None, "m/s^2/N")).unwrap(), expected[..1]);
        }
        let refused = values(&block(6, 2, None, "m/s^2/N")).unwrap_err();
        assert!(refused.contains("6×2 values do not make functions of 3 lines"), "{refused}");
    }

    #[test]
    fn a_factor_that_contradicts_its_label_is_refused() {
        let refused = values(&block(3, 2, Some(9.80665), "g/N")).unwrap_err();
        assert!(
            refused.contains("the factor 9.80665") && refused.contains("`g/N`, as 0.101972 would"),
            "{refused}"
        );
        assert!(values(&block(3, 2, Some(1.0), "g/N")).is_err());
        for (factor, label) in
            [(1.0 / 9.80665, "g/N"), (1.0, "(m/s^2)/N"), (1e6, "mm/s²/kN"), (7.0, "bogus/N")]
        {
            assert!(values(&block(3, 2, Some(factor), label)).is_ok(), "{label}");
        }
    }

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
