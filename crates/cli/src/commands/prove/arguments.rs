//! The arguments of `jointscope prove`.

use std::path::PathBuf;

use clap::Args;
use jointscope::Band;
use jointscope::proof::FAMILIES;
use jointscope::proof::concealed::ConcealmentKind;
use jointscope::recordings::{AssumedUnits, HeldAmplitude};

use crate::recording::map_entry;
use crate::values::band;

/// Options of `jointscope prove`.
#[derive(Debug, Args)]
pub(crate) struct ProveArguments {
    /// Make so many new cases [default: the shipped cases; 40 where only a seed is given; 8 of real
    /// recordings].
    #[arg(long, value_name = "N")]
    pub cases: Option<usize>,
    /// Seed of new cases [default: 1].
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,
    /// Make so many further cases of one effect so small that it may be missed, for the detection curve.
    #[arg(long, value_name = "N")]
    pub graded: Option<usize>,
    /// Make so many cases whose recording comes from a solid [default: a twentieth of --cases; none of these
    /// with --family].
    #[arg(long, value_name = "N")]
    pub solid: Option<usize>,
    /// Make so many cases of hits over time [default: as --solid].
    #[arg(long, value_name = "N")]
    pub struck: Option<usize>,
    /// Make so many cases whose recording comes from a solid with nothing idealised, so that no fixture is
    /// right to the noise [default: as --solid].
    #[arg(long, value_name = "N")]
    pub solid_as_is: Option<usize>,
    /// Make so many cases of lumped structures with an error in every mode [default: as --solid].
    #[arg(long, value_name = "N")]
    pub modal_errors: Option<usize>,
    /// Make so many lumped cases of which the one hidden thing is a flaw of the measuring chain [default:
    /// as --solid].
    #[arg(long, value_name = "N")]
    pub channel_flaws: Option<usize>,
    /// Make so many lumped cases with a load path beside a joint or to ground, or footings that turn
    /// [default: as --solid].
    #[arg(long, value_name = "N")]
    pub load_paths: Option<usize>,
    /// Make so many lumped cases of physics that no effect of a fixture file is, small and large [default:
    /// as --solid].
    #[arg(long, value_name = "N")]
    pub unknown_physics: Option<usize>,
    /// A text, such as the current commit's hash, from which a quarter of the cases is drawn afresh.
    #[arg(long, value_name = "TEXT")]
    pub also_from: Option<String>,
    /// Take the one case of this number.
    #[arg(long, value_name = "INDEX")]
    pub only: Option<usize>,
    /// The folder of the shipped cases [default: fixtures/concealed around the current folder or the
    /// program].
    #[arg(long, value_name = "DIR")]
    pub shipped: Option<PathBuf>,
    /// Assemblies to draw from [default: all but beam-and-block].
    #[arg(long, value_name = "NAME", num_args = 1.., value_parser = FAMILIES.map(|(name, _)| name))]
    pub family: Vec<String>,
    /// Tell every case that went wrong: what was hidden, what was found, and the objectives.
    #[arg(long)]
    pub wrong: bool,
    /// Cases diagnosed at a time, one core each [default: the number of cores].
    #[arg(long, value_name = "T")]
    pub threads: Option<usize>,
    /// Print the scores as JSON.
    #[arg(long)]
    pub json: bool,
    /// A directory for report.html, seal.json, answers.json, baselines.json, proof.json and timing.json, and
    /// cases/NNN with the files and the page of every case.
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub real: RealRecordings,
    /// Write no cases/NNN.
    #[arg(long)]
    pub no_case_pages: bool,
    /// Instead: make cases until the diagnosis leaves the name of so many open, carry out what `plan`
    /// suggests first, and count how often that keeps what it promises.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000),
        conflicts_with_all = ["cases", "graded", "solid", "struck", "solid_as_is", "modal_errors", "channel_flaws", "load_paths", "unknown_physics", "also_from", "only", "shipped", "family", "limits", "recordings"])]
    pub plan: Option<u32>,
    /// Instead: the effects that this recording cannot tell apart, and the smallest that show in it.
    #[arg(long, num_args = 2, value_names = ["FIXTURE", "RECORDING"],
        conflicts_with_all = ["cases", "seed", "graded", "solid", "struck", "solid_as_is", "modal_errors", "channel_flaws", "load_paths", "unknown_physics", "also_from", "only", "shipped", "family", "wrong", "output"])]
    pub limits: Vec<PathBuf>,
}

impl ProveArguments {
    /// Whether cases of a route beside the laboratory's are asked for.
    pub(crate) fn asks_for_routes(&self) -> bool {
        let lumped = [self.channel_flaws, self.load_paths, self.unknown_physics];
        let others = [self.solid, self.struck, self.solid_as_is, self.modal_errors];
        others.iter().chain(&lumped).any(Option::is_some)
    }

    /// Cases at a time.
    pub(crate) fn workers(&self) -> usize {
        let cores = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        self.threads.unwrap_or_else(cores).max(1)
    }
}

/// Options of `jointscope prove --recordings`.
#[derive(Debug, Args)]
#[command(next_help_heading = "On real recordings")]
pub(crate) struct RealRecordings {
    /// A directory with real recordings (FRFs) and the fixture.json that goes with them: conceal something
    /// there.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["also_from", "shipped", "family", "wrong", "graded", "no_case_pages"])]
    pub recordings: Option<PathBuf>,
    /// What to conceal [default: whatever fixture and recording have room for, in turn].
    #[arg(long, value_name = "KIND", num_args = 1.., value_parser = ConcealmentKind::ALL.map(ConcealmentKind::name), requires = "recordings")]
    pub conceal: Vec<String>,
    /// Diagnoses at the most that make the fixture explain the recording, each of what the one before
    /// repaired.
    #[arg(long, value_name = "N", default_value_t = 1, requires = "recordings")]
    pub rounds: usize,
    /// The level to use, where the recordings were made at several, such as "response 5 m/s^2".
    #[arg(long, value_name = "AMPLITUDE", value_parser = level, requires = "recordings")]
    pub level: Option<HeldAmplitude>,
    /// The band to use, in Hz [default: all lines].
    #[arg(long, value_name = "F1:F2", value_parser = band, requires = "recordings")]
    pub band: Option<Band>,
    /// Which channel of the files is which of the fixture: +z=+y for all nodes, 101:+z=1:+y for one.
    #[arg(long, value_name = "[NODE:]DIR=[POINT:]DIR", value_parser = map_entry, num_args = 1.., requires = "recordings")]
    pub map: Vec<String>,
    /// Units of response and force where a file states none, such as g,lbf.
    #[arg(long, value_name = "RESPONSE,FORCE", value_parser = AssumedUnits::parse, requires = "recordings")]
    pub assume_units: Option<AssumedUnits>,
}

fn level(text: &str) -> Result<HeldAmplitude, String> {
    let form = "an amplitude that was held is needed, such as \"response 5 m/s^2\" or \"force 0.5 N\"";
    HeldAmplitude::parse(text).ok_or_else(|| form.to_owned())
}
