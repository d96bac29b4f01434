//! Products of what the names predict of a measurement, whitened by its noise: all that its worth depends on.

use jointscope_inference::weighted_products;
use num_complex::Complex64;

/// One name's prediction of a measurement, FRF after FRF: the values, and their derivatives by its
/// coordinates.
#[derive(Debug, Clone)]
pub(crate) struct Predicted {
    pub values: Vec<Complex64>,
    pub derivatives: Vec<Vec<Complex64>>,
}

/// Inner products aᵀΣ⁻¹b of the columns of several names: the derivatives of the first by each of its
/// coordinates, those of the second, …, and then the differences of all their values from the first one's.
/// Products of independent measurements add up.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Products {
    /// Coordinates by name.
    pub widths: Vec<usize>,
    /// Row-major and whole.
    pub entries: Vec<f64>,
}

impl Products {
    /// Of a measurement that tells nothing.
    pub(crate) fn none(widths: &[usize]) -> Self {
        let order = widths.iter().sum::<usize>() + widths.len();
        Products { widths: widths.to_vec(), entries: vec![0.0; order * order] }
    }

    /// Of predictions on the values in `range`, with their weights 2/σ².
    pub(crate) fn of(names: &[Predicted], range: std::ops::Range<usize>, weights: &[f64]) -> Self {
        let first = &names[0].values[range.clone()];
        let away = |name: &Predicted| -> Vec<Complex64> {
            name.values[range.clone()].iter().zip(first).map(|(value, first)| value - first).collect()
        };
        let away: Vec<Vec<Complex64>> = names.iter().map(away).collect();
        let derivatives =
            names.iter().flat_map(|name| &name.derivatives).map(|column| &column[range.clone()]);
        let columns: Vec<&[Complex64]> = derivatives.chain(away.iter().map(Vec::as_slice)).collect();
        let widths = names.iter().map(|name| name.derivatives.len()).collect();
        Products { widths, entries: weighted_products(&columns, weights) }
    }

    /// Of one real number of variance one over `weight`: its value by each name, and its derivatives by that
    /// name's coordinates.
    pub(crate) fn of_number(names: &[(f64, Vec<f64>)], weight: f64) -> Self {
        let derivatives = names.iter().flat_map(|(_, derivatives)| derivatives.iter().copied());
        let column: Vec<f64> = derivatives.chain(names.iter().map(|(value, _)| value - names[0].0)).collect();
        let entries = column.iter().flat_map(|a| column.iter().map(move |b| weight * a * b)).collect();
        Products { widths: names.iter().map(|(_, derivatives)| derivatives.len()).collect(), entries }
    }

    /// Number of columns.
    pub(crate) fn order(&self) -> usize {
        self.widths.iter().sum::<usize>() + self.widths.len()
    }

    /// The first column of a name's derivatives.
    pub(crate) fn first(&self, name: usize) -> usize {
        self.widths[..name].iter().sum()
    }

    /// The column of a name's values.
    pub(crate) fn value(&self, name: usize) -> usize {
        self.first(self.widths.len()) + name
    }

    pub(crate) fn at(&self, row: usize, column: usize) -> f64 {
        self.entries[row * self.order() + column]
    }

    /// Adds those of an independent measurement.
    pub(crate) fn add(&mut self, other: &Products) {
        self.entries.iter_mut().zip(&other.entries).for_each(|(own, other)| *own += other);
    }

    /// The same measured so many times.
    pub(crate) fn times(&self, count: f64) -> Self {
        Products {
            widths: self.widths.clone(),
            entries: self.entries.iter().map(|entry| count * entry).collect(),
        }
    }

    /// A name's own information JᵀΣ⁻¹J.
    pub(crate) fn information(&self, name: usize) -> Vec<f64> {
        let (first, width) = (self.first(name), self.widths[name]);
        (0..width * width).map(|e| self.at(first + e / width, first + e % width)).collect()
    }
}
