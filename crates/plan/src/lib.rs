//! What to measure next.
//!
//! A diagnosis may leave several names for one finding, and an identified joint an interval that is too wide.
//! Which measurement settles that can be computed before it is made: every name that is left predicts it,
//! with the covariance of what is not known of the name's parameters and of the fixture's quantities.
//!
//! 1. **Names.** [`Remaining`] is what a diagnosis has left open. Each name is fitted to the present FRFs;
//!    the information of these, priors included, is what is known beforehand.
//! 2. **Candidates.** [`Measure`]: every FRF between the fixture's points, more averages, a known mass, the
//!    structure off its supports, a quantity weighed or measured by itself.
//! 3. **Noise.** A floor and a share of |H| as the present recording has them; an error of the model counts
//!    as noise where names were weighed with one.
//! 4. **Worth.** By each name a measurement is normal about what it predicts. Expected ln of the Bayes factor
//!    (Kullback–Leibler divergence, both ways), Box and Hill's gain, and by draws the probability that the
//!    diagnosis then is sure of the true name: all from products of columns, nothing as long as the
//!    measurement.
//! 5. **Ranking.** [`Plan::between`] lists [`Suggestion`]s, the promise first, then the effort;
//!    [`Plan::for_interval`] does the same for the interval of a joint's element.
//!
//! [`weighed_by`] puts two tests of one structure in different states together. `prove --plan` measures how
//! often promises are kept.
//!
//! ```
//! use jointscope_fixture::Fixture;
//! use jointscope_plan::{Plan, PlanOptions, Start};
//! use jointscope_spectra::SpectralLines;
//!
//! // Which FRF tells most of the stiffness between two blocks, before anything is measured?
//! let fixture = Fixture::from_json(include_str!("../../../fixtures/two-blocks/fixture.json"))?;
//! let lines = SpectralLines::even(5.0, 5.0, 200)?;
//! let wanted = "J/k11=1%".parse()?;
//! let plan = Plan::for_interval(&fixture, &Start::Lines(&lines), &wanted, &PlanOptions::default())?;
//! let first = &plan.suggestions[0];
//! assert!(first.interval.as_ref().is_some_and(|interval| interval.then > 0.0), "{}", first.says);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod candidates;
mod error;
mod expected_noise;
mod further;
mod joint;
mod measure;
mod model_error;
mod names;
mod plan;
mod planned_test;
mod products;
mod rivals;
mod says;
mod settings;
mod suggestion;

pub use error::PlanError;
pub use further::{Weighed, weighed_by};
pub use joint::{HalfWidth, Start, Wanted};
pub use measure::Measure;
pub use names::{NameNow, Remaining, WeighedName};
pub use plan::{FrfGain, Plan, PlanOptions};
pub use settings::outcome::{BEYOND_DOUBT, SURE};
pub use suggestion::{ExpectedInterval, Suggestion};
