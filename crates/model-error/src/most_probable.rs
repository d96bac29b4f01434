//! The most probable sizes of a model's error, one after the other: a bracket on a logarithmic scale and a
//! parabola through it, until none of them gains any more.

use crate::density::Density;
use crate::errors::{ErrorSizes, GAIN, KINDS, SizePrior};
use crate::settings::evidence::{COARSE_SIZES, COARSE_SWEEPS, LEAST_GAIN, MOST_STEPS, MOST_SWEEPS, STEP};

/// Sizes on their way to the most probable ones.
pub(crate) struct MostProbable<'s, 'd> {
    density: &'s mut Density<'d>,
    prior: SizePrior,
    scales: [f64; KINDS],
    pub sizes: [f64; KINDS],
    /// ln of density and prior there.
    pub ln: f64,
}

impl<'s, 'd> MostProbable<'s, 'd> {
    /// At these sizes.
    pub(crate) fn about(density: &'s mut Density<'d>, prior: SizePrior, sizes: [f64; KINDS]) -> Self {
        let scales = prior.scales.to_array();
        let mut all = MostProbable { density, prior, scales, sizes, ln: f64::NEG_INFINITY };
        all.ln = all.value(&sizes);
        all
    }

    fn value(&mut self, sizes: &[f64; KINDS]) -> f64 {
        let density = self.density.ln(&ErrorSizes::from_array(*sizes));
        density.map_or(f64::NEG_INFINITY, |ln| ln + ln_prior(sizes, &self.scales, &self.prior.stated))
    }

    /// The same with another size of one kind, which is taken if it is more probable.
    fn tried(&mut self, kind: usize, size: f64) -> f64 {
        let mut sizes = self.sizes;
        sizes[kind] = size;
        if sizes == self.sizes {
            return self.ln;
        }
        let ln = self.value(&sizes);
        if ln > self.ln {
            (self.sizes, self.ln) = (sizes, ln);
        }
        ln
    }

    /// The kinds whose sizes are not stated.
    fn free(&self) -> impl Iterator<Item = usize> + use<> {
        let stated = self.prior.stated;
        (0..KINDS).filter(move |kind| !stated[*kind])
    }

    /// Over five decades of each size, to set out from the most probable ones.
    pub(crate) fn over_decades(&mut self) {
        for _ in 0..COARSE_SWEEPS {
            for kind in self.free() {
                for times in COARSE_SIZES {
                    self.tried(kind, times * self.scales[kind]);
                }
            }
        }
    }

    /// To the maximum.
    pub(crate) fn climb(&mut self) {
        let mut kinds: Vec<usize> = self.free().collect();
        for _ in 0..MOST_SWEEPS {
            // What gained nothing is where it belongs, or next to it.
            kinds.retain(|&kind| {
                let before = self.ln;
                self.climb_along(kind);
                self.ln - before > LEAST_GAIN
            });
        }
    }

    /// To the maximum along one size.
    fn climb_along(&mut self, kind: usize) {
        let least = (ErrorSizes::LEAST * self.scales[kind]).ln();
        let here = Point { at: self.sizes[kind].ln(), ln: self.ln };
        let mut tried = |at: f64| Point { at, ln: self.tried(kind, at.exp()) };
        let up = tried(here.at + STEP);
        let bracket = if up.ln > here.ln {
            onward([here, up], f64::NEG_INFINITY, &mut tried)
        } else if here.at - STEP < least {
            return;
        } else {
            let down = tried(here.at - STEP);
            match down.ln > here.ln {
                true => onward([here, down], least, &mut tried),
                false => Some([down, here, up]),
            }
        };
        if let Some(at) = bracket.and_then(vertex) {
            tried(at);
        }
    }
}

/// ln p at the logarithm of a size.
#[derive(Clone, Copy)]
struct Point {
    at: f64,
    ln: f64,
}

/// Three points with the highest between the others, by steps twice as long each time in the direction in
/// which the second of two points is higher, down to `least`; `None` where that is the highest of all.
fn onward(
    [mut before, mut here]: [Point; 2],
    least: f64,
    tried: &mut impl FnMut(f64) -> Point,
) -> Option<[Point; 3]> {
    for _ in 0..MOST_STEPS {
        let there = tried((here.at + 2.0 * (here.at - before.at)).max(least));
        if there.ln <= here.ln {
            return Some([before, here, there]);
        }
        if there.at == least {
            return None;
        }
        (before, here) = (here, there);
    }
    None
}

/// Where the parabola through three points is highest; `None` where it has no maximum.
fn vertex([a, b, c]: [Point; 3]) -> Option<f64> {
    let (of_a, of_c) = ((b.ln - a.ln) / (b.at - a.at), (c.ln - b.ln) / (c.at - b.at));
    let curvature = (of_c - of_a) / (c.at - a.at);
    (curvature < 0.0).then(|| 0.5 * (a.at + b.at - of_a / curvature)).filter(|at| at.is_finite())
}

/// ln of the sizes' prior but for its normalisation: half-normal, and half-Cauchy for gains, of which a test
/// may have any.
pub(crate) fn ln_prior(sizes: &[f64; KINDS], scales: &[f64; KINDS], stated: &[bool; KINDS]) -> f64 {
    let of = |kind: usize| {
        let squared = (sizes[kind] / scales[kind]).powi(2);
        if kind == GAIN { -(1.0 + squared).ln() } else { -0.5 * squared }
    };
    (0..KINDS).filter(|kind| !stated[*kind]).map(of).sum()
}
