//! Progress on standard error: bars on a terminal alone, lines anywhere.

use std::io::Write;

use indicatif::{ProgressBar, ProgressStyle};

/// A message alone.
pub fn spinner() -> ProgressBar {
    styled(ProgressBar::new_spinner(), "{msg}")
}

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
