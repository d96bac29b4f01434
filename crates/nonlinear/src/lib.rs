//! Joints whose stiffness or damping depends on amplitude.
mod distribution;
mod error;
mod identification;
mod time;
pub use error::{DiagnoseError, SimulationError};
pub use identification::diagnosis::{
    Estimate, Finding, HeldOut, ModelFit, NonlinearDiagnosis, NonlinearOptions, Reach, Verdict,
};
pub use identification::homogeneity::{CHANGED, Homogeneity};
pub use identification::parameters::Tolerance;
pub use time::law::{Memory, RestoringLaw};
pub use time::simulation::{Simulation, simulate};
