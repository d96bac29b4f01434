//! Truths under seal: known by their hash, opened only against answers.

use crate::Truth;
use crate::sealable::{Filed, Given, Sealable};
use serde_json::Value;
use sha2::{Digest, Sha256};

/// Truths that cannot be read until the answers are there: [`SealedTruths::open`] asks for them.
///
/// What a truth says cannot be had of it in any other way:
///
/// ```compile_fail
/// # use jointscope_proof::Plan;
/// let (cases, sealed) = Plan::default().draw()?;
/// let peeked = &sealed.truths[0];
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct SealedTruths<T = Truth> {
    truths: Contents<T>,
    digest: String,
}

#[derive(Debug)]
enum Contents<T> {
    /// Drawn just now.
    Drawn(Vec<T>),
    /// A file's text, not even parsed before it is opened.
    Filed { text: String, only: Option<usize>, read: fn(&str, Option<usize>) -> Option<Vec<T>> },
}

/// The file of truths is not the one whose hash was published.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the sealed truths have the SHA-256 {found} where {published} was published: they were changed")]
pub struct BrokenSeal {
    /// What was published.
    pub published: String,
    /// What was found.
    pub found: String,
}

impl<T: Filed> SealedTruths<T> {
    /// Truths from a file that [`SealedTruths::open`] will read, checked by its hash alone; `only` names the
    /// one case that answers are for.
    ///
    /// # Errors
    /// [`BrokenSeal`], where the file is another than was published.
    pub fn filed(text: &str, published: &str, only: Option<usize>) -> Result<Self, BrokenSeal> {
        let found = sha256(text.as_bytes());
        if found != published {
            return Err(BrokenSeal { published: published.to_owned(), found });
        }
        let truths = Contents::Filed { text: text.to_owned(), only, read: truths_of::<T> };
        Ok(SealedTruths { digest: found, truths })
    }
}

/// The truths in a file's text, or the one that is asked for.
fn truths_of<T: Filed>(text: &str, only: Option<usize>) -> Option<Vec<T>> {
    let all: Value = serde_json::from_str(text).ok()?;
    let is_asked = |truth: &&Value| only.is_none_or(|only| truth["case"] == only);
    all.as_array()?.iter().filter(is_asked).map(T::from_value).collect()
}

impl<T: Sealable> SealedTruths<T> {
    /// Seals truths.
    pub(crate) fn new(truths: Vec<T>) -> Self {
        let digest = sha256(text_of(&truths).as_bytes());
        SealedTruths { digest, truths: Contents::Drawn(truths) }
    }

    /// SHA-256 of the truths as compact JSON, in hexadecimal.
    pub fn digest(&self) -> &str {
        &self.digest
    }

    /// The truths, handed out against the answers to all of their cases; `None` (and the seal broken) where
    /// answers are missing, or a file holds no truths.
    pub fn open(self, answers: &impl Given) -> Option<Vec<T>> {
        let truths = match self.truths {
            Contents::Drawn(truths) => truths,
            Contents::Filed { text, only, read } => read(&text, only)?,
        };
        (answers.count() == truths.len()).then_some(truths)
    }
}

fn text_of<T: Sealable>(truths: &[T]) -> String {
    Value::Array(truths.iter().map(T::to_value).collect()).to_string()
}

/// SHA-256 in hexadecimal.
fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
