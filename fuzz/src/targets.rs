//! What must hold for any input: nothing panics, what is refused is refused by an error, and what is answered
//! is finite and means what was read. The tests of the crate `jointscope` ask it of the corpus beside this
//! file.

use jointscope_comparison::{Comparison, ComparisonOptions, Decomposed};
use jointscope_estimation::{
    Baseline, Estimate, EstimateOptions, Estimator, ForceWindow, ResponseWindow, Weighting,
};
use jointscope_export::{self as export, ExportOptions, Program};
use jointscope_fixture::Fixture;
use jointscope_hits::{Hit, MeasuredMotion, Response};
use jointscope_import::{self as import, ColumnMap};
use jointscope_lumped::{Instrument, synthesize};
use jointscope_recordings::{
    AssumedUnits, ChannelMap, Contents, Geometry, ReadOptions, Recording, Source, hits_of,
};
use jointscope_spectra::{Channel, FrfPair, FrfSet, SpectralLines};
use jointscope_uff as universal;
use jointscope_wording::Summary;
use serde_json::Value;

const GLUED_JOINT: &str = include_str!("../../fixtures/glued-joint/fixture.json");

/// A universal file is written and read again as it was read.
pub fn uff(bytes: &[u8]) {
    let Ok(file) = universal::read(bytes) else { return };
    if file.datasets.is_empty() {
        return;
    }
    let Ok(written) = universal::write(&file.datasets) else { return };
    let again = universal::read(&written).expect("what was written is read");
    assert_eq!(again.datasets.len(), file.datasets.len());
    for (again, first) in again.datasets.iter().zip(&file.datasets) {
        assert_eq!(again.data.len(), first.data.len());
        assert_eq!(
            (again.response.number, again.reference.number),
            (first.response.number, first.reference.number)
        );
        assert_eq!((again.function, again.encoding), (first.function, first.encoding));
    }
    assert_eq!(universal::write(&again.datasets).as_deref(), Ok(written.as_slice()), "written twice");
}

/// A fixture means the same when it is written and read, and its FRFs are finite.
pub fn fixture(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(fixture) = Fixture::from_json(text) else { return };
    assert_eq!(Fixture::from_json(&fixture.to_json()).as_ref(), Ok(&fixture), "written and read");
    let names: Vec<&str> = fixture.points().iter().map(|point| point.name.as_str()).take(4).collect();
    let last = names[names.len() - 1];
    let pairs: Vec<FrfPair> = names.iter().map(|name| FrfPair::transverse(name, last)).collect();
    let lines = SpectralLines::even(0.0, 87.5, 6).expect("lines");
    for instrument in [Instrument::Perfect, Instrument::AsRecorded] {
        if let Ok(frfs) = synthesize(&fixture, &pairs, &lines, instrument) {
            finite(&frfs);
        }
    }
}

/// Whatever the format of a file, its FRFs and hits are finite, its contents and geometry are told.
pub fn recordings(bytes: &[u8]) {
    let Some((choice, bytes)) = bytes.split_first() else { return };
    let Ok(imported) = import::read(bytes, "a file", &ColumnMap::default()) else { return };
    let fixture = Fixture::from_json(GLUED_JOINT).expect("a shipped fixture");
    let sources = [Source { name: "a file".to_owned(), file: imported.file }];
    let is = |bit: u8| choice & 1 << bit != 0;
    let map = ["4:+z=4:y", "2:-y=3:y", "3:rz=4:theta"].iter().take(usize::from(choice & 3));
    let options = ReadOptions {
        map: ChannelMap::parse(map).expect("entries"),
        assume_units: is(2).then(|| AssumedUnits::parse("g,lbf").expect("units")),
        averages: is(3).then_some(3),
        ignore_coherence: is(4),
    };
    Contents::of(&sources).says();
    if let Ok(geometry) = Geometry::of(&sources, None) {
        let axis = geometry.longest_axis();
        assert!(geometry.points_along(axis).iter().all(|point| point.x.is_finite()));
    }
    for recording in [Recording::of_nodes(&sources, &options), Recording::of(&sources, &fixture, &options)] {
        recording.iter().flat_map(|recording| &recording.levels).for_each(|level| finite(&level.frfs));
    }
    for fixture in [None, Some(&fixture)] {
        if let Ok(hits) = hits_of(&sources, fixture, &options) {
            // Long ones are slow and tell nothing that short ones do not.
            if hits.hits.iter().map(Hit::samples).sum::<usize>() < 4096 {
                estimated(&hits.hits, &EstimateOptions::default());
            }
        }
    }
}

