//! Which tolerances of the fixture matter.

use jointscope_decomposition::ToleranceShare;
use jointscope_fixture::{Fixture, NamedQuantity, Nature};
use jointscope_linalg::RealMatrix2;

use super::Subject;
use super::element::{Element, Kind};
use super::estimate::Method;
use crate::format::{NOT_DETERMINED, significant};
use crate::{Column, Scale, Section, Table, typeset};

/// Rows of the table.
const SHOWN: usize = 8;

/// A tolerance with its relative effects on k11, k12, k22 and c11.
struct Effect<'a> {
    share: &'a ToleranceShare,
    relative: Vec<f64>,
}

impl Effect<'_> {
    /// Its largest effect on the stiffness; damping is too poorly known to rank by.
    fn on_stiffness(&self) -> f64 {
        let stiffness = self.relative.len().saturating_sub(1);
        self.relative.iter().take(stiffness).fold(0.0, |largest, effect| largest.max(effect.abs()))
    }
}

pub(super) fn section(subject: &Subject) -> Option<Section> {
    let shares = &subject.analysis.tolerances;
    let quantities = subject.fixture.quantities();
    let watched = watched(subject);
    let mut effects: Vec<Effect> =
        shares.iter().filter_map(|share| effect(subject, share, &watched)).collect();
    effects.sort_by(|a, b| {
        b.on_stiffness().total_cmp(&a.on_stiffness()).then_with(|| a.share.path.cmp(&b.share.path))
    });
    let section = Section::new("Tolerances");
    let Some(strongest) = effects.first() else {
        return Some(section.paragraph(
            "No quantity of the fixture has a tolerance: all are taken as exact, and the ± hold noise alone.",
        ));
    };
    let advice = advice(&strongest.share.path, &quantities, subject.fixture);
    let paragraph = format!(
        "By how much the result moves when one quantity of the fixture is larger by its standard deviation. {advice}"
    );
    let mut columns = vec![Column::text("Quantity"), Column::text("In the file"), Column::text("Known to")];
    let paper = subject.best.paper;
    columns.extend(watched.iter().map(|(kind, element)| Column::numbers(kind.symbol(*element, paper), "%")));
    let mut table = Table::new(columns);
    for Effect { share, relative } in effects.iter().take(SHOWN) {
        let quantity = quantities.iter().find(|quantity| quantity.path == share.path);
        let mut cells = vec![
            in_words(&share.path),
            share.path.clone(),
            quantity.map_or_else(|| significant(share.std, 2), |quantity| known_to(quantity, share.std)),
        ];
        cells.extend(relative.iter().map(|effect| signed_percent(*effect)));
        table = table.row(cells);
    }
    let rest = effects.len().saturating_sub(SHOWN);
    table = table.footnote("Changes in percent of the element's magnitude.");
    if rest > 0 {
        table = table
            .footnote(format!("{rest} more have smaller effects on the stiffness; the ± hold them all."));
    }
    Some(section.paragraph(paragraph).table(table))
}

/// k11, k12, k22, c11, or k11 and c11 of a scalar joint.
fn watched(subject: &Subject) -> Vec<(Kind, Element)> {
    let scalar = subject.is_scalar();
    let mut watched: Vec<(Kind, Element)> = Element::distinct(scalar).map(|e| (Kind::Stiffness, e)).collect();
    watched.push((Kind::Damping, Element::all(scalar)[0]));
    watched
}

fn effect<'a>(
    subject: &Subject,
    share: &'a ToleranceShare,
    watched: &[(Kind, Element)],
) -> Option<Effect<'a>> {
    let changes: (RealMatrix2, RealMatrix2) = match subject.best.method {
        Method::MaximumLikelihood => share.likelihood?,
        Method::WeightedMean | Method::PlainMean => share.plain,
    };
    let relative = |&(kind, element): &(Kind, Element)| {
        element.of(&kind.of(changes)) / subject.best.figure(kind, element).value.abs()
    };
    Some(Effect { share, relative: watched.iter().map(relative).collect() })
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

