//! What the unit fields decide, what they leave open, and what they contradict.

use crate::common::*;
use jointscope_recordings::ReadOptions;
use jointscope_spectra::FrfForm;
use jointscope_uff::{Axis, Dataset58, Units, data_type};
use num_complex::Complex64;

const LBF: f64 = 4.4482216152605;

/// FRF 4/1 with data types and units labels.
fn with(numerator: (i32, &str), denominator: (i32, &str)) -> Dataset58 {
    Dataset58 {
        ordinate_axis: Axis::new(numerator.0, "", numerator.1),
        denominator_axis: Axis::new(denominator.0, "", denominator.1),
        ..frf((4, 2), (1, 2))
    }
}

fn factor(dataset: Dataset58, units: Option<&str>) -> (f64, Vec<String>) {
    let recording = read_with(vec![dataset], &options(&[], units)).unwrap();
    let ratio = first_values(&recording)[0] / VALUES[0];
    assert!(ratio.im.abs() < 1e-12 * ratio.norm(), "a factor between real units is real: {ratio}");
    (ratio.re, recording.notes)
}

#[track_caller]
fn check(dataset: Dataset58, units: Option<&str>, expected: f64, note: &str) {
    let (found, notes) = factor(dataset, units);
    assert!((found - expected).abs() <= 1e-6 * expected.abs(), "expected {expected}, got {found}");
    let all = notes.join("\n");
    assert!(if note.is_empty() { all.is_empty() } else { all.contains(note) }, "`{note}` is not in: {all}");
}

#[test]
fn si_labels_change_nothing_and_need_no_note() {
    check(with((12, "m/s^2"), (13, "N")), None, 1.0, "");
    check(with((12, "SI"), (13, "SI")), None, 1.0, "");
    check(with((12, "(m/s^2)/N"), (13, "NONE")), None, 1.0, "");
}

#[test]
fn labels_of_other_units_are_honoured_and_noted() {
    check(with((12, "g"), (13, "lbf")), None, 9.80665 / LBF, "test.uff: accelerations in `g` were converted");
    check(with((12, "mm/s2"), (13, "N")), None, 1e-3, "`mm/s2`");
    check(with((12, "g/lbf"), (0, "NONE")), None, 9.80665 / LBF, "`g/lbf`");
    check(with((12, "1/kg"), (13, "NONE")), None, 1.0, "");
}

#[test]
fn without_labels_dataset_164_decides() {
    let dataset = Dataset58 { units: Some(inches()), ..with((12, "NONE"), (13, "NONE")) };
    check(dataset, None, 0.0254 / LBF, "unit system `Inch (pound f)` (dataset 164)");
    let dataset = Dataset58 { units: Some(Units::si()), ..with((12, "NONE"), (13, "")) };
    check(dataset, None, 1.0, "");
    let scalar = Dataset58 { units: Some(inches()), ..with((12, "NONE"), (13, "NONE")) };
    let scalar = Dataset58 { response: jointscope_uff::Node::new(4, 0), ..scalar };
    check(scalar, None, 0.0254 / LBF, "Inch");
}

#[test]
fn a_moment_in_inch_pounds_is_converted_with_its_length() {
    let dataset = Dataset58 {
        units: Some(inches()),
        ordinate_axis: Axis::new(12, "", "NONE"),
        denominator_axis: Axis::new(13, "", "NONE"),
        ..frf((4, 6), (1, 6))
    };
    check(dataset, None, 1.0 / (0.0254 * LBF), "moments");
    let labels = Dataset58 {
        ordinate_axis: Axis::new(12, "", "rad/s^2"),
        denominator_axis: Axis::new(13, "", "in*lbf"),
        ..frf((4, 6), (1, 6))
    };
    check(labels, None, 1.0 / (0.0254 * LBF), "moments in `in*lbf`");
}

#[test]
fn a_label_and_a_dataset_164_that_disagree_need_the_analysts_word() {
    let dataset = || Dataset58 { units: Some(Units::si()), ..with((12, "g"), (13, "N")) };
    refused(
        vec![dataset()],
        &ReadOptions::default(),
        &["function 1", "`g`", "SI: Meter (newton)", "--assume-units"],
    );
    check(dataset(), Some("g,N"), 9.80665, "disagree");
    let agreeing = Dataset58 { units: Some(inches()), ..with((12, "in/s^2"), (13, "lbf")) };
    check(agreeing, None, 0.0254 / LBF, "`in/s^2`");
    let ratio = || Dataset58 { units: Some(inches()), ..with((12, "g/N"), (13, "NONE")) };
    refused(vec![ratio()], &ReadOptions::default(), &["`g/N`", "Inch (pound f)"]);
    check(ratio(), Some("g,N"), 9.80665, "disagree");
}

#[test]
fn typed_axes_without_any_unit_are_si_by_the_formats_default_and_noted() {
    check(with((12, "NONE"), (13, "NONE")), None, 1.0, "accelerations: the file states no unit, SI taken");
}

#[test]
fn the_analysts_units_apply_where_a_file_states_none_and_only_there() {
    check(with((12, "NONE"), (13, "NONE")), Some("g,lbf"), 9.80665 / LBF, "`g` taken");
    check(with((0, "NONE"), (0, "NONE")), Some("g,lbf"), 9.80665 / LBF, "`lbf` taken");
    check(with((12, "m/s^2"), (13, "N")), Some("g,lbf"), 1.0, "was not needed");
    let open = Dataset58 { units: Some(Units::si()), ..with((1, ""), (1, "")) };
    check(open, Some("g,lbf"), 9.80665 / LBF, "`g` taken");
}

