//! What modes say of a recording at the true quantities: the ground of every probability that rests on them.

use crate::common::opened;
use jointscope_diagnosis::Observation;
use jointscope_linalg::Cholesky;
use jointscope_model_error::{
    ErrorSizes, KINDS, ModelledModes, Pairing, RecordedModes, Shapes, SharedFeatures, WeightedFrfs,
};
use jointscope_modes::ModesOptions;
use jointscope_proof::{Case, Plan, Role, Truth};

/// χ² of the features of a recording's modes at the truth, and their number.
fn chi2_at_the_truth(case: &Case, truth: &Truth) -> (f64, usize) {
    let observation = Observation::new(&case.recorded, |_| true).unwrap();
    let recording = WeightedFrfs { frfs: observation.frfs(), weights: observation.weights() };
    let expected = |alone: &RecordedModes| alone.expected_by(&case.believed);
    let recorded = RecordedModes::of(recording, &ModesOptions::default(), expected).unwrap();
    let modelled = ModelledModes::of(&truth.fixture, &recorded).unwrap();
    let pairing = Pairing::of(&recorded, &modelled);
    let shapes = Shapes::of(&truth.fixture, &recorded, &modelled.poles()).unwrap();
    let comparison = SharedFeatures::new(&recorded, &pairing, &modelled, &shapes);
    let mut difference = comparison.residual(&recorded, &recorded.features(), &modelled, &pairing);
    let noise = comparison.covariance(&ErrorSizes::from_array([0.0; KINDS]));
    Cholesky::of(comparison.count(), &noise).unwrap().solve_lower_in_place(&mut difference);
    (difference.iter().map(|d| d * d).sum(), comparison.count())
}

#[test]
fn at_the_truth_the_modes_of_nulls_differ_by_chance() {
    let (cases, truths) = opened(&Plan { cases: 60, seed: 2024, ..Plan::default() });
    let (mut all, mut features, mut nulls) = (0.0, 0.0, 0);
    for (case, truth) in cases.iter().zip(&truths).filter(|(_, truth)| truth.role == Role::Null) {
        let (chi2, count) = chi2_at_the_truth(case, truth);
        println!("case {}: χ² {chi2:.1} of {count} features", truth.index);
        let count = count as f64;
        assert!(
            chi2 < count + 6.0 * (2.0 * count).sqrt(),
            "case {}: χ² {chi2:.1} of {count} features",
            truth.index
        );
        (all, features, nulls) = (all + chi2, features + count, nulls + 1);
    }
    let mean = all / features;
    println!("{nulls} nulls: χ² per feature {mean:.3}");
    assert!(nulls >= 10 && (mean - 1.0).abs() < 0.15, "{nulls} nulls: χ² per feature {mean:.3}");
}
