//! How a plot is drawn, as far as the figure around it has to say so.

use crate::unit::Scale;

/// What the figure around a plot has to say of how it is drawn.
pub(super) struct Drawing {
    /// Display unit of the ordinates.
    pub scale: Scale,
    /// Whether only a part of the ordinate is drawn at first.
    pub is_cut: bool,
    /// What the reader must know.
    pub remarks: Vec<String>,
}

impl Drawing {
    /// Remarks that of so many things, if there are any, something is to be known.
    pub(super) fn remark(&mut self, count: usize, one: &str, several: &str, what: &str) {
        let noun = if count == 1 { one } else { several };
        self.remarks.extend((count > 0).then(|| format!("{count} {noun} {what}")));
    }
}
