//! Magnitude and phase of an FRF, measured and as models have it, and what the models leave of it.

use jointscope_inference::Z95;
use jointscope_spectra::FrfSet;
use num_complex::Complex64;

use super::{Axis, Plot, Role, Span, Style, YRange};

/// Modulus that a complex normal variable of unit variance exceeds in 5 %: √(χ²₂/2).
const RAYLEIGH_95: f64 = 1.7308;
/// Steps of phases, °, and of residuals: nobody reads more of them, and long recordings make long pages.
const STEPS: (f64, f64) = (0.1, 0.01);

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
    /// Half the width of the 95 % band of one part's noise; not drawn where empty.
    pub noise: Vec<Option<f64>>,
    /// γ² by line, where it was recorded.
    pub coherence: Option<&'a [f64]>,
    pub curves: Vec<Curve>,
}

/// Height of a strip and how finely its ordinates are told.
const STRIP: (u32, f64) = (104, 1e-3);
/// Lines above which a strip is drawn thinned: it is to be looked along, not read.
const STRIP_LINES: usize = 800;
/// Lines above which the other panes of an FRF are: a page holds five of each.
const PANE_LINES: usize = 1_400;
/// What lines without coherence are called.
const UNUSED: &str = "no coherence, not used";

/// An empty plot of what lies between 0 and 1, such as a coherence.
pub(crate) fn over_unity(title: impl Into<String>, label: &str) -> Plot {
    Plot::new(title, Axis::frequency(), Axis::linear(label, ""))
        .y_range(YRange::Held { low: -0.04, high: 1.04 })
        .height(STRIP.0)
        .rounded_to(STRIP.1)
}

impl<'a> FrfPanes<'a> {
    /// An accelerance of a set with the noise that its variances tell, and other curves beside it.
    pub(crate) fn recorded(frfs: &'a FrfSet, index: usize, curves: Vec<Curve>) -> Self {
        let pair = &frfs.pairs()[index];
        // Each part of a value has half its variance, and the modulus takes one part of the noise.
        let half = |variance: &f64| Some(Z95 * (0.5 * variance).sqrt());
        FrfPanes {
            title: format!("FRF {pair}"),
            phase_title: format!("Phase of FRF {pair}"),
            symbol: format!("H {pair}"),
            unit: "(m/s^2)/N",
            hz: frfs.lines().hz(),
            measured: frfs.values(index).iter().map(|value| Some(*value)).collect(),
            noise: frfs.variance(index).unwrap_or_default().iter().map(half).collect(),
            coherence: frfs.coherence(index),
            curves,
        }
    }

    pub(crate) fn magnitude(&self) -> Plot {
        let size =
            |values: &[Option<Complex64>]| values.iter().map(|v| v.map(|v| v.norm())).collect::<Vec<_>>();
        let axis = Axis::logarithmic(format!("|{}|", self.symbol), self.unit);
        let mut plot = Plot::new(&self.title, Axis::frequency(), axis).over(self.hz).line_limit(PANE_LINES);
        let measured = size(&self.measured);
        if !self.noise.is_empty() {
            let with_noise = || measured.iter().zip(&self.noise).map(|(size, half)| size.zip(*half));
            let low = with_noise().map(|line| line.map(|(size, half)| (size - half).max(0.05 * size)));
            let high = with_noise().map(|line| line.map(|(size, half)| size + half));
            plot = plot.band("noise, 95 %", Role::Uncertainty, low, high);
        }
        let unused = self.unused().map(|unused| {
            let values = measured.iter().zip(&unused);
            values.map(|(size, unused)| size.filter(|_| *unused)).collect::<Vec<_>>()
        });
        let gaps = measured.iter().filter(|value| value.is_none()).count();
        let range = YRange::decades(measured.iter().flatten().copied().filter(|size| *size > 0.0));
        let plot = plot.line("measured", Role::Measured, measured).height(220).y_range(range);
        let plot = self
            .curves
            .iter()
            .fold(plot, |plot, curve| plot.series(curve.style, curve.label, curve.role, size(&curve.values)));
        match unused {
            Some(values) => plot.points(UNUSED, Role::Reference, values).masked(gaps),
            None => plot,
        }
    }

    /// Lines that are not used because the FRF has no coherence there; nothing where it has some on all.
    fn unused(&self) -> Option<Vec<bool>> {
        let unused: Vec<bool> = self.coherence?.iter().map(|gamma2| *gamma2 <= 0.0).collect();
        unused.contains(&true).then_some(unused)
    }

