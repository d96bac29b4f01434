//! Joints whose stiffness or damping depends on amplitude.
mod error;
mod time;
pub use error::SimulationError;
pub use time::law::{Memory, RestoringLaw};
pub use time::simulation::{Simulation, simulate};
