//! Names of functions, quantities and datasets, and numbers and counts as they are told.

use jointscope_uff::{FunctionType, data_type};

/// What a function is, in the singular.
pub(super) fn function_name(function: FunctionType) -> &'static str {
    use FunctionType as F;
    match function {
        F::General => "function of no stated type",
        F::TimeResponse => "time history",
        F::AutoSpectrum => "auto spectrum",
        F::CrossSpectrum => "cross spectrum",
        F::FrequencyResponse => "FRF",
        F::Transmissibility => "transmissibility",
        F::Coherence => "coherence",
        F::AutoCorrelation => "auto correlation",
        F::CrossCorrelation => "cross correlation",
        F::PowerSpectralDensity => "power spectral density",
        F::EnergySpectralDensity => "energy spectral density",
        F::Spectrum => "spectrum",
        F::ModeIndicator => "mode indicator function",
        F::MultipleCoherence => "multiple coherence",
        _ => "function of another type",
    }
}

/// What a quantity is; for those of dataset 58 and of 55 and 2414, whose codes agree where both have them.
pub(super) fn quantity_name(code: i32) -> Option<&'static str> {
    Some(match code {
        data_type::STRESS => "stress",
        data_type::STRAIN => "strain",
        4 => "element force",
        data_type::TEMPERATURE => "temperature",
        data_type::HEAT_FLUX => "heat flux",
        data_type::DISPLACEMENT => "displacement",
        data_type::REACTION_FORCE => "reaction force",
        data_type::VELOCITY => "velocity",
        data_type::ACCELERATION => "acceleration",
        data_type::EXCITATION_FORCE => "excitation force",
        data_type::PRESSURE => "pressure",
        data_type::MASS => "mass",
        94 => "a scalar",
        _ => return None,
    })
}

/// A dataset that is not read, named where many programs write it.
pub(super) fn dataset_name(number: u32, count: usize) -> String {
    let what = match number {
        1858 => " (qualifiers of functions)",
        2400 => " (model header)",
        2429 | 2435 | 2452 | 2467 | 2477 => " (groups)",
        _ => "",
    };
    match count {
        1 => format!("dataset {number}{what}"),
        _ => format!("{count} datasets {number}{what}"),
    }
}

/// `1 node`, `1,204 nodes`, `3 time histories`.
pub(super) fn counted(count: usize, what: &str) -> String {
    match (count, what) {
        (1, _) => format!("1 {what}"),
        (_, "auto spectrum" | "cross spectrum" | "spectrum") => {
            format!("{} {}a", thousands(count), what.trim_end_matches("um"))
        }
        (_, "function of no stated type" | "function of another type") => {
            format!("{} {}", thousands(count), what.replacen("function", "functions", 1))
        }
        _ => match what.strip_suffix('y') {
            Some(stem) => format!("{} {stem}ies", thousands(count)),
            None => format!("{} {what}s", thousands(count)),
        },
    }
}

/// A count with commas between its thousands.
pub(super) fn thousands(count: usize) -> String {
    let digits = count.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A number to four digits, without zeros at its end.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let magnitude = value.abs().log10().floor() as i32;
    if !(-4..9).contains(&magnitude) {
        return format!("{value:.3e}");
    }
    let decimals = usize::try_from(3 - magnitude).unwrap_or(0);
    let text = format!("{value:.decimals$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_have_their_plural_and_commas() {
        assert_eq!(counted(1204, "node"), "1,204 nodes");
        assert_eq!(counted(1, "time history"), "1 time history");
        assert_eq!(counted(3, "time history"), "3 time histories");
        assert_eq!(counted(2, "auto spectrum"), "2 auto spectra");
        assert_eq!(counted(2, "power spectral density"), "2 power spectral densities");
        assert_eq!(thousands(2_508_876), "2,508,876");
        assert_eq!(thousands(100), "100");
    }

    #[test]
    fn numbers_are_told_to_four_digits() {
        assert_eq!(short(312.5), "312.5");
        assert_eq!(short(0.956363), "0.9564");
        assert_eq!(short(23383.2), "23383");
        assert_eq!(short(0.0), "0");
        assert_eq!(short(1.0 / 51200.0), "1.953e-5");
    }
}
