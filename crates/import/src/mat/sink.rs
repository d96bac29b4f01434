//! What is read of a MATLAB file goes here.

use crate::ColumnMap;
use jointscope_uff::UffFile;
use std::collections::BTreeSet;

/// Where functions go, and what the analyst says of them.
pub(super) struct Sink<'a> {
    pub file_name: &'a str,
    pub map: &'a ColumnMap,
    pub used: &'a mut BTreeSet<usize>,
    pub file: UffFile,
}
