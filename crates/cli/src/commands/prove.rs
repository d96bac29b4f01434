//! `jointscope prove`: concealed cases made, diagnosed, and only then opened and scored.

mod arguments;
mod cases;
mod pages;
mod recordings;
mod shipped;

use std::path::Path;

use jointscope::proof::{
    Baseline, CaseLine, Judged, Limits, Methods, Opened, Planning, Questions, Replies, RouteScores, Score,
    Timing, Truth,
};
use jointscope::report::{ProofContext, ProofResults, proof_page};
use serde_json::{Value, json};

use crate::input::FixtureFile;
use crate::origin;
use crate::output::{Outputs, pretty};
use crate::progress::{self, tell};
use crate::recording::RecordingArguments;
use crate::refusal::Refusal;
use cases::Concealed;
use pages::CasePages;

pub(super) use arguments::ProveArguments;

/// Has all cases diagnosed, opens the truths and scores; answers with the table.
pub(super) fn run(arguments: &ProveArguments) -> Result<String, Refusal> {
    if let Some(directory) = &arguments.real.recordings {
        return recordings::run(directory, arguments);
    }
    if let [fixture, recording] = arguments.limits.as_slice() {
        return limits(fixture, recording, arguments.json);
    }
    if let Some(wanted) = arguments.plan {
        return plans(arguments, wanted as usize);
    }
    let concealed = Concealed::of(arguments)?;
    tell(&format!("truths sealed, SHA-256 {}", concealed.truths.digest()));
    if let Some(directory) = &arguments.output {
        write_seal(directory, &concealed)?;
    }
    let answered = Answered::to(&concealed, arguments)?;
    if let Some(directory) = &arguments.output {
        // On disk before the truths are opened.
        answered.write(directory)?;
    }
    let scored = Scored::of(concealed, &answered, arguments.workers())?;
    let timing = Timing::of(&answered.answers.seconds());
    tell(&timing.to_string());
    if let Some(directory) = &arguments.output {
        write_results(directory, scored.page(arguments)?, &scored.to_value(), &timing)?;
    }
    if arguments.json {
        return Ok(pretty(&scored.to_value()).trim_end().to_owned());
    }
    Ok(scored.to_text(arguments))
}

/// What was answered to concealed cases before their truths were opened.
struct Answered {
    answers: Replies,
    baselines: Vec<Option<Baseline>>,
}

impl Answered {
    fn to(concealed: &Concealed, arguments: &ProveArguments) -> Result<Self, Refusal> {
        let threads = arguments.workers();
        let answers = diagnosed(arguments, concealed, threads)?;
        Ok(Answered { answers, baselines: baselines(concealed, threads) })
    }

    fn write(&self, directory: &Path) -> Result<(), Refusal> {
        Outputs::one(directory.join("answers.json"), &self.answers.to_value())?;
        Outputs::one(directory.join("baselines.json"), &json!(self.baselines))
    }
}

/// Cases whose truths were opened, and the scores of the answers.
struct Scored {
    /// Which cases these are.
    what: String,
    plan: Value,
    /// SHA-256 of the sealed truths.
    digest: String,
    judged: Vec<Judged>,
    score: Score,
    methods: Methods,
    routes: RouteScores,
}

impl Scored {
    /// Opens the truths and scores what was answered.
    fn of(concealed: Concealed, answered: &Answered, threads: usize) -> Result<Self, Refusal> {
        let Answered { answers, baselines } = answered;
        let Concealed { cases, numbers, truths, what, plan, .. } = concealed;
        let digest = truths.digest().to_owned();
        let truths = truths.open(answers).ok_or_else(|| Refusal::new("answers are missing"))?;
        let mut truths: Opened = truths.into_iter().collect();
        let own = std::mem::take(&mut truths.laboratory);
        let frfs = numbers.len() - cases.laboratory.len() - cases.struck.len();
        let judged = judged(&cases, own, answers, threads);
        let routes = routes((&cases, frfs), truths, answers, threads);
        let believed: Vec<_> = cases.laboratory.iter().map(|case| &case.believed).collect();
        let methods = Methods::of(&judged, &believed, baselines);
        Ok(Scored { what, plan, digest, score: Score::of(&judged), judged, methods, routes })
    }

    fn to_value(&self) -> Value {
        let mut value = json!(self.score);
        value["methods"] = json!(self.methods);
        value["plan"] = self.plan.clone();
        value["sealed_truths_sha256"] = self.digest.clone().into();
        value["routes"] = json!(self.routes);
        value
    }

    fn page(&self, arguments: &ProveArguments) -> Result<String, Refusal> {
        let context = ProofContext {
            program: origin::program(),
            command: origin::command_line(),
            cases: self.what.clone(),
            sealed: self.digest.clone(),
            pages: !arguments.no_case_pages,
        };
        let Scored { judged, score, methods, routes, .. } = self;
        proof_page(&ProofResults { score, methods, judged, routes }, &context).map_err(Refusal::new)
    }

    /// The table for a terminal.
    fn to_text(&self, arguments: &ProveArguments) -> String {
        let Scored { what, digest, judged, score, methods, routes, .. } = self;
        let mut text = format!("{what}\ntruths sealed before the first answer, SHA-256 {digest}\n");
        if !judged.is_empty() {
            text.push_str(&format!("\n{score}\n{methods}"));
        }
        text.push_str(&routes.to_string());
        text.extend(cases_asked_for(arguments, score, routes).map(|line| format!("\n{line}")));
        if let Some(directory) = &arguments.output {
            text.push_str(&format!("\n{}", directory.join("report.html").display()));
        }
        text.trim_end().to_owned()
    }
}

