//! The joint's interfaces.

use jointscope_decomposition::{Analysis, Compliance, InterfaceStiffness, Interfaces, Method};
use serde::Serialize;

/// The joint's interfaces, and the fit that they are taken from.
#[derive(Serialize)]
pub(super) struct InterfaceEntries {
    rest_on: Option<RestOn>,
    translation_both: InterfaceEntry,
    rotation_from: InterfaceEntry,
    rotation_to: InterfaceEntry,
    scalar_11: InterfaceEntry,
    scalar_22: InterfaceEntry,
}

#[derive(Serialize)]
struct RestOn {
    fit: Method,
    explains_the_frfs: bool,
}

#[derive(Serialize)]
struct InterfaceEntry {
    #[serde(flatten)]
    stiffness: StiffnessEntry,
    unit: &'static str,
    compliance: Compliance,
}

/// An interface's stiffness, as far as its compliance tells one.
#[derive(Serialize)]
#[serde(untagged)]
enum StiffnessEntry {
    Found { stiffness: f64, ci95: [f64; 2] },
    StifferThan { above: f64 },
    StifferThanTheBeam { says: &'static str },
}

impl InterfaceEntries {
    pub(super) fn of(analysis: &Analysis, found: &Interfaces) -> Self {
        let rest_on = |(fit, explains_the_frfs)| RestOn { fit, explains_the_frfs };
        InterfaceEntries {
            rest_on: analysis.interfaces_rest_on().map(rest_on),
            translation_both: InterfaceEntry::of(found.translation, "N/m"),
            rotation_from: InterfaceEntry::of(found.near_rotation, "N*m/rad"),
            rotation_to: InterfaceEntry::of(found.far_rotation, "N*m/rad"),
            scalar_11: InterfaceEntry::of(found.scalar[0], "N/m"),
            scalar_22: InterfaceEntry::of(found.scalar[1], "N*m/rad"),
        }
    }
}

impl InterfaceEntry {
    fn of(compliance: Compliance, unit: &'static str) -> Self {
        let stiffness = match compliance.stiffness() {
            InterfaceStiffness::Found { stiffness, interval } => {
                StiffnessEntry::Found { stiffness, ci95: interval }
            }
            InterfaceStiffness::StifferThan { above } => StiffnessEntry::StifferThan { above },
            InterfaceStiffness::StifferThanTheBeam => StiffnessEntry::StifferThanTheBeam {
                says: "the joint is stiffer than the beam it is said to be",
            },
        };
        InterfaceEntry { stiffness, unit, compliance }
    }
}
