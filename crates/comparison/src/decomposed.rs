//! What `stiffness.json` says of one decomposition, read back.

use crate::stiffness_file::{EstimateEntry, LineEntry, Matrix, MatrixPair, Nominal, read};
use crate::{AtOnce, FiledJoint, PlaceInFit, Source};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::sync::Arc;

/// K and C with standard deviations, SI.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FiledEstimate {
    /// K.
    pub stiffness: Matrix,
    /// C.
    pub damping: Matrix,
    /// Standard deviations of K: noise, the fixture's tolerances and a model that does not quite explain the
    /// FRFs, where the file states them.
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
    /// Whether noise dominates it.
    pub noisy: bool,
    /// H41, real and imaginary parts: m/N, m/(N·m), rad/N, rad/(N·m); files of earlier versions do not have
    /// it.
    pub h41: Option<[[[f64; 2]; 2]; 2]>,
}

/// Where a joint's K and C act: on d = u_to − R·u_from over `length`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Ends {
    /// L, m.
    pub length: f64,
    /// The near end.
    pub from: End,
    /// The far end.
    pub to: End,
}

/// One end of a joint.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct End {
    /// The point's name.
    pub point: String,
    /// Its body's name.
    pub body: String,
    /// Its abscissa, m.
    pub x: f64,
}

/// How an estimate may be used.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Judged {
    /// `sound`, `with_care` or `unusable`.
    pub verdict: String,
    /// χ² per degree of freedom of the fit, where a constant joint does not explain the FRFs.
    #[serde(default)]
    pub poor_fit: Option<f64>,
}

/// One joint, as `stiffness.json` tells it.
#[derive(Debug, Clone, PartialEq)]
pub struct Decomposed {
    /// What it is called in the comparison.
    pub name: String,
    /// The joint's name in its fixture.
    pub joint: String,
    /// Where it acts; files of earlier versions do not say.
    pub ends: Option<Ends>,
    /// `exact` or `paper`: how lines and averages were found.
    pub relation: String,
    /// Lines that were solved, ascending; none of joints that one fit found at once.
    pub lines: Vec<Line>,
    /// Plain averages; none of joints that one fit found at once.
    pub average: Option<Average>,
    /// The maximum-likelihood joint, by the exact relation, where there is one.
    pub likelihood: Option<FiledEstimate>,
    /// Why there is none.
    pub failed: Option<String>,
    /// The joint with the fixture's quantities moving, where the file has it.
    pub fitted: Option<FiledJoint>,
    /// Why it has none, where the file says it.
    pub not_fitted: Option<String>,
    /// SHA-256 of the files of its recording, where the file says what it was made from.
    pub recording: Vec<String>,
    /// How the estimate may be used, where the file says it.
    pub judgement: Option<Judged>,
    /// The fixture's own joint, where the file says it.
    pub nominal: Option<Nominal>,
    /// Its place among joints that one fit found at once, where it did.
    pub at_once: Option<PlaceInFit>,
    /// Where its FRFs come from, where that is said: no file does.
    pub source: Option<Source>,
}

/// Plain averages of K and C over a band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Average {
    /// Hz.
    pub band: (f64, f64),
    /// K and C.
    pub estimate: FiledEstimate,
}

/// Why a `stiffness.json` cannot be read, or not as one joint's.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DecomposedError {
    /// The place in the file of what is missing.
    #[error("`{0}` is missing or not what it should be; make the file anew with `jointscope decompose`")]
    Missing(String),
    /// One joint is asked for, and the file is of several.
    #[error("the file holds several joints ({}), and one is wanted here: name it", .0.join(", "))]
    Several(Vec<String>),
    /// There is no joint of this name in it.
    #[error("the file has no joint `{name}`; it has {}", known.join(", "))]
    NoSuchJoint {
        /// The name asked for.
        name: String,
        /// The joints there are.
        known: Vec<String>,
    },
}

