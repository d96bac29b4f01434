//! The page of a diagnosis from stepped sines at several levels.

use jointscope_fixture::Fixture;
use jointscope_nonlinear::{LevelResult, SteppedDiagnosis, Verdict as Conclusion};

use crate::format::quantity;
use crate::{Axis, Column, Page, PageContext, PageError, Plot, Role, Section, Table, Tone, Verdict};

/// The page of a diagnosis from FRFs at several levels as one self-contained HTML file: the verdict, frequency and damping against the amplitude
/// of the joint's motion, the levels' table, and every law tried. The same input gives the same bytes.
///
/// # Errors
/// A page whose parts cannot be drawn.
pub fn stepped_page(
    diagnosis: &SteppedDiagnosis,
    fixture: &Fixture,
    context: &PageContext,
) -> Result<String, PageError> {
    let tone = match diagnosis.verdict {
        Conclusion::Homogeneous => Tone::Ok,
        Conclusion::Explained => Tone::Attention,
        Conclusion::PartlyExplained | Conclusion::Unexplained => Tone::Problem,
    };
    let said = diagnosis.findings.iter().map(|finding| finding.says());
    let details = said.chain(diagnosis.remarks()).chain(context.notes.iter().cloned());
    let verdict = details.fold(Verdict::new(tone, diagnosis.says()), Verdict::detail);
    Page::new("Diagnosis: what changes from level to level")
        .subtitle(context.subtitle(fixture))
        .verdict(verdict)
        .section(courses(diagnosis))
        .section(levels(diagnosis))
        .section(tried(diagnosis))
        .foot(context.foot())
        .to_html()
}

fn courses(diagnosis: &SteppedDiagnosis) -> Section {
    let mut levels: Vec<&LevelResult> = diagnosis.levels.iter().collect();
    levels.sort_by(|a, b| a.motion.total_cmp(&b.motion));
    levels.dedup_by(|a, b| a.motion <= b.motion);
    let (joint, dof) = (&diagnosis.place.0, diagnosis.place.1.name());
    let unit = if dof == "rotation" { "rad" } else { "m" };
    let motions = || levels.iter().map(|l| l.motion).collect::<Vec<f64>>();
    let plot = |title: &str, y: Axis, value: &dyn Fn(&LevelResult) -> (f64, f64)| {
        let of = |times: f64| levels.iter().map(|l| value(l).0 + times * value(l).1).collect::<Vec<f64>>();
        let plot =
            Plot::new(title, Axis::linear(format!("Relative motion of joint {joint} in {dof}"), unit), y)
                .over(motions())
                .band("95 % interval", Role::Uncertainty, of(-1.96), of(1.96))
                .line("measured", Role::Measured, of(0.0));
        match levels.get(diagnosis.holds.wrapping_sub(1)) {
            Some(last) if diagnosis.holds < levels.len() => {
                plot.vertical("the law found holds up to here", Role::Highlight, last.motion)
            }
            _ => plot,
        }
    };
    Section::new("Frequency and damping against amplitude")
        .paragraph(
            "One resonance is fitted to each level by itself; intervals are those of that fit's scatter.",
        )
        .plot(plot("Natural frequency", Axis::linear("Natural frequency", "Hz"), &|l| l.resonance.frequency))
        .plot(plot("Damping ratio", Axis::linear("Damping ratio", "%"), &|l| {
            (100.0 * l.resonance.damping_ratio.0, 100.0 * l.resonance.damping_ratio.1)
        }))
}

fn levels(diagnosis: &SteppedDiagnosis) -> Section {
    let columns = [
        "level",
        "frequency, Hz",
        "damping, %",
        "relative motion",
        "stiffness beyond the fixture",
        "loss stiffness beyond it",
        "error refitted",
        "repaired",
        "own stiffness",
        "law holds",
    ];
    let mut table = Table::new(columns.map(Column::text));
    for (index, l) in diagnosis.levels.iter().enumerate() {
        table = table.row([
            l.held.to_string(),
            quantity(l.resonance.frequency.0, l.resonance.frequency.1, ""),
            quantity(100.0 * l.resonance.damping_ratio.0, 100.0 * l.resonance.damping_ratio.1, ""),
            format!("{:.3e}", l.motion),
            format!("{:.3e}", l.stiffness.0),
            format!("{:.3e}", l.loss.0),
            format!("{:.3}", l.nrmse[1]),
            format!("{:.3}", l.nrmse[2]),
            format!("{:.3}", l.nrmse[3]),
            if index < diagnosis.holds { "yes" } else { "no" }.to_owned(),
        ]);
    }
    Section::new("Levels").table(table)
}

fn tried(diagnosis: &SteppedDiagnosis) -> Section {
    let columns =
        ["law", "joint", "component", "relative error over all levels", "share of the change explained"];
    let mut table = Table::new(columns.map(Column::text));
    for t in &diagnosis.tried {
        table = table.row([
            t.form.to_owned(),
            t.joint.clone(),
            t.dof.name().to_owned(),
            format!("{:.3}", t.nrmse),
            format!("{:.0} %", 100.0 * t.share),
        ]);
    }
    Section::new("Laws tried on all levels")
        .paragraph(format!(
            "Relative errors are root mean squares over the levels. A complex stiffness of its own at each level leaves {:.3}: no law of amplitude leaves less.",
            diagnosis.nrmse[3]
        ))
        .table(table)
}
