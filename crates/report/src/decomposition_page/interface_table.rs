//! The joint's interfaces: what its ends add to its beam (eq 6).

use jointscope_decomposition::{Compliance, InterfaceStiffness};

use super::Subject;
use crate::format::significant;
use crate::{Column, Scale, Section, Table, typeset};

/// Nothing for a joint that is no beam: it has no ends of its own.
pub(super) fn section(subject: &Subject) -> Option<Section> {
    let interfaces = subject.analysis.interfaces.as_ref()?;
    let joint = subject.joint()?;
    let name = |point: usize| subject.fixture.points().get(point).map_or("", |p| p.name.as_str());
    let (near, far) = (name(joint.from), name(joint.to));
    let columns = [
        Column::text("Interface"),
        Column::text("Stiffness"),
        Column::text("95 % interval"),
        Column::text("Compliance"),
    ];
    let mut table =
        Table::new(columns).caption("In matrix form: k_J⁻¹ − k_E⁻¹, each interface seen through its own R");
    let rows = [
        (format!("Translation at points {near} and {far} together"), interfaces.translation, TRANSLATION),
        (format!("Rotation at point {near} (near end)"), interfaces.near_rotation, ROTATION),
        (format!("Rotation at point {far} (far end)"), interfaces.far_rotation, ROTATION),
    ];
    for (name, compliance, units) in rows {
        table = table.row(row(name, compliance, units));
    }
    table = table.footnote(
        "The two translations act on one displacement, so no test of this kind can tell them apart; the value is that of both in series.",
    );
    let columns = [
        Column::text("Element"),
        Column::text("Stiffness"),
        Column::text("95 % interval"),
        Column::text("Compliance"),
    ];
    let mut scalar = Table::new(columns)
        .caption("Element by element, as in eq (6): 1/k_I = 1/k_J − 1/k_E, both interfaces together");
    for (name, compliance, units) in
        [("(1,1)", interfaces.scalar[0], TRANSLATION), ("(2,2)", interfaces.scalar[1], ROTATION)]
    {
        scalar = scalar.row(row(name.to_owned(), compliance, units));
    }
    let section = Section::new("Interfaces").paragraph(
        "What glue, weld or bolts at the joint's two ends add to the beam between them, from the maximum-likelihood stiffness; \
         intervals hold noise and tolerances, the beam's own EI and length included.",
    );
    let wrong = [interfaces.translation, interfaces.near_rotation, interfaces.far_rotation]
        .iter()
        .any(|c| c.stiffness() == InterfaceStiffness::StifferThanTheBeam);
    let warning = wrong.then_some(
        "A negative compliance says that the joint is stiffer than the beam it is said to be: EI, the free length or a place in \
         the fixture file is off, or the interfaces cannot be told apart as modelled. Read the other interfaces with that in mind.",
    );
    Some(section.table(table).warnings(warning).table(scalar))
}

/// Units of a stiffness and of its compliance.
type Units = (&'static str, &'static str);
const TRANSLATION: Units = ("N/m", "m/N");
const ROTATION: Units = ("N*m/rad", "rad/(N*m)");

fn row(name: String, compliance: Compliance, (stiffness_unit, compliance_unit): Units) -> [String; 4] {
    let short = |value: f64| {
        let scale = Scale::for_magnitude(value, stiffness_unit);
        format!("{} {}", significant(scale.of(value), 3), scale.unit())
    };
    let (stiffness, interval) = match compliance.stiffness() {
        InterfaceStiffness::Found { stiffness, interval: [low, high] } => {
            let scale = Scale::for_magnitude(low, stiffness_unit);
            let text = |value: f64| significant(scale.of(value), 3);
            (short(stiffness), format!("{} to {} {}", text(low), text(high), scale.unit()))
        }
        InterfaceStiffness::StifferThan { above } => {
            ("stiffer than this test can see".into(), format!("above {}", short(above)))
        }
        InterfaceStiffness::StifferThanTheBeam => {
            ("none: the joint is stiffer than the beam it is said to be".into(), "–".into())
        }
    };
    let compliance = format!("{} {}", powers(compliance.value, compliance.std), typeset(compliance_unit));
    [name, stiffness, interval, compliance]
}

/// `(1.2 ± 0.3)×10⁻⁸`.
fn powers(value: f64, std: f64) -> String {
    crate::format::quantity(value, std, "1")
}
