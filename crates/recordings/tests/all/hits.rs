//! Hammer hits among time histories.

use crate::common::{self, fixture, history, inches, options, source};
use jointscope_hits::MeasuredMotion;
use jointscope_recordings::{Hits, HitsError, ReadOptions, Source, hits_of};
use jointscope_spectra::Channel;
use jointscope_uff::{Abscissa, Axis, Data, Dataset58, Node};

fn channel(hit: i64, node: i64, axis: Axis, values: &[f64]) -> Dataset58 {
    let abscissa = Abscissa::Even { start: 0.0, step: 1e-3, count: values.len() };
    Dataset58 {
        sequence_number: hit,
        abscissa,
        data: Data::Real(values.to_vec()),
        // What stands here means nothing.
        reference: Node::new(77, 3),
        ..history(node, axis)
    }
}

fn force(hit: i64, node: i64) -> Dataset58 {
    channel(hit, node, Axis::excitation_force(), &[0.0, 8.0, 2.0, 0.0])
}

fn sensor(hit: i64, node: i64) -> Dataset58 {
    channel(hit, node, Axis::acceleration(), &[0.0, 1.0, -2.0, 0.5])
}

fn read(sources: &[Source]) -> Result<Hits, HitsError> {
    hits_of(sources, Some(&fixture()), &ReadOptions::default())
}

fn refused(sources: &[Source], parts: &[&str]) {
    let message = read(sources).unwrap_err().to_string();
    parts.iter().for_each(|part| assert!(message.contains(part), "`{part}` is missing from: {message}"));
}

#[test]
fn channels_of_one_sequence_number_are_one_hit_in_whatever_order_they_come() {
    let datasets = vec![sensor(2, 4), force(1, 1), sensor(1, 4), sensor(2, 3), force(2, 2), sensor(1, 3)];
    let mut reversed = datasets.clone();
    reversed.reverse();
    let hits = read(&[source("a.uff", datasets)]).unwrap();
    assert_eq!(hits, read(&[source("a.uff", reversed)]).unwrap());
    let told: Vec<_> = hits.hits.iter().map(|h| (h.number(), h.struck().to_string())).collect();
    assert_eq!(told, [(1, "1".to_owned()), (2, "2".to_owned())]);
    let points: Vec<_> = hits.hits[0].responses().iter().map(|r| r.channel.to_string()).collect();
    assert_eq!(points, ["3", "4"]);
    assert!(hits.notes.is_empty(), "{:?}", hits.notes);
    assert_eq!((hits.hits[0].interval(), hits.hits[0].samples()), (1e-3, 4));
}

#[test]
fn one_map_entry_turns_the_directions_of_all_nodes() {
    let along_z = |mut channel: Dataset58| {
        channel.response.direction = -3;
        channel
    };
    let datasets = || vec![along_z(force(1, 1)), along_z(sensor(1, 4)), sensor(1, 3)];
    let read = |map: &[&str]| hits_of(&[source("a.uff", datasets())], Some(&fixture()), &options(map, None));
    let hits = read(&["+z=+y"]).unwrap();
    assert_eq!((hits.hits[0].struck().to_string(), hits.hits[0].responses().len()), ("1".to_owned(), 1));
    assert_eq!(hits.hits[0].force(), [0.0, -8.0, -2.0, 0.0]);
    assert_eq!(hits.hits[0].responses()[0].values, [0.0, -1.0, 2.0, -0.5]);
    assert_eq!(hits.notes, ["channels in directions other than y and theta left out: 3:+y"]);
    // Hits along two axes of one node are not hits of one FRF.
    let two = vec![along_z(force(1, 1)), sensor(1, 4), force(2, 1), sensor(2, 4)];
    let both = hits_of(&[source("a.uff", two)], Some(&fixture()), &options(&["+z=+y", "+y=+y"], None));
    let message = both.unwrap_err().to_string();
    assert!(message.contains("1:-z and 1:+y") && message.contains("give node 1"), "{message}");
}

