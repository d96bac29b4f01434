//! The page of many cases: what came of each, with the way to its own page.

use jointscope_cases::{Command, DecomposedCase, DiagnosedCase, FindingRow, Row, State, Summary};

use crate::context::PageContext;
use crate::error::PageError;
use crate::format::{in_column, quantity, significant};
use crate::section::{Card, Section, Verdict};
use crate::table::{Cell, Table};
use crate::tone::Tone;
use crate::unit::Scale;

/// The page of many cases as one self-contained HTML file: how many came to what, and a row a case; each
/// leads to the page beside it, `<case>/report.html`.
///
/// # Errors
/// None at present.
pub fn summary_page(summary: &Summary, context: &PageContext) -> Result<String, PageError> {
    let without = summary.rows.iter().filter(|row| !row.state.is_answered()).count();
    let tone = if without > 0 { Tone::Attention } else { Tone::Ok };
    let verdict = Verdict { tone, headline: summary.says(), details: Vec::new() };
    let title = match summary.command {
        Command::Diagnose => "Many cases diagnosed",
        Command::Decompose => "Many cases decomposed",
    };
    let cards = summary
        .counts()
        .into_iter()
        .map(|(verdict, count)| Card::text(verdict.replace('_', " "), count.to_string()));
    let table = match summary.command {
        Command::Diagnose => Section::new("Cases").cards(cards).with(diagnosed(summary)),
        Command::Decompose => Section::new("Cases").cards(cards).with(decomposed(summary)),
    };
    context.page(title, String::new(), verdict).sections([table]).sections(refused(summary)).to_html()
}

/// The case, and the way to its page where it has one.
fn name(row: &Row) -> Cell {
    match row.state.is_answered() {
        true => Cell::Link(row.case.clone(), format!("{}/report.html", row.case)),
        false => row.case.as_str().into(),
    }
}

fn tone(state: &State) -> Option<Tone> {
    match state {
        State::Diagnosed(case) => match case.verdict.as_str() {
            "consistent" => Some(Tone::Ok),
            "explained" => Some(Tone::Attention),
            _ => Some(Tone::Problem),
        },
        State::Decomposed(case) => match case.verdict.as_str() {
            "sound" => Some(Tone::Ok),
            "with_care" => Some(Tone::Attention),
            _ => Some(Tone::Problem),
        },
        State::Refused(_) | State::Missing => Some(Tone::Problem),
    }
}

fn verdict(row: &&Row) -> String {
    row.state.verdict().replace('_', " ")
}

/// Kind, place and dof as they are spoken: `shear deformation J1`.
fn name_of(finding: &FindingRow) -> String {
    // The name of a place keeps its underscores.
    let kind = finding.kind.replace('_', " ");
    let others = [finding.place.as_deref(), finding.dof.as_deref()].into_iter().flatten();
    std::iter::once(kind.as_str()).chain(others).collect::<Vec<_>>().join(" ")
}

/// Every parameter with its deviation in a unit that reads well.
fn parameters(finding: &FindingRow) -> String {
    let told = finding
        .estimates()
        .map(|(name, value, std, unit)| format!("{} {}", name.replace('_', " "), quantity(value, std, unit)));
    told.collect::<Vec<_>>().join("; ")
}

fn diagnosed(summary: &Summary) -> Table<&Row> {
    fn of<'a>(row: &&'a Row) -> Option<&'a DiagnosedCase> {
        match &row.state {
            State::Diagnosed(case) => Some(case),
            _ => None,
        }
    }
    let error = |row: &&Row, model: usize| {
        of(row)
            .and_then(|case| case.nrmse[model])
            .map_or(String::new(), |nrmse| significant(100.0 * nrmse, 3))
    };
    Table::of(&summary.rows)
        .words("Case", |row| name(row))
        .words("Verdict", verdict)
        .words("What is missing", |row| {
            of(row).map_or(String::new(), |case| case.findings.iter().map(name_of).collect::<Vec<_>>().join("; "))
        })
        .numbers("Probability", "", |row| {
            of(row).and_then(|case| case.findings.first()?.probability).map_or(String::new(), |p| format!("{p:.2}"))
        })
        .words("Parameters", |row| of(row).and_then(|case| case.findings.first()).map_or(String::new(), parameters))
        .numbers("Error, as stated", "%", |row| error(row, 0))
        .numbers("refitted", "%", |row| error(row, 1))
        .numbers("repaired", "%", |row| error(row, 2))
        .marked(|row| tone(&row.state))
        .footnote("Error: relative error of the FRFs (nrmse). The strongest finding's probability and parameters; summary.csv has the rest.")
}

fn decomposed(summary: &Summary) -> Table<&Row> {
    fn of<'a>(row: &&'a Row) -> Option<&'a DecomposedCase> {
        match &row.state {
            State::Decomposed(case) => Some(case),
            _ => None,
        }
    }
    const UNITS: [&str; 6] = ["N/m", "N/rad", "N*m/rad", "N*s/m", "N*s/rad", "N*m*s/rad"];
    const NAMES: [&str; 6] = ["k₁₁", "k₁₂", "k₂₂", "c₁₁", "c₁₂", "c₂₂"];
    let table = Table::of(&summary.rows)
        .words("Case", |row| name(row))
        .words("Joint", |row| of(row).map_or(String::new(), |case| case.joint.clone()))
        .words("Verdict", verdict);
    let table = (0..6).fold(table, |table, index| {
        let number = |row: &&Row| of(row).and_then(|case| case.numbers[index]);
        let scale =
            Scale::for_values(summary.rows.iter().filter_map(|row| Some(number(&row)?.0)), UNITS[index]);
        let unit = scale.unit().to_owned();
        table.numbers(NAMES[index], &unit, |row| {
            number(row).map_or(String::new(), |(value, std)| in_column(value, std, &scale))
        })
    });
    table
        .words("Law", |row| of(row).and_then(|case| case.law.as_ref()).map_or(String::new(), |(law, _)| law.clone()))
        .numbers("χ²/dof", "", |row| {
            of(row).and_then(|case| case.chi2_per_dof).map_or(String::new(), |chi2| significant(chi2, 3))
        })
        .marked(|row| tone(&row.state))
        .footnote("The joint from all FRFs, its most probable law over frequency, and χ² per degree of freedom; a case without one says why in summary.csv.")
}

fn refused(summary: &Summary) -> Option<Section> {
    let why = |row: &Row| match &row.state {
        State::Refused(why) => Some((row.case.clone(), why.clone())),
        State::Missing => Some((row.case.clone(), "not done yet, or its files are elsewhere".to_owned())),
        _ => None,
    };
    let rows: Vec<(String, String)> = summary.rows.iter().filter_map(why).collect();
    let table = (!rows.is_empty())
        .then(|| Table::of(rows).words("Case", |row| row.0.clone()).words("Why", |row| row.1.clone()));
    table.map(|table| Section::new("Without an answer").with(table))
}