    /// The coherence from 0 to 1 as a strip below magnitude and phase, where it was recorded.
    pub(crate) fn coherence(&self) -> Option<Plot> {
        let coherence = self.coherence?;
        let plot = over_unity(format!("Coherence of {}", self.symbol), "γ²")
            .strip()
            .line_limit(STRIP_LINES)
            .over(self.hz)
            .line("coherence", Role::Measured, coherence);
        Some(match self.unused() {
            None => plot.caption("Coherence as recorded."),
            Some(unused) => {
                let count = unused.iter().filter(|unused| **unused).count();
                let lines = if count == 1 { "1 line is" } else { &format!("{count} lines are") };
                plot.points(UNUSED, Role::Reference, unused.iter().map(|unused| unused.then_some(0.0)))
                    .masked(0)
                    .caption(format!("Coherence as recorded; {lines} without any and not used."))
            }
        })
    }

    pub(crate) fn phase(&self) -> Plot {
        let axis = Axis::linear(format!("arg {}", self.symbol), "°");
        let mut phases: Vec<Vec<Option<f64>>> = vec![degrees(&self.measured)];
        phases.extend(self.curves.iter().map(|curve| degrees(&curve.values)));
        in_the_quietest_turn(&mut phases);
        let mut phases = phases.into_iter();
        let plot = Plot::new(&self.phase_title, Axis::frequency(), axis)
            .over(self.hz)
            .line("measured", Role::Measured, phases.next().unwrap_or_default())
            .rounded_to(STEPS.0)
            .line_limit(PANE_LINES)
            .height(220);
        self.curves
            .iter()
            .zip(phases)
            .fold(plot, |plot, (curve, phases)| plot.series(curve.style, curve.label, curve.role, phases))
    }

    /// Everything that there is to draw, in rows of two.
    pub(crate) fn all(&self) -> impl Iterator<Item = Plot> {
        [self.magnitude(), self.phase()].into_iter().chain(self.below())
    }

    /// What stands below magnitude and phase: coherence and residuals.
    pub(crate) fn below(&self) -> impl Iterator<Item = Plot> {
        self.coherence().into_iter().chain(self.residuals())
    }

    /// What every curve leaves of the measured one over its noise, and both parts of what the last one
    /// leaves; nothing without curves or noise.
    fn residuals(&self) -> Vec<Plot> {
        let Some(last) = self.curves.last().filter(|_| !self.noise.is_empty()) else { return Vec::new() };
        let left = |curve: &Curve| -> Vec<Option<Complex64>> {
            let lines = self.measured.iter().zip(&curve.values).zip(&self.noise);
            lines
                .map(|((measured, model), half)| {
                    Some((measured.as_ref()? - model.as_ref()?) * (Z95 / (*half)?))
                })
                .collect()
        };
        let part =
            |of: fn(&Complex64) -> f64| left(last).iter().map(|v| v.as_ref().map(of)).collect::<Vec<_>>();
        // One part has half the variance of the complex value.
        let size = |curve: &Curve| part_size(&left(curve));
        let largest = Span::of(self.curves.iter().flat_map(size).flatten()).magnitude();
        let pane = |title: String, axis: Axis| {
            Plot::new(title, Axis::frequency(), axis)
                .over(self.hz)
                .digits(3)
                .line_limit(PANE_LINES)
                .height(150)
        };
        let sizes = pane(format!("Residuals of {}", self.title), Axis::logarithmic("|residual|/σ", ""));
        let sizes = sizes
            .y_range(YRange::Fixed { low: 0.1, high: 10f64.powf(largest.max(1.0).log10().ceil().max(1.0)) })
            .horizontal("exceeded by 5 % of noise", Role::Measured, RAYLEIGH_95)
            .caption("|measured − model| over the standard deviation of the noise.");
        let sizes = self
            .curves
            .iter()
            .fold(sizes, |plot, curve| plot.series(curve.style, curve.label, curve.role, size(curve)));
        let parts =
            pane(format!("Residual of {}, {}", self.title, last.label), Axis::linear("residual/σ", ""))
                .y_range(YRange::Robust)
                .rounded_to(STEPS.1)
                .points("real part", Role::Trace(0), part(|v| v.re))
                .points("imaginary part", Role::Trace(1), part(|v| v.im))
                .horizontal("± 95 % of noise", Role::Reference, Z95)
                .horizontal("", Role::Reference, -Z95)
                .caption(format!(
                    "Measured − {}, each part over its noise: without a course where noise alone is left.",
                    last.label
                ));
        vec![sizes, parts]
    }
}

