//! Fixture files, as text: who reads fixtures stands above this crate.

/// Two equal rigid blocks, points 1 and 2 on the one, 3 and 4 on the other, and a steel strip of 65 mm from 2
/// to 3.
pub const TWO_BLOCKS: &str = r#"{
  "name": "two blocks and a beam",
  "bodies": {
    "A": { "mass": 1.10, "inertia": 9.5e-4, "x_cg": -0.030 },
    "B": { "mass": 1.10, "inertia": 9.5e-4, "x_cg": 0.095 }
  },
  "points": {
    "1": { "body": "A", "x": -0.060 }, "2": { "body": "A", "x": 0.0 },
    "3": { "body": "B", "x": 0.065 },  "4": { "body": "B", "x": 0.125 }
  },
  "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 } } },
  "damping": { "loss_factor": 0.006 }
}"#;

/// Two storeys that do not rotate, a point on each and a column between them: few quantities, few places,
/// quick searches.
pub const TWO_STOREYS: &str = r#"{
  "name": "two storeys",
  "bodies": {
    "low": { "mass": {"value": 6.9, "std": 0.007}, "rotates": false },
    "high": { "mass": {"value": 6.0, "std": 0.006}, "rotates": false }
  },
  "points": { "1": { "body": "low", "x": 0 }, "2": { "body": "high", "x": 0.18 } },
  "joints": { "C": { "from": "1", "to": "2", "stiffness": [[{"value": 3.4e6, "std": 2e4}, 0], [0, 0]] } },
  "damping": { "modal_ratios": [{"value": 0.02, "std": 0.004}] }
}"#;

/// A fixture file with further keys at its end: `"physics": [..]`, say.
///
/// # Panics
/// Where the file does not end with a brace.
pub fn with(fixture: &str, keys: &str) -> String {
    format!("{}, {keys} }}", fixture.strip_suffix('}').unwrap().trim_end())
}

/// [`TWO_BLOCKS`] with modal damping of these ratios in place of a loss factor.
pub fn two_blocks_damped(modal_ratios: &[f64]) -> String {
    TWO_BLOCKS.replacen(r#""loss_factor": 0.006"#, &format!(r#""modal_ratios": {modal_ratios:?}"#), 1)
}
