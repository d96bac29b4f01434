//! The built program on hammer hits: `estimate`, and `decompose` and `diagnose` on time histories.

use std::f64::consts::TAU;
use std::path::PathBuf;
use std::sync::LazyLock;

use crate::common::{self, Bench, TWO_BLOCKS};
use jointscope::uff::{Abscissa, Axis, Data, Dataset58, FunctionType, Node};
use num_complex::Complex64;

/// Samples of a record, interval 1/4096 s: lines every 2 Hz.
const SAMPLES: usize = 2048;
const INTERVAL: f64 = 1.0 / 4096.0;

/// [`TWO_BLOCKS`] with its FRFs in `frf.uff`, and two hits at each of 1 and 2 in `hits.uff`, whose responses
/// are those FRFs times the force.
fn bench(name: &str) -> Bench {
    static FILES: LazyLock<Vec<(PathBuf, Vec<u8>)>> = LazyLock::new(|| struck().into_files());
    Bench::with(name, &FILES)
}

fn struck() -> Bench {
    let bench = Bench::synthesized("hits", TWO_BLOCKS, "2:2046:2");
    let force: Vec<f64> =
        (0..SAMPLES).map(|i| if (60..66).contains(&i) { half_sine(i - 60) } else { 0.0 }).collect();
    let spectrum = transform(&force);
    let responses: Vec<(Node, Node, Vec<f64>)> = bench
        .datasets("frf.uff")
        .into_iter()
        .map(|frf| {
            let Data::Complex(values) = &frf.data else { unreachable!() };
            let response = inverse(values, &spectrum);
            (frf.reference, frf.response, response)
        })
        .collect();
    let mut hits = Vec::new();
    for (hit, struck) in [(1, 1), (2, 1), (3, 2), (4, 2)] {
        let strength = 1.0 + 0.1 * hit as f64;
        // The hammer strikes towards −y.
        let push = force.iter().map(|f| -f * strength).collect();
        hits.push(history(hit, Node::new(struck, -2), Axis::excitation_force(), push));
        for (_, node, response) in responses.iter().filter(|(reference, ..)| reference.number == struck) {
            let scaled = response.iter().map(|v| v * strength).collect();
            hits.push(history(hit, node.clone(), Axis::acceleration(), scaled));
        }
    }
    bench.write("hits.uff", jointscope::uff::write(&hits).unwrap());
    bench
}

fn half_sine(i: usize) -> f64 {
    200.0 * (std::f64::consts::PI * (i as f64 + 0.5) / 6.0).sin()
}

fn history(hit: i64, node: Node, axis: Axis, values: Vec<f64>) -> Dataset58 {
    let abscissa = Abscissa::Even { start: 0.0, step: INTERVAL, count: values.len() };
    Dataset58 {
        function: FunctionType::TimeResponse,
        sequence_number: hit,
        response: node,
        abscissa_axis: Axis::time(),
        ordinate_axis: axis,
        ..Dataset58::new(abscissa, Data::Real(values))
    }
}

/// The force's spectrum on the lines 1 to 1023, by definition.
fn transform(force: &[f64]) -> Vec<Complex64> {
    let at = |line: usize| {
        let turn = |i: usize| Complex64::from_polar(1.0, -TAU * (line * i % SAMPLES) as f64 / SAMPLES as f64);
        (60..66).map(|i| force[i] * turn(i)).sum()
    };
    (1..SAMPLES / 2).map(at).collect()
}

/// The record whose spectrum is H·F on those lines, and nothing on the others.
fn inverse(frf: &[Complex64], force: &[Complex64]) -> Vec<f64> {
    let turns: Vec<Complex64> =
        (0..SAMPLES).map(|i| Complex64::from_polar(1.0, TAU * i as f64 / SAMPLES as f64)).collect();
    let sample = |i: usize| {
        let part =
            |(line, (h, f)): (usize, (&Complex64, &Complex64))| (h * f * turns[(line + 1) * i % SAMPLES]).re;
        2.0 / SAMPLES as f64 * frf.iter().zip(force).enumerate().map(part).sum::<f64>()
    };
    (0..SAMPLES).map(sample).collect()
}

#[test]
fn estimate_gives_the_frfs_back_with_coherence_averages_and_origin() {
    let bench = bench("estimate");
    let said = bench.done(&["estimate", "hits.uff", "-o", "estimated.uff"]);
    assert_eq!(said.lines().last(), Some("estimated.uff"), "{said}");
    assert!(said.contains("H1, 2 hits at 1, 2 hits at 2"), "{said}");
    let estimated = bench.datasets("estimated.uff");
    for truth in bench.datasets("frf.uff") {
        let of = |function| {
            let same = |d: &&Dataset58| {
                (d.function, d.response.number, d.reference.number)
                    == (function, truth.response.number, truth.reference.number)
            };
            estimated.iter().find(same).unwrap()
        };
        let (frf, coherence) = (of(FunctionType::FrequencyResponse), of(FunctionType::Coherence));
        assert_eq!(frf.id_lines[4], "averages 2");
        assert!(frf.id_lines[1].starts_with("H1 of hits "), "{:?}", frf.id_lines);
        assert_eq!(frf.id_lines[2], "NONE");
        let (Data::Complex(found), Data::Complex(expected)) = (&frf.data, &truth.data) else {
            unreachable!()
        };
        let Data::Real(coherence) = &coherence.data else { unreachable!() };
        // The header of a file holds six digits of the interval.
        assert_eq!(found.len(), SAMPLES / 2 + 1);
        assert!((frf.abscissa.value(500) - 1000.0).abs() < 1e-3);
        for line in (1..500).step_by(7) {
            // Signs: a force towards −y, its own direction stated.
            let off = (found[line] - expected[line - 1]).norm();
            assert!(off < 1e-9 * expected[line - 1].norm().max(0.1), "line {line}: {off}");
            assert!(coherence[line] > 0.999_999);
        }
    }
}

