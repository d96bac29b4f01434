//! What a standard deviation comes to as an interval, and where a test refutes.

/// Half of a 95 % interval of a normal distribution in standard deviations, to as many digits as deviations
/// are ever known to.
pub const Z95: f64 = 1.96;

/// Probability below which a test refutes what it tests.
pub const SIGNIFICANT: f64 = 0.05;

/// The 95 % interval of what is known to ± `std`, its errors normal.
pub fn interval95(value: f64, std: f64) -> [f64; 2] {
    [value - Z95 * std, value + Z95 * std]
}
