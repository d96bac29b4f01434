//! The first bending mode of a free uniform bar.

/// β·L/2 of the first symmetric free-free mode: the first root of tan b + tanh b = 0.
const HALF_WAVE_NUMBER: f64 = 2.365_020_372_431_352;

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

    /// Deflection (–) and slope (1/m) at abscissa `x` of the mode of unit mean square; beyond the bar's ends the
    /// shape goes on along its tangent.
    pub(crate) fn first_mode(&self, x: f64) -> (f64, f64) {
        let u = (x - self.centre) / self.length;
        let inside = u.clamp(-0.5, 0.5);
        let b = HALF_WAVE_NUMBER;
        let argument = 2.0 * b * inside;
        let deflection = argument.cos() / b.cos() + argument.cosh() / b.cosh();
        let slope = 2.0 * b * (argument.sinh() / b.cosh() - argument.sin() / b.cos());
        (deflection + slope * (u - inside), slope / self.length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mode_has_unit_mean_square_and_no_momentum() {
        let bar = UniformBar::of(12.0, 1.0, 0.0);
        let n = 20_000;
        let mean = |f: &dyn Fn(f64) -> f64| {
            (0..n).map(|i| f(bar.first_mode((i as f64 + 0.5) / n as f64 - 0.5).0)).sum::<f64>() / n as f64
        };
        assert!((mean(&|v| v * v) - 1.0).abs() < 1e-7);
        assert!(mean(&|v| v).abs() < 1e-7);
    }

    #[test]
    fn the_slope_is_the_derivative_of_the_deflection_inside_and_beyond_the_bar() {
        let bar = UniformBar::of(2.0, 3e-3, 0.04);
        for x in [-0.2, -0.01, 0.03, 0.1, 0.3] {
            let h = 1e-6;
            let difference = (bar.first_mode(x + h).0 - bar.first_mode(x - h).0) / (2.0 * h);
            let slope = bar.first_mode(x).1;
            assert!(
                (difference - slope).abs() < 1e-6 * (1.0 + slope.abs()),
                "at {x} m: {difference}, {slope}"
            );
        }
    }
}
