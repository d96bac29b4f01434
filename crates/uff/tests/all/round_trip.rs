//! What is written is read back: every ordinate type, spacing, encoding and byte order.

use jointscope_uff::{
    Abscissa, Axis, ByteOrder, Data, Dataset58, Encoding, FunctionType, Node, Precision, TemperatureMode,
    Units, read, write,
};
use num_complex::Complex64;
use proptest::prelude::*;

/// Values of all magnitudes that both precisions can hold, touching columns included.
fn value() -> BoxedStrategy<f64> {
    prop_oneof![
        4 => -1e3..1e3_f64,
        2 => (-30_i32..30, -9.99..9.99_f64).prop_map(|(exponent, mantissa)| mantissa * 10_f64.powi(exponent)),
        1 => Just(0.0),
        1 => Just(-0.0),
    ]
    .boxed()
}

fn extreme_value() -> BoxedStrategy<f64> {
    prop_oneof![proptest::num::f64::NORMAL, proptest::num::f64::SUBNORMAL, proptest::num::f64::ZERO].boxed()
}

fn text(width: usize) -> impl Strategy<Value = String> {
    proptest::string::string_regex(&format!("[A-Za-z²é][ -~]{{0,{}}}[A-Za-z0-9]", width - 2)).unwrap()
}

fn axis() -> impl Strategy<Value = Axis> {
    (0..21_i32, -9..9_i32, -9..9_i32, -9..9_i32, text(20), text(20))
        .prop_map(|(data_type, l, f, t, label, units)| Axis { data_type, exponents: [l, f, t], label, units })
}

fn node() -> impl Strategy<Value = Node> {
    // No blanks in names: they are legal, but a name is a word to every program.
    ("[A-Za-z][A-Za-z0-9]{0,9}", -999_999_999..=9_999_999_999_i64, -6..=6_i32)
        .prop_map(|(entity, number, direction)| Node { entity, number, direction })
}

/// Whole numbers of one digit to ten, of either sign.
fn any_magnitude() -> impl Strategy<Value = i32> {
    (0..10_u32, any::<i32>()).prop_map(|(digits, number)| number % 10_i32.pow(digits))
}

fn units() -> impl Strategy<Value = Units> {
    (1..10_i32, text(20), any::<bool>(), 1e-6..1e6_f64, 1e-6..1e6_f64, 0.5..2.0_f64, -500.0..500.0_f64)
        .prop_map(
            |(
                code,
                description,
                absolute,
                length_factor,
                force_factor,
                temperature_factor,
                temperature_offset,
            )| Units {
                code,
                description,
                temperature_mode: if absolute {
                    TemperatureMode::Absolute
                } else {
                    TemperatureMode::Relative
                },
                length_factor,
                force_factor,
                temperature_factor,
                temperature_offset,
            },
        )
}

fn encoding() -> impl Strategy<Value = Encoding> {
    prop_oneof![
        Just(Encoding::Ascii),
        Just(Encoding::Binary(ByteOrder::Little)),
        Just(Encoding::Binary(ByteOrder::Big))
    ]
}

fn data(value: BoxedStrategy<f64>) -> impl Strategy<Value = Data> {
    prop_oneof![
        proptest::collection::vec(value.clone(), 0..23).prop_map(Data::Real),
        proptest::collection::vec((value.clone(), value).prop_map(|(re, im)| Complex64::new(re, im)), 0..23)
            .prop_map(Data::Complex)
    ]
}

fn function(value: BoxedStrategy<f64>) -> impl Strategy<Value = Dataset58> {
    let header = (
        proptest::array::uniform5(text(80)),
        0..30_i32,
        (0..=9_999_999_999_i64, -9_999..=99_999_i64, 0..=99_i64),
        node(),
        node(),
        proptest::array::uniform4(axis()),
    );
    let abscissa =
        (any::<bool>(), value.clone(), value.clone(), proptest::collection::vec(value.clone(), 23));
    let form = (encoding(), prop_oneof![Just(Precision::Single), Just(Precision::Double)]);
    (header, abscissa, data(value.clone()), value, form).prop_map(
        |(header, abscissa, data, z_value, form)| {
            let (id_lines, function, (function_id, sequence_number, load_case), response, reference, axes) =
                header;
            let [abscissa_axis, ordinate_axis, denominator_axis, z_axis] = axes;
            let (even, start, step, uneven) = abscissa;
            let count = data.len();
            let abscissa = if even {
                Abscissa::Even { start, step, count }
            } else {
                Abscissa::Uneven(uneven[..count].to_vec())
            };
            Dataset58 {
                id_lines,
                function: FunctionType::from_code(function),
                function_id,
                sequence_number,
                load_case,
                response,
                reference,
                z_value,
                abscissa_axis,
                ordinate_axis,
                denominator_axis,
                z_axis,
                precision: form.1,
                encoding: form.0,
                ..Dataset58::new(abscissa, data)
            }
        },
    )
}

fn numbers(data: &Data) -> Vec<f64> {
    match data {
        Data::Real(values) => values.clone(),
        Data::Complex(values) => values.iter().flat_map(|value| [value.re, value.im]).collect(),
    }
}

