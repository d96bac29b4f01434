//! FRFs, coherences, levels and lines of several files as one test.

use crate::common::*;
use jointscope_recordings::{FunctionError, HeldAmplitude, ReadOptions, Recording, RecordingError};
use jointscope_uff::{Abscissa, Axis, Data, Dataset58, FunctionType, UffFile, data_type};
use num_complex::Complex64;
use proptest::prelude::*;

fn id(dataset: Dataset58, line: usize, text: &str) -> Dataset58 {
    let mut dataset = dataset;
    dataset.id_lines[line - 1] = text.to_owned();
    dataset
}

fn on(dataset: Dataset58, start: f64, step: f64) -> Dataset58 {
    Dataset58 { abscissa: Abscissa::Even { start, step, count: 3 }, ..dataset }
}

#[test]
fn coherence_belongs_to_the_frf_of_the_same_channels_whatever_their_sense() {
    let gamma = [0.9, 0.95, 1.0];
    let recording =
        read(vec![coherence((4, 2), (1, 2), gamma), frf((4, -2), (1, 2)), frf((3, 2), (1, 2))]).unwrap();
    let frfs = recording.frfs().unwrap();
    assert_eq!(names(&recording), ["3/1", "4/1"]);
    assert_eq!((frfs.coherence(0), frfs.coherence(1)), (None, Some(gamma.as_slice())));
}

#[test]
fn a_coherence_above_one_by_rounding_passes_and_what_is_no_coherence_is_left_out_and_named() {
    let with = |value| read(vec![frf((4, 2), (1, 2)), coherence((4, 2), (1, 2), [0.5, value, 0.5])]).unwrap();
    let used = |recording: &Recording| recording.frfs().unwrap().coherence(0).is_some();
    assert!(used(&with(1.0 + 1e-7)));
    for (value, why) in [(1.5, "4/1 is above one"), (-0.1, "4/1 is negative")] {
        let recording = with(value);
        assert!(!used(&recording));
        assert!(recording.notes[0].contains(why), "{:?}", recording.notes);
    }
    let zero = read(vec![frf((4, 2), (1, 2)), coherence((4, 2), (1, 2), [0.0; 3])]).unwrap();
    assert!(!used(&zero) && zero.notes[0].contains("is zero on all lines"), "{:?}", zero.notes);
}

#[test]
fn values_that_no_structure_has_are_refused_and_a_dead_channel_is_not() {
    let times = |factor: f64| {
        let Data::Complex(values) = frf((4, 2), (1, 2)).data else { panic!("an FRF is complex") };
        Dataset58 { data: Data::Complex(values.iter().map(|v| v * factor).collect()), ..frf((4, 2), (1, 2)) }
    };
    let other = || frf((3, 2), (1, 2));
    for set in [vec![times(1e25)], vec![times(1e300), other()], vec![times(1e-40)]] {
        let error = read(set).unwrap_err();
        let is_named =
            matches!(&error, RecordingError::Function { problem: FunctionError::Magnitude(_), .. });
        assert!(is_named, "{error}");
    }
    for set in [vec![times(0.0), other()], vec![times(1e-40), other()], vec![times(1e-12)], vec![times(1e9)]]
    {
        read(set).unwrap();
    }
}

#[test]
fn averages_may_be_stated_and_coherence_left_aside() {
    let files = || vec![id(frf((4, 2), (1, 2)), 5, "averages 8"), coherence((4, 2), (1, 2), [0.5, 0.6, 0.7])];
    let stated = ReadOptions { averages: Some(12), ..ReadOptions::default() };
    let recording = read_with(files(), &stated).unwrap();
    assert_eq!(recording.frfs().unwrap().averages(0), Some(12));
    let aside = ReadOptions { ignore_coherence: true, ..ReadOptions::default() };
    assert_eq!(read_with(files(), &aside).unwrap().frfs().unwrap().coherence(0), None);
}

#[test]
fn a_coherence_without_its_frf_is_left_out_and_named() {
    let recording = read(vec![frf((4, 2), (1, 2)), coherence((3, 2), (1, 2), [1.0; 3])]).unwrap();
    assert_eq!(recording.notes, ["coherences without their FRF left out: 3/1"]);
}

