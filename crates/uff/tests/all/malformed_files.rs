//! Damaged files: the message names the dataset, the place and what was expected there.

use crate::common::{dataset, even, uneven};
use jointscope_uff::{
    Abscissa, BinaryProblem, Data, Dataset58, ReadError, TextProblem, Units, WriteError, WriteProblem, read,
    write,
};

const BINARY: &str = "    58b     1     2          11          16     0     0           0           0";

/// The message up to its remedy, which may follow.
fn check(bytes: &[u8], message: &str) {
    let said = read(bytes).unwrap_err().to_string();
    assert!(said == message || said.starts_with(&format!("{message}; ")), "{said}\nis not\n{message}");
}

fn check_data(record7: &str, data: &str, message: &str) {
    check(&dataset("    58", record7, data.as_bytes()), message);
}

#[test]
fn a_file_that_is_no_universal_file_is_told_so() {
    check(b"", "the file is empty; copy or export it again");
    check(b" \n\n", "the file is empty; copy or export it again");
    check(
        b"frequency,re,im\n1,2,3\n",
        "does not start with a `    -1` line; export it as a universal file (UFF) whose lines end with LF or CR LF",
    );
    check(
        b"\x89PNG\r\n\x1a\n\0\0",
        "does not start with a `    -1` line; export it as a universal file (UFF) whose lines end with LF or CR LF",
    );
}

#[test]
fn text_between_datasets_is_named_with_its_line() {
    let first = dataset("    58", &even(2, 1), b"  1.00000e+00\n");
    check(
        &[&first, b"stray\n".as_slice(), &first].concat(),
        "line 16: expected the `    -1` line that opens dataset 2, found `stray`",
    );
}

#[test]
fn a_dataset_without_a_number_is_named() {
    check(
        b"    -1\n  xx\n    -1\n",
        "dataset 1, line 2: expected a dataset number in columns 1 to 6, found `xx`",
    );
    check(
        b"    -1\n",
        "dataset 1, line 1: the file ends where a dataset number was expected; copy or export it again",
    );
}

#[test]
fn a_file_that_begins_with_the_end_of_a_dataset_is_told_what_leaves_it_so() {
    let whole = dataset("    58", &even(2, 2), b"  1.00000e+00  2.00000e+00\n");
    for lost in [&b"    -1\n"[..], b"    -1\r\n", b"\n    -1\n\n"] {
        let message = read(&[lost, &whole].concat()).unwrap_err().to_string();
        for part in ["the dataset itself is missing", "pyuff", "`overwrite`", "`add` mode"] {
            assert!(message.contains(part), "`{part}` is missing from: {message}");
        }
    }
    // An empty dataset before the first is something else.
    let empty = [b"    -1\n    -1\n", &whole[..]].concat();
    assert!(read(&empty).unwrap_err().to_string().contains("line 2: expected a dataset number"));
}

#[test]
fn a_truncated_file_names_the_dataset_that_ends_early() {
    let whole = dataset("    58", &even(2, 2), b"  1.00000e+00  2.00000e+00\n");
    let two = [&whole[..], &whole[..]].concat();
    let in_header = whole.len() + 19;
    check(
        &two[..in_header],
        "dataset 2, line 18: the file ends where an ID line (records 1 to 5) was expected; copy or export it again",
    );
    let before_the_delimiter = two.len() - 7;
    check(
        &two[..before_the_delimiter],
        "dataset 2, line 29: the file ends where data or the `    -1` line that closes the dataset was expected; copy or export it again",
    );
    check(
        b"    -1\n    15\n   1  2  3\n",
        "dataset 1, line 3: the file ends where the `    -1` line that closes the dataset was expected; copy or export it again",
    );
}

#[test]
fn a_header_that_is_closed_early_names_the_record_that_is_missing() {
    check(
        b"    -1\n    58\na\nb\nc\nd\ne\n    -1\n",
        "dataset 1, line 8: the dataset is closed by `    -1` where record 6 (function type and nodes) was expected; export the file again",
    );
}

#[test]
fn a_header_field_that_is_no_number_is_named() {
    let text = String::from_utf8(dataset("    58", &even(2, 1), b"  1.00000e+00\n")).unwrap();
    check(
        text.replace("NONE               4   2", "NONE               x   2").as_bytes(),
        "dataset 1, line 8: expected a response node number (record 6, field 6), found `x`",
    );
    check_data(
        &even(3, 1),
        "  1.00000e+00\n",
        "dataset 1, line 9: expected ordinate data type 2, 4, 5 or 6 (record 7, field 1), found `3`",
    );
    check_data(
        "         2       abc         1  0.00000e+00  1.00000e+00  0.00000e+00",
        "",
        "dataset 1, line 9: expected a number of points (record 7, field 2), found `abc`",
    );
    check_data(
        "         2         1         1  0.00000e+00          NaN  0.00000e+00",
        "  1.00000e+00\n",
        "dataset 1, line 9: expected a finite abscissa increment (record 7, field 5), found `NaN`",
    );
    check(
        text.replace("        12    0    0    0 Acc", "        1x    0    0    0 Acc").as_bytes(),
        "dataset 1, line 11: expected data type and three exponents of the ordinate (record 9), found `1x`",
    );
}

