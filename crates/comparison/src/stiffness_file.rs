//! Entries of `stiffness.json` as they are written and read.

use crate::filed_likelihood::FiledLikelihood;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value;

/// A 2×2 matrix, rows (force, moment), columns (displacement, rotation).
pub type Matrix = [[f64; 2]; 2];

/// K and C, or a standard deviation of each of their elements.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MatrixPair {
    /// K.
    pub stiffness: Matrix,
    /// C.
    pub damping: Matrix,
}

/// K and C on one line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LineEntry {
    /// Hz.
    pub frequency: f64,
    /// K.
    pub stiffness: Matrix,
    /// C.
    pub damping: Matrix,
    /// By how much relative errors of the FRFs are multiplied, at the most.
    #[serde(default)]
    pub condition: Option<f64>,
    /// H41, each element with its real and imaginary part; files of earlier versions do not have it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub h41: Option<[[[f64; 2]; 2]; 2]>,
    /// Standard deviations from noise, where the recording had any.
    #[serde(default, deserialize_with = "where_whole", skip_serializing_if = "Option::is_none")]
    pub std: Option<MatrixPair>,
    /// Whether noise dominates it, where there is any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noisy: Option<bool>,
}

/// An estimate of K and C: a mean over lines, or the maximum-likelihood joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EstimateEntry {
    /// K.
    pub stiffness: Matrix,
    /// C.
    pub damping: Matrix,
    /// What the FRFs' noise leaves uncertain.
    #[serde(default, deserialize_with = "where_whole")]
    pub std: Option<MatrixPair>,
    /// The band of a mean, Hz.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub band: Option<(f64, f64)>,
    /// Lines behind a mean.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lines: Option<usize>,
    /// What the fixture's tolerances leave uncertain.
    #[serde(default, deserialize_with = "where_whole", skip_serializing_if = "Option::is_none")]
    pub std_fixture: Option<MatrixPair>,
    /// What it costs that a constant joint does not explain the FRFs.
    #[serde(default, deserialize_with = "where_whole", skip_serializing_if = "Option::is_none")]
    pub std_model: Option<MatrixPair>,
    /// χ² per degree of freedom of a fit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chi2_per_dof: Option<f64>,
}

/// What the fixture as it stands gives, element by element, where it does.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Nominal {
    /// K.
    pub stiffness: [[Option<f64>; 2]; 2],
    /// C, averaged over the band.
    pub damping: [[Option<f64>; 2]; 2],
}

/// By how much the deviations were widened for what the model gets wrong.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ModelError {
    /// Of the noise's variance; 1 where noise and tolerances explain the FRFs.
    pub inflation: f64,
    /// Of the posterior's, where quantities are farther from what is stated than chance takes them; 1 where
    /// they are not.
    #[serde(rename = "strain")]
    pub tolerance_inflation: f64,
    /// What of the covariance comes from it besides.
    pub covariance: [[f64; 6]; 6],
}

impl Default for ModelError {
    fn default() -> Self {
        ModelError { inflation: 1.0, tolerance_inflation: 1.0, covariance: [[0.0; 6]; 6] }
    }
}

/// A number with its standard deviation, SI.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Uncertain {
    /// The value.
    pub value: f64,
    /// Its standard deviation.
    pub std: f64,
}

/// The law over frequency that a joint's numbers are of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FollowedLaw {
    /// Its name; with a mass of the joint another one.
    pub law: String,
    /// Probability among the laws compared.
    #[serde(default)]
    pub probability: Option<f64>,
    /// Where K and C are stated, Hz.
    pub frequency: f64,
    /// Exponent of a springpot.
    #[serde(default, deserialize_with = "where_whole", skip_serializing_if = "Option::is_none")]
    pub exponent: Option<Uncertain>,
    /// Relaxation time of a standard linear solid.
    #[serde(default, deserialize_with = "where_whole", skip_serializing_if = "Option::is_none")]
    pub time: Option<Uncertain>,
    /// Loss factors ωC/K of a structural one, which do not depend on frequency.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loss_factor: Option<LossFactor>,
}

impl FollowedLaw {
    /// A law of which nothing is stated but its name.
    pub(crate) fn plain(law: &str, probability: f64, frequency: f64) -> Self {
        FollowedLaw {
            law: law.to_owned(),
            probability: Some(probability),
            frequency,
            exponent: None,
            time: None,
            loss_factor: None,
        }
    }

    /// Whether K and C are the same at every frequency.
    pub fn is_viscous(&self) -> bool {
        self.law.starts_with("viscous")
    }
}

/// Loss factors of the elements of K; nothing for those that are zero.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LossFactor {
    /// η.
    pub value: [[Option<f64>; 2]; 2],
    /// Standard deviations.
    pub std: [[Option<f64>; 2]; 2],
    /// 95 % intervals.
    #[serde(default, deserialize_with = "where_whole")]
    pub ci95: [[Option<[f64; 2]>; 2]; 2],
}

/// A law over frequency, as one joint's FRFs have it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComparedLaw {
    /// Its name; with a mass of the joint another one.
    pub law: String,
    /// Probability among those compared.
    pub probability: f64,
    /// Its parameters by their names, SI.
    #[serde(default)]
    pub parameters: Value,
    /// Exponent of a springpot.
    #[serde(default, deserialize_with = "where_whole", skip_serializing_if = "Option::is_none")]
    pub exponent: Option<Uncertain>,
    /// Relaxation time of a standard linear solid, s.
    #[serde(default, deserialize_with = "where_whole", skip_serializing_if = "Option::is_none")]
    pub time: Option<Uncertain>,
    /// K and C in the middle of the band; files of earlier versions do not say.
    #[serde(default, deserialize_with = "where_whole")]
    pub in_the_middle: Option<MatrixPair>,
    /// What the FRFs tell of K and C there under this law, of probable laws that the joint's numbers are not
    /// of; files of earlier versions do not say.
    #[serde(default, deserialize_with = "where_whole", skip_serializing_if = "Option::is_none")]
    pub likelihood: Option<FiledLikelihood>,
}

impl ComparedLaw {
    /// The joint's own mass, of a law that has one; how well it is known is not stated.
    pub(crate) fn mass(&self) -> Option<Uncertain> {
        read(&self.parameters["mass"]).map(|value| Uncertain { value, std: 0.0 })
    }
}

/// An entry of a file, if it is what it should be.
pub(crate) fn read<T: DeserializeOwned>(value: &Value) -> Option<T> {
    T::deserialize(value).ok()
}

/// What is left out where a number of it is not determined, which is `null` in the file.
fn where_whole<'de, T: DeserializeOwned + Default, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<T, D::Error> {
    Ok(read(&Value::deserialize(deserializer)?).unwrap_or_default())
}
