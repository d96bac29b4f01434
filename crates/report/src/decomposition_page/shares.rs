//! Which tolerances of the fixture matter.

use jointscope_decomposition::{DynamicStiffnessPart, JointEstimate, MatrixElement, Method, ToleranceShare};
use jointscope_fixture::{Dof, Fixture, NamedQuantity, Nature, QuantityKey as Key, QuantityOwner};
use jointscope_linalg::RealMatrix2;

use super::subject::Subject;
use crate::format::{NOT_DETERMINED, magnitude, significant};
use crate::section::Section;
use crate::table::Table;
use jointscope_wording::element::symbol;

/// Rows of the table.
const SHOWN: usize = 8;

/// A tolerance with its relative effects on k11, k12, k22 and c11.
struct Effect<'a> {
    quantity: &'a NamedQuantity,
    std: f64,
    relative: Vec<f64>,
}

impl Effect<'_> {
    /// Its largest effect on the stiffness; damping is too poorly known to rank by.
    fn on_stiffness(&self) -> f64 {
        let stiffness = self.relative.len().saturating_sub(1);
        self.relative.iter().take(stiffness).fold(0.0, |largest, effect| largest.max(effect.abs()))
    }

    /// Its standard deviation, absolute and as a share of its value.
    fn known_to(&self) -> String {
        let Effect { quantity, std, .. } = self;
        if quantity.nature == Nature::Abscissa {
            return format!("{} mm", significant(1e3 * std, 2));
        }
        let relative = format!(" ({} %)", significant(100.0 * std / quantity.value.abs(), 2));
        let absolute = magnitude(*std, quantity.key.unit(), 2);
        if quantity.value == 0.0 { absolute } else { absolute + &relative }
    }
}

pub(super) fn section(subject: &Subject) -> Section {
    let quantities = subject.fixture.quantities();
    let watched = watched(subject);
    let shares = subject.analysis.tolerances.iter();
    let mut effects: Vec<Effect> =
        shares.filter_map(|share| effect(subject, share, &quantities, &watched)).collect();
    effects.sort_by(|a, b| {
        b.on_stiffness().total_cmp(&a.on_stiffness()).then_with(|| a.quantity.path.cmp(&b.quantity.path))
    });
    let section = Section::new("Tolerances");
    if subject.analysis.tolerances.is_empty() {
        return section.paragraph(
            "No quantity of the fixture has a tolerance: all are taken as exact, and the ± hold noise alone.",
        );
    }
    let Some(strongest) = effects.first() else {
        return section.paragraph(
            "The fit to the FRFs across the joint could not follow any tolerance of the fixture.",
        );
    };
    let advice = advice(strongest.quantity, subject.fixture);
    let result = match subject.best.method {
        Method::AllFrfs => {
            "By how much the fit to the FRFs across the joint, the fixture as stated, moves when one quantity of the fixture is larger by its \
             standard deviation. The joint from all FRFs moves by other amounts: those FRFs weigh the fixture as well, and its ± hold what is left."
        }
        _ => {
            "By how much the result moves when one quantity of the fixture is larger by its standard deviation."
        }
    };
    let paragraph = format!("{result} {advice}");
    let mut table = Table::of(effects.iter().take(SHOWN))
        .words("Quantity", |effect| in_words(effect.quantity, subject.fixture))
        .words("In the file", |effect| effect.quantity.path.clone())
        .words("Known to", |effect| effect.known_to())
        .footnote("Changes in percent of the element's magnitude.");
    for (index, (part, element)) in watched.iter().enumerate() {
        let heading = symbol(*part, *element, subject.best.paper);
        table = table.numbers(heading, "%", |effect| signed_percent(effect.relative[index]));
    }
    let rest = effects.len().saturating_sub(SHOWN);
    if rest > 0 {
        table = table
            .footnote(format!("{rest} more have smaller effects on the stiffness; the ± hold them all."));
    }
    section.paragraph(paragraph).with(table)
}

