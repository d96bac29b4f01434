//! MATLAB's v7.3 files, which are HDF5: groups are structures, datasets are arrays with their dimensions
//! reversed, cells refer to objects in `#refs#`; the attribute `MATLAB_class` says what an object is.

use std::collections::BTreeMap;

use hdf5_reader::group::Group;
use hdf5_reader::{Dataset, Datatype, Hdf5File, OpenOptions};

use super::value::Value;
use crate::ImportError;

/// Structures in structures: deeper than anybody nests them.
const DEEPEST: usize = 32;
/// What one array may take, in bytes.
const LARGEST: usize = 1 << 30;
/// How many values one file may hold: references may form circles.
const MOST: usize = 200_000;

fn hdf5(error: impl std::fmt::Display) -> ImportError {
    ImportError::Hdf5(error.to_string())
}

/// Reads all variables with their names.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<(String, Value)>, ImportError> {
    let options = OpenOptions::default().with_max_read_bytes(LARGEST).with_max_chunk_bytes(LARGEST);
    let file = Hdf5File::from_bytes_with_options(bytes, options).map_err(hdf5)?;
    let root = file.root_group().map_err(hdf5)?;
    let (groups, datasets) = root.members().map_err(hdf5)?;
    let mut referred = BTreeMap::new();
    if let Some(refs) = groups.iter().find(|group| leaf(group.name()) == "#refs#") {
        let (groups, datasets) = refs.members().map_err(hdf5)?;
        referred.extend(groups.into_iter().map(|group| (group.address(), Object::Group(group))));
        referred.extend(
            datasets.into_iter().map(|dataset| (dataset.address(), Object::Dataset(Box::new(dataset)))),
        );
    }
    let mut reader = Reader { referred, left: MOST };
    let mut variables = Vec::new();
    for group in groups.iter().filter(|group| !leaf(group.name()).starts_with('#')) {
        variables.push((leaf(group.name()).to_owned(), reader.group(group, 0)?));
    }
    for dataset in datasets.iter().filter(|dataset| !leaf(dataset.name()).starts_with('#')) {
        variables.push((leaf(dataset.name()).to_owned(), reader.dataset(dataset, 0)?));
    }
    variables.sort_by(|(a, _), (b, _)| a.cmp(b));
    Ok(variables)
}

/// The last part of a path.
fn leaf(name: &str) -> &str {
    name.trim_end_matches('/').rsplit('/').next().unwrap_or(name)
}

enum Object {
    Group(Group),
    Dataset(Box<Dataset>),
}

struct Reader {
    /// What cells and structure arrays refer to, by address.
    referred: BTreeMap<u64, Object>,
    left: usize,
}

impl Reader {
    fn enter(&mut self, depth: usize) -> Result<(), ImportError> {
        self.left = self.left.checked_sub(1).ok_or_else(|| hdf5("more than 200,000 values"))?;
        if depth > DEEPEST { Err(hdf5("structures nested more than 32 deep")) } else { Ok(()) }
    }

    fn group(&mut self, group: &Group, depth: usize) -> Result<Value, ImportError> {
        self.enter(depth)?;
        let (groups, datasets) = group.members().map_err(hdf5)?;
        let mut fields = Vec::new();
        for inner in &groups {
            fields.push((leaf(inner.name()).to_owned(), self.group(inner, depth + 1)?));
        }
        for inner in &datasets {
            fields.push((leaf(inner.name()).to_owned(), self.dataset(inner, depth + 1)?));
        }
        fields.sort_by(|(a, _), (b, _)| a.cmp(b));
        Ok(Value::Structs(vec![fields]))
    }

