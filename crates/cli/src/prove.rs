//! `jointscope prove`: concealed cases made, diagnosed, and only then opened and scored.

mod cases;
mod pages;
mod shipped;

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use jointscope_proof::{
    Baseline, CaseLine, FAMILIES, Judged, Limits, Methods, Opened, Replies, RouteScores, Score, SolidJudged,
    StruckJudged, Timing,
};
use jointscope_report::{ProofContext, ProofResults, proof_page};
use serde_json::{Value, json};

use crate::input;
use crate::output::Outputs;
use crate::prove_recordings::{self, RealRecordings};
use crate::refusal::Refusal;
use cases::Concealed;
use pages::CasePages;

/// Options of `jointscope prove`.
#[derive(Debug, Args)]
pub struct ProveArguments {
    /// Make so many new cases [default: the cases that the program carries; 40 where only a seed is given; 8 of real recordings].
    #[arg(long, value_name = "N")]
    pub cases: Option<usize>,
    /// Seed of new cases [default: 1].
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,
    /// Make so many further cases of one effect so small that it may be missed, for the detection curve.
    #[arg(long, value_name = "N")]
    pub graded: Option<usize>,
    /// Make so many cases whose recording comes from a solid [default: a twentieth of --cases; none of these with --family].
    #[arg(long, value_name = "N")]
    pub solid: Option<usize>,
    /// Make so many cases of hits over time [default: as --solid].
    #[arg(long, value_name = "N")]
    pub struck: Option<usize>,
    /// A text, such as the current commit's hash, from which a quarter of the cases is drawn afresh.
    #[arg(long, value_name = "TEXT")]
    pub also_from: Option<String>,
    /// Take the one case of this number.
    #[arg(long, value_name = "INDEX")]
    pub only: Option<usize>,
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
    /// A directory for report.html, seal.json, answers.json, baselines.json, proof.json and timing.json, and cases/NNN with the files and
    /// the page of every case.
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub real: RealRecordings,
    /// Write no cases/NNN.
    #[arg(long)]
    pub no_case_pages: bool,
    /// Instead: the effects that this recording cannot tell apart, and the smallest that show in it.
    #[arg(long, num_args = 2, value_names = ["FIXTURE", "RECORDING"],
        conflicts_with_all = ["cases", "seed", "graded", "solid", "struck", "also_from", "only", "family", "wrong", "output"])]
    pub limits: Vec<PathBuf>,
}

/// Has all cases diagnosed, opens the truths and scores; answers with the table.
pub fn run(arguments: &ProveArguments) -> Result<String, Refusal> {
    if let Some(directory) = &arguments.real.recordings {
        return prove_recordings::run(directory, arguments);
    }
    if let [fixture, recording] = arguments.limits.as_slice() {
        return limits(fixture, recording, arguments.json);
    }
    let mut concealed = Concealed::of(arguments)?;
    let digest = concealed.truths.digest().to_owned();
    tell(&format!("truths sealed, SHA-256 {digest}"));
    if let Some(directory) = &arguments.output {
        // A directory that cannot be written to is found out before the work, not after it.
        let seal = json!({ "plan": concealed.plan, "sealed_truths_sha256": digest });
        write(directory.join("seal.json"), &seal)?;
    }
    let threads = workers(arguments);
    let answers = diagnosed(arguments, &concealed, threads)?;
    let baselines = {
        let bar = progress(concealed.cases.laboratory.len(), "looked up and updated");
        Baseline::all(&concealed.cases.laboratory, threads, |done| bar.set_position(done as u64))
    };
    if let Some(directory) = &arguments.output {
        // On disk before the truths are opened.
        write(directory.join("answers.json"), &answers.to_value())?;
        let value = baselines.iter().map(|b| b.as_ref().map(Baseline::to_value)).collect::<Value>();
        write(directory.join("baselines.json"), &value)?;
    }
    let truths = concealed.truths.open(&answers).ok_or_else(|| Refusal::new("answers are missing"))?;
    let truths: Opened = truths.into_iter().collect();
    let judged = {
        let bar = progress(concealed.cases.laboratory.len(), "judged");
        let told = |done: usize| bar.set_position(done as u64);
        Judged::all(&concealed.cases.laboratory, truths.laboratory, &answers.laboratory, threads, told)
    };
    let solid = {
        let bar = progress(concealed.cases.solid.len(), "judged");
        let told = |done: usize| bar.set_position(done as u64);
        SolidJudged::all(&concealed.cases.solid, truths.solid, &answers.solid, threads, told)
    };
    let routes = RouteScores::of(&solid, &StruckJudged::all(truths.struck, &answers.struck));
    let timing = Timing::of(&answers.seconds());
    tell(&timing.to_string());
    let score = Score::of(&judged);
    let believed: Vec<_> = concealed.cases.laboratory.iter().map(|case| &case.believed).collect();
    let methods = Methods::of(&judged, &believed, &baselines);
    let mut value = score.to_value();
    value["methods"] = methods.to_value();
    value["plan"] = concealed.plan.take();
    value["sealed_truths_sha256"] = digest.clone().into();
    value["cases"] = judged.iter().map(Judged::to_value).collect();
    value["routes"] = routes.to_value();
    if let Some(directory) = &arguments.output {
        let context = ProofContext {
            program: format!("jointscope {}", env!("CARGO_PKG_VERSION")),
            command: input::command_line(),
            cases: concealed.what.clone(),
            sealed: digest.clone(),
            pages: !arguments.no_case_pages,
        };
        let results = ProofResults { score: &score, methods: &methods, judged: &judged, routes: &routes };
        let mut outputs = Outputs::default();
        outputs.add(directory.join("report.html"), proof_page(&results, &context).map_err(Refusal::new)?);
        outputs.add(directory.join("proof.json"), pretty(&value));
        outputs.add(directory.join("timing.json"), pretty(&timing.to_value()));
        outputs.write()?;
    }
    if arguments.json {
        return Ok(pretty(&value).trim_end().to_owned());
    }
    let what = &concealed.what;
    let mut text = format!("{what}\ntruths sealed before the first answer, SHA-256 {digest}\n");
    if !judged.is_empty() {
        text.push_str(&format!("\n{score}\n{methods}"));
    }
    text.push_str(&routes.to_string());
    if arguments.wrong || arguments.only.is_some() {
        let all = arguments.only.is_some();
        let told = judged.iter().filter(|judged| all || !judged.faults().is_empty()).map(Judged::account);
        let lines = routes.0.iter().flat_map(|route| &route.lines);
        let lines = lines.filter(|line| all || !line.faults.is_empty()).map(CaseLine::account);
        for account in told.chain(lines) {
            text.push('\n');
            text.push_str(&account);
        }
    }
    if let Some(directory) = &arguments.output {
        text.push_str(&format!("\n{}", directory.join("report.html").display()));
    }
    Ok(text.trim_end().to_owned())
}

