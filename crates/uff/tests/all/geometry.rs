//! Geometry, shapes and header beside the functions: as pyuff writes them, as finite-element programs do, and
//! damaged.

use jointscope_uff::{
    Analysis, CoordinateSystem, Element, GridPoint, SystemKind, TraceLine, UffFile, ValueLocation, read,
};
use num_complex::Complex64;

/// Written by pyuff 2.5.8, see `docs/development/checks/geometry_with_pyuff.py`.
const BY_PYUFF: &[u8] = include_bytes!("samples/geometry-by-pyuff.uff");

fn by_pyuff() -> UffFile {
    let file = read(BY_PYUFF).unwrap();
    assert!(file.unreadable.is_empty(), "{:?}", file.unreadable);
    assert!(file.skipped.is_empty() && file.datasets.is_empty());
    file
}

fn dataset(number: u32, records: &str) -> Vec<u8> {
    format!("    -1\n{number:6}\n{records}    -1\n").into_bytes()
}

#[test]
fn nodes_come_with_their_systems_and_units() {
    let file = by_pyuff();
    assert_eq!(file.nodes.len(), 2);
    let point = |label, definition_system, displacement_system, coordinates| GridPoint {
        label,
        definition_system,
        displacement_system,
        coordinates,
    };
    assert_eq!(
        file.nodes[0].nodes,
        [point(1, 0, 0, [0.0; 3]), point(2, 7, 7, [20.0, 5.0, -1.0]), point(3, 0, 0, [150.0, -2.5, 0.0])]
    );
    // The export system of 2411 says nothing of the coordinates.
    assert_eq!(file.nodes[1].nodes, [point(11, 0, 3, [1.5, 0.0, 1e5]), point(12, 0, 0, [-2.25, 1e-3, 3.0])]);
    for nodes in &file.nodes {
        assert_eq!(nodes.units.as_ref().unwrap().length_factor, 1000.0);
    }
}

