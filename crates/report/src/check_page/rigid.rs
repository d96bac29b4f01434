//! The model's modes, beside the recording's.

use jointscope_check::{ModelModes, RecordingCheck};
use jointscope_wording::counted;

use crate::format::{fixed, in_column, significant, with_sign};
use crate::mode_indicator;
use crate::section::Section;
use crate::table::Table;
use crate::unit::Scale;

pub(super) fn modes(modes: &ModelModes, recording: Option<&RecordingCheck>) -> Section {
    let table = Table::of(&modes.modes)
        .numbers("Natural frequency", "Hz", |mode| hertz(mode.frequency.value, mode.frequency.std))
        .numbers("Damping ratio", "%", |mode| significant(100.0 * mode.damping_ratio, 3))
        .words("", |mode| moves(mode.on_supports))
        .footnote(format!(
            "{} at 0 Hz; modes up to {} Hz. The deviations are those that the fixture's own tolerances leave.",
            counted(modes.rigid, "rigid-body mode"),
            significant(modes.to, 4)
        ));
    let section = Section::new("Modes of the model").with(table);
    let section = match modes.nearness() {
        Some(nearness) => section.paragraph(format!("{nearness}.")),
        None => section,
    };
    let Some(recording) = recording else { return section };
    let Some(found) = &recording.modes else {
        let why = recording.no_modes.as_deref().unwrap_or_default();
        return section.paragraph(format!("No modes of the recording beside them: {why}."));
    };
    let shift = |mode: &&jointscope_check::ModePair| {
        let share = mode.fixture.map(|fixture| 100.0 * (mode.frequency / fixture - 1.0));
        share.map_or("–".to_owned(), |share| format!("{} %", with_sign(share, 2)))
    };
    let beside = Table::of(&found.modes)
        .caption("Modes of the recording, and the fixture's that they are by frequency and shape")
        .numbers("Recorded", "Hz", |mode| hertz(mode.frequency, Some(mode.std)))
        .numbers("Damping ratio", "%", |mode| significant(100.0 * mode.damping_ratio, 3))
        .numbers("Fixture", "Hz", |mode| mode.fixture.map_or("–".to_owned(), |hz| hertz(hz, None)))
        .numbers("Recorded differs by", "", shift)
        .numbers("MAC", "", |mode| mode.mac.map_or("–".to_owned(), |mac| fixed(mac, 2)))
        .words("", |mode| moves(mode.on_supports));
    let section = section.with(beside);
    if found.missing.is_empty() {
        return section;
    }
    let missing: Vec<String> = found.missing.iter().map(|hz| hertz(*hz, None)).collect();
    section.paragraph(format!(
        "The recording does not show the fixture's elastic mode{} at {} Hz.",
        if missing.len() == 1 { "" } else { "s" },
        missing.join(", ")
    ))
}

/// What a mode moves, where it does not bend the assembly.
fn moves(on_supports: bool) -> &'static str {
    if on_supports { "as rigid on its supports" } else { "" }
}

/// How many modes the recording shows, and the fixture.
pub(super) fn indicator(recording: &RecordingCheck) -> Option<Section> {
    let plot = mode_indicator::plot(&recording.measured, recording.fixture_frfs().as_ref())?;
    Some(Section::new("How many modes there are").plot(plot))
}

/// A figure in a column of Hz.
fn hertz(value: f64, std: Option<f64>) -> String {
    in_column(value, std, &Scale::plain("Hz"))
}
