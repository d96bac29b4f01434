//! FRFs, channels, driving points, reciprocity, mass line, and the overlays.

use jointscope_check::{DrivingPointVerdict, FrfCheck, RecordingCheck};

use crate::format::{percent, plain, quantity, significant, with_sign};
use crate::plot::{Curve, FrfPanes, Role, Style, worst};
use crate::section::Section;
use crate::table::Table;
use crate::tone::Tone;

/// FRFs that are drawn at the most.
const SHOWN: usize = 12;

pub(super) fn sections(recording: &RecordingCheck) -> Vec<Section> {
    vec![frfs(recording), channels(recording), pairs(recording), mass_line(recording), overlays(recording)]
}

fn or_dash(text: Option<String>) -> String {
    text.unwrap_or_else(|| "–".to_owned())
}

fn frfs(recording: &RecordingCheck) -> Section {
    let (from, to, count) = recording.lines;
    let coherence = |frf: &&FrfCheck| {
        or_dash(
            frf.coherence.map(|c| format!("{} ({} below 0.8)", significant(c.median, 3), percent(c.low, 0))),
        )
    };
    let table = Table::of(&recording.frfs)
        .words("FRF", |frf| frf.frf.to_string())
        .numbers("averages", "", |frf| or_dash(frf.averages.map(|n| n.to_string())))
        .words("coherence, median", coherence)
        .numbers("noise", "%", |frf| significant(100.0 * frf.noise, 2))
        .words("noise from", |frf| frf.noise_from.says())
        .numbers("nrmse", "", |frf| or_dash(frf.nrmse.map(|nrmse| percent(nrmse, 1))))
        .numbers("level", "", |frf| or_dash(frf.level.map(|level| significant(level, 3))))
        .numbers("sign", "", |frf| or_dash(frf.sign.map(|sign| with_sign(sign, 2))))
        .footnote(
            "nrmse: distance from the fixture's FRF as it stands. A narrow resonance that has moved by its width makes 100 % and more. Level: median of recorded over the fixture's. Sign: mean cosine of the angle between them, 1 alike, −1 turned round. Noise: median over the lines.",
        );
    let lines = format!("{count} lines from {} to {} Hz.", plain(from, 6), plain(to, 6));
    let section = Section::new("FRFs").paragraph(lines).with(table);
    match recording.without_recording.as_slice() {
        [] => section,
        points => section.paragraph(format!("Nothing was recorded at points {}.", points.join(", "))),
    }
}

fn channels(recording: &RecordingCheck) -> Section {
    let table = Table::of(&recording.channels)
        .words("channel", |channel| channel.channel.clone())
        .numbers("FRFs", "", |channel| channel.frfs.to_string())
        .numbers("level beside the others", "", |channel| {
            or_dash(channel.level.map(|level| significant(level, 3)))
        })
        .numbers("noise", "%", |channel| significant(100.0 * channel.noise, 2))
        .words("odd", |channel| channel.odd.join("; "))
        .marked(|channel| (!channel.odd.is_empty()).then_some(Tone::Attention));
    Section::new("Channels").with(table)
}

fn pairs(recording: &RecordingCheck) -> Section {
    let section = Section::new("Driving points and reciprocity");
    let section = match recording.driving_points.as_slice() {
        [] => section.paragraph("There is no driving point: no sensor sits where the hammer strikes, so signs and places cannot be judged by one."),
        points => section.with(
            Table::of(points)
                .words("driving point", |point| point.frf.to_string())
                .numbers("lines judged", "", |point| point.judged_lines.to_string())
                .numbers("power comes out on", "", |point| percent(point.negative, 1))
                .words("so", |point| match point.verdict {
                    DrivingPointVerdict::Passive => "passive, as it must be",
                    DrivingPointVerdict::Turned => "sensor and hammer point opposite ways",
                    DrivingPointVerdict::Mixed => "not one point, or a phase error",
                    DrivingPointVerdict::NotJudged => "too noisy to judge",
                })
                .marked(|point| match point.verdict {
                    DrivingPointVerdict::Turned | DrivingPointVerdict::Mixed => Some(Tone::Attention),
                    _ => None,
                })
                .footnote("A passive structure takes in power at a driving point on every line: the imaginary part of its accelerance is never negative."),
        ),
    };
    match recording.reciprocity.as_slice() {
        [] => section.paragraph("No two FRFs are each other's reciprocal."),
        pairs => section.with(
            Table::of(pairs)
                .words("FRFs", |pair| format!("{} and {}", pair.frf, pair.other))
                .numbers("apart", "", |pair| percent(pair.difference, 1))
                .numbers("by noise", "", |pair| percent(pair.expected, 1))
                .numbers("level", "", |pair| significant(pair.level, 3))
                .marked(|pair| pair.odd.then_some(Tone::Attention)),
        ),
    }
}

fn mass_line(recording: &RecordingCheck) -> Section {
    let section = Section::new("Mass line");
    let Some(line) = &recording.mass_line else {
        let why = recording.no_mass_line.as_deref().unwrap_or("there is no model");
        return section.paragraph(format!("Not judged: {why}."));
    };
    let mass = match line.mass {
        Some(mass) => format!("They weigh {}.", quantity(mass.value, mass.std, mass.unit)),
        None => "They do not tell the total mass: that takes a structure that moves as one rigid body and three FRFs between different places.".to_owned(),
    };
    section
        .paragraph(format!(
            "From {} to {} Hz the assembly moves nearly as one rigid body; what is left there at 0 Hz is its accelerance as such. {mass}",
            plain(line.band.0, 4),
            plain(line.band.1, 4)
        ))
        .with(
            Table::of(&line.frfs)
                .words("FRF", |frf| frf.frf.to_string())
                .words("recorded", |frf| quantity(frf.recorded.value, frf.recorded.std, "1/kg"))
                .words("fixture", |frf| quantity(frf.fixture, None, "1/kg"))
                .marked(|frf| frf.odd.then_some(Tone::Attention)),
        )
}

fn overlays(recording: &RecordingCheck) -> Section {
    let frfs = &recording.measured;
    let count = frfs.lines().len();
    let distances: Vec<f64> = recording.frfs.iter().map(|frf| frf.nrmse.unwrap_or(0.0)).collect();
    let shown = worst(&distances, SHOWN);
    let some = if shown.len() < frfs.pairs().len() {
        format!(" Shown are the {} of {} that are farthest from it.", shown.len(), frfs.pairs().len())
    } else {
        String::new()
    };
    let section = Section::new("FRFs beside the fixture's").paragraph(format!(
        "Accelerances as recorded with the 95 % band of their noise, and the fixture's as it stands, nothing fitted.{some}"
    ));
    shown.into_iter().fold(section, |section, index| {
        let modelled = recording.modelled.as_deref().map(|all| &all[index * count..(index + 1) * count]);
        let curve = |values: &[num_complex::Complex64]| Curve {
            label: "fixture",
            role: Role::Nominal,
            style: Style::Dashed,
            values: values.iter().map(|value| Some(*value)).collect(),
        };
        let mut panes = FrfPanes::recorded(frfs, index, modelled.map(curve).into_iter().collect());
        if let Some(nrmse) = recording.frfs[index].nrmse {
            panes.title += &format!(", nrmse {}", percent(nrmse, 1));
        }
        section.plots(2, panes.all())
    })
}
