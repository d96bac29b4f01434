//! Receptances line by line, and a whole synthesis with its set-up.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]

#[path = "rivals/dense.rs"]
mod dense;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use jointscope_benches::cases::{self, Attachments};
use jointscope_lumped::{Instrument, Model, synthesize};
use num_complex::Complex64;
use std::hint::black_box;

const LINES: usize = 400;

fn receptances(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("receptances");
    group.sample_size(20).throughput(Throughput::Elements(LINES as u64));
    let lines = cases::lines(LINES);
    let (outputs, inputs) = cases::ends(2);
    for attachments in [Attachments::None, Attachments::Supports, Attachments::SupportsAndEffects] {
        for bodies in [2, 4, 16] {
            let name = |version: &str| BenchmarkId::new(format!("{version} {attachments:?}"), bodies);
            let model = Model::new(&cases::chain(bodies, attachments), 1000.0).unwrap();
            let (outputs, inputs) = if bodies == 2 { (outputs, inputs) } else { cases::ends(bodies) };
            let mut ours = model.receptances(&outputs, &inputs);
            let rival = dense::Dense::new(bodies, attachments);
            let mut values = vec![Complex64::ZERO; 4 * LINES];
            let s = cases::imaginary(&lines);
            group.bench_function(name("ours"), |b| {
                b.iter(|| ours.on_lines(&s, black_box(&mut values)).unwrap())
            });
            let mut on_lines = |each: &mut dyn FnMut(Complex64, &mut [Complex64])| {
                for (line, four) in values.chunks_exact_mut(4).enumerate() {
                    each(Complex64::new(0.0, lines.omega(line)), four);
                }
                black_box(&mut values);
            };
            group.bench_function(name("nalgebra"), |b| b.iter(|| on_lines(&mut |s, v| rival.nalgebra(s, v))));
            group.bench_function(name("faer"), |b| b.iter(|| on_lines(&mut |s, v| rival.faer(s, v))));
            group.bench_function(name("floor"), |b| b.iter(|| on_lines(&mut |s, v| v.fill(s))));
        }
    }
    group.finish();
}

fn whole(criterion: &mut Criterion) {
    let (fixture, lines, pairs) = (cases::two_blocks(), cases::lines(LINES), cases::four_pairs());
    criterion.bench_function("synthesis of two blocks on 400 lines", |b| {
        b.iter(|| synthesize(black_box(&fixture), &pairs, &lines, Instrument::AsRecorded).unwrap());
    });
    criterion.bench_function("model of two blocks", |b| {
        b.iter(|| Model::new(black_box(&fixture), 1000.0).unwrap());
    });
}

criterion_group!(benches, receptances, whole);
criterion_main!(benches);
