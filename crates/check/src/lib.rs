//! What a fixture and its recordings are like, before any diagnosis.
//!
//! A fixture of one's own is full of slips: grams, millimetres, a sensor turned round, a point on the wrong
//! body. All of them look like physics to a diagnosis. Here they are looked for one by one, in an instant,
//! and said with the number that gave them away.
//!
//! * [`Totals`]: mass, centre of gravity and inertia of the whole, to be held against scales and a drawing;
//! * [`ModelModes`]: natural frequencies and damping ratios, rigid-body modes counted, with the deviations
//!   that the fixture's tolerances leave them;
//! * [`Number`]: every number of the file with unit and deviation, and what it means: a second moment as a
//!   section, a modulus as a material;
//! * [`RecordingCheck`]: every FRF and channel of a recording: noise, coherence, distance from the fixture's
//!   FRFs, [`DrivingPoint`]s, [`Reciprocity`], the [`MassLine`], modes side by side, and what `screening`
//!   finds and a diagnosis would put right;
//! * [`Remark`]: what is odd, one plain sentence each. Everything is decided here: files, pages and the
//!   terminal show it.
//!
//! ```
//! use jointscope_check::{Check, CheckOptions};
//! use jointscope_fixture::Fixture;
//!
//! let fixture = Fixture::from_json(r#"{
//!   "bodies": { "A": { "mass": 2.0, "inertia": 1.5e-3, "x_cg": -0.04 }, "B": { "mass": 3.0, "inertia": 2e-3, "x_cg": 0.1 } },
//!   "points": { "1": { "body": "A", "x": -0.08 }, "2": { "body": "A", "x": 0 }, "3": { "body": "B", "x": 0.06 } },
//!   "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2.07e11, "second_moment": 9e-10 } } },
//!   "damping": { "modal_ratios": [0.003] } }"#)?;
//! let check = Check::of(&fixture, None, &CheckOptions::default())?;
//! assert_eq!((check.totals.mass.value, check.modes.as_ref().map(|modes| modes.rigid)), (5.0, Some(2)));
//! assert!(check.remarks.is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod channels;
mod driving_point;
mod figure;
mod frfs;
mod mass_line;
mod meaning;
mod model_modes;
mod numbers;
mod over_time;
mod parts;
mod reciprocity;
mod recorded_modes;
mod recording;
mod remark;
mod settings;
mod totals;

pub use channels::ChannelCheck;
pub use driving_point::{DrivingPoint, DrivingPointVerdict};
pub use figure::Figure;
pub use frfs::{Coherence, FrfCheck};
pub use mass_line::{MassLine, MassLineFrf};
pub use model_modes::{ModelMode, ModelModes};
pub use numbers::{Known, Number};
pub use reciprocity::Reciprocity;
pub use recorded_modes::{ModePair, RecordedModes};
pub use recording::{RecordingCheck, fixture_frfs};
pub use remark::{Remark, Weight};
pub use totals::{MassPart, Totals};

use jointscope_estimation::{EstimateOptions, ResponseWindow};
use jointscope_fixture::{Damping, Fixture};
use jointscope_pipeline::{Error, Measurement};
use serde::Serialize;

/// How FRFs follow from hits, where a recording holds hits.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckOptions {
    /// As for a diagnosis.
    pub estimate: EstimateOptions,
}

impl Default for CheckOptions {
    fn default() -> Self {
        let estimate = EstimateOptions {
            response_window: ResponseWindow::Auto,
            zero_padding: 1,
            ..EstimateOptions::default()
        };
        CheckOptions { estimate }
    }
}

/// What there is to say of a fixture, and of its recording if there is one.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Check {
    /// The fixture's name.
    pub name: String,
    /// What is odd, the worst first.
    pub remarks: Vec<Remark>,
    /// Mass, centre of gravity and inertia.
    pub totals: Totals,
    /// The model's modes; `None` where it has none, which a remark explains.
    pub modes: Option<ModelModes>,
    /// Every number of the file.
    pub numbers: Vec<Number>,
    /// The recording.
    pub recording: Option<RecordingCheck>,
}