impl Decomposed {
    /// From the contents of a `stiffness.json` of one joint.
    ///
    /// # Errors
    /// The first entry that is missing; several joints.
    pub fn of(name: impl Into<String>, file: &Value) -> Result<Self, DecomposedError> {
        let mut all = Decomposed::all(name, file)?;
        match all.len() {
            1 => Ok(all.remove(0)),
            _ => Err(DecomposedError::Several(all.into_iter().map(|joint| joint.joint).collect())),
        }
    }

    /// The joint of this name in a `stiffness.json` of one joint or of several; it is called `name`.
    ///
    /// # Errors
    /// The first entry that is missing; no joint of this name.
    pub fn one(name: impl Into<String>, file: &Value, joint: &str) -> Result<Self, DecomposedError> {
        let all = Decomposed::all("", file)?;
        let known = all.iter().map(|found| found.joint.clone()).collect();
        let found = all.into_iter().find(|found| found.joint == joint);
        let found = found.ok_or_else(|| DecomposedError::NoSuchJoint { name: joint.to_owned(), known })?;
        Ok(Decomposed { name: name.into(), ..found })
    }

    /// From the contents of a `stiffness.json`: its joint, called `name`, or all of several, called `name/J`.
    ///
    /// # Errors
    /// The first entry that is missing.
    pub fn all(name: impl Into<String>, file: &Value) -> Result<Vec<Self>, DecomposedError> {
        match file["joints"].is_array() {
            true => found_at_once(&name.into(), file),
            false => Ok(vec![Decomposed::alone(name.into(), file)?]),
        }
    }

    /// Whether one fit found both.
    pub(crate) fn is_of_the_fit_of(&self, other: &Decomposed) -> bool {
        self.at_once.as_ref().zip(other.at_once.as_ref()).is_some_and(|(a, b)| a.fit == b.fit)
    }

    /// A joint that was taken out of its assembly.
    fn alone(name: String, file: &Value) -> Result<Self, DecomposedError> {
        let lines = file["lines"].as_array().ok_or_else(|| missing("lines"))?;
        let lines = lines.iter().enumerate().map(|(i, entry)| {
            let line: LineEntry = read(entry).ok_or_else(|| missing(&format!("lines/{i}")))?;
            Ok(line.into())
        });
        let lines: Vec<Line> = lines.collect::<Result<_, _>>()?;
        if lines.windows(2).any(|pair| pair[0].frequency >= pair[1].frequency) {
            return Err(missing("lines: ascending frequencies"));
        }
        let band = read(&file["average"]["band"]).ok_or_else(|| missing("average/band"))?;
        let average: EstimateEntry = read(&file["average"]).ok_or_else(|| missing("average"))?;
        let (joint, fitted) = joint(file).ok_or_else(|| missing("joint"))?;
        Ok(Decomposed {
            name,
            joint,
            ends: optional(file, "ends")?,
            relation: read(&file["relation"]).ok_or_else(|| missing("relation"))?,
            lines,
            average: Some(Average { band, estimate: average.into() }),
            likelihood: likelihood(file)?,
            failed: read(&file["maximum_likelihood"]["failed"]),
            fitted,
            not_fitted: read(&file["joint"]["failed"]),
            recording: recording(file),
            judgement: optional(file, "judgement")?,
            nominal: optional(file, "nominal")?,
            at_once: None,
            source: None,
        })
    }
}

fn missing(what: &str) -> DecomposedError {
    DecomposedError::Missing(what.to_owned())
}