#[test]
fn decompose_and_diagnose_take_hits_and_show_them_first() {
    let bench = bench("hits-analysed");
    // These records are periodic: a window that falls over them would find what is no decay.
    let options = ["--band", "200:900", "--response-window", "none", "-o"];
    let decompose = |file, to| {
        let said = bench.done(&[&["decompose", "two.json", file], &options[..], &[to]].concat());
        (said, common::matrix(&bench.json(&format!("{to}/stiffness.json"))["average"]["stiffness"]))
    };
    let (said, from_hits) = decompose("hits.uff", "joint");
    assert!(said.contains("FRFs were estimated from the hits"), "{said}");
    let (_, from_frfs) = decompose("frf.uff", "reference");
    for i in 0..2 {
        let error = (from_hits[i][i] / from_frfs[i][i] - 1.0).abs();
        assert!(error < 1e-4, "k{i}{i}: {} and {}", from_hits[i][i], from_frfs[i][i]);
    }
    let page = bench.text("joint/report.html");
    let place = |text: &str| page.find(text).unwrap_or_else(|| panic!("`{text}` is missing"));
    assert!(place(">Hits</h2>") < place("<svg"), "hits stand before the fixture's drawing");
    bench.done(&["diagnose", "two.json", "hits.uff", "--band", "50:900", "-o", "out"]);
    assert!(bench.text("out/report.html").contains(">Hits</h2>"));
    let notes = bench.json("out/diagnosis.json")["notes"].to_string();
    assert!(notes.contains("FRFs were estimated from the hits"), "{notes}");
}

#[test]
fn a_window_is_stated_in_the_file_modelled_by_diagnose_and_by_decompose() {
    let bench = bench("hits-window");
    bench.done(&["estimate", "hits.uff", "--response-window", "12.5", "-o", "windowed.uff"]);
    assert!(bench.datasets("windowed.uff").iter().all(|d| d.id_lines[2] == "exponential window 12.5 1/s"));
    bench.done(&["diagnose", "two.json", "windowed.uff", "--band", "50:900", "-o", "out"]);
    let physics = bench.json("out/refitted.json")["physics"].to_string();
    assert!(physics.contains("exponential_window") && physics.contains("12.5"), "{physics}");
    let said = bench.done(&["decompose", "two.json", "windowed.uff", "-o", "joint"]);
    assert!(
        said.contains("exponential window of decay 12.5000 1/s: sides and joint are read at s"),
        "{said}"
    );
}

#[test]
fn hits_that_are_no_good_are_refused_in_one_sentence() {
    let bench = bench("hits-bad");
    let refused = |change: &dyn Fn(&mut Vec<Dataset58>), parts: &[&str]| {
        bench.rewrite("hits.uff", "bad.uff", |datasets| change(datasets));
        bench.refused(&["estimate", "bad.uff", "-o", "out.uff"], parts);
    };
    let is_force = |d: &Dataset58| d.ordinate_axis.data_type == 13;
    refused(
        &|d| d.retain(|d| !(is_force(d) && d.sequence_number == 2)),
        &["bad.uff: hit 2 has no force channel"],
    );
    refused(
        &|d| {
            d[1].abscissa = Abscissa::Even { start: 0.0, step: INTERVAL, count: 100 };
            d[1].data = Data::Real(vec![0.0; 100]);
        },
        &["bad.uff: hit 1 has 2048 samples of force and 100"],
    );
    refused(
        &|d| d[1].abscissa = Abscissa::Even { start: 0.0, step: 2.0 * INTERVAL, count: SAMPLES },
        &["bad.uff, function 2", "sample all channels of a hit alike"],
    );
    refused(&|d| d.retain(is_force), &["bad.uff: no hit has a response"]);
    refused(
        &|d| {
            d.iter_mut().for_each(|d| {
                if let Data::Real(values) = &mut d.data {
                    values.rotate_left(62)
                }
            })
        },
        &["every hit is rejected: hits 1, 2, 3, 4: the record starts when", "pre-trigger"],
    );
    bench.refused(
        &["estimate", "frf.uff", "-o", "out.uff"],
        &["no time histories", "what there is: 4 FRFs (function type 4)"],
    );
    bench.refused(
        &["estimate", "hits.uff", "--reject", "9", "-o", "out.uff"],
        &["there is no hit 9", "1, 2, 3, 4"],
    );
    bench.refused(&["estimate", "hits.uff", "-o", "hits.uff"], &["would be overwritten"]);
}

#[test]
fn rejected_hits_are_named_and_others_go_on() {
    let bench = bench("hits-some");
    bench.rewrite("hits.uff", "some.uff", |datasets| {
        let Data::Real(values) = &mut datasets[0].data else { unreachable!() };
        (0..6).for_each(|i| values[130 + i] -= 0.4 * half_sine(i));
    });
    let said = bench.done(&["estimate", "some.uff", "-o", "out.uff"]);
    assert!(said.contains("hit 1 rejected: double hit") && said.contains("one hit at 1"), "{said}");
    let said = bench.done(&["estimate", "some.uff", "--keep", "1", "-o", "out.uff"]);
    assert!(said.contains("2 hits at 1"), "{said}");
}
