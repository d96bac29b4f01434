//! Joints to export, and the 4×4 matrices that they should have.

use jointscope_comparison::Decomposed;
use jointscope_export::{Export, ExportError, ExportOptions, of_decompositions};
use serde_json::{Value, json};

pub(crate) type Matrix = [[f64; 2]; 2];
pub(crate) type Matrix4 = [[f64; 4]; 4];

pub(crate) const LENGTH: f64 = 0.065;

/// Stiffness of a beam from its far end.
pub(crate) fn beam(ei: f64, l: f64) -> Matrix {
    let f = ei / l.powi(3);
    [[12.0 * f, -6.0 * l * f], [-6.0 * l * f, 4.0 * l * l * f]]
}

/// The contents of a `stiffness.json` with a maximum-likelihood joint.
pub(crate) fn file(k: Matrix, c: Matrix) -> Value {
    let std = json!({"stiffness": [[1e4, 3e2], [3e2, 20.0]], "damping": [[0.1, 0.002], [0.002, 1e-4]]});
    let pair = json!({"stiffness": k, "damping": c, "std": std});
    let line = |hz: f64| json!({"frequency": hz, "stiffness": k.map(|row| row.map(|e| e * (1.0 + hz / 1e4))), "damping": c});
    json!({
        "joint": "J", "relation": "exact",
        "ends": {"length": LENGTH, "from": {"point": "2", "body": "A", "x": 0.01}, "to": {"point": "3", "body": "B", "x": 0.01 + LENGTH}},
        "lines": [line(100.0), line(200.0), line(300.0)],
        "average": {"band": [100.0, 300.0], "stiffness": k, "damping": c, "std": std},
        "maximum_likelihood": pair,
        "judgement": {"verdict": "sound"},
    })
}

pub(crate) fn exported(file: &Value, options: &ExportOptions) -> Result<Export, ExportError> {
    of_decompositions(&[Decomposed::of("J", file).unwrap()], options)
}

/// `[−R, I]ᵀ m [−R, I]`, written out.
pub(crate) fn both_ends(m: &Matrix, l: f64) -> Matrix4 {
    let d = [[-1.0, -l, 1.0, 0.0], [0.0, -1.0, 0.0, 1.0]];
    let mut all = [[0.0; 4]; 4];
    for i in 0..4 {
        for j in 0..4 {
            for p in 0..2 {
                for q in 0..2 {
                    all[i][j] += d[p][i] * m[p][q] * d[q][j];
                }
            }
        }
    }
    all
}

/// Whether two matrices are the same to `digits` of the root of their diagonal's products.
#[track_caller]
pub(crate) fn same(found: &Matrix4, expected: &Matrix4, digits: f64) {
    for i in 0..4 {
        for j in 0..4 {
            let scale = (expected[i][i] * expected[j][j]).abs().sqrt().max(expected[i][j].abs());
            let error = (found[i][j] - expected[i][j]).abs();
            assert!(error <= digits * scale, "element {i}{j}: {} for {}", found[i][j], expected[i][j]);
        }
    }
}