/// FRFs of any signals are finite, their variances and coherences too.
pub fn estimation(bytes: &[u8]) {
    let mut bytes = bytes.iter().copied();
    let mut byte = || bytes.next().unwrap_or(0);
    let choice = byte();
    let options = EstimateOptions {
        estimator: [Estimator::H1, Estimator::H2, Estimator::Hv][usize::from(choice % 3)],
        weighting: [Weighting::Auto, Weighting::Plain][usize::from(choice >> 2 & 1)],
        unbiased: choice >> 1 & 1 == 1,
        baseline: [Baseline::Offset, Baseline::Drift, Baseline::Keep][usize::from((choice >> 3) % 3)],
        force_window: match byte() {
            0 => ForceWindow::None,
            1 => ForceWindow::Auto,
            length => ForceWindow::Length(power(length)),
        },
        response_window: match byte() {
            0 => ResponseWindow::None,
            1 => ResponseWindow::Auto,
            decay => ResponseWindow::Decay(power(decay)),
        },
        zero_padding: u32::from(byte() % 4),
        keep: if choice & 64 == 0 { Vec::new() } else { vec![1, 2] },
        reject: if choice & 128 == 0 { Vec::new() } else { vec![1] },
    };
    let (hits, channels, samples) = (1 + byte() % 3, byte() % 3, 8 + usize::from(byte()));
    let interval = power(byte());
    let mut signal = || -> Vec<f64> {
        let scale = power(byte());
        (0..samples).map(|_| f64::from(byte().cast_signed()) * scale).collect()
    };
    let mut all = Vec::new();
    for number in 1..=hits {
        let force = signal();
        let response = |channel: u8| Channel::transverse(channel.to_string());
        let motions = [MeasuredMotion::Acceleration, MeasuredMotion::Velocity, MeasuredMotion::Displacement];
        let responses: Vec<Response> = (0..channels)
            .map(|channel| Response::new(response(channel), motions[usize::from(channel)], signal()))
            .collect();
        let struck = Channel::transverse(["1", "0"][usize::from(number == 3)]);
        if let Ok(hit) = Hit::new(number.into(), interval, 0.0, struck, force, responses) {
            all.push(hit);
        }
    }
    estimated(&all, &options);
}

/// Powers of ten from 1e-160 to 1e159.
fn power(byte: u8) -> f64 {
    10f64.powf((f64::from(byte) - 128.0) * 1.25)
}

fn estimated(hits: &[Hit], options: &EstimateOptions) {
    let Ok(estimate) = Estimate::of(hits, options) else { return };
    finite(&estimate.frfs);
    estimate.usable().iter().for_each(finite);
    assert!(estimate.excitations.iter().all(|excitation| excitation.usable_to.is_finite()));
}

fn finite(frfs: &FrfSet) {
    assert!(frfs.all_values().iter().all(|value| value.is_finite()));
    for index in 0..frfs.pairs().len() {
        assert!(frfs.variance(index).into_iter().flatten().all(|v| v.is_finite() && *v >= 0.0));
        assert!(frfs.coherence(index).into_iter().flatten().all(|g| (0.0..=1.0 + 1e-9).contains(g)));
    }
}

/// `stiffness.json`, or `{"diagnosis": …, "repaired": …}`: what `compare` and `export` make of it has no
/// number that is none.
pub fn answers(bytes: &[u8]) {
    let Ok(value) = serde_json::from_slice::<Value>(bytes) else { return };
    let options = ExportOptions { by_line: true, anyway: true, ..ExportOptions::default() };
    if let Some(repaired) = value.get("repaired") {
        let Ok(fixture) = Fixture::from_value(repaired) else { return };
        if let Ok(found) = export::of_diagnosis(&value["diagnosis"], &fixture, &options) {
            exported(&found, bytes);
        }
        return;
    }
    let Ok(joints) = Decomposed::all("a", &value) else { return };
    if let Ok(found) = export::of_decompositions(&joints, &options) {
        exported(&found, bytes);
    }
    let renamed = |joint: &Decomposed| Decomposed { name: format!("b{}", joint.name), ..joint.clone() };
    let both: Vec<Decomposed> = joints.iter().cloned().chain(joints.iter().map(renamed)).collect();
    for independent in [false, true] {
        let options = ComparisonOptions { independent, specimens: vec![("ab".to_owned(), vec![0, 1])] };
        if let Ok(comparison) = Comparison::with(both.clone(), &options) {
            comparison.summary();
        }
    }
}

fn exported(found: &export::Export, input: &[u8]) {
    let says_so =
        |text: &str| text.split(|c: char| !c.is_alphanumeric()).any(|word| ["NaN", "inf"].contains(&word));
    export::json(found);
    for program in [Program::Nastran, Program::Ansys, Program::Abaqus, Program::Calculix, Program::Csv] {
        if let Ok(text) = export::write(found, program, None, &[]) {
            assert!(!says_so(&text) || says_so(&String::from_utf8_lossy(input)), "{program}: {text}");
        }
    }
}