/// k11, k12, k22, c11, or k11 and c11 of a scalar joint.
fn watched(subject: &Subject) -> Vec<(DynamicStiffnessPart, MatrixElement)> {
    let scalar = subject.is_scalar();
    let mut watched: Vec<(DynamicStiffnessPart, MatrixElement)> =
        MatrixElement::distinct(scalar).map(|e| (DynamicStiffnessPart::Stiffness, e)).collect();
    watched.push((DynamicStiffnessPart::Damping, MatrixElement::all(scalar)[0]));
    watched
}

fn effect<'a>(
    subject: &Subject,
    share: &ToleranceShare,
    quantities: &'a [NamedQuantity],
    watched: &[(DynamicStiffnessPart, MatrixElement)],
) -> Option<Effect<'a>> {
    let quantity = quantities.iter().find(|quantity| quantity.path == share.path)?;
    let changes: (RealMatrix2, RealMatrix2) = match subject.best.method {
        Method::MaximumLikelihood | Method::AllFrfs => share.likelihood?,
        Method::WeightedMean | Method::PlainMean => share.plain,
    };
    let across = match subject.best.method {
        Method::AllFrfs => JointEstimate::maximum_likelihood(subject.analysis),
        _ => None,
    };
    let of = across.as_ref().unwrap_or(subject.best);
    let relative = |&(part, element): &(DynamicStiffnessPart, MatrixElement)| {
        element.of(&part.of(changes)) / of.figure(part, element).value.abs()
    };
    Some(Effect { quantity, std: share.std, relative: watched.iter().map(relative).collect() })
}

fn signed_percent(effect: f64) -> String {
    if !effect.is_finite() {
        return NOT_DETERMINED.to_owned();
    }
    let percent = 100.0 * effect;
    if percent.abs() < 0.005 {
        return "0".to_owned();
    }
    let text = significant(percent, 2);
    if percent > 0.0 { format!("+{text}") } else { text }
}

/// A quantity as one would say it.
fn in_words(quantity: &NamedQuantity, fixture: &Fixture) -> String {
    let name = match quantity.owner {
        QuantityOwner::Body(index) => &fixture.bodies()[index].name,
        QuantityOwner::Point(index) => &fixture.points()[index].name,
        QuantityOwner::Joint(index) => &fixture.joints()[index].name,
        QuantityOwner::Support(index) => &fixture.supports()[index].name,
        _ => "",
    };
    let what = match quantity.key {
        Key::Mass => "mass of",
        Key::Inertia => "inertia of",
        Key::CentreOfGravity => "centre of gravity of",
        Key::Abscissa => "place of point",
        Key::YoungsModulus => "Young's modulus of",
        Key::SecondMoment => "second moment of area of",
        Key::SupportStiffness(Dof::Translation) => "stiffness of support",
        Key::SupportStiffness(Dof::Rotation) => "rotational stiffness of support",
        Key::SupportDamping(Dof::Translation) => "dashpot of support",
        Key::ModalRatio(index) => return format!("damping ratio of mode {}", index + 1),
        _ => return quantity.path.rsplit('/').next().unwrap_or_default().replace('_', " "),
    };
    format!("{what} {name}")
}

/// How to know the quantity better that matters most.
fn advice(quantity: &NamedQuantity, fixture: &Fixture) -> String {
    let is_joint_end =
        |point: usize| fixture.joints().iter().any(|joint| [joint.from, joint.to].contains(&point));
    let how = match (quantity.nature, quantity.owner) {
        (Nature::Abscissa, _) if quantity.key == Key::CentreOfGravity => {
            "balance the block on an edge, or take it from the drawing with the sensors' masses"
        }
        (Nature::Abscissa, QuantityOwner::Point(point)) if is_joint_end(point) => {
            "measure the joint's free length with a calliper and all other places from its ends"
        }
        (Nature::Abscissa, _) => {
            "measure sensors and hammer points from the joint's end with a calliper, and strike through a punch mark"
        }
        (Nature::Mass, _) => "weigh the block as tested, sensors and half of the cables included",
        (Nature::Inertia, _) => {
            "swing the block as a pendulum, or take it from the drawing with the sensors' masses"
        }
        (Nature::Support, _) => {
            "find it from the rigid-body frequencies of the hung assembly, or hang the assembly softer"
        }
        _ => "measure it by itself",
    };
    format!("What matters most is the {}: to know the joint better, {how}.", in_words(quantity, fixture))
}
