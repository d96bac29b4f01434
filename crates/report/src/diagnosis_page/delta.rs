//! δ(ω): the missing component as measured, line by line, and the law that names it.

use jointscope_diagnosis::{Finding, LineEstimate, Location, Site};
use jointscope_fixture::EffectKind;
use num_complex::Complex64;

use super::law::Law;
use super::{LINE_LIMIT, Subject};
use crate::format::{NOT_DETERMINED, quantity, significant};
use crate::{Axis, Column, Plot, Role, Section, Table, YRange};

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
        .filter_map(|(index, finding)| Some((index, finding, finding.measured.as_ref()?)))
        .filter(|(_, _, location)| !location.delta.is_empty())
        .collect();
    // Only what has no name is drawn without a law.
    let best = diagnosis.locations.first().filter(|l| diagnosis.is_unnamed() && !l.delta.is_empty());
    if measured.is_empty() && best.is_none() {
        return None;
    }
    let mut section = Section::new("Measured δ(ω)").paragraph(
        "The place alone, with no law assumed: one unknown complex value a line that explains all FRFs together as well as can be. Dots with their \
         95 % band are what was measured of the missing component; the curve is the law of the finding, with its fitted parameters.",
    );
    for (index, finding, location) in &measured {
        let law = Law::of(finding, &location.site, subject.fixture);
        let curve = law
            .map(|law| (law.formula, known(location).map(|d| law.at(d.frequency)).collect()))
            .or_else(|| roving(finding, location));
        section = section.plots(2, panes(&format!("{}. {}", index + 1, finding.name()), location, curve));
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

/// The law of a sensor that is moved about depends on the accelerance of its own seat: taken as it was fitted to δ.
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
    let columns = [
        Column::text("Law tried on δ(ω)"),
        Column::text("Formula"),
        Column::text("Parameters"),
        Column::numbers("χ² per degree of freedom", ""),
    ];
    let mut table = Table::new(columns).caption(format!("Laws at {}", location.site.says()));
    for law in &location.laws {
        let parameters: Vec<String> = law
            .parameters
            .iter()
            .map(|p| format!("{} {}", p.name.replace('_', " "), quantity(p.value, p.std, p.unit)))
            .collect();
        table = table.row([
            law.name.to_owned(),
            law.formula.to_owned(),
            parameters.join(", "),
            // Where nothing fits the yielding tolerances may take more than there is.
            if law.chi2_per_dof >= 0.0 {
                significant(law.chi2_per_dof, 3)
            } else {
                NOT_DETERMINED.to_owned()
            },
        ]);
    }
    section.table(table.footnote(format!(
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

fn pane(title: &str, part: &str, of: fn(Complex64) -> f64, location: &Location, law: Option<&Curve>) -> Plot {
    let known: Vec<&LineEstimate> = known(location).collect();
    let hz: Vec<f64> = known.iter().map(|d| d.frequency).collect();
    let values: Vec<f64> = known.iter().map(|d| of(d.value)).collect();
    let low = known.iter().map(|d| of(d.value) - 1.96 * d.std);
    let high = known.iter().map(|d| of(d.value) + 1.96 * d.std);
    let curve: Option<Vec<f64>> = law.map(|(_, values)| values.iter().map(|value| of(*value)).collect());
    let range = range(&values, &known, curve.as_deref());
    let mut plot =
        Plot::new(title, Axis::frequency(), Axis::linear(format!("{part} δ"), location.site.unit()))
            .over(&hz)
            .band("95 % interval", Role::Uncertainty, low, high)
            .points("measured", Role::Measured, &values);
    if let (Some((formula, _)), Some(curve)) = (law, curve) {
        plot = plot.line(format!("law: {formula}"), Role::Highlight, curve);
    }
    // In series nothing missing would be an infinite stiffness.
    if !matches!(location.site, Site::Series { .. }) {
        plot = plot.horizontal("nothing missing", Role::Reference, 0.0);
    }
    plot.height(240)
        .line_limit(LINE_LIMIT)
        .y_range(range)
        .caption(format!("{part} δ at {}.", location.site.says()))
}

/// Room for the law and for the lines that are best known; lines that know little would squash both.
fn range(values: &[f64], known: &[&LineEstimate], curve: Option<&[f64]>) -> YRange {
    let mut stds: Vec<f64> = known.iter().map(|d| d.std).collect();
    stds.sort_unstable_by(f64::total_cmp);
    let Some(&limit) = stds.get(stds.len() / 4) else { return YRange::Full };
    let mut best: Vec<f64> =
        values.iter().zip(known).filter(|(_, d)| d.std <= limit).map(|(v, _)| *v).collect();
    best.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| best.get((share * best.len().saturating_sub(1) as f64).round() as usize).copied();
    let (Some(mut low), Some(mut high)) = (at(0.05), at(0.95)) else { return YRange::Full };
    for value in curve.unwrap_or(&[]).iter().filter(|v| v.is_finite()) {
        (low, high) = (low.min(*value), high.max(*value));
    }
    (low, high) = (low.min(0.0), high.max(0.0));
    let room = (0.4 * (high - low)).max(2.0 * limit);
    if room > 0.0 { YRange::Fixed { low: low - room, high: high + room } } else { YRange::Full }
}