#[test]
fn averages_come_from_id_line_five_of_the_frf_or_of_its_coherence() {
    let averages = |datasets| read(datasets).unwrap().frfs().unwrap().averages(0);
    assert_eq!(averages(vec![frf((4, 2), (1, 2))]), None);
    assert_eq!(averages(vec![id(frf((4, 2), (1, 2)), 5, "averages 8")]), Some(8));
    let gamma = id(coherence((4, 2), (1, 2), [1.0; 3]), 5, "Averages  5");
    assert_eq!(averages(vec![frf((4, 2), (1, 2)), gamma]), Some(5));
    assert_eq!(averages(vec![id(frf((4, 2), (1, 2)), 5, "taken on a Monday")]), None);
    for bad in ["averages", "averages 0", "averages many", "averages 5 or so"] {
        let answer = read(vec![id(frf((4, 2), (1, 2)), 5, bad)]).unwrap_err();
        assert!(
            matches!(&answer, RecordingError::Function { problem: FunctionError::Averages(line), .. } if line == bad),
            "{answer}"
        );
    }
}

#[test]
fn several_files_are_one_test_and_the_same_frf_in_two_of_them_is_named() {
    let files = |second: Dataset58| {
        let sources = [source("a.uff", vec![frf((4, 2), (1, 2))]), source("b.uff", vec![second])];
        Recording::of(&sources, &fixture(), &ReadOptions::default())
    };
    assert_eq!(names(&files(frf((3, 2), (1, 2))).unwrap()), ["3/1", "4/1"]);
    let message = files(frf((4, -2), (1, 2))).unwrap_err().to_string();
    assert!(message.starts_with("b.uff, function 1 (FRF 4:-y/1:+y): FRF 4/1 was given already"), "{message}");
    assert!(message.contains("a.uff, function 1"), "{message}");
}

#[test]
fn the_same_coherence_twice_is_named() {
    let gamma = || coherence((4, 2), (1, 2), [1.0; 3]);
    refused(
        vec![frf((4, 2), (1, 2)), gamma(), gamma()],
        &ReadOptions::default(),
        &["coherence 4/1 was given already"],
    );
}

#[test]
fn levels_are_kept_apart_each_on_its_own_lines() {
    let at = |level: &str, start| on(id(frf((3, 2), (3, 2)), 4, level), start, 0.05);
    let recording =
        read(vec![at("response 20 m/s^2", 79.0), at("force 0.5 N", 79.0), at("response 5 m/s^2", 79.2)])
            .unwrap();
    let held: Vec<_> = recording.levels.iter().map(|level| level.held.unwrap()).collect();
    assert_eq!(
        held,
        [HeldAmplitude::Force(0.5), HeldAmplitude::Response(5.0), HeldAmplitude::Response(20.0)]
    );
    assert_eq!(recording.levels[1].frfs.lines().hz()[0], 79.2);
    let message = recording.frfs().unwrap_err().to_string();
    assert!(message.contains("3 levels (force 0.5 N, response 5 m/s^2, response 20 m/s^2)"), "{message}");
}

#[test]
fn the_same_frf_twice_at_one_level_is_named_with_the_level() {
    let at = || id(frf((3, 2), (3, 2)), 4, "force 0.5 N");
    refused(vec![at(), at()], &ReadOptions::default(), &["FRF 3/3 at force 0.5 N was given already"]);
}

#[test]
fn functions_on_different_lines_are_named_with_their_lines() {
    let datasets = vec![frf((3, 2), (1, 2)), on(frf((4, 2), (1, 2)), 10.0, 5.0)];
    refused(
        datasets,
        &ReadOptions::default(),
        &["(FRF 4:+y/1:+y) has 3 lines from 10 to 20 Hz", "(FRF 3:+y/1:+y) has 3 lines from 10 to 15 Hz"],
    );
    let gamma = on(coherence((4, 2), (1, 2), [1.0; 3]), 0.0, 2.5);
    refused(vec![frf((4, 2), (1, 2)), gamma], &ReadOptions::default(), &["coherence 4:+y/1:+y"]);
}

#[test]
fn frfs_over_different_parts_of_one_axis_are_read_together_each_measured_on_its_own_lines() {
    let gamma = |dataset| on(dataset, 12.5, 2.5);
    let recording = read(vec![
        frf((3, 2), (1, 2)),
        gamma(frf((4, 2), (1, 2))),
        gamma(coherence((4, 2), (1, 2), [0.9, 0.8, 0.7])),
    ])
    .unwrap();
    let frfs = recording.frfs().unwrap();
    assert_eq!(frfs.lines().hz(), [10.0, 12.5, 15.0, 17.5]);
    let measured = |index: usize| (0..4).map(|line| frfs.is_measured(index, line)).collect::<Vec<_>>();
    assert_eq!(measured(0), [true, true, true, false]);
    assert_eq!(measured(1), [false, true, true, true]);
    assert_eq!(frfs.coherence(1).unwrap(), [0.0, 0.9, 0.8, 0.7]);
    // Two parts that do not overlap are parts of what a third one has.
    let long = |dataset: Dataset58| Dataset58 {
        abscissa: Abscissa::Even { start: 10.0, step: 2.5, count: 7 },
        data: Data::Complex(vec![Complex64::new(1.0, 0.1); 7]),
        ..dataset
    };
    let parts = vec![frf((3, 2), (1, 2)), on(frf((4, 2), (1, 2)), 20.0, 2.5), long(frf((3, 2), (2, 2)))];
    assert_eq!(read(parts).unwrap().frfs().unwrap().lines().len(), 7);
}

