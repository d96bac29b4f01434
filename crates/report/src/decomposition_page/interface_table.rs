//! The joint's interfaces: what its ends add to its beam (eq 6).

use jointscope_decomposition::{Compliance, InterfaceStiffness, Method};

use super::subject::Subject;
use crate::format::{interval, magnitude, quantity, significant};
use crate::section::Section;
use crate::table::Table;
use crate::unit::{Scale, typeset};

/// Nothing for a joint that is no beam: it has no ends of its own.
pub(super) fn section(subject: &Subject) -> Option<Section> {
    let interfaces = subject.analysis.interfaces.as_ref()?;
    let joint = subject.joint()?;
    let name = |point: usize| subject.fixture.points().get(point).map_or("", |p| p.name.as_str());
    let (near, far) = (name(joint.from), name(joint.to));
    let matrix = [
        (format!("Translation at points {near} and {far} together"), interfaces.translation, TRANSLATION),
        (format!("Rotation at point {near} (near end)"), interfaces.near_rotation, ROTATION),
        (format!("Rotation at point {far} (far end)"), interfaces.far_rotation, ROTATION),
    ];
    let scalar = [
        ("(1,1)".to_owned(), interfaces.scalar[0], TRANSLATION),
        ("(2,2)".to_owned(), interfaces.scalar[1], ROTATION),
    ];
    let matrix = table("Interface", matrix)
        .caption("In matrix form: k_J⁻¹ − k_E⁻¹, each interface seen through its own R")
        .footnote(
            "The two translations act on one displacement, so no test of this kind can tell them apart; the value is that of both in series.",
        );
    let scalar = table("Element", scalar)
        .caption("Element by element, as in eq (6): 1/k_I = 1/k_J − 1/k_E, both interfaces together");
    let (source, explains) = subject.analysis.interfaces_rest_on()?;
    let from = match source {
        Method::AllFrfs => "the joint from all FRFs",
        _ => "the joint from the FRFs across it",
    };
    let section = Section::new("Interfaces").paragraph(format!(
        "What glue, weld or bolts at the joint's two ends add to the beam between them, by the stiffness of {from}; \
         intervals hold noise and tolerances, the beam's own EI and length included.",
    ));
    let unexplained = (!explains).then_some(
        "No fit explains these FRFs within noise and tolerances. What the model gets wrong passes into the interfaces, which are small differences: \
         read them as orders of magnitude.",
    );
    let wrong = [interfaces.translation, interfaces.near_rotation, interfaces.far_rotation]
        .iter()
        .any(|c| c.stiffness() == InterfaceStiffness::StifferThanTheBeam);
    let warning = wrong.then_some(
        "A negative compliance says that the joint is stiffer than the beam it is said to be: EI, the free length or a place in \
         the fixture file is off, or the interfaces cannot be told apart as modelled. Read the other interfaces with that in mind.",
    );
    Some(section.warnings(unexplained).with(matrix).warnings(warning).with(scalar))
}

/// Units of a stiffness and of its compliance.
type Units = (&'static str, &'static str);
const TRANSLATION: Units = ("N/m", "m/N");
const ROTATION: Units = ("N*m/rad", "rad/(N*m)");

/// The unit of a stiffness and of its interval, whose upper end may lie far off.
fn scale(stiffness: f64, ends: [f64; 2], unit: &str) -> Scale {
    let near = ends.into_iter().filter(|end| *end < 1e3 * stiffness);
    Scale::for_values(near.chain([stiffness]), unit)
}

/// Name, compliance and units.
type Row = (String, Compliance, Units);

fn table(heading: &str, rows: impl IntoIterator<Item = Row>) -> Table<Row> {
    Table::of(rows)
        .words(heading, |(name, ..)| name.clone())
        .words("Stiffness", |(_, compliance, (unit, _))| match compliance.stiffness() {
            InterfaceStiffness::Found { stiffness, interval } => {
                let scale = scale(stiffness, interval, unit);
                format!("{} {}", significant(scale.of(stiffness), 3), scale.unit())
            }
            InterfaceStiffness::StifferThan { .. } => "stiffer than this test can see".to_owned(),
            InterfaceStiffness::StifferThanTheBeam => {
                "none: the joint is stiffer than the beam it is said to be".to_owned()
            }
        })
        .words("95 % interval", |(_, compliance, (unit, _))| match compliance.stiffness() {
            InterfaceStiffness::Found { stiffness, interval: ends } => {
                interval(ends, &scale(stiffness, ends, unit), 3)
            }
            InterfaceStiffness::StifferThan { above } => format!("above {}", magnitude(above, unit, 3)),
            InterfaceStiffness::StifferThanTheBeam => "–".to_owned(),
        })
        .words("Compliance", |(_, compliance, (_, unit))| {
            format!("{} {}", quantity(compliance.value, compliance.std, "1"), typeset(unit))
        })
}
