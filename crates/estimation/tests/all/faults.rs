//! What is wrong with a hit, and what becomes of it.

use crate::common::{self, INTERVAL, TWO_MODES, Test, hit, pulse};
use jointscope_estimation::{Estimate, EstimateError, EstimateOptions, Fault, Remark, Signal};
use jointscope_hits::{Hit, MeasuredMotion, Response};
use jointscope_spectra::Channel;

fn of(hits: &[Hit]) -> Result<Estimate, EstimateError> {
    Estimate::of(hits, &EstimateOptions::default())
}

/// Two good hits and a third one with this force.
fn beside_two(force: Vec<f64>) -> Vec<Hit> {
    let mut hits = Test::quiet(2, 4096).hits();
    let response = TWO_MODES.answer(&force);
    hits.push(hit(3, force, response));
    hits
}

fn faults(estimate: &Estimate) -> &[Fault] {
    &estimate.hits[2].faults
}

#[test]
fn a_double_hit_is_rejected_with_when_and_how_hard_and_kept_on_request() {
    let force: Vec<f64> =
        pulse(4096, 80, 5, 90.0).iter().zip(pulse(4096, 140, 5, 27.0)).map(|(a, b)| a + b).collect();
    let hits = beside_two(force);
    let estimate = of(&hits).unwrap();
    let [Fault::DoubleHit { after, ratio }] = faults(&estimate) else { panic!("{:?}", faults(&estimate)) };
    assert!((after - 60.0 * INTERVAL).abs() < 1e-9 && (ratio - 0.3).abs() < 1e-9);
    assert_eq!(estimate.frfs.averages(0), Some(2));
    let Remark::Rejected { hit: 3, why } = &estimate.remarks[0] else { panic!("{:?}", estimate.remarks) };
    assert!(why.contains("29.3 ms later, 30 % as hard"), "{why}");
    let keep = EstimateOptions { keep: vec![3], ..EstimateOptions::default() };
    let kept = Estimate::of(&hits, &keep).unwrap();
    assert_eq!(kept.frfs.averages(0), Some(3));
    assert!(matches!(kept.remarks[0], Remark::Kept { hit: 3, .. }), "{:?}", kept.remarks);
}

#[test]
fn an_overload_names_the_channel() {
    let force = pulse(4096, 80, 4, 90.0);
    let cut: Vec<f64> = TWO_MODES.answer(&force).iter().map(|v| v.clamp(-9.0, 9.0)).collect();
    let mut hits = Test::quiet(2, 4096).hits();
    hits.push(hit(3, force, cut));
    let estimate = of(&hits).unwrap();
    let [Fault::Overload { signal, at }] = faults(&estimate) else { panic!("{:?}", faults(&estimate)) };
    assert_eq!((signal, at.abs()), (&Signal::Response(Channel::transverse("4")), 9.0));
    let cut: Vec<f64> = pulse(4096, 80, 12, 90.0).iter().map(|f| f.min(60.0)).collect();
    let estimate = of(&beside_two(cut)).unwrap();
    assert!(
        matches!(faults(&estimate), [Fault::Overload { signal: Signal::Force, at: 60.0 }]),
        "{estimate:?}"
    );
}

#[test]
fn a_short_blow_beyond_the_range_of_the_force_is_found_and_all_others_that_reach_it() {
    // Two samples at the top of the third hit, one at that of the fourth.
    let cut = |begins: usize, third: f64| {
        let mut force = vec![0.0; 4096];
        force[begins..begins + 4].copy_from_slice(&[31.0, 70.0, third, 12.0]);
        force
    };
    let mut hits = Test::quiet(2, 4096).hits();
    for (number, third) in [(3, 70.0), (4, 55.0)] {
        let force = cut(80, third);
        let response = TWO_MODES.answer(&force);
        hits.push(hit(number, force, response));
    }
    let estimate = of(&hits).unwrap();
    let found: Vec<&[Fault]> = estimate.hits.iter().map(|hit| hit.faults.as_slice()).collect();
    let [[], [], third, fourth] = found[..] else { panic!("{found:?}") };
    for faults in [third, fourth] {
        assert!(matches!(faults, [Fault::Overload { signal: Signal::Force, at: 70.0 }]), "{faults:?}");
    }
}

#[test]
fn hits_that_are_rejected_for_one_reason_are_told_together() {
    let mut force = vec![0.0; 4096];
    force[80..84].copy_from_slice(&[31.0, 70.0, 70.0, 12.0]);
    let all = (1..=3).map(|number| hit(number, force.clone(), TWO_MODES.answer(&force)));
    let error = of(&all.collect::<Vec<_>>()).unwrap_err().to_string();
    let told = "every hit is rejected: hits 1, 2, 3: overload: the force is cut off at 70 N, widen the range";
    assert!(error.starts_with(told), "{error}");
}

#[test]
fn a_record_that_starts_after_the_impact_and_one_without_impact_are_rejected() {
    let late: Vec<f64> = pulse(4096, 80, 4, 90.0)[81..].iter().copied().chain([0.0; 81]).collect();
    let estimate = of(&beside_two(late)).unwrap();
    assert!(matches!(faults(&estimate), [Fault::StartsAfterImpact]), "{:?}", faults(&estimate));
    let noise: Vec<f64> =
        (0..4096).map(|i| 0.1 * (1.3 * i as f64).sin() + 0.08 * (2.9 * i as f64).sin()).collect();
    let estimate =
        of(&beside_two(noise.iter().map(|v| v + if *v > 0.0 { 0.1 } else { 0.0 }).collect())).unwrap();
    assert!(
        matches!(faults(&estimate), [Fault::NoImpact | Fault::ForceRings { pulse_at: None }]),
        "{:?}",
        faults(&estimate)
    );
    assert!(matches!(faults(&of(&beside_two(vec![0.0; 4096])).unwrap()), [Fault::NoImpact]));
}

