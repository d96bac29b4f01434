//! Self-contained report pages: text, figures of merit, tables, fixture drawings and interactive plots in one HTML file.
//!
//! A [`Page`] is put together from [`Section`]s and rendered to a `String`; this crate reads and writes no files. The page needs no network and cannot use
//! one: its Content-Security-Policy is `default-src 'none'`. Everything it shows is escaped, so names from fixture files may contain anything. The same
//! input gives the same bytes.
//!
//! | module | holds |
//! |---|---|
//! | [`Page`], [`Section`], [`Foot`] | the page and its parts |
//! | [`Verdict`], [`Card`], [`Table`], [`Cell`] | headline, key figures, tables |
//! | [`Plot`], [`Axis`], [`Role`], [`YRange`] | plots over spectral lines, with bands, gaps and reference lines |
//! | [`drawing`] | side view of a fixture as SVG |
//! | [`HeatMap`] | misfit by place and band, with its numbers |
//! | [`decomposition_page`], [`diagnosis_page`], [`comparison_page`], [`modes_page`], [`PageContext`] | the pages of a joint's decomposition, of a diagnosis, of joints side by side and of a modal analysis |
//! | [`proof_page`], [`ProofContext`] | the page of concealed cases: what the diagnosis is worth |
//! | [`format`](mod@format), [`Scale`] | numbers with uncertainty, units with SI prefix |
//!
//! ```
//! use jointscope_report::{Axis, Card, Foot, Page, Plot, Role, Section, Verdict};
//!
//! let frequency: Vec<f64> = (200..900).map(f64::from).collect();
//! let stiffness = frequency.iter().map(|f| if *f == 310.0 { None } else { Some(3.3e6 + 40.0 * f) });
//!
//! let html = Page::new("Joint J: two blocks and a beam")
//!     .verdict(Verdict::ok("The transverse stiffness is 3.32 MN/m."))
//!     .section(
//!         Section::new("Stiffness")
//!             .cards([Card::quantity("k₁₁", 3.32e6, 2.0e4, "N/m").note("nominal 3.31 MN/m")])
//!             .plot(
//!                 Plot::new("Transverse stiffness", Axis::frequency(), Axis::linear("k₁₁", "N/m"))
//!                     .over(&frequency)
//!                     .line("measured", Role::Measured, stiffness)
//!                     .horizontal("nominal", Role::Nominal, 3.31e6)
//!                     .caption("The measured stiffness stays close to the nominal one."),
//!             ),
//!     )
//!     .foot(Foot::new("jointscope 0.1.0").command("jointscope decompose rig.json rig.uff -o out"))
//!     .to_html()?;
//! assert!(html.contains("3.320 ± 0.020"));
//! # Ok::<(), jointscope_report::PageError>(())
//! ```
//!
//! Plots are drawn by [uPlot](https://github.com/leeoniya/uPlot) 1.6.32 (MIT, its licence is part of every page), embedded as published: 51 KB, maintained, and fast enough
//! that panes of many thousand spectral lines zoom and move together without delay, where general plotting libraries would add megabytes to each report or load
//! themselves from a server.

mod comparison_page;
mod context;
mod decomposition_page;
mod diagnosis_page;
pub mod drawing;
mod elements;
mod error;
mod force_state;
pub mod format;
mod hammer_test;
mod heat_map;
mod hits_page;
mod html;
mod modes_page;
mod page;
mod phase;
mod plot;
mod proof_page;
mod scatter;
mod section;
mod stepped_page;
mod unit;

pub use comparison_page::comparison_page;
pub use context::{HammerTest, InputFile, PageContext};
pub use decomposition_page::decomposition_page;
pub use diagnosis_page::diagnosis_page;
pub use drawing::{FixtureDrawing, Svg};
pub use elements::{Card, Cell, Column, Table, Tone, Verdict};
pub use error::PageError;
pub use heat_map::HeatMap;
pub use hits_page::hits_page;
pub use modes_page::modes_page;
pub use page::{Foot, Page};
pub use plot::{Axis, Ordinate, Plot, Role, Spacing, YRange, kept_lines};
pub use proof_page::{ProofContext, ProofResults, proof_page};
pub use section::Section;
pub use stepped_page::stepped_page;
pub use unit::{Scale, typeset};
