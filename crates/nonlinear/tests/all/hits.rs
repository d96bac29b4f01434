//! A law of a joint found in hits of several strengths, beside what the fixture states wrongly.

use jointscope_fixture::{EffectKind, Fixture};
use jointscope_hits::{Hit, Response};
use jointscope_nonlinear::{NonlinearDiagnosis, NonlinearOptions, Verdict, simulate};
use jointscope_samples::Noise;
use jointscope_spectra::Channel;
use jointscope_wording::Says;

const INTERVAL: f64 = 1.0 / 5120.0;
const SAMPLES: usize = 2048;

/// Two storeys on a spring of this stiffness, known to 1 %.
fn storeys(stiffness: f64, physics: &str) -> Fixture {
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ "A": {{ "mass": {{"value": 2.0, "std": 0.004}}, "rotates": false }}, "B": {{ "mass": {{"value": 3.0, "std": 0.006}}, "rotates": false }} }},
  "points": {{ "1": {{ "body": "A", "x": 0 }}, "2": {{ "body": "B", "x": 0.1 }} }},
  "joints": {{ "J": {{ "from": "1", "to": "2", "stiffness": [[{{"value": {stiffness}, "std": 5e4}}, 0], [0, 0]] }} }},
  "damping": {{ "modal_ratios": [0.02] }}, "physics": [{physics}] }}"#
    ))
    .unwrap()
}

/// Two hits of each of three strengths, with noise.
fn struck(fixture: &Fixture) -> Vec<Hit> {
    let mut noise = Noise::new(3);
    let mut normal = move || noise.complex(2.0).re;
    let channels = ["1", "2"].map(Channel::transverse);
    let mut recorded = |(number, peak): (u32, f64)| {
        let blow = (0..SAMPLES).map(|i| peak * (-0.5 * ((i as f64 - 50.0) / 2.0).powi(2)).exp());
        let hit = Hit::new(number, INTERVAL, 0.0, Channel::transverse("1"), blow.collect(), Vec::new());
        let exact = simulate(fixture, &[hit.unwrap()], &channels).unwrap().hits.remove(0);
        let mut spoilt = |values: &[f64], deviation: f64| -> Vec<f64> {
            values.iter().map(|value| value + deviation * normal()).collect()
        };
        let responses = exact.responses().iter().map(|response| {
            let most = response.values.iter().fold(0.0, |most: f64, value| value.abs().max(most));
            Response { values: spoilt(&response.values, 1e-3 * most), ..response.clone() }
        });
        let responses = responses.collect();
        let force = spoilt(exact.force(), 2e-4 * peak);
        Hit::new(number, INTERVAL, 0.0, Channel::transverse("1"), force, responses).unwrap()
    };
    (1..).zip([50.0, 52.0, 110.0, 112.0, 200.0, 205.0]).map(&mut recorded).collect()
}

#[test]
fn a_law_beside_a_joint_that_is_stiffer_than_stated_explains_in_part_and_the_stiffness_is_told() {
    let cubic = r#"{ "kind": "cubic_stiffness", "place": "J", "dof": "translation", "stiffness3": 4e14 }"#;
    let hits = struck(&storeys(5e6, cubic));
    let found = |stated: f64| {
        NonlinearDiagnosis::of(&storeys(stated, ""), &hits, &NonlinearOptions::default()).unwrap()
    };
    for (stated, verdict) in [(5e6, Verdict::Explained), (4.5e6, Verdict::PartlyExplained)] {
        let found = found(stated);
        assert_eq!(found.verdict, verdict, "{}", found.says());
        let kinds: Vec<EffectKind> = found.findings.iter().map(|finding| finding.effect.kind).collect();
        assert_eq!(kinds, [EffectKind::CubicStiffness], "{}", found.says());
        let size = found.findings[0].effect.value(0);
        assert!((size / 4e14 - 1.0).abs() < 0.03, "{size:e}");
        let [.., repaired] = found.models.as_ref().unwrap();
        let departed: Vec<&str> =
            repaired.departed().iter().map(|quantity| quantity.stated.path.as_str()).collect();
        match verdict {
            Verdict::Explained => assert!(departed.is_empty(), "{departed:?}"),
            _ => {
                assert_eq!(departed.first(), Some(&"joints/J/stiffness/0/0"), "{departed:?}");
                let says = found.says();
                assert!(says.contains("joints/J/stiffness/0/0 would have to be 5.0"), "{says}");
                assert!(says.contains("does not depend on amplitude"), "{says}");
            }
        }
    }
}
