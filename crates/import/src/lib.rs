//! Recordings in other formats than universal files: CSV tables and MATLAB files in, functions of a universal
//! file out.
//!
//! [`read()`] tells the format by the bytes ([`Format`]) and hands back what a universal file of the same
//! FRFs would hold, so that everything behind it (units, directions, maps) is the same for all formats. It
//! opens no file.
//!
//! | format | what is an FRF |
//! |---|---|
//! | universal file | see [`jointscope_uff`] |
//! | CSV | columns `4/1 real` and `4/1 imag`, or `4/1 magnitude` and `4/1 phase [deg]`, beside a column `frequency [Hz]`; see [`csv`](mod@crate::csv) |
//! | MATLAB v5, v7, v7.3 | a structure as Simcenter Testlab exports it, or an array of complex values beside one of frequencies; see [`mat`] |
//!
//! Names that say nothing of nodes are given their FRF by a [`ColumnMap`], such as `H1=4/1 [m/s^2/N]`. Units
//! are those of the file or of the map; where neither states any, the unit label stays blank and whoever
//! reads the function asks for it.
//!
//! # Example: one FRF of a table
//! ```
//! use jointscope_import::{ColumnMap, Format, read};
//!
//! let table = b"frequency [Hz];4/1 real [m/s^2/N];4/1 imag [m/s^2/N]\n10;0,91;-0,12\n12,5;1,08;-0,33\n";
//! let imported = read(table, "frf.csv", &ColumnMap::default())?;
//! assert_eq!(imported.format, Format::Table);
//! let frf = &imported.file.datasets[0];
//! assert_eq!((frf.response.number, frf.reference.number), (4, 1));
//! assert_eq!(frf.abscissa.value(1), 12.5);
//! assert_eq!(frf.ordinate_axis.units, "m/s^2/N");
//! # Ok::<(), jointscope_import::ImportError>(())
//! ```

pub mod csv;
mod error;
mod format;
mod function;
mod map;
pub mod mat;
mod pair;

use std::collections::BTreeSet;

pub use error::ImportError;
pub use format::Format;
pub use map::{ColumnEntry, ColumnMap, ColumnMapError};
pub(crate) use pair::ChannelPair;
pub use pair::PairError;

use jointscope_uff::UffFile;

/// What a file holds, whatever its format.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// Its format.
    pub format: Format,
    /// Its functions.
    pub file: UffFile,
    /// Which entries of the map were of use, by position.
    pub used: BTreeSet<usize>,
}

/// Reads a recording of any format; `name` is the file's, by which entries of the map may speak of it.
///
/// # Errors
/// An [`ImportError`]: one plain sentence with place and remedy.
pub fn read(bytes: &[u8], name: &str, map: &ColumnMap) -> Result<Imported, ImportError> {
    let format = Format::of(bytes)?;
    let mut used = BTreeSet::new();
    let file = match format {
        Format::Universal => jointscope_uff::read(bytes)?,
        Format::Table => csv::read(bytes, name, map, &mut used)?,
        Format::Mat5 | Format::Mat73 => mat::read(bytes, format, name, map, &mut used)?,
    };
    Ok(Imported { format, file, used })
}
