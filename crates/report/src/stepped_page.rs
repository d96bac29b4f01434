//! The page of a diagnosis from stepped sines at several levels.

use jointscope_fixture::Fixture;
use jointscope_inference::Z95;
use jointscope_nonlinear::{LevelResult, SteppedDiagnosis};
use jointscope_wording::{Remarks, Says};

use crate::context::PageContext;
use crate::format::{in_column, quantity};
use crate::plot::{Axis, Plot, Role};
use crate::report::Report;
use crate::section::Section;
use crate::table::Table;
use crate::unit::Scale;

/// The page of a diagnosis from FRFs at several levels as one self-contained HTML file: the verdict,
/// frequency and damping against the amplitude of the joint's motion, the levels' table, and every law tried.
/// The same input gives the same bytes.
pub(crate) fn stepped_report(
    diagnosis: &SteppedDiagnosis,
    fixture: &Fixture,
    context: &PageContext,
) -> Report {
    let said = diagnosis.findings.iter().map(|finding| finding.says());
    // Levels are told as recordings spell their units.
    let says = diagnosis.says().replace("m/s^2", "m/s²");
    let verdict = context.verdict(diagnosis.verdict, says, said.chain(diagnosis.remarks()));
    Report::of(
        context
            .page("Diagnosis: what changes from level to level", context.subtitle(fixture), verdict)
            .sections([against_amplitude(diagnosis), levels(diagnosis), tried(diagnosis)]),
    )
}

fn against_amplitude(diagnosis: &SteppedDiagnosis) -> Section {
    let mut levels: Vec<&LevelResult> = diagnosis.levels.iter().collect();
    levels.sort_by(|a, b| a.motion.total_cmp(&b.motion));
    levels.dedup_by(|a, b| a.motion <= b.motion);
    let (joint, dof) = (&diagnosis.place.0, diagnosis.place.1.name());
    let scale = scale(&levels, if dof == "rotation" { "rad" } else { "m" }, |level| level.motion);
    let plot = |title: &str, unit_y: &str, value: &dyn Fn(&LevelResult) -> (f64, f64)| {
        let of = |times: f64| levels.iter().map(|l| value(l).0 + times * value(l).1).collect::<Vec<f64>>();
        let motion = Axis::linear(format!("Relative motion of joint {joint} in {dof}"), scale.unit());
        let plot = Plot::new(title, motion, Axis::linear(title, unit_y))
            .over(levels.iter().map(|level| scale.of(level.motion)))
            .band("95 % interval", Role::Uncertainty, of(-Z95), of(Z95))
            .line("measured", Role::Measured, of(0.0));
        match levels.get(diagnosis.holds.wrapping_sub(1)) {
            Some(last) if diagnosis.holds < levels.len() => {
                plot.vertical("the law found holds up to here", Role::Highlight, scale.of(last.motion))
            }
            _ => plot,
        }
    };
    Section::new("Frequency and damping against amplitude")
        .paragraph(
            "One resonance is fitted to each level by itself; intervals are those of that fit's scatter.",
        )
        .plot(plot("Natural frequency", "Hz", &|l| l.resonance.frequency))
        .plot(plot("Damping ratio", "%", &in_percent))
}

/// The unit in which all levels are told.
fn scale<'a>(
    levels: impl IntoIterator<Item = &'a &'a LevelResult>,
    unit: &str,
    value: fn(&LevelResult) -> f64,
) -> Scale {
    Scale::for_values(levels.into_iter().map(|level| value(level)), unit)
}

/// Damping ratio and its standard deviation, %.
fn in_percent(level: &LevelResult) -> (f64, f64) {
    (100.0 * level.resonance.damping_ratio.0, 100.0 * level.resonance.damping_ratio.1)
}

fn levels(diagnosis: &SteppedDiagnosis) -> Section {
    let text = |(value, std): (f64, f64)| quantity(value, std, "");
    let (motion, stiffness) = match diagnosis.place.1.name() {
        "rotation" => ("rad", "N*m/rad"),
        _ => ("m", "N/m"),
    };
    let all: Vec<&LevelResult> = diagnosis.levels.iter().collect();
    let motion = scale(&all, motion, |level| level.motion);
    let beyond = scale(&all, stiffness, |level| level.stiffness.0);
    let loss = scale(&all, stiffness, |level| level.loss.0);
    let table = Table::of(&diagnosis.levels)
        .words("level", |l| l.held.to_string().replace("^2", "²"))
        .words("frequency, Hz", |l| text(l.resonance.frequency))
        .words("damping, %", |l| text(in_percent(l)))
        .numbers("relative motion", motion.unit(), |l| in_column(l.motion, None, &motion))
        .numbers("stiffness beyond the fixture", beyond.unit(), |l| in_column(l.stiffness.0, None, &beyond))
        .numbers("loss stiffness beyond it", loss.unit(), |l| in_column(l.loss.0, None, &loss))
        .words("error refitted", |l| format!("{:.3}", l.nrmse[1]))
        .words("repaired", |l| format!("{:.3}", l.nrmse[2]))
        .words("own stiffness", |l| format!("{:.3}", l.nrmse[3]))
        .words("law holds", |l| if l.explained { "yes" } else { "no" });
    Section::new("Levels").with(table)
}

fn tried(diagnosis: &SteppedDiagnosis) -> Section {
    let table = Table::of(&diagnosis.tried)
        .words("law", |t| t.form.clone())
        .words("joint", |t| t.joint.clone())
        .words("component", |t| t.dof.name())
        .words("relative error over all levels", |t| format!("{:.3}", t.nrmse))
        .words("share of the change explained", |t| format!("{:.0} %", 100.0 * t.share));
    Section::new("Laws tried on all levels")
        .paragraph(format!(
            "Relative errors are root mean squares over the levels. A complex stiffness of its own at each level leaves {:.3}: no law of amplitude leaves less.",
            diagnosis.nrmse[3]
        ))
        .with(table)
}
