//! `jointscope check`: a fixture in, and recordings if there are any; what they are like and what is odd out.

use std::path::PathBuf;

use clap::Args;
use jointscope::check::{Check, CheckOptions, Figure, Weight};
use jointscope::report::check_report;
use jointscope::report::format::{quantity, with_sign};
use jointscope::spectra::in_sentence;
use jointscope::{check_file, checked_frfs};
use serde_json::Value;

use crate::answered::{Also, Answered, Destination, PAGE};
use crate::estimation_arguments::EstimationArguments;
use crate::input::FixtureFile;
use crate::origin;
use crate::output::{counted, pretty};
use crate::recording::{ReadingArguments, RecordingArguments};
use crate::refusal::Refusal;

#[derive(Debug, Args)]
pub(super) struct CheckArguments {
    /// The fixture file (JSON).
    pub fixture: PathBuf,
    /// Recordings of it, if there are any (UFF, UNV, CSV, MAT): all files of one test, in any order.
    #[arg(value_name = "F.uff")]
    pub files: Vec<PathBuf>,
    #[command(flatten)]
    pub reading: ReadingArguments,
    /// Print check.json to standard output, for scripts.
    #[arg(long)]
    pub json: bool,
    /// Also write tables and curves of the page (csv), its figures (svg), or FRFs as recorded and as the
    /// fixture has them (uff).
    #[arg(long, value_name = "KIND", value_enum, value_delimiter = ',', requires = "output")]
    pub also: Vec<Also>,
    /// The directory to write check.json and report.html to [default: nothing is written].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub estimation: EstimationArguments,
}

/// Checks, writes `check.json` and `report.html` if a directory is given, and answers with what is odd and
/// the figures that matter.
pub(super) fn run(arguments: &CheckArguments) -> Result<String, Refusal> {
    let fixture = FixtureFile::read(&arguments.fixture)?;
    let recording = RecordingArguments { files: arguments.files.clone(), reading: arguments.reading.clone() };
    let measurement = match arguments.files.is_empty() {
        true => None,
        false => Some(recording.measurement(&fixture)?),
    };
    let files = || std::iter::once(&arguments.fixture).chain(&arguments.files);
    let destination =
        Destination { json: arguments.json, also: arguments.also.clone(), output: arguments.output.clone() };
    if arguments.files.is_empty() && arguments.also.contains(&Also::Uff) {
        return Err(Refusal::new(
            "`--also uff` writes the FRFs of a recording and the fixture's beside them, and no recording is given; `synthesize` writes the fixture's",
        ));
    }
    destination.foresee(files(), &[FILE, PAGE])?;
    let options = CheckOptions { estimate: arguments.estimation.for_models() };
    let check = Check::of(&fixture, measurement.as_ref(), &options)
        .map_err(|error| recording.unanswered(&error, &fixture))?;
    let context = origin::context(files(), Vec::new(), None)?;
    let mut file: Value = check_file(&check);
    origin::add(&mut file, &context);
    let notes = check.recording.iter().flat_map(|recording| recording.notes.clone()).collect::<Vec<_>>();
    if check.recording.is_some() {
        file["notes"] = notes.clone().into();
    }
    let frfs = match check.recording.as_ref().filter(|_| arguments.also.contains(&Also::Uff)) {
        Some(recording) => checked_frfs(recording).map_err(Refusal::new)?,
        None => Vec::new(),
    };
    let answered = Answered {
        notes,
        answer: (FILE, pretty(&file)),
        others: Vec::new(),
        elsewhere: Vec::new(),
        report: check_report(&check, &fixture, &context),
        frfs,
        summary: summary(&check),
    };
    answered.end(&destination, files())
}

const FILE: &str = "check.json";

