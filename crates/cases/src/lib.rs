//! Many tests at once: lists of cases, shares of them for the jobs of a cluster, and what came of each in one
//! table.
//!
//! A [`Case`] is a fixture and the recordings of one test of it. [`listed`] reads cases from a list,
//! [`of_folders`] makes them of folders, [`Shard`] takes a share. A [`Summary`] has a row a case, made of
//! what `diagnosis.json` or `stiffness.json` says of it, and is written as CSV. This crate reads and writes
//! no files.
//!
//! ```
//! use jointscope_cases::{Shard, listed};
//!
//! let cases = listed("# one fixture, two specimens\nblocks.json, day1/a.uff\nblocks.json, day1/b.uff, day1/b2.uff\n")?;
//! let names: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
//! assert_eq!(names, ["a", "b"]);
//! let second: Shard = "2/2".parse()?;
//! assert!(second.has(1) && !second.has(0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod case;
mod decomposed;
mod diagnosed;
mod shard;
mod summary;

pub use case::{Case, CasesError, FolderOfFiles, listed, of_folders};
pub use decomposed::DecomposedCase;
pub use diagnosed::{DiagnosedCase, FindingRow};
pub use shard::{Shard, ShardError};
pub use summary::{Command, Row, State, Summary};
