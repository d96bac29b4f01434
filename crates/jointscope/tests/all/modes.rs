//! Modes of FRFs without files, of the simulated cases, and of a real free beam whose resonances drift from
//! hit to hit.

use jointscope::fixture::{Damping, Effect, EffectKind, Place};
use jointscope::recordings::{ReadOptions, Recording, Source};
use jointscope::{
    Fixture, Instrument, ModalAnalysis, ModesOptions, Remarks, SpectralLines, measured_damping, modes_file,
    synthesize,
};
use jointscope_samples::{ACROSS, transverse};
use std::path::{Path, PathBuf};

fn shared(part: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared").join(part)
}

const BLOCKS: &str = r#"{
  "bodies": { "A": { "mass": 1.10, "inertia": 9.5e-4, "x_cg": -0.030 }, "B": { "mass": 1.25, "inertia": 1.1e-3, "x_cg": 0.096 } },
  "points": { "1": { "body": "A", "x": -0.060 }, "2": { "body": "A", "x": 0.0 }, "3": { "body": "B", "x": 0.065 }, "4": { "body": "B", "x": 0.127 } },
  "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2.07e11, "second_moment": 3.6e-10 } } },
  "damping": { "modal_ratios": [0.003, 0.0045] } }"#;

#[test]
fn the_ratios_of_a_synthesized_test_go_back_into_its_fixture_without_a_file() {
    let fixture = Fixture::from_json(BLOCKS).unwrap();
    let pairs = transverse(&ACROSS);
    let lines = SpectralLines::even(2.5, 2.5, 600).unwrap();
    let frfs = synthesize(&fixture, &pairs, &lines, Instrument::Perfect).unwrap();
    let analysis = ModalAnalysis::of(&frfs, &ModesOptions::default()).unwrap();
    let undamped = fixture.clone().with_damping(Damping::Undamped).unwrap();
    let measured = measured_damping(&undamped, &analysis).unwrap();
    let Damping::ModalRatios { ratios, .. } = measured.fixture.damping() else {
        panic!("ratios were measured")
    };
    for (ratio, truth) in ratios.iter().zip([0.003, 0.0045]) {
        assert!((ratio.value / truth - 1.0).abs() < 1e-4, "{ratio:?} of {truth}");
    }
    assert!(
        measured.matches.other_measured.is_empty() && measured.matches.pairs.iter().all(|p| p.mac > 0.99)
    );
    let file = modes_file(&analysis);
    assert_eq!(file["modes"][0]["frequency"].as_f64(), Some(analysis.modes[0].frequency));
}

#[test]
fn a_window_s_decay_is_taken_off_the_damping_of_modes_and_said() {
    let decay = 4.0;
    let windowed = Effect::new(EffectKind::ExponentialWindow, Place::All, None, &[decay]);
    let fixture = Fixture::from_json(BLOCKS).unwrap();
    let as_recorded = fixture.clone().with_physics(vec![windowed]).unwrap();
    let lines = SpectralLines::even(2.5, 2.5, 600).unwrap();
    let frfs = synthesize(&as_recorded, &transverse(&ACROSS), &lines, Instrument::AsRecorded).unwrap();
    let recorded = ModalAnalysis::of(&frfs, &ModesOptions::default()).unwrap();
    let own = recorded.clone().without_window(decay);
    for (mode, truth) in own.modes.iter().zip([0.003, 0.0045]) {
        assert!((mode.damping_ratio / truth - 1.0).abs() < 5e-4, "{mode:?} of {truth}");
        assert!((-mode.pole.re / mode.pole.norm() / truth - 1.0).abs() < 5e-4, "{mode:?} of {truth}");
    }
    assert!(recorded.modes[0].damping_ratio > 1.5 * own.modes[0].damping_ratio);
    assert_eq!(modes_file(&own)["window_decay"], decay);
    assert!(own.remarks().iter().any(|said| said.contains("decay of 4")), "{:?}", own.remarks());
    assert!(modes_file(&recorded).get("window_decay").is_none());
}

#[test]
fn a_band_that_holds_the_second_mode_alone_leaves_the_first_ratio_as_it_was() {
    let fixture = Fixture::from_json(BLOCKS).unwrap();
    let pairs = transverse(&ACROSS);
    let lines = SpectralLines::even(2.5, 2.5, 600).unwrap();
    let frfs = synthesize(&fixture, &pairs, &lines, Instrument::Perfect).unwrap();
    let all = ModalAnalysis::of(&frfs, &ModesOptions::default()).unwrap();
    let second = all.modes[1].frequency;
    let options = ModesOptions { band: Some((0.7 * second, 1.2 * second)), ..ModesOptions::default() };
    let analysis = ModalAnalysis::of(&frfs, &options).unwrap();
    let believed = Fixture::from_json(&BLOCKS.replace("[0.003, 0.0045]", "[0.007]")).unwrap();
    let measured = measured_damping(&believed, &analysis).unwrap();
    let Damping::ModalRatios { ratios, .. } = measured.fixture.damping() else {
        panic!("ratios were measured")
    };
    assert_eq!(ratios[0].value, 0.007);
    assert!((ratios[1].value / 0.0045 - 1.0).abs() < 1e-3, "{:?}", ratios[1]);
    assert!(measured.remarks.iter().any(|r| r.contains("not measured")), "{:?}", measured.remarks);
}

