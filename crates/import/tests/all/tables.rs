//! Tables of FRFs in the layouts that analysers and spreadsheets write.

use jointscope_import::{ColumnMap, Format, read};
use jointscope_uff::{Data, Dataset58, FunctionType};
use num_complex::Complex64;
use proptest::prelude::*;

fn datasets(table: &str, columns: &[&str]) -> Vec<Dataset58> {
    let imported = read(table.as_bytes(), "folder/frf.csv", &ColumnMap::parse(columns).unwrap());
    let imported = imported.unwrap_or_else(|error| panic!("{error}\n{table}"));
    assert_eq!(imported.format, Format::Table);
    assert_eq!(imported.used.len(), columns.len(), "every entry is of use");
    imported.file.datasets
}

#[track_caller]
fn refused(table: &str, columns: &[&str], parts: &[&str]) {
    let message =
        read(table.as_bytes(), "frf.csv", &ColumnMap::parse(columns).unwrap()).unwrap_err().to_string();
    parts.iter().for_each(|part| assert!(message.contains(part), "`{part}` is missing from: {message}"));
}

/// One FRF 4/1 on 10 and 12.5 Hz.
#[track_caller]
fn check(table: &str, columns: &[&str], unit: &str) {
    let all = datasets(table, columns);
    let frf = &all[0];
    assert_eq!((frf.response.number, frf.reference.number), (4, 1), "{table}");
    assert_eq!(frf.abscissa.values(), [10.0, 12.5], "{table}");
    assert_eq!(frf.ordinate_axis.units, unit, "{table}");
    let Data::Complex(values) = &frf.data else { panic!("an FRF is complex") };
    for (value, expected) in values.iter().zip([Complex64::new(0.0, 2.0), Complex64::new(-1.5, 0.0)]) {
        assert!((value - expected).norm() < 1e-12, "{value}, not {expected}, in\n{table}");
    }
}

#[test]
fn one_frf_comes_in_every_usual_layout() {
    let unit = "m/s^2/N";
    check("frequency_hz,4/1 real [m/s^2/N],4/1 imag [m/s^2/N]\n10,0,2\n12.5,-1.5,0\n", &[], unit);
    check("Frequency (Hz);Re(4/1) [m/s^2/N];Im(4/1)\r\n10,0;0,0;2,0\r\n12,5;-1,5;0\r\n", &[], unit);
    check("f\tH(4/1) mag (m/s^2/N)\tH(4/1) phase (deg)\n10\t2\t90\n12,5\t1,5\t-180\n", &[], unit);
    check("freq 4/1_mag 4/1_phase_rad\n10 2 1.5707963267948966\n12.5 1.5 3.141592653589793\n", &[], "NONE");
    check(
        "\"frequency [kHz]\",\"real\",\"imag\"\n0.01,0,2\n"
            .replace("kHz", "Hz")
            .replace("0.01", "10")
            .as_str()
            .replace("2\n", "2\n12.5,-1.5,0\n")
            .as_str(),
        &["4/1 [m/s^2/N]"],
        unit,
    );
    check("frequency,real,imag\n10,0,2\n12.5,-1.5,0\n", &["frf.csv=4:+y/1 [m/s^2/N]"], unit);
    check("frequency,H1 real,H1 imag\n10,0,2\n12.5,-1.5,0\n", &["H1=4/1 [m/s^2/N]"], unit);
    check("f,4/1 real,4/1 imag\n10,0,2\n12.5,-1.5,0\n", &["4/1 [m/s^2/N]"], unit);
    // Lines before the header, remarks, and a line of units below it.
    let preamble = "Analyser 9000;v1\nSerial;42\n# remark\n\nFrequency;4/1 real;4/1 imag\nHz;m/s^2/N;m/s^2/N\n10;0;2\n12,5;-1,5;0\n";
    check(preamble, &[], unit);
    // A delimiter at the end of every line.
    check("f;4/1 re;4/1 im;\n10;0;2;\n12,5;-1,5;0;\n", &[], "NONE");
}

