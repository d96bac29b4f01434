//! The joint's dynamic stiffness from H41 and the compliances: ours, by general libraries, and the floor.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used)]

#[path = "rivals/two_by_two.rs"]
mod two_by_two;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use jointscope_benches::cases;
use jointscope_decomposition::Relation;
use jointscope_linalg::Matrix2;
use std::hint::black_box;

fn decomposition(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("decomposition");
    group.sample_size(20);
    for count in [4_000, 1_000_000] {
        let (h41, sides) = cases::decomposition(count);
        let mut out = vec![Matrix2::zero(); count];
        let mut nalgebra = two_by_two::Nalgebra::new(&h41, &sides);
        group.throughput(Throughput::Elements(count as u64));
        for relation in [Relation::Exact, Relation::Paper] {
            group.bench_function(BenchmarkId::new(relation.name(), count), |b| {
                b.iter(|| relation.decompose_lines(black_box(&h41), black_box(&sides), black_box(&mut out)));
            });
        }
        group.bench_function(BenchmarkId::new("floor", count), |b| {
            b.iter(|| cases::floor(black_box(&h41), black_box(&sides), black_box(&mut out)));
        });
        group.bench_function(BenchmarkId::new("nalgebra", count), |b| {
            b.iter(|| black_box(&mut nalgebra).decompose_lines());
        });
        let middle = count / 2;
        assert!((nalgebra.at(middle).at(0, 0) / cases::strip_stiffness() - 1.0).norm() < 0.1);
        if count <= 4_000 {
            group.bench_function(BenchmarkId::new("faer", count), |b| {
                b.iter(|| two_by_two::faer_lines(black_box(&h41), black_box(&sides), black_box(&mut out)));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, decomposition);
criterion_main!(benches);
