//! Truths under seal: known by their hash, opened only against answers.

use crate::{Answers, Truth};
use serde_json::Value;
use sha2::{Digest, Sha256};

/// What can be sealed: a truth that says all of itself as JSON.
pub trait Sealable {
    /// The truth as JSON.
    fn to_value(&self) -> Value;
}

impl Sealable for Truth {
    fn to_value(&self) -> Value {
        Truth::to_value(self)
    }
}

/// Truths that cannot be read until the answers are there: [`SealedTruths::open`] asks for them.
#[derive(Debug)]
pub struct SealedTruths<T = Truth> {
    truths: Vec<T>,
    digest: String,
}

impl<T: Sealable> SealedTruths<T> {
    /// Seals truths.
    pub fn new(truths: Vec<T>) -> Self {
        let text = Value::Array(truths.iter().map(T::to_value).collect()).to_string();
        SealedTruths { digest: hex(&Sha256::digest(text.as_bytes())), truths }
    }

    /// SHA-256 of the truths as compact JSON, in hexadecimal.
    pub fn digest(&self) -> &str {
        &self.digest
    }

    /// The truths, handed out against the answers to all of their cases; `None` (and the seal broken) where answers are missing.
    pub fn open(self, answers: &Answers) -> Option<Vec<T>> {
        (answers.all().len() == self.truths.len()).then_some(self.truths)
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
