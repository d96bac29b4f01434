//! Models over measurements, beside the ratios of their pairs.

use crate::{file, joints};
use jointscope_comparison::{Comparison, Decomposed, ModelIs, ModelRatios, Source};
use jointscope_wording::models::{by_measurement, sentence, without_measurement, without_ratio};
use serde_json::Value;

fn said(files: &[Value], sources: &[Option<Source>]) -> Comparison {
    let mut joints: Vec<Decomposed> = joints(files);
    joints.iter_mut().zip(sources).for_each(|(joint, source)| joint.source = *source);
    Comparison::of(joints).unwrap()
}

const SIM: Option<Source> = Some(Source::Simulation);
const EXP: Option<Source> = Some(Source::Measurement);
const FEM: Option<Source> = Some(Source::FiniteElements);

/// Deviations of the difference are √2, the mass of the blocks in common cancelling: 1 % apart is seven of
/// them.
fn three() -> [Value; 3] {
    [1010.0, 1000.0, 1000.5].map(|k11| file(k11, 20.0, 5.0))
}

#[test]
fn a_model_over_a_measurement_is_the_ratio_of_their_pair_in_whatever_order_they_are_given() {
    let last = said(&three(), &[EXP, SIM, FEM]);
    assert_eq!(last.models.len(), 2);
    for (pair, model) in last.pairs.iter().zip(&last.models) {
        assert_eq!((&model.measurement, &model.model), (&pair.first, &pair.second));
        assert_eq!(model.numbers[0].ratio, pair.number("K11").unwrap().ratio);
    }
    let first = said(&three(), &[SIM, EXP, FEM]);
    let [sim, fem] = first.models.as_slice() else { panic!("{:?}", first.models) };
    assert_eq!((sim.model.as_str(), sim.measurement.as_str(), sim.kind), ("a", "b", Source::Simulation));
    assert_eq!((fem.model.as_str(), fem.measurement.as_str()), ("c", "b"));
    // Fieller's set of b/a has the inverse ends of that of a/b.
    let (over, under) = (sim.numbers[0].ratio.unwrap(), first.pairs[0].number("K11").unwrap().ratio.unwrap());
    assert!((over.value * under.value - 1.0).abs() < 1e-12);
    assert!(
        (over.ci95[0] * under.ci95[1] - 1.0).abs() < 1e-12
            && (over.ci95[1] * under.ci95[0] - 1.0).abs() < 1e-12
    );
}

#[test]
fn numbers_that_agree_with_one_are_counted_and_a_stiffer_or_softer_model_is_named() {
    let found = said(&three(), &[SIM, EXP, FEM]);
    assert_eq!(ModelRatios::agreement(&found.models), (1, 2));
    let is: Vec<_> = found.models.iter().map(|model| model.numbers[0].model_is).collect();
    assert_eq!(is, [Some(ModelIs::Larger), Some(ModelIs::AsMeasured)]);
    let says = sentence(&found.models).unwrap();
    assert_eq!(
        says,
        "1 of 2 ratios of models to the measurement agrees with 1 within its 95 % interval; a is stiffer than b by K11"
    );
    let softer = said(&three(), &[EXP, SIM, None]);
    assert_eq!(softer.models[0].numbers[0].model_is, Some(ModelIs::Smaller));
    assert!(sentence(&softer.models).unwrap().ends_with("b is softer than a by K11"));
    let both = said(&three(), &[None, EXP, FEM]);
    assert!(sentence(&both.models).unwrap().starts_with("the one ratio of a model"));
}

#[test]
fn numbers_without_a_ratio_are_not_counted_and_are_named() {
    // Nothing tells how sure K22 is.
    let files = three().map(|mut file| {
        file["joint"]["stiffness"][1][1] = 5.0.into();
        file
    });
    let found = said(&files, &[SIM, EXP, None]);
    assert_eq!(ModelRatios::agreement(&found.models).1, 1);
    let elements: Vec<(&str, bool)> =
        found.models[0].numbers.iter().map(|n| (n.element.as_str(), n.ratio.is_some())).collect();
    assert_eq!(elements, [("K11", true), ("K22", false)]);
    let over = by_measurement(&found);
    let text = without_ratio(&found, &over[0]).unwrap();
    assert!(text.starts_with("K22 of b cannot be told from zero"), "{text}");
}

#[test]
fn nothing_is_set_against_a_measurement_that_nobody_named() {
    let unsaid = said(&three(), &[None, None, None]);
    assert!(
        unsaid.models.is_empty()
            && sentence(&unsaid.models).is_none()
            && without_measurement(&unsaid).is_none()
    );
    let models = said(&three(), &[SIM, FEM, None]);
    assert!(models.models.is_empty() && without_measurement(&models).unwrap().contains("--as exp=DIR"));
    let measured = said(&three(), &[EXP, EXP, None]);
    assert!(measured.models.is_empty() && without_measurement(&measured).is_none());
}
