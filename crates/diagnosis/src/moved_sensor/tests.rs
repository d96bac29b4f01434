use super::{MovedSensor, WithoutSensors};
use crate::candidate::Candidate;
use crate::catalogue::catalogue;
use crate::fitter::Fitter;
use crate::settings::Settings;
use crate::simulated::{observed, simulated};
use crate::{Hypothesis, Observation, Watch};
use jointscope_fixture::{Effect, EffectKind, Fixture, Place};
use jointscope_lumped::{Instrument, synthesize};
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};

/// Noise of a thousandth of each value.
const VARIANCE: f64 = 1e-6;

/// Two blocks on a strip of this modulus.
fn blocks(modulus: f64) -> Fixture {
    let text = format!(
        r#"{{ "bodies": {{ "A": {{ "mass": 1.1, "inertia": 9.5e-4, "x_cg": -0.03 }}, "B": {{ "mass": 1.2, "inertia": 9.9e-4, "x_cg": 0.095 }} }},
             "points": {{ "1": {{ "body": "A", "x": -0.06 }}, "2": {{ "body": "A", "x": 0 }}, "3": {{ "body": "B", "x": 0.065 }}, "4": {{ "body": "B", "x": 0.125 }} }},
             "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": {modulus}, "second_moment": 3.67e-10 }} }} }},
             "damping": {{ "modal_ratios": [0.004, 0.006] }} }}"#
    );
    Fixture::from_json(&text).unwrap()
}

fn pairs() -> Vec<FrfPair> {
    ["1", "3", "4"].iter().flat_map(|o| ["1", "2"].map(|i| FrfPair::transverse(o, i))).collect()
}

fn lines() -> SpectralLines {
    SpectralLines::even(2.5, 2.5, 400).unwrap()
}

/// What is recorded of blocks on a strip of this modulus with sensors of these masses in grams.
fn recorded(modulus: f64, sensors: &[(Place, f64)]) -> Observation {
    let sensor = |(place, grams): &(Place, f64)| {
        Effect::new(EffectKind::SensorMass, place.clone(), None, &[1e-3 * grams])
    };
    let truth = blocks(modulus).with_physics(sensors.iter().map(sensor).collect()).unwrap();
    simulated(&truth, &pairs(), &lines(), VARIANCE)
}

/// What a recording tells of a sensor beside a model whose modulus is 2.07e11.
fn told(observation: &Observation) -> Option<MovedSensor> {
    let fixture = blocks(2.07e11);
    let names: Vec<Candidate> = catalogue(&fixture, observation);
    MovedSensor::of(observation, &Hypothesis::nominal(&fixture, false), &names)
}

#[test]
fn frequencies_that_differ_by_response_tell_a_sensor_and_its_mass_whatever_the_model_errs_by() {
    for place in [Place::Response("4".into()), Place::Responses] {
        for modulus in [2.07e11, 2.2e11] {
            let sensor = told(&recorded(modulus, &[(place.clone(), 6.0)])).unwrap();
            assert_eq!(sensor.effect().place, place, "{modulus}");
            assert!(sensor.probability > 0.9, "{place:?} {modulus}: {}", sensor.probability);
            assert!((sensor.effect().value(0) - 6e-3).abs() < 1.5 * sensor.deviation, "{modulus}");
            assert!(sensor.deviation < 4e-4, "{modulus}: {}", sensor.deviation);
        }
    }
}

#[test]
fn a_model_that_is_wrong_has_no_sensor_that_is_moved() {
    for modulus in [2.07e11, 2.2e11] {
        assert!(told(&recorded(modulus, &[])).is_none(), "{modulus}");
    }
}

#[test]
fn frequencies_of_one_response_that_are_all_lower_alike_are_of_no_sensor() {
    // As if that response had been recorded on a warmer day.
    let (cold, warm) = (recorded(2.07e11, &[]), recorded(2.04e11, &[]));
    let lines = lines().len();
    let is_warm = |at: usize| pairs()[at / lines].response.point == "4";
    let values = cold.values().iter().zip(warm.values()).enumerate();
    let values = values.map(|(at, (cold, warm))| if is_warm(at) { *warm } else { *cold }).collect();
    let both = FrfSet::new(cold.lines().clone(), cold.frfs().form(), pairs(), values).unwrap();
    assert!(told(&observed(both, VARIANCE)).is_none());
}

