//! Motions of points as rows over the coordinates, by which springs, sensors and forces are attached.

/// A motion as a combination of coordinates: pairs of a coordinate's index and its factor.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Row(Vec<(usize, f64)>);

impl Row {
    /// No motion at all.
    pub fn zero() -> Self {
        Row::default()
    }

    /// One coordinate as it is.
    pub fn coordinate(index: usize) -> Self {
        Row(vec![(index, 1.0)])
    }

    /// This motion plus `factor` times `other`.
    pub(crate) fn plus(&self, factor: f64, other: &Row) -> Self {
        let mut sum = self.0.clone();
        for &(index, value) in &other.0 {
            match sum.iter_mut().find(|(i, _)| *i == index) {
                Some((_, total)) => *total += factor * value,
                None => sum.push((index, factor * value)),
            }
        }
        sum.retain(|(_, value)| *value != 0.0);
        Row(sum)
    }

    /// The relative motion `self − other`.
    pub(crate) fn minus(&self, other: &Row) -> Self {
        self.plus(-1.0, other)
    }

    /// Coordinates and factors.
    pub fn terms(&self) -> &[(usize, f64)] {
        &self.0
    }
}

/// A place on the structure: its transverse motion y and its rotation θ.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Station {
    /// Transverse motion, m.
    pub y: Row,
    /// Rotation, rad.
    pub theta: Row,
}

impl Station {
    /// A node with two coordinates of its own.
    pub(crate) fn node(y: usize, theta: usize) -> Self {
        Station { y: Row::coordinate(y), theta: Row::coordinate(theta) }
    }

    /// The place at `distance` (m, along x) on what is rigidly connected to this one.
    pub(crate) fn rigidly_at(&self, distance: f64) -> Self {
        Station { y: self.y.plus(distance, &self.theta), theta: self.theta.clone() }
    }

    /// The relative motion u − R·u_from across `length`, in translation and rotation.
    pub(crate) fn relative_to(&self, from: &Station, length: f64) -> [Row; 2] {
        let carried = from.rigidly_at(length);
        [self.y.minus(&carried.y), self.theta.minus(&carried.theta)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rigid_motion_has_no_relative_motion_across_any_length() {
        let from = Station::node(0, 1);
        let to = from.rigidly_at(0.3);
        assert_eq!(to.y.terms(), [(0, 1.0), (1, 0.3)]);
        assert_eq!(to.relative_to(&from, 0.3), [Row::zero(), Row::zero()]);
    }
}
