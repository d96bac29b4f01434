//! Magnitude and phase of an FRF, measured and as models have it.

use jointscope_spectra::FrfSet;
use num_complex::Complex64;

use super::{Axis, Plot, Role, Style};

/// A curve beside the measured one.
#[derive(Debug, Clone)]
pub(crate) struct Curve {
    pub label: &'static str,
    pub role: Role,
    pub style: Style,
    pub values: Vec<Option<Complex64>>,
}

/// What is drawn of one FRF.
#[derive(Debug, Clone)]
pub(crate) struct FrfPanes<'a> {
    /// Heading of the pane of magnitudes.
    pub title: String,
    /// What the FRF is called on its axes, such as `H 4/1`.
    pub symbol: String,
    /// Heading of the pane of phases.
    pub phase_title: String,
    pub unit: &'a str,
    pub hz: &'a [f64],
    pub measured: Vec<Option<Complex64>>,
    /// Half the width of the 95 % band of the noise; not drawn where empty.
    pub noise: Vec<Option<f64>>,
    pub curves: Vec<Curve>,
}

impl<'a> FrfPanes<'a> {
    /// An accelerance of a set with the noise that its variances tell, and other curves beside it.
    pub fn recorded(frfs: &'a FrfSet, index: usize, curves: Vec<Curve>) -> Self {
        let pair = &frfs.pairs()[index];
        // Each part of a value has half its variance, and the modulus takes one part of the noise.
        let half = |variance: &f64| Some(1.96 * (0.5 * variance).sqrt());
        FrfPanes {
            title: format!("FRF {pair}"),
            phase_title: format!("Phase of FRF {pair}"),
            symbol: format!("H {pair}"),
            unit: "(m/s^2)/N",
            hz: frfs.lines().hz(),
            measured: frfs.values(index).iter().map(|value| Some(*value)).collect(),
            noise: frfs.variance(index).unwrap_or_default().iter().map(half).collect(),
            curves,
        }
    }

    pub fn magnitude(&self) -> Plot {
        let size =
            |values: &[Option<Complex64>]| values.iter().map(|v| v.map(|v| v.norm())).collect::<Vec<_>>();
        let axis = Axis::logarithmic(format!("|{}|", self.symbol), self.unit);
        let mut plot = Plot::new(&self.title, Axis::frequency(), axis).over(self.hz);
        let measured = size(&self.measured);
        if !self.noise.is_empty() {
            let with_noise = || measured.iter().zip(&self.noise).map(|(size, half)| size.zip(*half));
            let low = with_noise().map(|line| line.map(|(size, half)| (size - half).max(0.05 * size)));
            let high = with_noise().map(|line| line.map(|(size, half)| size + half));
            plot = plot.band("noise, 95 %", Role::Uncertainty, low, high);
        }
        let plot = plot.line("measured", Role::Measured, measured).height(220);
        self.curves
            .iter()
            .fold(plot, |plot, curve| plot.series(curve.style, curve.label, curve.role, size(&curve.values)))
    }

    pub fn phase(&self) -> Plot {
        let axis = Axis::linear(format!("arg {}", self.symbol), "°");
        let mut phases: Vec<Vec<Option<f64>>> = vec![degrees(&self.measured)];
        phases.extend(self.curves.iter().map(|curve| degrees(&curve.values)));
        in_the_quietest_turn(&mut phases);
        let mut phases = phases.into_iter();
        let plot = Plot::new(&self.phase_title, Axis::frequency(), axis)
            .over(self.hz)
            .line("measured", Role::Measured, phases.next().unwrap_or_default())
            .height(220);
        self.curves
            .iter()
            .zip(phases)
            .fold(plot, |plot, (curve, phases)| plot.series(curve.style, curve.label, curve.role, phases))
    }
}

/// Places of so many of the worst, in their order.
pub(crate) fn worst(badness: &[f64], count: usize) -> Vec<usize> {
    let mut places: Vec<usize> = (0..badness.len()).collect();
    places.sort_by(|a, b| badness[*b].total_cmp(&badness[*a]));
    places.truncate(count);
    places.sort_unstable();
    places
}

/// Phases in degrees; nothing where there is no value or it is zero.
fn degrees(values: &[Option<Complex64>]) -> Vec<Option<f64>> {
    values.iter().map(|v| v.filter(|v| *v != Complex64::ZERO).map(|v| v.arg().to_degrees())).collect()
}

/// Moves the phases (degrees) of several curves into one turn, cut where the fewest neighbouring lines jump over the cut: noise about ±180°
/// would fill the pane.
fn in_the_quietest_turn(curves: &mut [Vec<Option<f64>>]) {
    let jumps = |cut: f64| -> usize {
        let of = |values: &Vec<Option<f64>>| {
            let pairs = values.windows(2).filter_map(|pair| pair[0].zip(pair[1]));
            pairs.filter(|(a, b)| (below(*a, cut) - below(*b, cut)).abs() > 180.0).count()
        };
        curves.iter().map(of).sum()
    };
    let cuts = [180.0, 90.0, 60.0, 45.0, 120.0, 135.0, 150.0, 210.0, 225.0, 240.0, 270.0, 30.0];
    let cut = cuts.into_iter().min_by_key(|cut| jumps(*cut)).unwrap_or(180.0);
    for value in curves.iter_mut().flatten().flatten() {
        *value = below(*value, cut);
    }
}

/// The phase in the turn that ends at `cut`, degrees.
fn below(degrees: f64, cut: f64) -> f64 {
    cut - (cut - degrees).rem_euclid(360.0)
}
