//! The concealed cases that come with the sources: `fixtures/concealed`.

use std::path::{Path, PathBuf};

use crate::refusal::Refusal;

/// Where they lie in a checkout.
pub(super) const FOLDER: &str = "fixtures/concealed";

/// Number of cases of the laboratory's FRFs, of solids and of hits over time, numbered in this order.
pub(super) const COUNTS: [usize; 3] = [20, 4, 3];

/// SHA-256 of the sealed truths, published with the cases.
pub(super) const TRUTHS_SHA256: &str = "4cc62f599c45ade5ee8ff96fa921908aefe74c712a168fb6407f6ccd540a23cc";

/// Options that make the same cases anew, recordings in double precision.
const ANEW: &str = "--cases 16 --graded 4 --solid 4 --struck 3 --seed 1 --family two-blocks";

/// The folder of the cases: the one that is named, or that of the checkout around the current folder or the
/// program.
pub(super) fn folder(named: Option<&Path>) -> Result<PathBuf, Refusal> {
    if let Some(named) = named {
        return Ok(named.to_owned());
    }
    let around = [std::env::current_dir().ok(), std::env::current_exe().ok()];
    let mut checkouts = around.iter().flatten().flat_map(|path| path.ancestors());
    let found = checkouts.find(|checkout| checkout.join(FOLDER).join("truths.json").is_file());
    found.map(|checkout| checkout.join(FOLDER)).ok_or_else(|| {
        Refusal::new(format_args!(
            "{FOLDER} is not here; run this in a checkout of the sources, name the folder with `--shipped DIR`, or make the same cases \
             anew with `{ANEW}`"
        ))
    })
}
