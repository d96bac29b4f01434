//! Recordings that do not say what a joint needs.

use super::LINES;
use crate::common::{Bench, TWO_BLOCKS};
use jointscope::uff::{Abscissa, Axis, Data, Dataset58, FunctionType};

/// The program on a recording made of good FRFs by a change; it must refuse.
#[track_caller]
fn recording(name: &str, change: impl FnOnce(&mut Vec<Dataset58>), parts: &[&str]) {
    let bench = Bench::synthesized(name, TWO_BLOCKS, LINES);
    bench.rewrite("frf.uff", "bad.uff", change);
    bench.refused(&["decompose", "two.json", "bad.uff", "-o", "out"], parts);
}

#[test]
fn coherences_alone_are_no_frfs() {
    let only = |datasets: &mut Vec<Dataset58>| {
        for dataset in datasets.iter_mut() {
            dataset.function = FunctionType::Coherence;
            dataset.data = Data::Real(vec![0.9; dataset.data.len()]);
        }
    };
    recording("bad-coherence", only, &["bad.uff", "no FRF", "coherence", "export"]);
}

#[test]
fn time_histories_without_a_force_are_no_hits() {
    let only = |datasets: &mut Vec<Dataset58>| {
        for dataset in datasets.iter_mut() {
            dataset.function = FunctionType::TimeResponse;
            dataset.abscissa_axis = Axis::time();
            dataset.denominator_axis = Axis::default();
            dataset.data = Data::Real(vec![0.1; dataset.data.len()]);
        }
    };
    recording("bad-time", only, &["bad.uff: hit 0 has no force channel", "ordinate type 13"]);
}

#[test]
fn frfs_on_different_lines_name_both() {
    let other = |datasets: &mut Vec<Dataset58>| {
        datasets[2].abscissa = Abscissa::Even { start: 50.0, step: 4.0, count: 191 };
    };
    recording("bad-lines", other, &["bad.uff, function 3", "function 2", "on the same lines"]);
}

#[test]
fn an_frf_that_is_needed_and_missing_is_named() {
    let without = |datasets: &mut Vec<Dataset58>| {
        datasets.pop();
    };
    recording("bad-three", without, &["bad.uff", "joint `J`", "missing FRF 3/2"]);
    let one_sensor = |datasets: &mut Vec<Dataset58>| datasets.retain(|d| d.response.number == 4);
    recording("bad-sensor", one_sensor, &["bad.uff", "missing a second sensor", "point 4"]);
    let one_hit = |datasets: &mut Vec<Dataset58>| datasets.retain(|d| d.reference.number == 1);
    recording("bad-hit", one_hit, &["bad.uff", "missing a second hammer point", "point 1"]);
    let same_side = |datasets: &mut Vec<Dataset58>| {
        datasets.truncate(1);
        datasets[0].response.number = 2;
    };
    recording(
        "bad-side",
        same_side,
        &["bad.uff", "no FRF of the recording crosses joint `J`", "3, 4", "2/1"],
    );
}

#[test]
fn an_frf_given_twice_is_left_to_the_user() {
    let twice = |datasets: &mut Vec<Dataset58>| datasets.push(datasets[0].clone());
    recording("bad-twice", twice, &["bad.uff, function 5", "4/1", "leave one of them out"]);
}

#[test]
fn unknown_and_absent_units_ask_for_what_they_are() {
    let unknown = |datasets: &mut Vec<Dataset58>| datasets[1].ordinate_axis.units = "furlong/s^2".to_owned();
    recording("bad-unit", unknown, &["bad.uff, function 2", "`furlong/s^2`", "--assume-units"]);
    let absent = |datasets: &mut Vec<Dataset58>| {
        let first = &mut datasets[0];
        for axis in [&mut first.ordinate_axis, &mut first.denominator_axis] {
            (axis.data_type, axis.units) = (0, "NONE".to_owned());
        }
    };
    recording("bad-no-unit", absent, &["bad.uff, function 1", "does not say", "--assume-units m/s^2,N"]);
    let contrary = |datasets: &mut Vec<Dataset58>| datasets[3].ordinate_axis.units = "m/s".to_owned();
    recording("bad-contrary", contrary, &["bad.uff, function 4", "`m/s`", "acceleration", "export"]);
}

#[test]
fn nodes_that_the_fixture_does_not_have_ask_for_a_map() {
    let moved = |datasets: &mut Vec<Dataset58>| {
        for dataset in datasets.iter_mut() {
            dataset.response.number += 100;
            dataset.reference.number += 100;
        }
    };
    recording("bad-nodes", moved, &["bad.uff", "104:+y", "1, 2, 3, 4", "`--map 10"]);
    let sideways = |datasets: &mut Vec<Dataset58>| {
        datasets.iter_mut().for_each(|dataset| dataset.response.direction = 3);
    };
    recording(
        "bad-direction",
        sideways,
        &["bad.uff, function 1", "+z", "`--map 4:+z=4:+y`", "`--map +z=+y`"],
    );
}

#[test]
fn a_coherence_that_is_zero_everywhere_is_left_out_and_named() {
    let bench = Bench::shipped("bad-incoherent");
    bench.rewrite("hammer-test.uff", "bad.uff", |datasets| {
        for dataset in datasets.iter_mut() {
            if let (FunctionType::Coherence, Data::Real(values)) = (dataset.function, &mut dataset.data) {
                values.fill(0.0);
            }
        }
    });
    let said = bench.done(&["decompose", "fixture.json", "bad.uff", "-o", "out"]);
    assert!(said.contains("is zero on all lines: left out"), "{said}");
}

#[test]
fn a_coherence_beyond_one_is_left_out_and_named() {
    let bench = Bench::shipped("bad-coherent");
    bench.rewrite("hammer-test.uff", "bad.uff", |datasets| {
        if let Data::Real(values) = &mut datasets[1].data {
            values[9] = 1.2;
        }
    });
    let said = bench.done(&["decompose", "fixture.json", "bad.uff", "-o", "out"]);
    assert!(said.contains("the coherence of 4/1 is above one"), "{said}");
}
