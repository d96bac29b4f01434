//! The map of a mismatch: every place of two blocks fitted with one free scalar a line, 400 lines × 4 FRFs.
#![allow(missing_docs, clippy::unwrap_used)]

use criterion::{Criterion, criterion_group, criterion_main};
use jointscope_benches::cases;
use jointscope_diagnosis::{Fit, Hypothesis, Observation, locate};
use jointscope_fixture::{Effect, EffectKind, Place};
use std::hint::black_box;

/// Mass at the end of the second block, kg.
const MASS: f64 = 0.05;

fn map(criterion: &mut Criterion) {
    let observation = Observation::new(&cases::test_of_two_blocks(400), |_| true).unwrap();
    let fixture = cases::two_blocks();
    // The recording has no such mass: a fixture that claims one disagrees with it as strongly as one that
    // lacks it.
    let claimed = Effect::new(EffectKind::AddedMass, Place::Body("B1".into()), None, &[0.15, MASS]);
    let claims = fixture.with_physics(vec![claimed]).unwrap();
    let nominal = Hypothesis::nominal(&claims, false);
    let refitted = Fit::of(&nominal, &observation, true).unwrap();
    let mut group = criterion.benchmark_group("location");
    group.sample_size(20);
    group.bench_function("map of 400 lines × 4 FRFs", |bencher| {
        bencher.iter(|| locate(black_box(&nominal), &refitted, &observation));
    });
    group.finish();
}

criterion_group!(benches, map);
criterion_main!(benches);