#[test]
fn directions_turn_signs_and_units_become_si() {
    let mut push = force(1, 1);
    push.response.direction = -2;
    push.ordinate_axis.units = "lbf".into();
    let mut turn = sensor(1, 4);
    turn.response.direction = -6;
    turn.ordinate_axis.units = "rad/s^2".into();
    let mut inch = channel(1, 3, Axis { units: "NONE".into(), ..Axis::velocity() }, &[0.0, 1.0, 0.0, 0.0]);
    inch.units = Some(inches());
    let hits = read(&[source("a.uff", vec![push, turn, inch])]).unwrap();
    let hit = &hits.hits[0];
    assert!((hit.force()[1] + 8.0 * 4.4482216152605).abs() < 1e-12);
    let [velocity, rotation] = hit.responses() else { panic!("{hit:?}") };
    assert_eq!((velocity.motion, rotation.motion), (MeasuredMotion::Velocity, MeasuredMotion::Acceleration));
    assert!((velocity.values[1] - 0.0254).abs() < 1e-12);
    assert_eq!((&rotation.channel, rotation.values[1]), (&Channel::rotational("4"), -1.0));
    assert_eq!(hits.notes.len(), 2, "{:?}", hits.notes);
}

#[test]
fn maps_and_assumed_units_apply_to_hits_too() {
    let bare = Axis { units: "NONE".into(), ..Axis::acceleration() };
    let triaxial = |direction| Dataset58 {
        response: Node::new(101, direction),
        ..channel(1, 101, bare.clone(), &[0.0, 1.0, 0.0, 0.0])
    };
    let file = source("a.uff", vec![force(1, 1), triaxial(1), triaxial(-3)]);
    let options = options(&["101:+z=4:+y"], Some("g,N"));
    let hits = hits_of(&[file], Some(&fixture()), &options).unwrap();
    assert_eq!(hits.hits[0].responses().len(), 1);
    assert_eq!(hits.hits[0].responses()[0].values[1], -9.80665);
    assert!(hits.notes.iter().any(|note| note.contains("101:+x")), "{:?}", hits.notes);
}

#[test]
fn without_a_fixture_nodes_are_labels_in_the_order_of_their_numbers() {
    let file = source("a.uff", vec![sensor(1, 102), sensor(1, 7), force(1, 30)]);
    let hits = hits_of(&[file], None, &ReadOptions::default()).unwrap();
    assert_eq!(hits.hits[0].struck(), &Channel::transverse("30"));
    let points: Vec<_> = hits.hits[0].responses().iter().map(|r| r.channel.to_string()).collect();
    assert_eq!(points, ["7", "102"]);
}

#[test]
fn files_that_count_from_one_each_give_hits_of_their_own_and_one_hit_may_lie_in_two_files() {
    let at = |name, node| source(name, vec![force(1, node), sensor(1, 4), force(2, node), sensor(2, 4)]);
    let hits = read(&[at("one.uff", 1), at("two.uff", 2)]).unwrap();
    let told: Vec<_> = hits.hits.iter().map(|h| (h.number(), h.struck().to_string())).collect();
    let expected = [(1, "1"), (2, "1"), (3, "2"), (4, "2")].map(|(n, point)| (n, point.to_owned()));
    assert_eq!(told, expected);
    assert_eq!(hits.notes, ["hits are numbered through all files: 1 to 2 from one.uff, 3 to 4 from two.uff"]);
    let apart = [source("force.uff", vec![force(5, 1)]), source("motion.uff", vec![sensor(5, 4)])];
    let hits = read(&apart).unwrap();
    assert_eq!((hits.hits[0].number(), hits.hits[0].responses().len()), (5, 1));
}

#[test]
fn a_hit_without_a_force_or_with_two_is_refused() {
    refused(
        &[source("a.uff", vec![force(1, 1), sensor(1, 4), sensor(2, 4)])],
        &["a.uff: hit 2 has no force channel", "only 4:+y"],
    );
    refused(
        &[source("a.uff", vec![force(1, 1), force(1, 2), sensor(1, 4)])],
        &["a.uff, function 2 (time history of 2:+y)", "function 1 (time history of 1:+y)", "sequence number"],
    );
}