#[test]
fn many_frfs_with_coherence_come_from_one_table() {
    let table = "f [Hz],4:+z/1:+z real [g/N],4:+z/1:+z imag [g/N],4:+z/1:+z coherence,3/1 mag,3/1 phase [deg]\n10,1,2,0.9,3,0\n20,4,5,0.8,6,90\n";
    let all = datasets(table, &[]);
    let found: Vec<_> = all.iter().map(|d| (d.function, d.response.number, d.response.direction)).collect();
    use FunctionType::{Coherence, FrequencyResponse};
    assert_eq!(found, [(FrequencyResponse, 4, 3), (Coherence, 4, 3), (FrequencyResponse, 3, 2)]);
    assert_eq!(all[1].data, Data::Real(vec![0.9, 0.8]));
}

#[test]
fn a_unit_of_two_parts_is_one_for_motion_and_one_for_force() {
    let all = datasets("f,4/1 real [g per lbf],4/1 imag\n10,1,2\n20,3,4\n", &[]);
    assert_eq!((all[0].ordinate_axis.units.as_str(), all[0].denominator_axis.units.as_str()), ("g", "lbf"));
}

#[test]
fn a_bad_field_is_named_with_line_and_column() {
    refused(
        "f,4/1 real,4/1 imag\n10,0,2\n12.5,x1,0\n",
        &[],
        &["line 3, column 2 (`4/1 real`)", "`x1` is no finite number"],
    );
    refused("f,4/1 real,4/1 imag\n10,0,2\n12.5,,0\n", &[], &["line 3, column 2", "blank"]);
    refused("f,4/1 real,4/1 imag\n10,0,2\n12.5,nan,0\n", &[], &["line 3, column 2", "`nan`"]);
    refused("f,4/1 real,4/1 imag\n10,0,2\n12.5,1\n", &[], &["line 3: 2 fields where the header has 3"]);
    refused("f;4/1 real;4/1 imag\n10;0;2\n12,5;1.234,5;0\n", &[], &["line 3, column 2", "`1.234,5`"]);
    refused("f,4/1 mag,4/1 phase [deg]\n10,-20,0\n20,1,2\n", &[], &["line 2, column 2", "decibels"]);
}

#[test]
fn a_column_that_says_too_little_is_refused_with_the_remedy() {
    refused("f,real,imag\n10,0,2\n", &[], &["line 1, column 2 (`real`)", "`4/1 real`", "--columns \"4/1\""]);
    refused("f,H1 real,H1 imag\n10,0,2\n", &[], &["--columns \"H1=4/1\""]);
    refused("f,4/1 real,3/1 imag\n10,0,2\n", &[], &["4:+y/1:+y has no column `imag`"]);
    refused("f,4/1 mag,4/1 phase\n10,0,2\n", &[], &["column 3", "`phase [deg]` or `phase [rad]`"]);
    refused("f,4/1 mag [dB],4/1 phase [deg]\n10,0,2\n", &[], &["column 2", "decibels"]);
    refused(
        "f,4/1 real,4/1 imag,temperature\n10,0,2,20\n",
        &[],
        &["column 4 (`temperature`)", "take the column out"],
    );
    refused("time [s],4/1 real,4/1 imag\n10,0,2\n", &[], &["column 1", "time histories as UFF"]);
    refused("f,4/1 real,4/1 imag,4/1 real\n10,0,2,1\n", &[], &["column 4", "a second real of 4:+y/1:+y"]);
    refused("f,4/1 real [g/N],4/1 imag [m/s^2/N]\n10,0,2\n", &[], &["column 3", "`m/s^2/N`", "`g/N`"]);
    refused("4/1 real,4/1 imag\n0,2\n", &[], &["no column is named `frequency`"]);
}

