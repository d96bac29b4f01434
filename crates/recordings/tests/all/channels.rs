//! Nodes and directions of the files against points, y and θ of the fixture.

use crate::common::*;
use jointscope_recordings::ReadOptions;
use num_complex::Complex64;

#[test]
fn node_numbers_are_point_names_and_direction_six_is_theta() {
    let recording = read(vec![frf((4, 6), (1, 2)), frf((4, 2), (1, 2))]).unwrap();
    assert_eq!(names(&recording), ["4/1", "4:theta/1"]);
}

#[test]
fn a_negative_direction_turns_the_sign_and_two_turn_it_back() {
    assert_close(&first_values(&read(vec![frf((4, -2), (1, 2))]).unwrap()), Complex64::new(-1.0, 0.0));
    assert_close(&first_values(&read(vec![frf((4, 2), (1, -2))]).unwrap()), Complex64::new(-1.0, 0.0));
    assert_close(&first_values(&read(vec![frf((4, -2), (1, -2))]).unwrap()), Complex64::ONE);
}

#[test]
fn a_map_renames_nodes_and_turns_directions() {
    let options = options(&["101:+z=1:+y", "104:-x=4:+y"], None);
    let recording = read_with(vec![frf((104, 1), (101, 3))], &options).unwrap();
    assert_eq!(names(&recording), ["4/1"]);
    assert_close(&first_values(&recording), Complex64::new(-1.0, 0.0));
}

#[test]
fn a_mapped_node_of_a_triaxial_sensor_is_known_by_its_entries_alone() {
    let datasets = vec![frf((3, 1), (1, 2)), frf((3, 2), (1, 2)), frf((3, 3), (1, 2))];
    let recording = read_with(datasets, &options(&["3:+z=3:+y"], None)).unwrap();
    assert_eq!(names(&recording), ["3/1"]);
    assert!(recording.notes[0].contains("2 FRFs in directions other than y and theta left out"));
}

#[test]
fn one_entry_maps_a_direction_of_all_nodes() {
    let datasets =
        || vec![frf((4, -3), (1, 3)), frf((3, 3), (1, 3)), frf((4, 1), (1, 3)), frf((9, 3), (1, 3))];
    let recording = read_with(datasets(), &options(&["+z=+y"], None)).unwrap();
    assert_eq!(names(&recording), ["3/1", "4/1"]);
    assert_eq!(recording.frfs().unwrap().values(1)[0], -VALUES[0]);
    assert_eq!(
        recording.notes,
        [
            "1 FRF at nodes that the fixture does not have left out: 9:+z/1:+z",
            "1 FRF in directions other than y and theta left out: 4:+x/1:+z"
        ]
    );
    // What is y in the files is then another axis than the fixture's, unless the map says so too.
    let mixed = vec![frf((4, 3), (1, 2))];
    refused(
        mixed.clone(),
        &options(&["+z=+y"], None),
        &["no FRF belongs to the fixture", "`--map 1:+y=1:+y`"],
    );
    assert_eq!(names(&read_with(mixed, &options(&["+z=+y", "+y=+y"], None)).unwrap()), ["4/1"]);
    refused(datasets(), &options(&["+y=+y"], None), &["`+y=+y` applies to no channel", "4:-z"]);
}

#[test]
fn one_entry_maps_nodes_whose_numbers_fit_it() {
    let datasets = vec![frf((104, 3), (1, 2)), frf((103, 3), (1, 2)), frf((110, 3), (1, 2))];
    let recording = read_with(datasets, &options(&["10*:+z=*:+y"], None)).unwrap();
    assert_eq!(names(&recording), ["3/1", "4/1"]);
    assert_eq!(recording.notes, ["1 FRF at nodes that the fixture does not have left out: 110:+z/1:+y"]);
    // A sensor and a hammer of one point have node numbers of their own.
    let driving = vec![frf((101, 3), (1, 3))];
    assert_eq!(names(&read_with(driving, &options(&["+z=+y", "10*:+z=*:+y"], None)).unwrap()), ["1/1"]);
}