#[test]
fn a_coherence_of_fewer_values_than_lines_is_refused() {
    let gamma = coherence((4, 2), (1, 2), [0.9, 0.8, 0.7]);
    let short = Dataset58 { data: Data::Real(vec![0.9, 0.8]), ..gamma };
    let error = read(vec![frf((4, 2), (1, 2)), short]).unwrap_err();
    assert!(matches!(error, RecordingError::Spectra(_)), "{error}");
}

#[test]
fn the_same_numbers_in_other_units_of_frequency_are_other_lines() {
    let kilohertz = Axis::new(18, "Frequency", "kHz");
    let datasets = vec![frf((3, 2), (1, 2)), Dataset58 { abscissa_axis: kilohertz, ..frf((4, 2), (1, 2)) }];
    refused(datasets, &ReadOptions::default(), &["10000 to 15000 Hz", "10 to 15 Hz"]);
}

#[test]
fn a_force_and_a_response_of_the_same_number_are_two_levels() {
    let at = |level: &str| id(frf((3, 2), (3, 2)), 4, level);
    let recording = read(vec![at("response 5 m/s^2"), at("force 5 N"), frf((3, 2), (3, 2))]).unwrap();
    let held: Vec<_> = recording.levels.iter().map(|level| level.held).collect();
    assert_eq!(held, [None, Some(HeldAmplitude::Force(5.0)), Some(HeldAmplitude::Response(5.0))]);
}

#[test]
fn lines_that_do_not_ascend_name_their_function() {
    refused(
        vec![on(frf((4, 2), (1, 2)), 10.0, 0.0)],
        &ReadOptions::default(),
        &["function 1", "spectral lines must ascend"],
    );
}

#[test]
fn the_line_at_zero_hertz_is_kept_in_every_form() {
    for axis in [Axis::acceleration(), Axis::velocity(), Axis::displacement()] {
        let expected = if axis == Axis::acceleration() { VALUES[0] } else { Complex64::ZERO };
        let dataset = Dataset58 { ordinate_axis: axis, ..on(frf((4, 2), (1, 2)), 0.0, 2.5) };
        let recording = read(vec![dataset]).unwrap();
        assert_eq!(recording.frfs().unwrap().lines().hz(), [0.0, 2.5, 5.0]);
        assert_eq!(first_values(&recording)[0], expected);
    }
}

#[test]
fn a_magnitude_without_phase_is_refused() {
    let real = Dataset58 { data: Data::Real(vec![1.0; 3]), ..frf((4, 2), (1, 2)) };
    refused(vec![real], &ReadOptions::default(), &["without phase"]);
}

#[test]
fn time_histories_alone_ask_for_an_estimate_and_beside_frfs_are_noted() {
    let hits = || vec![history(1, Axis::excitation_force()), history(4, Axis::acceleration())];
    let answer = read(hits()).unwrap_err();
    assert!(
        matches!(&answer, RecordingError::OnlyTimeHistories { count: 2, channels, .. } if channels.len() == 2)
    );
    assert!(answer.to_string().contains("`jointscope estimate`"), "{answer}");
    let sound = vec![history(1, Axis::new(data_type::PRESSURE, "Sound", "Pa"))];
    let answer = read(sound).unwrap_err().to_string();
    assert!(answer.contains("there is 1 time history") && answer.contains("it is no force"), "{answer}");
    let recording = read([hits(), vec![frf((4, 2), (1, 2))]].concat()).unwrap();
    assert_eq!(recording.time_histories.count, 2);
    assert_eq!(recording.notes, ["2 time histories left aside: the files hold FRFs"]);
}

#[test]
fn files_without_frfs_say_what_they_hold_instead() {
    let spectrum = Dataset58 { function: FunctionType::AutoSpectrum, ..frf((4, 2), (4, 2)) };
    refused(
        vec![spectrum],
        &ReadOptions::default(),
        &["test.uff", "what there is: 1 auto spectrum (function type 2)"],
    );
    refused(vec![], &ReadOptions::default(), &["what there is: nothing"]);
    refused(
        vec![coherence((4, 2), (1, 2), [1.0; 3])],
        &ReadOptions::default(),
        &["what there is: 1 coherence (function type 6)"],
    );
    let mut header = source("header.uff", vec![]);
    header.file = UffFile { skipped: [(2467, 1), (1858, 2)].into(), ..header.file };
    let message = Recording::of(&[header], &fixture(), &ReadOptions::default()).unwrap_err().to_string();
    assert!(
        message.contains(
            "what there is: 2 datasets 1858 (qualifiers of functions), dataset 2467 (groups); export"
        ),
        "{message}"
    );
}

