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

/// Fixture and recording by case number.
pub const CASES: [(&str, &[u8]); 20] = [
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

/// What is true of them, under seal.
pub const TRUTHS: &str = include_str!("../../../../fixtures/concealed/truths.json");

/// SHA-256 of the sealed truths, published with the cases.
pub const TRUTHS_SHA256: &str = "c5ea509764ce149b5792840497b85edbeca056f5a3616766b9f5e376c0b9b4c1";
