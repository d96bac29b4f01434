//! `jointscope prove`: concealed cases made, diagnosed, and only then opened and scored.

use std::io::{IsTerminal, Write};
use std::path::PathBuf;

use clap::Args;
use clap::builder::ArgPredicate;
use indicatif::{ProgressBar, ProgressStyle};
use jointscope_proof::{Answers, FAMILIES, Judged, Plan, Score, Timing};
use serde_json::{Value, json};

use crate::output::Outputs;
use crate::prove_recordings::{self, RealRecordings};
use crate::refusal::Refusal;

/// Options of `jointscope prove`.
#[derive(Debug, Args)]
pub struct ProveArguments {
    /// Number of cases [default: 40, of real recordings 8].
    #[arg(
        long,
        value_name = "N",
        default_value_t = 40,
        default_value_if("recordings", ArgPredicate::IsPresent, "8"),
        hide_default_value = true
    )]
    pub cases: usize,
    /// Seed of the cases.
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub seed: u64,
    /// A text, such as the current commit's hash, from which a quarter of the cases is drawn afresh.
    #[arg(long, value_name = "TEXT")]
    pub also_from: Option<String>,
    /// Make the one case of this number.
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
    /// A directory for seal.json, answers.json, proof.json and timing.json.
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub real: RealRecordings,
}

/// Makes the cases, has them all diagnosed, opens the truths and scores; answers with the table.
pub fn run(arguments: &ProveArguments) -> Result<String, Refusal> {
    if let Some(directory) = &arguments.real.recordings {
        return prove_recordings::run(directory, arguments);
    }
    let named = |(name, family): (&str, _)| arguments.family.iter().any(|f| f == name).then_some(family);
    let families: Vec<_> = FAMILIES.into_iter().filter_map(named).collect();
    let standard = Plan::default();
    let plan = Plan {
        cases: arguments.cases,
        seed: arguments.seed,
        fresh_from: arguments.also_from.clone(),
        only: arguments.only,
        families: if families.is_empty() { standard.families } else { families },
    };
    let (cases, truths) = plan.draw().map_err(Refusal::new)?;
    let digest = truths.digest().to_owned();
    tell(&format!("truths sealed, SHA-256 {digest}"));
    if let Some(directory) = &arguments.output {
        // A directory that cannot be written to is found out before the work, not after it.
        let seal = json!({ "plan": plan.to_value(), "sealed_truths_sha256": digest });
        write(directory.join("seal.json"), &seal)?;
    }
    let threads = workers(arguments);
    let bar = progress(cases.len(), "diagnosed");
    let answers = Answers::to(&cases, threads, |done| bar.set_position(done as u64));
    bar.finish_and_clear();
    if let Some(directory) = &arguments.output {
        // On disk before the truths are opened.
        write(directory.join("answers.json"), &answers.to_value())?;
    }
    let truths = truths.open(&answers).ok_or_else(|| Refusal::new("answers are missing"))?;
    let bar = progress(cases.len(), "judged");
    let judged = Judged::all(&cases, truths, &answers, threads, |done| bar.set_position(done as u64));
    bar.finish_and_clear();
    let timing = Timing::of(answers.seconds());
    tell(&timing.to_string());
    let score = Score::of(&judged);
    let mut value = score.to_value();
    value["plan"] = plan.to_value();
    value["sealed_truths_sha256"] = digest.clone().into();
    value["cases"] = judged.iter().map(Judged::to_value).collect();
    if let Some(directory) = &arguments.output {
        let mut outputs = Outputs::default();
        outputs.add(directory.join("proof.json"), pretty(&value));
        outputs.add(directory.join("timing.json"), pretty(&timing.to_value()));
        outputs.write()?;
    }
    if arguments.json {
        return Ok(pretty(&value).trim_end().to_owned());
    }
    let mut text = format!("{plan}\ntruths sealed before the first answer, SHA-256 {digest}\n\n{score}");
    if arguments.wrong || arguments.only.is_some() {
        let told = judged.iter().filter(|judged| arguments.only.is_some() || !judged.faults().is_empty());
        for judged in told {
            text.push('\n');
            text.push_str(&judged.account());
        }
    }
    Ok(text.trim_end().to_owned())
}

/// Cases at a time.
pub fn workers(arguments: &ProveArguments) -> usize {
    let cores = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    arguments.threads.unwrap_or_else(cores).max(1)
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
    let template = "{bar:30} {pos} of {len} cases {msg}, {elapsed}, {eta} to go";
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(cases as u64).with_style(style).with_message(what)
}
