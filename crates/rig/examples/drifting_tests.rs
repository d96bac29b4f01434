//! Writes hammer tests that drift, and tests that look as if they did, into the directory given: for each
//! case `CASE/fixture.json` and `CASE/test.uff`.

use jointscope_fixture::{Dof, Effect, EffectKind, Fixture, Place};
use jointscope_rig::universal_file::{Precision, to_bytes};
use jointscope_rig::{HammerSetup, Instrument, drawn_within_tolerance, frfs, generator};
use jointscope_spectra::{FrfForm, FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;
use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

const SEED: u64 = 20_261_122;
const BLOCKS: &str = include_str!("../../../fixtures/two-blocks/fixture.json");
/// Three storeys on the ground.
const STOREYS: &str = r#"{
  "name": "three storeys",
  "bodies": {
    "F1": { "mass": { "value": 6.0, "std": 0.02 }, "rotates": false },
    "F2": { "mass": { "value": 5.0, "std": 0.02 }, "rotates": false },
    "F3": { "mass": { "value": 4.0, "std": 0.02 }, "rotates": false }
  },
  "points": { "1": { "body": "F1", "x": 0.0 }, "2": { "body": "F2", "x": 1.0 }, "3": { "body": "F3", "x": 2.0 } },
  "supports": { "G": { "point": "1", "stiffness": { "value": 3.0e6, "std": 1.0e5 } } },
  "joints": {
    "J1": { "from": "1", "to": "2", "stiffness": [[{ "value": 4.0e6, "std": 1.0e5 }, 0], [0, 0]] },
    "J2": { "from": "2", "to": "3", "stiffness": [[{ "value": 2.5e6, "std": 1.0e5 }, 0], [0, 0]] }
  },
  "damping": { "modal_ratios": [ { "value": 0.006, "std": 0.002 }, { "value": 0.006, "std": 0.002 }, { "value": 0.006, "std": 0.002 } ] }
}"#;

/// What differs while each reference was struck.
type Course = Vec<(&'static str, Vec<Effect>)>;

struct Case {
    name: &'static str,
    fixture: &'static str,
    /// Responses and references, each with each.
    channels: (Vec<&'static str>, Vec<&'static str>),
    hidden: Vec<Effect>,
    course: Course,
    /// Relative deviation of each FRF's gain.
    gains: f64,
}

fn stiffness(joint: &str, factor: f64) -> Effect {
    Effect::new(EffectKind::StiffnessChange, Place::Joint(joint.into()), None, &[factor])
}

fn cases() -> Vec<Case> {
    let compliance = || {
        let place = Place::Point("2".into());
        Effect::new(EffectKind::InterfaceCompliance, place, Some(Dof::Rotation), &[9.0e3, 0.05])
    };
    let blocks = |name, hidden, course| Case {
        name,
        fixture: BLOCKS,
        channels: (vec!["4", "3"], vec!["1", "2"]),
        hidden,
        course,
        gains: 0.0,
    };
    let on_2 = |factor| vec![("2", vec![stiffness("J", factor)])];
    let storeys = |name, course| Case {
        name,
        fixture: STOREYS,
        channels: (vec!["1", "2", "3"], vec!["1", "2", "3"]),
        hidden: Vec::new(),
        course,
        gains: 0.0,
    };
    let mass = Effect::new(EffectKind::AddedMass, Place::Body("B".into()), None, &[0.09, 0.03]);
    let roving = |grams: f64| {
        let sensor = |response: &str| {
            Effect::new(EffectKind::SensorMass, Place::Response(response.into()), None, &[1e-3 * grams])
        };
        ["3", "4"].map(sensor).to_vec()
    };
    vec![
        blocks("blocks-drift", Vec::new(), on_2(0.985)),
        blocks("blocks-drift-little", Vec::new(), on_2(0.998)),
        blocks("blocks-drift-hidden", vec![compliance()], on_2(0.985)),
        blocks("blocks-none", Vec::new(), Vec::new()),
        blocks("blocks-hidden", vec![compliance()], Vec::new()),
        blocks("blocks-mass", vec![mass], Vec::new()),
        blocks("blocks-roving-sensor", roving(8.0), Vec::new()),
        Case { gains: 0.1, ..blocks("blocks-gains", Vec::new(), Vec::new()) },
        Case {
            channels: (vec!["1", "4"], vec!["1", "2", "3", "4"]),
            ..blocks(
                "blocks-course",
                Vec::new(),
                vec![
                    ("2", vec![stiffness("J", 0.996)]),
                    ("3", vec![stiffness("J", 0.992)]),
                    ("4", vec![stiffness("J", 0.988)]),
                ],
            )
        },
        storeys("storeys-none", Vec::new()),
        storeys("storeys-drift", vec![("3", vec![stiffness("J2", 0.985)])]),
        storeys("storeys-warm", vec![("3", vec![stiffness("J1", 0.985), stiffness("J2", 0.985)])]),
    ]
}

fn recording(case: &Case) -> Result<FrfSet, Box<dyn Error>> {
    let mut drawn = generator(SEED);
    let truth = drawn_within_tolerance(&Fixture::from_json(case.fixture)?, &mut drawn)?;
    let storeys = case.fixture == STOREYS;
    let (responses, references) = &case.channels;
    let pair = |i: &&str| responses.iter().map(|o| FrfPair::transverse(o, i)).collect::<Vec<_>>();
    let pairs: Vec<FrfPair> = references.iter().flat_map(pair).collect();
    let lines = match storeys {
        true => SpectralLines::even(20.0, 0.5, 560)?,
        false => SpectralLines::even(5.0, 5.0, 200)?,
    };
    let mut values: Vec<Complex64> = Vec::new();
    for (index, pair) in pairs.iter().enumerate() {
        let now = case.course.iter().find(|(reference, _)| *reference == pair.reference.point);
        let mut physics = case.hidden.clone();
        physics.extend(now.iter().flat_map(|(_, effects)| effects.clone()));
        let gain = 1.0 + case.gains * [0.6, -0.8, 1.0, -0.3][index % 4];
        let struck = truth.clone().with_physics(physics)?;
        let set = frfs(&struck, std::slice::from_ref(pair), &lines, Instrument::AsDescribed)?;
        values.extend(set.values(0).iter().map(|value| value * gain));
    }
    let exact = FrfSet::new(lines, FrfForm::Accelerance, pairs, values)?;
    let corner = if storeys { 400.0 } else { 1000.0 };
    let hammer = HammerSetup {
        averages: 8,
        noise_response: 0.005,
        noise_force: 0.001,
        corner,
        spread: 0.25,
        common_hits: false,
        seed: SEED,
    };
    Ok(hammer.measure(&exact)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::args_os().nth(1).ok_or("name a directory")?);
    for case in cases() {
        let folder = folder.join(case.name);
        fs::create_dir_all(&folder)?;
        let mut fixture: serde_json::Value = serde_json::from_str(case.fixture)?;
        if case.gains > 0.0 {
            fixture["channels"] = serde_json::json!({ "*": { "gain": { "value": 1.0, "std": case.gains } } });
        }
        fs::write(folder.join("fixture.json"), serde_json::to_string_pretty(&fixture)?)?;
        fs::write(folder.join("test.uff"), to_bytes(case.name, &recording(&case)?, Precision::Single)?)?;
    }
    Ok(())
}
