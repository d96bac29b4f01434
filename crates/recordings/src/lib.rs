//! What a set of universal files says of a test, in the fixture's terms and SI units.
//!
//! The files' nodes and directions become the fixture's points, y and θ; signs of directions are folded into
//! the values; data types and units, never a guess, decide what a function is. Several files are one test,
//! and the order of their datasets means nothing.
//!
//! * [`Recording`]: the FRFs of each level as accelerances in SI units, with coherence and averages where
//!   they were recorded;
//! * [`hits_of`]: the hammer hits among the time histories, force and responses in SI units;
//! * [`Recording::of_nodes`]: the same of a structure that no fixture file describes, its points the files'
//!   nodes;
//! * [`Contents`]: what files hold, FRFs or not;
//! * [`Geometry`]: the files' nodes in global axes and metres, as points of a fixture along one of them;
//! * [`ReadOptions`]: what the files do not say and the analyst does, a [`ChannelMap`] and [`AssumedUnits`];
//! * [`hits_to_datasets`]: time histories as functions of a universal file;
//! * [`to_datasets`]: FRFs as functions of a universal file;
//! * [`RecordingError`]: one plain sentence each, naming file, function and remedy.
//!
//! No file is opened here: the caller brings what [`jointscope_uff`] read. Variances are not made up here
//! either.
//!
//! ```
//! use jointscope_fixture::Fixture;
//! use jointscope_recordings::{ReadOptions, Recording, Source, to_datasets};
//! use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
//! use jointscope_uff::{Encoding, UffFile};
//! use num_complex::Complex64;
//!
//! let fixture = Fixture::from_json(r#"{
//!   "bodies": { "A": { "mass": 2.0, "rotates": false } },
//!   "points": { "1": { "body": "A", "x": 0 } } }"#)?;
//! let lines = SpectralLines::even(2.5, 2.5, 2)?;
//! let mobility = vec![Complex64::new(0.0, -0.03), Complex64::new(0.0, -0.015)];
//! let pairs = vec![FrfPair::transverse("1", "1")];
//! let frfs = FrfSet::new(lines, FrfForm::Mobility, pairs, mobility)?;
//!
//! let mut datasets = to_datasets(&frfs, "one block", Encoding::default())?;
//! datasets[0].response.direction = -2;
//! let source = Source { name: "test.uff".into(), file: UffFile { datasets, ..UffFile::default() } };
//! let recording = Recording::of(&[source], &fixture, &ReadOptions::default())?;
//!
//! let accelerance = recording.frfs()?.values(0)[0];
//! let omega = 2.0 * std::f64::consts::PI * 2.5;
//! assert!((accelerance.re + 0.03 * omega).abs() < 1e-12); // measured along −y
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod assumed_units;
mod channel_map;
mod coherence;
mod common_lines;
mod completeness;
mod contents;
mod datasets;
mod error;
mod function;
mod gather;
mod geometry;
mod histories;
mod hits;
mod hits_error;
mod level;
mod nodes;
mod ordinate;
mod recording;
mod source;
mod unit;
mod units_error;

pub use assumed_units::{AssumedUnits, AssumedUnitsError};
pub use channel_map::{ChannelMap, ChannelMapError, FileChannel, MapEntry};
pub use contents::{Contents, FunctionKind, ModeShape};
pub use datasets::{DatasetsError, to_datasets};
pub use error::{FunctionError, FunctionPlace, RecordingError};
pub use geometry::{Geometry, GeometryError, PlacedNode, PointAlong, SpatialAxis};
pub use histories::hits_to_datasets;
pub use hits::{Hits, hits_of};
pub use hits_error::HitsError;
pub use level::HeldAmplitude;
pub use recording::{Level, ReadOptions, Recording, TimeHistories};
pub use source::Source;
pub use units_error::UnitsError;
