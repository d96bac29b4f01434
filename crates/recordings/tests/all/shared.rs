//! Real and simulated recordings beside the repository, where they are present.

use std::fs;
use std::path::{Path, PathBuf};

use jointscope_fixture::Fixture;
use jointscope_recordings::{HeldAmplitude, ReadOptions, Recording, RecordingError, Source};
use jointscope_spectra::FrfForm;

fn shared() -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    path.is_dir().then_some(path)
}

fn source(path: &Path) -> Source {
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    Source { name, file: jointscope_uff::read(&fs::read(path).unwrap()).unwrap() }
}

fn recording(folder: &Path, files: &[&str]) -> Result<Recording, RecordingError> {
    let fixture = Fixture::from_json(&fs::read_to_string(folder.join("fixture.json")).unwrap()).unwrap();
    let sources: Vec<Source> = files.iter().map(|file| source(&folder.join(file))).collect();
    Recording::of(&sources, &fixture, &ReadOptions::default())
}

#[test]
fn every_simulated_case_is_read_with_coherence_and_averages() {
    let Some(shared) = shared() else { return };
    for case in 1..=24 {
        let folder = shared.join(format!("concealed/open/case-{case:03}"));
        let unseen = recording(&folder, &["unseen.uff"]).unwrap();
        assert!(unseen.frfs().unwrap().pairs().len() >= 3, "case {case}");
        if matches!(case, 13 | 14 | 24) {
            let answer = recording(&folder, &["hits.uff"]).unwrap_err();
            let found = matches!(
                &answer,
                RecordingError::OnlyTimeHistories { count: 54, channels, .. } if channels.len() == 4
            );
            assert!(found, "case {case}: {answer:?}");
            continue;
        }
        let recording = recording(&folder, &["frf.uff"]).unwrap();
        assert!(recording.notes.is_empty(), "case {case}: {:?}", recording.notes);
        let level = &recording.levels[0];
        let frfs = recording.frfs().unwrap();
        let count = if matches!(case, 2 | 6) { 8 } else { 4 };
        assert_eq!((frfs.pairs().len(), frfs.lines().len()), (count, 400), "case {case}");
        let form = match case {
            3 | 16 => FrfForm::Mobility,
            11 | 19 | 20 | 22 | 23 => FrfForm::Receptance,
            _ => FrfForm::Accelerance,
        };
        for index in 0..count {
            assert_eq!(level.recorded_forms[index], form, "case {case}");
            assert!(frfs.coherence(index).is_some(), "case {case}, FRF {}", frfs.pairs()[index]);
            assert!(frfs.averages(index).is_some_and(|n| n >= 5), "case {case}");
        }
    }
}

#[test]
fn sensors_along_minus_y_are_turned_and_their_coherence_stays() {
    let Some(shared) = shared() else { return };
    // Case 18 has two FRFs recorded along −y.
    let folder = shared.join("concealed/open/case-018");
    let recording = recording(&folder, &["frf.uff"]).unwrap();
    let raw = source(&folder.join("frf.uff"));
    let flipped = raw.file.datasets.iter().filter(|d| d.response.direction == -2 && d.function.code() == 4);
    assert_eq!(flipped.clone().count(), 2);
    for dataset in flipped {
        let frfs = recording.frfs().unwrap();
        let pair = frfs.pairs().iter().position(|pair| {
            pair.response.point == dataset.response.number.to_string()
                && pair.reference.point == dataset.reference.number.to_string()
        });
        let jointscope_uff::Data::Complex(values) = &dataset.data else { panic!("an FRF is complex") };
        assert_eq!(frfs.values(pair.unwrap())[100], -values[100]);
        assert!(frfs.coherence(pair.unwrap()).is_some());
    }
}

#[test]
fn the_lap_jointed_beam_has_four_force_levels_and_eight_response_levels() {
    let Some(shared) = shared() else { return };
    let folder = shared.join("recordings/brake-reuss-beam");
    let forces = recording(&folder, &["force-controlled.uff"]).unwrap();
    let held: Vec<_> = forces.levels.iter().filter_map(|level| level.held).collect();
    assert_eq!(held, [0.19, 0.52, 0.95, 1.43].map(HeldAmplitude::Force));
    assert!(matches!(forces.frfs(), Err(RecordingError::SeveralLevels { count: 4, .. })));
    let low = recording(&folder, &["response-5-to-40.uff"]).unwrap();
    assert_eq!(low.levels.len(), 4);
    assert_eq!(low.levels[2].frfs.lines().hz()[0], 79.2);
    let all = recording(
        &folder,
        &["response-50-to-80.uff", "force-controlled.uff", "ringdown.uff", "response-5-to-40.uff"],
    )
    .unwrap();
    assert_eq!((all.levels.len(), all.time_histories.count), (12, 3));
    let answer = recording(&folder, &["ringdown.uff"]).unwrap_err();
    assert!(matches!(answer, RecordingError::OnlyTimeHistories { count: 3, .. }));
}

#[test]
fn the_roving_hammer_test_of_a_beam_is_nine_frfs_with_the_sensor_turned() {
    let Some(shared) = shared() else { return };
    let folder = shared.join("recordings/modelab-beam");
    let recording = recording(&folder, &["frf.uff"]).unwrap();
    let frfs = recording.frfs().unwrap();
    assert_eq!((frfs.pairs().len(), frfs.lines().len()), (9, 50_689));
    let driving = frfs.pairs().iter().position(|pair| pair.to_string() == "4/4").unwrap();
    // At a driving point power flows in: the accelerance's imaginary part at resonance is positive.
    let band = frfs.lines().range(105.0, 120.0);
    let peak =
        frfs.values(driving)[band].iter().copied().max_by(|a, b| a.norm().total_cmp(&b.norm())).unwrap();
    assert!(peak.im > 0.0, "driving-point accelerance at its resonance: {peak}");
}

#[test]
fn a_file_of_hits_asks_for_an_estimate_first() {
    let Some(shared) = shared() else { return };
    let fixture = Fixture::from_json(
        r#"{"bodies": {"A": {"mass": 1, "rotates": false}}, "points": {"1": {"body": "A", "x": 0}}}"#,
    )
    .unwrap();
    let hits = source(&shared.join("recordings/hammer-hit/hits.uff"));
    let answer = Recording::of(&[hits], &fixture, &ReadOptions::default()).unwrap_err();
    let message = answer.to_string();
    assert!(message.contains("hits.uff: there are 6 time histories and no FRF"), "{message}");
}
