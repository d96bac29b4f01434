//! The page of a diagnosis from hits of several strengths.

use jointscope_fixture::Fixture;
use jointscope_nonlinear::{NonlinearDiagnosis, Verdict as Conclusion};

use crate::{Column, Page, PageContext, PageError, Section, Table, Tone, Verdict};
use crate::{force_state, hammer_test};

/// The page of a diagnosis from hits as one self-contained HTML file: the verdict, the laws found with their intervals, levels compared,
/// force against motion, errors of the three models, and the hits held out. The same input gives the same bytes.
///
/// # Errors
/// A page whose parts cannot be drawn.
pub fn hits_page(
    diagnosis: &NonlinearDiagnosis,
    fixture: &Fixture,
    context: &PageContext,
) -> Result<String, PageError> {
    let mut page = Page::new("Diagnosis: what changes with amplitude")
        .subtitle(context.subtitle(fixture))
        .verdict(verdict(diagnosis, context));
    if let Some(test) = &context.hits {
        page = page.section(hammer_test::section(test));
    }
    page = page.section(levels(diagnosis));
    if !diagnosis.findings.is_empty() {
        page = page.section(laws(diagnosis));
    }
    if !diagnosis.maps.is_empty() {
        page = page.section(force_state::section(&diagnosis.maps, fixture));
    }
    if diagnosis.models.is_some() {
        page = page.section(judgement(diagnosis));
    }
    page.foot(context.foot()).to_html()
}

fn verdict(diagnosis: &NonlinearDiagnosis, context: &PageContext) -> Verdict {
    let tone = match diagnosis.verdict {
        Conclusion::Homogeneous => Tone::Ok,
        Conclusion::Explained => Tone::Attention,
        Conclusion::PartlyExplained | Conclusion::Unexplained => Tone::Problem,
    };
    let said = diagnosis.findings.iter().map(|finding| finding.says());
    let remarks = said.chain(diagnosis.remarks()).chain(context.notes.iter().cloned());
    remarks.fold(Verdict::new(tone, diagnosis.says()), Verdict::detail)
}

fn levels(diagnosis: &NonlinearDiagnosis) -> Section {
    let homogeneity = &diagnosis.homogeneity;
    let mut table =
        Table::new([Column::text("level"), Column::text("mean peak force, N"), Column::text("hits")]);
    for (index, (peak, hits)) in homogeneity.levels.iter().enumerate() {
        table = table.row([(index + 1).to_string(), format!("{peak:.1}"), hits.to_string()]);
    }
    Section::new("Do FRFs change with strength?")
        .paragraph(format!(
            "One FRF for all hits at a point is compared with one a level. Levels differ {:.2} times as much as noise makes them (variance); the probability of as much by chance is {:.2e}. They differ the most between {:.0} and {:.0} Hz.",
            homogeneity.ratio, homogeneity.p_value, homogeneity.band.0, homogeneity.band.1
        ))
        .table(table)
}

fn laws(diagnosis: &NonlinearDiagnosis) -> Section {
    let columns = ["law", "parameter", "value", "from (95 %)", "to", "unit", "probability"];
    let mut table = Table::new(columns.map(Column::text));
    for finding in &diagnosis.findings {
        for estimate in &finding.estimates {
            let end = |i: usize| {
                estimate.interval.map_or("not determined".to_owned(), |ends| format!("{:.4e}", ends[i]))
            };
            table = table.row([
                finding.name(),
                estimate.parameter.name.to_owned(),
                format!("{:.4e}", estimate.value),
                end(0),
                end(1),
                estimate.unit.to_owned(),
                format!("{:.2}", finding.probability),
            ]);
        }
    }
    Section::new("What the joint does").table(table)
}

fn judgement(diagnosis: &NonlinearDiagnosis) -> Section {
    let columns = ["model", "relative error of the responses", "χ² per degree of freedom"];
    let mut table = Table::new(columns.map(Column::text));
    let names = ["as stated", "refitted within tolerances, no law", "repaired"];
    for (name, model) in names.iter().zip(diagnosis.models.iter().flatten()) {
        table = table.row([
            name.to_string(),
            format!("{:.4}", model.nrmse),
            format!("{:.4e}", model.chi2_per_dof),
        ]);
    }
    let section = Section::new("Is it better?").table(table);
    match &diagnosis.held_out {
        Some(held) => section.paragraph(format!(
            "{} hits were kept from the search and predicted afterwards: relative error {:.4} by the refitted fixture, {:.4} by the repaired one.",
            held.hits.len(),
            held.nrmse_refitted,
            held.nrmse_repaired
        )),
        None => section,
    }
}
