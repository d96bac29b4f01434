//! Unit labels: `m/s^2`, `g`, `lbf`, `(m/s^2)/N`, read as a factor to SI and a dimension.

/// Exponents of length, mass, time and voltage; angles have none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Dimension([i32; 4]);

impl Dimension {
    /// An angle or a pure number.
    pub(crate) const NONE: Dimension = Dimension([0; 4]);
    /// Of a force.
    pub(crate) const FORCE: Dimension = Dimension([1, 1, -2, 0]);
    /// Of a moment.
    pub(crate) const MOMENT: Dimension = Dimension([2, 1, -2, 0]);

    /// Of a length, velocity, acceleration (`order` 0, 1, 2), or of their rotational counterparts.
    pub(crate) const fn motion(order: i32, rotational: bool) -> Dimension {
        Dimension([if rotational { 0 } else { 1 }, 0, -order, 0])
    }

    /// Of a quotient.
    pub(crate) const fn over(self, other: Dimension) -> Dimension {
        self.times(other, -1)
    }

    const fn times(self, Dimension(b): Dimension, exponent: i32) -> Dimension {
        let a = self.0;
        Dimension([
            a[0] + exponent * b[0],
            a[1] + exponent * b[1],
            a[2] + exponent * b[2],
            a[3] + exponent * b[3],
        ])
    }
}

/// A unit: what one of it is in SI, and of which dimension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unit {
    /// SI units in one of it.
    pub si: f64,
    /// Its dimension.
    pub dimension: Dimension,
}

const fn unit(si: f64, dimension: [i32; 4]) -> Unit {
    Unit { si, dimension: Dimension(dimension) }
}

const LENGTH: [i32; 4] = [1, 0, 0, 0];
const MASS: [i32; 4] = [0, 1, 0, 0];
const TIME: [i32; 4] = [0, 0, 1, 0];
const ACCELERATION: [i32; 4] = [1, 0, -2, 0];
const FORCE: [i32; 4] = [1, 1, -2, 0];
const MOMENT: [i32; 4] = [2, 1, -2, 0];
const VOLTAGE: [i32; 4] = [0, 0, 0, 1];

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.80665;
/// One pound-force, N.
const POUND_FORCE: f64 = 4.4482216152605;
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Spellings told apart by their case: milli against mega.
const CASED: [(&str, Unit); 4] = [
    ("mN", unit(1e-3, FORCE)),
    ("MN", unit(1e6, FORCE)),
    ("mV", unit(1e-3, VOLTAGE)),
    ("MV", unit(1e6, VOLTAGE)),
];

