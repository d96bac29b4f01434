//! Universal files (UFF, UNV), the exchange format of experimental modal analysis: bytes in, typed functions
//! out, and back.
//!
//! A universal file is a row of datasets between `    -1` lines. This crate reads and writes **dataset 58**
//! (a function at a nodal degree of freedom: an FRF, a coherence, a time history) in its ASCII form and its
//! binary form **58b**, with the **dataset 164** (units) in force. It reads the geometry (**15**, **2411**
//! nodes, **18**, **2420** coordinate systems, **2412** elements, **82** trace lines), mode shapes
//! (**55**, **2414**) and the header (**151**). Every other dataset is skipped and counted. It opens no file:
//! the caller brings the bytes.
//!
//! | module of the docs | holds |
//! |---|---|
//! | [`read()`] → [`UffFile`] | all functions of a file, in file order, and what was skipped |
//! | [`write()`] | the bytes of a file holding the given functions |
//! | [`Nodes`], [`CoordinateSystem`], [`Element`], [`TraceLine`] | the geometry, with the layout of its datasets |
//! | [`NodalData`] | mode shapes and other data at nodes |
//! | [`Dataset58`] | one function: nodes, abscissa, axes, data, and how it is stored |
//! | [`Axis`], [`data_type`] | what a quantity is (acceleration, excitation force, …) and its unit exponents |
//! | [`Units`] | how to bring a file's values to SI |
//! | [`ReadError`], [`WriteError`] | one plain sentence each: where, what was expected, what was found |
//!
//! # Example: an accelerance, written and read back
//! ```
//! use jointscope_uff::{Abscissa, Axis, Data, Dataset58, FunctionType, Node, read, write};
//! use num_complex::Complex64;
//!
//! let accelerance = vec![Complex64::new(0.9, -0.1), Complex64::new(1.1, -0.3)];
//! let frf = Dataset58 {
//!     function: FunctionType::FrequencyResponse,
//!     response: Node::new(4, 2),
//!     reference: Node::new(1, 2),
//!     abscissa_axis: Axis::frequency(),
//!     ordinate_axis: Axis::acceleration(),
//!     denominator_axis: Axis::excitation_force(),
//!     ..Dataset58::new(
//!         Abscissa::Even { start: 10.0, step: 2.5, count: 2 },
//!         Data::Complex(accelerance),
//!     )
//! };
//! let bytes = write(std::slice::from_ref(&frf))?;
//! let file = read(&bytes)?;
//! assert_eq!(file.datasets, [frf]);
//! assert_eq!(file.datasets[0].abscissa.value(1), 12.5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What is lenient and what is not
//! Records are read by their columns, and where the columns do not fit, by their blanks: fields that touch,
//! columns that are off, short lines, CRLF, Fortran `D` exponents and exponents without a letter
//! (`1.00000-100`) are all in circulation. Binary byte counts are often wrong (half of the truth for complex
//! data), so the number of points decides and the closing `    -1` proves it. Nothing is guessed beyond that:
//! a value that is missing, not a number or not finite is a [`ReadError`]. An ASCII function that is closed
//! in good order but holds fewer whole points than its header states is read with what there is and says so
//! ([`Dataset58::stated_points`]): whoever needs it must refuse it, who does not need it can leave it aside.
//!
//! # Uneven abscissae in double precision
//! The specification keeps the abscissa of double-precision data in single precision (`E13.5` beside
//! `E20.12`). ASCII follows it. In binary [`write()`] stores abscissa and ordinate both as doubles, which
//! loses nothing and is what other programs (pyuff) write and expect; [`read()`] takes either layout, told
//! apart by where the closing `    -1` stands.

mod abscissa;
mod axis;
mod dataset;
mod function_type;
mod geometry;
mod nodal;
mod read;
mod read_error;
mod units;
mod write;

pub use abscissa::Abscissa;
pub use axis::{Axis, data_type};
pub use dataset::{ByteOrder, Data, Dataset58, Encoding, Node, Precision, UffFile, Unreadable};
pub use function_type::FunctionType;
pub use geometry::{CoordinateSystem, Element, GridPoint, Header, Nodes, SystemKind, TraceLine};
pub use nodal::{Analysis, NodalData, NodeValues, ValueLocation};
pub use read::read;
pub use read_error::{BinaryProblem, ReadError, TextProblem};
pub use units::{TemperatureMode, Units};
pub use write::{WriteError, WriteProblem, write};
