//! Every figure of `docs/records/2026-11-21-performance.md` in one run, ours beside the floor and the rivals.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]

#[path = "rivals/dense.rs"]
mod dense;
#[path = "rivals/two_by_two.rs"]
mod two_by_two;

use jointscope_benches::cases::{self, Attachments};
use jointscope_benches::{Timing, compare, ratio};
use jointscope_decomposition::{Analysis, AnalysisOptions, Relation, Sides, decompose};
use jointscope_linalg::{ComplexMatrix2, Matrix2};
use jointscope_lumped::{Instrument, Model, synthesize};
use jointscope_recordings::{ReadOptions, Recording, Source};
use jointscope_uff::{ByteOrder, Encoding};
use num_complex::Complex64;
use std::hint::black_box;

const LINES: usize = 400;

/// Rounds in which all versions take turns, and how long each runs in a round, s.
#[derive(Clone, Copy)]
struct Effort {
    rounds: usize,
    budget: f64,
}

fn main() {
    // `cargo test --all-targets` calls without `--bench`: then it is enough that everything runs.
    let measures = std::env::args().any(|a| a == "--bench");
    let effort =
        if measures { Effort { rounds: 31, budget: 0.005 } } else { Effort { rounds: 1, budget: 1e-6 } };
    println!("| work | ours, median | best | ours / floor | nalgebra / ours | faer / ours |");
    println!("|---|---|---|---|---|---|");
    decompositions(effort, if measures { 1_000_000 } else { 10_000 });
    for attachments in [Attachments::None, Attachments::Supports, Attachments::SupportsAndEffects] {
        for bodies in [2, 4, 16] {
            receptances(effort, bodies, attachments);
        }
    }
    println!("\n| whole calls | median | best |");
    println!("|---|---|---|");
    whole_calls(effort);
}

/// One row: ours, then where there are any the floor and the two rivals; all for `lines` lines.
fn row(work: &str, lines: usize, ours: &Timing, others: [Option<&Timing>; 3]) {
    let [floor, nalgebra, faer] = others;
    let cell = |ratio: Option<f64>| ratio.map_or("".to_owned(), |r| format!("{r:.2}"));
    println!(
        "| {work} | {:.1} ns/line | {:.1} | {} | {} | {} |",
        ours.seconds / lines as f64 * 1e9,
        ours.best / lines as f64 * 1e9,
        cell(floor.map(|floor| ratio(ours, floor))),
        cell(nalgebra.map(|other| ratio(other, ours))),
        cell(faer.map(|other| ratio(other, ours))),
    );
}

fn decompositions(effort: Effort, many: usize) {
    for count in [4_000, many] {
        let (h41, sides) = cases::decomposition(count);
        let mut out: [Vec<ComplexMatrix2>; 4] = std::array::from_fn(|_| vec![Matrix2::zero(); count]);
        let [exact, paper, floor, faer] = &mut out;
        let mut nalgebra = two_by_two::Nalgebra::new(&h41, &sides);
        // A million lines by faer take seconds and are no news; the first 4,000 say what a line costs.
        let few = &h41[..4_000.min(count)];
        let times = compare(
            effort.rounds,
            effort.budget,
            &mut [
                &mut || Relation::Exact.decompose_lines(black_box(&h41), &sides, black_box(exact)),
                &mut || Relation::Paper.decompose_lines(black_box(&h41), &sides, black_box(paper)),
                &mut || cases::floor(black_box(&h41), &sides, black_box(floor)),
                &mut || black_box(&mut nalgebra).decompose_lines(),
                &mut || two_by_two::faer_lines(black_box(few), &sides, black_box(&mut faer[..few.len()])),
            ],
        );
        for line in (0..few.len()).step_by(97) {
            for other in [nalgebra.at(line), faer[line]] {
                let error = (exact[line] - other).norm_squared() / other.norm_squared();
                assert!(error < 1e-12, "line {line}: {:?} against {other:?}", exact[line]);
            }
        }
        let scale = count as f64 / few.len() as f64;
        let whole = Timing {
            seconds: times[4].seconds * scale,
            best: times[4].best * scale,
            rounds: times[4].rounds.iter().map(|t| t * scale).collect(),
        };
        for (relation, ours) in [(Relation::Exact, &times[0]), (Relation::Paper, &times[1])] {
            let rivals = [&times[3], &whole].map(|t| (relation == Relation::Exact).then_some(t));
            let work = format!("{} relation, {count} lines", relation.name());
            row(&work, count, ours, [Some(&times[2]), rivals[0], rivals[1]]);
        }
        row(&format!("floor, {count} lines"), count, &times[2], [None; 3]);
    }
}