#[test]
fn a_sensor_that_is_taken_off_leaves_what_the_structure_does_without_it() {
    let observation = recorded(2.2e11, &[(Place::Response("4".into()), 6.0)]);
    let unloaded = told(&observation).unwrap().load.taken_off(&observation).unwrap();
    let free = synthesize(&blocks(2.2e11), &pairs(), &lines(), Instrument::AsRecorded).unwrap();
    let missed = |of: &Observation| {
        let squares = |all: &mut dyn Iterator<Item = f64>| all.sum::<f64>();
        let error = of.values().iter().zip(free.all_values()).map(|(a, b)| (a - b).norm_sqr());
        (squares(&mut error.into_iter()) / squares(&mut free.all_values().iter().map(|v| v.norm_sqr())))
            .sqrt()
    };
    assert!(missed(&observation) > 0.05, "{}", missed(&observation));
    assert!(missed(&unloaded) < 0.1 * missed(&observation), "{}", missed(&unloaded));
}

#[test]
fn one_mode_alone_does_not_tell_a_sensor_from_a_warmer_day() {
    let whole = recorded(2.07e11, &[(Place::Response("4".into()), 6.0)]);
    let sensor = told(&whole.reduced(|hz| hz < 400.0, |_| true).unwrap()).unwrap();
    assert_eq!(sensor.load.off.len(), 1, "modes in the band");
    let any_place = sensor.probability + sensor.alternatives.iter().map(|(_, p)| p).sum::<f64>();
    assert!(any_place < 0.95, "{any_place}");
}

/// Root mean square of what two recordings differ by, over that of the second.
fn apart(a: &Observation, b: &Observation) -> f64 {
    let square = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>();
    let difference = square(&mut a.values().iter().zip(b.values()).map(|(a, b)| (a - b).norm_sqr()));
    (difference / square(&mut b.values().iter().map(|b| b.norm_sqr()))).sqrt()
}

#[test]
fn stated_sensors_are_taken_off_a_recording_that_the_fixture_does_not_explain() {
    let sensor = Effect::new(EffectKind::SensorMass, Place::Responses, None, &[6e-3]);
    let window = Effect::new(EffectKind::ExponentialWindow, Place::All, None, &[4.0]);
    for window in [vec![], vec![window]] {
        let with_window =
            |fixture: Fixture, sensors: &[Effect]| fixture.with_physics([sensors, &window].concat()).unwrap();
        let recorded = |modulus: f64, sensors: &[Effect]| {
            simulated(&with_window(blocks(modulus), sensors), &pairs(), &lines(), VARIANCE)
        };
        let stated = Hypothesis::nominal(&with_window(blocks(2.07e11), std::slice::from_ref(&sensor)), false);
        let settings = Settings::default();
        let without = |observation: &Observation| {
            let fitter = Fitter { observation, settings: &settings, watch: Watch::default() };
            WithoutSensors::of(&fitter, &stated, true)
        };
        assert!(without(&recorded(2.07e11, std::slice::from_ref(&sensor))).is_none(), "lines do not mind");
        assert!(without(&recorded(2.5e11, &[])).is_none(), "nothing was moved");
        let loaded = recorded(2.5e11, std::slice::from_ref(&sensor));
        let (found, unloaded) = without(&loaded).unwrap();
        assert_eq!(found.sensors(), std::slice::from_ref(&sensor));
        assert_eq!(found.nominal.fixture().physics(), window);
        let truth = recorded(2.5e11, &[]);
        let (before, after) = (apart(&loaded, &truth), apart(&unloaded, &truth));
        assert!(before > 0.1 && after < 0.01 * before, "{before} {after}");
    }
}
