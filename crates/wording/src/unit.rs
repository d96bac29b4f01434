//! Units as the reader sees them: `N*m/rad` becomes `N·m/rad`, 3.3e6 N/m becomes 3.3 MN/m.

/// Prefixes an engineer reads without thinking, largest first.
const PREFIXES: [(f64, &str); 7] =
    [(1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n")];

/// A unit together with the factor by which SI values are divided before they are printed in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Scale {
    factor: f64,
    unit: String,
}

impl Scale {
    /// The unit as it stands, typeset, without a prefix.
    pub fn plain(unit: &str) -> Self {
        Self { factor: 1.0, unit: typeset(unit) }
    }

    /// The prefix in which a value of this `magnitude` (SI, sign ignored) reads as 1 to 999. Units that take
    /// no prefix (`%`, `dB`, `1/s`, `m^4`, one that already has a prefix) stay as they are, and so do
    /// magnitudes for which no usual prefix exists.
    pub(crate) fn for_magnitude(magnitude: f64, unit: &str) -> Self {
        let magnitude = magnitude.abs();
        if !magnitude.is_finite() || magnitude == 0.0 {
            return Self::plain(unit);
        }
        let base = leading_symbol(unit);
        let rest = &unit[base.len()..];
        // A prefix on a raised symbol would be raised with it: mm² is not a thousandth of m².
        if rest.starts_with(['^', '²', '³', '⁴']) {
            return Self::plain(unit);
        }
        if unit == "kg" {
            return Self::for_mass(magnitude);
        }
        let largest = match base {
            "N" | "Pa" | "J" | "W" | "V" | "Hz" => 1e9,
            "m" | "s" | "rad" => 1.0,
            _ => return Self::plain(unit),
        };
        let prefix = PREFIXES
            .iter()
            .find(|(factor, _)| *factor <= largest && magnitude >= threshold(base, *factor) * (1.0 - 1e-9));
        match prefix {
            Some(&(factor, prefix)) if magnitude < 1e4 * factor.max(1.0) => {
                Self { factor, unit: format!("{prefix}{}", typeset(unit)) }
            }
            _ => Self::plain(unit),
        }
    }

    /// The prefix that suits the largest finite magnitude among `values`: one unit for a whole column or
    /// axis.
    pub fn for_values(values: impl IntoIterator<Item = f64>, unit: &str) -> Self {
        let largest = values
            .into_iter()
            .filter(|value| value.is_finite())
            .fold(0.0, |largest: f64, value| largest.max(value.abs()));
        Self::for_magnitude(largest, unit)
    }

    /// The unit of a quantity that a fixture states: places and lengths in mm, as drawings have them, however
    /// small their deviations; all else as in [`Scale::for_values`].
    pub fn of_stated(values: impl IntoIterator<Item = f64>, unit: &str) -> Self {
        let scale = Self::for_values(values, unit);
        if unit == "m" && scale.factor < 1.0 {
            return Self { factor: 1e-3, unit: "mm".to_owned() };
        }
        scale
    }

    /// The SI kilogram already has a prefix, so masses below 0.1 kg go by the gram. An inertia in kg·m²
    /// stays: nobody reads mg·m².
    fn for_mass(magnitude: f64) -> Self {
        let (factor, symbol) = match magnitude {
            m if !(1e-7..0.1).contains(&m) => (1.0, "kg"),
            m if m >= 1e-3 => (1e-3, "g"),
            _ => (1e-6, "mg"),
        };
        Self { factor, unit: symbol.to_owned() }
    }

    /// The value as a number of this unit.
    pub fn of(&self, value: f64) -> f64 {
        value / self.factor
    }

    /// The typeset unit, prefix included; empty for a pure number.
    pub fn unit(&self) -> &str {
        &self.unit
    }
}

/// Frequencies stay in Hz up to 10 kHz: 1843.2 Hz is how a line is spoken of.
fn threshold(base: &str, factor: f64) -> f64 {
    if base == "Hz" && factor > 1.0 { 10.0 * factor } else { factor }
}

/// The first symbol of a unit: the `N` of `N*s/m`.
fn leading_symbol(unit: &str) -> &str {
    let end = unit.find(|c: char| !c.is_alphabetic()).unwrap_or(unit.len());
    &unit[..end]
}

/// Writes a unit of a file (`N*m/rad`, `m/s^2`) the way it is printed (`N·m/rad`, `m/s²`). A pure number
/// (`1`) has no unit.
pub fn typeset(unit: &str) -> String {
    if unit == "1" {
        return String::new();
    }
    let mut printed = String::with_capacity(unit.len());
    let mut raised = false;
    for c in unit.chars() {
        match c {
            '^' => raised = true,
            '*' => {
                raised = false;
                printed.push('·');
            }
            '0'..='9' | '-' if raised => printed.push(superscript(c)),
            _ => {
                raised = false;
                printed.push(c);
            }
        }
    }
    printed
}

/// The raised form of a digit or minus sign; anything else stays.
pub fn superscript(c: char) -> char {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    match c {
        '-' => '⁻',
        c => c.to_digit(10).map_or(c, |digit| RAISED[digit as usize]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(magnitude: f64, unit: &str, expected: &str) {
        assert_eq!(Scale::for_magnitude(magnitude, unit).unit(), expected, "for {magnitude:e} {unit}");
    }

    #[test]
    fn a_value_is_divided_by_its_prefix() {
        let scale = Scale::for_magnitude(3.32e6, "N/m");
        assert_eq!(scale.unit(), "MN/m");
        assert!((scale.of(3.32e6) - 3.32).abs() < 1e-12);
    }

    #[test]
    fn a_prefix_is_chosen_so_that_the_number_reads_between_1_and_999() {
        check(3.3e6, "N/m", "MN/m");
        check(999.0, "N/m", "N/m");
        check(1000.0, "N/m", "kN/m");
        check(4.7e-3, "N*m*s/rad", "mN·m·s/rad");
        check(2.0e-5, "m", "µm");
    }

    #[test]
    fn places_are_in_millimetres_as_drawings_have_them() {
        for values in [[0.0, 1e-4], [0.131, 2e-4], [-3.4e-6, 0.0]] {
            assert_eq!(Scale::of_stated(values, "m").unit(), "mm", "{values:?}");
        }
        assert_eq!(Scale::of_stated([12.0, 0.1], "m").unit(), "m");
        assert_eq!(Scale::of_stated([0.02], "kg").unit(), "g");
    }

    #[test]
    fn units_that_take_no_prefix_stay_as_they_are() {
        check(3.67e-10, "m^4", "m⁴");
        check(1e6, "%", "%");
        check(1e5, "1/s", "1/s");
        check(0.005, "mm", "mm");
        check(2500.0, "m", "m");
        check(0.0, "N/m", "N/m");
        check(0.02, "1", "");
    }

    #[test]
    fn frequencies_stay_in_hertz_and_small_masses_go_to_grams() {
        check(1843.2, "Hz", "Hz");
        check(12_800.0, "Hz", "kHz");
        check(0.02, "kg", "g");
        check(1.1, "kg", "kg");
        check(9.5e-4, "kg*m^2", "kg·m²");
    }
}
