use crate::paper::{Elements, StiffnessRow};

/// K11·K22/(K12·K21) of a printed row, against what eq (7) can give.
///
/// For two equal blocks and a massless Euler strip, eq (7) averaged over any band that holds none of its two poles gives a ratio below one:
/// with u = 2EI/(L I ω²) and r = c/L a line has (2/3)(1 + 6 r u)/(1 − u)², which is one on the poles and less on either side of them, and
/// an average is the same expression at a mean u. So a row beyond one, by more than its rounding, belongs to no band of no such fixture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// The ratio as printed.
    pub ratio: f64,
    /// Smallest and largest ratio that rounds to the printed cells.
    pub rounding: (f64, f64),
}

/// Half of the last digit that Tables 2 and 3 print.
const HALF_DIGIT: f64 = 0.05;

impl Reach {
    /// The ratio of a row's SIM cells.
    pub fn of_sim(row: &StiffnessRow) -> Option<Self> {
        row.sim.map(|cells| Reach::of(&cells))
    }

    /// The ratio of four cells printed with one decimal.
    pub fn of(cells: &Elements) -> Self {
        // MN/m · kN·m/rad over kN/rad · kN·m/m.
        let ratio = |shift: f64| {
            let [k11, k12, k21, k22] = *cells;
            1e3 * (k11 + shift) * (k22 + shift) / ((k12 - shift) * (k21 - shift))
        };
        Reach { ratio: ratio(0.0), rounding: (ratio(-HALF_DIGIT), ratio(HALF_DIGIT)) }
    }

    /// What it means for the row, in a sentence.
    pub fn says(&self) -> &'static str {
        if self.rounding.0 > 1.0 {
            "no fixture of two equal blocks reaches these cells in any one band"
        } else if self.ratio > 1.0 {
            "beyond the bound as printed, and with rounding only on a pole of eq (7) itself: no band away from it reaches these cells"
        } else {
            "within reach"
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::STIFFNESS;

    /// Eq (7) in closed form on equal blocks, without its sign conventions: K11, K12, K21, K22 at u = 2EI/(L I ω²), in units of EI/L³ and L.
    fn line(u: f64, r: f64) -> Elements {
        let g = 1.0 / (1.0 - u * (12.0 * r + 6.0) + 3.0 * u * u);
        [12.0 * g, 6.0 * g * (1.0 - u), 6.0 * g * (1.0 - u), 2.0 * g * (1.0 + 6.0 * r * u)]
    }

    #[test]
    fn averages_over_bands_beside_the_poles_stay_below_one() {
        for r in [0.0, 0.5, 1.0, 3.0] {
            let upper_pole = (12.0 * r + 6.0 - ((12.0_f64 * r + 6.0).powi(2) - 12.0).sqrt()) / 6.0;
            for (from, to) in [(0.3, 0.99), (0.9, 0.999), (0.01, 0.5)] {
                // Equal steps of ω, u ∝ ω⁻².
                let lines: Vec<Elements> = (0..200)
                    .map(|i| {
                        let omega = 1.0 / f64::sqrt(from) * (1.0 - f64::from(i) / 199.0)
                            + f64::from(i) / 199.0 / f64::sqrt(to);
                        line(upper_pole / (omega * omega), r)
                    })
                    .collect();
                let mean = |e: usize| lines.iter().map(|l| l[e]).sum::<f64>() / 200.0;
                let ratio = mean(0) * mean(3) / (mean(1) * mean(2));
                assert!(ratio < 1.0 && ratio > 0.6, "c/L = {r}, {from} to {to}: {ratio}");
            }
        }
    }

    #[test]
    fn on_a_pole_the_ratio_is_one() {
        for r in [0.0_f64, 1.0, 5.0] {
            let pole = (12.0 * r + 6.0 - ((12.0 * r + 6.0).powi(2) - 12.0).sqrt()) / 6.0;
            let ratio = 2.0 / 3.0 * (1.0 + 6.0 * r * pole) / (1.0 - pole).powi(2);
            assert!((ratio - 1.0).abs() < 1e-12, "{ratio}");
        }
    }

    #[test]
    fn e0_is_out_of_reach_and_f01_is_not() {
        let reach =
            |name: &str| Reach::of_sim(STIFFNESS.iter().find(|row| row.example == name).unwrap()).unwrap();
        assert!(reach("E0").rounding.0 > 1.7);
        assert!(reach("F01").rounding.1 < 1.0);
        assert!(reach("D0").ratio > 1.0 && reach("D0").rounding.0 < 1.0);
    }
}
