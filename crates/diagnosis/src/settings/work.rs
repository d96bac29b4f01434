//! Numbers of how much a search does: what things cost, in predicted values of an FRF, and what share of the
//! rest one step may take.

/// What is counted besides the values that are predicted.
pub(crate) mod costs {
    /// Of a model: its matrices, modes and participations.
    pub(crate) const MODEL: u64 = 1000;
    /// The cube of a meshed model's coordinates whose modes cost as much as one value more.
    pub(crate) const CUBE_OF_COORDINATES: u64 = 250;
    /// Of the search for a model's poles, about, by FRF.
    pub(crate) const SEARCHED_POLES: usize = 1000;
    /// Of following known ones.
    pub(crate) const FOLLOWED_POLES: usize = 300;
}

/// Who may do how much.
pub(crate) mod shares {
    /// Fits between which the work done is looked at.
    pub(crate) const FITS_TOGETHER: usize = 16;
    /// Share of the work left that one step by lines may take: one more effect is worth less than to know
    /// what else would explain the first.
    pub(crate) const OF_STEP_BY_LINES: f64 = 0.5;
    /// The same of a search by lines where modes have told what there is and leave doubts.
    pub(crate) const OF_DOUBTS: f64 = 0.1;
    /// The same of the judgement on held-out data where modes decide.
    pub(crate) const OF_HELD_OUT: f64 = 0.3;
}
