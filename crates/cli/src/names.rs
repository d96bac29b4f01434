//! What files are called in messages.

use std::path::{Path, PathBuf};

/// The files' names for a message about all of them.
pub(crate) fn names(files: &[PathBuf]) -> String {
    files.iter().map(|path| name(path)).collect::<Vec<_>>().join(", ")
}

/// A file's name in messages; `-` is standard input.
pub(crate) fn name(path: &Path) -> String {
    if is_standard_input(path) { "standard input".to_owned() } else { path.display().to_string() }
}

/// Whether a path means standard input.
pub(crate) fn is_standard_input(path: &Path) -> bool {
    path.as_os_str() == "-"
}
