//! How complex numbers stand in files, for `serde(serialize_with)`: as `[real, imaginary]`.

use num_complex::Complex64;
use serde::{Serialize, Serializer};

/// One complex number.
///
/// # Errors
/// Those of `serializer`.
pub fn complex<S: Serializer>(value: &Complex64, serializer: S) -> Result<S::Ok, S::Error> {
    [value.re, value.im].serialize(serializer)
}
