//! A MATLAB value, whichever file version it came from.

/// A variable, a field of a structure, or a cell.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    /// Numbers in column-major order.
    Numbers { dims: Vec<usize>, re: Vec<f64>, im: Option<Vec<f64>> },
    /// Rows of text.
    Text(Vec<String>),
    /// A cell array.
    Cells(Vec<Value>),
    /// A structure array: its elements, each with its fields in order.
    Structs(Vec<Vec<(String, Value)>>),
    /// Anything else: a function, a table, a sparse matrix.
    Other(&'static str),
}

impl Value {
    /// The fields of a structure that is no array.
    pub(super) fn fields(&self) -> Option<&[(String, Value)]> {
        match self {
            Value::Structs(elements) => match elements.as_slice() {
                [one] => Some(one),
                _ => None,
            },
            _ => None,
        }
    }

    /// A field along a path such as `y_values.quantity.label`.
    pub(super) fn field(&self, path: &str) -> Option<&Value> {
        path.split('.').try_fold(self, |value, name| {
            let same = |(field, _): &&(String, Value)| field.eq_ignore_ascii_case(name);
            value.fields()?.iter().find(same).map(|(_, value)| value)
        })
    }

    /// One real number.
    pub(super) fn number(&self) -> Option<f64> {
        match self {
            Value::Numbers { re, .. } => match re.as_slice() {
                [one] => Some(*one),
                _ => None,
            },
            _ => None,
        }
    }

    /// All texts in it: rows of text, or those of the cells.
    pub(super) fn texts(&self) -> Vec<String> {
        match self {
            Value::Text(rows) => rows.clone(),
            Value::Cells(cells) => cells.iter().flat_map(Value::texts).collect(),
            _ => Vec::new(),
        }
    }

    /// What it is, for messages.
    pub(super) fn what(&self) -> String {
        match self {
            Value::Numbers { dims, im, .. } => {
                let size = dims.iter().map(usize::to_string).collect::<Vec<_>>().join("×");
                format!("{size} {}", if im.is_some() { "complex" } else { "real" })
            }
            Value::Text(_) => "text".to_owned(),
            Value::Cells(_) => "cells".to_owned(),
            Value::Structs(_) => "structure".to_owned(),
            Value::Other(what) => (*what).to_owned(),
        }
    }
}
