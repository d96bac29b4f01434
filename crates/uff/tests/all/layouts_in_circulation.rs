//! Files as other programs write them.

use crate::common::{dataset, even, uneven};
use jointscope_uff::{Abscissa, ByteOrder, Data, Encoding, FunctionType, Node, Precision, read};
use num_complex::Complex64;

const BINARY: &str = "    58b     1     2          11        3200     0     0           0           0";

fn real(bytes: &[u8]) -> Vec<f64> {
    match read(bytes).unwrap().datasets.remove(0).data {
        Data::Real(values) => values,
        Data::Complex(_) => panic!("expected real data"),
    }
}

fn check_real(record7: &str, data: &str, expected: &[f64]) {
    assert_eq!(real(&dataset("    58", record7, data.as_bytes())), expected, "data:\n{data}");
}

#[test]
fn every_ascii_layout_of_the_specification_is_read() {
    let singles =
        "  1.00000e+00 -2.00000e+00  3.00000e+00  4.00000e+00  5.00000e+00  6.00000e+00\n  7.00000e+00\n";
    check_real(&even(2, 7), singles, &[1.0, -2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
    let doubles = "  1.000000000000e+00 -2.000000000000e+00  3.000000000000e+00  4.000000000000e+00\n  5.000000000000e+00\n";
    check_real(&even(4, 5), doubles, &[1.0, -2.0, 3.0, 4.0, 5.0]);

    let mixed = "  1.00000e+00 -2.000000000000e+00  3.00000e+00  4.000000000000e+00\n  5.00000e+00  6.000000000000e+00\n";
    let function = read(&dataset("    58", &uneven(4, 3), mixed.as_bytes())).unwrap().datasets.remove(0);
    assert_eq!(function.abscissa, Abscissa::Uneven(vec![1.0, 3.0, 5.0]));
    assert_eq!(function.data, Data::Real(vec![-2.0, 4.0, 6.0]));

    let mixed = "  1.00000e+00 -2.000000000000e+00  3.000000000000e+00\n  4.00000e+00  5.000000000000e+00  6.000000000000e+00\n";
    let function = read(&dataset("    58", &uneven(6, 2), mixed.as_bytes())).unwrap().datasets.remove(0);
    assert_eq!(function.abscissa, Abscissa::Uneven(vec![1.0, 4.0]));
    assert_eq!(function.data, Data::Complex(vec![Complex64::new(-2.0, 3.0), Complex64::new(5.0, 6.0)]));
}

#[test]
fn fields_that_touch_are_parted_by_their_columns() {
    check_real(&even(2, 3), "-1.00000e+00-2.00000e+00-3.00000e+00\n", &[-1.0, -2.0, -3.0]);
    check_real(&even(2, 3), "-1.00000e-100-2.00000e+100-3.00000e+00\n", &[-1e-100, -2e100, -3.0]);
    check_real(&even(2, 3), " -1.00000-100 -2.00000+100  3.00000D+00\n", &[-1e-100, -2e100, 3.0]);
    check_real(&even(2, 2), "1.2345678e+002.3456789e+00\n", &[1.2345678, 2.3456789]);
    check_real(&even(2, 2), "1.234567e-10 1.5\n", &[1.234567e-10, 1.5]);
}

#[test]
fn numbers_out_of_their_columns_are_parted_by_blanks() {
    check_real(&even(2, 3), "1.0 2.0 3.0\n", &[1.0, 2.0, 3.0]);
    check_real(&even(2, 3), "1.0\n\n2.0   \n3.0\n", &[1.0, 2.0, 3.0]);
    check_real(&even(4, 2), "  -1.43019390106e+01   1.41790986061e+00\n", &[-14.3019390106, 1.41790986061]);
    // Twenty columns each in a dataset that promises thirteen.
    check_real(&even(2, 2), "  -1.43019390106e+01   1.41790986061e+00\n", &[-14.3019390106, 1.41790986061]);
    check_real(&even(2, 1), "  -1.43019390106e+01\n", &[-14.3019390106]);
    check_real(&even(2, 2), "                 1.0                 2.0\n", &[1.0, 2.0]);
}

#[test]
fn zeros_that_fill_the_last_line_are_left_out() {
    let data = "  5.00000e+00  9.93003e-01 -1.08420e-19  5.03501e+00  1.00135e+00  0.00000e+00\n  1.00000e+02  8.03837e-01  0.00000e+00  0.00000e+00  0.00000e+00  0.00000e+00\n";
    let function = read(&dataset("    58", &uneven(5, 3), data.as_bytes())).unwrap().datasets.remove(0);
    assert_eq!(function.abscissa, Abscissa::Uneven(vec![5.0, 5.03501, 100.0]));
}

#[test]
fn crlf_and_a_missing_final_line_end_change_nothing() {
    let lf = dataset("    58", &even(2, 2), b"  1.00000e+00  2.00000e+00\n");
    let expected = read(&lf).unwrap();
    let crlf = String::from_utf8(lf.clone()).unwrap().replace('\n', "\r\n");
    assert_eq!(read(crlf.as_bytes()).unwrap(), expected);
    assert_eq!(read(lf.trim_ascii_end()).unwrap(), expected);
    let marked = [b"\xef\xbb\xbf\n".as_slice(), &lf, b"\n\n"].concat();
    assert_eq!(read(&marked).unwrap(), expected);
}

#[test]
fn record_6_is_read_in_both_spellings_and_with_columns_that_are_off() {
    for record6 in [
        "    4         0    3         0 NONE               1   2 NONE               4  -6",
        "    4         0    3         0       NONE         1   2       NONE         4  -6",
        "    4         0    3           0 NONE               1   2 NONE               4  -6",
        "   4         0    3         0 NONE               1   2 NONE               4  -6",
        "4 0 3 0 NONE 1 2 NONE 4 -6",
    ] {
        let text = String::from_utf8(dataset("    58", &even(2, 1), b"  1.00000e+00\n")).unwrap();
        let record = text.lines().nth(7).unwrap().to_owned();
        let function = read(text.replace(&record, record6).as_bytes()).unwrap().datasets.remove(0);
        assert_eq!(function.function, FunctionType::FrequencyResponse, "{record6}");
        assert_eq!(function.sequence_number, 3, "{record6}");
        assert_eq!(function.response, Node::new(1, 2), "{record6}");
        assert_eq!(function.reference, Node::new(4, -6), "{record6}");
    }
}

#[test]
fn record_7_may_have_touching_fields() {
    let record7 = "         2         1         1-1.000000e-02 7.812500e-05  0.00000e+00";
    let function = read(&dataset("    58", record7, b"  1.00000e+00\n")).unwrap().datasets.remove(0);
    assert_eq!(function.abscissa, Abscissa::Even { start: -0.01, step: 7.8125e-5, count: 1 });
}

#[test]
fn a_blank_entity_name_is_read() {
    let text = String::from_utf8(dataset("    58", &even(2, 1), b"  1.00000e+00\n")).unwrap();
    let function = read(text.replace(" NONE               4", "                    4").as_bytes()).unwrap();
    assert_eq!(function.datasets[0].response, Node { entity: String::new(), number: 4, direction: 2 });
}

#[test]
fn text_that_is_not_utf_8_is_taken_as_latin_1() {
    let mut bytes = dataset("    58", &even(2, 1), b"  1.00000e+00\n");
    let at = bytes.windows(4).position(|window| window == b"beam").unwrap();
    bytes[at + 1] = 0xe9;
    assert_eq!(read(&bytes).unwrap().datasets[0].id_lines[0], "b\u{e9}am");
}

fn doubles(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

#[test]
fn a_wrong_byte_count_does_not_hide_the_data() {
    let data = doubles(&[1.0, -2.0, 3.0, 4.0]);
    for stated in [16, 32, 0, 999_999] {
        let identification =
            format!("    58b     1     2          11{stated:12}     0     0           0           0");
        let function = read(&dataset(&identification, &even(6, 2), &data)).unwrap().datasets.remove(0);
        assert_eq!(function.data, Data::Complex(vec![Complex64::new(1.0, -2.0), Complex64::new(3.0, 4.0)]));
        assert_eq!(function.encoding, Encoding::Binary(ByteOrder::Little));
    }
}

#[test]
fn a_line_end_after_binary_data_is_not_data() {
    for line_end in ["", "\n", "\r\n"] {
        let data = [doubles(&[1.0, 2.0]), line_end.as_bytes().to_vec()].concat();
        assert_eq!(real(&dataset(BINARY, &even(4, 2), &data)), [1.0, 2.0]);
    }
}

#[test]
fn binary_data_may_look_like_delimiters() {
    let data = [b"\n    -1\n".as_slice(), b"    -1\n\n", b"\r\n\r\n\r\n\r\n"].concat();
    assert_eq!(real(&dataset(BINARY, &even(4, 3), &data)).len(), 3);
    let file = [dataset(BINARY, &even(4, 3), &data), dataset(BINARY, &even(2, 6), &data)].concat();
    assert_eq!(read(&file).unwrap().datasets.len(), 2);
}

#[test]
fn both_layouts_of_an_uneven_double_precision_abscissa_are_told_apart() {
    let expected = (Abscissa::Uneven(vec![1.5, 2.5, 4.5]), Data::Real(vec![0.1, 0.2, 0.3]));
    let both_double = doubles(&[1.5, 0.1, 2.5, 0.2, 4.5, 0.3]);
    let mut single_abscissa = Vec::new();
    for (abscissa, ordinate) in [(1.5_f32, 0.1_f64), (2.5, 0.2), (4.5, 0.3)] {
        single_abscissa.extend_from_slice(&abscissa.to_le_bytes());
        single_abscissa.extend_from_slice(&ordinate.to_le_bytes());
    }
    for data in [both_double, single_abscissa] {
        let function = read(&dataset(BINARY, &uneven(4, 3), &data)).unwrap().datasets.remove(0);
        assert_eq!((function.abscissa, function.data), expected);
    }
}

#[test]
fn doubles_under_a_header_that_says_single_are_read_as_doubles() {
    let function =
        read(&dataset(BINARY, &even(2, 3), &doubles(&[0.1, 0.2, 0.3]))).unwrap().datasets.remove(0);
    assert_eq!(function.data, Data::Real(vec![0.1, 0.2, 0.3]));
    assert_eq!(function.precision, Precision::Double);
}

#[test]
fn other_datasets_are_skipped_and_counted_by_number() {
    let groups = "    -1\n  2467\n         1         0         0         0         0         0         0         4\n    -1\n";
    let title = "    -1\n   151\ntitle\nNONE\nNONE\n    -1\n";
    let file = [
        groups.as_bytes(),
        title.as_bytes(),
        &dataset("    58", &even(2, 1), b"  1.00000e+00\n"),
        groups.as_bytes(),
    ]
    .concat();
    let file = read(&file).unwrap();
    assert_eq!(file.datasets.len(), 1);
    assert_eq!(file.skipped.into_iter().collect::<Vec<_>>(), [(2467, 2)]);
    // A header of fewer lines than it should have names what it can.
    assert_eq!((file.header.unwrap().model.as_str(), file.unreadable.len()), ("title", 0));
}

#[test]
fn units_govern_the_functions_after_them() {
    // The example printed in the specification of dataset 164.
    let units = "    -1\n   164\n         2Foot (pound f)               2\n  3.28083989501312334D+00  2.24808943099710480D-01  1.79999999999999999D+00\n  4.59670000000000002D+02\n    -1\n";
    let function = dataset("    58", &even(2, 1), b"  1.00000e+00\n");
    let file = read(&[&function, units.as_bytes(), &function].concat()).unwrap();
    assert_eq!(file.datasets[0].units, None);
    let units = file.datasets[1].units.as_ref().unwrap();
    assert_eq!((units.code, units.description.as_str()), (2, "Foot (pound f)"));
    assert!((units.si_per_unit([1, 0, 0]) - 0.3048).abs() < 1e-12);
    assert!((units.si_per_unit([0, 1, 0]) - 4.4482216152605).abs() < 1e-9);
}
