//! The concealed cases that the program carries: `fixtures/concealed` as it was when the program was built.

/// Fixture and recording of a directory of `fixtures/concealed`.
macro_rules! case {
    ($number:literal) => {
        (
            include_str!(concat!("../../../../fixtures/concealed/", $number, "/fixture.json")),
            include_bytes!(concat!("../../../../fixtures/concealed/", $number, "/hammer-test.uff")),
        )
    };
}

/// A case's files: fixture and recording.
pub type Files = (&'static str, &'static [u8]);

/// Cases of the laboratory's FRFs, numbered from 0.
pub const LABORATORY: [Files; 20] = [
    case!("00"),
    case!("01"),
    case!("02"),
    case!("03"),
    case!("04"),
    case!("05"),
    case!("06"),
    case!("07"),
    case!("08"),
    case!("09"),
    case!("10"),
    case!("11"),
    case!("12"),
    case!("13"),
    case!("14"),
    case!("15"),
    case!("16"),
    case!("17"),
    case!("18"),
    case!("19"),
];

/// Cases whose FRFs come from solids, numbered after them.
pub const SOLID: [Files; 4] = [case!("20"), case!("21"), case!("22"), case!("23")];

/// Cases of hits over time, the last ones.
pub const STRUCK: [Files; 3] = [case!("24"), case!("25"), case!("26")];

/// What is true of them, under seal.
pub const TRUTHS: &str = include_str!("../../../../fixtures/concealed/truths.json");

/// SHA-256 of the sealed truths, published with the cases.
pub const TRUTHS_SHA256: &str = "4cc62f599c45ade5ee8ff96fa921908aefe74c712a168fb6407f6ccd540a23cc";
