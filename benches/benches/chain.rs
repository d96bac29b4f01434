//! From the bytes of a universal file to the joint: 400 lines, four FRFs.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]

use criterion::{Criterion, criterion_group, criterion_main};
use jointscope_benches::cases;
use jointscope_decomposition::{Analysis, AnalysisOptions, Relation, Sides, decompose};
use jointscope_recordings::{ReadOptions, Recording, Source};
use jointscope_uff::{ByteOrder, Encoding};
use std::hint::black_box;

const LINES: usize = 400;

fn chain(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("chain");
    group.sample_size(20);
    let fixture = cases::two_blocks();
    for (name, encoding) in [("58b", Encoding::Binary(ByteOrder::Little)), ("58 ASCII", Encoding::Ascii)] {
        let bytes = cases::universal_file(LINES, encoding);
        group.bench_function(format!("read {name}"), |b| {
            b.iter(|| jointscope_uff::read(black_box(&bytes)).unwrap());
        });
        let source = Source { name: name.into(), file: jointscope_uff::read(&bytes).unwrap() };
        group.bench_function(format!("recording of {name}"), |b| {
            b.iter(|| {
                Recording::of(std::slice::from_ref(black_box(&source)), &fixture, &ReadOptions::default())
                    .unwrap()
            });
        });
    }
    let frfs = cases::test_of_two_blocks(LINES);
    let sides = Sides::of(&fixture, None).unwrap();
    group.bench_function("decompose with covariance", |b| {
        b.iter(|| decompose(black_box(&frfs), &sides, Relation::Exact).unwrap());
    });
    group.bench_function("analysis", |b| {
        b.iter(|| Analysis::of(&fixture, black_box(&frfs), &AnalysisOptions::default()).unwrap());
    });
    group.finish();
}

criterion_group!(benches, chain);
criterion_main!(benches);
