//! Truths under seal: known by their hash, opened only against answers.

use crate::{Answers, Truth};
use serde_json::Value;
use sha2::{Digest, Sha256};

/// Truths that cannot be read until the answers are there: [`SealedTruths::open`] asks for them.
#[derive(Debug)]
pub struct SealedTruths {
    truths: Vec<Truth>,
    digest: String,
}

impl SealedTruths {
    /// Seals truths.
    pub fn new(truths: Vec<Truth>) -> Self {
        let text = Value::Array(truths.iter().map(Truth::to_value).collect()).to_string();
        SealedTruths { digest: hex(&Sha256::digest(text.as_bytes())), truths }
    }

    /// SHA-256 of the truths as compact JSON, in hexadecimal.
    pub fn digest(&self) -> &str {
        &self.digest
    }

    /// The truths, handed out against the answers to all of their cases; `None` (and the seal broken) where answers are missing.
    pub fn open(self, answers: &Answers) -> Option<Vec<Truth>> {
        (answers.all().len() == self.truths.len()).then_some(self.truths)
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
