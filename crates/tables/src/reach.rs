//! Which printed rows eq (7) can give, and on which side of its poles.
//!
//! For two rigid blocks and a massless Euler strip eq (7) has, with x = ω², p = 2EI/(L I_A x), q = 2EI/(L I_B
//! x), σ = (EI/L²)(c_A/I_A + c_B/I_B)/x,
//!
//! K11 = (12EI/L³) g, |K12| = (6EI/L²) g |1 − q|, |K21| = (6EI/L²) g |1 − p|, |K22| = (2EI/L) g (1 + 6σ),
//! 1/g = 1 − 12σ − 3(p + q) + 3pq,
//!
//! so that K11·K22/(K12·K21) − 1 = −1/(3 g (1 − p)(1 − q)) in magnitudes. 1/g has two roots in x, the poles
//! of eq (7), and is negative between them. It is negative where p or q is one, so these places lie between
//! the poles. Above the upper pole p and q are below one and below the lower pole both are beyond it: there
//! the ratio is below one, and above 2/3 in the first. Between the poles it is beyond one wherever K12 and
//! K21 have the signs that they have outside, as two equal blocks always do.
//!
//! An average over a band without a pole is the same expression at a mean of 1/x, weighted by g, which has
//! one sign there. So what holds for a line holds for every such average.

use crate::paper::{Elements, StiffnessRow};
use jointscope_averaging::Band;

/// Where a band lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// Above the upper pole.
    Above,
    /// Between the poles.
    Between,
    /// Below the lower pole.
    Below,
}

impl Side {
    /// All of them.
    pub(crate) const ALL: [Side; 3] = [Side::Above, Side::Between, Side::Below];

    /// As tables and files write it.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Side::Above => "above the upper pole",
            Side::Between => "between the poles",
            Side::Below => "below the lower pole",
        }
    }

    /// Infimum and supremum of the ratio there, neither of which is reached.
    fn ratios(self) -> (f64, f64) {
        match self {
            Side::Above => (2.0 / 3.0, 1.0),
            Side::Between => (1.0, f64::INFINITY),
            Side::Below => (0.0, 1.0),
        }
    }
}

/// K11·K22/(K12·K21) of a printed row, against what eq (7) can give.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reach {
    /// The ratio as printed.
    pub ratio: f64,
    /// Smallest and largest ratio that rounds to the printed cells.
    pub rounding: (f64, f64),
}

/// Half of the last digit that Tables 2 and 3 print.
const HALF_DIGIT: f64 = 0.05;

impl Reach {
    /// The ratio of a row's SIM cells.
    pub(crate) fn of_sim(row: &StiffnessRow) -> Option<Self> {
        row.sim.map(|cells| Reach::of(&cells))
    }

    /// The ratio of four cells printed with one decimal.
    pub(crate) fn of(cells: &Elements) -> Self {
        // MN/m · kN·m/rad over kN/rad · kN·m/m.
        let ratio = |shift: f64| {
            let [k11, k12, k21, k22] = *cells;
            1e3 * (k11 + shift) * (k22 + shift) / ((k12 - shift) * (k21 - shift))
        };
        Reach { ratio: ratio(0.0), rounding: (ratio(-HALF_DIGIT), ratio(HALF_DIGIT)) }
    }

    /// On which sides of the poles a band without one can have a ratio that rounds to the printed one.
    pub(crate) fn sides(&self) -> Vec<Side> {
        let (low, high) = self.rounding;
        let meets = |side: &Side| low < side.ratios().1 && high > side.ratios().0;
        Side::ALL.into_iter().filter(meets).collect()
    }

    /// What it means for the row, in words.
    pub(crate) fn says(&self) -> String {
        let names: Vec<&str> = self.sides().into_iter().map(Side::name).collect();
        match names.as_slice() {
            [] => "in no band without a pole".to_owned(),
            [only] => format!("{only} only"),
            all if all.len() == Side::ALL.len() && self.ratio > 1.0 => {
                "between the poles as printed; beside them only near a pole, and by rounding".to_owned()
            }
            all => all.join(" or "),
        }
    }
}

