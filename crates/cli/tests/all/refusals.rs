//! The built program on recordings, fixtures and joints that do not go together: one plain sentence with
//! file, place and remedy, status 2, nothing written. What goes wrong within one file, by the hundred, is in
//! `bad_inputs`.

mod diagnoses;
mod files;
mod fixtures;
mod joints;
mod recordings;

const LINES: &str = "50:1000:5";
