//! What a function is: first field of record 6.

macro_rules! function_types {
    ($($code:literal $name:ident $doc:literal),* $(,)?) => {
        /// Function type of a dataset 58 (record 6, field 1).
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum FunctionType {
            $(#[doc = concat!($doc, " (", stringify!($code), ").")] $name,)*
            /// A code that the specification does not list.
            Other(i32),
        }

        impl FunctionType {
            /// The type that a file's code stands for.
            pub fn from_code(code: i32) -> Self {
                match code {
                    $($code => FunctionType::$name,)*
                    other => FunctionType::Other(other),
                }
            }

            /// The code that stands for this type in a file.
            pub fn code(self) -> i32 {
                match self {
                    $(FunctionType::$name => $code,)*
                    FunctionType::Other(code) => code,
                }
            }
        }
    };
}

function_types! {
    0 General "General or unknown",
    1 TimeResponse "Time response",
    2 AutoSpectrum "Auto spectrum",
    3 CrossSpectrum "Cross spectrum",
    4 FrequencyResponse "Frequency response function (FRF)",
    5 Transmissibility "Transmissibility",
    6 Coherence "Coherence",
    7 AutoCorrelation "Auto correlation",
    8 CrossCorrelation "Cross correlation",
    9 PowerSpectralDensity "Power spectral density",
    10 EnergySpectralDensity "Energy spectral density",
    11 ProbabilityDensity "Probability density function",
    12 Spectrum "Spectrum",
    13 CumulativeFrequencyDistribution "Cumulative frequency distribution",
    14 PeaksValley "Peaks and valleys",
    15 StressPerCycles "Stress against cycles",
    16 StrainPerCycles "Strain against cycles",
    17 Orbit "Orbit",
    18 ModeIndicator "Mode indicator function",
    19 ForcePattern "Force pattern",
    20 PartialPower "Partial power",
    21 PartialCoherence "Partial coherence",
    22 Eigenvalue "Eigenvalue",
    23 Eigenvector "Eigenvector",
    24 ShockResponseSpectrum "Shock response spectrum",
    25 FiniteImpulseResponse "Finite impulse response filter",
    26 MultipleCoherence "Multiple coherence",
    27 OrderFunction "Order function",
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_comes_back_as_itself() {
        for code in -3..40 {
            assert_eq!(FunctionType::from_code(code).code(), code);
        }
        assert_eq!(FunctionType::from_code(4), FunctionType::FrequencyResponse);
        assert_eq!(FunctionType::from_code(6), FunctionType::Coherence);
        assert_eq!(FunctionType::from_code(28), FunctionType::Other(28));
    }
}
