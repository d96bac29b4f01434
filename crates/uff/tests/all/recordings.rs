//! Recordings of real and simulated structures that lie beside the workspace, where they are at hand.

use std::path::{Path, PathBuf};

use jointscope_uff::{Abscissa, Data, Encoding, FunctionType, Precision, UffFile, data_type, read, write};

/// A folder beside the workspace, or nothing and a message.
fn beside_the_workspace(folder: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared").join(folder);
    if !path.is_dir() {
        println!("skipped: no folder `shared/{folder}` beside the workspace");
        return None;
    }
    Some(path)
}

fn open(path: &Path) -> UffFile {
    let bytes = std::fs::read(path).unwrap();
    read(&bytes).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn universal_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            universal_files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "uff") {
            found.push(path);
        }
    }
}

#[test]
fn every_recording_is_read_and_its_second_writing_holds_the_same() {
    let structures = ["brake-reuss-beam", "clamped-beam-masses", "hammer-hit", "modelab-beam"]
        .map(|name| format!("recordings/{name}"));
    for folder in structures.iter().map(String::as_str).chain(["concealed/open", "concealed/solids"]) {
        let Some(folder) = beside_the_workspace(folder) else { continue };
        let mut files = Vec::new();
        universal_files(&folder, &mut files);
        assert!(!files.is_empty());
        for path in files {
            let file = open(&path);
            assert!(!file.datasets.is_empty() && file.skipped.is_empty(), "{}", path.display());
            assert_eq!(read(&write(&file.datasets).unwrap()).unwrap(), file, "{}", path.display());
        }
    }
}

/// Files of many programs with datasets of every kind: every one is read, and functions among them come back.
#[test]
fn functions_among_datasets_of_other_kinds_come_back_after_a_second_writing() {
    let Some(folder) = beside_the_workspace("recordings/pyuff-data") else { return };
    let mut files = Vec::new();
    universal_files(&folder, &mut files);
    let mut with_functions = 0;
    for path in files {
        let file = open(&path);
        assert!(file.unreadable.is_empty(), "{}: {:?}", path.display(), file.unreadable);
        if !file.datasets.is_empty() {
            with_functions += 1;
            let once = write(&file.datasets).unwrap();
            assert_eq!(write(&read(&once).unwrap().datasets).unwrap(), once, "{}", path.display());
        }
    }
    assert!(with_functions >= 7, "{with_functions} files with functions");
}

#[test]
fn the_modelab_beam_has_nine_frfs_of_50689_lines() {
    let Some(folder) = beside_the_workspace("recordings") else { return };
    let file = open(&folder.join("modelab-beam/frf.uff"));
    assert_eq!(file.datasets.len(), 9);
    for (index, frf) in file.datasets.iter().enumerate() {
        assert_eq!(frf.function, FunctionType::FrequencyResponse);
        assert_eq!(frf.abscissa, Abscissa::Even { start: 10.0, step: 0.01953125, count: 50_689 });
        assert!((frf.abscissa.value(50_688) - 1000.0).abs() < 0.02);
        assert_eq!((frf.response.number, frf.response.direction), (4, -2));
        assert_eq!((frf.reference.number, frf.reference.direction), (index as i64 + 1, 2));
        assert_eq!(frf.precision, Precision::Single);
        assert!(matches!(&frf.data, Data::Complex(lines) if lines.len() == 50_689));
    }
}

#[test]
fn the_brake_reuss_beam_has_twelve_levels_of_41_lines_and_a_ring_down() {
    let Some(folder) = beside_the_workspace("recordings") else { return };
    let folder = folder.join("brake-reuss-beam");
    let mut levels = Vec::new();
    for name in ["response-5-to-40.uff", "response-50-to-80.uff", "force-controlled.uff"] {
        for frf in open(&folder.join(name)).datasets {
            assert_eq!((frf.data.len(), frf.encoding), (41, Encoding::Ascii));
            levels.push(frf.id_lines[3].clone());
        }
    }
    let expected =
        ["5", "20", "30", "40", "50", "60", "70", "80"].map(|level| format!("response {level} m/s^2"));
    assert_eq!(levels[..8], expected);
    assert_eq!(levels[8..], ["0.19", "0.52", "0.95", "1.43"].map(|level| format!("force {level} N")));

    let ring_down = open(&folder.join("ringdown.uff"));
    let channels: Vec<_> = ring_down
        .datasets
        .iter()
        .map(|channel| (channel.response.number, channel.response.direction))
        .collect();
    assert_eq!(channels, [(1, 2), (2, -2), (3, -2)]);
    for channel in &ring_down.datasets {
        // 12.8 kHz for 5.12 s from −0.01 s.
        assert_eq!(channel.abscissa, Abscissa::Even { start: -0.01, step: 1.0 / 12_800.0, count: 65_536 });
    }
}

#[test]
fn two_hammer_hits_have_three_channels_of_8192_samples() {
    let Some(folder) = beside_the_workspace("recordings") else { return };
    let hits = open(&folder.join("hammer-hit/hits.uff"));
    let channels: Vec<_> = hits
        .datasets
        .iter()
        .map(|channel| (channel.sequence_number, channel.response.number, channel.ordinate_axis.data_type))
        .collect();
    let [force, response] = [data_type::EXCITATION_FORCE, data_type::ACCELERATION];
    for hit in [1, 2] {
        for channel in [(hit, 3, force), (hit, 1, response), (hit, 2, response)] {
            assert!(channels.contains(&channel), "{channel:?} is missing from {channels:?}");
        }
    }
    assert_eq!(channels.len(), 6);
    for channel in &hits.datasets {
        assert_eq!(channel.function, FunctionType::TimeResponse);
        assert_eq!(channel.abscissa, Abscissa::Even { start: 0.0, step: 0.000977, count: 8192 });
        if channel.ordinate_axis.data_type == force {
            assert_eq!(channel.response.direction, -2);
        }
    }
}

/// Counts as pyuff has them, see `docs/development/checks/geometry_with_pyuff.py`.
#[test]
fn geometry_and_shapes_of_many_programs_are_read_in_full() {
    let Some(folder) = beside_the_workspace("recordings/pyuff-data") else { return };
    let check = |name: &str, nodes: usize, elements: usize, modes: usize| {
        let file = open(&folder.join(name));
        let found: usize = file.nodes.iter().map(|nodes| nodes.nodes.len()).sum();
        assert_eq!((found, file.elements.len()), (nodes, elements), "{name}: nodes and elements");
        let shapes: Vec<_> = file.nodal.iter().filter(|data| data.is_mode()).collect();
        assert_eq!(shapes.len(), modes, "{name}: modes");
        assert!(shapes.iter().all(|mode| !mode.values.is_empty()), "{name}");
    };
    check("2411 and 2414.uff", 441, 400, 10);
    check("NX simulation output.uff", 18, 17, 176);
    check("groups_test.uff", 74, 341, 0);
    check("mesh_Oros-modal_uff15_uff2412.uff", 96, 72, 0);
    check("Artemis export - Geometry RPBC_setup_05_14102016_105117.uff", 74, 108, 0);
    check("uff55_translation.uff", 0, 0, 3);
    check("uff55_translation_rotation.uff", 0, 0, 1);
}