#[test]
fn channels_on_different_instants_are_refused_with_both() {
    let slow = Dataset58 { abscissa: Abscissa::Even { start: 0.0, step: 2e-3, count: 4 }, ..sensor(1, 4) };
    refused(&[source("a.uff", vec![force(1, 1), slow])], &["function 2", "0.001 s", "0.002 s", "alike"]);
    let late = Dataset58 { abscissa: Abscissa::Even { start: 0.01, step: 1e-3, count: 4 }, ..sensor(1, 4) };
    refused(&[source("a.uff", vec![force(1, 1), late])], &["starts at 0 s", "0.01 s"]);
    let short = channel(1, 4, Axis::acceleration(), &[0.0; 3]);
    refused(
        &[source("a.uff", vec![force(1, 1), short])],
        &["a.uff: hit 1", "4 samples", "3 of the response"],
    );
    let uneven = Dataset58 { abscissa: Abscissa::Uneven(vec![0.0, 1e-3, 1.2e-3, 3e-3]), ..force(1, 1) };
    refused(&[source("a.uff", vec![uneven])], &["function 1", "not evenly spaced"]);
}

#[test]
fn files_without_time_histories_and_hits_elsewhere_are_refused_with_the_remedy() {
    refused(
        &[source("a.uff", vec![common::frf((4, 2), (1, 2))])],
        &["a.uff", "what there is: 1 FRF (function type 4)"],
    );
    refused(&[source("a.uff", vec![])], &["a.uff: there are no time histories (function type 1);"]);
    refused(
        &[source("a.uff", vec![force(1, 101), sensor(1, 4)])],
        &["no hit belongs", "`--map 101:+y=1:+y`"],
    );
}

#[test]
fn what_is_no_part_of_the_test_is_left_out_and_named() {
    let sound = channel(1, 4, Axis::new(15, "Pressure", "Pa"), &[0.0; 4]);
    let hits = read(&[source("a.uff", vec![force(1, 1), sensor(1, 4), sensor(1, 99), sound, force(2, 98)])])
        .unwrap();
    assert_eq!((hits.hits.len(), hits.hits[0].responses().len()), (1, 1));
    let notes = hits.notes.join("; ");
    for part in [
        "99:+y",
        "neither force nor motion left out: 4:+y",
        "hits at nodes that the fixture does not have left out: 2",
    ] {
        assert!(notes.contains(part), "`{part}` is missing from: {notes}");
    }
}

#[test]
fn a_channel_that_says_nothing_of_what_it_is_is_refused() {
    let bare = channel(1, 4, Axis::new(0, "NONE", "NONE"), &[0.0; 4]);
    refused(&[source("a.uff", vec![force(1, 1), bare])], &["function 2", "force or a motion"]);
    let labelled = channel(1, 4, Axis::new(0, "NONE", "g"), &[1.0; 4]);
    let hammer = channel(1, 1, Axis::new(0, "NONE", "kN"), &[1.0; 4]);
    let hits = read(&[source("a.uff", vec![labelled, hammer])]).unwrap();
    assert_eq!((hits.hits[0].force()[0], hits.hits[0].responses()[0].values[0]), (1000.0, 9.80665));
}

#[test]
fn a_response_that_every_other_hit_has_is_missed_aloud() {
    let all: Vec<Dataset58> =
        (1..=3).flat_map(|hit| [force(hit, 1), sensor(hit, 2), sensor(hit, 3), sensor(hit, 4)]).collect();
    let says = |datasets: &[Dataset58]| read(&[source("a.uff", datasets.to_vec())]).unwrap().notes;
    assert!(says(&all).is_empty() && says(&all[..8]).is_empty());
    let expected = "hit 3 has no responses 3:+y, 4:+y, which the 2 other hits have: where a file was cut before it, copy or export that file again";
    assert_eq!(says(&all[..10]), [expected]);
}
