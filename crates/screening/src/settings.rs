//! Every tuned number of the screening, with the reason for it, by the question that it decides.
//!
//! Distances between levels are medians of |ln(|H|/|Ĥ|)| over the lines, Ĥ being the fixture's FRFs. Factors
//! between units stand with the units (`axis.rs`, `unit.rs`, `masses.rs`).

/// How near levels of FRFs are.
pub(crate) mod levels {
    /// Distance up to which FRFs are like a fixture's.
    pub(crate) const LIKE_FIXTURE: f64 = 0.2;
    /// Share of a distance below which another reading is the better one: what a fixture leaves out takes
    /// part in both.
    pub(crate) const BETTER_SHARE: f64 = 1.0 / 3.0;
    /// Distance below which FRFs are alike: calibration is no better.
    pub(crate) const CALIBRATION: f64 = 0.01;
}

/// FRFs without a signal.
pub(crate) mod dead {
    /// An FRF's root mean square over that of the median one below which it has no signal.
    pub(crate) const RMS_RATIO: f64 = 1e-9;
}

/// Numbers that were changed in the file.
pub(crate) mod steps {
    /// Least exponent of ten of a step.
    pub(crate) const LEAST_DECADES: f64 = 2.0;
    /// How far that may be from a whole number: an FRF changes a little between two lines besides.
    pub(crate) const DECADE_TOLERANCE: f64 = 0.1;
    /// Change of an FRF to the line before and after a step, as ln of its level, up to which it is even
    /// there. A resonance or an antiresonance that lies between two lines has its change on both sides.
    pub(crate) const LEVEL_CHANGE: f64 = 0.4;
    /// Fewest steps: there and back.
    pub(crate) const FEWEST_STEPS: usize = 2;
}

/// Magnitudes and phases in the place of real and imaginary parts.
pub(crate) mod polar {
    /// How near to a whole half turn, as a share of it, a phase is near it: numbers of any other kind are by
    /// twice that share of them.
    pub(crate) const NEAR_WHOLE: f64 = 1.0 / 9.0;
    /// Share of those beyond a quarter turn that must be.
    pub(crate) const WHOLE_SHARE: f64 = 0.8;
    /// Least share of all values that lies beyond a quarter turn.
    pub(crate) const LEAST_TURNED: f64 = 0.05;
}

/// A frequency axis in another unit.
pub(crate) mod axis {
    /// Distance from which FRFs are unlike the fixture's.
    pub(crate) const UNLIKE_FIXTURE: f64 = 0.7;
}

/// FRFs of another form than stated.
pub(crate) mod form {
    /// Parts of the band, in ln ω, whose medians are compared.
    pub(crate) const BAND_PARTS: usize = 12;
    /// Lines that a part needs.
    pub(crate) const LINES_PER_PART: usize = 3;
    /// How far a slope may be from a whole number.
    pub(crate) const SLOPE_TOLERANCE: f64 = 0.35;
    /// How far ln of the levels may be from that of the fixture.
    pub(crate) const LEVEL_TOLERANCE: f64 = 0.7;
}

/// FRFs in another unit than stated.
pub(crate) mod unit {
    /// How near to a factor between units, relative, the levels must be.
    pub(crate) const FACTOR_TOLERANCE: f64 = 0.06;
    /// How far FRFs may be from each other, as ln.
    pub(crate) const FRF_SPREAD: f64 = 0.25;
}

/// Masses and inertias of the fixture in another unit.
pub(crate) mod masses {
    /// Distance up to which FRFs are like the fixture's: what a fixture leaves out moves resonances, and
    /// levels between them by less than half.
    pub(crate) const UNLIKE_FIXTURE: f64 = 0.35;
    /// Lines on which readings are compared: medians need no more.
    pub(crate) const MOST_LINES: usize = 200;
    /// Bodies of which each is tried by itself, at most.
    pub(crate) const MOST_BODIES: usize = 8;
}

/// FRFs with the other sign of time.
pub(crate) mod conjugates {
    /// Share of |Im(H_{k+1} H̄_k)| that must be of one sign.
    pub(crate) const RISING_SHARE: f64 = 0.8;
    /// Least of Σ|Im(H_{k+1} H̄_k)| over Σ|H|²: without a resonance in the band nothing turns.
    pub(crate) const LEAST_TURN: f64 = 1e-3;
}

/// FRFs under each other's labels. Their distance is the median |ln(H/Ĥ)|² over the lines.
pub(crate) mod exchanged {
    /// Distance up to which an FRF is like a modelled one, and from which it is not.
    pub(crate) const LIKE_FIXTURE: f64 = 0.15;
    /// What is left of that by an exchange, at most.
    pub(crate) const REMAINING_SHARE: f64 = 0.1;
    /// Fewest lines that tell.
    pub(crate) const FEWEST_LINES: usize = 20;
}

/// Bands without coherence.
pub(crate) mod unexcited {
    /// Coherence below which nothing is told.
    pub(crate) const LEAST_COHERENCE: f64 = 0.5;
    /// Lines whose median counts.
    pub(crate) const WINDOW_LINES: usize = 9;
    /// Least share of the lines that is worth a word.
    pub(crate) const LEAST_SHARE: f64 = 0.1;
}

/// Numbers of a fixture that cannot belong to one structure.
pub(crate) mod plausibility {
    /// Distances from the centre of gravity to a body's points, over its radius of gyration, that bodies
    /// have: a bar with points at its ends has √3, one with points near its middle alone next to none.
    pub(crate) const SPAN: (f64, f64) = (0.01, 8.0);
    /// The same of a body whose numbers are in the right units.
    pub(crate) const USUAL_SPAN: (f64, f64) = (0.3, 6.0);
    /// The mass of such a body over the cube of a bar as long as its radius of gyration asks for, kg/m³: of
    /// slender bars that is less than their density, of foam and of lead between these.
    pub(crate) const USUAL_DENSITY: (f64, f64) = (1.0, 1e5);
    /// Masses above which nothing is that a hammer tests, kg.
    pub(crate) const MOST_MASS: f64 = 1e7;
    /// Young's moduli below which nothing is that carries a structure, Pa.
    pub(crate) const LEAST_MODULUS: f64 = 5e5;
    /// Depth of a section, (12 I)^¼, over the length of its beam above which that is none.
    pub(crate) const MOST_DEPTH: f64 = 10.0;
    /// Densities that no beam has, kg/m³: lighter than foam, heavier than any metal.
    pub(crate) const DENSITY: (f64, f64) = (20.0, 25e3);
    /// A section's area over the square root of its second moment: 3.5 of a square, down to a quarter of that
    /// of a tall one or a thin tube, up to ten times that of a strip.
    pub(crate) const SECTION_AREA: (f64, f64) = (0.8, 35.0);
}
