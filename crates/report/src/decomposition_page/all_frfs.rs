//! The joint from all FRFs: laws over frequency, tests, and where the fixture moved.

use jointscope_decomposition::{FittedQuantity, JointFit, JointTests, LawFit};
use jointscope_fixture::Fixture;
use jointscope_wording::{Remarks, Says, capitalised};

use super::subject::Subject;
use crate::format::{quantity, quantity_in, significant};
use crate::section::{Block, Section};
use crate::table::Table;
use crate::tone::Tone;
use crate::unit::Scale;

/// Probability below which a law is left out of the table.
const NEGLIGIBLE: f64 = 1e-3;

pub(super) fn section(subject: &Subject) -> Option<Section> {
    let fit = subject.analysis.joint_fit.as_ref().ok()?;
    let names: Vec<String> = fit.frfs.iter().map(ToString::to_string).collect();
    let fixture = match fit.quantities.is_empty() {
        true => ", the fixture taken as exact. The ± hold noise.",
        false => {
            " together with the fixture's uncertain quantities, each of which may move as far as its standard deviation lets \
             it: FRFs on one side of the joint weigh that side's block. The ± hold noise and tolerances at once."
        }
    };
    let mut section = Section::new("The joint from all FRFs")
        .paragraph(format!(
            "k and c are fitted to {} ({}){fixture}",
            if names.len() == 1 { "one FRF".to_owned() } else { format!("all {} FRFs", names.len()) },
            names.join(", ")
        ))
        .notes(fit.remarks().iter().map(|remark| capitalised(remark)));
    if !fit.laws.is_empty() {
        section = section.with(laws(fit));
    }
    section = section.with(tests(&fit.tests));
    Some(if fit.quantities.is_empty() { section } else { section.with(moved(subject.fixture, fit)) })
}

pub(super) fn laws(fit: &JointFit) -> impl Into<Block> {
    let shown =
        fit.laws.iter().enumerate().filter(|(place, law)| *place < 2 || law.probability >= NEGLIGIBLE);
    let probability = |law: &LawFit| match law.probability {
        p if p >= NEGLIGIBLE => format!("{} %", significant(100.0 * p, 3)),
        _ => "< 0.1 %".to_owned(),
    };
    let element = |value: f64, unit: &'static str| quantity(value, None, unit);
    let mut table = Table::of(shown.map(|(_, law)| law))
        .words("Law over frequency", |law| capitalised(&law.says()))
        .numbers("Probability", "", move |law| probability(law))
        .numbers("k₁₁", "", move |law| element(law.stiffness.at(0, 0), "N/m"));
    if !fit.scalar {
        table = table.numbers("k₁₂", "", move |law| element(law.stiffness.at(0, 1), "N/rad")).numbers(
            "k₂₂",
            "",
            move |law| element(law.stiffness.at(1, 1), "N*m/rad"),
        );
    }
    table.caption("How stiffness and damping depend on frequency, by the evidence of the FRFs").footnote(
        "k: of the law's own spring, at rest for laws whose stiffness changes; the figures above are those in the middle of the band. The damping matrix of every law has three free elements; a law pays for \
         what it adjusts.",
    )
}

pub(super) fn tests(tests: &JointTests) -> impl Into<Block> {
    let rows = [
        ("k₁₂ = k₂₁ and c₁₂ = c₂₁ (reciprocal)", tests.reciprocity),
        ("No negative eigenvalue of k (stays at rest)", tests.definite),
        ("No negative eigenvalue of c (gives out no energy)", tests.passive),
    ];
    Table::of(rows.into_iter().filter_map(|(what, p)| Some((what, p?))))
        .words("What physics asks of a joint", |(what, _)| (*what).to_owned())
        .numbers("p", "", |(_, p)| significant(*p, 2))
        .marked(|(_, p)| JointTests::fails(*p).then_some(Tone::Problem))
        .caption("p: how often chance speaks as much against it, if it holds and the joint follows the law that k and c are of")
}

pub(super) fn moved(fixture: &Fixture, fit: &JointFit) -> impl Into<Block> {
    let stated = fixture.quantities();
    let unit = move |path: &str| stated.iter().find(|own| own.path == path).map_or("", |own| own.key.unit());
    let mut rows: Vec<(&FittedQuantity, &'static str)> =
        fit.quantities.iter().map(|quantity| (quantity, unit(&quantity.path))).collect();
    rows.sort_by(|a, b| b.0.deviations.abs().total_cmp(&a.0.deviations.abs()));
    let scale = |own: &FittedQuantity, unit: &str| {
        Scale::of_stated([own.stated, own.fitted, own.fitted_std].into_iter().chain(own.std), unit)
    };
    Table::of(rows)
        .words("Quantity", |(own, _)| own.path.clone())
        .words("Stated", move |(own, unit)| quantity_in(own.stated, own.std, &scale(own, unit)))
        .words("With the FRFs", move |(own, unit)| quantity_in(own.fitted, own.fitted_std, &scale(own, unit)))
        .numbers("moved by", "std", |(own, _)| match own.std {
            Some(_) => significant(own.deviations, 2),
            None => "free".to_owned(),
        })
        .marked(|(own, _)| own.is_far().then_some(Tone::Attention))
        .caption("What of the fixture the FRFs depend on, and where they take it")
}
