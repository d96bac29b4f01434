//! Writes the shipped example of a diagnosis, `fixture.json` and `hammer-test.uff`, into the directory given,
//! or into `fixtures/two-blocks` of the workspace.
//!
//! Whoever wants to try the diagnosis should not read on: [`hidden`] gives the answer away.

use jointscope_fixture::{Dof, Effect, EffectKind, Fixture, Place};
use jointscope_rig::universal_file::{Precision, to_bytes};
use jointscope_rig::{HammerSetup, Instrument, drawn_within_tolerance, frfs, generator};
use jointscope_spectra::{FrfPair, SpectralLines};
use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

/// Seed of the true quantities, of the hits and of the noise.
const SEED: u64 = 20_240_917;

/// What the analyst believes.
const BELIEVED: &str = r#"{
  "name": "two steel blocks and a strip",
  "bodies": {
    "A": {
      "mass": { "value": 1.1020, "std": 0.0011 },
      "inertia": { "value": 5.90e-4, "std": 3.0e-6 },
      "x_cg": { "value": -0.031, "std": 0.0001 }
    },
    "B": {
      "mass": { "value": 1.4850, "std": 0.0015 },
      "inertia": { "value": 1.020e-3, "std": 5.0e-6 },
      "x_cg": { "value": 0.104, "std": 0.0001 }
    }
  },
  "points": {
    "1": { "body": "A", "x": { "value": -0.056, "std": 0.0001 } },
    "2": { "body": "A", "x": { "value": 0.0, "std": 0.0001 } },
    "3": { "body": "B", "x": { "value": 0.070, "std": 0.0001 } },
    "4": { "body": "B", "x": { "value": 0.131, "std": 0.0001 } }
  },
  "joints": {
    "J": {
      "from": "2",
      "to": "3",
      "beam": {
        "youngs_modulus": { "value": 2.07e11, "std": 1.0e9 },
        "second_moment": { "value": 3.40e-10, "std": 2.0e-12 }
      }
    }
  },
  "damping": {
    "modal_ratios": [ { "value": 0.004, "std": 0.001 }, { "value": 0.005, "std": 0.001 } ]
  }
}
"#;

/// What the fixture leaves out.
fn hidden() -> Effect {
    let place = Place::Point("2".into());
    Effect::new(EffectKind::InterfaceCompliance, place, Some(Dof::Rotation), &[9.0e3, 0.05])
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = match env::args_os().nth(1) {
        Some(folder) => PathBuf::from(folder),
        None => PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/two-blocks"),
    };
    let believed = Fixture::from_json(BELIEVED)?;
    let truth = drawn_within_tolerance(&believed, &mut generator(SEED))?.with_physics(vec![hidden()])?;
    let pairs = [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")].map(|(o, i)| FrfPair::transverse(o, i));
    let lines = SpectralLines::even(5.0, 5.0, 200)?;
    let hammer = HammerSetup {
        averages: 8,
        noise_response: 0.005,
        noise_force: 0.001,
        corner: 1000.0,
        spread: 0.25,
        common_hits: false,
        seed: SEED,
    };
    let recording = hammer.measure(&frfs(&truth, &pairs, &lines, Instrument::AsDescribed)?)?;
    fs::create_dir_all(&folder)?;
    let bytes = to_bytes("two blocks, hammer test", &recording, Precision::Single)?;
    for (name, bytes) in [("fixture.json", BELIEVED.as_bytes().to_vec()), ("hammer-test.uff", bytes)] {
        fs::write(folder.join(name), &bytes)?;
        println!("{} ({} bytes)", folder.join(name).display(), bytes.len());
    }
    Ok(())
}