/// The values there are may be the wrong ones: nobody knows where the missing ones would have stood.
#[test]
fn a_function_cut_short_is_refused_where_it_is_needed_and_only_there() {
    let cut = |dataset: Dataset58| Dataset58 { stated_points: Some(400), ..dataset };
    let (here, elsewhere) = (frf((4, 2), (1, 2)), frf((99, 2), (1, 2)));
    let parts =
        ["test.uff, function 1 (FRF 4:+y/1:+y)", "states 400 points", "after 3", "export the file again"];
    refused(vec![cut(here.clone())], &ReadOptions::default(), &parts);
    let short_coherence = cut(coherence((4, 2), (1, 2), [1.0; 3]));
    refused(
        vec![here.clone(), short_coherence],
        &ReadOptions::default(),
        &["function 2 (coherence", "after 3"],
    );
    let recording = read(vec![here, cut(elsewhere), cut(history(1, Axis::acceleration()))]).unwrap();
    assert_eq!(names(&recording), ["4/1"]);
}

/// A file of three hammer points and three sensors, each FRF with its coherence behind it.
fn three_by_three() -> Vec<Dataset58> {
    let pairs = [1, 2, 5].map(|reference| [2, 3, 4].map(|response| ((response, 2), (reference, 2))));
    let both =
        |(response, reference)| [frf(response, reference), coherence(response, reference, [0.9, 0.95, 0.99])];
    pairs.into_iter().flatten().flat_map(both).collect()
}

#[test]
fn a_coherence_that_other_frfs_have_is_missed_aloud() {
    let says = |datasets: &[Dataset58]| read(datasets.to_vec()).unwrap().notes;
    let whole = three_by_three();
    assert!(says(&whole).is_empty(), "{:?}", says(&whole));
    let expected = "FRF 4:+y/5:+y has no coherence, which 8 others have: where a file was cut before it, copy or export that file again";
    assert_eq!(says(&whole[..17]), [expected]);
    // All FRFs first, then their coherences.
    let (frfs, coherences): (Vec<_>, Vec<_>) =
        whole.into_iter().partition(|dataset| dataset.function == FunctionType::FrequencyResponse);
    let apart = [frfs, coherences].concat();
    assert!(says(&apart).is_empty());
    let cut = says(&apart[..15]);
    assert!(
        cut[0].starts_with("FRFs 2:+y/5:+y, 3:+y/5:+y, 4:+y/5:+y have no coherence, which 6 others"),
        "{cut:?}"
    );
    // None has one: nothing is missing.
    assert!(says(&apart[..9]).is_empty());
}

#[test]
fn an_frf_that_every_other_reference_has_is_missed_aloud() {
    let says = |datasets: &[Dataset58]| read(datasets.to_vec()).unwrap().notes;
    let whole = three_by_three();
    let expected = "there is no FRF 4:+y/5:+y, and the 2 other references have that response: where a file was cut before it, copy or export that file again";
    assert_eq!(says(&whole[..16]), [expected]);
    // A whole reference less is another test.
    assert!(says(&whole[..12]).is_empty());
    // Beside one other reference it may be meant so, or else the other responses tell.
    assert!(says(&whole[..8]).is_empty());
    let cut = says(&whole[..10]);
    assert!(
        cut[0].starts_with("there is no FRF 4:+y/2:+y, and the 2 other responses have that reference"),
        "{cut:?}"
    );
}

proptest! {
    #[test]
    fn the_order_of_datasets_means_nothing(order in Just((0..9).collect::<Vec<usize>>()).prop_shuffle()) {
        let mut all = Vec::new();
        for (response, reference) in [((4, -2), (1, 2)), ((3, 2), (1, -2)), ((4, 6), (2, 2))] {
            all.push(id(frf(response, reference), 5, "averages 4"));
            all.push(coherence(response, reference, [0.9, 0.99, response.0 as f64 / 10.0]));
            all.push(frf((9, 2), reference));
        }
        let expected = read(all.clone()).unwrap();
        let shuffled = read(order.iter().map(|&index| all[index].clone()).collect()).unwrap();
        prop_assert_eq!(shuffled, expected);
    }
}