#[test]
fn coordinate_systems_are_rows_of_axes_and_an_origin() {
    let file = by_pyuff();
    let system = |label, name: &str, axes, origin| CoordinateSystem {
        label,
        name: name.to_owned(),
        kind: SystemKind::Cartesian,
        reference: 0,
        axes,
        origin,
    };
    // 18: x along the second axis, a point of the xz plane along the third, so y = z × x points along the
    // negative first.
    assert_eq!(
        file.systems[0],
        system(7, "SIDE", [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], [100.0, 0.0, 0.0])
    );
    assert_eq!(
        file.systems[1],
        system(3, "TURNED", [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [10.0, 0.0, 0.0])
    );
}

#[test]
fn trace_lines_lift_their_pen_at_zero() {
    let outline = TraceLine { number: 2, name: "outline".into(), nodes: vec![1, 2, 0, 2, 3] };
    assert_eq!(by_pyuff().traces, [outline]);
}

#[test]
fn the_header_names_model_and_program() {
    let header = by_pyuff().header.unwrap();
    assert_eq!((header.model.as_str(), header.written_by.as_str()), ("bench", "pyuff 2.5"));
    assert_eq!(header.description, "two nodes off the line");
}

#[test]
fn a_real_mode_has_frequency_damping_and_modal_mass() {
    let mode = &by_pyuff().nodal[0];
    assert!(mode.is_mode());
    assert_eq!((mode.analysis, mode.mode, mode.name.as_str()), (Analysis::NormalMode, 1, "first bending"));
    assert_eq!((mode.frequency, mode.damping_ratio), (Some(312.5), Some(0.003)));
    assert_eq!((mode.modal_mass, mode.hysteretic_damping), (Some(1.25), None));
    let along_y: Vec<_> = mode.values.iter().map(|at| (at.node, at.values[1].re)).collect();
    assert_eq!(along_y, [(1, 1.0), (2, -0.5), (3, 1.0)]);
}

#[test]
fn a_complex_mode_has_the_frequency_and_damping_of_its_eigenvalue() {
    let mode = &by_pyuff().nodal[1];
    let eigenvalue = Complex64::new(-30.0, 4000.0);
    assert!(mode.is_mode() && mode.complex);
    assert_eq!(mode.eigenvalue, Some(eigenvalue));
    let hertz = (30.0_f64.powi(2) + 4000.0_f64.powi(2)).sqrt() / (2.0 * std::f64::consts::PI);
    assert!((mode.frequency.unwrap() - hertz).abs() < 1e-9 * hertz);
    assert!((mode.damping_ratio.unwrap() - 0.0075).abs() < 1e-6, "{:?}", mode.damping_ratio);
    assert_eq!(mode.values[1].node, 3);
    assert_eq!(mode.values[1].values[1], Complex64::new(-2.0, -0.25));
}

#[test]
fn elements_of_every_kind_are_counted_with_their_nodes() {
    let records = "         1        21         1         1         7         2\n         0         1         1\n         1         2\n\
                   \x20        2        44         1         1         7         4\n         1         2         3         4\n\
                   \x20        3       116         1         1         7        10\n         1         2         3         4         5         6         7         8\n         9        10\n";
    let file = read(&dataset(2412, records)).unwrap();
    assert!(file.unreadable.is_empty(), "{:?}", file.unreadable);
    assert_eq!(file.elements[0], Element { label: 1, descriptor: 21, nodes: vec![1, 2] });
    assert_eq!(file.elements[1].nodes, [1, 2, 3, 4]);
    assert_eq!(file.elements[2].nodes, [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]);
}

/// The layout of finite-element programs, D exponents and touching numbers included.
#[test]
fn a_mode_of_dataset_2414_is_read_whatever_its_precision() {
    let head = |data_type| {
        format!(
            "         1\nMODE 1\n         1\nNONE\nNONE\nNONE\nNONE\nNONE\n\
             \x20        1         2         2         8{data_type:10}         3\n\
             \x20        0         0         1         0         0         4         0         0\n         0         0\n\
             \x20 0.00000E+00  1.25000E+02  0.00000E+00  2.00000E+00  1.00000E-02  0.00000E+00\n\
             \x20 0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00\n"
        )
    };
    let single =
        head(5) + "        17\n-1.00000E+00-2.00000E-01 3.00000E+00 0.00000E+00-4.00000E+00 5.00000E-01\n";
    let file = read(&dataset(2414, &single)).unwrap();
    assert!(file.unreadable.is_empty(), "{:?}", file.unreadable);
    let mode = &file.nodal[0];
    assert_eq!((mode.frequency, mode.damping_ratio, mode.modal_mass), (Some(125.0), Some(0.01), Some(2.0)));
    assert_eq!((mode.mode, mode.location, mode.dataset), (4, ValueLocation::Nodes, 2414));
    let expected = [Complex64::new(-1.0, -0.2), Complex64::new(3.0, 0.0), Complex64::new(-4.0, 0.5)];
    assert_eq!(mode.values[0].values, expected);

    let double =
        head(4) + "        17\n   1.0000000000000002D+00  -2.0000000000000000D+00   3.0000000000000000D-01\n";
    let file = read(&dataset(2414, &double)).unwrap();
    assert_eq!(file.nodal[0].values[0].values[0].re, 1.0000000000000002);
}

#[test]
fn values_on_elements_are_passed_with_their_header() {
    let records = "         1\nThickness\n         2\nNONE\nNONE\nNONE\nNONE\nNONE\n\
                   \x20        1         1         1        94         2         1\n\
                   \x20        1         0         1         0         1         0         0         0\n         0         0\n\
                   \x20 0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00\n\
                   \x20 0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00\n\
                   \x20        1         1\n      1.8E+01\n";
    let file = read(&dataset(2414, records)).unwrap();
    assert!(file.unreadable.is_empty(), "{:?}", file.unreadable);
    assert_eq!((file.nodal[0].location, file.nodal[0].quantity), (ValueLocation::Other(2), 94));
    assert!(!file.nodal[0].is_mode() && file.nodal[0].values.is_empty());
}

#[test]
fn numbers_that_fill_their_columns_are_told_apart() {
    let records = " 123456789         0         0         8-1.00000E+00-2.00000E-01-3.00000E+00\n";
    let file = read(&dataset(15, records)).unwrap();
    assert_eq!(file.nodes[0].nodes[0].coordinates, [-1.0, -0.2, -3.0]);
    let records = "         1        44         0         0         1         2\n12345678901234567891\n";
    let file = read(&dataset(2412, records)).unwrap();
    assert_eq!(file.elements[0].nodes, [1_234_567_890, 1_234_567_891]);
}

#[test]
fn a_damaged_geometry_is_named_and_keeps_nobody_from_the_rest() {
    let nodes = "         1         0         0         8  0.00000E+00  0.00000E+00\n";
    let bytes =
        [dataset(15, nodes), dataset(82, "         2         2        30\nline\n         1         2\n")]
            .concat();
    let file = read(&bytes).unwrap();
    assert_eq!(file.traces.len(), 1);
    assert_eq!(file.unreadable[0].number, 15);
    let message = file.unreadable[0].error.to_string();
    assert!(message.starts_with("dataset 1, line 3: expected label,"), "{message}");

    let flat = "         1         0         0         8         1\nFLAT\n  0.00000e+00  0.00000e+00  0.00000e+00  1.00000e+00  0.00000e+00  0.00000e+00\n  2.00000e+00  0.00000e+00  0.00000e+00\n";
    let file = read(&dataset(18, flat)).unwrap();
    let message = file.unreadable[0].error.to_string();
    assert!(message.contains("line 5") && message.contains("not on one line"), "{message}");
}

#[test]
fn a_geometry_that_the_file_ends_in_is_an_error_of_the_file() {
    let bytes = dataset(2411, "         1         1         1        11\n");
    let error = read(&bytes[..bytes.len() - 7]).unwrap_err();
    assert!(error.to_string().contains("the file ends where"), "{error}");
}
