//! Self-contained report pages: verdict, figures of merit, tables, fixture drawings and interactive plots in
//! one HTML file.
//!
//! A page takes what a library found and a [`PageContext`]; this crate reads and writes no files, and a page
//! shows decisions rather than taking any. The page needs no network and cannot use one: its
//! Content-Security-Policy is `default-src 'none'`. Everything it shows is escaped, so names from fixture
//! files may contain anything. The same input gives the same bytes.
//!
//! | page | of |
//! |---|---|
//! | [`decomposition_report`] | a joint's stiffness and damping by line and as an estimate |
//! | [`joint_report`] | the same, or several joints found at once |
//! | [`diagnosis_report`] | what a fixture leaves out |
//! | [`answer_report`] | the same, or what changes with amplitude: whichever the test answers |
//! | [`modes_report`] | natural frequencies, damping ratios, shapes |
//! | [`check_report`] | a fixture, and its recording before any diagnosis |
//! | [`comparison_report`] | joints side by side |
//! | [`summary_page`] | many cases, a row each |
//! | [`proof_page`] | concealed cases: what the diagnosis is worth |
//!
//! A [`Report`] is had as one HTML file ([`Report::html`]), its tables and curves as CSV, its figures as SVG;
//! the pages of many cases are HTML alone.
//!
//! Inside, a page is a list of sections (`section`) made of paragraphs, key figures, tables (`table`: one row
//! per item, a column for each question asked of it), plots (`plot`) and drawings (`drawing`, `scatter`).
//! [`format`](mod@format) prints numbers with their uncertainty.
//!
//! ```
//! use jointscope_report::format::quantity;
//! assert_eq!(quantity(3.32e6, 2.0e4, "N/m"), "3.320 ± 0.020 MN/m");
//! ```
//!
//! HTML and SVG are written by [maud](https://maud.lambda.xyz), which escapes every value. Plots are drawn by
//! [uPlot](https://github.com/leeoniya/uPlot) 1.6.32 (MIT, its licence is part of every page), embedded as
//! published: 51 KB, maintained, and fast enough that panes of many thousand spectral lines zoom and move
//! together without delay, where general plotting libraries would add megabytes to each report or load
//! themselves from a server.

mod answer_page;
mod check_page;
mod comparison_page;
mod context;
mod decomposition_page;
mod diagnosis_page;
mod drawing;
mod error;
mod force_state;
mod hammer_test;
mod hits_page;
mod input_file;
mod json;
mod mode_indicator;
mod modes_page;
mod page;
mod plan_page;
mod plot;
mod proof_page;
mod report;
mod scatter;
mod section;
mod stepped_page;
mod summary_page;
mod table;
#[cfg(test)]
mod tests;
mod tone;
mod weighed_page;

pub use jointscope_wording::format;
use jointscope_wording::unit;

pub use answer_page::answer_report;
pub use check_page::check_report;
pub use comparison_page::comparison_report;
pub use context::PageContext;
pub use decomposition_page::{decomposition_report, joint_report};
pub use diagnosis_page::diagnosis_report;
pub use error::PageError;
pub use input_file::InputFile;
pub use modes_page::modes_report;
pub use plan_page::plan_page;
pub use proof_page::{ProofContext, ProofResults, proof_page};
pub use report::{Report, ReportFile};
pub use summary_page::summary_page;
pub use weighed_page::weighed_page;
