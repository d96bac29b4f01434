//! MATLAB files as scipy (v5, v7) and h5py (v7.3) write them, see
//! `docs/development/checks/mat_with_scipy.py`: two FRFs on five lines.

use jointscope_import::{ColumnMap, Format, Imported, read};
use jointscope_uff::{Data, Dataset58, FunctionType};
use num_complex::Complex64;

const TESTLAB: [(&str, Format, &[u8]); 3] = [
    ("testlab-v5.mat", Format::Mat5, include_bytes!("samples/testlab-v5.mat")),
    ("testlab-v7.mat", Format::Mat5, include_bytes!("samples/testlab-v7.mat")),
    ("testlab-v73.mat", Format::Mat73, include_bytes!("samples/testlab-v73.mat")),
];
const NAMED: [(&str, &[u8]); 2] = [
    ("named-v7.mat", include_bytes!("samples/named-v7.mat")),
    ("named-v73.mat", include_bytes!("samples/named-v73.mat")),
];
const PLAIN: &[u8] = include_bytes!("samples/plain-v5.mat");

fn line(at: usize) -> f64 {
    10.0 + 2.5 * at as f64
}

/// What the script writes.
fn written(function: usize, at: usize) -> Complex64 {
    let f = line(at);
    match function {
        0 => Complex64::new(f / 10.0, -0.25 * f),
        _ => Complex64::new(0.5, -0.125 * f),
    }
}

#[track_caller]
fn check(dataset: &Dataset58, function: usize, factor: f64) {
    let Data::Complex(values) = &dataset.data else { panic!("an FRF is complex") };
    assert_eq!((values.len(), dataset.abscissa.len()), (5, 5));
    for (at, value) in values.iter().enumerate() {
        assert_eq!(dataset.abscissa.value(at), line(at));
        let expected = written(function, at) * factor;
        assert!(
            (value - expected).norm() < 1e-12 * expected.norm(),
            "{} Hz: {value}, not {expected}",
            line(at)
        );
    }
}

fn imported(bytes: &[u8], columns: &[&str]) -> Imported {
    read(bytes, "test.mat", &ColumnMap::parse(columns).unwrap()).unwrap()
}

#[track_caller]
fn refused(bytes: &[u8], columns: &[&str], parts: &[&str]) {
    let message = read(bytes, "test.mat", &ColumnMap::parse(columns).unwrap()).unwrap_err().to_string();
    parts.iter().for_each(|part| assert!(message.contains(part), "`{part}` is missing from: {message}"));
}

/// Stored in SI; the factor brings them to the unit that the label names.
#[test]
fn a_testlab_export_of_any_version_is_two_frfs_in_the_unit_of_its_label() {
    for (name, format, bytes) in TESTLAB {
        let imported = imported(bytes, &[]);
        assert_eq!(imported.format, format, "{name}");
        let [first, second] = imported.file.datasets.as_slice() else { panic!("{name}: two FRFs") };
        for (dataset, node) in [(first, 4), (second, 3)] {
            assert_eq!(dataset.function, FunctionType::FrequencyResponse);
            assert_eq!((dataset.response.number, dataset.response.direction), (node, 3), "{name}");
            assert_eq!((dataset.reference.number, dataset.reference.direction), (1, 3), "{name}");
            assert_eq!(
                (dataset.ordinate_axis.units.as_str(), dataset.abscissa_axis.units.as_str()),
                ("g/N", "Hz")
            );
        }
        check(first, 0, 1.0 / 9.80665);
        check(second, 1, 1.0 / 9.80665);
    }
}

#[test]
fn a_map_renames_functions_of_an_export_by_column_or_by_name() {
    let map = ["FRF(1)=7:+y/1:-y", "FRF 3:+Z/1:+Z=8/1"];
    let imported = imported(TESTLAB[0].2, &map);
    let found: Vec<_> =
        imported.file.datasets.iter().map(|d| (d.response.number, d.reference.direction)).collect();
    assert_eq!(found, [(7, -2), (8, 2)]);
    assert_eq!(imported.used.len(), 2);
}

#[test]
fn variables_named_for_their_frf_are_read_beside_their_frequencies() {
    for (name, bytes) in NAMED {
        let mut datasets = imported(bytes, &[]).file.datasets;
        datasets.sort_by_key(|dataset| -dataset.response.number);
        assert_eq!(datasets.len(), 2, "{name}");
        assert_eq!((datasets[0].response.number, datasets[1].response.number), (4, 3));
        check(&datasets[0], 0, 1.0);
        check(&datasets[1], 1, 1.0);
        assert_eq!(datasets[0].ordinate_axis.units, "NONE", "no unit is stated, none is made up");
        let stated = imported(bytes, &["4/1 [g/N]"]);
        assert_eq!(stated.used.len(), 1);
        assert!(
            stated.file.datasets.iter().any(|d| d.response.number == 4 && d.ordinate_axis.units == "g/N")
        );
    }
}

#[test]
fn columns_of_a_matrix_are_what_the_map_says() {
    let imported = imported(PLAIN, &["H(2)=3:+z/1 [m/s^2/N]"]);
    let [only] = imported.file.datasets.as_slice() else { panic!("one FRF is named, one read") };
    check(only, 1, 1.0);
    assert_eq!((only.response.number, only.response.direction), (3, 3));
    assert_eq!(only.ordinate_axis.units, "m/s^2/N");
    refused(PLAIN, &[], &["variable `H(1)`", "--columns \"H(1)=4/1\""]);
}

#[test]
fn damaged_files_and_files_without_frfs_say_so() {
    refused(&PLAIN[..300], &["4/1"], &["byte", "copy or save the file again"]);
    let (_, _, compressed) = TESTLAB[1];
    refused(&compressed[..400], &[], &["byte 128", "copy or save the file again"]);
    let mut broken = compressed.to_vec();
    broken[200] ^= 0x55;
    refused(&broken, &[], &["cannot be unpacked"]);
    refused(&TESTLAB[2].2[..4000], &[], &["HDF5", "'-v7'", "dataset 58"]);
    refused(&PLAIN[..128], &[], &["is a MATLAB or HDF5 file without FRFs", "no variable"]);
    let header = [b"MATLAB 5.0 MAT-file".to_vec(), vec![b' '; 109]].concat();
    refused(&header, &[], &["byte 126", "byte order"]);
}
