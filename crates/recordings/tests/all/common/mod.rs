//! A small test, as files would hold it.

use jointscope_fixture::Fixture;
use jointscope_recordings::{AssumedUnits, ChannelMap, ReadOptions, Recording, RecordingError, Source};
use jointscope_uff::{Abscissa, Axis, Data, Dataset58, FunctionType, Node, UffFile, Units, data_type};
use num_complex::Complex64;

/// Two blocks and a storey that does not rotate, points 1 to 5.
pub(crate) fn fixture() -> Fixture {
    Fixture::from_json(
        r#"{ "name": "two blocks and a storey",
        "bodies": { "A": { "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 },
                    "B": { "mass": 1.1, "inertia": 9.5e-4, "x_cg": 0.095 },
                    "C": { "mass": 2.0, "rotates": false } },
        "points": { "1": { "body": "A", "x": -0.06 }, "2": { "body": "A", "x": 0 },
                    "3": { "body": "B", "x": 0.065 }, "4": { "body": "B", "x": 0.125 },
                    "5": { "body": "C", "x": 0.2 } } }"#,
    )
    .unwrap()
}

pub(crate) const VALUES: [Complex64; 3] =
    [Complex64::new(1.0, -0.5), Complex64::new(2.0, 0.25), Complex64::new(-3.0, 4.0)];

/// An accelerance in SI units on 10, 12.5 and 15 Hz.
pub(crate) fn frf(response: (i64, i32), reference: (i64, i32)) -> Dataset58 {
    Dataset58 {
        function: FunctionType::FrequencyResponse,
        response: Node::new(response.0, response.1),
        reference: Node::new(reference.0, reference.1),
        abscissa_axis: Axis::frequency(),
        ordinate_axis: Axis::acceleration(),
        denominator_axis: Axis::excitation_force(),
        ..Dataset58::new(Abscissa::Even { start: 10.0, step: 2.5, count: 3 }, Data::Complex(VALUES.to_vec()))
    }
}

pub(crate) fn coherence(response: (i64, i32), reference: (i64, i32), values: [f64; 3]) -> Dataset58 {
    Dataset58 {
        function: FunctionType::Coherence,
        ordinate_axis: Axis::new(data_type::GENERAL, "Coherence", "NONE"),
        denominator_axis: Axis::default(),
        data: Data::Real(values.to_vec()),
        ..frf(response, reference)
    }
}

pub(crate) fn history(node: i64, axis: Axis) -> Dataset58 {
    Dataset58 {
        function: FunctionType::TimeResponse,
        response: Node::new(node, 2),
        abscissa_axis: Axis::time(),
        ordinate_axis: axis,
        ..Dataset58::new(Abscissa::Even { start: 0.0, step: 1e-3, count: 2 }, Data::Real(vec![0.0, 1.0]))
    }
}

/// Inch and pound-force, as dataset 164 states them.
pub(crate) fn inches() -> Units {
    Units {
        code: 7,
        description: "Inch (pound f)".to_owned(),
        length_factor: 39.37007874015748,
        force_factor: 0.224808943099711,
        ..Units::si()
    }
}

pub(crate) fn source(name: &str, datasets: Vec<Dataset58>) -> Source {
    Source { name: name.to_owned(), file: UffFile { datasets, ..UffFile::default() } }
}

pub(crate) fn options(map: &[&str], units: Option<&str>) -> ReadOptions {
    ReadOptions {
        map: ChannelMap::parse(map).unwrap(),
        assume_units: units.map(|units| AssumedUnits::parse(units).unwrap()),
        ..ReadOptions::default()
    }
}

pub(crate) fn read_with(
    datasets: Vec<Dataset58>,
    options: &ReadOptions,
) -> Result<Recording, RecordingError> {
    Recording::of(&[source("test.uff", datasets)], &fixture(), options)
}

pub(crate) fn read(datasets: Vec<Dataset58>) -> Result<Recording, RecordingError> {
    read_with(datasets, &ReadOptions::default())
}

/// The first FRF's values.
pub(crate) fn first_values(recording: &Recording) -> Vec<Complex64> {
    recording.frfs().unwrap().values(0).to_vec()
}

/// FRF names of the only level.
pub(crate) fn names(recording: &Recording) -> Vec<String> {
    recording.frfs().unwrap().pairs().iter().map(|pair| pair.to_string()).collect()
}

/// The refusal of these functions must hold every part.
pub(crate) fn refused(datasets: Vec<Dataset58>, options: &ReadOptions, parts: &[&str]) {
    let message = match read_with(datasets, options) {
        Err(error) => error.to_string(),
        Ok(recording) => panic!("was read: {recording:?}"),
    };
    for part in parts {
        assert!(message.contains(part), "`{part}` is missing from: {message}");
    }
}

pub(crate) fn assert_close(found: &[Complex64], factor: Complex64) {
    for (line, (found, recorded)) in found.iter().zip(VALUES).enumerate() {
        let expected = recorded * factor;
        assert!(
            (found - expected).norm() <= 1e-9 * expected.norm(),
            "line {line}: expected {expected}, got {found}"
        );
    }
}