/// Cases at a time.
pub fn workers(arguments: &ProveArguments) -> usize {
    let cores = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    arguments.threads.unwrap_or_else(cores).max(1)
}

/// All cases diagnosed, and a page written of each where a directory was given.
fn diagnosed(arguments: &ProveArguments, concealed: &Concealed, threads: usize) -> Result<Replies, Refusal> {
    let bar = progress(concealed.numbers.len(), "diagnosed");
    let directory = arguments.output.as_ref().filter(|_| !arguments.no_case_pages);
    let pages = directory.map(|directory| CasePages::below(directory, concealed));
    let replies = Replies::to(
        &concealed.cases,
        threads,
        |done| bar.set_position(done as u64),
        |position, diagnosis| {
            if let Some(pages) = &pages {
                pages.write(position, diagnosis);
            }
        },
        |position, diagnosis| {
            if let Some(pages) = &pages {
                pages.write_hits(position, diagnosis);
            }
        },
    );
    pages.map_or(Ok(()), CasePages::finish)?;
    Ok(replies)
}

/// What a recording cannot tell apart or show.
fn limits(fixture: &Path, recording: &Path, json: bool) -> Result<String, Refusal> {
    let believed = input::fixture(fixture)?;
    let arguments = crate::arguments::RecordingArguments {
        files: vec![recording.to_owned()],
        map: Vec::new(),
        assume_units: None,
    };
    let read = input::recording(&arguments, &believed, fixture)?;
    let frfs = read.frfs().map_err(|error| Refusal::at(recording, error))?;
    let limits = Limits::of(&believed, frfs).ok_or_else(|| {
        Refusal::at(
            recording,
            "has no coherence with a number of averages, from which the noise could be taken",
        )
    })?;
    Ok(if json { pretty(&limits.to_value()) } else { limits.to_string() }.trim_end().to_owned())
}

/// Writes one file.
pub fn write(path: PathBuf, value: &Value) -> Result<(), Refusal> {
    let mut outputs = Outputs::default();
    outputs.add(path, pretty(value));
    outputs.write()
}

/// JSON for people.
pub fn pretty(value: &Value) -> String {
    format!("{value:#}\n")
}

/// A line for whoever watches, apart from the results.
pub fn tell(line: &str) {
    // With standard error closed nobody watches.
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// A progress bar on a terminal, nothing elsewhere.
pub fn progress(cases: usize, what: &'static str) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let template = "{bar:30} {pos} of {len} cases {msg}, {elapsed} gone, {eta} to go";
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    let finish = indicatif::ProgressFinish::AndClear;
    ProgressBar::new(cases as u64).with_style(style).with_message(what).with_finish(finish)
}
