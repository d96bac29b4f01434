//! What can be wrong with the units of an FRF: an unknown label, none at all, or one that contradicts the
//! data type.

/// Why the units of one FRF are not known.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum UnitsError {
    /// A label that is no unit this program knows.
    #[error(
        "the {axis}'s units label `{label}` is not known; export in SI units, or blank the label and state the units with `--assume-units`"
    )]
    Unknown {
        /// `response` or `force`.
        axis: &'static str,
        /// The label.
        label: String,
    },
    /// Neither data type nor label say what the quantity is.
    #[error("the file does not say what the {axis} is{}; say it with `--assume-units`, such as `--assume-units m/s^2,N`", stated(*.data_type, .label))]
    Absent {
        /// `response` or `force`.
        axis: &'static str,
        /// The data type stated.
        data_type: i32,
        /// The label stated.
        label: String,
    },
    /// Data type and label speak of different quantities.
    #[error(
        "the {axis} has data type {data_type} ({quantity}) but the units label `{label}`: one of them is wrong, export the file again"
    )]
    Contradiction {
        /// `response` or `force`.
        axis: &'static str,
        /// The data type stated.
        data_type: i32,
        /// What that type is in this direction.
        quantity: String,
        /// The label stated.
        label: String,
    },
    /// Dataset 164 and label state different units.
    #[error(
        "the {axis}'s units label `{label}` disagrees with the file's unit system `{system}` (dataset 164); say which units hold with `--assume-units`, such as `--assume-units m/s^2,N`"
    )]
    System {
        /// `response` or `force`.
        axis: &'static str,
        /// The label stated.
        label: String,
        /// Description in dataset 164.
        system: String,
    },
    /// The analyst's unit is of another quantity.
    #[error(
        "`--assume-units` speaks of {assumed}, but the response is one of {stated}: state their unit instead"
    )]
    Assumed {
        /// What the assumed unit measures.
        assumed: &'static str,
        /// What the file's data type says.
        stated: &'static str,
    },
    /// An FRF that is no function of frequency.
    #[error(
        "its abscissa has data type {data_type} and the units label `{label}`: an FRF needs frequencies (18) in Hz, kHz or rad/s"
    )]
    Abscissa {
        /// The data type stated.
        data_type: i32,
        /// The label stated.
        label: String,
    },
    /// A time history that may be a force or a motion.
    #[error(
        "neither its data type ({data_type}) nor a units label says whether it is a force or a motion; export it as excitation force (13), displacement (8), velocity (11) or acceleration (12)"
    )]
    NoQuantity {
        /// The data type stated.
        data_type: i32,
    },
    /// A time history over something else than time.
    #[error(
        "its abscissa has data type {data_type} and the units label `{label}`: a time history needs times (17) in s or ms"
    )]
    NotTime {
        /// The data type stated.
        data_type: i32,
        /// The label stated.
        label: String,
    },
}

/// What a universal file states all the same; a column of a CSV or MATLAB file has neither.
fn stated(data_type: i32, label: &str) -> String {
    match (data_type, label) {
        (0, "" | "NONE") => ": there is no unit".to_owned(),
        _ => format!(" (data type {data_type}, units label `{label}`)"),
    }
}
