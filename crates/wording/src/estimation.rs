//! What a reader of FRFs that were estimated from hits should know.

use crate::Says;
use jointscope_estimation::{Remark, Signal};
use jointscope_spectra::{Channel, FrfPair, in_sentence};

/// Dips of a force's spectrum that a sentence holds at the most.
const DIPS: usize = 5;

/// One sentence, without a full stop.
impl Says for Remark {
    fn says(&self) -> String {
        match self {
            Remark::Rejected { hit, why } => format!("hit {hit} rejected: {why}"),
            Remark::Kept { hit, why } => format!("hit {hit} used as `--keep` says, though: {why}"),
            Remark::NoHit(point) => format!("no hit at {point} is left: there are no FRFs to it"),
            Remark::OneHit(point) => format!(
                "one hit at {point}: it has no coherence, so the noise is estimated from the scatter over the lines, which sees neither hits \
                 that differ nor anything that repeats; three hits or more tell"
            ),
            Remark::Lengths { short, long } => format!(
                "records of {short} to {long} samples: the shorter ones are filled with zeros, which adds nothing to what has died away"
            ),
            Remark::ZeroPadding(times) => format!(
                "records filled with zeros to {times} times their length: of {times} neighbouring lines one is new, the rest follow from the others"
            ),
            Remark::Window(decay) => window(*decay),
            Remark::StillRinging { left, window } => still_ringing(left, *window),
            Remark::RingingBefore(hits) => ringing_before(hits),
            Remark::DriftingBaselines(signals) => drifting_baselines(signals),
            Remark::Hum { hz, signals } => hum(*hz, signals),
            Remark::UnequalNoise { ratio, is_plain } => unequal_noise(*ratio, *is_plain),
            Remark::Disagreement { ratio, frfs } => disagreement(*ratio, frfs),
            Remark::SmallH1 { struck, taken_off } => format!(
                "the force's noise makes H1 read low by up to {} where the force is weakest: {}",
                shares(struck, "to"),
                match taken_off {
                    true => "that was taken off, as the samples apart from the blow show it",
                    false => "a force window lessens it",
                }
            ),
            Remark::ForceDips { struck, hz } => force_dips(struck, hz),
            Remark::DrawsEnergy(pair) => format!(
                "the driving point {pair} moves as if the hammer drew energy from it: the direction of its force or of its sensor is the wrong \
                 way round, or one of them is another channel"
            ),
            Remark::NotReciprocal { frfs, difference, is_sign } => {
                not_reciprocal(frfs, *difference, *is_sign)
            }
        }
    }
}

fn still_ringing(left: &[(Channel, f64)], decay: Option<f64>) -> String {
    let share = shares(left, "at");
    match decay {
        None => format!(
            "responses still ring when their records end ({share} of their loudest part), which bends peaks and fills antiresonances by about as \
             much, the same way in every hit, so that no coherence shows it: record longer, or take `--response-window auto`"
        ),
        Some(decay) => format!(
            "responses still ring when their records end ({share} of their loudest part): {}",
            window(decay)
        ),
    }
}

fn ringing_before(hits: &[(u32, f64)]) -> String {
    let hits = hits.iter().map(|(hit, share)| format!("hit {hit} ({} % of the peak)", percent(*share)));
    format!(
        "the structure still rings from the hit before in {}: that counts as noise; wait longer between hits",
        joined(hits)
    )
}

fn drifting_baselines(signals: &[Signal]) -> String {
    let mut names: Vec<String> = signals.iter().map(Signal::to_string).collect();
    names.sort();
    format!(
        "the baseline of {} drifts, which shows in the lowest lines: `--detrend drift` takes a straight line off",
        names.join(", ")
    )
}

fn hum(hz: f64, signals: &[(Signal, f64)]) -> String {
    let share = |(signal, share): &(Signal, f64)| format!("{signal} ({} % of its peak)", percent(*share));
    format!(
        "mains hum of {hz:.2} Hz and its multiples, which is there before the blows, was taken off {}: look for a ground loop or a missing \
         shield; `--detrend keep` leaves it in",
        joined(signals.iter().map(share))
    )
}

fn unequal_noise(ratio: f64, is_plain: bool) -> String {
    let ratio = two_digits(ratio);
    match is_plain {
        false => format!(
            "the noise of the hits differs by a factor of up to {ratio}: in the averages each hit counts inversely to the power of its noise \
             (`--weights plain` takes the textbook's average)"
        ),
        true => format!(
            "the noise of the hits differs by a factor of up to {ratio}: the variances here know of it, but coherence and averages state less noise \
             than a plain average has (`--weights auto` mends that)"
        ),
    }
}

fn disagreement(ratio: f64, frfs: &[FrfPair]) -> String {
    format!(
        "the hits disagree by up to {} times the noise that precedes them ({}): they fell on different places, or the structure does not answer \
         in proportion, or it still rang",
        two_digits(ratio),
        joined(frfs.iter().map(FrfPair::to_string))
    )
}

fn force_dips(struck: &Channel, hz: &[f64]) -> String {
    format!(
        "the force's spectrum at {struck} dips near {} Hz{}: do not trust the FRFs there, however high their coherence",
        joined(hz.iter().take(DIPS).map(|hz| in_sentence(*hz).to_string())),
        if hz.len() > DIPS { " and elsewhere" } else { "" }
    )
}

fn not_reciprocal([one, other]: &[FrfPair; 2], difference: f64, is_sign: bool) -> String {
    let remedy = match is_sign {
        true => "with the sign of one they would be: a direction is the wrong way round",
        false => "a sensor or a struck point is not where it is said to be, or two channels are swapped",
    };
    format!("{one} and {other} should be the same and differ by {:.0} %: {remedy}", 100.0 * difference)
}

/// `1.2 % at 3, 4.5 % at 4`.
fn shares(channels: &[(Channel, f64)], at: &str) -> String {
    joined(channels.iter().map(|(channel, share)| format!("{} % {at} {channel}", percent(*share))))
}

fn joined(words: impl Iterator<Item = String>) -> String {
    words.collect::<Vec<_>>().join(", ")
}

fn window(decay: f64) -> String {
    format!(
        "an exponential window of decay {decay:.4} 1/s lies on force and responses, so the FRFs are those at s = {decay:.4} 1/s + iω and look more damped \
         than the structure is"
    )
}

fn percent(share: f64) -> String {
    two_digits(100.0 * share)
}

/// Two significant digits, without an exponent.
fn two_digits(value: f64) -> String {
    if !(value.is_finite() && value > 0.0) {
        return value.to_string();
    }
    let decimals = (1 - value.log10().floor() as i32).max(0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dips_of_a_force_are_told_with_four_digits() {
        let says = force_dips(&Channel::transverse("1"), &[1034.375, 88.21875]);
        assert!(says.contains("dips near 1034, 88.22 Hz"), "{says}");
    }

    #[test]
    fn shares_are_told_with_two_digits() {
        assert_eq!([0.0123, 0.5, 0.1, 0.00034].map(percent), ["1.2", "50", "10", "0.034"]);
        assert_eq!(two_digits(14.96), "15");
    }
}