#[test]
fn text_that_is_no_table_says_what_one_needs() {
    refused(
        "name: 1",
        &[],
        &["no universal file", "line 1 reads `name: 1`", "frequency [Hz],4/1 real,4/1 imag"],
    );
    refused("{ \"name\": 1 }", &[], &["a JSON file, such as a fixture"]);
    // As numpy prints complex numbers.
    refused(
        "(-0.077+2.68e-08j)\n(-0.175-0.12j)\n",
        &[],
        &["no line holds a frequency and numbers", "(-0.077+2.68e-08j)"],
    );
    refused("10,0,2\n20,1,2\n", &[], &["no header of 3 names stands above the numbers of line 1"]);
}

proptest! {
    /// A table of any numbers, in any of the delimiters, comes back as the numbers that were written.
    #[test]
    fn what_is_written_is_read(
        values in prop::collection::vec((-1e6..1e6_f64, -1e6..1e6_f64), 2..20),
        form in 0..4_usize,
    ) {
        let (delimiter, comma) = [(",", false), (";", true), ("\t", true), (";", false)][form];
        let number = |value: f64| if comma { value.to_string().replace('.', ",") } else { value.to_string() };
        let mut table = ["frequency", "4/1 real", "4/1 imag"].join(delimiter) + "\n";
        for (at, (re, im)) in values.iter().enumerate() {
            table += &([number(at as f64 + 0.5), number(*re), number(*im)].join(delimiter) + "\n");
        }
        let all = datasets(&table, &[]);
        let expected: Vec<Complex64> = values.iter().map(|(re, im)| Complex64::new(*re, *im)).collect();
        prop_assert_eq!(&all[0].data, &Data::Complex(expected));
    }
}

#[test]
fn a_first_row_with_a_field_that_is_no_number_is_named_and_not_passed_over() {
    let table =
        |row: &str, units: &str| format!("frequency,4/1 real,4/1 imag\n{units}{row}\n12.5,-1.5,0\n15,1,1\n");
    for (row, what) in
        [("10,NaN,2", "`NaN`"), ("10,1e999,2", "`1e999`"), ("10,,2", "blank"), ("10,--,2", "`--`")]
    {
        refused(&table(row, ""), &[], &["line 2, column 2 (`4/1 real`)", what]);
        refused(&table(row, "Hz,m/s^2/N,m/s^2/N\n"), &[], &["line 3, column 2 (`4/1 real`)", what]);
    }
    refused(&table("NaN,1,2", ""), &[], &["line 2, column 1 (`frequency`)", "`NaN`"]);
    let two = "frequency,4/1 real,4/1 imag\n10,NaN,2\n11,NaN,2\n12.5,-1.5,0\n";
    refused(two, &[], &["line 2, column 2"]);
}

#[test]
fn a_column_with_decimal_commas_and_points_is_refused() {
    let table = "f;4/1 real;4/1 imag\n10;0,5;2\n12,5;-1.500;0\n15,0;1;0\n";
    refused(table, &[], &["line 3, column 2 (`4/1 real`)", "`-1.500`, but `0,5` on line 2"]);
    // A column of its own program may have its own sign.
    check("f;4/1 real [m/s^2/N];4/1 imag\n10;0,0;2.0\n12,5;-1,5;0.0\n", &[], "m/s^2/N");
}

#[test]
fn a_first_row_with_too_few_cells_is_named_and_not_taken_for_a_missing_header() {
    let table = |row: &str| format!("frequency,4/1 real,4/1 imag\n{row}\n12.5,-1.5,0\n15,1,1\n");
    for (row, found) in [("10,0", 2), ("10", 1), ("10,0,2,7", 4)] {
        refused(&table(row), &[], &[&format!("line 2: {found} fields where the header has 3")]);
    }
    refused("f;4/1 real;4/1 imag\nHz;g/N;g/N\n10;0\n20;1;2\n", &[], &["line 3: 2 fields"]);
}
