//! Something odd in a recording, in a sentence.

use crate::{Implausible, Polar};
use jointscope_spectra::{FrfForm, FrfPair, in_sentence};
use std::fmt;

/// Something odd in a recording, and what was done about it. Shown as one plain sentence, without a full
/// stop.
#[derive(Debug, Clone, PartialEq)]
pub enum Oddity {
    /// FRFs without a signal on any line: left out.
    Dead(Vec<FrfPair>),
    /// FRFs that are real on all lines, of a damped structure: left out.
    NoPhase(Vec<FrfPair>),
    /// Lines on which FRFs have no value or one of exactly zero, which no recording has: each FRF with the
    /// number of its lines, and the frequencies (Hz) of the first and the last. Left out.
    Empty(Vec<(FrfPair, usize, [f64; 2])>),
    /// Real and imaginary parts that are magnitudes and phases: taken as such.
    Polar(Polar),
    /// FRFs whose phase rises through resonances: their conjugates were taken.
    Conjugated(Vec<FrfPair>),
    /// FRFs that are of this form, and not what the file says: taken as such.
    Form(FrfForm),
    /// The frequencies of all lines are this many times too large: divided by it.
    Axis(f64),
    /// All FRFs are larger by this factor, which lies between two units: divided by it.
    Unit {
        /// The factor.
        factor: f64,
        /// The units that were taken for each other.
        between: &'static str,
    },
    /// Masses or inertias of the fixture are in another unit, or a decimal place off: nothing was changed for
    /// it.
    Masses(Implausible),
    /// Two FRFs that stand under each other's labels: exchanged.
    Exchanged(FrfPair, FrfPair),
    /// Two points whose channels, responses or references, have each other's place in all FRFs: exchanged.
    Swapped(String, String),
    /// No coherence from this frequency (Hz) to the end of the band in all FRFs of a channel: `true` of a
    /// reference.
    Unexcited {
        /// The channel's point.
        point: String,
        /// Whether it is a reference: where the hammer struck.
        is_reference: bool,
        /// Hz.
        from: f64,
        /// Lines from there on.
        lines: usize,
    },
}

impl fmt::Display for Oddity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let listed = |pairs: &[FrfPair]| pairs.iter().map(FrfPair::to_string).collect::<Vec<_>>().join(", ");
        match self {
            Oddity::Dead(pairs) => write!(
                f,
                "{} without a signal on any line, left out: {}; check the sensor, its cable and the export",
                if pairs.len() == 1 { "an FRF" } else { "FRFs" },
                listed(pairs)
            ),
            Oddity::NoPhase(pairs) => write!(
                f,
                "{} real on all lines, left out: {}; export complex values, not magnitudes or real parts",
                if pairs.len() == 1 { "an FRF is" } else { "FRFs are" },
                listed(pairs)
            ),
            Oddity::Empty(frfs) => write!(
                f,
                "nothing was recorded or exported on some lines (no value, or exactly zero), left out there: {}; export these lines too, or end the band before them with --band",
                listed_lines(frfs)
            ),
            Oddity::Polar(polar) => write!(
                f,
                "what stands for real and imaginary parts are {}: taken as such; export real and imaginary parts, or say what the columns of a table are",
                polar.says()
            ),
            Oddity::Conjugated(pairs) => write!(
                f,
                "the phase rises through the resonances, as with a time dependence of exp(−iωt): conjugates taken of {}; export with exp(+iωt), as universal files have it",
                listed(pairs)
            ),
            Oddity::Form(form) => write!(
                f,
                "the levels are not those of what the file says it holds: taken as {}; correct the file's function and unit codes",
                form.name()
            ),
            Oddity::Axis(factor) => write!(
                f,
                "the frequency axis is {factor:.4} times what it should be, as where kHz, rad/s or cycles a minute are taken for Hz: divided by it; correct the axis in the file"
            ),
            Oddity::Unit { factor, between } => write!(
                f,
                "all FRFs are {factor:.4} times what the fixture makes of them, as where {between} are taken for each other: divided by it; correct the units in the file, or with --assume-units"
            ),
            Oddity::Masses(slip) => write!(f, "{slip}"),
            Oddity::Exchanged(a, b) => write!(
                f,
                "FRFs {a} and {b} stand under each other's labels: exchanged; correct the node numbers in the file"
            ),
            Oddity::Swapped(a, b) => write!(
                f,
                "points {a} and {b} have each other's place: their channels are swapped, in the cables or in the node numbers of the file: exchanged"
            ),
            Oddity::Unexcited { point, is_reference: true, from, lines } => write!(
                f,
                "from {} Hz on the blows at {point} leave no coherence, so they do not excite that band: its {lines} lines are left out of their FRFs; a harder tip excites them, or end the band below with --band",
                in_sentence(*from)
            ),
            Oddity::Unexcited { point, is_reference: false, from, .. } => write!(
                f,
                "above {} Hz response {point} has no coherence: its sensor or filter ends there; replace it, or use --band",
                in_sentence(*from)
            ),
        }
    }
}

/// FRFs with their lines, those with the same lines together.
fn listed_lines(frfs: &[(FrfPair, usize, [f64; 2])]) -> String {
    let alike = frfs.chunk_by(|a, b| (a.1, a.2) == (b.1, b.2));
    let says = alike.map(|alike| {
        let (_, count, [first, last]) = &alike[0];
        let names: Vec<String> = alike.iter().map(|(pair, ..)| pair.to_string()).collect();
        let at = match count {
            1 => format!("at {} Hz", in_sentence(*first)),
            _ => format!("on {count} lines from {} to {} Hz", in_sentence(*first), in_sentence(*last)),
        };
        format!("{} {at}", names.join(", "))
    });
    says.collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frequency_in_a_sentence_has_four_digits_however_fine_the_lines_are() {
        let from = |is_reference| {
            Oddity::Unexcited { point: "4".to_owned(), is_reference, from: 1034.375, lines: 7 }.to_string()
        };
        assert!(from(true).starts_with("from 1034 Hz on the blows at 4"), "{}", from(true));
        assert!(from(false).starts_with("above 1034 Hz response 4"), "{}", from(false));
    }
}