impl Check {
    /// Looks at a fixture, and at what a test of it recorded.
    ///
    /// # Errors
    /// A recording of which there are no FRFs: hits that excite nothing, FRFs without any signal. What is odd
    /// is no error.
    pub fn of(
        fixture: &Fixture,
        measurement: Option<&Measurement>,
        options: &CheckOptions,
    ) -> Result<Self, Error> {
        let mut remarks: Vec<Remark> = jointscope_screening::implausible(fixture)
            .into_iter()
            .map(|slip| {
                let says = format!(
                    "{}{}; correct it, or insist on it with `diagnose --as-stated`",
                    slip.problem, slip.advice
                );
                Remark::wrong(slip.place, says)
            })
            .collect();
        remarks.extend(parts::apart(fixture));
        let numbers = numbers::of(fixture, &mut remarks);
        // What is wrong in itself need not be called odd besides, number by number; of a channel or an FRF
        // both may be true.
        let wrong: Vec<String> = remarks
            .iter()
            .filter(|remark| remark.weight == Weight::Wrong)
            .map(|remark| remark.place.clone())
            .collect();
        remarks.retain(|remark| remark.weight == Weight::Wrong || !wrong.contains(&remark.place));
        let totals = Totals::of(fixture);
        let mut recording = measurement
            .map(|measurement| RecordingCheck::of(fixture, measurement, options, &mut remarks))
            .transpose()?;
        let highest = recording.as_ref().map(RecordingCheck::highest);
        let modes = match ModelModes::of(fixture, highest) {
            Ok(modes) => Some(modes),
            Err(error) => {
                remarks.push(Remark::wrong("bodies", format!("the model has no modes: {error}")));
                None
            }
        };
        if let (Some(recording), Some(modes)) = (&mut recording, &modes) {
            recording.compare(fixture, &totals, modes, &mut remarks);
        }
        if let Some(recording) = &recording {
            recording.contradictions(fixture, modes.as_ref(), &mut remarks);
        }
        if *fixture.damping() == Damping::Undamped && !has_dashpots(fixture) {
            remarks.push(Remark::odd(
                "damping",
                "none is stated: state `modal_ratios`, or measure them with `jointscope modes --fixture … --update …`; a diagnosis fits them without knowing anything of them",
            ));
        }
        remarks.sort_by_key(|remark| remark.weight);
        Ok(Check { name: fixture.name().to_owned(), remarks, totals, modes, numbers, recording })
    }

    /// What it comes to, in a few words.
    pub fn headline(&self) -> String {
        let wrong = self.remarks.iter().filter(|remark| remark.weight == Weight::Wrong).count();
        let odd = self.remarks.len() - wrong;
        let of = if self.recording.is_some() { "fixture and recording" } else { "the fixture" };
        match (wrong, odd) {
            (0, 0) => format!("Nothing odd in {of}"),
            (0, odd) => format!("{} to look at in {of}", things(odd)),
            (wrong, 0) => format!("{} wrong in {of}", things(wrong)),
            (wrong, odd) => format!("{} wrong and {} to look at in {of}", things(wrong), things(odd)),
        }
    }
}

fn things(count: usize) -> String {
    if count == 1 { "1 thing".to_owned() } else { format!("{count} things") }
}

/// Whether supports or joints have dashpots of their own.
pub(crate) fn has_dashpots(fixture: &Fixture) -> bool {
    use jointscope_fixture::JointLaw;
    let of_supports = |s: &jointscope_fixture::Support| s.damping.is_some() || s.rotational_damping.is_some();
    fixture.supports().iter().any(of_supports)
        || fixture.joints().iter().any(|j| matches!(j.law, JointLaw::Stiffness { damping: Some(_), .. }))
}
