//! MATLAB's MAT-file, level 5: versions 5, 6 and 7 (`-v7` is compressed), after MathWorks' *MAT-File Format*,
//! chapter 1.
//!
//! A header of 128 bytes, then data elements: a tag of type and length, and the bytes, padded to eight. An
//! array is an element that holds elements: flags, dimensions, name, values. Every length is checked against
//! the bytes there are.

use std::io::Read;

use flate2::read::ZlibDecoder;

use super::value::Value;
use crate::ImportError;

/// Arrays in arrays: deeper than anybody nests structures.
const DEEPEST: usize = 32;
/// What the compressed variables of a file may grow to together, in bytes.
const LARGEST: u64 = 1 << 30;

const MI_MATRIX: u32 = 14;
const MI_COMPRESSED: u32 = 15;

/// Reads all variables with their names.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<(String, Value)>, ImportError> {
    let big_endian = match bytes.get(126..128) {
        Some(b"IM") => false,
        Some(b"MI") => true,
        _ => return Err(damaged(126, "no mark of the byte order in the header of the MAT-file")),
    };
    let mut elements = Elements { bytes, position: 128, base: 0, big_endian };
    let (mut variables, mut left) = (Vec::new(), LARGEST);
    while let Some(element) = elements.next()? {
        match element.kind {
            MI_MATRIX => variables.push(array(element.inner(big_endian), 0)?),
            MI_COMPRESSED => {
                let mut inflated = Vec::new();
                let decoded = ZlibDecoder::new(element.bytes).take(left + 1).read_to_end(&mut inflated);
                let why = match decoded {
                    Ok(size) if size as u64 > left => {
                        Some("compressed variables of more than 1 GiB together".to_owned())
                    }
                    Ok(size) => {
                        left -= size as u64;
                        None
                    }
                    Err(error) => Some(format!("a compressed variable cannot be unpacked ({error})")),
                };
                if let Some(why) = why {
                    return Err(damaged(element.offset, why));
                }
                // Places in an unpacked variable are told as that of its first byte in the file.
                let mut inner = Elements { bytes: &inflated, position: 0, base: element.offset, big_endian };
                if let Some(inner) = inner.next()?.filter(|inner| inner.kind == MI_MATRIX) {
                    variables.push(array(inner.inner(big_endian), 0)?);
                }
            }
            _ => {}
        }
    }
    Ok(variables)
}

fn damaged(offset: usize, what: impl Into<String>) -> ImportError {
    ImportError::Damaged { offset, what: what.into() }
}

/// A run of data elements.
struct Elements<'a> {
    bytes: &'a [u8],
    position: usize,
    /// Offset of the first byte in the file.
    base: usize,
    big_endian: bool,
}

struct Element<'a> {
    kind: u32,
    bytes: &'a [u8],
    offset: usize,
}

impl<'a> Element<'a> {
    fn inner(&self, big_endian: bool) -> Elements<'a> {
        Elements { bytes: self.bytes, position: 0, base: self.offset, big_endian }
    }
}

impl<'a> Elements<'a> {
    fn offset(&self) -> usize {
        self.base.saturating_add(self.position)
    }

    fn word(&self, at: usize) -> Option<u32> {
        let bytes = self.bytes.get(at..at.checked_add(4)?)?.try_into().ok()?;
        Some(if self.big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) })
    }

    /// The next element, or nothing at the end.
    fn next(&mut self) -> Result<Option<Element<'a>>, ImportError> {
        if self.position >= self.bytes.len() {
            return Ok(None);
        }
        let offset = self.offset();
        let cut = || damaged(offset, "the file ends within a data element");
        let tag = self.word(self.position).ok_or_else(cut)?;
        // A small element has its length in the upper half of the tag's first word and its bytes in the
        // second.
        let (kind, length, start, whole) = match tag >> 16 {
            0 => {
                let length = self.word(self.position + 4).ok_or_else(cut)? as usize;
                let padding = if tag == MI_COMPRESSED { 0 } else { (8 - length % 8) % 8 };
                (tag, length, self.position + 8, length.saturating_add(padding))
            }
            length @ 1..=4 => (tag & 0xffff, length as usize, self.position + 4, 4),
            _ => return Err(damaged(offset, "a data element of impossible length")),
        };
        let end = start.checked_add(length).filter(|end| *end <= self.bytes.len()).ok_or_else(cut)?;
        // The padding of the last element may be missing.
        self.position = start.saturating_add(whole).min(self.bytes.len());
        Ok(Some(Element { kind, bytes: &self.bytes[start..end], offset }))
    }

    /// The next element; an array without it is damaged.
    fn required(&mut self, what: &str) -> Result<Element<'a>, ImportError> {
        let offset = self.offset();
        self.next()?.ok_or_else(|| damaged(offset, format!("an array without {what}")))
    }
}

