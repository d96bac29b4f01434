//! K and C by line.

use super::pair::pair;
use jointscope_comparison::LineEntry;
use jointscope_decomposition::{Analysis, JointLine};

pub(super) fn line(analysis: &Analysis, line: &JointLine) -> LineEntry {
    let h41 = analysis.spectrum.h41.values.get(line.line);
    let std = line.stiffness_std.zip(line.damping_std).map(pair);
    LineEntry {
        frequency: line.frequency,
        stiffness: line.stiffness.0,
        damping: line.damping.0,
        condition: Some(line.condition),
        h41: h41.map(|h41| h41.0.map(|row| row.map(|value| [value.re, value.im]))),
        noisy: std.map(|_| line.is_noisy()),
        std,
    }
}
