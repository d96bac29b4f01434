//! Whether FRFs change with the strength of hits, of hits under an exponential window: noise dies away with
//! the signal there.

use jointscope_fixture::Fixture;
use jointscope_hits::{Hit, Response};
use jointscope_nonlinear::{NonlinearDiagnosis, NonlinearOptions, simulate};
use jointscope_samples::Noise;
use jointscope_spectra::Channel;

/// Sampling interval, s.
const INTERVAL: f64 = 1.0 / 5120.0;
const SAMPLES: usize = 4096;
/// Decay of the window, 1/s.
const DECAY: f64 = 12.0;

/// Two storeys, joined by a spring that hardens by `cubic`, N/m³.
fn storeys(cubic: f64) -> Fixture {
    let law = format!(
        r#"{{ "kind": "cubic_stiffness", "place": "J", "dof": "translation", "stiffness3": {cubic} }}"#
    );
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ "A": {{ "mass": 2.0, "rotates": false }}, "B": {{ "mass": 3.0, "rotates": false }} }},
  "points": {{ "1": {{ "body": "A", "x": 0 }}, "2": {{ "body": "B", "x": 0.1 }} }},
  "joints": {{ "J": {{ "from": "1", "to": "2", "stiffness": [[5e6, 0], [0, 0]] }} }},
  "damping": {{ "modal_ratios": [0.004] }}, "physics": [{}] }}"#,
        if cubic > 0.0 { law } else { String::new() }
    ))
    .unwrap()
}

/// Five hits between 70 N and 150 N with noise, then all signals under the window.
fn hits(fixture: &Fixture, seed: u64) -> Vec<Hit> {
    let mut noise = Noise::new(seed);
    let mut normal = move || noise.complex(2.0).re;
    let channels = ["1", "2"].map(Channel::transverse);
    let blow = |peak: f64| -> Vec<f64> {
        (0..SAMPLES).map(|i| peak * (-0.5 * ((i as f64 - 50.0) / 1.6).powi(2)).exp()).collect()
    };
    let window = |i: usize| (-DECAY * INTERVAL * i as f64).exp();
    let mut spoilt = |values: &[f64], deviation: f64| -> Vec<f64> {
        values.iter().enumerate().map(|(i, v)| (v + deviation * normal()) * window(i)).collect()
    };
    let mut recorded = |number: u32, peak: f64| {
        let hit = Hit::new(number, INTERVAL, 0.0, Channel::transverse("1"), blow(peak), Vec::new()).unwrap();
        let exact = simulate(fixture, &[hit], &channels).unwrap().hits.remove(0);
        let responses = exact.responses().iter().map(|response| {
            let mean = response.values.iter().map(|v| v * v).sum::<f64>() / SAMPLES as f64;
            Response { values: spoilt(&response.values, 2e-3 * mean.sqrt()), ..response.clone() }
        });
        let responses = responses.collect();
        let force = spoilt(exact.force(), 2e-4 * peak);
        Hit::new(number, INTERVAL, 0.0, Channel::transverse("1"), force, responses).unwrap()
    };
    [70.0, 80.0, 110.0, 140.0, 150.0]
        .into_iter()
        .zip(1..)
        .map(|(peak, number)| recorded(number, peak))
        .collect()
}

fn p_value(cubic: f64, seed: u64) -> f64 {
    let hits = hits(&storeys(cubic), seed);
    NonlinearDiagnosis::of(&storeys(0.0), &hits, &NonlinearOptions::default()).unwrap().homogeneity.p_value
}

#[test]
fn a_tone_that_comes_and_goes_is_no_change_with_strength_where_its_lines_are_excluded() {
    let hits = hits(&storeys(0.0), 3);
    let with_tone = |(k, hit): (usize, &Hit)| {
        let level = 0.03 * hit.responses()[1].values.iter().map(|v| v.abs()).fold(0.0, f64::max);
        let tone = |i: usize| {
            let t = INTERVAL * i as f64;
            let part = (4.0 * i as f64 / SAMPLES as f64).min(1.0);
            let swelling = (std::f64::consts::PI * part).sin().powi(2);
            // A machine that runs up and down within the stronger hits.
            if k > 1 { level * swelling * (std::f64::consts::TAU * 333.0 * t).sin() } else { 0.0 }
        };
        let responses = hit.responses().iter().map(|response| {
            let values = response.values.iter().enumerate().map(|(i, v)| v + tone(i)).collect();
            Response { values, ..response.clone() }
        });
        let (number, force) = (hit.number(), hit.force().to_vec());
        Hit::new(number, INTERVAL, 0.0, hit.struck().clone(), force, responses.collect()).unwrap()
    };
    let humming: Vec<Hit> = hits.iter().enumerate().map(with_tone).collect();
    let p_value = |exclude: Vec<(f64, f64)>| {
        let options = NonlinearOptions { exclude, ..NonlinearOptions::default() };
        NonlinearDiagnosis::of(&storeys(0.0), &humming, &options).unwrap().homogeneity.p_value
    };
    assert!(p_value(Vec::new()) < 1e-3);
    let excluded = p_value(vec![(233.0, 433.0)]);
    assert!(excluded > 0.01, "{excluded}");
}

#[test]
fn linear_hits_under_an_exponential_window_are_alike_and_those_of_a_cubic_spring_are_not() {
    let linear: Vec<f64> = (1..=20).map(|seed| p_value(0.0, seed)).collect();
    assert!(linear.iter().all(|p| *p > 0.01), "{linear:?}");
    let hardening = p_value(1e14, 1);
    assert!(hardening < 1e-3, "{hardening}");
}
