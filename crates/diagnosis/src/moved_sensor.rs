//! A sensor that loads the structure where it is and is moved, or sits at one response alone, told by what no
//! error of a model imitates: natural frequencies that differ from response to response.
//!
//! A sensor of mass m at a point where mode k has the mass-normalised shape φ lowers its frequency by about
//! ½mφ², in the FRFs of that response and in no other. The poles that all FRFs share are then of no structure,
//! and whatever a comparison by modes names stands for that. What one response shows beside another is free of
//! the model's own error, for that is the same in both:
//!
//! * [`by_response`] fits the FRFs of each response by themselves and pairs their modes with the model's;
//! * [`told`] asks which sensor's mass makes the differences between responses, and how surely;
//! * [`unloaded`] takes the sensor off the recording, H·(1 + m·A) with the accelerance A where it sits, so
//!   that everything else is judged without it;
//! * [`stated`] does so with sensors that the fixture states, before anything else;
//! * [`beside`] puts it back beside what was found then.

mod beside;
mod by_response;
mod stated;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
mod told;
mod unloaded;

pub(crate) use stated::WithoutSensors;
pub(crate) use told::MovedSensor;
