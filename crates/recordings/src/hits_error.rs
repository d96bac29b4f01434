//! Why time histories are no hits: each message says what the files hold instead and what to export.

use jointscope_hits::HitError;

use crate::{FunctionError, FunctionPlace, RecordingError};

/// Why the time histories of files are no hammer hits.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum HitsError {
    /// Files without time histories.
    #[error(
        "{files}: there are no time histories (function type 1); what there is: {found}; export force and responses over time as dataset 58"
    )]
    NoTimeHistory {
        /// The files.
        files: String,
        /// What there is instead.
        found: String,
    },
    /// Time histories of other things than forces and motions.
    #[error(
        "{files}: no time history is a force or a motion along y; what there is: {found}; export excitation force (13) and acceleration (12) over time"
    )]
    NoSignal {
        /// The files.
        files: String,
        /// What there is.
        found: String,
    },
    /// A map that does not fit.
    #[error(transparent)]
    Map(RecordingError),
    /// One channel cannot be used.
    #[error("{place}: {problem}")]
    Channel {
        /// Which.
        place: Box<FunctionPlace>,
        /// Why.
        problem: FunctionError,
    },
    /// Complex values over time.
    #[error("{0}: a time history is real, but its values are complex; export the signal itself")]
    Complex(Box<FunctionPlace>),
    /// Samples that are not equally far apart.
    #[error("{0}: its samples are not evenly spaced in time; resample the record before it is exported")]
    Uneven(Box<FunctionPlace>),
    /// A hit whose responses have no force.
    #[error(
        "{files}: hit {hit} has no force channel (ordinate type 13), only {responses}; give the file that holds it, with the same sequence number in record 6, or leave the hit out"
    )]
    NoForce {
        /// The files.
        files: String,
        /// The sequence number.
        hit: i64,
        /// Its channels.
        responses: String,
    },
    /// Two forces of one sequence number.
    #[error(
        "{second}: hit {hit} has its force already from {first}; channels of one hit share the sequence number (third field of record 6), and each hit needs one of its own"
    )]
    TwoForces {
        /// The sequence number.
        hit: i64,
        /// The first force.
        first: Box<FunctionPlace>,
        /// The second force.
        second: Box<FunctionPlace>,
    },
    /// Channels of one hit on different instants.
    #[error(
        "{place}: hit {hit} has its force every {force} s and this response every {response} s; sample all channels of a hit alike"
    )]
    Interval {
        /// The response.
        place: Box<FunctionPlace>,
        /// The hit.
        hit: i64,
        /// Interval of the force's samples, s.
        force: f64,
        /// Interval of the response's samples, s.
        response: f64,
    },
    /// Channels of one hit that start at different times.
    #[error(
        "{place}: the force of hit {hit} starts at {force} s and this response at {response} s; export all channels of a hit from the same instant"
    )]
    Start {
        /// The response.
        place: Box<FunctionPlace>,
        /// The hit.
        hit: i64,
        /// First instant of the force, s.
        force: f64,
        /// First instant of the response, s.
        response: f64,
    },
    /// The signals do not make a hit.
    #[error("{files}: {problem}")]
    Hit {
        /// The files.
        files: String,
        /// Why.
        problem: HitError,
    },
    /// No hit strikes a point of the fixture.
    #[error(
        "{files}: no hit belongs to the fixture: the files have nodes {nodes}, the fixture has points {points}; say which is which with `--map`, such as `--map {example}`"
    )]
    NotOnFixture {
        /// The files.
        files: String,
        /// Channels of the files.
        nodes: String,
        /// The fixture's points.
        points: String,
        /// A map entry in the right form.
        example: String,
    },
}
