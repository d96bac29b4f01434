//! A universal file among the files of a test.

use jointscope_uff::UffFile;

/// A universal file and the name it goes by in messages.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// Name for messages, usually the file's.
    pub name: String,
    /// What it holds.
    pub file: UffFile,
}