/// Spellings in any case; `lb` is the pound-force it means on an analyser.
const NAMES: [(&str, Unit); 47] = [
    ("m", unit(1.0, LENGTH)),
    ("meter", unit(1.0, LENGTH)),
    ("metre", unit(1.0, LENGTH)),
    ("cm", unit(1e-2, LENGTH)),
    ("mm", unit(1e-3, LENGTH)),
    ("um", unit(1e-6, LENGTH)),
    ("µm", unit(1e-6, LENGTH)),
    ("μm", unit(1e-6, LENGTH)),
    ("nm", unit(1e-9, LENGTH)),
    ("in", unit(0.0254, LENGTH)),
    ("inch", unit(0.0254, LENGTH)),
    ("mil", unit(2.54e-5, LENGTH)),
    ("ft", unit(0.3048, LENGTH)),
    ("foot", unit(0.3048, LENGTH)),
    ("s", unit(1.0, TIME)),
    ("sec", unit(1.0, TIME)),
    ("ms", unit(1e-3, TIME)),
    ("min", unit(60.0, TIME)),
    ("g", unit(GRAVITY, ACCELERATION)),
    ("gn", unit(GRAVITY, ACCELERATION)),
    ("g's", unit(GRAVITY, ACCELERATION)),
    ("gs", unit(GRAVITY, ACCELERATION)),
    ("g_n", unit(GRAVITY, ACCELERATION)),
    ("mg", unit(1e-3 * GRAVITY, ACCELERATION)),
    ("gal", unit(1e-2, ACCELERATION)),
    ("n", unit(1.0, FORCE)),
    ("newton", unit(1.0, FORCE)),
    ("newtons", unit(1.0, FORCE)),
    ("kn", unit(1e3, FORCE)),
    ("cn", unit(1e-2, FORCE)),
    ("dyn", unit(1e-5, FORCE)),
    ("lbf", unit(POUND_FORCE, FORCE)),
    ("lb", unit(POUND_FORCE, FORCE)),
    ("lbs", unit(POUND_FORCE, FORCE)),
    ("pound", unit(POUND_FORCE, FORCE)),
    ("kip", unit(1e3 * POUND_FORCE, FORCE)),
    ("pdl", unit(0.138254954376, FORCE)),
    ("kgf", unit(GRAVITY, FORCE)),
    ("kp", unit(GRAVITY, FORCE)),
    ("gf", unit(1e-3 * GRAVITY, FORCE)),
    ("kg", unit(1.0, MASS)),
    ("rad", unit(1.0, [0; 4])),
    ("deg", unit(DEGREE, [0; 4])),
    ("°", unit(DEGREE, [0; 4])),
    ("v", unit(1.0, VOLTAGE)),
    ("mrad", unit(1e-3, [0; 4])),
    ("urad", unit(1e-6, [0; 4])),
];

impl Unit {
    /// Reads a unit as labels spell it: products (`*`, `·`, `-` or a blank between names), quotients, powers
    /// (`^2`, `**2`, `²` or a digit behind the name) and brackets. `None` for anything else.
    pub(crate) fn parse(label: &str) -> Option<Unit> {
        let text = label.trim().replace("**", "^").replace('⁻', "^-").replace('²', "^2").replace('¹', "1");
        let text = text.replace("^-^", "^-");
        let mut parser = Parser { rest: &text };
        let unit = parser.product()?;
        parser.skip_blanks();
        parser.rest.is_empty().then_some(unit)
    }

    /// Whether this is the SI unit of `dimension`.
    pub(crate) fn is_si(self, dimension: Dimension) -> bool {
        self.si == 1.0 && self.dimension == dimension
    }

    fn power(self, exponent: i32) -> Unit {
        Unit { si: self.si.powi(exponent), dimension: Dimension::NONE.times(self.dimension, exponent) }
    }

    fn times(self, other: Unit) -> Unit {
        Unit { si: self.si * other.si, dimension: self.dimension.times(other.dimension, 1) }
    }

    fn named(name: &str) -> Option<Unit> {
        // N·m written as one word; lower-case `nm` is the nanometre.
        if name == "Nm" || name == "NM" {
            return Some(unit(1.0, MOMENT));
        }
        let cased = CASED.iter().find(|(spelling, _)| *spelling == name);
        cased.or_else(|| NAMES.iter().find(|(spelling, _)| *spelling == name.to_lowercase())).map(|(_, u)| *u)
    }
}

/// Recursive descent over a label.
struct Parser<'a> {
    rest: &'a str,
}

