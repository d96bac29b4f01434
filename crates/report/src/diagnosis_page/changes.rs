//! The modes on the baseline and now, and what the findings make of them.

use jointscope_diagnosis::{ModeChange, ModeState};

use super::subject::Subject;
use crate::format::significant;
use crate::section::Section;
use crate::table::Table;
use crate::tone::Tone;

/// Standard deviation, %, below which none is told.
const SMALLEST: f64 = 1e-3;

pub(super) fn section(subject: &Subject) -> Option<Section> {
    let baseline = subject.diagnosis.baseline.as_ref()?;
    let found = !subject.diagnosis.findings.is_empty();
    let frequency = |state: &ModeState| state.frequency;
    let damping = |state: &ModeState| state.damping_ratio;
    let numbered = baseline.modes.iter().enumerate();
    let mut table = Table::of(numbered)
        .words("Mode", |(index, _)| (index + 1).to_string())
        .numbers("f, baseline", "Hz", |(_, mode)| or_dash(mode.baseline.map(|s| frequency(&s)), 5))
        .numbers("f, now", "Hz", |(_, mode)| or_dash(mode.now.map(|s| frequency(&s)), 5))
        .numbers("Δf", "%", |(_, mode)| change(mode, frequency));
    if found {
        table = table.numbers("Δf, predicted", "%", |(_, mode)| predicted(mode, frequency));
    }
    let in_percent = |state: Option<ModeState>| or_dash(state.map(|s| 100.0 * damping(&s)), 3);
    table = table
        .numbers("ζ, baseline", "%", |(_, mode)| in_percent(mode.baseline))
        .numbers("ζ, now", "%", |(_, mode)| in_percent(mode.now))
        .numbers("Δζ", "%", |(_, mode)| change(mode, damping));
    if found {
        table = table.numbers("Δζ, predicted", "%", |(_, mode)| predicted(mode, damping));
    }
    let table = table.marked(|(_, mode)| mode.has_changed().then_some(Tone::Attention)).footnote(
        "f: natural frequency; ζ: damping ratio. Changes Δ are relative, with the standard deviation that the noise of both recordings gives them. Marked: a frequency or damping ratio \
         that has changed by more than three of them, which a repetition of the test may do as well. A mode that the \
         model does not have is taken for the same where its frequency is nearest.",
    );
    let words = if found {
        "What the modes of the recording differ by from those of the baseline; predicted is what the findings change the calibrated model's modes by."
    } else {
        "What the modes of the recording differ by from those of the baseline."
    };
    Some(Section::new("Modes, baseline and now").paragraph(words).with(table))
}

fn or_dash(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "–".to_owned(), |value| significant(value, digits))
}

/// The relative change of one of a mode's numbers with its standard deviation, %.
fn change(mode: &ModeChange, of: impl Fn(&ModeState) -> f64) -> String {
    let Some((change, std)) = mode.change.zip(mode.change_std) else { return "–".to_owned() };
    let (change, std) = (percent(of(&change)), 100.0 * of(&std));
    // As many decimals as the first digit of the deviation has, within reason.
    let decimals = (-std.max(SMALLEST).log10().floor()).clamp(0.0, 3.0) as usize;
    let text = match std < SMALLEST {
        true => format!("{change:+.decimals$}"),
        false => format!("{change:+.decimals$} ± {std:.decimals$}"),
    };
    text.replace('-', "−")
}

fn predicted(mode: &ModeChange, of: impl Fn(&ModeState) -> f64) -> String {
    mode.predicted.map_or_else(|| "–".to_owned(), |ratio| signed(percent(of(&ratio))))
}

/// Two digits with the sign.
fn signed(percent: f64) -> String {
    if percent.abs() < 5e-4 {
        return "0".to_owned();
    }
    let text = significant(percent, 2);
    if percent > 0.0 { format!("+{text}") } else { text }
}

/// The relative change that the logarithm of a ratio is, %.
fn percent(ln_ratio: f64) -> f64 {
    100.0 * ln_ratio.exp_m1()
}
