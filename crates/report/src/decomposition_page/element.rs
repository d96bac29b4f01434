//! The four elements of K and C: their places, symbols and units.

use jointscope_decomposition::{Analysis, JointLine, Relation};
use jointscope_linalg::RealMatrix2;

/// An element of the joint's 2×2 matrices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Element {
    pub row: usize,
    pub column: usize,
    /// Its indices in small figures.
    pub index: &'static str,
    pub stiffness_unit: &'static str,
    pub damping_unit: &'static str,
    /// What it connects, in words.
    pub meaning: &'static str,
}

const ELEMENTS: [Element; 4] = [
    Element {
        row: 0,
        column: 0,
        index: "₁₁",
        stiffness_unit: "N/m",
        damping_unit: "N*s/m",
        meaning: "force per displacement",
    },
    Element {
        row: 0,
        column: 1,
        index: "₁₂",
        stiffness_unit: "N/rad",
        damping_unit: "N*s/rad",
        meaning: "force per rotation",
    },
    Element {
        row: 1,
        column: 0,
        index: "₂₁",
        stiffness_unit: "N*m/m",
        damping_unit: "N*s",
        meaning: "moment per displacement",
    },
    Element {
        row: 1,
        column: 1,
        index: "₂₂",
        stiffness_unit: "N*m/rad",
        damping_unit: "N*m*s/rad",
        meaning: "moment per rotation",
    },
];

impl Element {
    /// The elements that mean anything: all four, or (1,1) where the blocks do not rotate.
    pub fn all(scalar: bool) -> &'static [Element] {
        if scalar { &ELEMENTS[..1] } else { &ELEMENTS }
    }

    /// The elements of a symmetric matrix: 11, 12, 22.
    pub fn distinct(scalar: bool) -> impl Iterator<Item = Element> {
        Self::all(scalar).iter().copied().filter(|e| e.column >= e.row)
    }

    pub fn of(self, matrix: &RealMatrix2) -> f64 {
        matrix.at(self.row, self.column)
    }

    /// `k₁₁`, or `K₁₁` for what eq (7) gives.
    pub fn stiffness(self, paper: bool) -> String {
        format!("{}{}", if paper { 'K' } else { 'k' }, self.index)
    }

    /// `c₁₁`, or `C₁₁` for what eq (7) gives.
    pub fn damping(self, paper: bool) -> String {
        format!("{}{}", if paper { 'C' } else { 'c' }, self.index)
    }
}

/// Which of the two matrices is spoken of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Stiffness,
    Damping,
}

impl Kind {
    pub fn symbol(self, element: Element, paper: bool) -> String {
        match self {
            Kind::Stiffness => element.stiffness(paper),
            Kind::Damping => element.damping(paper),
        }
    }

    /// What the element connects, in words.
    pub fn meaning(self, element: Element) -> String {
        match self {
            Kind::Stiffness => element.meaning.to_owned(),
            Kind::Damping => {
                element.meaning.replace("displacement", "velocity").replace("rotation", "angular velocity")
            }
        }
    }

    pub fn unit(self, element: Element) -> &'static str {
        match self {
            Kind::Stiffness => element.stiffness_unit,
            Kind::Damping => element.damping_unit,
        }
    }

    pub fn of<T>(self, (stiffness, damping): (T, T)) -> T {
        match self {
            Kind::Stiffness => stiffness,
            Kind::Damping => damping,
        }
    }

    /// Value and standard deviation of an element at a line.
    pub fn at(self, line: &JointLine, element: Element) -> (f64, Option<f64>) {
        let (value, std) = match self {
            Kind::Stiffness => (&line.stiffness, &line.stiffness_std),
            Kind::Damping => (&line.damping, &line.damping_std),
        };
        (element.of(value), std.as_ref().map(|std| element.of(std)))
    }

    /// What the fixture as it stands predicts for an element at a line of the recording; nothing where that is not known.
    pub fn nominal(self, analysis: &Analysis, line: usize, element: Element) -> Option<f64> {
        let scalar = analysis.spectrum.scalar;
        let (_, joint) = analysis.nominal.get(line)?.as_ref().filter(|_| !scalar)?;
        let (stiffness, damping) = analysis.spectrum.stiffness_and_damping(line, *joint);
        Some(match self {
            Kind::Stiffness => stiffness.at(element.row, element.column),
            Kind::Damping => damping.at(element.row, element.column),
        })
    }

    /// The fixture's element over the averaging band, on the lines that the averages were taken over.
    ///
    /// For the exact relation a stiffness is the joint's own; what eq (7) makes of it, and every damping, is a mean over lines.
    pub fn nominal_average(self, analysis: &Analysis, element: Element, paper: bool) -> Option<f64> {
        if self == Kind::Stiffness && !paper {
            return Some(element.of(&analysis.nominal_stiffness));
        }
        // The spectrum's nominal curves are those of its own relation.
        if paper != (analysis.spectrum.relation == Relation::Paper) {
            return None;
        }
        let lines = analysis.spectrum.solved.iter().filter(|l| analysis.averages.band.contains(l.frequency));
        let (sum, count) = lines
            .filter_map(|line| self.nominal(analysis, line.line, element))
            .fold((0.0, 0_usize), |(sum, count), value| (sum + value, count + 1));
        (count > 0).then(|| sum / count as f64)
    }
}
