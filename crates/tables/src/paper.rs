//! The numbers of Tables 2–6 of "Estimation of Dynamic Stiffness Matrix of Welded or Glued Joints Using a
//! Laboratory Fixture", as printed.

/// How the strip of an example meets its blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointType {
    /// Milled from one piece.
    Integral,
    /// Welded.
    Welded,
    /// Glued with epoxy.
    Glued,
}

impl JointType {
    /// The word of the tables.
    pub fn name(self) -> &'static str {
        match self {
            JointType::Integral => "integral",
            JointType::Welded => "welded",
            JointType::Glued => "glued",
        }
    }
}

/// Elements (1,1), (1,2), (2,1), (2,2) of a printed matrix.
pub type Elements = [f64; 4];

/// Names of the elements in the order of [`Elements`].
pub(crate) const ELEMENTS: [&str; 4] = ["11", "12", "21", "22"];

/// Units in which Tables 2 and 3 print the elements of K, and what one of them is in SI.
pub const STIFFNESS_UNITS: [(&str, f64); 4] =
    [("MN/m", 1e6), ("kN/rad", 1e3), ("kN*m/m", 1e3), ("kN*m/rad", 1e3)];

/// Units of the elements of C in Tables 5 and 6. Table 6 prints kN/rad and kNm/m, which are units of
/// stiffness.
pub const DAMPING_UNITS: [(&str, f64); 4] =
    [("N*s/m", 1.0), ("N*s/rad", 1.0), ("N*s", 1.0), ("N*m*s/rad", 1.0)];

/// A row of Tables 2 and 3: magnitudes, in [`STIFFNESS_UNITS`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StiffnessRow {
    /// The example's name.
    pub example: &'static str,
    /// Its joint.
    pub joint: JointType,
    /// The analytical model.
    pub sim: Option<Elements>,
    /// Measured.
    pub exp: Option<Elements>,
    /// The finite-element model.
    pub fem: Option<Elements>,
}

/// A row of Tables 5 and 6, in [`DAMPING_UNITS`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DampingRow {
    /// The example's name.
    pub example: &'static str,
    /// What was put in, C_IN.
    pub input: Elements,
    /// What the analytical model gave back.
    pub sim: Elements,
    /// What the finite-element model gave back.
    pub fem: Option<Elements>,
}

/// Tables 2 and 3.
#[rustfmt::skip]
pub const STIFFNESS: [StiffnessRow; 11] = [
    StiffnessRow { example: "D0", joint: JointType::Integral, sim: Some([3.3, 107.9, 105.5, 3.5]), exp: Some([4.0, 109.5, 106.6, 4.0]), fem: Some([3.6, 83.1, 113.1, 12.0]) },
    StiffnessRow { example: "E0", joint: JointType::Integral, sim: Some([3.8, 141.2, 141.2, 9.7]), exp: None, fem: Some([3.9, 68.2, 129.2, 8.0]) },
    StiffnessRow { example: "E1", joint: JointType::Welded, sim: None, exp: Some([0.9, 22.4, 11.2, 0.6]), fem: Some([1.0, 20.1, 30.0, 2.3]) },
    StiffnessRow { example: "E2", joint: JointType::Welded, sim: None, exp: Some([0.7, 17.0, 9.9, 1.9]), fem: Some([0.7, 10.9, 17.0, 4.1]) },
    StiffnessRow { example: "E3", joint: JointType::Welded, sim: None, exp: Some([3.4, 53.4, 73.6, 3.1]), fem: Some([2.9, 54.6, 98.3, 13.2]) },
    StiffnessRow { example: "E4", joint: JointType::Welded, sim: None, exp: Some([1.3, 12.8, 23.4, 2.6]), fem: Some([1.0, 10.6, 22.7, 2.3]) },
    StiffnessRow { example: "E5", joint: JointType::Welded, sim: None, exp: Some([4.2, 122.0, 56.0, 8.5]), fem: Some([4.1, 96.9, 131.4, 12.2]) },
    StiffnessRow { example: "F01", joint: JointType::Integral, sim: Some([25.1, 308.6, 308.6, 2.8]), exp: Some([14.9, 138.1, 136.5, 10.2]), fem: Some([12.4, 243.2, 243.2, 13.7]) },
    StiffnessRow { example: "F1", joint: JointType::Glued, sim: None, exp: Some([0.8, 47.8, 45.4, 0.61]), fem: None },
    StiffnessRow { example: "F02", joint: JointType::Integral, sim: Some([0.5, 4.7, 4.7, 0.1]), exp: Some([0.5, 5.0, 4.1, 0.1]), fem: Some([0.4, 2.1, 3.9, 0.1]) },
    StiffnessRow { example: "F2", joint: JointType::Glued, sim: None, exp: Some([0.5, 4.8, 2.5, 0.2]), fem: None },
];