/// Relative tolerance of stored ordinates and stored abscissae; 0 asks for the same bits.
fn tolerances(function: &Dataset58) -> (f64, f64) {
    // Half a unit of the last printed digit over a mantissa of at least 1.
    let printed = |decimals: i32| 0.5000001 * 10_f64.powi(-decimals);
    match (function.encoding, function.precision) {
        (Encoding::Ascii, Precision::Single) => (printed(5), printed(5)),
        (Encoding::Ascii, Precision::Double) => (printed(12), printed(5)),
        (Encoding::Binary(_), Precision::Single) => {
            (f64::from(f32::EPSILON) / 2.0, f64::from(f32::EPSILON) / 2.0)
        }
        (Encoding::Binary(_), Precision::Double) => (0.0, 0.0),
    }
}

fn check_values(what: &str, expected: &[f64], got: &[f64], relative: f64) {
    assert_eq!(expected.len(), got.len(), "number of {what}");
    for (point, (&expected, &got)) in expected.iter().zip(got).enumerate() {
        // Below 1e-300 a double itself has fewer digits than its text.
        let allowed = relative * expected.abs()
            + if relative > 0.0 { 1e-300 * relative + f64::MIN_POSITIVE * f64::EPSILON } else { 0.0 };
        assert!(
            (expected - got).abs() <= allowed && (relative > 0.0 || expected.to_bits() == got.to_bits()),
            "{what} {point}: expected {expected:e}, got {got:e}"
        );
    }
}

fn check(written: &Dataset58, got: &Dataset58) {
    let (ordinate, abscissa) = tolerances(written);
    check_values("ordinate", &numbers(&written.data), &numbers(&got.data), ordinate);
    match (&written.abscissa, &got.abscissa) {
        (
            Abscissa::Even { start, step, count },
            Abscissa::Even { start: got_start, step: got_step, count: got_count },
        ) => {
            check_values("start and step", &[*start, *step], &[*got_start, *got_step], 0.5000001e-5);
            assert_eq!(count, got_count);
        }
        (Abscissa::Uneven(values), Abscissa::Uneven(got)) => check_values("abscissa", values, got, abscissa),
        (written, got) => panic!("abscissa {written:?} came back as {got:?}"),
    }
    check_values("z-value", &[written.z_value], &[got.z_value], 0.5000001e-5);
    let rest = Dataset58 {
        abscissa: got.abscissa.clone(),
        data: got.data.clone(),
        z_value: got.z_value,
        ..written.clone()
    };
    assert_eq!(&rest, got);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn every_function_comes_back(functions in proptest::collection::vec(function(value()), 1..4)) {
        let file = read(&write(&functions).unwrap()).unwrap();
        prop_assert_eq!(file.datasets.len(), functions.len());
        functions.iter().zip(&file.datasets).for_each(|(written, got)| check(written, got));
    }

    #[test]
    fn values_at_the_ends_of_the_range_stay_in_their_columns(mut function in function(extreme_value())) {
        if function.encoding != Encoding::Ascii {
            function.precision = Precision::Double;
        }
        // Rounding the largest doubles up to six digits would leave their range.
        let too_large = |value: f64| value.abs() > 1.79e308;
        prop_assume!(!numbers(&function.data).iter().chain(&function.abscissa.values()).any(|&value| too_large(value) || !value.is_finite()));
        prop_assume!(!too_large(function.z_value));
        let file = read(&write(std::slice::from_ref(&function)).unwrap()).unwrap();
        check(&function, &file.datasets[0]);
    }

    #[test]
    fn what_the_writer_takes_the_reader_takes(
        mut function in function(value()), directions in proptest::array::uniform2(any_magnitude()), exponents in proptest::array::uniform3(any_magnitude()), sequence_number in any_magnitude()
    ) {
        [function.response.direction, function.reference.direction] = directions;
        function.ordinate_axis.exponents = exponents;
        function.sequence_number = i64::from(sequence_number);
        // Names that could be numbers of their own to a reader who goes by blanks.
        function.response.entity = "A 1".to_owned();
        function.ordinate_axis.label = "5 mm".to_owned();
        if let Ok(bytes) = write(std::slice::from_ref(&function)) {
            check(&function, &read(&bytes).unwrap().datasets[0]);
        }
    }

    #[test]
    fn a_second_writing_is_the_same_to_the_byte(functions in proptest::collection::vec(function(value()), 1..3)) {
        let once = write(&functions).unwrap();
        let twice = write(&read(&once).unwrap().datasets).unwrap();
        prop_assert_eq!(once, twice);
    }

    #[test]
    fn units_come_back_exactly_with_the_functions_they_govern(
        functions in proptest::collection::vec(function(value()), 3), units in proptest::collection::vec(units(), 2)
    ) {
        let mut functions = functions;
        functions[1].units = Some(units[0].clone());
        functions[2].units = Some(units[1].clone());
        let file = read(&write(&functions).unwrap()).unwrap();
        prop_assert!(file.skipped.is_empty());
        functions.iter().zip(&file.datasets).for_each(|(written, got)| check(written, got));
    }
}
