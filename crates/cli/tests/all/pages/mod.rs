//! Pages as their readers have them: drawn and used in a browser, on paper, and in words.

mod browser;
mod drawn;
mod numbers;
mod used;

pub(crate) use drawn::sound;
