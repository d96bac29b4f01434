//! Writes the shipped example, a simulated hammer test of a glued joint: `fixture.json`, `hammer-test.uff`
//! and `README.md`, into the directory given, or into `fixtures/glued-joint` of the workspace.

use jointscope_rig::glued_joint::{GluedJoint, SEED};
use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = match env::args_os().nth(1) {
        Some(folder) => PathBuf::from(folder),
        None => PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/glued-joint"),
    };
    let files = GluedJoint::new(SEED)?.files()?;
    fs::create_dir_all(&folder)?;
    for (name, bytes) in files {
        fs::write(folder.join(name), &bytes)?;
        println!("{} ({} bytes)", folder.join(name).display(), bytes.len());
    }
    Ok(())
}
