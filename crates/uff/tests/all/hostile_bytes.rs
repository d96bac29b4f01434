//! Arbitrary and damaged bytes end in a value or an error, never in a panic or a huge allocation.

use crate::common::{dataset, even, uneven};
use jointscope_uff::{read, write};
use proptest::prelude::*;

const UNITS: &[u8] = b"    -1\n   164\n         2Foot (pound f)               2\n  3.28083989501312334D+00  2.24808943099710480D-01  1.79999999999999999D+00\n  4.59670000000000002D+02\n    -1\n";
const BINARY: &str = "    58b     1     2          11          48     0     0           0           0";

fn valid_file() -> Vec<u8> {
    let ascii =
        b"  1.00000e+00 -2.00000e+00  3.00000e+00  4.00000e+00  5.00000e+00  6.00000e+00\n  7.00000e+00\n";
    let mixed = b"  1.00000e+00 -2.000000000000e+00  3.000000000000e+00\n";
    [
        UNITS,
        &dataset("    58", &even(2, 7), ascii),
        &dataset(BINARY, &even(6, 3), &[0x3f; 48]),
        b"    -1\n   151\ntitle\n    -1\n",
        include_bytes!("samples/geometry-by-pyuff.uff"),
        b"    -1\n  2412\n         1        21         1         1         7         2\n         0         1         1\n         1         2\n    -1\n",
        &dataset("    58", &uneven(6, 1), mixed),
        &dataset(BINARY, &uneven(5, 4), &[0x40; 48]),
    ]
    .concat()
}

/// Whatever is read can be written again or is refused, and both without a panic.
fn swallow(bytes: &[u8]) {
    if let Ok(file) = read(bytes) {
        let _ = write(&file.datasets);
    }
}

#[test]
fn the_file_that_is_damaged_below_is_whole() {
    assert_eq!(read(&valid_file()).unwrap().datasets.len(), 4);
}

#[test]
fn every_truncation_is_survived() {
    let bytes = valid_file();
    (0..bytes.len()).for_each(|length| swallow(&bytes[..length]));
}

/// Between two datasets a file that was cut is a whole one; what its functions then lack,
/// `jointscope-recordings` tells.
#[test]
fn a_file_that_is_cut_inside_a_dataset_is_refused_and_only_there() {
    let bytes = valid_file();
    let whole = read(&bytes).unwrap();
    for length in 0..bytes.len() {
        let cut = &bytes[..length];
        let text = cut.trim_ascii_end();
        let between = text.ends_with(b"    -1") && {
            // A delimiter closes a dataset where another one, or nothing, follows it.
            let rest = bytes[text.len()..].trim_ascii_start();
            rest.is_empty() || rest.starts_with(b"-1\n")
        };
        match read(cut) {
            Ok(file) => {
                assert!(between, "the first {length} bytes were read");
                assert!(whole.datasets.starts_with(&file.datasets) && file.unreadable.is_empty());
            }
            Err(error) => assert!(!between, "the first {length} bytes: {error}"),
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn arbitrary_bytes_are_survived(bytes in proptest::collection::vec(any::<u8>(), 0..600)) {
        swallow(&bytes);
        swallow(&[b"    -1\n    58\n".as_slice(), &bytes].concat());
        swallow(&[b"    -1\n    58b     1     2          11          16\n".as_slice(), &bytes].concat());
    }

    #[test]
    fn arbitrary_data_is_survived(data in "[-+0-9.eEdD nNaA\n]{0,200}", data_type in prop_oneof![Just(2_usize), Just(4), Just(5), Just(6)], points in 0_usize..20) {
        swallow(&dataset("    58", &even(data_type, points), data.as_bytes()));
        swallow(&dataset("    58", &uneven(data_type, points), data.as_bytes()));
        swallow(&dataset("   164", "", data.as_bytes()));
    }

    #[test]
    fn arbitrary_geometry_is_survived(records in "[-+0-9.eEdD \n]{0,300}", number in prop::sample::select(vec![15, 18, 55, 82, 151, 2411, 2412, 2414, 2420])) {
        let bytes = format!("    -1\n{number:6}\n{records}\n    -1\n");
        swallow(bytes.as_bytes());
    }

    #[test]
    fn flipped_inserted_and_deleted_bytes_are_survived(
        damage in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0_u8..3), 1..12)
    ) {
        let mut bytes = valid_file();
        for (at, byte, kind) in damage {
            let at = at.index(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                _ => { bytes.remove(at); }
            }
        }
        swallow(&bytes);
    }

    #[test]
    fn digits_in_the_header_may_be_anything(damage in proptest::collection::vec((any::<prop::sample::Index>(), b'0'..=b'9'), 1..12)) {
        let mut bytes = valid_file();
        let digits: Vec<usize> = (0..bytes.len()).filter(|&at| bytes[at].is_ascii_digit()).collect();
        for (at, digit) in damage {
            let at = digits[at.index(digits.len())];
            bytes[at] = digit;
        }
        swallow(&bytes);
    }
}
