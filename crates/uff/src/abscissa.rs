//! Where the ordinates sit: frequencies in Hz, times in s, or whatever the abscissa axis says.

/// Abscissa of a function, in the unit of its abscissa axis.
#[derive(Debug, Clone, PartialEq)]
pub enum Abscissa {
    /// Evenly spaced: value `i` is `start + i·step`. The header of a universal file holds both in 13 columns,
    /// so [`write()`](crate::write()) keeps as many digits as fit there (8 to 10 significant ones for
    /// everyday numbers).
    Even {
        /// First value.
        start: f64,
        /// Spacing of neighbours.
        step: f64,
        /// Number of points.
        count: usize,
    },
    /// Every value stored beside its ordinate.
    Uneven(Vec<f64>),
}

impl Abscissa {
    /// Number of points.
    pub fn len(&self) -> usize {
        match self {
            Abscissa::Even { count, .. } => *count,
            Abscissa::Uneven(values) => values.len(),
        }
    }

    /// Whether there is no point at all.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Value of point `index`, counted from 0; NaN past the end of an uneven abscissa.
    pub fn value(&self, index: usize) -> f64 {
        match self {
            // Multiplied, not summed: the last of 10⁵ lines must not carry 10⁵ roundings.
            Abscissa::Even { start, step, .. } => start + index as f64 * step,
            Abscissa::Uneven(values) => values.get(index).copied().unwrap_or(f64::NAN),
        }
    }

    /// All values, in order.
    pub fn values(&self) -> Vec<f64> {
        match self {
            Abscissa::Even { count, .. } => (0..*count).map(|i| self.value(i)).collect(),
            Abscissa::Uneven(values) => values.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_of_many_even_lines_carries_one_rounding_only() {
        let lines = Abscissa::Even { start: 10.0, step: 0.01953125, count: 50_689 };
        assert_eq!(lines.value(50_688), 10.0 + 50_688.0 * 0.01953125);
        assert_eq!(lines.values().len(), 50_689);
    }
}
