//! Progress on standard error: bars on a terminal alone, lines anywhere.

use std::io::{IsTerminal, Write};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// Steps of something long: the last one on a terminal, lines elsewhere, of what is done within a stage no more than one every other second.
#[derive(Debug)]
pub struct Steps {
    /// On a terminal alone.
    spinner: Option<ProgressBar>,
    told: Mutex<Told>,
}

/// What was told last.
#[derive(Debug)]
struct Told {
    stage: String,
    /// What the stages are about, until it is told.
    over: Option<String>,
    last: Instant,
}

/// Time between lines of what is done within a stage: a log stays short, and whoever watches sees that it goes on.
const PAUSE: Duration = Duration::from_secs(2);

impl Steps {
    /// Nothing told yet.
    pub fn new() -> Self {
        let spinner = || styled(ProgressBar::new_spinner(), "{msg}");
        let told = Told { stage: String::new(), over: None, last: Instant::now() };
        Steps { spinner: std::io::stderr().is_terminal().then(spinner), told: Mutex::new(told) }
    }

    /// What the stages that follow are about; told with the first.
    pub fn over(&self, what: &str) {
        self.told().over = Some(what.to_owned());
    }

    /// A stage begins.
    pub fn stage(&self, what: &str) {
        let mut told = self.told();
        let over = told.over.take().map_or_else(String::new, |over| format!(" ({over})"));
        told.stage = format!("{what}{over}");
        self.show(&mut told, &format!("{what}{over} …"));
    }

    /// Something is done within a stage.
    pub fn within(&self, what: impl FnOnce() -> String) {
        let mut told = self.told();
        let due = if self.spinner.is_some() { SHOWN } else { PAUSE };
        if told.last.elapsed() >= due {
            let line = format!("{}: {}", told.stage, what());
            self.show(&mut told, &line);
        }
    }

    /// It is done.
    pub fn finish(&self) {
        if let Some(spinner) = &self.spinner {
            spinner.finish_and_clear();
        }
    }

    fn show(&self, told: &mut Told, line: &str) {
        told.last = Instant::now();
        match &self.spinner {
            Some(spinner) => spinner.set_message(line.to_owned()),
            None => tell(line),
        }
    }

    fn told(&self) -> MutexGuard<'_, Told> {
        // What was told stays true whatever happened to whoever told it.
        self.told.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Time between changes of what a terminal shows.
const SHOWN: Duration = Duration::from_millis(100);

/// A bar of `steps`; `template` says what stands beside it.
pub fn bar(steps: u64, template: &str) -> ProgressBar {
    styled(ProgressBar::new(steps), template)
}

/// A bar of cases: how many are done, and how long the rest takes.
pub fn cases(count: usize, what: &'static str) -> ProgressBar {
    bar(count as u64, "{bar:30} {pos} of {len} cases {msg}, {elapsed} gone, {eta} to go")
        .with_message(what)
        .with_finish(indicatif::ProgressFinish::AndClear)
}

fn styled(bar: ProgressBar, template: &str) -> ProgressBar {
    bar.with_style(ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()))
}

/// A line for whoever watches, apart from the results.
pub fn tell(line: &str) {
    // With standard error closed nobody watches.
    let _ = writeln!(std::io::stderr(), "{line}");
}