#[test]
fn what_is_not_stated_is_asked_for() {
    let default = ReadOptions::default();
    refused(
        vec![with((0, "NONE"), (13, "N"))],
        &default,
        &["test.uff, function 1 (FRF 4:+y/1:+y)", "what the response is", "--assume-units m/s^2,N"],
    );
    refused(vec![with((12, "m/s^2"), (1, "NONE"))], &default, &["what the force is", "--assume-units"]);
}

#[test]
fn a_label_tells_what_an_open_data_type_is() {
    let omega = std::f64::consts::TAU * 10.0;
    let recording = read(vec![with((1, "mm/s"), (0, "N"))]).unwrap();
    assert_eq!(recording.levels[0].recorded_forms, [FrfForm::Mobility]);
    let found = first_values(&recording)[0];
    let expected = VALUES[0] * Complex64::new(0.0, 1e-3 * omega);
    assert!((found - expected).norm() < 1e-12, "expected {expected}, got {found}");
}

#[test]
fn data_types_and_labels_that_contradict_each_other_are_refused() {
    let default = ReadOptions::default();
    let both = ["data type 12 (accelerations)", "`m/s`"];
    refused(vec![with((12, "m/s"), (13, "N"))], &default, &both);
    refused(vec![with((12, "m/s^2"), (13, "V"))], &default, &["data type 13 (forces)", "`V`"]);
    refused(vec![with((12, "m/s^2/N"), (13, "V"))], &default, &["data type 13 (forces)", "`V`"]);
    refused(
        vec![with((11, "NONE"), (13, "N"))],
        &options(&[], Some("g,N")),
        &["accelerations", "velocities"],
    );
    let rotation = |label| Dataset58 { ordinate_axis: Axis::new(12, "", label), ..frf((4, 6), (1, 2)) };
    refused(vec![rotation("g")], &default, &["rotational accelerations", "`g`"]);
    refused(vec![rotation("m/s")], &default, &["rotational accelerations", "`m/s`"]);
}

#[test]
fn a_rotation_with_the_si_label_of_a_translation_is_si_and_noted() {
    let recording = read(vec![frf((4, 6), (1, 6))]).unwrap();
    assert_close(&first_values(&recording), Complex64::ONE);
    assert_eq!(recording.notes.len(), 2);
    assert!(
        recording.notes[1].contains("rotations carry the label of a translation in SI units, `rad` taken")
    );
}

#[test]
fn an_unknown_label_is_named_with_the_remedy() {
    let parts = ["function 1", "`furlong`", "--assume-units"];
    refused(vec![with((12, "furlong"), (13, "N"))], &ReadOptions::default(), &parts);
}

#[test]
fn mobilities_and_receptances_become_accelerances_together() {
    let mobility = Dataset58 { ordinate_axis: Axis::velocity(), ..frf((3, 2), (1, 2)) };
    let receptance = Dataset58 { ordinate_axis: Axis::displacement(), ..frf((4, 2), (1, 2)) };
    let recording = read(vec![receptance, mobility, frf((1, 2), (1, 2))]).unwrap();
    let level = &recording.levels[0];
    assert_eq!(level.recorded_forms, [FrfForm::Accelerance, FrfForm::Mobility, FrfForm::Receptance]);
    for (line, hz) in [10.0, 12.5, 15.0].into_iter().enumerate() {
        let i_omega = Complex64::new(0.0, std::f64::consts::TAU * hz);
        for (frf, factor) in [Complex64::ONE, i_omega, i_omega * i_omega].into_iter().enumerate() {
            let (found, expected) = (level.frfs.values(frf)[line], VALUES[line] * factor);
            assert!((found - expected).norm() <= 1e-14 * expected.norm(), "{hz} Hz: {expected}, got {found}");
        }
    }
}

#[test]
fn functions_that_are_no_motion_per_force_are_left_out_or_refused() {
    let strain = || with((data_type::STRAIN, "NONE"), (13, "N"));
    let transmissibility = with((12, "m/s^2"), (12, "m/s^2"));
    let recording = read(vec![strain(), frf((4, 2), (1, 2)), transmissibility]).unwrap();
    assert_eq!(names(&recording), ["4/1"]);
    assert!(recording.notes[0].contains("2 functions of type FRF, but no motion per force"));
    refused(vec![strain()], &ReadOptions::default(), &["data types 3 over 13"]);
}

#[test]
fn frequencies_are_read_in_hertz_kilohertz_or_radians_and_times_refused() {
    let on = |axis| Dataset58 { abscissa_axis: axis, ..frf((4, 2), (1, 2)) };
    let lines = |axis| read(vec![on(axis)]).unwrap().frfs().unwrap().lines().hz().to_vec();
    assert_eq!(lines(Axis::new(18, "", "NONE")), [10.0, 12.5, 15.0]);
    assert_eq!(lines(Axis::new(18, "", "kHz")), [1e4, 1.25e4, 1.5e4]);
    assert!((lines(Axis::new(18, "", "rad/s"))[0] - 10.0 / std::f64::consts::TAU).abs() < 1e-15);
    refused(vec![on(Axis::time())], &ReadOptions::default(), &["data type 17", "Hz, kHz or rad/s"]);
}