fn known_to(quantity: &NamedQuantity, std: f64) -> String {
    let relative = || format!(" ({} %)", significant(100.0 * std / quantity.value.abs(), 2));
    let absolute = |unit: &str| {
        let scale = Scale::for_magnitude(std, unit);
        format!("{} {}", significant(scale.of(std), 2), scale.unit())
    };
    match quantity.nature {
        Nature::Abscissa => format!("{} mm", significant(std * 1e3, 2)),
        _ if quantity.value == 0.0 => significant(std, 2),
        Nature::Mass => absolute("kg") + &relative(),
        Nature::YoungsModulus => absolute("Pa") + &relative(),
        Nature::Inertia => format!("{} {}", significant(std, 2), typeset("kg*m^2")) + &relative(),
        _ => significant(std, 2) + &relative(),
    }
}

/// A path of the fixture file as one would say it.
fn in_words(path: &str) -> String {
    let between = |start: &str, end: &str| path.strip_prefix(start).and_then(|rest| rest.strip_suffix(end));
    let known: [(&str, &str, &str); 9] = [
        ("bodies/", "/mass", "mass of"),
        ("bodies/", "/inertia", "inertia of"),
        ("bodies/", "/x_cg", "centre of gravity of"),
        ("points/", "/x", "place of point"),
        ("joints/", "/beam/youngs_modulus", "Young's modulus of"),
        ("joints/", "/beam/second_moment", "second moment of area of"),
        ("supports/", "/stiffness", "stiffness of support"),
        ("supports/", "/damping", "dashpot of support"),
        ("supports/", "/rotational_stiffness", "rotational stiffness of support"),
    ];
    for (start, end, words) in known {
        if let Some(name) = between(start, end).filter(|name| !name.contains('/')) {
            return format!("{words} {name}");
        }
    }
    if let Some(index) = path.strip_prefix("damping/modal_ratios/").and_then(|i| i.parse::<usize>().ok()) {
        return format!("damping ratio of mode {}", index.saturating_add(1));
    }
    match path {
        "damping/loss_factor" => "loss factor".to_owned(),
        _ => path.rsplit('/').next().unwrap_or(path).replace('_', " "),
    }
}

/// How to know the quantity better that matters most.
fn advice(path: &str, quantities: &[NamedQuantity], fixture: &Fixture) -> String {
    let what = in_words(path);
    let nature = quantities.iter().find(|quantity| quantity.path == path).map(|quantity| quantity.nature);
    let how = match nature {
        Some(Nature::Abscissa) if path.ends_with("/x_cg") => {
            "balance the block on an edge, or take it from the drawing with the sensors' masses"
        }
        Some(Nature::Abscissa) if is_joint_end(path, fixture) => {
            "measure the joint's free length with a calliper and all other places from its ends"
        }
        Some(Nature::Abscissa) => {
            "measure sensors and hammer points from the joint's end with a calliper, and strike through a punch mark"
        }
        Some(Nature::Mass) => "weigh the block as tested, sensors and half of the cables included",
        Some(Nature::Inertia) => {
            "swing the block as a pendulum, or take it from the drawing with the sensors' masses"
        }
        Some(Nature::Support) => {
            "find it from the rigid-body frequencies of the hung assembly, or hang the assembly softer"
        }
        _ => "measure it by itself",
    };
    format!("What matters most is the {what}: to know the joint better, {how}.")
}

fn is_joint_end(path: &str, fixture: &Fixture) -> bool {
    let point = path.strip_prefix("points/").and_then(|rest| rest.strip_suffix("/x"));
    let index = point.and_then(|name| fixture.points().iter().position(|p| p.name == name));
    index.is_some_and(|index| fixture.joints().iter().any(|joint| joint.from == index || joint.to == index))
}
