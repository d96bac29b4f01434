//! The first two bending modes of a free uniform bar.

use std::f64::consts::TAU;

/// β·L/2 of the first free-free mode, symmetric: the first root of tan b + tanh b = 0.
const FIRST: f64 = 2.365_020_372_431_352;
/// β·L/2 of the second, antisymmetric: the first root of tan b − tanh b = 0.
const SECOND: f64 = 3.926_602_312_047_919;

/// Frequency of the first mode over that of the second.
pub(crate) const FIRST_TO_SECOND: f64 = FIRST * FIRST / (SECOND * SECOND);

/// Which mode of the bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Order {
    First,
    Second,
}

/// A bending mode of the body of a name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BodyMode<'a> {
    pub body: &'a str,
    pub order: Order,
    /// Natural frequency, Hz.
    pub frequency: f64,
    pub damping_ratio: f64,
}

impl BodyMode<'_> {
    /// Natural frequency, rad/s.
    pub(crate) fn omega(&self) -> f64 {
        TAU * self.frequency
    }
}

/// A free uniform bar with the mass and inertia of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct UniformBar {
    centre: f64,
    length: f64,
}

impl UniformBar {
    /// The bar of mass `mass` (kg) and inertia `inertia` (kg·m²) about its centre at `centre` (m).
    pub(crate) fn of(mass: f64, inertia: f64, centre: f64) -> Self {
        UniformBar { centre, length: (12.0 * inertia / mass).sqrt() }
    }

    /// Deflection (–) and slope (1/m) at abscissa `x` of the mode of unit mean square; beyond the bar's ends
    /// the shape goes on along its tangent.
    pub(crate) fn mode(&self, order: Order, x: f64) -> (f64, f64) {
        let u = (x - self.centre) / self.length;
        let inside = u.clamp(-0.5, 0.5);
        let (deflection, slope) = match order {
            Order::First => {
                let (b, argument) = (FIRST, 2.0 * FIRST * inside);
                let deflection = argument.cos() / b.cos() + argument.cosh() / b.cosh();
                (deflection, 2.0 * b * (argument.sinh() / b.cosh() - argument.sin() / b.cos()))
            }
            Order::Second => {
                let (b, argument) = (SECOND, 2.0 * SECOND * inside);
                let deflection = argument.sin() / b.sin() + argument.sinh() / b.sinh();
                (deflection, 2.0 * b * (argument.cos() / b.sin() + argument.cosh() / b.sinh()))
            }
        };
        (deflection + slope * (u - inside), slope / self.length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOTH: [Order; 2] = [Order::First, Order::Second];

    #[test]
    fn the_modes_have_unit_mean_square_and_no_momentum() {
        let bar = UniformBar::of(12.0, 1.0, 0.0);
        let n = 20_000;
        for order in BOTH {
            let mean = |f: &dyn Fn(f64, f64) -> f64| {
                let at = |i: usize| (i as f64 + 0.5) / n as f64 - 0.5;
                (0..n).map(|i| f(bar.mode(order, at(i)).0, at(i))).sum::<f64>() / n as f64
            };
            assert!((mean(&|v, _| v * v) - 1.0).abs() < 1e-7, "{order:?}");
            assert!(mean(&|v, _| v).abs() < 1e-7, "{order:?}");
            assert!(mean(&|v, x| v * x).abs() < 1e-7, "{order:?}: no angular momentum either");
        }
    }

    #[test]
    fn the_slope_is_the_derivative_of_the_deflection_inside_and_beyond_the_bar() {
        let bar = UniformBar::of(2.0, 3e-3, 0.04);
        for (order, x) in BOTH.into_iter().flat_map(|order| [-0.2, -0.01, 0.03, 0.1, 0.3].map(|x| (order, x)))
        {
            let h = 1e-6;
            let difference = (bar.mode(order, x + h).0 - bar.mode(order, x - h).0) / (2.0 * h);
            let slope = bar.mode(order, x).1;
            assert!(
                (difference - slope).abs() < 1e-6 * (1.0 + slope.abs()),
                "{order:?} at {x} m: {difference}, {slope}"
            );
        }
    }
}
