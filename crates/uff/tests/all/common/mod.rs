//! Pieces of universal files for the tests.

/// Records 1 to 5, 6, 8 to 11 of an accelerance; record 7 is the caller's.
pub(crate) fn dataset(identification: &str, record7: &str, data: &[u8]) -> Vec<u8> {
    let header = format!(
        "    -1\n{identification}\nbeam\nNONE\nNONE\nNONE\naverages 8\n\
         \x20   4         0    0         0 NONE               4   2 NONE               1  -2\n\
         {record7}\n\
         \x20       18    0    0    0 Frequency            Hz\n\
         \x20       12    0    0    0 Acceleration         m/s^2\n\
         \x20       13    0    0    0 Excitation Force     N\n\
         \x20        0    0    0    0 NONE                 NONE\n"
    );
    let mut bytes = header.into_bytes();
    bytes.extend_from_slice(data);
    bytes.extend_from_slice(b"    -1\n");
    bytes
}

/// Record 7 with even spacing: start 10, step 2.5.
pub(crate) fn even(data_type: usize, points: usize) -> String {
    format!("{data_type:10}{points:10}{:10}  1.00000e+01  2.50000e+00  0.00000e+00", 1)
}

/// Record 7 with uneven spacing.
pub(crate) fn uneven(data_type: usize, points: usize) -> String {
    format!("{data_type:10}{points:10}{:10}  0.00000e+00  0.00000e+00  0.00000e+00", 0)
}
