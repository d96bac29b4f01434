//! The modes of a recording, and the features that they give.

use crate::basis::Pole;
use crate::outline::Outline;
use jointscope_spectra::FrfPair;
use num_complex::Complex64;

/// One mode of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedMode {
    /// Natural frequency and damping ratio.
    pub pole: Pole,
    /// Residue in each FRF, 1/kg for transverse channels: φ_response·φ_reference of mass-normalised shapes,
    /// where damping is light.
    pub residues: Vec<Complex64>,
    /// Root mean square of the residues over the FRFs.
    pub scale: f64,
    /// Whether it lies far enough above the lowest line that counts to be told from a residual term.
    pub resolved: bool,
}

/// What a baseline's residues and residual terms are beyond those of the model that is calibrated on it: what
/// a channel's gain or delay makes of a structure's signal it makes of all of that signal, whatever the model
/// knows of it. Filters are left out: over few modes one makes up for residues that do not repeat, as a
/// resonance at 1470 Hz did on a real clamped beam that had lost a mass.
#[derive(Debug, Clone)]
pub(crate) struct Offsets {
    /// By mode and FRF, as channels without gains and delays would have read them; nothing of modes
    /// that the baseline does not show.
    pub residues: Vec<Vec<Complex64>>,
    /// Mass line and upper residual of each FRF, as the channels then read them.
    pub terms: Vec<[f64; 2]>,
    /// What these then made of each FRF at the lowest and the highest line.
    pub signals_at_ends: [Vec<Complex64>; 2],
}

/// Modes and residual terms of a recording, with their covariance.
#[derive(Debug, Clone)]
pub struct RecordedModes {
    pub(crate) pairs: Vec<FrfPair>,
    /// The modes in the band, ascending.
    pub modes: Vec<RecordedMode>,
    /// Lowest and highest line that counts, Hz.
    pub band: (f64, f64),
    /// Lowest line, counted or not, Hz.
    pub(crate) lowest: f64,
    /// Frequency, Hz, from which on modes can be told from residual terms.
    pub(crate) resolved_from: f64,
    /// χ² per degree of freedom of the free fit.
    pub chi2_per_dof: f64,
    /// What the free fit leaves on each line, mean square in units of the noise.
    pub misfit: Vec<f64>,
    /// Real parts of mass line and upper residual of each FRF.
    pub(crate) residual_terms: Vec<[f64; 2]>,
    /// Root mean squares of those over the FRFs.
    pub(crate) residual_scales: [f64; 2],
    /// Covariance of mass lines, 1/kg², where the shapes of modes that are a part of them err at each channel
    /// by their root mean square; empty where there are none.
    pub(crate) low: Vec<f64>,
    /// Covariance of the [features](RecordedModes::features), row-major.
    pub(crate) covariance: Vec<f64>,
    /// Whether residual terms were taken that neither noise nor the model asks for.
    pub(crate) excess_residual_terms: bool,
    pub(crate) outline: Outline,
    /// What a calibrated model is off by, where these are compared with one.
    pub(crate) offsets: Option<Offsets>,
    /// Poles outside the band, and number of residual terms of each FRF.
    pub(crate) surroundings: (Vec<Pole>, usize),
}

impl RecordedModes {
    /// Standard deviations of ln ω and ln ζ of mode `index` by the noise.
    pub fn deviations(&self, index: usize) -> [f64; 2] {
        let (n, first) = (self.count(), 2 * index);
        [first, first + 1].map(|at| self.covariance[at * (n + 1)].max(0.0).sqrt())
    }

    /// Whether the free fit took all the residual terms it may, and the model beside it needs fewer: then
    /// something smooth that is no mode is in the FRFs.
    pub fn has_excess_residual_terms(&self) -> bool {
        self.excess_residual_terms
    }

    /// Number of FRFs.
    pub fn frfs(&self) -> usize {
        self.pairs.len()
    }

    /// Number of features: ln ω and ln ζ of each mode, real and imaginary residue of each FRF in each mode,
    /// and two residual terms of each FRF.
    pub fn count(&self) -> usize {
        let (modes, frfs) = (self.modes.len(), self.frfs());
        2 * modes + 2 * modes * frfs + 2 * frfs
    }

    /// The features: residues over the mode's [scale](RecordedMode::scale), residual terms over theirs.
    pub fn features(&self) -> Vec<f64> {
        let poles = self.modes.iter().flat_map(|m| [m.pole.omega.ln(), m.pole.damping_ratio.ln()]);
        let mut all: Vec<f64> = poles.collect();
        for mode in &self.modes {
            all.extend(mode.residues.iter().flat_map(|a| [a.re / mode.scale, a.im / mode.scale]));
        }
        for terms in &self.residual_terms {
            all.extend((0..2).map(|k| terms[k] / self.residual_scales[k]));
        }
        all
    }
}