impl Parser<'_> {
    fn skip_blanks(&mut self) {
        self.rest = self.rest.trim_start();
    }

    fn take(&mut self, symbols: &[char]) -> Option<char> {
        self.skip_blanks();
        let first = self.rest.chars().next().filter(|c| symbols.contains(c))?;
        self.rest = &self.rest[first.len_utf8()..];
        Some(first)
    }

    /// Factors one after the other; a slash divides by the one factor behind it.
    fn product(&mut self) -> Option<Unit> {
        let mut unit = self.factor()?;
        loop {
            let divides = match self.take(&['/', '*', '·', '.', '-']) {
                Some(symbol) => symbol == '/',
                None if self.rest.is_empty() || self.rest.starts_with(')') => return Some(unit),
                None => false,
            };
            unit = unit.times(self.factor()?.power(if divides { -1 } else { 1 }));
        }
    }

    fn factor(&mut self) -> Option<Unit> {
        if self.take(&['(']).is_some() {
            let inside = self.product()?;
            self.take(&[')'])?;
            return Some(inside.power(self.exponent()?));
        }
        self.skip_blanks();
        // The 1 of `1/kg`.
        if let Some(rest) = self.rest.strip_prefix('1') {
            self.rest = rest;
            return Some(unit(1.0, [0; 4]));
        }
        let is_name = |c: char| c.is_alphabetic() || c == '\'' || c == '°' || c == '_';
        let end = self.rest.find(|c| !is_name(c)).unwrap_or(self.rest.len());
        let (name, rest) = self.rest.split_at(end);
        self.rest = rest;
        Some(Unit::named(name)?.power(self.exponent()?))
    }

    /// `^2`, `^-2`, `2`, `-2`, or nothing for 1.
    fn exponent(&mut self) -> Option<i32> {
        let (marked, text) = match self.rest.strip_prefix('^') {
            Some(text) => (true, text),
            None => (false, self.rest),
        };
        let (sign, digits) = match text.strip_prefix('-') {
            Some(digits) => (-1, digits),
            None => (1, text),
        };
        match digits.chars().next().and_then(|c| c.to_digit(10)) {
            Some(digit @ 1..=4) => {
                self.rest = &digits[1..];
                Some(sign * digit as i32)
            }
            _ if marked => None,
            _ => Some(1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn check(label: &str, si: f64, dimension: Dimension) {
        let unit = Unit::parse(label).unwrap_or_else(|| panic!("`{label}` was not understood"));
        assert_eq!(unit.dimension, dimension, "dimension of `{label}`");
        assert!((unit.si - si).abs() <= 1e-12 * si, "`{label}`: expected {si} SI, got {}", unit.si);
    }

    #[test]
    fn an_acceleration_is_read_in_every_usual_spelling() {
        let acceleration = Dimension::motion(2, false);
        for label in
            ["m/s^2", "m/s2", "m/s**2", "m/s²", "m/s/s", "m/sec^2", "M/S^2", "m s^-2", "m*s-2", "(m/s^2)"]
        {
            check(label, 1.0, acceleration);
        }
        check("g", 9.80665, acceleration);
        check("G", 9.80665, acceleration);
        check("mm/s^2", 1e-3, acceleration);
        check("in/s^2", 0.0254, acceleration);
    }

    #[test]
    fn forces_and_moments_are_read_with_their_case() {
        check("N", 1.0, Dimension::FORCE);
        check("lbf", 4.4482216152605, Dimension::FORCE);
        check("mN", 1e-3, Dimension::FORCE);
        check("MN", 1e6, Dimension::FORCE);
        check("N m", 1.0, Dimension::MOMENT);
        check("Nm", 1.0, Dimension::MOMENT);
        check("in-lbf", 0.0254 * 4.4482216152605, Dimension::MOMENT);
        check("nm", 1e-9, Dimension::motion(0, false));
    }

    #[test]
    fn a_label_may_state_the_whole_ratio() {
        let accelerance = Dimension::motion(2, false).over(Dimension::FORCE);
        check("m/s^2/N", 1.0, accelerance);
        check("(m/s^2)/N", 1.0, accelerance);
        check("m/(N s^2)", 1.0, accelerance);
        check("1/kg", 1.0, accelerance);
        check("g/lbf", 9.80665 / 4.4482216152605, accelerance);
    }

    #[test]
    fn what_is_no_unit_is_not_guessed_at() {
        for label in ["furlong", "m/", "/s", "m^", "(m", "m)", "dB", "EU", "m/s^9", "s^^2", "2m"] {
            assert_eq!(Unit::parse(label), None, "`{label}`");
        }
    }

    proptest! {
        #[test]
        fn no_label_whatsoever_panics(label in "\\PC{0,20}") {
            let _ = Unit::parse(&label);
        }
    }
}
