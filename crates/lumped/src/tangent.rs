//! Derivatives of recorded FRFs from the one solution at hand: no modes are solved for, and nothing per line
//! is but once for all of them.
//!
//! A receptance of the free assembly is a sum over modes, G_pq = Σ a_pr a_qr / D_r with D_r = λ_r + iη_r + s
//! v_r + s². What changes of a fixture make of participations and denominators is known from the modes to
//! first order ([`AssemblyChange`](crate::assembly::AssemblyChange)), so that
//!
//! dG_pq = Σ (da_pr a_qr + a_pr da_qr)/D_r − Σ a_pr a_qr dD_r/D_r²,
//!
//! real coefficients of functions of the line alone: a product of matrices. Supports and effects, V Δ Vᵀ,
//! enter by R = (I + ΔG_VV)⁻¹ Δ G_V· on either side,
//!
//! dH = dG_oi − dG_oV R_i − R_oᵀ dG_Vi + R_oᵀ dG_VV R_i − g_oᵀ dΔ g_i, g = G_V· − G_VV R.
//!
//! Damping follows λ by its law, dv = τ dλ, in almost every change, and then dλ (1 + s τ)/D² is one function
//! too.

mod rows;
mod through;

use crate::assembly::has_meshed_bodies;
use crate::lanes::{Lanes, Lines, WIDTH};
use crate::motions::Motions;
use crate::receptances::is_solved_by_modes;
use crate::synthesis::channels;
use crate::term_station::TermStation;
use crate::{Instrument, MeasuringChain, ModelledTest};
use jointscope_fixture::Fixture;
use jointscope_linalg::Field;
use jointscope_spectra::{FrfPair, SpectralLines};
use num_complex::Complex64;
use rows::{Coefficients, Rows, sums};
use std::f64::consts::TAU;
use through::Through;

/// A model with the channels of a test on spectral lines, ready to tell what small changes of its fixture
/// make of the recorded accelerances.
///
/// ```
/// use jointscope_fixture::Fixture;
/// use jointscope_lumped::{Instrument, Tangent};
/// use jointscope_spectra::{FrfPair, SpectralLines};
///
/// let with = |stiffness: f64| Fixture::from_json(&format!(r#"{{
///   "bodies": {{ "A": {{ "mass": 2.0, "rotates": false }}, "B": {{ "mass": 3.0, "rotates": false }} }},
///   "points": {{ "1": {{ "body": "A", "x": 0 }}, "2": {{ "body": "B", "x": 0.1 }} }},
///   "joints": {{ "J": {{ "from": "1", "to": "2", "stiffness": [[{stiffness}, 0], [0, 0]] }} }} }}"#));
/// let lines = SpectralLines::new(vec![100.0])?;
/// let pairs = [FrfPair::transverse("2", "1")];
/// let tangent = Tangent::new(with(5e6)?, &pairs, &lines, Instrument::AsRecorded).ok_or("no tangent")?;
/// let step = 1.0; // N/m
/// let slope = tangent.toward(&with(5e6 + step)?, step, None).ok_or("another structure")?[0];
/// // Closed form of two masses on a spring, A = k / (k (m1 + m2) − ω² m1 m2).
/// let omega2 = (2.0 * std::f64::consts::PI * 100.0_f64).powi(2);
/// let expected = -omega2 * 6.0 / (5e6 * 5.0 - omega2 * 6.0).powi(2);
/// assert!((slope.re / expected - 1.0).abs() < 1e-5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Tangent<'a> {
    fixture: Fixture,
    pairs: &'a [FrfPair],
    instrument: Instrument,
    test: ModelledTest,
    motions: Motions,
    rows: Rows,
    lines: usize,
    /// s on the lines of each block.
    blocks: Vec<Lanes>,
    /// Recorded accelerance per receptance, FRF after FRF, by block.
    factors: Vec<Lanes>,
    through: Through,
}

impl<'a> Tangent<'a> {
    /// About the fixture, between the channels of `pairs`; `None` where it has no finite FRFs on these lines,
    /// for sensors that load what they measure, and for meshed beams.
    pub fn new(
        fixture: Fixture,
        pairs: &'a [FrfPair],
        lines: &SpectralLines,
        instrument: Instrument,
    ) -> Option<Self> {
        let test = test(&fixture, pairs, lines, instrument)?;
        Tangent::of(fixture, test, (pairs, lines), instrument)
    }

    /// [`Tangent::new`] where it takes less time than models of neighbouring fixtures: not where few modes
    /// and a change of high rank are solved in the modes' own coordinates, which costs a line less than all
    /// entries of G that the change acts through.
    pub fn where_it_pays(
        fixture: Fixture,
        pairs: &'a [FrfPair],
        lines: &SpectralLines,
        instrument: Instrument,
    ) -> Option<Self> {
        let test = test(&fixture, pairs, lines, instrument)?;
        if is_solved_by_modes(test.model.modes(), test.model.terms().stations.len()) {
            return None;
        }
        Tangent::of(fixture, test, (pairs, lines), instrument)
    }