/// Tables 5 and 6. C_IN(1,2) of F2 is printed 0.01; its neighbours say 0.1.
#[rustfmt::skip]
pub const DAMPING: [DampingRow; 10] = [
    DampingRow { example: "D0", input: [1.5, 0.06, 0.06, 0.03], sim: [2.4, 0.05, 0.05, 0.03], fem: Some([2.4, 0.06, 0.03, 0.03]) },
    DampingRow { example: "E1", input: [3.2, 0.1, 0.1, 0.02], sim: [6.3, 0.2, 0.2, 0.2], fem: Some([2.0, 0.07, 0.06, 0.02]) },
    DampingRow { example: "E2", input: [1.7, 0.06, 0.06, 0.04], sim: [2.6, 0.05, 0.05, 0.04], fem: Some([0.8, 0.04, 0.02, 0.02]) },
    DampingRow { example: "E3", input: [1.3, 0.05, 0.05, 0.005], sim: [2.0, 0.07, 0.07, 0.005], fem: Some([1.8, 0.05, 0.05, 0.005]) },
    DampingRow { example: "E4", input: [2.2, 0.08, 0.08, 0.03], sim: [3.4, 0.09, 0.09, 0.03], fem: Some([1.3, 0.05, 0.03, 0.02]) },
    DampingRow { example: "E5", input: [0.9, 0.03, 0.03, 0.03], sim: [1.0, 0.02, 0.02, 0.04], fem: Some([1.5, 0.03, 0.03, 0.04]) },
    DampingRow { example: "F01", input: [8.9, 0.1, 0.1, 0.003], sim: [18.4, 0.2, 0.2, 0.002], fem: Some([16.7, 0.1, 0.2, 0.003]) },
    DampingRow { example: "F1", input: [175.0, 2.2, 2.2, 0.09], sim: [275.0, 3.2, 3.2, 0.12], fem: None },
    DampingRow { example: "F02", input: [1.0, 0.01, 0.01, 0.002], sim: [1.5, 0.01, 0.01, 0.002], fem: Some([1.3, 0.008, 0.006, 0.002]) },
    DampingRow { example: "F2", input: [7.9, 0.01, 0.01, 0.001], sim: [9.8, 0.1, 0.1, 0.001], fem: None },
];

/// Groups of Table 4: examples of equal blocks and strips.
pub(crate) const GROUPS: [&[&str]; 3] =
    [&["D0", "E0", "E1", "E2", "E3", "E4", "E5"], &["F01", "F1"], &["F02", "F2"]];

/// Table 4: for each group and element, the examples from the most compliant to the stiffest.
#[rustfmt::skip]
pub const RANKS: [[&[&str]; 4]; 3] = [
    [&["E2", "E1", "E4", "E3", "D0", "E0", "E5"], &["E4", "E2", "E1", "E3", "D0", "E5", "E0"], &["E2", "E1", "E4", "E3", "D0", "E5", "E0"], &["E1", "E2", "E4", "E3", "D0", "E0", "E5"]],
    [&["F1", "F01"], &["F1", "F01"], &["F1", "F01"], &["F1", "F01"]],
    [&["F02", "F2"], &["F2", "F02"], &["F2", "F02"], &["F02", "F2"]],
];

/// One of the paper's models, as Table 4 names them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Model {
    /// The analytical model, ①.
    Sim,
    /// Measured, ②.
    Exp,
    /// The finite-element model, ③.
    Fem,
}

use Model::{Exp, Fem, Sim};

impl Model {
    /// The word of the tables.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Model::Sim => "SIM",
            Model::Exp => "EXP",
            Model::Fem => "FEM",
        }
    }

    /// Its cells in a row of Tables 2 and 3.
    pub(crate) fn cells(self, row: &StiffnessRow) -> Option<Elements> {
        match self {
            Model::Sim => row.sim,
            Model::Exp => row.exp,
            Model::Fem => row.fem,
        }
    }
}

const ALL: &[Model] = &[Sim, Exp, Fem];
const BOTH: &[Model] = &[Exp, Fem];

/// Table 4, "model used to compare values": for each place of [`RANKS`], the models whose values were
/// compared.
#[rustfmt::skip]
pub const MODELS_USED: [[&[&[Model]]; 4]; 3] = [
    [
        &[BOTH, BOTH, BOTH, BOTH, ALL, &[Sim, Fem], BOTH],
        &[BOTH, BOTH, BOTH, BOTH, ALL, BOTH, &[Sim]],
        &[BOTH, &[Exp], BOTH, BOTH, ALL, &[Fem], &[Sim, Fem]],
        &[BOTH, BOTH, &[Exp], &[Exp], BOTH, &[Fem], &[Exp]],
    ],
    [&[&[Exp], ALL], &[&[Exp], ALL], &[&[Exp], ALL], &[&[Exp], ALL]],
    [&[ALL, &[Exp]], &[&[Exp], ALL], &[&[Exp], ALL], &[ALL, &[Exp]]],
];

/// An element of an example in one of the places of Table 4: the smallest and the largest of the values that
/// were compared, in the units of Tables 2 and 3; `None` where a model that is said to have been used has
/// none.
pub fn compared(group: usize, element: usize, place: usize) -> Option<[f64; 2]> {
    let example = RANKS[group][element].get(place)?;
    let row = STIFFNESS.iter().find(|row| row.example == *example)?;
    let models = MODELS_USED[group][element].get(place)?;
    let values = models.iter().map(|model| Some(model.cells(row)?[element]));
    let values: Vec<f64> = values.collect::<Option<_>>()?;
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(0.0, f64::max);
    Some([low, high])
}
