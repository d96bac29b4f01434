//! FRFs with coherence as universal files.

use jointscope_recordings::{DatasetsError, to_datasets};
use jointscope_spectra::FrfSet;
pub use jointscope_uff::Precision;
use jointscope_uff::{Encoding, WriteError, write};

/// Why a recording cannot be written to a universal file.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// A point whose name is no node number.
    #[error(transparent)]
    Datasets(#[from] DatasetsError),
    /// Values that the format cannot hold.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// The FRFs, each followed by its coherence where it has one, as 58b datasets of the given precision; `title`
/// is the first ID line.
///
/// # Errors
/// A point that is no node number, values that the format cannot hold.
pub fn to_bytes(title: &str, set: &FrfSet, precision: Precision) -> Result<Vec<u8>, FileError> {
    let mut datasets = to_datasets(set, title, Encoding::default())?;
    datasets.iter_mut().for_each(|dataset| dataset.precision = precision);
    Ok(write(&datasets)?)
}
