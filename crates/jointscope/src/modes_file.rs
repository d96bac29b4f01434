//! The contents of `modes.json`.

use crate::file::value;
use jointscope_frf::noise::NoiseSource;
use jointscope_modes::{ChartPole, ModalAnalysis, Mode, Stability};
use jointscope_spectra::{Channel, FrfPair};
use jointscope_wording::Remarks;
use num_complex::Complex64;
use serde::Serialize;
use serde_json::Value;

/// The contents of `modes.json`: modes with standard deviations, shapes and residues, residual terms, how
/// well the rebuilt FRFs meet the measured ones, and the stabilisation chart. SI units; complex numbers as
/// `[real, imaginary]`; what is not told is `null`.
pub fn modes_file(analysis: &ModalAnalysis) -> Value {
    let pairs = analysis.pairs();
    let modes = |modes: &[Mode]| modes.iter().map(|mode| ModeEntry::of(mode, pairs)).collect();
    let hz = analysis.lines().hz();
    value(ModesFile {
        modes: modes(&analysis.modes),
        outside_the_band: modes(&analysis.outside),
        auto_mac: analysis.auto_mac().chunks(analysis.modes.len().max(1)).map(<[f64]>::to_vec).collect(),
        chi2_per_dof: analysis.chi2_per_dof,
        window_decay: Some(analysis.window_decay).filter(|decay| *decay > 0.0),
        explained: analysis.is_explained(),
        lines: LinesEntry {
            from: hz[0],
            to: hz[hz.len() - 1],
            count: analysis.merged_from.unwrap_or(hz.len()),
        },
        frfs: frfs(analysis),
        stabilization: StabilizationEntry::of(analysis),
        remarks: analysis.remarks(),
    })
}

#[derive(Serialize)]
struct ModesFile {
    modes: Vec<ModeEntry>,
    outside_the_band: Vec<ModeEntry>,
    /// A row a mode of the band.
    auto_mac: Vec<Vec<f64>>,
    chi2_per_dof: f64,
    /// Decay of the exponential window that was taken off the modes, 1/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    window_decay: Option<f64>,
    /// Whether poles that all FRFs share explain them.
    explained: bool,
    lines: LinesEntry,
    frfs: Vec<FrfEntry>,
    stabilization: StabilizationEntry,
    remarks: Vec<String>,
}

/// The lines in use, Hz; before neighbours were merged, if they were.
#[derive(Serialize)]
struct LinesEntry {
    from: f64,
    to: f64,
    count: usize,
}

/// Natural frequency, Hz, and damping ratio: values or standard deviations.
#[derive(Serialize)]
struct FrequencyAndRatio {
    frequency: f64,
    damping_ratio: f64,
}

#[derive(Serialize)]
struct ModeEntry {
    frequency: f64,
    damping_ratio: f64,
    std: FrequencyAndRatio,
    correlation: f64,
    drift: Option<DriftEntry>,
    pole: Complex,
    shape: ShapeEntry,
    modal_mass: Option<f64>,
    phase_collinearity: f64,
    stands_out: bool,
    damping_is_vague: bool,
    residues: Vec<ResidueEntry>,
}

/// By how much a mode scatters from FRF to FRF, and each FRF's own.
#[derive(Serialize)]
struct DriftEntry {
    frequency: f64,
    damping_ratio: f64,
    frfs: Vec<ModeOfFrf>,
}

#[derive(Serialize)]
struct ModeOfFrf {
    frf: FrfPair,
    frequency: f64,
    damping_ratio: f64,
    std: FrequencyAndRatio,
}

#[derive(Serialize)]
struct ShapeEntry {
    responses: Vec<ChannelEntry>,
    references: Vec<ChannelEntry>,
}

#[derive(Serialize)]
struct ChannelEntry {
    channel: Channel,
    value: Complex,
}

#[derive(Serialize)]
struct ResidueEntry {
    frf: FrfPair,
    value: Complex,
    std: f64,
}