/// The values of an element as doubles.
fn numbers(element: &Element, big_endian: bool) -> Result<Vec<f64>, ImportError> {
    fn all<const N: usize>(bytes: &[u8], big_endian: bool, value: impl Fn([u8; N]) -> f64) -> Vec<f64> {
        let ordered = |mut bytes: [u8; N]| {
            if big_endian {
                bytes.reverse();
            }
            value(bytes)
        };
        bytes.as_chunks::<N>().0.iter().map(|bytes| ordered(*bytes)).collect()
    }
    let bytes = element.bytes;
    Ok(match element.kind {
        1 => all(bytes, big_endian, |b| i8::from_le_bytes(b).into()),
        2 => all(bytes, big_endian, |b| u8::from_le_bytes(b).into()),
        3 => all(bytes, big_endian, |b| i16::from_le_bytes(b).into()),
        4 => all(bytes, big_endian, |b| u16::from_le_bytes(b).into()),
        5 => all(bytes, big_endian, |b| i32::from_le_bytes(b).into()),
        6 => all(bytes, big_endian, |b| u32::from_le_bytes(b).into()),
        7 => all(bytes, big_endian, |b| f32::from_le_bytes(b).into()),
        9 => all(bytes, big_endian, f64::from_le_bytes),
        12 => all(bytes, big_endian, |b| i64::from_le_bytes(b) as f64),
        13 => all(bytes, big_endian, |b| u64::from_le_bytes(b) as f64),
        kind => return Err(damaged(element.offset, format!("numbers of the unknown type {kind}"))),
    })
}

/// An array with its name.
fn array(mut elements: Elements, depth: usize) -> Result<(String, Value), ImportError> {
    // An empty array may be an element without bytes.
    let Some(flags) = elements.next()? else {
        return Ok((String::new(), Value::Numbers { dims: vec![0, 0], re: Vec::new(), im: None }));
    };
    let big_endian = elements.big_endian;
    if depth > DEEPEST {
        return Err(damaged(flags.offset, "arrays nested more than 32 deep"));
    }
    let word =
        flags.inner(big_endian).word(0).ok_or_else(|| damaged(flags.offset, "an array without flags"))?;
    let (class, complex) = (word & 0xff, word & 0x0800 != 0);
    // Objects of newer classes and functions have a layout of their own.
    if matches!(class, 16 | 17) {
        return Ok((String::new(), Value::Other("object")));
    }
    let dims = dimensions(&elements.required("dimensions")?, big_endian)?;
    let count = dims.iter().try_fold(1_usize, |product, dim| product.checked_mul(*dim));
    let count = count.ok_or_else(|| damaged(flags.offset, "an array of impossible size"))?;
    let name = latin(elements.required("a name")?.bytes);
    let value = match class {
        1 => cells(&mut elements, count, depth)?,
        2 => structs(&mut elements, count, depth)?,
        3 => {
            let _class_name = elements.required("a class name")?;
            structs(&mut elements, count, depth)?
        }
        4 => text(&elements.required("text")?, &dims, big_endian)?,
        5 => Value::Other("sparse matrix"),
        6..=15 => {
            let re = exactly(&elements.required("values")?, count, big_endian)?;
            let im = match complex {
                true => Some(exactly(&elements.required("imaginary parts")?, count, big_endian)?),
                false => None,
            };
            Value::Numbers { dims, re, im }
        }
        _ => Value::Other("value of an unknown class"),
    };
    Ok((name, value))
}

