//! The signals of a hammer hit: one force and the responses to it over time, in SI units and the fixture's
//! terms.

use jointscope_hits::{Hit, HitError, MeasuredMotion, Response};
use jointscope_spectra::Channel;

fn hit(force: Vec<f64>, responses: Vec<Response>) -> Result<Hit, HitError> {
    Hit::new(3, 1e-3, 0.0, Channel::transverse("1"), force, responses)
}

fn at(point: &str, values: Vec<f64>) -> Response {
    Response::new(Channel::transverse(point), MeasuredMotion::Acceleration, values)
}

#[test]
fn signals_of_different_length_are_refused_by_name() {
    let error = hit(vec![0.0; 4], vec![at("4", vec![0.0; 4]), at("3", vec![0.0; 3])]).map(|_| ());
    let said = error.map_err(|e| e.to_string());
    assert_eq!(
        said,
        Err("hit 3 has 4 samples of force and 3 of the response at 3: record both equally long".into())
    );
}

#[test]
fn a_sample_that_is_no_number_is_refused_with_its_place() {
    let error = hit(vec![0.0; 4], vec![at("4", vec![0.0, 0.0, f64::NAN, 0.0])]);
    assert!(
        matches!(error, Err(HitError::NotFinite { sample: 2, ref signal, .. }) if signal == "the acceleration at 4")
    );
}

#[test]
fn a_response_given_twice_and_a_hit_without_samples_are_refused() {
    let twice = hit(vec![0.0; 2], vec![at("4", vec![0.0; 2]), at("4", vec![1.0; 2])]);
    assert!(matches!(twice, Err(HitError::Twice { .. })));
    assert!(matches!(hit(vec![], vec![]), Err(HitError::Empty { hit: 3 })));
}

#[test]
fn the_peak_force_is_the_largest_of_either_sign() {
    assert_eq!(hit(vec![0.0, 3.0, -7.0, 1.0], vec![]).map(|h| h.peak_force()), Ok(7.0));
}
