//! The laws over frequency that an unknown scalar may follow, by the kind of its site.

use super::Site;
use jointscope_fixture::Dof;
use jointscope_lumped::{Delta, PointLaw};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// A line as a law sees it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub omega: f64,
    /// Accelerance of a response's own position.
    pub driving: Complex64,
}

impl Line {
    /// s = iω.
    fn s(self) -> Complex64 {
        Complex64::new(0.0, self.omega)
    }
}

/// A law: the missing component over frequency by a few parameters, the first of which is an amplitude. Of
/// what is in series it is the compliance: there nothing missing is zero.
#[derive(Clone, Copy)]
pub(super) struct Law {
    pub name: &'static str,
    pub formula: &'static str,
    /// Names and units of the parameters stated.
    pub parameters: &'static [(&'static str, &'static str)],
    /// Whether the component is proportional to the first parameter, so that it need not be sought.
    pub proportional: bool,
    /// Parameters to start from, for a band of angular frequencies.
    pub starts: fn(f64, f64) -> Vec<Vec<f64>>,
    pub value: fn(Line, &[f64]) -> Complex64,
    /// The parameters stated, of those fitted.
    pub stated: fn(&[f64]) -> Vec<f64>,
}

fn one(_: f64, _: f64) -> Vec<Vec<f64>> {
    vec![vec![1.0]]
}

fn same(parameters: &[f64]) -> Vec<f64> {
    parameters.to_vec()
}

/// A factor by its departure from one.
fn as_factor(parameters: &[f64]) -> Vec<f64> {
    vec![1.0 + parameters[0]]
}

fn constant(_: Line, parameters: &[f64]) -> Complex64 {
    Complex64::new(parameters[0], 0.0)
}

/// `count` values from `low` to `high`, evenly on a logarithmic scale.
fn between(low: f64, high: f64, count: usize) -> impl Iterator<Item = f64> {
    let (from, to) = (low.ln(), high.ln());
    (0..count).map(move |i| (from + (to - from) * (i as f64 + 0.5) / count as f64).exp())
}

fn resonators(low: f64, high: f64) -> Vec<Vec<f64>> {
    let frequencies = between(low, 1.1 * high, 60);
    frequencies.flat_map(|omega| [0.005, 0.03].map(|ratio| vec![1.0, omega.ln(), ratio])).collect()
}

fn times(low: f64, high: f64) -> Vec<Vec<f64>> {
    between(0.2 / high, 5.0 / low, 16).map(|time| vec![1.0, time.ln()]).collect()
}

fn delays(_: f64, high: f64) -> Vec<Vec<f64>> {
    [-2.0, -1.0, -0.5, -0.2, -0.05, 0.05, 0.2, 0.5, 1.0, 2.0].map(|turn| vec![turn / high]).to_vec()
}

fn sensors(_: f64, _: f64) -> Vec<Vec<f64>> {
    [1e-3, 5e-3, 2e-2, 0.1].map(|mass| vec![mass]).to_vec()
}

/// k + iωc.
fn spring(stiffness: f64, damping: f64) -> Delta {
    Delta::Stiffness(PointLaw::Spring { stiffness, damping })
}

const MASS: Law = Law {
    name: "a mass",
    formula: "−ω²m",
    parameters: &[("mass", "kg")],
    proportional: true,
    starts: one,
    value: |line, p| Delta::Stiffness(PointLaw::Mass(p[0])).at(line.s()),
    stated: same,
};
const SPRING: Law = Law {
    name: "a spring",
    formula: "k",
    parameters: &[("stiffness", "N/m")],
    proportional: true,
    starts: one,
    value: |line, p| spring(p[0], 0.0).at(line.s()),
    stated: same,
};
const DASHPOT: Law = Law {
    name: "a dashpot",
    formula: "iωc",
    parameters: &[("damping", "N*s/m")],
    proportional: true,
    starts: one,
    value: |line, p| spring(0.0, p[0]).at(line.s()),
    stated: same,
};
const SPRING_AND_DASHPOT: Law = Law {
    name: "a spring and a dashpot",
    formula: "k + iωc",
    parameters: &[("stiffness", "N/m"), ("damping", "N*s/m")],
    proportional: true,
    // A dashpot in shares of the spring over the band's highest line.
    starts: |_, high| [0.0, 0.01, 0.1, 1.0].map(|turn| vec![1.0, turn / high]).to_vec(),
    value: |line, p| p[0] * spring(1.0, p[1]).at(line.s()),
    stated: |p| vec![p[0], p[0] * p[1]],
};
const RESONATOR: Law = Law {
    name: "a mass on a spring",
    formula: "−ω²m(ω_a² + 2iζω_aω)/(ω_a² − ω² + 2iζω_aω)",
    parameters: &[("mass", "kg"), ("frequency", "Hz"), ("damping_ratio", "")],
    proportional: true,
    starts: resonators,
    value: |line, p| {
        // Without its peak a resonator is a mass or a support: those have laws of their own.
        if !(0.0..1.0).contains(&p[2]) {
            return Complex64::new(f64::NAN, f64::NAN);
        }
        let (omega, own) = (line.omega, p[1].exp());
        let spring = own * own + line.s() * (2.0 * p[2] * own);
        -omega * omega * p[0] * spring / (spring - omega * omega)
    },
    stated: |p| vec![p[0], p[1].exp() / TAU, p[2]],
};
const YIELDING: Law = Law {
    name: "a spring in series",
    formula: "k",
    parameters: &[("stiffness", "N/m")],
    proportional: true,
    starts: one,
    value: constant,
    stated: |p| vec![1.0 / p[0]],
};
const YIELDING_AND_LOSSY: Law = Law {
    name: "a spring and a dashpot in series",
    formula: "k + iωc",
    parameters: &[("stiffness", "N/m"), ("damping", "N*s/m")],
    proportional: true,
    starts: |_, high| [0.01, 0.1, 0.5].map(|turn| vec![1.0, turn / high]).to_vec(),
    value: |line, p| p[0] / spring(1.0, p[1]).at(line.s()),
    stated: |p| vec![1.0 / p[0], p[1] / p[0]],
};
const YIELDING_ROTATION: Law = Law { parameters: &[("stiffness", "N*m/rad")], ..YIELDING };
const YIELDING_AND_LOSSY_ROTATION: Law =
    Law { parameters: &[("stiffness", "N*m/rad"), ("damping", "N*m*s/rad")], ..YIELDING_AND_LOSSY };