/// A fixture of two equal blocks whose average by eq (7) between the poles has given cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Witness {
    /// Of the strip, N·m².
    pub bending_stiffness: f64,
    /// Of the strip, m.
    pub length: f64,
    /// Of each block about its centre of gravity, kg·m².
    pub inertia: f64,
    /// From the strip's end to the centre of gravity of its block, m.
    pub arm: f64,
    /// What is averaged over.
    pub band: Band,
}

/// Arms tried, as shares of the strip's length.
const ARMS: [f64; 5] = [0.5, 0.75, 1.0, 1.5, 2.0];
/// The band tried: what the paper's recordings have at their upper end.
const BAND: Band = Band { from: 600.0, to: 1000.0 };
/// Lines of the band, as the paper's lie.
const STEP: f64 = 2.5;

/// Mean g, g(1 − u) and g(1 + 6ru) of two equal blocks over [`BAND`], u = κ/ω².
fn means(kappa: f64, r: f64) -> [f64; 3] {
    let count = ((BAND.to - BAND.from) / STEP) as usize + 1;
    let mut sums = [0.0; 3];
    for line in 0..count {
        let omega = std::f64::consts::TAU * (BAND.from + STEP * line as f64);
        let u = kappa / (omega * omega);
        let g = 1.0 / (1.0 - u * (12.0 * r + 6.0) + 3.0 * u * u);
        [g, g * (1.0 - u), g * (1.0 + 6.0 * r * u)].iter().zip(&mut sums).for_each(|(v, sum)| *sum += v);
    }
    sums.map(|sum| sum / count as f64)
}

impl Witness {
    /// Of cells with K12 = K21 whose ratio is beyond one; the first that is found with a band clear of the
    /// poles by a tenth.
    pub fn between_the_poles(cells: &Elements) -> Option<Self> {
        let [k11, k12, k21, k22] = *cells;
        let ratio = 1e3 * k11 * k22 / (k12 * k21);
        if ratio.partial_cmp(&1.0) != Some(std::cmp::Ordering::Greater) || k12 != k21 {
            return None;
        }
        ARMS.into_iter().find_map(|r| {
            let omegas = [BAND.from, BAND.to].map(|hz| (std::f64::consts::TAU * hz).powi(2));
            // u of the upper pole; the band's upper end lies below it, its lower end where K12 has its sign
            // still.
            let pole = (12.0 * r + 6.0 - ((12.0 * r + 6.0f64).powi(2) - 12.0).sqrt()) / 6.0;
            let (mut low, mut high) = (1.1 * pole * omegas[1], 0.9 * omegas[0]);
            let excess = |kappa: f64| {
                let [a, b, d] = means(kappa, r);
                2.0 / 3.0 * a * d / (b * b) - ratio
            };
            if !(low < high && excess(low) < 0.0 && excess(high) > 0.0) {
                return None;
            }
            for _ in 0..200 {
                let middle = 0.5 * (low + high);
                if excess(middle) < 0.0 { low = middle } else { high = middle }
            }
            let [a, b, _] = means(low, r).map(f64::abs);
            let length = 2.0 * (1e3 * k12 / (1e6 * k11)) * a / b;
            let bending_stiffness = 1e6 * k11 * length.powi(3) / (12.0 * a);
            let inertia = 2.0 * bending_stiffness / (length * low);
            Some(Witness { bending_stiffness, length, inertia, arm: r * length, band: BAND })
        })
    }