#[derive(Serialize)]
struct FrfEntry {
    frf: FrfPair,
    nrmse: f64,
    noise: Option<&'static str>,
    lower_residuals: Vec<Complex>,
    upper_residuals: Vec<Complex>,
}

#[derive(Serialize)]
struct StabilizationEntry {
    /// Lowest and highest.
    orders: (usize, usize),
    columns: [&'static str; 4],
    /// A row of these columns a pole.
    poles: Vec<(usize, f64, f64, &'static str)>,
}

/// Real and imaginary part.
#[derive(Serialize)]
struct Complex(f64, f64);

impl From<&Complex64> for Complex {
    fn from(value: &Complex64) -> Self {
        Complex(value.re, value.im)
    }
}

impl ModeEntry {
    fn of(mode: &Mode, pairs: &[FrfPair]) -> Self {
        let shape = |shape: &[(Channel, Complex64)]| -> Vec<ChannelEntry> {
            let entry = |(channel, value): &(Channel, Complex64)| ChannelEntry {
                channel: channel.clone(),
                value: value.into(),
            };
            shape.iter().map(entry).collect()
        };
        let residues = pairs.iter().zip(&mode.residues).zip(&mode.residue_std);
        let residue = |((frf, value), std): ((&FrfPair, &Complex64), &f64)| ResidueEntry {
            frf: frf.clone(),
            value: value.into(),
            std: *std,
        };
        let drift = mode.drift.as_ref().map(|drift| {
            let own = |&(frf, frequency, frequency_std, damping_ratio, damping_std): &(_, _, _, _, _)| {
                let frf: &FrfPair = &pairs[frf];
                let std = FrequencyAndRatio { frequency: frequency_std, damping_ratio: damping_std };
                ModeOfFrf { frf: frf.clone(), frequency, damping_ratio, std }
            };
            DriftEntry {
                frequency: drift.frequency,
                damping_ratio: drift.damping_ratio,
                frfs: drift.by_frf.iter().map(own).collect(),
            }
        });
        ModeEntry {
            frequency: mode.frequency,
            damping_ratio: mode.damping_ratio,
            std: FrequencyAndRatio { frequency: mode.frequency_std, damping_ratio: mode.damping_std },
            correlation: mode.correlation,
            drift,
            pole: (&mode.pole).into(),
            shape: ShapeEntry { responses: shape(&mode.responses), references: shape(&mode.references) },
            modal_mass: mode.modal_mass,
            phase_collinearity: mode.phase_collinearity,
            stands_out: mode.stands_out(),
            damping_is_vague: mode.is_vaguely_damped(),
            residues: residues.map(residue).collect(),
        }
    }
}

fn frfs(analysis: &ModalAnalysis) -> Vec<FrfEntry> {
    let errors = analysis.relative_errors();
    let of = |(index, frf): (usize, &FrfPair)| {
        let terms = &analysis.residual_terms[index];
        let noise = analysis.noise.get(index).map(|noise| match noise {
            NoiseSource::Coherence => "coherence",
            NoiseSource::CoherenceAlone => "coherence, averages by scatter",
            NoiseSource::Scatter => "scatter",
        });
        FrfEntry {
            frf: frf.clone(),
            nrmse: errors[index],
            noise,
            lower_residuals: terms.lower.iter().map(Complex::from).collect(),
            upper_residuals: terms.upper.iter().map(Complex::from).collect(),
        }
    };
    analysis.pairs().iter().enumerate().map(of).collect()
}

impl StabilizationEntry {
    fn of(analysis: &ModalAnalysis) -> Self {
        let stability = |stability| match stability {
            Stability::New => "new",
            Stability::Frequency => "frequency",
            Stability::Stable => "stable",
        };
        let pole = |p: &ChartPole| (p.order, p.frequency, p.damping_ratio, stability(p.stability));
        StabilizationEntry {
            orders: analysis.orders,
            columns: ["order", "frequency", "damping_ratio", "stability"],
            poles: analysis.chart.iter().map(pole).collect(),
        }
    }
}
