//! Writes the shipped example of a plan, `fixture.json`, `first-test.uff` and `second-test.uff`, into the
//! directory given, or into `fixtures/look-alikes` of the workspace.
//!
//! The first test is so small that its diagnosis leaves the name open; the second holds the one FRF that the
//! plan suggests. Whoever wants to try it should not read on: [`hidden`] gives the answer away.

use jointscope_fixture::{Dof, Effect, EffectKind, Fixture, Place};
use jointscope_rig::universal_file::{Precision, to_bytes};
use jointscope_rig::{HammerSetup, Instrument, drawn_within_tolerance, frfs, generator};
use jointscope_spectra::{FrfPair, SpectralLines};
use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

/// Seed of the true quantities, of the hits and of the noise.
const SEED: u64 = 18;
/// What the analyst believes: the blocks of another example.
const BELIEVED: &str = include_str!("../../../fixtures/two-blocks/fixture.json");
/// FRFs of the first test, and of the second.
const TESTS: [(&str, &[(&str, &str)]); 2] =
    [("first-test.uff", &[("4", "1"), ("3", "2")]), ("second-test.uff", &[("3", "3")])];

/// What the fixture leaves out.
fn hidden() -> Effect {
    let place = Place::Point("3".into());
    Effect::new(EffectKind::InterfaceCompliance, place, Some(Dof::Rotation), &[3.0e4, 0.05])
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = match env::args_os().nth(1) {
        Some(folder) => PathBuf::from(folder),
        None => PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/look-alikes"),
    };
    let believed = Fixture::from_json(BELIEVED)?;
    let truth = drawn_within_tolerance(&believed, &mut generator(SEED))?.with_physics(vec![hidden()])?;
    let lines = SpectralLines::even(5.0, 5.0, 200)?;
    fs::create_dir_all(&folder)?;
    fs::write(folder.join("fixture.json"), BELIEVED)?;
    for (round, (name, pairs)) in TESTS.into_iter().enumerate() {
        let pairs: Vec<FrfPair> = pairs.iter().map(|(o, i)| FrfPair::transverse(o, i)).collect();
        let hammer = HammerSetup {
            averages: 8,
            noise_response: 0.01,
            noise_force: 0.001,
            corner: 1000.0,
            spread: 0.25,
            common_hits: false,
            seed: SEED + round as u64,
        };
        let recording = hammer.measure(&frfs(&truth, &pairs, &lines, Instrument::AsDescribed)?)?;
        let bytes = to_bytes("two blocks, hammer test", &recording, Precision::Single)?;
        fs::write(folder.join(name), &bytes)?;
        println!("{} ({} bytes)", folder.join(name).display(), bytes.len());
    }
    Ok(())
}
