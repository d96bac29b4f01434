//! The first free–free bending mode of a uniform bar: how a block bends that was taken as rigid.

/// βL of the first free–free mode: the first root above zero of cosh(βL)·cos(βL) = 1.
const ROOT: f64 = 4.730_040_744_862_704;

/// Shape of unit mean square of a bar centred at a block's centre of gravity; beyond the bar's ends
/// the shape goes on along its tangent.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BarShape {
    centre: f64,
    length: f64,
}

impl BarShape {
    /// The bar of mass `mass` and central inertia `inertia`: its length is √(12 I/m).
    pub(crate) fn new(mass: f64, inertia: f64, centre: f64) -> Self {
        BarShape { centre, length: (12.0 * inertia / mass).sqrt() }
    }

    /// Deflection and slope of the shape at abscissa `x`, 1 and 1/m.
    pub(crate) fn at(&self, x: f64) -> (f64, f64) {
        let half = 0.5 * self.length;
        let offset = x - self.centre;
        let inside = offset.clamp(-half, half);
        let (deflection, slope) = self.inside(inside);
        (deflection + slope * (offset - inside), slope)
    }

    // The symmetric form cos(βξ)/cos(βL/2) + cosh(βξ)/cosh(βL/2) is free of the cancellation in the usual
    // one; it reaches 2 at the ends, which is unit mean square.
    fn inside(&self, offset: f64) -> (f64, f64) {
        let beta = ROOT / self.length;
        let (c, ch) = ((0.5 * ROOT).cos(), (0.5 * ROOT).cosh());
        let z = beta * offset;
        (z.cos() / c + z.cosh() / ch, beta * (-z.sin() / c + z.sinh() / ch))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shape_has_unit_mean_square_and_moves_no_momentum() {
        let bar = BarShape::new(2.0, 2.0 * 0.1 * 0.1 / 12.0, 0.03);
        let n = 20_000;
        let mut sums = [0.0; 3];
        for i in 0..n {
            let x = 0.03 - 0.05 + 0.1 * (i as f64 + 0.5) / n as f64;
            let (deflection, _) = bar.at(x);
            sums[0] += deflection * deflection / n as f64;
            sums[1] += deflection / n as f64;
            sums[2] += deflection * (x - 0.03) / n as f64;
        }
        assert!((sums[0] - 1.0).abs() < 1e-6, "mean square {}", sums[0]);
        assert!(sums[1].abs() < 1e-6 && sums[2].abs() < 1e-9, "{sums:?}");
    }

    #[test]
    fn beyond_its_ends_the_shape_goes_on_along_its_tangent() {
        let bar = BarShape::new(2.0, 2.0 * 0.1 * 0.1 / 12.0, 0.0);
        let ((end, slope), (outside, same)) = (bar.at(0.05), bar.at(0.06));
        assert!((end - 2.0).abs() < 1e-12);
        assert!((outside - end - 0.01 * slope).abs() < 1e-12 && slope == same);
    }
}