#[test]
fn force_and_response_swapped_are_told_by_their_looks() {
    let force = pulse(4096, 80, 4, 90.0);
    let ringing = TWO_MODES.answer(&force);
    let hits = [hit(1, ringing.clone(), force.clone()), hit(2, ringing, force)];
    let error = of(&hits).unwrap_err().to_string();
    assert!(error.contains("the response at 4 looks like a hammer's force"), "{error}");
    assert!(error.contains("every hit is rejected"), "{error}");
}

#[test]
fn numbers_that_no_hit_has_are_refused_with_those_there_are() {
    let hits = Test::quiet(2, 4096).hits();
    let options = EstimateOptions { reject: vec![7], ..EstimateOptions::default() };
    let error = Estimate::of(&hits, &options).unwrap_err();
    assert_eq!(error.to_string(), "there is no hit 7 to reject; the hits are 1, 2");
    let all = EstimateOptions { reject: vec![1, 2], ..EstimateOptions::default() };
    assert!(matches!(Estimate::of(&hits, &all), Err(EstimateError::AllRejected(_))));
    assert_eq!(of(&[]), Err(EstimateError::NoHits));
}

#[test]
fn hits_of_different_rates_or_without_responses_are_refused() {
    let slow = Hit::new(9, 2.0 * INTERVAL, 0.0, Channel::transverse("1"), vec![0.0; 64], vec![]).unwrap();
    assert_eq!(of(std::slice::from_ref(&slow)), Err(EstimateError::NoResponses));
    let mut hits = Test::quiet(1, 4096).hits();
    hits.push(slow);
    assert!(matches!(of(&hits), Err(EstimateError::Interval { first: 1, second: 9, .. })));
}

/// Hits at 1 and 2, with sensors at 1 and 2, on a symmetric structure; `change` may spoil them.
fn both_ways(change: impl Fn(&str, &str, f64) -> f64) -> Estimate {
    let drive = common::Structure { modes: [(87.3, 9.0, -0.11), (311.7, 14.0, -0.07)], direct: 0.4 };
    let cross = common::Structure { modes: [(87.3, 9.0, -0.09), (311.7, 14.0, 0.05)], direct: 0.1 };
    let hits: Vec<Hit> = ["1", "1", "2", "2"]
        .iter()
        .zip(1..)
        .map(|(struck, number)| {
            let force = pulse(4096, 80, 4, 90.0);
            let sensor = |point: &str| {
                let structure = if point == *struck { drive } else { cross };
                let values = structure.answer(&force).iter().map(|v| change(point, struck, *v)).collect();
                Response::new(Channel::transverse(point), MeasuredMotion::Acceleration, values)
            };
            let responses = vec![sensor("1"), sensor("2")];
            Hit::new(number, INTERVAL, 0.0, Channel::transverse(*struck), force, responses).unwrap()
        })
        .collect();
    of(&hits).unwrap()
}

#[test]
fn a_reversed_sensor_is_told_by_the_driving_point_and_by_reciprocity() {
    assert!(both_ways(|_, _, v| v).remarks.is_empty());
    let reversed = both_ways(|point, _, v| if point == "2" { -v } else { v }).remarks;
    let drawing: Vec<String> = reversed
        .iter()
        .filter_map(|remark| match remark {
            Remark::DrawsEnergy(pair) => Some(pair.to_string()),
            _ => None,
        })
        .collect();
    assert_eq!(drawing, ["2/2"], "{reversed:?}");
    let is_across = |remark: &Remark| match remark {
        Remark::NotReciprocal { frfs, is_sign: true, .. } => {
            frfs.iter().all(|pair| pair.response != pair.reference)
        }
        _ => false,
    };
    assert!(reversed.iter().any(is_across), "{reversed:?}");
}

#[test]
fn swapped_sensors_break_reciprocity() {
    let swapped = both_ways(|point, struck, v| if point != struck && struck == "1" { 2.0 * v } else { v });
    assert!(
        swapped.remarks.iter().any(|r| matches!(r, Remark::NotReciprocal { is_sign: false, .. })),
        "{:?}",
        swapped.remarks
    );
}

#[test]
fn ringing_from_the_hit_before_and_a_drift_are_remarked() {
    let mut hits = Test::quiet(3, 4096).hits();
    let old = |i: usize| 2.0 * (-0.0005 * i as f64).exp() * (0.4 * i as f64).sin();
    let ringing: Vec<f64> =
        hits[1].responses()[0].values.iter().enumerate().map(|(i, v)| v + old(i)).collect();
    hits[1] = hit(2, hits[1].force().to_vec(), ringing);
    let remarks = of(&hits).unwrap().remarks;
    let rings = |r: &Remark| matches!(r, Remark::RingingBefore(hits) if hits[0].0 == 2);
    assert!(remarks.iter().any(rings), "{remarks:?}");
    let drifting = |i: usize| 2e-3 * i as f64;
    let force: Vec<f64> = hits[2].force().iter().enumerate().map(|(i, f)| f + drifting(i)).collect();
    hits[2] = hit(3, force, hits[2].responses()[0].values.clone());
    let remarks = of(&hits).unwrap().remarks;
    assert!(remarks.contains(&Remark::DriftingBaselines(vec![Signal::Force])), "{remarks:?}");
}
