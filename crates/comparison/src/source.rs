//! Where the FRFs of a joint come from.

use serde::Serialize;

/// Where the FRFs come from that a joint was taken out of: the paper's columns SIM, EXP and FEM (Table 1). No
/// file says it, whoever compares does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// A lumped model (SIM).
    Simulation,
    /// A test (EXP).
    Measurement,
    /// A finite-element model (FEM).
    FiniteElements,
}

impl Source {
    /// All of them.
    pub const ALL: [Source; 3] = [Source::Simulation, Source::Measurement, Source::FiniteElements];

    /// `sim`, `exp` or `fem`, after the paper's columns.
    pub fn short(self) -> &'static str {
        match self {
            Source::Simulation => "sim",
            Source::Measurement => "exp",
            Source::FiniteElements => "fem",
        }
    }

    /// Whether nothing was measured.
    pub fn is_model(self) -> bool {
        self != Source::Measurement
    }
}