fn receptances(effort: Effort, bodies: usize, attachments: Attachments) {
    let lines = cases::lines(LINES);
    let (outputs, inputs) = cases::ends(bodies);
    let model = Model::new(&cases::chain(bodies, attachments), 1000.0).unwrap();
    let mut prepared = model.receptances(&outputs, &inputs);
    let rival = dense::Dense::new(bodies, attachments);
    let on_lines = |values: &mut [Complex64], each: &mut dyn FnMut(Complex64, &mut [Complex64])| {
        for (line, four) in values.chunks_exact_mut(4).enumerate() {
            each(Complex64::new(0.0, lines.omega(line)), four);
        }
        black_box(values);
    };
    let s = cases::imaginary(&lines);
    let mut values: [Vec<Complex64>; 4] = std::array::from_fn(|_| vec![Complex64::ZERO; 4 * LINES]);
    let [ours, floor, nalgebra, faer] = &mut values;
    let times = compare(
        effort.rounds,
        0.3 * effort.budget,
        &mut [
            &mut || prepared.on_lines(&s, black_box(ours)).unwrap(),
            &mut || on_lines(floor, &mut |s, four| four.fill(s)),
            &mut || on_lines(nalgebra, &mut |s, four| rival.nalgebra(s, four)),
            &mut || on_lines(faer, &mut |s, four| rival.faer(s, four)),
        ],
    );
    for (index, ours) in ours.iter().enumerate() {
        // Ours are FRF after FRF, the others' line after line.
        let there = index % LINES * 4 + index / LINES;
        for other in [nalgebra[there], faer[there]] {
            assert!((ours - other).norm() < 1e-6 * other.norm(), "value {index}: {ours} against {other}");
        }
    }
    let what = match attachments {
        Attachments::None => "free",
        Attachments::Supports => "on supports (rank 2)",
        Attachments::SupportsAndEffects => "on supports with effects (rank 8)",
    };
    let work = format!("4 FRFs of {bodies} blocks, {what}");
    row(&work, LINES, &times[0], [Some(&times[1]), Some(&times[2]), Some(&times[3])]);
}

fn whole_calls(effort: Effort) {
    let (fixture, lines, pairs) = (cases::two_blocks(), cases::lines(LINES), cases::four_pairs());
    let frfs = cases::test_of_two_blocks(LINES);
    let sides = Sides::of(&fixture, None).unwrap();
    let bytes = cases::universal_file(LINES, Encoding::Binary(ByteOrder::Little));
    let text = cases::universal_file(LINES, Encoding::Ascii);
    let file = jointscope_uff::read(&bytes).unwrap();
    let source = [Source { name: "test.uff".into(), file }];
    let times = compare(
        effort.rounds,
        effort.budget,
        &mut [
            &mut || drop(Model::new(black_box(&fixture), 1000.0).unwrap()),
            &mut || drop(synthesize(black_box(&fixture), &pairs, &lines, Instrument::AsRecorded).unwrap()),
            &mut || drop(jointscope_uff::read(black_box(&bytes)).unwrap()),
            &mut || drop(jointscope_uff::read(black_box(&text)).unwrap()),
            &mut || drop(Recording::of(black_box(&source), &fixture, &ReadOptions::default()).unwrap()),
            &mut || drop(decompose(black_box(&frfs), &sides, Relation::Exact).unwrap()),
            &mut || drop(Analysis::of(&fixture, black_box(&frfs), &AnalysisOptions::default()).unwrap()),
        ],
    );
    let names = [
        "`Model::new` of two blocks",
        "`synthesize` of two blocks, 400 lines × 4 FRFs, set-up included",
        "`uff::read` of 400 lines × 4 FRFs, 58b",
        "`uff::read` of the same, 58 ASCII",
        "`Recording::of` the same",
        "`decompose` 400 lines × 4 FRFs with covariance",
        "`Analysis::of` the same, exact relation",
    ];
    for (name, time) in names.iter().zip(&times) {
        println!("| {name} | {:.1} µs | {:.1} µs |", time.seconds * 1e6, time.best * 1e6);
    }
}