#[test]
fn frequencies_that_leave_out_a_fixtures_effects_say_so() {
    let soft = r#""damping": { "modal_ratios": [0.003, 0.0045] },
        "physics": [ { "kind": "interface_compliance", "place": "2", "dof": "rotation", "stiffness": 20000 } ] }"#;
    let plain = Fixture::from_json(BLOCKS).unwrap();
    let yielding = BLOCKS.replace(r#""damping": { "modal_ratios": [0.003, 0.0045] } }"#, soft);
    let yielding = Fixture::from_json(&yielding).unwrap();
    let pairs = transverse(&ACROSS);
    let lines = SpectralLines::even(2.5, 2.5, 600).unwrap();
    let frfs = synthesize(&yielding, &pairs, &lines, Instrument::Perfect).unwrap();
    let analysis = ModalAnalysis::of(&frfs, &ModesOptions::default()).unwrap();
    let says = |fixture: &Fixture| {
        let remarks = measured_damping(fixture, &analysis).unwrap().remarks;
        remarks.iter().any(|remark| remark.contains("effects it states (interface_compliance)"))
    };
    assert!(says(&yielding) && !says(&plain));
}

#[test]
fn modes_of_the_cases_that_hide_nothing_have_their_true_ratios() {
    let Ok(cases) = std::fs::read_dir(shared("concealed/open")) else {
        eprintln!("skipped: the simulated cases are not here");
        return;
    };
    let mut checked = 0;
    for case in cases.map(|case| case.unwrap().path()) {
        let Ok(truth) = std::fs::read_to_string(case.join("truth.json")) else { continue };
        let truth: serde_json::Value = serde_json::from_str(&truth).unwrap();
        let (true, Ok(bytes)) =
            (truth["effects"] == serde_json::json!([]), std::fs::read(case.join("frf.uff")))
        else {
            continue;
        };
        let fixture =
            Fixture::from_json(&std::fs::read_to_string(case.join("fixture.json")).unwrap()).unwrap();
        let recording = jointscope::read(&fixture, &bytes).unwrap();
        let analysis = ModalAnalysis::of(recording.frfs().unwrap(), &ModesOptions::default()).unwrap();
        let measured = measured_damping(&fixture, &analysis).unwrap();
        for pair in measured.matches.pairs {
            let key = format!("damping/modal_ratios/{}", pair.expected);
            let Some(known) = truth["true_quantities"][&key]["true"].as_f64() else { continue };
            let mode = &analysis.modes[pair.measured];
            let off = (mode.damping_ratio - known) / mode.damping_std;
            assert!(
                off.abs() < 4.0,
                "{}: {} ± {} of {known}",
                case.display(),
                mode.damping_ratio,
                mode.damping_std
            );
            checked += 1;
        }
    }
    assert!(checked >= 7, "{checked} ratios were compared");
}

#[test]
fn the_real_beams_modes_drift_and_their_deviations_say_so() {
    let Ok(bytes) = std::fs::read(shared("recordings/modelab-beam/frf.uff")) else {
        eprintln!("skipped: the recording of the free beam is not here");
        return;
    };
    let source = Source { name: "frf.uff".into(), file: jointscope::uff::read(&bytes).unwrap() };
    let recording = Recording::of_nodes(&[source], &ReadOptions::default()).unwrap();
    let analysis = ModalAnalysis::of(recording.frfs().unwrap(), &ModesOptions::default()).unwrap();
    assert_eq!(analysis.modes.len(), 4);
    // Means and scatter of the nine records by an independent calculation.
    let expected = [
        (111.995, 0.0023, 1.386e-4),
        (306.855, 0.0064, 1.178e-4),
        (596.367, 0.0127, 9.79e-5),
        (974.135, 0.029, 1.08e-4),
    ];
    for (mode, (hz, scatter, ratio)) in analysis.modes.iter().zip(expected) {
        assert!((mode.frequency - hz).abs() < 0.5 * scatter, "{} of {hz} Hz", mode.frequency);
        let drift = mode.drift.as_ref().unwrap();
        assert!((0.6..1.5).contains(&(drift.frequency / scatter)), "{} of {scatter} Hz", drift.frequency);
        assert!(mode.frequency_std > 0.9 * drift.frequency);
        assert!(
            (mode.damping_ratio - ratio).abs() < 1.5 * mode.damping_std,
            "{} ± {} of {ratio}",
            mode.damping_ratio,
            mode.damping_std
        );
    }
}
