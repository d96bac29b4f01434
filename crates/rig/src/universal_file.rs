//! FRFs with coherence as universal files, and back: the only module that knows the format.

use jointscope_spectra::{Channel, Dof, FrfForm, FrfPair, FrfSet, SpectraError, SpectralLines};
pub use jointscope_uff::Precision;
use jointscope_uff::{
    Abscissa, Axis, Data, Dataset58, FunctionType, Node, ReadError, WriteError, data_type, read, write,
};
use num_complex::Complex64;

/// Why FRFs cannot be written to or read from a universal file.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// A point's name is not a node number.
    #[error("point `{0}` cannot be a node of a universal file: name it by a whole number")]
    NotANode(String),
    /// Node directions other than ±2 and ±6.
    #[error("direction {direction} at node {node} is neither transverse (±2) nor a rotation (±6)")]
    Direction {
        /// The node.
        node: i64,
        /// Its direction code.
        direction: i32,
    },
    /// An ordinate that is not displacement, velocity or acceleration.
    #[error("FRF {frf} has an ordinate of data type {data_type}: 8, 11 or 12 is needed")]
    Ordinate {
        /// The FRF.
        frf: String,
        /// The code found.
        data_type: i32,
    },
    /// FRFs of several forms or on several sets of lines.
    #[error("FRF {0} does not have the form and the spectral lines of the FRF before it")]
    Mixed(String),
    /// No FRF at all.
    #[error("the file holds no FRF")]
    Empty,
    /// The FRFs do not form a set.
    #[error(transparent)]
    Spectra(#[from] SpectraError),
    /// The bytes are not a universal file.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The values cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// The FRFs, each followed by its coherence where it has one, as 58b datasets of the given precision; `title` is
/// the first ID line.
///
/// # Errors
/// A point that is no node number, values that the format cannot hold.
pub fn to_bytes(title: &str, set: &FrfSet, precision: Precision) -> Result<Vec<u8>, FileError> {
    let hz = set.lines().hz();
    let step = if hz.len() > 1 { hz[1] - hz[0] } else { 0.0 };
    let even = hz.iter().enumerate().all(|(i, f)| (f - hz[0] - step * i as f64).abs() <= 1e-9 * f.abs());
    let abscissa = if even {
        Abscissa::Even { start: hz[0], step, count: hz.len() }
    } else {
        Abscissa::Uneven(hz.to_vec())
    };
    let numerator = match set.form() {
        FrfForm::Receptance => Axis::displacement(),
        FrfForm::Mobility => Axis::velocity(),
        FrfForm::Accelerance => Axis::acceleration(),
    };
    let mut datasets = Vec::new();
    for (index, pair) in set.pairs().iter().enumerate() {
        let function = |kind, data, ordinate_axis, denominator_axis| {
            let mut dataset = Dataset58 {
                function: kind,
                response: node(&pair.response)?,
                reference: node(&pair.reference)?,
                abscissa_axis: Axis::frequency(),
                ordinate_axis,
                denominator_axis,
                precision,
                ..Dataset58::new(abscissa.clone(), data)
            };
            dataset.id_lines[0] = title.to_owned();
            if let Some(averages) = set.averages(index) {
                dataset.id_lines[4] = format!("averages {averages}");
            }
            Ok::<_, FileError>(dataset)
        };
        let values = Data::Complex(set.values(index).to_vec());
        let force = Axis::excitation_force();
        datasets.push(function(FunctionType::FrequencyResponse, values, numerator.clone(), force)?);
        if let Some(coherence) = set.coherence(index) {
            let values = Data::Real(coherence.to_vec());
            let axis = Axis::new(data_type::GENERAL, "Coherence", "NONE");
            datasets.push(function(FunctionType::Coherence, values, axis, Axis::default())?);
        }
    }
    Ok(write(&datasets)?)
}

fn node(channel: &Channel) -> Result<Node, FileError> {
    let number = channel.point.parse().map_err(|_| FileError::NotANode(channel.point.clone()))?;
    let direction = match channel.dof {
        Dof::Translation => 2,
        Dof::Rotation => 6,
    };
    Ok(Node::new(number, direction))
}

/// The FRFs of a file with their coherence and averages; directions −2 and −6 are turned round.
///
/// # Errors
/// Bytes that are no universal file, FRFs that do not form a set.
pub fn from_bytes(bytes: &[u8]) -> Result<FrfSet, FileError> {
    let file = read(bytes)?;
    let mut lines: Option<SpectralLines> = None;
    let mut form = None;
    let (mut pairs, mut values, mut averages) = (Vec::new(), Vec::new(), Vec::new());
    for dataset in &file.datasets {
        let (FunctionType::FrequencyResponse, Data::Complex(data)) = (dataset.function, &dataset.data) else {
            continue;
        };
        let (pair, sign) = pair(dataset)?;
        let these = SpectralLines::new(dataset.abscissa.values())?;
        let this = form_of(dataset, &pair)?;
        if *form.get_or_insert(this) != this || !lines.get_or_insert(these.clone()).agrees_with(&these) {
            return Err(FileError::Mixed(pair.to_string()));
        }
        pairs.push(pair);
        averages.push(dataset.id_lines[4].strip_prefix("averages ").and_then(|n| n.trim().parse().ok()));
        values.extend(data.iter().map(|value: &Complex64| value * sign));
    }
    let (Some(lines), Some(form)) = (lines, form) else { return Err(FileError::Empty) };
    let mut set = FrfSet::new(lines, form, pairs, values)?;
    for (index, averages) in averages.into_iter().enumerate() {
        set.set_averages(index, averages);
    }
    for dataset in &file.datasets {
        if let (FunctionType::Coherence, Data::Real(data)) = (dataset.function, &dataset.data)
            && let Some(index) = set.index_of(&pair(dataset)?.0)
        {
            set.set_coherence(index, data.clone())?;
        }
    }
    Ok(set)
}

/// Response and reference, and the sign that their directions give the FRF.
fn pair(dataset: &Dataset58) -> Result<(FrfPair, f64), FileError> {
    let channel = |node: &Node| {
        let point = node.number.to_string();
        match node.direction {
            2 | -2 => Ok(Channel::transverse(point)),
            6 | -6 => Ok(Channel::rotational(point)),
            direction => Err(FileError::Direction { node: node.number, direction }),
        }
    };
    let pair = FrfPair::new(channel(&dataset.response)?, channel(&dataset.reference)?);
    Ok((pair, f64::from(dataset.response.direction.signum() * dataset.reference.direction.signum())))
}

fn form_of(dataset: &Dataset58, pair: &FrfPair) -> Result<FrfForm, FileError> {
    match dataset.ordinate_axis.data_type {
        data_type::DISPLACEMENT => Ok(FrfForm::Receptance),
        data_type::VELOCITY => Ok(FrfForm::Mobility),
        data_type::ACCELERATION => Ok(FrfForm::Accelerance),
        data_type => Err(FileError::Ordinate { frf: pair.to_string(), data_type }),
    }
}