#[test]
fn a_value_that_is_no_number_is_named_with_its_line() {
    check_data(
        &even(2, 3),
        "  1.00000e+00  2.0000oe+00  3.00000e+00\n",
        "dataset 1, line 14: expected a number, found `2.0000oe+00`; correct it or export the file again",
    );
    check_data(
        &even(2, 1),
        "*************\n",
        "dataset 1, line 14: expected a number, found `*************`; correct it or export the file again",
    );
}

#[test]
fn nan_and_infinity_are_named_with_their_spectral_line() {
    let message = "dataset 1: the value at spectral line (point) 1, counted from 0, is not finite; mask or remove it before export, or, where a binary dataset (58b) states the wrong byte order, export it again or as ASCII";
    check_data(&even(2, 3), "  1.00000e+00          NaN  3.00000e+00\n", message);
    check_data(
        &even(5, 3),
        "  1.00000e+00  0.00000e+00  1.00000e+00     Infinity  1.00000e+00  1.00000e+00\n",
        message,
    );
    check_data(
        &uneven(2, 3),
        "  1.00000e+00  0.00000e+00  2.00000e+00      1.#QNAN  1.00000e+00  1.00000e+00\n",
        message,
    );
    check_data(&even(2, 2), "  1.00000e+00  1.00000e+999\n", message);
    let data: Vec<u8> = [1.0, f64::NAN].iter().flat_map(|value: &f64| value.to_le_bytes()).collect();
    check(&dataset(BINARY, &even(4, 2), &data), message);
    let complex: Vec<u8> =
        [1.0, 2.0, 3.0, f64::NAN].iter().flat_map(|value: &f64| value.to_le_bytes()).collect();
    check(&dataset(BINARY, &even(6, 2), &complex), message);
    // An uneven abscissa before each ordinate, in both layouts of double precision.
    check(&dataset(BINARY, &uneven(4, 2), &complex), message);
    let mixed = [
        &1.0_f32.to_le_bytes()[..],
        &2.0_f64.to_le_bytes(),
        &f32::INFINITY.to_le_bytes(),
        &4.0_f64.to_le_bytes(),
    ];
    check(&dataset(BINARY, &uneven(4, 2), &mixed.concat()), message);
}

#[test]
fn a_blank_value_is_named_with_its_place_in_the_line() {
    let message = "dataset 1, line 14: value 2 of the line is blank; fill it in or export the file again";
    check_data(&even(2, 3), "  1.00000e+00               3.00000e+00\n", message);
    check_data(&even(4, 3), "  1.000000000000e+00                      3.000000000000e+00\n", message);
}

#[test]
fn too_few_and_too_many_values_are_told_apart() {
    check_data(
        &even(5, 3),
        "  1.00000e+00  2.00000e+00  3.00000e+00\n",
        "dataset 1, line 15: the dataset ends after 3 of 6 values; export the file again",
    );
    check_data(
        &even(2, 3),
        "",
        "dataset 1, line 14: the dataset ends after 0 of 3 values; export the file again",
    );
    let too_many =
        "dataset 1, line 14: more data than the 1 values the header states; is the number of points right?";
    check_data(&even(2, 1), "  1.00000e+00  2.00000e+00\n", too_many);
    check_data(
        &even(2, 1),
        "  1.00000e+00\n  0.00000e+00\n",
        "dataset 1, line 15: more data than the 1 values the header states; is the number of points right?",
    );
    check_data(
        &even(5, 999_999_999),
        "  1.00000e+00\n",
        "dataset 1, line 15: the dataset ends after 1 of 1999999998 values; export the file again",
    );
}

/// A throughput cut by hand and closed in good order; its ID lines hold `-1` in dates and paths.
#[test]
fn fewer_whole_points_than_stated_are_read_and_said() {
    let data = b"  1.00000e+00  2.00000e+00\n";
    let bytes = dataset("    58", &even(2, 2_508_876), data);
    let text = String::from_utf8(bytes).unwrap().replacen("beam\n", "[.../20EH -1 2017-12-06 a/1 :1]\n", 1);
    let file = read(text.as_bytes()).unwrap();
    let function = &file.datasets[0];
    assert_eq!(function.data, Data::Real(vec![1.0, 2.0]));
    assert_eq!((function.abscissa.len(), function.stated_points), (2, Some(2_508_876)));
    let whole = read(&dataset("    58", &even(2, 2), data)).unwrap();
    assert_eq!(whole.datasets[0].stated_points, None);
}

