//! Why datasets make no recording: the place in which file, and the remedy.

use std::fmt;

use jointscope_spectra::{Channel, SpectraError};

use crate::{FileChannel, UnitsError};

/// A function in a file: `test.uff, function 3 (FRF 4:+y/1:+y)`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FunctionPlace {
    /// The file's name.
    pub source: String,
    /// Which of its functions (datasets 58), counted from 1.
    pub function: usize,
    /// What it is, with its channels as the file names them.
    pub what: String,
}

impl fmt::Display for FunctionPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, function {} ({})", self.source, self.function, self.what)
    }
}

/// What is wrong with one function.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FunctionError {
    /// Its units.
    #[error(transparent)]
    Units(#[from] UnitsError),
    /// An FRF without phase.
    #[error("its values are real, a magnitude without phase: export the complex FRF")]
    NoPhase,
    /// A coherence with an imaginary part.
    #[error("a coherence is real, but its values are complex")]
    ComplexCoherence,
    /// Fewer points than the header states.
    #[error(
        "its header states {stated} points, but the dataset is closed after {found}: which are missing is not known, export the file again"
    )]
    Short {
        /// Points stated.
        stated: usize,
        /// Points there.
        found: usize,
    },
    /// ID line 5 starts with `averages`, but no count follows.
    #[error("ID line 5 reads `{0}`: a whole number of averages, 1 or more, is needed, such as `averages 5`")]
    Averages(String),
    /// ID line 3 starts with `exponential window`, but no decay follows.
    #[error(
        "ID line 3 reads `{0}`: a decay in 1/s is needed, zero or above, such as `exponential window 12.5 1/s`"
    )]
    Window(String),
    /// A largest magnitude, (m/s²)/N or the like of rotations, whose square means nothing any more.
    #[error("its largest value is {0:.1e} in SI units, which is that of no structure: check unit and scale")]
    Magnitude(f64),
    /// Its spectral lines.
    #[error("{0}")]
    Lines(SpectraError),
    /// A direction along or about which nothing says that it is the fixture's.
    #[error(
        "direction {direction} of node {node} is neither y nor theta; if it is the fixture's {becomes}, say so with `--map {node}:{direction}={node}:+{becomes}` (or `-{becomes}`), for all nodes at once with `--map {direction}=+{becomes}`"
    )]
    Direction {
        /// Node.
        node: i64,
        /// Direction, as a map entry writes it.
        direction: String,
        /// `y` or `theta`.
        becomes: &'static str,
    },
    /// A direction that the format does not have.
    #[error(
        "direction {direction} of node {node} does not exist: 0 to 6 and -1 to -6 do; export the file again"
    )]
    NoSuchDirection {
        /// Node number.
        node: i64,
        /// The number stated.
        direction: i32,
    },
    /// A rotation of a body that has none.
    #[error("point `{point}` of the fixture sits on a body that does not rotate; leave this function out")]
    NoRotation {
        /// The point.
        point: String,
    },
}