/// |r|/√2 of residuals whose parts have unit variance.
fn part_size(residuals: &[Option<Complex64>]) -> Vec<Option<f64>> {
    residuals.iter().map(|v| v.map(|v| v.norm() * std::f64::consts::FRAC_1_SQRT_2)).collect()
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

/// How far, °, a curve may be drawn beyond either end of its turn rather than jump over it.
const BEYOND: f64 = 120.0;

/// Moves the phases (degrees) of several curves, the measured one first, into one turn, cut where the fewest
/// neighbouring lines jump over the cut: noise about ±180° would fill the pane. Beyond the cut a curve is
/// followed a little way, and models are drawn beside what was measured.
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
    let Some((measured, models)) = curves.split_first_mut() else { return };
    let mut before = None;
    for value in measured.iter_mut().flatten() {
        *value = beside(below(*value, cut), before, cut);
        before = Some(*value);
    }
    for model in models {
        let mut before = None;
        for (value, measured) in model.iter_mut().zip(&*measured) {
            let Some(value) = value else { continue };
            let own = below(*value, cut);
            let off = |measured: f64| below(own - measured, 180.0);
            // Opposite to what was measured a model is on either side of it.
            let near = measured.filter(|measured| off(*measured).abs() < 90.0);
            *value = near.map_or_else(|| beside(own, before, cut), |measured| measured + off(measured));
            before = Some(*value);
        }
    }
}

/// The phase as near to another one as the ends of the turn let it be.
fn beside(degrees: f64, other: Option<f64>, cut: f64) -> f64 {
    let turns = other.map_or(0.0, |other| ((other - degrees) / 360.0).round());
    let nearest = degrees + 360.0 * turns;
    if (cut - 360.0 - BEYOND..=cut + BEYOND).contains(&nearest) { nearest } else { degrees }
}

/// The phase in the turn that ends at `cut`, degrees.
fn below(degrees: f64, cut: f64) -> f64 {
    cut - (cut - degrees).rem_euclid(360.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Phases whose neighbours lie more than half a turn apart.
    fn jumps(phases: &[Option<f64>]) -> usize {
        let pairs = phases.windows(2).filter_map(|pair| pair[0].zip(pair[1]));
        pairs.filter(|(a, b)| (a - b).abs() > 180.0).count()
    }

    /// Degrees as `arg` gives them.
    fn wrapped(degrees: f64) -> Option<f64> {
        Some(below(degrees, 180.0))
    }

    #[test]
    fn wide_noise_about_both_signs_of_half_a_turn_leaves_no_jumps() {
        // From −180° over a resonance's 0° to −180° again, each with noise of up to 85° to either side.
        let noise = |line: usize| 85.0 * ((line * 37 % 100) as f64 / 50.0 - 1.0);
        let course = |line: usize| match line {
            0..100 => -180.0,
            100..200 => 0.0,
            _ => 180.0,
        };
        let measured: Vec<_> = (0..300).map(|line| wrapped(course(line) + noise(line))).collect();
        let model: Vec<_> = (0..300).map(|line| wrapped(course(line) + 1.0)).collect();
        assert!(jumps(&measured) > 50);
        let mut curves = [measured.clone(), model];
        in_the_quietest_turn(&mut curves);
        assert!(curves.iter().all(|curve| jumps(curve) <= 2), "{} {}", jumps(&curves[0]), jumps(&curves[1]));
        for (line, (drawn, given)) in curves[0].iter().zip(&measured).enumerate() {
            let turns = (drawn.unwrap() - given.unwrap()) / 360.0;
            assert!((turns - turns.round()).abs() < 1e-9, "line {line} is drawn at another phase");
        }
        for (line, (measured, model)) in curves[0].iter().zip(&curves[1]).enumerate() {
            let apart = (measured.unwrap() - model.unwrap()).abs();
            assert!(apart < 90.0, "line {line}: the model is drawn {apart}° from what was measured");
        }
    }

    #[test]
    fn a_phase_that_turns_on_and_on_stays_in_the_pane() {
        let turning: Vec<_> = (0..400).map(|line| wrapped(-10.0 * f64::from(line))).collect();
        let mut curves = [turning];
        in_the_quietest_turn(&mut curves);
        let span = Span::of(curves[0].iter().copied().flatten());
        assert!(span.width() <= 360.0 + 2.0 * BEYOND, "{}", span.width());
    }
}