const GAIN: Law = Law {
    name: "a gain",
    formula: "g − 1",
    parameters: &[("factor", "")],
    proportional: true,
    starts: one,
    value: constant,
    stated: as_factor,
};
const DELAY: Law = Law {
    name: "a delay",
    formula: "e^{−iωτ} − 1",
    parameters: &[("seconds", "s")],
    proportional: false,
    starts: delays,
    value: |line, p| Delta::Signal { gain: 1.0, delay: p[0] }.at(line.s()),
    stated: same,
};
const GAIN_AND_DELAY: Law = Law {
    name: "a gain and a delay",
    formula: "g e^{−iωτ} − 1",
    parameters: &[("factor", ""), ("seconds", "s")],
    proportional: false,
    starts: |_, high| {
        let factors = [0.7, 1.0, 1.4];
        factors.iter().flat_map(|g| [-0.3, 0.0, 0.3].map(|turn| vec![*g, turn / high])).collect()
    },
    value: |line, p| Delta::Signal { gain: p[0], delay: p[1] }.at(line.s()),
    stated: same,
};
const SENSOR_MASS: Law = Law {
    name: "a sensor's mass",
    formula: "1/(1 − ω²m H_oo) − 1",
    parameters: &[("mass", "kg")],
    proportional: false,
    starts: sensors,
    value: |line, p| 1.0 / (1.0 + p[0] * line.driving) - 1.0,
    stated: same,
};
const OFFSET: Law = Law {
    name: "an offset",
    formula: "dx",
    parameters: &[("dx", "m")],
    proportional: true,
    starts: one,
    value: constant,
    stated: same,
};
const FACTOR: Law = Law {
    name: "a stiffness factor",
    formula: "factor − 1",
    parameters: &[("factor", "")],
    proportional: true,
    starts: one,
    value: constant,
    stated: as_factor,
};
const LOSS: Law = Law {
    name: "a loss factor",
    formula: "iη",
    parameters: &[("loss_factor", "")],
    proportional: true,
    starts: one,
    value: |line, p| Delta::Loss(p[0]).at(line.s()),
    stated: same,
};
const RELAXATION: Law = Law {
    name: "relaxation",
    formula: "ratio·iωτ/(1 + iωτ)",
    parameters: &[("ratio", ""), ("time", "s")],
    proportional: true,
    starts: times,
    value: |line, p| {
        let turned = line.s() * p[1].exp();
        p[0] * turned / (1.0 + turned)
    },
    stated: |p| vec![p[0], p[1].exp()],
};

/// The laws that make sense at a site.
pub(super) fn laws_of(site: &Site) -> &'static [Law] {
    match site {
        Site::Body { .. } => &[MASS, SPRING, DASHPOT, SPRING_AND_DASHPOT, RESONATOR],
        Site::Series { dof: Dof::Translation, .. } => &[YIELDING, YIELDING_AND_LOSSY],
        Site::Series { dof: Dof::Rotation, .. } => &[YIELDING_ROTATION, YIELDING_AND_LOSSY_ROTATION],
        Site::Joint(_) => &[FACTOR, LOSS, RELAXATION],
        Site::Response(_) => &[GAIN, DELAY, GAIN_AND_DELAY, SENSOR_MASS],
        Site::Reference(_) => &[GAIN, DELAY, GAIN_AND_DELAY],
        Site::Position(_) => &[OFFSET],
    }
}