    fn dataset(&mut self, dataset: &Dataset, depth: usize) -> Result<Value, ImportError> {
        self.enter(depth)?;
        let attribute = |name: &str| dataset.attribute(name).ok();
        let class = attribute("MATLAB_class").and_then(|class| class.read_string().ok()).unwrap_or_default();
        let class = class.trim_end_matches('\0').to_owned();
        if attribute("MATLAB_empty")
            .and_then(|empty| empty.read_as_f64().ok())
            .is_some_and(|empty| empty != 0.0)
        {
            return Ok(match class.as_str() {
                "char" => Value::Text(vec![String::new()]),
                "cell" => Value::Cells(Vec::new()),
                "struct" => Value::Structs(Vec::new()),
                _ => Value::Numbers { dims: vec![0, 0], re: Vec::new(), im: None },
            });
        }
        let dims: Vec<usize> =
            dataset.shape().iter().rev().map(|dim| usize::try_from(*dim).unwrap_or(usize::MAX)).collect();
        match dataset.dtype().clone() {
            Datatype::Reference { .. } => self.references(dataset, depth),
            Datatype::Compound { size, fields } => {
                let [real, imaginary] = fields.as_slice() else { return Ok(Value::Other("compound value")) };
                let bytes = dataset.read_native_bytes().map_err(hdf5)?;
                let re = strided(&bytes, &real.datatype, size as usize, real.byte_offset as usize);
                let im = strided(&bytes, &imaginary.datatype, size as usize, imaginary.byte_offset as usize);
                Ok(match (re, im) {
                    (Some(re), Some(im)) if fills(&dims, &re) => Value::Numbers { dims, re, im: Some(im) },
                    _ => Value::Other("compound value"),
                })
            }
            datatype => {
                let Some(size) = size_of(&datatype) else { return Ok(Value::Other("value of another type")) };
                let bytes = dataset.read_native_bytes().map_err(hdf5)?;
                let Some(re) = strided(&bytes, &datatype, size, 0) else {
                    return Ok(Value::Other("value of another type"));
                };
                Ok(match class.as_str() {
                    "char" => Value::Text(rows(&re, dims.first().copied().unwrap_or(1))),
                    _ if fills(&dims, &re) => Value::Numbers { dims, re, im: None },
                    _ => Value::Other("array of another size than stated"),
                })
            }
        }
    }

    fn references(&mut self, dataset: &Dataset, depth: usize) -> Result<Value, ImportError> {
        let bytes = dataset.read_raw_bytes().map_err(hdf5)?;
        let mut cells = Vec::new();
        for address in bytes.as_chunks::<8>().0.iter().map(|bytes| u64::from_le_bytes(*bytes)) {
            // Taken out while it is read: a circle finds nothing.
            let value = match self.referred.remove(&address) {
                None => Value::Other("reference to nothing"),
                Some(object) => {
                    let value = match &object {
                        Object::Group(group) => self.group(group, depth + 1),
                        Object::Dataset(dataset) => self.dataset(dataset, depth + 1),
                    };
                    self.referred.insert(address, object);
                    value?
                }
            };
            cells.push(value);
        }
        Ok(Value::Cells(cells))
    }
}

/// Whether there are as many numbers as the dimensions say.
fn fills(dims: &[usize], numbers: &[f64]) -> bool {
    dims.iter().try_fold(1_usize, |product, dim| product.checked_mul(*dim)) == Some(numbers.len())
}

/// Bytes of one number.
fn size_of(datatype: &Datatype) -> Option<usize> {
    match datatype {
        Datatype::FixedPoint { size, .. } | Datatype::FloatingPoint { size, .. } => Some(*size as usize),
        _ => None,
    }
}

/// Every number of `datatype` at `offset` in strides of `stride` bytes, native byte order.
fn strided(bytes: &[u8], datatype: &Datatype, stride: usize, offset: usize) -> Option<Vec<f64>> {
    let size = size_of(datatype)?;
    if stride == 0 {
        return None;
    }
    let signed = matches!(datatype, Datatype::FixedPoint { signed: true, .. });
    let floating = matches!(datatype, Datatype::FloatingPoint { .. });
    let one = |bytes: &[u8]| -> Option<f64> {
        Some(match (floating, size, signed) {
            (true, 4, _) => f32::from_ne_bytes(bytes.try_into().ok()?).into(),
            (true, 8, _) => f64::from_ne_bytes(bytes.try_into().ok()?),
            (false, 1, true) => i8::from_ne_bytes(bytes.try_into().ok()?).into(),
            (false, 1, false) => u8::from_ne_bytes(bytes.try_into().ok()?).into(),
            (false, 2, true) => i16::from_ne_bytes(bytes.try_into().ok()?).into(),
            (false, 2, false) => u16::from_ne_bytes(bytes.try_into().ok()?).into(),
            (false, 4, true) => i32::from_ne_bytes(bytes.try_into().ok()?).into(),
            (false, 4, false) => u32::from_ne_bytes(bytes.try_into().ok()?).into(),
            (false, 8, true) => i64::from_ne_bytes(bytes.try_into().ok()?) as f64,
            (false, 8, false) => u64::from_ne_bytes(bytes.try_into().ok()?) as f64,
            _ => return None,
        })
    };
    let at = |element: &[u8]| element.get(offset..offset.checked_add(size)?).and_then(one);
    bytes.chunks_exact(stride).map(at).collect()
}

/// Rows of a matrix of characters, stored column after column.
fn rows(codes: &[f64], rows: usize) -> Vec<String> {
    let decoded = |row: usize| {
        let codes = codes.iter().skip(row).step_by(rows.max(1)).map(|code| *code as u16);
        let text: String =
            char::decode_utf16(codes).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
        text.trim_end().to_owned()
    };
    (0..rows.min(codes.len())).map(decoded).collect()
}
