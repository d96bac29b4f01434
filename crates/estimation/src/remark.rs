//! What a reader of the FRFs should know.

use crate::Signal;
use jointscope_spectra::{Channel, FrfPair};

/// One thing that a reader of estimated FRFs should know.
#[derive(Debug, Clone, PartialEq)]
pub enum Remark {
    /// A hit is left out.
    Rejected {
        /// Its number.
        hit: u32,
        /// Why.
        why: String,
    },
    /// A hit is used because it was asked for.
    Kept {
        /// Its number.
        hit: u32,
        /// What speaks against it.
        why: String,
    },
    /// No hit is left at a point.
    NoHit(Channel),
    /// One hit is left at a point, which has no coherence.
    OneHit(Channel),
    /// Records of different lengths, in samples.
    Lengths {
        /// The shortest.
        short: usize,
        /// The longest.
        long: usize,
    },
    /// Records were filled with zeros to so many times their length.
    ZeroPadding(u32),
    /// An exponential window of this decay, 1/s, lies on all signals.
    Window(f64),
    /// Responses have not died away when their records end.
    StillRinging {
        /// Channels, and what is left of the loudest part of each.
        left: Vec<(Channel, f64)>,
        /// Decay of the exponential window, 1/s, where there is one.
        window: Option<f64>,
    },
    /// The structure still rang from the hit before: numbers of hits, and how much of the peak that is.
    RingingBefore(Vec<(u32, f64)>),
    /// Baselines that drift.
    DriftingBaselines(Vec<Signal>),
    /// Mains hum was taken off.
    Hum {
        /// The mains' frequency, Hz.
        hz: f64,
        /// Signals that had it, and the largest share of their peak that it was.
        signals: Vec<(Signal, f64)>,
    },
    /// The noise of the hits differs.
    UnequalNoise {
        /// By this factor.
        ratio: f64,
        /// Whether the hits count alike all the same.
        is_plain: bool,
    },
    /// Hits scatter by more than the noise before them explains.
    Disagreement {
        /// This many times at the most.
        ratio: f64,
        /// In these FRFs.
        frfs: Vec<FrfPair>,
    },
    /// The force's noise makes H1 too small.
    SmallH1 {
        /// Struck points, and by what share at the most.
        struck: Vec<(Channel, f64)>,
        /// Whether that was taken off.
        taken_off: bool,
    },
    /// The force's spectrum dips.
    ForceDips {
        /// At this struck point.
        struck: Channel,
        /// Near these frequencies, Hz.
        hz: Vec<f64>,
    },
    /// A driving point from which the hammer seems to draw energy.
    DrawsEnergy(FrfPair),
    /// Two FRFs that should be the same.
    NotReciprocal {
        /// The two.
        frfs: [FrfPair; 2],
        /// Their relative difference.
        difference: f64,
        /// Whether they are the same with the sign of one.
        is_sign: bool,
    },
}
