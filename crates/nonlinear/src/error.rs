//! Why motion over time cannot be computed, or a law not identified.

use crate::settings::levels::{FEWEST_LINES, LEAST_RATIO};
use jointscope_hits::HitError;
use jointscope_lumped::LumpedError;

/// Why a channel cannot be read or struck.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ChannelError {
    /// It names a point that the fixture does not have.
    #[error("the fixture has no point `{point}` (it has {known})")]
    UnknownPoint {
        /// The missing point.
        point: String,
        /// The points there are.
        known: String,
    },
    /// A rotation or moment at a point of a body that does not rotate.
    #[error("point `{0}` sits on a body that does not rotate")]
    NoRotation(String),
}

/// Why motion over time cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// The assembly cannot be modelled over time.
    #[error(transparent)]
    Model(#[from] LumpedError),
    /// A channel is impossible.
    #[error(transparent)]
    Channel(#[from] ChannelError),
    /// More amplitude-dependent effects than there is room for: their number, and the most there may be.
    #[error(
        "the fixture has {0} effects that depend on amplitude: {1} at the most can be simulated together"
    )]
    TooManyElements(usize, usize),
    /// More modes within the sampled band than there is room for.
    #[error(
        "{modes} modes lie within the band that the force's sampling rate asks for, and {most} at the most can be followed: give the force at a lower rate"
    )]
    TooManyStates {
        /// Number of modes.
        modes: usize,
        /// The most there is room for.
        most: usize,
    },
    /// A roving sensor's mass, at this channel.
    #[error(
        "physics: `sensor_mass` at {0} is there only while that response is measured, but here all responses are simulated at once; state it as an `added_mass`"
    )]
    SensorMass(String),
    /// The motion grows beyond all bounds.
    #[error(
        "hit {hit}: the motion grows beyond all bounds; check the signs of stiffness and mass in `physics`"
    )]
    Unbounded {
        /// The hit's number.
        hit: u32,
    },
    /// The simulated signals do not form a hit.
    #[error(transparent)]
    Hit(#[from] HitError),
}

/// Why hits cannot be diagnosed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DiagnoseError {
    /// No hits.
    #[error("there are no hits: time histories of force and response are needed")]
    NoHits,
    /// The hit of this number has no force.
    #[error("hit {0} has no force: its force channel is zero throughout")]
    NoForce(u32),
    /// The hit of this number has no response.
    #[error("hit {0} has a force and no response: at least one acceleration is needed")]
    NoResponse(u32),
    /// A response that is zero throughout.
    #[error("hit {hit}: the response at {channel} is zero throughout; leave the dead channel out")]
    SilentResponse {
        /// The hit's number.
        hit: u32,
        /// The channel.
        channel: String,
    },
    /// A hit too short for spectra.
    #[error("hit {hit} has {samples} samples: {needed} at the least are needed")]
    TooShort {
        /// The hit's number.
        hit: u32,
        /// Its samples.
        samples: usize,
        /// Samples needed.
        needed: usize,
    },
    /// A channel of the hit of this number is impossible.
    #[error("hit {0}: {1}")]
    Channel(u32, #[source] ChannelError),
    /// Hits of one strength only.
    #[error(
        "all {hits} hits are of one strength (at each point the strongest is {ratio:.2} times the weakest): whether anything depends on amplitude cannot be judged; strike at two or more strengths that differ by a factor of 2 or more"
    )]
    OneLevel {
        /// Number of hits.
        hits: usize,
        /// Strongest over weakest.
        ratio: f64,
    },
    /// Nothing elastic below this frequency in Hz, half of the sampling rate.
    #[error("no elastic motion of the fixture lies below {0} Hz, half of the sampling rate: sample faster")]
    NoElasticMotion(f64),
    /// The fixture's motion is not finite.
    #[error("the fixture's motion under these hits is not finite: check its stiffnesses and masses")]
    NoMotion,
    /// The fixture cannot be simulated.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

/// Why FRFs at several levels cannot be diagnosed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SteppedError {
    /// Fewer than two levels.
    #[error("there is one level only: give FRFs at two or more amplitudes")]
    OneLevel,
    /// Levels of held force among levels of held response.
    #[error(
        "level {first} holds one quantity and level {second} another: give the levels of held force or those of held response"
    )]
    Mixed {
        /// A level.
        first: String,
        /// A level of the other kind.
        second: String,
    },
    /// Levels of one strength.
    #[error(
        "the levels, {first} to {last}, differ by less than a factor of {least}: record a weaker or a stronger one",
        least = LEAST_RATIO
    )]
    Alike {
        /// The first.
        first: String,
        /// The last.
        last: String,
    },
    /// Too few lines about the resonance of the level of this amplitude.
    #[error(
        "level {0} has fewer than {needed} spectral lines about the resonance; step finer, or widen `--band`",
        needed = FEWEST_LINES
    )]
    TooFewLines(String),
    /// No resonance can be fitted to the level of this amplitude.
    #[error("no resonance can be fitted to the FRFs of level {0}; choose a band about one with `--band`")]
    NoResonance(String),
    /// No joint is moved by the resonance.
    #[error(
        "no joint of the fixture is moved at this resonance, so nothing can be said of a joint; choose another with `--band`"
    )]
    NoJoint,
    /// A channel is impossible.
    #[error(transparent)]
    Channel(#[from] ChannelError),
    /// The fixture cannot be modelled.
    #[error(transparent)]
    Model(#[from] LumpedError),
}

/// Why the force–state map of a joint, named first, cannot be drawn.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ForceStateError {
    /// The fixture does not have the joint.
    #[error("the fixture has no joint `{0}`")]
    UnknownJoint(String),
    /// Other joints bridge it.
    #[error(
        "other joints lead around joint {0}: what it bears alone does not follow from the motion of the bodies"
    )]
    Loop(String),
    /// Supports on both sides.
    #[error("supports hold the bodies on both sides of joint {0}: what they bear is not measured")]
    Supported(String),
    /// No side is of rigid bodies that nothing holds.
    #[error("the bodies beside joint {0} bend: their inertia forces do not follow from a few sensors")]
    Deformable(String),
    /// No side is followed by sensors.
    #[error(
        "the motion of {bodies} beside joint {joint} is not measured: put two sensors on the body (one where it does not rotate)"
    )]
    TooFewSensors {
        /// The joint.
        joint: String,
        /// Bodies that are not followed.
        bodies: String,
    },
    /// An effect by which inertia or signals are not what they seem.
    #[error(
        "`{kind}` at {place} makes the joint's force more than inertia and hammer say: no map is drawn with it"
    )]
    Effect {
        /// Its kind.
        kind: &'static str,
        /// Its place.
        place: String,
    },
    /// The fixture cannot be simulated.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}
