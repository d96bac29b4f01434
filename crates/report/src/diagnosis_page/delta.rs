//! δ(ω): the missing component as measured, line by line, and the law that names it.

use jointscope_diagnosis::{Finding, LawFit, LawParameter, LineEstimate, Location, Site};
use jointscope_fixture::{EffectKind, Fixture};
use jointscope_inference::Z95;
use jointscope_lumped::Delta;
use jointscope_wording::{Says, effect_name};
use num_complex::Complex64;
use std::f64::consts::TAU;

use super::subject::Subject;
use crate::format::{NOT_DETERMINED, quantity, significant};
use crate::plot::{Axis, Plot, Role, Span, YRange};
use crate::section::Section;
use crate::table::Table;

/// Real or imaginary part.
type Part = fn(Complex64) -> f64;
/// A law's formula and its values on the lines where δ is drawn.
type Curve = (&'static str, Vec<Complex64>);

pub(super) fn section(subject: &Subject) -> Option<Section> {
    let diagnosis = subject.diagnosis;
    let measured: Vec<(usize, &Finding, &Location)> = diagnosis
        .findings
        .iter()
        .enumerate()
        .filter_map(|(index, finding)| Some((index, finding, finding.evidence.measured.as_ref()?)))
        .filter(|(_, _, location)| !location.delta.is_empty())
        .collect();
    // Only what has no name is drawn without a law.
    let best = diagnosis.best_place().filter(|place| !place.delta.is_empty());
    if measured.is_empty() && best.is_none() {
        return None;
    }
    let mut section = Section::new("Measured δ(ω)").paragraph(
        "The place alone, with no law assumed: one unknown complex value a line that explains all FRFs together as well as can be. Dots with their \
         95 % band are what was measured of the missing component; the curve is the law of the finding, with its fitted parameters.",
    );
    for (index, finding, location) in &measured {
        let curve = of_effect(finding, location, subject.fixture).or_else(|| roving(finding, location));
        section = section
            .plots(2, panes(&format!("{}. {}", index + 1, effect_name(&finding.effect)), location, curve));
        section = with_laws(section, location);
    }
    if let Some(best) = best {
        section = section.paragraph(
            "Nothing that was tried names the mismatch with any confidence: below, what is missing is drawn as it was measured at the place that explains \
             most by itself.",
        );
        section = with_laws(section.plots(2, panes(&best.site.says(), best, None)), best);
    }
    Some(section)
}

/// δ on the lines where it can be drawn.
fn known(location: &Location) -> impl Iterator<Item = &LineEstimate> {
    location.delta.iter().filter(|d| d.frequency.is_finite() && d.std.is_finite() && d.value.is_finite())
}

/// The law of a finding with its parameters.
fn of_effect(finding: &Finding, location: &Location, fixture: &Fixture) -> Option<Curve> {
    let formula = finding.effect.kind.spec().words.law?;
    let delta = Delta::of(fixture, &finding.effect)?;
    let at = |line: &LineEstimate| delta.at(Complex64::new(0.0, TAU * line.frequency));
    Some((formula, known(location).map(at).collect()))
}

/// The law of a sensor that is moved about depends on the accelerance of its own seat: taken as it was fitted
/// to δ.
fn roving(finding: &Finding, location: &Location) -> Option<Curve> {
    let law = location.laws.iter().find(|law| law.name == "a sensor's mass")?;
    if finding.effect.kind != EffectKind::SensorMass || law.values.len() != location.delta.len() {
        return None;
    }
    let drawn = location.delta.iter().zip(&law.values);
    let finite = drawn.filter(|(d, _)| d.frequency.is_finite() && d.std.is_finite() && d.value.is_finite());
    Some((law.formula, finite.map(|(_, value)| *value).collect()))
}

/// The laws that were tried on δ, the closest first.
fn with_laws(section: Section, location: &Location) -> Section {
    if location.laws.is_empty() {
        return section;
    }
    let parameters = |law: &LawFit| -> Vec<String> {
        let text =
            |p: &LawParameter| format!("{} {}", p.name.replace('_', " "), quantity(p.value, p.std, p.unit));
        law.parameters.iter().map(text).collect()
    };
    // Where nothing fits the yielding tolerances may take more than there is.
    let misfit = |chi2: f64| if chi2 >= 0.0 { significant(chi2, 3) } else { NOT_DETERMINED.to_owned() };
    let table = Table::of(&location.laws)
        .caption(format!("Laws at {}", location.site.says()))
        .words("Law tried on δ(ω)", |law| law.name)
        .words("Formula", |law| law.formula)
        .words("Parameters", |law| parameters(law).join(", "))
        .numbers("χ² per degree of freedom", "", |law| misfit(law.chi2_per_dof));
    section.with(table.footnote(format!(
        "χ² is that of δ on {} lines against its law, tolerances yielding; {} lines do not determine δ.",
        location.delta.len(),
        location.masked
    )))
}

/// Real and imaginary part.
fn panes(title: &str, location: &Location, law: Option<Curve>) -> [Plot; 2] {
    let parts: [(&str, Part); 2] = [("Re", |v| v.re), ("Im", |v| v.im)];
    parts.map(|(part, of)| pane(&format!("{part} δ, {title}"), part, of, location, law.as_ref()))
}

fn pane(title: &str, part: &str, of: Part, location: &Location, law: Option<&Curve>) -> Plot {
    let known: Vec<&LineEstimate> = known(location).collect();
    let edge = |times: f64| known.iter().map(move |d| of(d.value) + times * Z95 * d.std);
    let curve = law.map(|(formula, values)| (formula, values.iter().map(|v| of(*v)).collect::<Vec<f64>>()));
    let delta = Axis::linear(format!("{part} δ"), location.site.unit());
    let mut plot = Plot::new(title, Axis::frequency(), delta)
        .over(known.iter().map(|d| d.frequency))
        .y_range(range(&known, of, curve.as_ref().map_or(&[], |(_, values)| values)))
        .band("95 % interval", Role::Uncertainty, edge(-1.0), edge(1.0))
        .points("measured", Role::Measured, known.iter().map(|d| of(d.value)));
    if let Some((formula, curve)) = curve {
        plot = plot.line(format!("law: {formula}"), Role::Highlight, curve);
    }
    // In series nothing missing would be an infinite stiffness.
    if !matches!(location.site, Site::Series { .. }) {
        plot = plot.horizontal("nothing missing", Role::Reference, 0.0);
    }
    plot.caption(format!("{part} δ at {}.", location.site.says()))
}

/// Room for the law and for the lines that are best known; lines that know little would squash both.
fn range(known: &[&LineEstimate], of: Part, curve: &[f64]) -> YRange {
    let mut stds: Vec<f64> = known.iter().map(|d| d.std).collect();
    stds.sort_unstable_by(f64::total_cmp);
    let Some(&limit) = stds.get(stds.len() / 4) else { return YRange::Full };
    let best = known.iter().filter(|d| d.std <= limit).map(|d| of(d.value));
    let span = Span::percentiles(best, (5.0, 95.0)).and(Span::of(curve.iter().copied().chain([0.0])));
    YRange::about(span, (0.4 * span.width()).max(2.0 * limit))
}