/// Why files and fixture do not make a recording.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RecordingError {
    /// One function cannot be used.
    #[error("{place}: {problem}")]
    Function {
        /// Which.
        place: Box<FunctionPlace>,
        /// Why.
        problem: FunctionError,
    },
    /// A map entry names a point that the fixture does not have.
    #[error(
        "the map entry `{entry}` names the point `{point}`, which the fixture does not have (it has {points})"
    )]
    MapPoint {
        /// The entry.
        entry: String,
        /// The unknown point.
        point: String,
        /// The fixture's points.
        points: String,
    },
    /// A map entry that applies to nothing.
    #[error("the map entry `{entry}` applies to no channel of the files (they have {channels})")]
    MapUnused {
        /// The entry.
        entry: String,
        /// The files' channels.
        channels: String,
    },
    /// Two map entries of many nodes for one channel of the files.
    #[error(
        "the map entries `{first}` and `{second}` both speak of {channel}: give node {} an entry of its own", channel.node
    )]
    MapAmbiguous {
        /// The channel.
        channel: FileChannel,
        /// The first entry.
        first: String,
        /// The second entry.
        second: String,
    },
    /// Two channels of the files that become one of the fixture by a map entry of many nodes.
    #[error(
        "by the map entry `{entry}` both {first} and {second} of the files are the fixture's channel {channel}: give node {} an entry of its own, which takes the place of `{entry}` there", second.node
    )]
    MapMerges {
        /// The entry.
        entry: String,
        /// The fixture's channel.
        channel: Channel,
        /// The first channel.
        first: FileChannel,
        /// The second channel.
        second: FileChannel,
    },
    /// The same function twice.
    #[error("{second}: {what} {frf} was given already by {first}; leave one of them out")]
    Twice {
        /// `FRF` or `coherence`.
        what: &'static str,
        /// In the fixture's terms, with the level where there is one.
        frf: String,
        /// The first of them.
        first: Box<FunctionPlace>,
        /// The second of them.
        second: Box<FunctionPlace>,
    },
    /// Functions on different spectral lines.
    #[error(
        "{second} has {second_lines}, but {first} has {first_lines}; give functions on the same lines, or on parts of them"
    )]
    Lines {
        /// One function.
        first: Box<FunctionPlace>,
        /// Its lines.
        first_lines: String,
        /// The other function.
        second: Box<FunctionPlace>,
        /// Its lines.
        second_lines: String,
    },
    /// No FRF connects two points of the fixture.
    #[error(
        "no FRF belongs to the fixture: the files have nodes {nodes}, the fixture has points {points}; say which is which with `--map`, such as `--map {example}`"
    )]
    NotOnFixture {
        /// Channels of the files.
        nodes: String,
        /// The fixture's points.
        points: String,
        /// A map entry in the right form.
        example: String,
    },
    /// Time histories only.
    #[error(
        "{files}: there {} and no FRF; {}", histories(*count), remedy(*count, *forces)
    )]
    OnlyTimeHistories {
        /// The files.
        files: String,
        /// Number of time histories.
        count: usize,
        /// Whether a force is among them, or may be.
        forces: bool,
        /// Their channels.
        channels: Vec<FileChannel>,
    },
    /// Neither FRFs nor time histories.
    #[error(
        "{files}: there is no FRF (function type 4), which every answer is made from; what there is: {found}; export the FRFs as dataset 58"
    )]
    NoFrf {
        /// The files.
        files: String,
        /// What there is.
        found: String,
    },
    /// Functions of type 4 that are no motion per force.
    #[error(
        "{place}: data types {numerator} over {denominator} are no displacement (8), velocity (11) or acceleration (12) per force (13), and the files have no other FRF"
    )]
    NotPerForce {
        /// The first of them.
        place: Box<FunctionPlace>,
        /// Data type of the ordinate's numerator.
        numerator: i32,
        /// Data type of its denominator.
        denominator: i32,
    },
    /// FRFs under different exponential windows.
    #[error(
        "{second} lies under an exponential window of decay {second_decay} 1/s, but {first} under one of {first_decay} 1/s (0 is none); give FRFs of one window"
    )]
    Windows {
        /// One function.
        first: Box<FunctionPlace>,
        /// Its window's decay, 1/s.
        first_decay: f64,
        /// The other function.
        second: Box<FunctionPlace>,
        /// Its window's decay, 1/s.
        second_decay: f64,
    },
    /// Points that the map names, or the files' nodes, are no points of any fixture.
    #[error("the points of the files do not make a structure: {0}")]
    Points(jointscope_fixture::FixtureError),
    /// FRFs at several amplitudes, where those of one are needed.
    #[error("the files hold FRFs at {count} levels ({levels}); give the files of one level")]
    SeveralLevels {
        /// Number of levels.
        count: usize,
        /// The levels.
        levels: String,
    },
    /// The FRFs are no valid set.
    #[error("the FRFs do not make a set: {0}")]
    Spectra(#[from] SpectraError),
}

fn histories(count: usize) -> String {
    if count == 1 { "is 1 time history".to_owned() } else { format!("are {count} time histories") }
}

fn remedy(count: usize, forces: bool) -> &'static str {
    match (forces, count) {
        (true, _) => "make FRFs of them first: `jointscope estimate`",
        (false, 1) => {
            "it is no force (ordinate type 13), without which there is no FRF: give the file that holds it, or export the FRFs as dataset 58"
        }
        (false, _) => {
            "none of them is a force (ordinate type 13), without which there is no FRF: give the file that holds it, or export the FRFs as dataset 58"
        }
    }
}

impl RecordingError {
    pub(crate) fn function(place: Box<FunctionPlace>, problem: impl Into<FunctionError>) -> Self {
        RecordingError::Function { place, problem: problem.into() }
    }
}

/// `1 line`, `2 lines`.
pub(crate) fn with_count(count: usize, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}

/// Names in a row, the end of a long row cut short.
pub(crate) fn enumeration<T: fmt::Display>(items: impl IntoIterator<Item = T>) -> String {
    const SHOWN: usize = 12;
    let names: Vec<String> = items.into_iter().map(|item| item.to_string()).collect();
    match names.len() {
        0 => "none".to_owned(),
        count if count > SHOWN + 1 => {
            format!("{} and {} more", names[..SHOWN].join(", "), count - SHOWN)
        }
        _ => names.join(", "),
    }
}