/// The page of a proof, its score and its timing, written into a directory.
fn write_results(directory: &Path, page: String, score: &Value, timing: &Timing) -> Result<(), Refusal> {
    let mut outputs = Outputs::default();
    outputs.add(directory.join("report.html"), page);
    outputs.add_json(directory.join("proof.json"), score);
    outputs.add_json(directory.join("timing.json"), &timing.to_value());
    outputs.write()
}

/// What is sealed before the first answer: the plan and the digest of the truths.
fn write_seal(directory: &Path, concealed: &Concealed) -> Result<(), Refusal> {
    // A directory that cannot be written to is found out before the work, not after it.
    let seal = json!({ "plan": concealed.plan, "sealed_truths_sha256": concealed.truths.digest() });
    Outputs::one(directory.join("seal.json"), &seal)
}

/// The updated and the looked-up models of the laboratory's cases, to hold the diagnosis against.
fn baselines(concealed: &Concealed, threads: usize) -> Vec<Option<Baseline>> {
    let bar = progress::cases(concealed.cases.laboratory.len(), "looked up and updated");
    Baseline::all(&concealed.cases.laboratory, threads, |done| bar.set_position(done as u64))
}

/// The laboratory's cases judged, each with its truth.
fn judged(cases: &Questions, truths: Vec<Truth>, answers: &Replies, threads: usize) -> Vec<Judged> {
    let cases = &cases.laboratory;
    let bar = progress::cases(cases.len(), "judged");
    Judged::all(cases, truths, &answers.laboratory, threads, |done| bar.set_position(done as u64))
}

/// The other routes' cases judged and scored, so many of them by their FRFs.
fn routes(
    (cases, frfs): (&Questions, usize),
    truths: Opened,
    answers: &Replies,
    threads: usize,
) -> RouteScores {
    let bar = progress::cases(frfs, "judged");
    RouteScores::of(cases, truths, answers, threads, |done| bar.set_position(done as u64))
}

/// The cases that were asked for: the only one, or with `--wrong` those with a fault.
fn cases_asked_for<'a>(
    arguments: &ProveArguments,
    score: &'a Score,
    routes: &'a RouteScores,
) -> impl Iterator<Item = &'a CaseLine> {
    let (all, wrong) = (arguments.only.is_some(), arguments.wrong);
    let sheets = std::iter::once(&score.sheet).chain(routes.0.iter().map(|route| &route.sheet));
    let lines = sheets.flat_map(|sheet| &sheet.lines);
    lines.filter(move |line| all || (wrong && !line.faults.is_empty()))
}

/// All cases diagnosed, and a page written of each where a directory was given.
fn diagnosed(arguments: &ProveArguments, concealed: &Concealed, threads: usize) -> Result<Replies, Refusal> {
    let bar = progress::cases(concealed.numbers.len(), "diagnosed");
    let directory = arguments.output.as_ref().filter(|_| !arguments.no_case_pages);
    let pages = directory.map(|directory| CasePages::below(directory, concealed));
    let replies = Replies::to(
        &concealed.cases,
        threads,
        |done| bar.set_position(done as u64),
        |position, answer| {
            if let Some(pages) = &pages {
                pages.write(position, answer);
            }
        },
    );
    pages.map_or(Ok(()), CasePages::finish)?;
    Ok(replies)
}

/// Whether plans keep what they promise.
fn plans(arguments: &ProveArguments, wanted: usize) -> Result<String, Refusal> {
    let path = arguments.output.as_ref().map(|directory| directory.join("planning.json"));
    if let Some(path) = &path {
        let mut outputs = Outputs::default();
        outputs.add(path, "");
        outputs.check()?;
    }
    let bar = progress::cases(wanted, "planned");
    let progress = |done: usize| bar.set_position(done as u64);
    let planning = Planning::of(wanted, arguments.seed.unwrap_or(1), arguments.workers(), progress)
        .map_err(Refusal::new)?;
    drop(bar);
    let value = json!(planning);
    if let Some(path) = path {
        Outputs::one(path, &value)?;
    }
    if arguments.json {
        return Ok(pretty(&value).trim_end().to_owned());
    }
    let mut text = planning.to_string();
    if arguments.wrong {
        for case in planning.cases.iter().filter(|case| case.promise >= 0.9 && !case.separated) {
            text.push_str(&format!("{case}\n"));
        }
    }
    Ok(text.trim_end().to_owned())
}

/// What a recording cannot tell apart or show.
fn limits(fixture: &Path, recording: &Path, json: bool) -> Result<String, Refusal> {
    let believed = FixtureFile::read(fixture)?;
    let files = vec![recording.to_owned()];
    let read = RecordingArguments::plain(files).recording(&believed)?;
    let frfs = read.frfs().map_err(|error| Refusal::at(recording, error))?;
    let limits = Limits::of(&believed, frfs).ok_or_else(|| {
        Refusal::at(
            recording,
            "has no coherence with a number of averages, from which the noise could be taken",
        )
    })?;
    Ok(if json { pretty(&json!(limits)) } else { limits.to_string() }.trim_end().to_owned())
}
