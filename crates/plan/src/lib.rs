//! What to measure next.

mod candidates;
mod error;
mod expected_noise;
mod further;
mod joint;
mod measure;
mod names;
mod plan;
mod products;
mod rivals;
mod says;
mod scene;
mod softening;
mod suggestion;

pub use error::PlanError;
pub use further::weighed_by;
pub use joint::{HalfWidth, Start, Wanted};
pub use measure::Measure;
pub use names::Remaining;
pub use plan::{FrfGain, NameNow, Plan, PlanOptions};
pub use suggestion::{ExpectedInterval, Suggestion};
