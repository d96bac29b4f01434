//! The structure itself: coordinates, elements and their laws, and how a fixture becomes one.
//!
//! A [`Structure`] is built of [`Assembly`] elements: every element acts on [`Station`]s, and a station says
//! how the transverse motion and the rotation of a place follow from the coordinates. Rigid constraints are
//! thereby eliminated exactly.

mod assembly;
mod bar_mode;
mod beam_element;
mod body;
mod damping;
mod joint;
mod mesh;
mod station;
mod structure;

pub use assembly::{Assembly, Law};
pub(crate) use bar_mode::{BodyMode, FIRST_TO_SECOND, Order};
pub use beam_element::BeamElement;
pub(crate) use damping::{RIGID, add_viscous};
pub use station::{Row, Station};
pub use structure::Structure;
pub(crate) use structure::window_decay;