/// The joints that one fit found at once; a single one, of a loop, has the name of its test.
fn found_at_once(name: &str, file: &Value) -> Result<Vec<Decomposed>, DecomposedError> {
    let all = file["joints"].as_array().filter(|all| !all.is_empty()).ok_or_else(|| missing("joints"))?;
    let fit = Arc::new(AtOnce::of(file).ok_or_else(|| missing("covariance"))?);
    let is_alone = all.len() == 1;
    let of = |(place, entry): (usize, &Value)| {
        let joint = fit.joints[place].clone();
        let at = |what: &str| format!("joints/{place}/{what}");
        let fitted: FiledJoint = read(entry).ok_or_else(|| missing(&format!("joints/{place}")))?;
        let nominal: Option<[[f64; 2]; 2]> = read(&entry["nominal_stiffness"]);
        Ok(Decomposed {
            name: if is_alone { name.to_owned() } else { format!("{name}/{joint}") },
            joint,
            ends: optional(entry, "ends").map_err(|_| missing(&at("ends")))?,
            // The fit knows of no other.
            relation: "exact".to_owned(),
            lines: Vec::new(),
            average: None,
            likelihood: None,
            failed: None,
            fitted: Some(fitted),
            not_fitted: None,
            recording: recording(file),
            judgement: None,
            nominal: nominal.map(|k| Nominal {
                stiffness: k.map(|row| row.map(Some)),
                damping: Nominal::default().damping,
            }),
            at_once: Some(PlaceInFit { fit: Arc::clone(&fit), joint: place }),
            source: None,
        })
    };
    all.iter().enumerate().map(of).collect()
}

/// The joint's name, and the joint itself where the file has it: `joint` is a name alone in earlier files,
/// and has `failed` where there is no fit.
fn joint(file: &Value) -> Option<(String, Option<FiledJoint>)> {
    let joint = &file["joint"];
    if let Some(name) = joint.as_str() {
        return Some((name.to_owned(), None));
    }
    let name = read(&joint["name"]).or_else(|| read(&file["name"])).unwrap_or_else(|| "J".to_owned());
    match joint["failed"].is_string() {
        true => Some((name, None)),
        false => Some((name, Some(read(joint)?))),
    }
}

/// Hashes of what it was made from but for the fixture, which comes first.
fn recording(file: &Value) -> Vec<String> {
    let inputs = file["made"]["inputs"].as_array().into_iter().flatten().skip(1);
    inputs.filter_map(|input| read(&input["sha256"])).collect()
}

/// The maximum-likelihood joint; none where the entry says why it failed.
fn likelihood(file: &Value) -> Result<Option<FiledEstimate>, DecomposedError> {
    if file["maximum_likelihood"]["failed"].is_string() {
        return Ok(None);
    }
    Ok(optional(file, "maximum_likelihood")?.map(EstimateEntry::into))
}

/// An entry that may be left out, but not be wrong.
fn optional<T: DeserializeOwned>(file: &Value, key: &str) -> Result<Option<T>, DecomposedError> {
    match &file[key] {
        Value::Null => Ok(None),
        value => read(value).map(Some).ok_or_else(|| DecomposedError::Missing(key.to_owned())),
    }
}

impl From<LineEntry> for Line {
    fn from(line: LineEntry) -> Self {
        Line {
            frequency: line.frequency,
            stiffness: line.stiffness,
            damping: line.damping,
            std: line.std.map(|std| (std.stiffness, std.damping)),
            noisy: line.noisy.unwrap_or(false),
            h41: line.h41,
        }
    }
}

impl From<EstimateEntry> for FiledEstimate {
    /// K and C with all their deviations in one: `std`, `std_fixture` and `std_model` are of independent
    /// causes.
    fn from(entry: EstimateEntry) -> Self {
        let parts = [entry.std, entry.std_fixture, entry.std_model];
        let together = |of: &dyn Fn(&MatrixPair) -> Matrix| -> Matrix {
            let element = |i: usize, j: usize| {
                parts.iter().flatten().map(|part| of(part)[i][j].powi(2)).sum::<f64>().sqrt()
            };
            [[element(0, 0), element(0, 1)], [element(1, 0), element(1, 1)]]
        };
        FiledEstimate {
            stiffness: entry.stiffness,
            damping: entry.damping,
            stiffness_std: together(&|part| part.stiffness),
            damping_std: together(&|part| part.damping),
        }
    }
}
