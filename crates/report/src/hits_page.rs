//! The page of a diagnosis from hits of several strengths.

use jointscope_fixture::Fixture;
use jointscope_nonlinear::NonlinearDiagnosis;
use jointscope_wording::{Remarks, Says, effect_name};

use crate::context::PageContext;
use crate::force_state;
use crate::format::significant;
use crate::report::Report;
use crate::section::Section;
use crate::table::Table;

/// The page of a diagnosis from hits as one self-contained HTML file: the verdict, the laws found with their
/// intervals, levels compared, force against motion, errors of the three models, and the hits held out. The
/// same input gives the same bytes.
pub(crate) fn hits_report(
    diagnosis: &NonlinearDiagnosis,
    fixture: &Fixture,
    context: &PageContext,
) -> Report {
    let said = diagnosis.findings.iter().map(|finding| finding.says());
    let verdict = context.verdict(diagnosis.verdict, diagnosis.says(), said.chain(diagnosis.remarks()));
    Report::of(
        context
            .page("Diagnosis: what changes with amplitude", context.subtitle(fixture), verdict)
            .sections(context.hits())
            .sections([levels(diagnosis)])
            .sections((!diagnosis.findings.is_empty()).then(|| laws(diagnosis)))
            .sections((!diagnosis.maps.is_empty()).then(|| force_state::section(&diagnosis.maps, fixture)))
            .sections(diagnosis.models.as_ref().map(|_| judgement(diagnosis))),
    )
}

fn levels(diagnosis: &NonlinearDiagnosis) -> Section {
    let homogeneity = &diagnosis.homogeneity;
    let table = Table::of(homogeneity.levels.iter().enumerate())
        .words("level", |(index, _)| (index + 1).to_string())
        .words("mean peak force, N", |(_, level)| format!("{:.1}", level.peak_force))
        .words("hits", |(_, level)| level.hits.to_string());
    Section::new("Do FRFs change with strength?")
        .paragraph(format!(
            "One FRF for all hits at a point is compared with one a level. Levels differ {:.2} times as much as noise makes them (variance); the probability of as much by chance is {}. They differ the most between {} and {} Hz.",
            homogeneity.ratio, significant(homogeneity.p_value, 2), significant(homogeneity.band.0, 4), significant(homogeneity.band.1, 4)
        ))
        .with(table)
}

fn laws(diagnosis: &NonlinearDiagnosis) -> Section {
    let of_finding = |finding| {
        let finding: &jointscope_nonlinear::HitFinding = finding;
        finding.estimates.iter().map(move |estimate| (finding, estimate))
    };
    let end = |interval: Option<[f64; 2]>, i: usize| {
        interval.map_or("not determined".to_owned(), |ends| significant(ends[i], 4))
    };
    let table = Table::of(diagnosis.findings.iter().flat_map(of_finding))
        .words("law", |(finding, _)| effect_name(&finding.effect))
        .words("parameter", |(_, estimate)| estimate.parameter.name)
        .words("value", |(_, estimate)| significant(estimate.value, 5))
        .words("from (95 %)", |(_, estimate)| end(estimate.interval, 0))
        .words("to", |(_, estimate)| end(estimate.interval, 1))
        .words("unit", |(_, estimate)| estimate.unit)
        .words("probability", |(finding, _)| format!("{:.2}", finding.probability));
    Section::new("What the joint does").with(table)
}

fn judgement(diagnosis: &NonlinearDiagnosis) -> Section {
    let names = ["as stated", "refitted within tolerances, no law", "repaired"];
    let table = Table::of(names.into_iter().zip(diagnosis.models.iter().flatten()))
        .words("model", |(name, _)| *name)
        .words("relative error of the responses", |(_, model)| format!("{:.4}", model.nrmse))
        .words("χ² per degree of freedom", |(_, model)| significant(model.chi2_per_dof, 4));
    let section = Section::new("Is it better?").with(table);
    match &diagnosis.held_out {
        Some(held) => section.paragraph(format!(
            "{} hits were kept from the search and predicted afterwards: relative error {:.4} by the refitted fixture, {:.4} by the repaired one.",
            held.what.len(),
            held.nrmse_refitted,
            held.nrmse_repaired
        )),
        None => section,
    }
}
