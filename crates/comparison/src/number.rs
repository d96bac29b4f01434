//! The numbers by which joints are compared: elements of K and C.

use crate::FiledEstimate;

/// K or C.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// K.
    Stiffness,
    /// C.
    Damping,
}

impl Kind {
    /// `K` or `C`.
    pub fn symbol(self) -> &'static str {
        match self {
            Kind::Stiffness => "K",
            Kind::Damping => "C",
        }
    }

    /// Unit of an element, SI.
    pub fn unit(self, (i, j): (usize, usize)) -> &'static str {
        match (self, i, j) {
            (Kind::Stiffness, 0, 0) => "N/m",
            (Kind::Stiffness, 0, _) => "N/rad",
            (Kind::Stiffness, _, 0) => "N*m/m",
            (Kind::Stiffness, ..) => "N*m/rad",
            (Kind::Damping, 0, 0) => "N*s/m",
            (Kind::Damping, 0, _) => "N*s/rad",
            (Kind::Damping, _, 0) => "N*s",
            (Kind::Damping, ..) => "N*m*s/rad",
        }
    }

    /// Value and standard deviation of an element of an estimate.
    pub fn of(self, estimate: &FiledEstimate, (i, j): (usize, usize)) -> (f64, f64) {
        match self {
            Kind::Stiffness => (estimate.stiffness[i][j], estimate.stiffness_std[i][j]),
            Kind::Damping => (estimate.damping[i][j], estimate.damping_std[i][j]),
        }
    }
}

/// Rows and columns of the elements.
pub const ELEMENTS: [(usize, usize); 4] = [(0, 0), (0, 1), (1, 0), (1, 1)];

/// One of the numbers by which joints are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Number {
    /// K or C.
    pub kind: Kind,
    /// Row and column, from 0.
    pub element: (usize, usize),
}

impl Number {
    /// `K11` ….
    pub fn name(self) -> String {
        format!("{}{}{}", self.kind.symbol(), self.element.0 + 1, self.element.1 + 1)
    }

    /// Its unit, SI.
    pub(crate) fn unit(self) -> &'static str {
        self.kind.unit(self.element)
    }

    /// Its place among k11, k12, k22, c11, c12, c22.
    pub(crate) fn slot(self) -> usize {
        let first = if self.kind == Kind::Stiffness { 0 } else { 3 };
        first + self.element.0 + self.element.1
    }

    /// Whether an estimate has a value of it without saying how sure that is.
    pub(crate) fn has_no_deviation(self, estimate: &FiledEstimate) -> bool {
        let (value, std) = self.of(estimate);
        value != 0.0 && std == 0.0
    }

    /// Value and standard deviation of an estimate's.
    pub(crate) fn of(self, estimate: &FiledEstimate) -> (f64, f64) {
        self.kind.of(estimate, self.element)
    }
}
