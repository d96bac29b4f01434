//! What a column's name says: which part of which FRF, in which unit.

use crate::ChannelPair;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    Frequency,
    Real,
    Imaginary,
    Magnitude,
    Phase,
    Coherence,
}

impl Part {
    pub(super) fn name(self) -> &'static str {
        match self {
            Part::Frequency => "frequency",
            Part::Real => "real",
            Part::Imaginary => "imag",
            Part::Magnitude => "magnitude",
            Part::Phase => "phase [deg]",
            Part::Coherence => "coherence",
        }
    }

    fn of_word(word: &str) -> Option<Part> {
        Some(match word {
            "frequency" | "frequencies" | "freq" | "f" | "omega" | "frequenz" => Part::Frequency,
            "real" | "re" | "realpart" => Part::Real,
            "imag" | "imaginary" | "im" | "img" | "imagpart" => Part::Imaginary,
            "magnitude" | "mag" | "abs" | "amplitude" | "amp" | "modulus" => Part::Magnitude,
            "phase" | "angle" | "arg" | "pha" => Part::Phase,
            "coherence" | "coh" => Part::Coherence,
            _ => return None,
        })
    }
}

/// A column and what its name says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Column {
    pub index: usize,
    pub part: Part,
    /// The FRF it names.
    pub pair: Option<ChannelPair>,
    /// What is left of its name: that of its FRF, if it is none of nodes.
    pub stem: String,
    /// Its unit, or nothing.
    pub unit: String,
}

/// What the name of the column at `index` says; `None` where it names none.
pub(super) fn column(index: usize, header: &str) -> Option<Column> {
    let (name, mut unit) = split_unit(header);
    let mut part = None;
    let mut pair = None;
    let mut stem: Vec<&str> = Vec::new();
    let words = name
        .split(|c: char| c.is_whitespace() || matches!(c, '_' | ',' | '|'))
        .filter(|word| !word.is_empty());
    for word in words {
        // `H(4/1)`, `FRF(4:+z/1:+z)`, `Re(4/1)`, `real(H1)`
        let (before, inner) = match word.split_once('(') {
            Some((before, inner)) if word.ends_with(')') => (before, inner.trim_end_matches(')')),
            _ => (word, ""),
        };
        let lower = before.to_lowercase();
        if let Some(found) = Part::of_word(&lower).filter(|_| part.is_none()) {
            part = Some(found);
        } else if is_unit_word(&lower, part) {
            unit = before.to_owned();
        } else if lower == "part" || (inner.is_empty() && lower == "frf") {
            continue;
        } else if let Ok(found) = ChannelPair::parse(before) {
            pair = pair.or(Some(found));
        } else if inner.is_empty() || !matches!(lower.as_str(), "h" | "frf" | "") {
            stem.push(word);
            continue;
        }
        if !inner.is_empty() {
            match ChannelPair::parse(inner) {
                Ok(found) => pair = pair.or(Some(found)),
                Err(_) => stem.push(inner),
            }
        }
    }
    // A frequency column is named by nothing else.
    let part = match part {
        None if matches!(name.trim().to_lowercase().as_str(), "hz" | "khz") => {
            unit = name.trim().to_owned();
            stem.clear();
            Part::Frequency
        }
        part => part?,
    };
    if part == Part::Frequency && (pair.is_some() || !stem.is_empty()) {
        return None;
    }
    Some(Column { index, part, pair, stem: stem.join(" "), unit })
}

/// `frequency_hz`, `phase deg`: a unit without brackets, of those that say nothing else.
fn is_unit_word(word: &str, part: Option<Part>) -> bool {
    match part {
        Some(Part::Frequency) => matches!(word, "hz" | "khz"),
        Some(Part::Phase) => matches!(word, "deg" | "rad"),
        _ => false,
    }
}

/// Name and unit: `4/1 real [m/s^2/N]`, or `frequency (Hz)` with a blank before the bracket, so that `H(4/1)`
/// stays whole.
fn split_unit(header: &str) -> (String, String) {
    let header = header.trim();
    let brackets = header.find('[').and_then(|open| Some((open, open + header[open..].find(']')?)));
    let parentheses =
        || header.ends_with(')').then(|| header.find(" (")).flatten().map(|at| (at + 1, header.len() - 1));
    // A pair in parentheses is no unit.
    let is_pair = |(open, close): &(usize, usize)| {
        header.get(open + 1..*close).is_some_and(|inside| ChannelPair::parse(inside).is_ok())
    };
    match brackets.or_else(parentheses).filter(|range| !is_pair(range)) {
        None => (header.to_owned(), String::new()),
        Some((open, close)) => {
            let after = header.get(close + 1..).unwrap_or_default();
            let unit = header.get(open + 1..close).unwrap_or_default().trim().to_owned();
            (format!("{} {after}", header.get(..open).unwrap_or_default()), unit)
        }
    }
}

/// Whether all fields of a line name columns.
pub(super) fn is_header(fields: &[String]) -> bool {
    fields.iter().enumerate().all(|(at, field)| column(at, field).is_some())
}

/// Whether a line below a header is one of units: the header says what its columns are, and that line does
/// not, and holds no number: a row with one field that is none is no line of units.
pub(super) fn is_line_of_units(
    header: &[String],
    below: &[String],
    is_number: impl Fn(&str) -> bool,
) -> bool {
    if below.iter().any(|field| is_number(field)) {
        return false;
    }
    is_header(header) && !is_header(below)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(header: &str, part: Part, pair: &str, stem: &str, unit: &str) {
        let column = column(0, header).unwrap_or_else(|| panic!("`{header}` is not understood"));
        let found = column.pair.map_or(String::new(), |pair| pair.to_string());
        assert_eq!(
            (column.part, found.as_str(), column.stem.as_str(), column.unit.as_str()),
            (part, pair, stem, unit),
            "`{header}`"
        );
    }

    #[test]
    fn headers_come_in_many_spellings() {
        check("frequency_hz", Part::Frequency, "", "", "hz");
        check("Frequency [Hz]", Part::Frequency, "", "", "Hz");
        check("Freq (kHz)", Part::Frequency, "", "", "kHz");
        check("f", Part::Frequency, "", "", "");
        check("Hz", Part::Frequency, "", "", "Hz");
        check("omega [rad/s]", Part::Frequency, "", "", "rad/s");
        check("4/1 real", Part::Real, "4:+y/1:+y", "", "");
        check("4/1 imag [m/s^2/N]", Part::Imaginary, "4:+y/1:+y", "", "m/s^2/N");
        check("4/1 [g/N] real", Part::Real, "4:+y/1:+y", "", "g/N");
        check("H(4/1) mag", Part::Magnitude, "4:+y/1:+y", "", "");
        check("H(4:+z/1:-z) Phase (deg)", Part::Phase, "4:+z/1:-z", "", "deg");
        check("Re(4/1)", Part::Real, "4:+y/1:+y", "", "");
        check("real(H1)", Part::Real, "", "H1", "");
        check("H1_phase_rad", Part::Phase, "", "H1", "rad");
        check("Real part", Part::Real, "", "", "");
        check("4/1_coherence", Part::Coherence, "4:+y/1:+y", "", "");
        check("FRF 4/1 Imaginary part [m/(N s^2)]", Part::Imaginary, "4:+y/1:+y", "", "m/(N s^2)");
    }

    #[test]
    fn other_headers_are_not_guessed_at() {
        for header in ["time", "4/1", "temperature", "", "4/1 frequency"] {
            assert_eq!(column(0, header), None, "`{header}`");
        }
    }
}