/// What it comes to, a line each.
fn summary(check: &Check) -> Vec<String> {
    let figure = |figure: &Figure| quantity(figure.value, figure.std, figure.unit);
    let mut lines = vec![format!("{}.", check.headline())];
    lines.extend(check.remarks.iter().map(|remark| {
        let sign = if remark.weight == Weight::Wrong { "✕" } else { "!" };
        format!("  {sign} {}: {}", remark.place, remark.says)
    }));
    let totals = &check.totals;
    let mut weighs = format!("total mass {}", figure(&totals.mass));
    if let Some(x_cg) = &totals.x_cg {
        weighs += &format!(", centre of gravity at x = {}", figure(x_cg));
    }
    if let Some(inertia) = &totals.inertia {
        weighs += &format!(", inertia about it {}", figure(inertia));
    }
    lines.push(weighs);
    if let Some(modes) = &check.modes {
        lines.push(format!(
            "{} at 0 Hz, and up to {} Hz:",
            counted(modes.rigid, "rigid-body mode"),
            in_sentence(modes.to)
        ));
        lines.extend(modes.modes.iter().map(|mode| {
            let on_supports = if mode.on_supports { ", as rigid on its supports" } else { "" };
            let ratio = 100.0 * mode.damping_ratio;
            format!("  {}, damping ratio {ratio:.3} %{on_supports}", figure(&mode.frequency))
        }));
        lines.extend(modes.nearness().map(|nearness| format!("  {nearness}")));
    }
    if let Some(recording) = &check.recording {
        lines.extend(of_recording(recording));
    } else {
        lines.push(format!(
            "{} read; -o DIR writes what each of them means, and a page",
            counted(check.numbers.len(), "number")
        ));
    }
    lines
}

/// Modes that are listed at the most.
const LISTED: usize = 8;

/// The recording beside the fixture, a line each.
fn of_recording(recording: &jointscope::check::RecordingCheck) -> Vec<String> {
    let percent =
        |share: Option<f64>| share.map_or("–".to_owned(), |share| format!("{:.1} %", 100.0 * share));
    // To a tenth of a millihertz: lines carry rounding of their own.
    let rounded = |hz: f64| (1e4 * hz).round() / 1e4;
    let (from, to, count) = recording.lines;
    let (from, to) = (rounded(from), rounded(to));
    let mut lines = vec![format!(
        "{} on {count} lines from {from} to {to} Hz; distance from the fixture's as it stands (nrmse) {}:",
        counted(recording.frfs.len(), "FRF"),
        percent(recording.nrmse)
    )];
    lines.extend(recording.frfs.iter().map(|frf| {
        let averages =
            frf.averages.map_or(String::new(), |n| format!(", {}", counted(n as usize, "average")));
        let coherence = frf.coherence.map_or(String::new(), |c| format!(", coherence {:.3}", c.median));
        format!(
            "  {}: nrmse {}, noise {:.2} %{averages}{coherence}",
            frf.frf,
            percent(frf.nrmse),
            100.0 * frf.noise
        )
    }));
    if let Some(modes) = &recording.modes {
        let shown = modes.modes.iter().map(|mode| match mode.fixture {
            Some(fixture) => {
                let change = 100.0 * (mode.frequency / fixture - 1.0);
                let moving = if mode.on_supports { ", as rigid on its supports" } else { "" };
                format!("{} Hz ({} %{moving})", in_sentence(mode.frequency), with_sign(change, 1))
            }
            None => format!("{} Hz (none of the fixture's)", in_sentence(mode.frequency)),
        });
        let mut shown: Vec<String> = shown.collect();
        if shown.len() > LISTED {
            let more = shown.split_off(LISTED).len();
            shown.push(format!("and {more} more"));
        }
        lines.push(format!("modes of the recording, beside the fixture's: {}", shown.join(", ")));
    }
    match (&recording.mass_line, &recording.no_mass_line) {
        (Some(line), _) => {
            let total = line.mass.map_or("does not tell the total mass".to_owned(), |mass| {
                format!("weighs {}", quantity(mass.value, mass.std, mass.unit))
            });
            lines.push(format!(
                "from {} to {} Hz the recording {total}",
                in_sentence(line.band.0),
                in_sentence(line.band.1)
            ));
        }
        (None, Some(why)) => lines.push(format!("mass line not judged: {why}")),
        (None, None) => {}
    }
    if !recording.without_recording.is_empty() {
        lines.push(format!("nothing was recorded at points {}", recording.without_recording.join(", ")));
    }
    lines
}
