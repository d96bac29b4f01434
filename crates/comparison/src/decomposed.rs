use serde_json::Value;

/// A 2×2 matrix, rows (force, moment), columns (displacement, rotation).
pub type Matrix = [[f64; 2]; 2];

/// K and C with standard deviations, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// K.
    pub stiffness: Matrix,
    /// C.
    pub damping: Matrix,
    /// Standard deviations of K: noise, the fixture's tolerances and a model that does not quite explain the FRFs, where the file states them.
    pub stiffness_std: Matrix,
    /// Standard deviations of C.
    pub damping_std: Matrix,
}

/// K and C on one spectral line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Hz.
    pub frequency: f64,
    /// K.
    pub stiffness: Matrix,
    /// C.
    pub damping: Matrix,
    /// Standard deviations of K and C from noise, where the recording had any.
    pub std: Option<(Matrix, Matrix)>,
}

/// One joint, as `stiffness.json` tells it.
#[derive(Debug, Clone, PartialEq)]
pub struct Decomposed {
    /// What it is called in the comparison.
    pub name: String,
    /// The joint's name in its fixture.
    pub joint: String,
    /// `exact` or `paper`: how lines and averages were found.
    pub relation: String,
    /// Lines that were solved, ascending.
    pub lines: Vec<Line>,
    /// Band of the averages, Hz.
    pub band: (f64, f64),
    /// Plain averages over the band.
    pub average: Estimate,
    /// The maximum-likelihood joint, by the exact relation, where there is one.
    pub likelihood: Option<Estimate>,
}

/// What is missing from a `stiffness.json`: the place in it.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is missing or not what it should be; make the file anew with `jointscope decompose`")]
pub struct DecomposedError(pub String);

impl Decomposed {
    /// From the contents of a `stiffness.json`.
    ///
    /// # Errors
    /// The first entry that is missing.
    pub fn of(name: impl Into<String>, file: &Value) -> Result<Self, DecomposedError> {
        let missing = |what: &str| DecomposedError(what.to_owned());
        let text = |key: &str| file[key].as_str().map(str::to_owned).ok_or_else(|| missing(key));
        let lines = file["lines"].as_array().ok_or_else(|| missing("lines"))?;
        let lines = lines
            .iter()
            .enumerate()
            .map(|(i, value)| line(value).ok_or_else(|| missing(&format!("lines/{i}"))));
        let lines = lines.collect::<Result<Vec<_>, _>>()?;
        if lines.windows(2).any(|pair| pair[0].frequency >= pair[1].frequency) {
            return Err(missing("lines: ascending frequencies"));
        }
        let band = &file["average"]["band"];
        let band = band[0].as_f64().zip(band[1].as_f64()).ok_or_else(|| missing("average/band"))?;
        Ok(Decomposed {
            name: name.into(),
            joint: text("joint")?,
            relation: text("relation")?,
            lines,
            band,
            average: estimate(&file["average"]).ok_or_else(|| missing("average"))?,
            likelihood: estimate(&file["maximum_likelihood"]),
        })
    }
}

fn matrix(value: &Value) -> Option<Matrix> {
    let element = |i: usize, j: usize| value[i][j].as_f64().filter(|v| v.is_finite());
    Some([[element(0, 0)?, element(0, 1)?], [element(1, 0)?, element(1, 1)?]])
}

fn line(value: &Value) -> Option<Line> {
    let std = matrix(&value["std"]["stiffness"]).zip(matrix(&value["std"]["damping"]));
    Some(Line {
        frequency: value["frequency"].as_f64()?,
        stiffness: matrix(&value["stiffness"])?,
        damping: matrix(&value["damping"])?,
        std,
    })
}

/// K and C with all their deviations in one: `std`, `std_fixture` and `std_model` are of independent causes.
fn estimate(value: &Value) -> Option<Estimate> {
    let together = |what: &str| -> Matrix {
        let parts = ["std", "std_fixture", "std_model"].map(|key| matrix(&value[key][what]));
        let element =
            |i: usize, j: usize| parts.iter().flatten().map(|m| m[i][j].powi(2)).sum::<f64>().sqrt();
        [[element(0, 0), element(0, 1)], [element(1, 0), element(1, 1)]]
    };
    Some(Estimate {
        stiffness: matrix(&value["stiffness"])?,
        damping: matrix(&value["damping"])?,
        stiffness_std: together("stiffness"),
        damping_std: together("damping"),
    })
}
