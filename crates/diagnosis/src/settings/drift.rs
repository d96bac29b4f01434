//! Numbers of structures that change between references. Measurements: `docs/records/2026-11-22-drift.md`.

/// Modes of each reference, beside each other.
pub(crate) mod poles {
    /// Farthest that a mode may have moved between references, in ln ω.
    pub(crate) const MOST_MOVED: f64 = 0.05;
    /// Factor by which the damping ratio of the same mode may differ, at most: a pole that only follows what
    /// a fit leaves has any damping. Without it, and without the limit on what a free fit may leave
    /// (`free_fit_limit` of `ModalSettings`), drift of 2 % was told of a real beam that does not drift by
    /// more than parts in 100,000.
    pub(crate) const MOST_DAMPING_FACTOR: f64 = 2.0;
    /// A natural frequency counts where it is known to this share of its half-width.
    pub(crate) const KNOWN_SHARE: f64 = 0.3;
}

/// Whether references differ.
pub(crate) mod differences {
    /// Probability by chance below which poles that differ between references are called drift: none of 1400
    /// tests without drift is.
    pub(crate) const CALLED_DRIFT: f64 = 1e-3;
    /// Differences of natural frequencies, as a share of the half-width, below which nothing is called drift:
    /// a free fit's residual terms leave as much wrong.
    pub(crate) const LEAST_DIFFERENCE: f64 = 0.005;
    /// χ² per degree of freedom that a reference's free fit may leave for drift to be taken out: that of frames
    /// whose damping is the same at all rates was 1.3 to 1.9.
    pub(crate) const NEARLY_ALL: f64 = 3.0;
    /// Distance in ln ω from the mean of all references up to which drift is taken out of FRFs: four kelvins make
    /// steel that much softer. What is farther off may be another structure.
    pub(crate) const MOST_LEVELLED: f64 = 1e-3;
    /// Probability by chance from which two references agree.
    pub(crate) const AGREE: f64 = 0.01;
}

/// Which stiffness it was.
pub(crate) mod attribution {
    /// Relative deviation of the shares of strain energy of a model that explains the recording down to its
    /// noise.
    pub(crate) const DEVIATION_IF_EXPLAINED: f64 = 0.02;
    /// The same of any other model.
    pub(crate) const DEVIATION_OTHERWISE: f64 = 0.1;
    /// Step in ln k that shares are taken with.
    pub(crate) const STIFFNESS_STEP: f64 = 0.005;
    /// Distance from the unchanged model's poles at which those of the changed one are looked for, relative.
    pub(crate) const BESIDE_POLES: f64 = 1e-4;
    /// Probability by chance from which a stiffness explains the differences.
    pub(crate) const EXPLAINS: f64 = 0.01;
    /// Probability among those that do from which it is the one.
    pub(crate) const NAMED: f64 = 0.9;
    /// Fits of one stiffness: the deviation of shares counts in proportion to the change.
    pub(crate) const ROUNDS: usize = 4;
}
