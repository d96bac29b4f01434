use jointscope_hits::HitError;
use jointscope_lumped::LumpedError;

/// Why motion over time cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// The assembly cannot be modelled over time.
    #[error(transparent)]
    Model(#[from] LumpedError),
    /// A channel names a point that the fixture does not have.
    #[error("the fixture has no point `{point}` (it has {known})")]
    UnknownPoint {
        /// The missing point.
        point: String,
        /// The points there are.
        known: String,
    },
    /// A rotation or moment of a body that does not rotate.
    #[error("point `{point}` sits on a body that does not rotate")]
    NoRotation {
        /// The point.
        point: String,
    },
    /// More amplitude-dependent effects than there is room for.
    #[error(
        "the fixture has {count} effects that depend on amplitude: {most} at the most can be simulated together"
    )]
    TooManyElements {
        /// Number of effects.
        count: usize,
        /// The most there is room for.
        most: usize,
    },
    /// More modes within the sampled band than there is room for.
    #[error("{} modes lie within the band that the force's sampling rate asks for, and {} at the most can be followed: give the force at a lower rate", states / 2, most / 2)]
    TooManyStates {
        /// Number of states.
        states: usize,
        /// The most there is room for.
        most: usize,
    },
    /// A roving sensor's mass.
    #[error(
        "physics: `sensor_mass` at {place} is there only while that response is measured, but here all responses are simulated at once; state it as an `added_mass`"
    )]
    SensorMass {
        /// The channel.
        place: String,
    },
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