#[test]
fn truncated_binary_data_is_named_with_its_byte() {
    let bytes = dataset(BINARY, &even(4, 2), &[0; 16]);
    let start = bytes.len() - 16 - 7;
    check(
        &bytes[..start + 10],
        &format!(
            "dataset 1, byte {start}: the binary data of 2 points needs 16 bytes, the file ends after 10; copy or export it again"
        ),
    );
    check(
        &bytes[..start + 16],
        &format!(
            "dataset 1, byte {start}: the binary data of 2 points needs 16 bytes, the file ends after 16; copy or export it again"
        ),
    );
}

#[test]
fn binary_data_without_a_closing_delimiter_is_an_error() {
    let bytes = dataset(BINARY, &even(4, 2), &[0; 21]);
    let error = read(&bytes).unwrap_err();
    let problem = BinaryProblem::NoEnd { points: 2, stated: 16 };
    assert!(matches!(&error, ReadError::Binary { dataset: 1, problem: p, .. } if *p == problem), "{error}");
    let bytes = dataset(BINARY, &even(4, 7), &[0; 16]);
    let error = read(&bytes).unwrap_err();
    let problem = BinaryProblem::PointsAgainstBytes { points: 7, stated: 16 };
    assert!(matches!(&error, ReadError::Binary { dataset: 1, problem: p, .. } if *p == problem), "{error}");
}

#[test]
fn float_formats_other_than_ieee_are_refused() {
    let vax = BINARY.replace("     1     2", "     1     1");
    let error = read(&dataset(&vax, &even(4, 2), &[0; 16])).unwrap_err();
    assert_eq!(error, ReadError::Text { dataset: 1, line: 2, problem: TextProblem::FloatFormat(1) });
    let no_order = BINARY.replace("     1     2", "     7     2");
    assert!(matches!(
        read(&dataset(&no_order, &even(4, 2), &[0; 16])),
        Err(ReadError::Text { line: 2, problem: TextProblem::Field { .. }, .. })
    ));
}

#[test]
fn unit_factors_that_convert_nothing_are_refused() {
    let units = "    -1\n   164\n         1SI                           2\n  0.00000000000000000D+00  1.00000000000000000D+00  1.00000000000000000D+00\n  2.73150000000000000D+02\n    -1\n";
    check(
        units.as_bytes(),
        "dataset 1, line 4: expected factors of length, force and temperature above zero (dataset 164, record 2), found `0 1 1`",
    );
}

fn one_line(value: f64) -> Dataset58 {
    Dataset58::new(Abscissa::Even { start: 0.0, step: 1.0, count: 1 }, Data::Real(vec![value]))
}

#[test]
fn what_a_file_cannot_hold_is_not_written() {
    let check = |function: Dataset58, problem: WriteProblem| {
        assert_eq!(write(&[function]), Err(WriteError { function: 1, problem }));
    };
    check(one_line(f64::NAN), WriteProblem::NotFinite(0));
    check(one_line(f64::INFINITY), WriteProblem::NotFinite(0));
    check(
        Dataset58 { precision: jointscope_uff::Precision::Single, ..one_line(1e300) },
        WriteProblem::BeyondSingle(0),
    );
    check(
        Dataset58 { abscissa: Abscissa::Uneven(vec![1.0, 2.0]), ..one_line(1.0) },
        WriteProblem::LengthMismatch { ordinates: 1, abscissae: 2 },
    );
    check(Dataset58 { z_value: f64::NAN, ..one_line(1.0) }, WriteProblem::HeaderNotFinite);
    check(
        Dataset58 { sequence_number: 100_000, ..one_line(1.0) },
        WriteProblem::Number { field: "the sequence number", width: 5, found: 100_000 },
    );
    let mut long = one_line(1.0);
    long.id_lines[4] = "-1".to_owned();
    check(long, WriteProblem::Text { field: "ID line 5", width: 80, found: "-1".to_owned() });
    let mut long = one_line(1.0);
    long.ordinate_axis.label = "a label of 21 columns".to_owned();
    assert!(matches!(write(&[long]), Err(WriteError { problem: WriteProblem::Text { width: 20, .. }, .. })));
}

#[test]
fn units_are_not_taken_back() {
    let with_units = Dataset58 { units: Some(Units::si()), ..one_line(1.0) };
    let withdrawn = WriteError { function: 2, problem: WriteProblem::UnitsWithdrawn };
    assert_eq!(write(&[with_units, one_line(1.0)]), Err(withdrawn));
}
