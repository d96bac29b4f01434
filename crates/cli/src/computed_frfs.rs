//! FRFs computed from a fixture: which, on which lines, and where to write them.

use std::path::PathBuf;

use clap::Args;
use jointscope::fixture::Fixture;
use jointscope::recordings::to_datasets;
use jointscope::spectra::{FrfPair, FrfSet, SpectralLines, in_text};
use jointscope::uff::Encoding;

use crate::input::FixtureFile;
use crate::output::Outputs;
use crate::refusal::Refusal;
use crate::values::{frf_pair, spectral_lines};

/// Options of every command that computes FRFs.
#[derive(Debug, Args)]
pub(crate) struct ComputedFrfs {
    /// The fixture file (JSON).
    pub fixture: PathBuf,
    /// FRFs to compute, response over reference, such as 4/1 or 4:theta/1 [default: 4/1 3/1 4/2 3/2].
    #[arg(long, value_name = "OUT/IN", value_parser = frf_pair, num_args = 1..)]
    pub frf: Vec<FrfPair>,
    /// Spectral lines in Hz: first, last and step.
    #[arg(long, value_name = "FROM:TO:STEP", value_parser = spectral_lines, default_value = "2.5:1000:2.5")]
    pub lines: SpectralLines,
    /// Write text (dataset 58) instead of binary (58b).
    #[arg(long)]
    pub ascii: bool,
    /// The universal file to write.
    #[arg(short, long, value_name = "F.uff")]
    pub output: PathBuf,
}

impl ComputedFrfs {
    /// The FRFs to compute.
    pub(crate) fn pairs(&self, fixture: &FixtureFile) -> Result<Vec<FrfPair>, Refusal> {
        match self.frf.as_slice() {
            [] => default_pairs(fixture).map_err(|error| fixture.refusal(error)),
            named => named.iter().map(|pair| known(pair, fixture)).collect(),
        }
    }

    /// The universal file, to be written; ID line 2 says `how` the FRFs were made.
    pub(crate) fn outputs(
        &self,
        fixture: &FixtureFile,
        frfs: &FrfSet,
        how: Option<&str>,
    ) -> Result<Outputs, Refusal> {
        let mut datasets = to_datasets(frfs, fixture.name(), encoding(self.ascii))
            .map_err(|error| fixture.refusal(error))?;
        if let Some(how) = how {
            datasets.iter_mut().for_each(|dataset| how.clone_into(&mut dataset.id_lines[1]));
        }
        let mut outputs = Outputs::new([&self.fixture]);
        outputs.add_datasets(&self.output, &datasets)?;
        Ok(outputs)
    }

    /// What was written: file, names, lines.
    pub(crate) fn written(&self, frfs: &FrfSet) -> String {
        let names: Vec<String> = frfs.pairs().iter().map(FrfPair::to_string).collect();
        let hz = frfs.lines().hz();
        format!(
            "{}: FRFs {} on {} lines, {} to {} Hz",
            self.output.display(),
            names.join(", "),
            hz.len(),
            in_text(hz[0]),
            in_text(hz[hz.len() - 1])
        )
    }
}

/// An FRF between points of the fixture: a mesh that took its time is no place to find out that it is not.
fn known(pair: &FrfPair, fixture: &FixtureFile) -> Result<FrfPair, Refusal> {
    let mut points = [&pair.response, &pair.reference].into_iter().map(|channel| &channel.point);
    let Some(point) = points.find(|point| fixture.point(point).is_none()) else { return Ok(pair.clone()) };
    let names: Vec<&str> = fixture.points().iter().map(|point| point.name.as_str()).collect();
    let names = names.join(", ");
    Err(fixture.refusal(format_args!("FRF {pair}: the fixture has no point `{point}` (it has {names})")))
}

/// The encoding that `--ascii` asks for.
pub(crate) fn encoding(ascii: bool) -> Encoding {
    if ascii { Encoding::Ascii } else { Encoding::default() }
}

/// The paper's four FRFs, across the joint between points 2 and 3.
const DEFAULT_PAIRS: [(&str, &str); 4] = [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")];

/// The FRFs computed where none are named.
fn default_pairs(fixture: &Fixture) -> Result<Vec<FrfPair>, String> {
    if ["1", "2", "3", "4"].iter().all(|point| fixture.point(point).is_some()) {
        return Ok(DEFAULT_PAIRS
            .iter()
            .map(|(response, reference)| FrfPair::transverse(response, reference))
            .collect());
    }
    let names: Vec<&str> = fixture.points().iter().map(|point| point.name.as_str()).collect();
    let (Some(first), Some(last)) = (names.first(), names.last()) else {
        return Err("the fixture has no points, so there is no FRF to compute".to_owned());
    };
    Err(format!(
        "the default FRFs 4/1, 3/1, 4/2, 3/2 need points 1 to 4, and the fixture has {}; choose FRFs with `--frf`, such as `--frf {last}/{first}`",
        names.join(", ")
    ))
}
