//! The joint's interfaces line by line.

use jointscope_decomposition::{InterfaceLine, InterfaceSpectrum, LineCompliance, LineInterface, LineSpring};
use num_complex::Complex64;
use serde::Serialize;

use super::masked::MaskedLine;

/// The interfaces by line: what the beam leaves of the joint's compliance, and the springs and dashpots
/// behind it.
#[derive(Serialize)]
pub(super) struct InterfacesByLine {
    lines: Vec<LineOfInterfaces>,
    masked: Vec<MaskedLine>,
    mass: f64,
    within_noise: WithinNoise,
    asymmetry_chi2_per_dof: Option<f64>,
}

/// Lines that tell no stiffness.
#[derive(Serialize)]
struct WithinNoise {
    translation_both: usize,
    rotation_from: usize,
    rotation_to: usize,
}

#[derive(Serialize)]
struct LineOfInterfaces {
    frequency: f64,
    compliance: [[[f64; 2]; 2]; 2],
    compliance_std: Option<[[f64; 2]; 2]>,
    translation_both: Interface,
    rotation_from: Interface,
    rotation_to: Interface,
    asymmetry_chi2: Option<f64>,
}

#[derive(Serialize)]
struct Interface {
    compliance: [f64; 2],
    compliance_std: Option<f64>,
    compliance_std_fixture: [f64; 2],
    #[serde(flatten)]
    spring: Option<Spring>,
}

#[derive(Serialize)]
struct Spring {
    stiffness: f64,
    damping: f64,
    std: Option<SpringStd>,
    std_fixture: SpringStd,
}

#[derive(Serialize)]
struct SpringStd {
    stiffness: f64,
    damping: f64,
}

impl InterfacesByLine {
    /// `frequencies` are those of the recording's lines, Hz.
    pub(super) fn of(found: &InterfaceSpectrum, frequencies: &[f64]) -> Self {
        let [translation_both, rotation_from, rotation_to] = found.within_noise();
        let masked = found.masked.iter();
        InterfacesByLine {
            lines: found.lines.iter().map(LineOfInterfaces::of).collect(),
            masked: masked
                .map(|&(line, why)| MaskedLine { frequency: frequencies[line], why: why.why() })
                .collect(),
            mass: found.mass,
            within_noise: WithinNoise { translation_both, rotation_from, rotation_to },
            asymmetry_chi2_per_dof: found.asymmetry(),
        }
    }
}

impl LineOfInterfaces {
    fn of(line: &InterfaceLine) -> Self {
        let [translation, coupling, rotation] = line.compliance.map(|element| parts(element.value));
        let std = line.compliance.map(|LineCompliance { std, .. }| std);
        LineOfInterfaces {
            frequency: line.frequency,
            compliance: [[translation, coupling], [coupling, rotation]],
            compliance_std: match std {
                [Some(a), Some(b), Some(d)] => Some([[a, b], [b, d]]),
                _ => None,
            },
            translation_both: Interface::of(&line.translation),
            rotation_from: Interface::of(&line.near_rotation),
            rotation_to: Interface::of(&line.far_rotation),
            asymmetry_chi2: line.asymmetry,
        }
    }
}

impl Interface {
    fn of(interface: &LineInterface) -> Self {
        let compliance = interface.compliance;
        Interface {
            compliance: parts(compliance.value),
            compliance_std: compliance.std,
            compliance_std_fixture: compliance.std_fixture(),
            spring: interface.spring.map(Spring::of),
        }
    }
}

impl Spring {
    fn of(spring: LineSpring) -> Self {
        let std = |(stiffness, damping)| SpringStd { stiffness, damping };
        Spring {
            stiffness: spring.stiffness,
            damping: spring.damping,
            std: spring.std.map(std),
            std_fixture: std(spring.std_fixture),
        }
    }
}

fn parts(value: Complex64) -> [f64; 2] {
    [value.re, value.im]
}
