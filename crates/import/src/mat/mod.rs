//! MATLAB files: which of their variables are FRFs.
//!
//! **Simcenter Testlab** exports a structure a block of functions (`FRF`, `Signal`, …), of which is read:
//!
//! | field | what |
//! |---|---|
//! | `x_values.start_value`, `.increment`, `.number_of_values` (or `.values`) | the lines |
//! | `x_values.quantity.label` | their unit, `Hz` |
//! | `y_values.values` | one function a column |
//! | `y_values.quantity.label`, `.unit_transformation.factor` | values times the factor are in the unit of the label: they are stored in SI and shown, say, in g/N |
//! | `function_record.name` | a name a column, such as `FRF 4:+Z/1:+Z`: the FRF, where it names nodes |
//!
//! **Plain arrays**: complex values as long as a vector named `f`, `freq`, `frequency` or `frequencies` (in
//! Hz; `omega` in rad/s) beside them, at the top or within a structure. `H_4_1`, `frf_4_1` is the FRF 4/1;
//! any other name is given its FRF by a [`ColumnMap`]: `H=4/1 [m/s^2/N]`, or `H(2)=3/1` and `H(2,1)=3/1` for
//! the columns and slices of a matrix.

mod arrays;
mod sink;
mod testlab;
mod v5;
mod v73;
mod value;

use std::collections::BTreeSet;

use jointscope_uff::UffFile;

use crate::{ColumnMap, Format, ImportError};
use sink::Sink;

/// Reads the FRFs of a MATLAB file.
pub(crate) fn read(
    bytes: &[u8],
    format: Format,
    name: &str,
    map: &ColumnMap,
    used: &mut BTreeSet<usize>,
) -> Result<UffFile, ImportError> {
    let variables = match format {
        Format::Mat73 => v73::read(bytes)?,
        _ => v5::read(bytes)?,
    };
    let mut sink = Sink { file_name: name, map, used, file: UffFile::default() };
    let (exported, plain): (Vec<_>, Vec<_>) =
        variables.iter().partition(|(_, value)| testlab::is_block(value));
    for (variable, value) in exported {
        testlab::read(variable, value, &mut sink)?;
    }
    arrays::read("", &plain, &mut sink)?;
    if sink.file.datasets.is_empty() {
        let held: Vec<String> =
            variables.iter().take(12).map(|(name, value)| format!("`{name}`, {}", value.what())).collect();
        let held = if held.is_empty() { "no variable".to_owned() } else { held.join("; ") };
        return Err(ImportError::NoFrfInMat(held));
    }
    Ok(sink.file)
}
