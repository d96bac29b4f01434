//! What a writer makes for its program.

/// A program's text without its header, and what the header has to say of it.
pub(crate) struct Body {
    pub text: String,
    pub notes: Vec<String>,
}