    fn of(
        fixture: Fixture,
        test: ModelledTest,
        (pairs, lines): (&'a [FrfPair], &SpectralLines),
        instrument: Instrument,
    ) -> Option<Self> {
        if test.chain.readings.iter().any(|reading| reading.load.is_some()) {
            return None;
        }
        let omegas: Vec<f64> = lines.hz().iter().map(|hz| TAU * hz).collect();
        let s: Vec<Complex64> = omegas.iter().map(|&omega| test.chain.s(omega)).collect();
        let blocks: Vec<Lanes> = s.chunks(WIDTH).map(Lanes::of).collect();
        let factor = |index: usize| {
            let all: Vec<Complex64> = omegas.iter().map(|&omega| test.chain.factor(index, omega)).collect();
            all.chunks(WIDTH).map(Lanes::of).collect::<Vec<_>>()
        };
        let factors = (0..pairs.len()).flat_map(factor).collect();
        let motions = Motions::of(&test.model, &test.stations.outputs, &test.stations.inputs);
        let rows = Rows::new(&test.model, &blocks);
        let through = Through::new(&test, &motions, &rows, &blocks)?;
        let lines = s.len();
        Some(Tangent { fixture, pairs, instrument, test, motions, rows, lines, blocks, factors, through })
    }

    /// Derivatives of the recorded accelerances by the parameter whose `step` leads to the fixture `moved`,
    /// of all FRFs or of `some` of them by place: all lines of the first, then of the second, …
    ///
    /// The step is to be small against what makes the fixture's own numbers curve (a relative 1e-5 or less),
    /// not against a resonance's width. `None` where the change has no derivative here: one of the measuring
    /// chain, or one that adds something to the model.
    pub fn toward(&self, moved: &Fixture, step: f64, some: Option<&[usize]>) -> Option<Vec<Complex64>> {
        let model = &self.test.model;
        let chain = MeasuringChain::of(moved, self.pairs, self.instrument).ok()?;
        let (stations, wanted) = channels(&chain);
        let readings = chain.readings.iter().zip(&self.test.chain.readings);
        let has_same_signals = |(after, before): (&crate::Reading, &crate::Reading)| {
            after.has_signals_of(before) && after.load.is_none()
        };
        if wanted != self.test.wanted
            || chain.decay() != self.test.chain.decay()
            || !readings.into_iter().all(has_same_signals)
        {
            return None;
        }
        let change = model.change(&self.fixture, moved, step)?;
        let of = |participation: &Vec<f64>, before: &TermStation, after: &TermStation| {
            model.participation_change(&change, participation, [before, after])
        };
        let of_stations = |all: &[Vec<f64>], before: &[crate::Station], after: &[crate::Station]| {
            let pairs =
                before.iter().zip(after).map(|(b, a)| (TermStation::single(*b), TermStation::single(*a)));
            all.iter().zip(pairs).map(|(own, (before, after))| of(own, &before, &after)).collect()
        };
        let through = model.terms().stations.iter().zip(&change.terms.stations);
        let changes = Motions {
            outputs: of_stations(&self.motions.outputs, &self.test.stations.outputs, &stations.outputs),
            inputs: of_stations(&self.motions.inputs, &self.test.stations.inputs, &stations.inputs),
            change: self.motions.change.iter().zip(through).map(|(own, (b, a))| of(own, b, a)).collect(),
        };
        let all: Vec<usize> = (0..self.pairs.len()).collect();
        let some = some.unwrap_or(&all);
        let wanted: Vec<(usize, usize)> = some.iter().map(|&index| wanted[index]).collect();
        let entries = self.motions.entries(&wanted);
        let coefficients =
            self.rows.of_change(&self.motions.all(), &changes.all(), &entries, &change.denominators);
        let delta = self.through.changes_of_delta(model.terms(), &change.terms, &self.blocks, step);
        self.evaluated(&coefficients, (some, &wanted), &delta)
    }

    /// The derivatives on all lines; `None` where they are not finite.
    fn evaluated(
        &self,
        coefficients: &Coefficients,
        (some, wanted): (&[usize], &[(usize, usize)]),
        delta: &[Lanes],
    ) -> Option<Vec<Complex64>> {
        let mut values = vec![Complex64::ZERO; some.len() * self.lines];
        let is_finite = pulp::Arch::new().dispatch(Evaluation {
            tangent: self,
            coefficients,
            some,
            wanted,
            delta,
            values: &mut values,
        });
        is_finite.then_some(values)
    }
}

/// The derivatives on all lines, compiled once for each instruction set that the processor may have.
struct Evaluation<'e> {
    tangent: &'e Tangent<'e>,
    coefficients: &'e Coefficients,
    some: &'e [usize],
    wanted: &'e [(usize, usize)],
    /// dΔ by block; empty where it does not change.
    delta: &'e [Lanes],
    values: &'e mut [Complex64],
}

impl pulp::WithSimd for Evaluation<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> bool {
        let Evaluation { tangent, coefficients, some, wanted, delta, values } = self;
        let lines = tangent.lines;
        let mut entries = vec![Lanes::ZERO; coefficients.padded()];
        let mut memory = tangent.through.memory();
        let mut is_finite = true;
        for block in 0..tangent.blocks.len() {
            sums(coefficients, tangent.rows.on_block(block), &mut entries);
            tangent.through.combine(block, wanted, &mut entries, delta, &mut memory);
            let first = block * WIDTH;
            let last = (first + WIDTH).min(lines);
            for (own, (index, entry)) in some.iter().zip(&mut entries).enumerate() {
                *entry = *entry * tangent.factors[index * tangent.blocks.len() + block];
                entry.write(&mut values[own * lines + first..own * lines + last]);
            }
            is_finite &= Lanes::all_finite(&entries[..some.len()]);
        }
        is_finite
    }
}

/// The model with its channels, of rigid bodies alone.
fn test(
    fixture: &Fixture,
    pairs: &[FrfPair],
    lines: &SpectralLines,
    instrument: Instrument,
) -> Option<ModelledTest> {
    if has_meshed_bodies(fixture) {
        return None;
    }
    ModelledTest::new(fixture, pairs, lines.hz()[lines.len() - 1], instrument).ok()
}