    /// It in words.
    pub(crate) fn says(&self) -> String {
        format!(
            "EI {:.0} N*m^2 over {:.1} mm, blocks of {:.5} kg*m^2 with {:.1} mm to the centre, {:.0}-{:.0} Hz",
            self.bending_stiffness,
            1e3 * self.length,
            self.inertia,
            1e3 * self.arm,
            self.band.from,
            self.band.to
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::STIFFNESS;

    /// Eq (7) of two blocks: K11, |K12|, |K21|, |K22| at x in units where EI = L = 1, and 1/g.
    fn line(x: f64, [ia, ib, ca, cb]: [f64; 4]) -> ([f64; 4], f64) {
        let (p, q, s) = (2.0 / (ia * x), 2.0 / (ib * x), (ca / ia + cb / ib) / x);
        let reciprocal = 1.0 - 12.0 * s - 3.0 * (p + q) + 3.0 * p * q;
        let g = 1.0 / reciprocal;
        ([12.0 * g, 6.0 * g * (1.0 - q), 6.0 * g * (1.0 - p), 2.0 * g * (1.0 + 6.0 * s)], reciprocal)
    }

    /// The two poles in x.
    fn poles([ia, ib, ca, cb]: [f64; 4]) -> (f64, f64) {
        let (b, c) = (12.0 * (ca / ia + cb / ib) + 6.0 * (1.0 / ia + 1.0 / ib), 12.0 / (ia * ib));
        let root = (b * b - 4.0 * c).sqrt();
        (0.5 * (b - root), 0.5 * (b + root))
    }

    #[test]
    fn averages_stay_below_one_outside_the_poles_and_exceed_it_between_them() {
        let equal = |r: f64| [1.0, 1.0, r, r];
        for blocks in [equal(0.0), equal(0.5), equal(3.0), [0.3, 1.0, 0.2, 0.7], [1.0, 5.0, 2.0, 0.1]] {
            let (lower, upper) = poles(blocks);
            assert!(line(lower, blocks).1.abs() < 1e-9 && line(upper, blocks).1.abs() < 1e-9);
            let average = |from: f64, to: f64| {
                // Equal steps of ω.
                let at = |i: usize| (from.sqrt() + (to.sqrt() - from.sqrt()) * i as f64 / 199.0).powi(2);
                let mut sums = [0.0; 4];
                for i in 0..200 {
                    line(at(i), blocks).0.iter().zip(&mut sums).for_each(|(value, sum)| *sum += value);
                }
                sums[0] * sums[3] / (sums[1] * sums[2])
            };
            for (from, to) in [(1.001, 1.1), (1.1, 3.0), (2.0, 50.0), (1.01, 900.0)] {
                let above = average(from * upper, to * upper);
                assert!((2.0 / 3.0..1.0).contains(&above), "{blocks:?} above {from} {to}: {above}");
                let below = average(lower / to, lower / from);
                assert!((0.0..1.0).contains(&below), "{blocks:?} below {from} {to}: {below}");
            }
            for (from, to) in [(0.01, 0.2), (0.1, 0.6), (0.3, 0.9), (0.05, 0.95)] {
                let between = average(lower + from * (upper - lower), lower + to * (upper - lower));
                // Unequal blocks have K12 and K21 of other signs in a part of it.
                assert!(between > 1.0 || (blocks[0] != blocks[1] && between < 0.0), "{blocks:?}: {between}");
            }
        }
    }

    #[test]
    fn each_row_is_met_on_the_sides_that_its_rounding_allows() {
        let reach =
            |name: &str| Reach::of_sim(STIFFNESS.iter().find(|row| row.example == name).unwrap()).unwrap();
        assert_eq!(reach("E0").sides(), [Side::Between]);
        assert_eq!(reach("F01").sides(), [Side::Above, Side::Below]);
        assert_eq!(reach("D0").sides(), Side::ALL);
        assert_eq!(reach("F02").sides(), Side::ALL);
        assert_eq!(Reach { ratio: 0.5, rounding: (0.45, 0.55) }.sides(), [Side::Below]);
    }

    #[test]
    fn no_witness_is_made_up_for_cells_that_equal_blocks_cannot_have() {
        assert!(Witness::between_the_poles(&[3.3, 107.9, 105.5, 3.5]).is_none());
        assert!(Witness::between_the_poles(&[25.1, 308.6, 308.6, 2.8]).is_none());
        assert!(Witness::between_the_poles(&[f64::NAN, 1.0, 1.0, 1.0]).is_none());
    }
}
