//! The elements of K and C as they are written.

use jointscope_decomposition::{DynamicStiffnessPart, MatrixElement, Method};

const INDICES: [[&str; 2]; 2] = [["₁₁", "₁₂"], ["₂₁", "₂₂"]];
const STIFFNESS_UNITS: [[&str; 2]; 2] = [["N/m", "N/rad"], ["N*m/m", "N*m/rad"]];
const DAMPING_UNITS: [[&str; 2]; 2] = [["N*s/m", "N*s/rad"], ["N*s", "N*m*s/rad"]];

/// Its indices in small figures.
pub fn index(element: MatrixElement) -> &'static str {
    INDICES[element.row][element.column]
}

/// `k₁₁`, or `K₁₁` for what eq (7) gives.
pub fn symbol(part: DynamicStiffnessPart, element: MatrixElement, paper: bool) -> String {
    let letter = if paper { part.of(("K", "C")) } else { part.of(("k", "c")) };
    format!("{letter}{}", index(element))
}

/// Its unit, SI.
pub fn unit(part: DynamicStiffnessPart, element: MatrixElement) -> &'static str {
    part.of((STIFFNESS_UNITS, DAMPING_UNITS))[element.row][element.column]
}

/// What the element connects, in words.
pub fn meaning(part: DynamicStiffnessPart, element: MatrixElement) -> String {
    let load = ["force", "moment"][element.row];
    let motion = part.of((["displacement", "rotation"], ["velocity", "angular velocity"]))[element.column];
    format!("{load} per {motion}")
}

/// Where an estimate comes from, in words; `exact`: the fit moved nothing of the fixture.
pub fn method(method: Method, exact: bool) -> &'static str {
    match method {
        Method::PlainMean => "plain mean over the band",
        Method::WeightedMean => "weighted mean over the band",
        Method::MaximumLikelihood => "maximum likelihood from the FRFs across it",
        Method::AllFrfs if exact => "all FRFs, the fixture taken as exact",
        Method::AllFrfs => "all FRFs, the fixture moving within its tolerances",
    }
}