fn dimensions(element: &Element, big_endian: bool) -> Result<Vec<usize>, ImportError> {
    let numbers = numbers(element, big_endian)?;
    if numbers.len() < 2 || numbers.len() > 32 || numbers.iter().any(|dim| *dim < 0.0) {
        return Err(damaged(element.offset, "an array without two dimensions"));
    }
    Ok(numbers.into_iter().map(|dim| dim as usize).collect())
}

fn exactly(element: &Element, count: usize, big_endian: bool) -> Result<Vec<f64>, ImportError> {
    let found = numbers(element, big_endian)?;
    match found.len() == count {
        true => Ok(found),
        false => {
            Err(damaged(element.offset, format!("{} values where its dimensions need {count}", found.len())))
        }
    }
}

fn cells(elements: &mut Elements, count: usize, depth: usize) -> Result<Value, ImportError> {
    let mut cells = Vec::new();
    for _ in 0..count {
        cells.push(inner_array(elements, depth)?);
    }
    Ok(Value::Cells(cells))
}

fn inner_array(elements: &mut Elements, depth: usize) -> Result<Value, ImportError> {
    let element = elements.required("its elements")?;
    if element.kind != MI_MATRIX {
        return Err(damaged(element.offset, "an array of arrays that holds something else"));
    }
    Ok(array(element.inner(elements.big_endian), depth + 1)?.1)
}

fn structs(elements: &mut Elements, count: usize, depth: usize) -> Result<Value, ImportError> {
    let big_endian = elements.big_endian;
    let length = elements.required("the length of its field names")?;
    let width = numbers(&length, big_endian)?.first().map_or(0, |width| *width as usize);
    let names = elements.required("its field names")?;
    if width == 0 && !names.bytes.is_empty() {
        return Err(damaged(length.offset, "field names of no length"));
    }
    let names: Vec<String> = names.bytes.chunks(width.max(1)).map(latin).collect();
    let mut all = Vec::new();
    // Elements without fields hold nothing that their number could be checked against.
    for _ in 0..if names.is_empty() { 0 } else { count } {
        let mut fields = Vec::new();
        for name in &names {
            fields.push((name.clone(), inner_array(elements, depth)?));
        }
        all.push(fields);
    }
    Ok(Value::Structs(all))
}

/// Text in a matrix of characters: its rows, read across the columns.
fn text(element: &Element, dims: &[usize], big_endian: bool) -> Result<Value, ImportError> {
    let characters: Vec<char> = match element.kind {
        16 => String::from_utf8_lossy(element.bytes).chars().collect(),
        // UTF-16 and UTF-32 as plain numbers.
        17 => utf16(numbers(&Element { kind: 4, ..*element }, big_endian)?),
        4 => utf16(numbers(element, big_endian)?),
        18 => utf32(numbers(&Element { kind: 6, ..*element }, big_endian)?),
        _ => utf32(numbers(element, big_endian)?),
    };
    let rows = dims.first().copied().unwrap_or(0).max(1);
    if rows == 1 {
        return Ok(Value::Text(vec![characters.into_iter().collect::<String>().trim_end().to_owned()]));
    }
    let row =
        |row: usize| characters.iter().skip(row).step_by(rows).collect::<String>().trim_end().to_owned();
    // A row without characters is none.
    Ok(Value::Text((0..rows.min(characters.len())).map(row).collect()))
}

fn utf16(codes: Vec<f64>) -> Vec<char> {
    let codes = codes.into_iter().map(|code| code as u16);
    char::decode_utf16(codes).map(|decoded| decoded.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
}

fn utf32(codes: Vec<f64>) -> Vec<char> {
    codes.into_iter().map(|code| char::from_u32(code as u32).unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
}

fn latin(bytes: &[u8]) -> String {
    bytes.iter().take_while(|byte| **byte != 0).map(|byte| char::from(*byte)).collect()
}
