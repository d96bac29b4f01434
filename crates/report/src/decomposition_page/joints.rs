//! The page of several joints found at once, or of one in a loop.

use jointscope_decomposition::{DynamicStiffnessPart, FoundJoint, JointsFit, MatrixElement};
use jointscope_fixture::Fixture;
use jointscope_wording::{Remarks, capitalised};

use super::all_frfs::{laws, moved, tests};
use crate::context::PageContext;
use crate::drawing::SideView;
use crate::format::{quantity, quantity_in, significant};
use crate::report::Report;
use crate::section::{Section, Verdict};
use crate::table::Table;
use crate::tone::Tone;
use crate::unit::Scale;
use jointscope_wording::element::{symbol, unit};

/// Correlation of two numbers from which it is listed.
const CORRELATED: f64 = 0.5;
/// Correlations listed at the most.
const LISTED: usize = 12;

/// The page of several joints: the fixture, k and c of every joint with the fixture's own beside them, laws
/// and tests of each, numbers of different joints that are known together, and where the fixture moved.
///
/// `fixture` is the one that the joints were found with. The same input gives the same bytes.
pub(crate) fn joints_report(fit: &JointsFit, fixture: &Fixture, context: &PageContext) -> Report {
    let names: Vec<&str> = fit.joints.iter().map(|joint| joint.name.as_str()).collect();
    let sections = fit.joints.iter().map(joint_section);
    let page = context
        .page(
            format!("Joints {}: stiffness and damping", names.join(", ")),
            context.subtitle(fixture),
            verdict(fit),
        )
        .sections(context.hits())
        .sections(drawing(fit, fixture))
        .sections([result(fit)])
        .sections(sections)
        .sections(together(fit))
        .sections(quantities(fit, fixture));
    Report::of(page)
}

fn verdict(fit: &JointsFit) -> Verdict {
    let stiffness = |joint: &FoundJoint| {
        let std = joint.fit.std().0.at(0, 0);
        format!("{}: k₁₁ = {}", joint.name, quantity(joint.fit.stiffness.at(0, 0), std, "N/m"))
    };
    let all: Vec<String> = fit.joints.iter().map(stiffness).collect();
    let mut details: Vec<String> = fit.remarks().iter().map(|remark| capitalised(remark)).collect();
    if let Some(first) = fit.joints.first() {
        details.push(format!(
            "From {} FRFs over {} lines, all joints and the fixture's uncertain quantities in one fit; χ² per degree of freedom {}.",
            first.fit.frfs.len(),
            first.fit.lines,
            significant(first.fit.chi2_per_dof, 3)
        ));
    }
    Verdict {
        tone: if fit.is_sound() { Tone::Ok } else { Tone::Attention },
        headline: format!("{}.", all.join("; ")),
        details,
    }
}

fn drawing(fit: &JointsFit, fixture: &Fixture) -> Option<Section> {
    let mut view = SideView::new(fixture, fit.joints.first()?.fit.frfs.iter());
    view.joints.extend(fit.joints.iter().map(|joint| joint.name.as_str()));
    Some(Section::new("Fixture").drawing(
        view.draw(),
        "Side view: the joints found, and the channels that they were found from, responses (sensors) in blue and references (hammer) in green.",
    ))
}

/// A number of a joint.
type Row<'a> = (&'a FoundJoint, DynamicStiffnessPart, MatrixElement);

fn result(fit: &JointsFit) -> Section {
    let rows = fit.joints.iter().flat_map(|joint| {
        DynamicStiffnessPart::ALL
            .into_iter()
            .flat_map(move |part| MatrixElement::distinct(joint.fit.scalar).map(move |e| (joint, part, e)))
    });
    let table = Table::of(rows)
        .words("Joint", |(joint, ..): &Row| joint.name.clone())
        .words("", |(_, part, element)| symbol(*part, *element, false).to_string())
        .words("From all FRFs", |(joint, part, element)| {
            let value = element.of(&part.of((joint.fit.stiffness, joint.fit.damping)));
            quantity_in(value, element.of(&part.of(joint.fit.std())), &scale(joint, *part, *element))
        })
        .words("The fixture's", |(joint, part, element)| match part {
            DynamicStiffnessPart::Stiffness => quantity_in(element.of(&joint.nominal), None, &scale(joint, *part, *element)),
            DynamicStiffnessPart::Damping => String::new(),
        })
        .caption("On d = u_to − R·u_from at each joint's far end. The ± hold noise, tolerances and what the model gets wrong.");
    Section::new("Result").with(table)
}

/// The unit of a number's row.
fn scale(joint: &FoundJoint, part: DynamicStiffnessPart, element: MatrixElement) -> Scale {
    let found = element.of(&part.of((joint.fit.stiffness, joint.fit.damping)));
    let std = element.of(&part.of(joint.fit.std()));
    let nominal = (part == DynamicStiffnessPart::Stiffness).then(|| element.of(&joint.nominal));
    Scale::for_values(nominal.into_iter().chain([found, std]), unit(part, element))
}

fn joint_section(joint: &FoundJoint) -> Section {
    let mut section = Section::new(format!("Joint {}", joint.name))
        .paragraph(format!(
            "From point {} on {} to point {} on {}{}.",
            joint.ends.from.point,
            joint.ends.from.body,
            joint.ends.to.point,
            joint.ends.to.body,
            if joint.is_in_a_loop { ", in a loop" } else { "" }
        ))
        .notes(joint.remarks().iter().map(|remark| capitalised(remark)));
    if !joint.fit.laws.is_empty() {
        section = section.with(laws(&joint.fit));
    }
    section.with(tests(&joint.fit.tests))
}

/// Numbers of different joints whose errors go together.
fn together(fit: &JointsFit) -> Option<Section> {
    let std = |e: usize| fit.covariance[e][e].max(0.0).sqrt();
    let joint = |e: usize| fit.elements[e].rsplit_once('/').map_or("", |(joint, _)| joint);
    let mut pairs: Vec<(usize, usize, f64)> = (0..fit.elements.len())
        .flat_map(|a| (0..a).map(move |b| (b, a)))
        .filter(|(a, b)| joint(*a) != joint(*b))
        .map(|(a, b)| (a, b, fit.covariance[a][b] / (std(a) * std(b))))
        .filter(|(.., correlation)| correlation.abs() >= CORRELATED)
        .collect();
    pairs.sort_by(|a, b| b.2.abs().total_cmp(&a.2.abs()));
    pairs.truncate(LISTED);
    (!pairs.is_empty()).then(|| {
        let table = Table::of(pairs)
            .words("Number", |(a, ..)| fit.elements[*a].clone())
            .words("and number", |(_, b, _)| fit.elements[*b].clone())
            .numbers("correlation", "", |(.., correlation)| significant(*correlation, 2))
            .caption("Errors of different joints that go together, by what both of them share: blocks, and each other");
        Section::new("Known together").with(table)
    })
}

fn quantities(fit: &JointsFit, fixture: &Fixture) -> Option<Section> {
    let first = &fit.joints.first()?.fit;
    (!first.quantities.is_empty())
        .then(|| Section::new("Where the fixture moved").with(moved(fixture, first)))
}
