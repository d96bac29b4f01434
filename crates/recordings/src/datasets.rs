//! The way back: FRFs of a fixture's points as functions of a universal file.

use jointscope_spectra::{Channel, Dof, FrfForm, FrfSet, SpectralLines};
use jointscope_uff::{
    Abscissa, Axis, Data, Dataset58, Encoding, FunctionType, Node, ReadError, WriteError, data_type, read,
    write,
};

/// Why FRFs cannot be stored in a universal file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum DatasetsError {
    /// A point whose name is no node number.
    #[error(
        "the point `{point}` has no place in a universal file, where nodes are whole numbers: give it a number for a name"
    )]
    PointName {
        /// The point.
        point: String,
    },
    /// Lines that the text columns would change.
    #[error(
        "the spectral lines are uneven and have more digits than an ASCII file holds (line {frequency} Hz): write a binary one"
    )]
    Digits {
        /// The first such line, printed in full.
        frequency: String,
    },
    /// The header refuses the lines.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The header does not come back.
    #[error(transparent)]
    Read(#[from] ReadError),
}

/// FRFs, each followed by its coherence where it has one, as functions of a universal file in SI units and
/// double precision, in the set's own form. ID line 1 is `test_name` (its first 80 characters), ID line 5 the
/// number of averages.
///
/// The abscissa is even where the header's columns hold the lines to a few roundings (in ASCII, to 10⁻⁸), and
/// uneven otherwise.
///
/// # Errors
/// A point whose name is no node number; in ASCII, uneven lines of more digits than fit its columns.
pub fn to_datasets(
    frfs: &FrfSet,
    test_name: &str,
    encoding: Encoding,
) -> Result<Vec<Dataset58>, DatasetsError> {
    let abscissa = abscissa(frfs.lines(), encoding)?;
    let mut datasets = Vec::with_capacity(2 * frfs.pairs().len());
    for (index, pair) in frfs.pairs().iter().enumerate() {
        let (response, reference) = (node(&pair.response)?, node(&pair.reference)?);
        let base = |data| Dataset58 {
            id_lines: id_lines(test_name, frfs.averages(index)),
            response: response.clone(),
            reference: reference.clone(),
            abscissa_axis: Axis::frequency(),
            encoding,
            ..Dataset58::new(abscissa.clone(), data)
        };
        datasets.push(Dataset58 {
            function: FunctionType::FrequencyResponse,
            ordinate_axis: motion_axis(frfs.form(), pair.response.dof),
            denominator_axis: force_axis(pair.reference.dof),
            ..base(Data::Complex(frfs.values(index).to_vec()))
        });
        if let Some(coherence) = frfs.coherence(index) {
            datasets.push(Dataset58 {
                function: FunctionType::Coherence,
                ordinate_axis: Axis::new(data_type::GENERAL, "Coherence", "NONE"),
                ..base(Data::Real(coherence.to_vec()))
            });
        }
    }
    Ok(datasets)
}

pub(crate) fn id_lines(test_name: &str, averages: Option<u32>) -> [String; 5] {
    let none = || "NONE".to_owned();
    // Columns hold plain text; a test's name is for people only.
    let name: String = test_name.chars().map(|c| if c.is_control() { ' ' } else { c }).take(80).collect();
    [name, none(), none(), none(), averages.map_or_else(none, |count| format!("averages {count}"))]
}

pub(crate) fn node(channel: &Channel) -> Result<Node, DatasetsError> {
    let direction = match channel.dof {
        Dof::Translation => 2,
        Dof::Rotation => 6,
    };
    match channel.point.parse::<i64>() {
        // `007` would come back as 7.
        Ok(number) if number >= 0 && number.to_string() == channel.point => Ok(Node::new(number, direction)),
        _ => Err(DatasetsError::PointName { point: channel.point.clone() }),
    }
}

/// The axis of a motion in SI units.
pub(crate) fn motion_axis(form: FrfForm, dof: Dof) -> Axis {
    let translation = match form {
        FrfForm::Receptance => Axis::displacement(),
        FrfForm::Mobility => Axis::velocity(),
        FrfForm::Accelerance => Axis::acceleration(),
    };
    match dof {
        Dof::Translation => translation,
        Dof::Rotation => Axis { units: translation.units.replacen('m', "rad", 1), ..translation },
    }
}

pub(crate) fn force_axis(dof: Dof) -> Axis {
    match dof {
        Dof::Translation => Axis::excitation_force(),
        Dof::Rotation => Axis::new(data_type::EXCITATION_FORCE, "Excitation Moment", "N*m"),
    }
}

/// Relative errors of a line that count as none.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;
const ASCII_TOLERANCE: f64 = 1e-8;

fn abscissa(lines: &SpectralLines, encoding: Encoding) -> Result<Abscissa, DatasetsError> {
    let hz = lines.hz();
    let ascii = encoding == Encoding::Ascii;
    let tolerance = if ascii { ASCII_TOLERANCE } else { ROUNDINGS };
    let (first, last) = (hz[0], hz[hz.len() - 1]);
    let step = if hz.len() > 1 { (last - first) / (hz.len() - 1) as f64 } else { 0.0 };
    let even = as_stored(first, step, hz.len())?;
    let holds = |(index, line): (usize, &f64)| (even.value(index) - line).abs() <= tolerance * line.abs();
    if hz.iter().enumerate().all(holds) {
        return Ok(even);
    }
    // ASCII abscissae have the columns of single precision, E13.5.
    let changed = |line: &&f64| format!("{line:.5e}").parse() != Ok(**line);
    match hz.iter().find(changed) {
        Some(line) if ascii => Err(DatasetsError::Digits { frequency: line.to_string() }),
        _ => Ok(Abscissa::Uneven(hz.to_vec())),
    }
}

/// What a header keeps of start and step: found by writing and reading one.
fn as_stored(start: f64, step: f64, count: usize) -> Result<Abscissa, DatasetsError> {
    let probe = Dataset58::new(Abscissa::Even { start, step, count: 1 }, Data::Real(vec![0.0]));
    let file = read(&write(&[probe])?)?;
    Ok(match file.datasets.first().map(|stored| &stored.abscissa) {
        Some(&Abscissa::Even { start, step, .. }) => Abscissa::Even { start, step, count },
        _ => Abscissa::Even { start, step, count },
    })
}
