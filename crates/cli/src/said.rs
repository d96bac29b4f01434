//! What a command has to say when it is done.

/// What a command has to say when it is done.
pub(crate) struct Said {
    /// For standard output, without the last line end.
    pub text: String,
    /// Whether all is done that was asked.
    pub whole: bool,
}

impl From<String> for Said {
    fn from(text: String) -> Self {
        Said { text, whole: true }
    }
}
