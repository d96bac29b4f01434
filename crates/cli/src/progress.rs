//! Progress and notices on standard error: bars on a terminal alone, lines anywhere.

use std::fmt;
use std::io::{IsTerminal, Write};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use jointscope::report::format::hides;

/// Steps of something long: the last one on a terminal, lines elsewhere, of what is done within a stage no
/// more than one every other second.
#[derive(Debug)]
pub(crate) struct Steps {
    /// On a terminal alone.
    spinner: Option<ProgressBar>,
    last_shown: Mutex<LastShown>,
}

/// What was told last.
#[derive(Debug)]
struct LastShown {
    stage: String,
    /// What the stages are about, until it is told.
    over: Option<String>,
    last: Instant,
}

/// Time between lines of what is done within a stage: a log stays short, and whoever watches sees that it
/// goes on.
const PAUSE: Duration = Duration::from_secs(2);

impl Steps {
    /// Nothing told yet.
    pub(crate) fn new() -> Self {
        let spinner = || styled(ProgressBar::new_spinner(), "{msg}");
        let last_shown = LastShown { stage: String::new(), over: None, last: Instant::now() };
        Steps { spinner: std::io::stderr().is_terminal().then(spinner), last_shown: Mutex::new(last_shown) }
    }

    /// What the stages that follow are about; told with the first.
    pub(crate) fn over(&self, what: &str) {
        self.last_shown().over = Some(what.to_owned());
    }

    /// A stage begins.
    pub(crate) fn stage(&self, what: &str) {
        let mut last_shown = self.last_shown();
        let over = last_shown.over.take().map_or_else(String::new, |over| format!(" ({over})"));
        last_shown.stage = format!("{what}{over}");
        self.show(&mut last_shown, &format!("{what}{over} …"));
    }

    /// Something is done within a stage.
    pub(crate) fn within(&self, what: impl FnOnce() -> String) {
        let mut last_shown = self.last_shown();
        let due = if self.spinner.is_some() { SHOWN } else { PAUSE };
        if last_shown.last.elapsed() >= due {
            let line = format!("{}: {}", last_shown.stage, what());
            self.show(&mut last_shown, &line);
        }
    }

    /// It is done.
    pub(crate) fn finish(&self) {
        if let Some(spinner) = &self.spinner {
            spinner.finish_and_clear();
        }
    }

    fn show(&self, last_shown: &mut LastShown, line: &str) {
        last_shown.last = Instant::now();
        match &self.spinner {
            Some(spinner) => spinner.set_message(visible(line)),
            None => tell(line),
        }
    }

    fn last_shown(&self) -> MutexGuard<'_, LastShown> {
        // What was told stays true whatever happened to whoever told it.
        self.last_shown.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Time between changes of what a terminal shows.
const SHOWN: Duration = Duration::from_millis(100);

/// A count of steps: a bar on a terminal, lines elsewhere, no more than one every so often and none for what
/// is done at once.
pub(crate) struct Bar {
    /// On a terminal alone.
    bar: Option<ProgressBar>,
    state: Mutex<BarState>,
}

struct BarState {
    done: u64,
    steps: u64,
    what: String,
    last: Instant,
}

/// Time between lines of a count.
const BETWEEN: Duration = Duration::from_secs(5);

impl Bar {
    /// Of so many steps; `template` says what stands beside it on a terminal, `what` what is counted.
    fn new(steps: u64, template: &str, what: &str) -> Self {
        let bar = || styled(ProgressBar::new(steps), template).with_message(what.to_owned());
        let state = BarState { done: 0, steps, what: what.to_owned(), last: Instant::now() };
        Bar { bar: std::io::stderr().is_terminal().then(bar), state: Mutex::new(state) }
    }

    /// How many steps there are.
    pub(crate) fn set_length(&self, steps: u64) {
        self.state().steps = steps;
        if let Some(bar) = &self.bar {
            bar.set_length(steps);
        }
    }

    /// What is done at present.
    pub(crate) fn set_message(&self, what: String) {
        if let Some(bar) = &self.bar {
            bar.set_message(what.clone());
        }
        self.state().what = what;
    }

    /// So many steps are done.
    pub(crate) fn set_position(&self, done: u64) {
        let mut state = self.state();
        state.done = done;
        match &self.bar {
            Some(bar) => bar.set_position(done),
            None if state.last.elapsed() >= BETWEEN => {
                tell(&state.to_string());
                state.last = Instant::now();
            }
            None => {}
        }
    }

    fn state(&self) -> MutexGuard<'_, BarState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl fmt::Display for BarState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {} {}", self.done, self.steps, self.what)
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// A bar of `steps`; `template` says what stands beside it.
pub(crate) fn bar(steps: u64, template: &str, what: &str) -> Bar {
    Bar::new(steps, template, what)
}

/// A bar of cases: how many are done, and how long the rest takes.
pub(crate) fn cases(count: usize, what: &str) -> Bar {
    let template = "{bar:30} {pos} of {len} {msg}, {elapsed} gone, {eta} to go";
    Bar::new(count as u64, template, &format!("cases {what}"))
}

fn styled(bar: ProgressBar, template: &str) -> ProgressBar {
    bar.with_style(ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()))
}

/// A line for whoever watches, apart from the results.
pub(crate) fn tell(line: &str) {
    // With standard error closed nobody watches.
    let _ = writeln!(std::io::stderr(), "{}", visible(line));
}

/// A text that no name can make look like another: what hides is spelled as JSON does, so that JSON stays the
/// same.
pub(crate) fn visible(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        match hides(c) {
            true => shown.extend([format!("\\u{:04x}", u32::from(c))]),
            false => shown.push(c),
        }
    }
    shown
}

/// What a reader of the answer should know besides.
pub(crate) fn notice(sentence: &str) {
    tell(&format!("note: {sentence}"));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_can_neither_command_a_terminal_nor_turn_its_text_around() {
        assert_eq!(visible("a\u{1b}[2J\tÄ\n\u{202e}b"), "a\\u001b[2J\tÄ\n\\u202eb");
    }

    #[test]
    fn a_line_of_a_count_says_how_much_of_what_is_done() {
        let bar = cases(12, "diagnosed");
        bar.set_position(3);
        assert_eq!(bar.state().to_string(), "3 of 12 cases diagnosed");
    }
}