#[test]
fn entries_of_many_nodes_that_contradict_each_other_ask_for_one_of_the_node() {
    let map = &["10*:+z=*:+y", "1*:+z=*:+y"];
    refused(
        vec![frf((104, 3), (1, 2))],
        &options(map, None),
        &["`10*:+z=*:+y` and `1*:+z=*:+y`", "104:+z", "node 104"],
    );
    let triaxial = || vec![frf((3, 2), (1, 3)), frf((3, 3), (1, 3))];
    let both = &["+z=+y", "+y=+y"];
    refused(triaxial(), &options(both, None), &["`+y=+y`", "3:+y and 3:+z", "channel 3: give node 3"]);
    let mended = &["+z=+y", "+y=+y", "3:+z=3:+y"];
    assert_eq!(names(&read_with(triaxial(), &options(mended, None)).unwrap()), ["3/1"]);
    let two_nodes = vec![frf((103, 3), (1, 3)), frf((3, 3), (1, 3))];
    refused(two_nodes, &options(&["+z=+y", "10*:+z=*:+y"], None), &["103:+z and 3:+z", "channel 3"]);
}

#[test]
fn the_other_axes_of_a_triaxial_sensor_are_left_out_and_named() {
    let datasets = vec![frf((3, 1), (1, 2)), frf((3, -2), (1, 2)), frf((3, 3), (1, 2))];
    let recording = read(datasets).unwrap();
    assert_eq!(names(&recording), ["3/1"]);
    assert!(recording.notes[0].ends_with("3:+x/1:+y, 3:+z/1:+y"), "{:?}", recording.notes);
}

#[test]
fn a_direction_that_is_not_transverse_asks_for_the_map_entry_to_write() {
    let default = ReadOptions::default();
    refused(
        vec![frf((4, 2), (1, 2)), frf((3, -3), (1, 2))],
        &default,
        &["test.uff, function 2 (FRF 3:-z/1:+y)", "`--map 3:+z=3:+y`", "`--map +z=+y`"],
    );
    refused(vec![frf((3, 4), (1, 2))], &default, &["`--map 3:+rx=3:+theta`"]);
    refused(vec![frf((3, 7), (1, 2))], &default, &["direction 7 of node 3 does not exist"]);
}

#[test]
fn a_node_without_direction_is_taken_as_y_and_the_notes_say_so() {
    let recording = read(vec![frf((4, 0), (1, 2))]).unwrap();
    assert_eq!(names(&recording), ["4/1"]);
    assert_eq!(recording.notes, ["no direction is stated for nodes 4: +y taken"]);
    let mapped = read_with(vec![frf((4, 0), (1, 2))], &options(&["4:0=4:-y"], None)).unwrap();
    assert_close(&first_values(&mapped), Complex64::new(-1.0, 0.0));
    assert!(mapped.notes.is_empty(), "{:?}", mapped.notes);
}

#[test]
fn frfs_beyond_the_fixture_are_left_out_by_name_even_in_odd_directions() {
    let recording = read(vec![frf((9, 3), (1, 2)), frf((4, 2), (1, 2))]).unwrap();
    assert_eq!(names(&recording), ["4/1"]);
    assert_eq!(recording.notes, ["1 FRF at nodes that the fixture does not have left out: 9:+z/1:+y"]);
}

#[test]
fn files_of_other_nodes_only_are_refused_with_both_sides_named() {
    refused(
        vec![frf((102, 3), (101, 3))],
        &ReadOptions::default(),
        &["101:+z, 102:+z", "points 1, 2, 3, 4, 5", "`--map 101:+z=1:+y`"],
    );
}

#[test]
fn map_entries_must_name_a_point_of_the_fixture_and_a_channel_of_the_files() {
    let datasets = || vec![frf((4, 2), (1, 2))];
    refused(datasets(), &options(&["4:+y=9:+y"], None), &["`4:+y=9:+y`", "1, 2, 3, 4, 5"]);
    refused(datasets(), &options(&["7:+y=3:+y"], None), &["`7:+y=3:+y`", "1:+y, 4:+y"]);
}

#[test]
fn a_rotation_of_a_storey_is_refused() {
    refused(
        vec![frf((5, 6), (1, 2))],
        &ReadOptions::default(),
        &["function 1", "point `5`", "does not rotate"],
    );
}
