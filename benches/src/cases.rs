//! The inputs of the benchmarks. Blocks are steel, joints are thin steel strips, as in a laboratory.
#![allow(clippy::expect_used)] // constant fixtures, checked by the tests below

use jointscope_decomposition::{Compliances, Sides};
use jointscope_fixture::{Effect, EffectKind, Fixture, Place};
use jointscope_linalg::{ComplexMatrix2, Matrix2, Uniform};
use jointscope_lumped::{Instrument, Model, Station, synthesize};
use jointscope_recordings::to_datasets;
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};
use jointscope_uff::{ByteOrder, Encoding};
use num_complex::Complex64;

/// How recordings are written.
pub const BINARY: Encoding = Encoding::Binary(ByteOrder::Little);

/// What hangs on a chain besides its joints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Attachments {
    /// Nothing: the modal sum alone.
    None,
    /// A spring and dashpot to ground at either end: a change of rank 2.
    Supports,
    /// The supports, a mass, a resonator and a softened joint: a change of rank 8.
    SupportsAndEffects,
}

/// By how much the softened joint's stiffness is multiplied.
pub const SOFTENED: f64 = 0.8;
/// Stiffness (N/m) and damping (N·s/m) of either support.
pub const SUPPORT: (f64, f64) = (2e4, 5.0);
/// The added mass, kg, on the first block's centre.
pub const ADDED_MASS: f64 = 0.02;
/// Mass (kg), frequency (Hz) and damping ratio of the resonator on the last block's centre.
pub const RESONATOR: (f64, f64, f64) = (0.05, 300.0, 0.02);

/// Distance between the centres of neighbouring blocks, m.
const PITCH: f64 = 0.125;
/// Half of a block's length, m.
const HALF: f64 = 0.03;

/// A free chain of `bodies` blocks joined by strips; block i has points 2i + 1 and 2i + 2 at its ends.
pub fn chain(bodies: usize, attachments: Attachments) -> Fixture {
    let list =
        |count: usize, entry: &dyn Fn(usize) -> String| (0..count).map(entry).collect::<Vec<_>>().join(", ");
    let blocks = list(bodies, &|i| {
        let (mass, inertia) = (1.1 + 0.01 * i as f64, 9.5e-4 + 1e-5 * i as f64);
        format!(r#""B{i}": {{ "mass": {mass}, "inertia": {inertia}, "x_cg": {} }}"#, i as f64 * PITCH)
    });
    let points = list(2 * bodies, &|p| {
        let x = (p / 2) as f64 * PITCH + if p % 2 == 0 { -HALF } else { HALF };
        format!(r#""{}": {{ "body": "B{}", "x": {x} }}"#, p + 1, p / 2)
    });
    let joints = list(bodies - 1, &|j| {
        format!(
            r#""J{j}": {{ "from": "{}", "to": "{}", "beam": {{ "youngs_modulus": 2.07e11, "second_moment": 3.67e-10 }} }}"#,
            2 * j + 2,
            2 * j + 3
        )
    });
    let (spring, dashpot) = SUPPORT;
    let supports = match attachments {
        Attachments::None => String::new(),
        _ => format!(
            r#", "supports": {{ "S": {{ "point": "1", "stiffness": {spring}, "damping": {dashpot} }},
                 "T": {{ "point": "{}", "stiffness": {spring}, "damping": {dashpot} }} }}"#,
            2 * bodies
        ),
    };
    let (mass, frequency, ratio) = RESONATOR;
    let physics = match attachments {
        Attachments::SupportsAndEffects => format!(
            r#", "physics": [ {{ "kind": "added_mass", "place": "B0", "x": 0.0, "mass": {ADDED_MASS} }},
                 {{ "kind": "attached_resonator", "place": "B{}", "x": {}, "mass": {mass}, "frequency": {frequency}, "damping_ratio": {ratio} }},
                 {{ "kind": "stiffness_change", "place": "J0", "factor": {SOFTENED} }} ]"#,
            bodies - 1,
            (bodies - 1) as f64 * PITCH
        ),
        _ => String::new(),
    };
    let text = format!(
        r#"{{ "bodies": {{ {blocks} }}, "points": {{ {points} }}, "joints": {{ {joints} }},
             "damping": {{ "modal_ratios": [0.002, 0.003] }} {supports} {physics} }}"#
    );
    Fixture::from_json(&text).expect("the chain is a possible fixture")
}

/// k11 = 12 EI/L³ of the strips, N/m.
pub fn strip_stiffness() -> f64 {
    12.0 * 2.07e11 * 3.67e-10 / (PITCH - 2.0 * HALF).powi(3)
}

/// The two blocks and a beam of the paper's tests.
pub fn two_blocks() -> Fixture {
    chain(2, Attachments::None)
}

/// Two response and two excitation stations at the far and the near end of a chain: four FRFs.
pub fn ends(bodies: usize) -> ([Station; 2], [Station; 2]) {
    let at = |body: usize, side: f64| Station::transverse(body, body as f64 * PITCH + side * HALF);
    ([at(bodies - 1, 1.0), at(bodies - 1, -1.0)], [at(0, -1.0), at(0, 1.0)])
}

/// `count` lines from 100 Hz to 1 kHz, where a decomposition is well conditioned.
pub fn lines(count: usize) -> SpectralLines {
    SpectralLines::even(100.0, 900.0 / count as f64, count).expect("an ascending row of lines")
}

/// The paper's four FRFs.
pub fn four_pairs() -> Vec<FrfPair> {
    [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")].map(|(o, i)| FrfPair::transverse(o, i)).to_vec()
}

/// s = iω of every line.
pub fn imaginary(lines: &SpectralLines) -> Vec<Complex64> {
    (0..lines.len()).map(|line| Complex64::new(0.0, lines.omega(line))).collect()
}

/// H41 and the compliances of the two blocks' sides on `count` lines: the input of a decomposition.
pub fn decomposition(count: usize) -> (Vec<ComplexMatrix2>, Compliances) {
    let fixture = two_blocks();
    let lines = lines(count);
    let ([far, _], [near, _]) = ends(2);
    let sides = Sides::of(&fixture, None).expect("one joint");
    let compliances = sides
        .compliances(&lines, (near.body, near.x), (far.body, far.x))
        .expect("free blocks have no resonance");
    let model = Model::new(&fixture, lines.hz()[count - 1]).expect("the modes of two blocks");
    let mut receptances =
        model.receptances(&Station::both(far.body, far.x), &Station::both(near.body, near.x));
    let mut values = vec![Complex64::ZERO; 4 * count];
    receptances.on_lines(&imaginary(&lines), &mut values).expect("the joint is damped");
    let element = |pair: usize, line: usize| values[pair * count + line];
    let matrix = |l| Matrix2::new(element(0, l), element(1, l), element(2, l), element(3, l));
    let h41 = (0..count).map(matrix).collect();
    (h41, compliances)
}

/// The floor under every decomposition: reads what it reads and writes what it writes, the sum of the five
/// matrices.
pub fn floor(h41: &[ComplexMatrix2], sides: &Compliances, out: &mut [ComplexMatrix2]) {
    let n = out.len();
    let (h41, a21, a22) = (&h41[..n], &sides.alpha21[..n], &sides.alpha22[..n]);
    let (b33, b43) = (&sides.beta33[..n], &sides.beta43[..n]);
    for i in 0..n {
        out[i] = h41[i] + a21[i] + a22[i] + b33[i] + b43[i];
    }
}

/// The two blocks' four FRFs on `count` lines with a little noise and its variances, as a test would give
/// them.
pub fn test_of_two_blocks(count: usize) -> FrfSet {
    noisy(&two_blocks(), &four_pairs(), count)
}

/// A fixture's FRFs on `count` lines with a little noise and its variances.
fn noisy(fixture: &Fixture, pairs: &[FrfPair], count: usize) -> FrfSet {
    let clean = synthesize(fixture, pairs, &lines(count), Instrument::AsRecorded)
        .expect("the fixture can be synthesised");
    let mut random = Uniform::from_state(20_240_229);
    let mut values = clean.all_values().to_vec();
    let mut variance = Vec::with_capacity(values.len());
    for frf in values.chunks_exact_mut(count) {
        let mean = frf.iter().map(|h| h.norm_sqr()).sum::<f64>() / count as f64;
        let own = 1e-8 * mean;
        frf.iter_mut().for_each(|h| *h += complex(&mut random) * own.sqrt());
        variance.resize(variance.len() + count, own);
    }
    FrfSet::new(clean.lines().clone(), clean.form(), clean.pairs().to_vec(), values)
        .and_then(|set| set.with_variance(variance))
        .expect("finite values and positive variances")
}

/// A test of a free chain with a mass on the first block that its fixture does not have, as the bytes of a
/// universal file: FRFs between the first so many of its points and so many of the last.
pub fn test_of_a_chain(bodies: usize, (responses, references): (usize, usize), count: usize) -> Vec<u8> {
    let mass = Effect::new(EffectKind::AddedMass, Place::Body("B0".to_owned()), None, &[0.0, ADDED_MASS]);
    let fixture =
        chain(bodies, Attachments::None).with_physics(vec![mass]).expect("the mass lies on the block");
    let points: Vec<String> = (1..=2 * bodies).map(|point| point.to_string()).collect();
    let pair = |o: &String| {
        points.iter().rev().take(references).map(|i| FrfPair::transverse(o, i)).collect::<Vec<_>>()
    };
    let pairs: Vec<FrfPair> = points.iter().take(responses).flat_map(pair).collect();
    let datasets = to_datasets(&noisy(&fixture, &pairs, count), "chain", BINARY).expect("numbered points");
    jointscope_uff::write(&datasets).expect("finite values")
}

/// The same test as the bytes of a universal file.
pub fn universal_file(count: usize, encoding: Encoding) -> Vec<u8> {
    let datasets = to_datasets(&test_of_two_blocks(count), "two blocks", encoding).expect("numbered points");
    jointscope_uff::write(&datasets).expect("finite values")
}

/// Real and imaginary part each uniform, |z|² one on average.
fn complex(random: &mut Uniform) -> Complex64 {
    let width = 6.0_f64.sqrt();
    let mut part = || (random.next_number() - 0.5) * width;
    Complex64::new(part(), part())
}

#[cfg(test)]
mod tests {
    use super::*;
    use jointscope_decomposition::{Relation, decompose};

    #[test]
    fn every_chain_has_finite_receptances_on_every_line() {
        for bodies in [2, 4, 16] {
            for attachments in [Attachments::None, Attachments::Supports, Attachments::SupportsAndEffects] {
                let fixture = chain(bodies, attachments);
                let (outputs, inputs) = ends(bodies);
                let model = Model::new(&fixture, 1000.0).unwrap();
                let mut values = vec![Complex64::ZERO; 200];
                let solved =
                    model.receptances(&outputs, &inputs).on_lines(&imaginary(&lines(50)), &mut values);
                assert_eq!(solved, Ok(()), "{bodies} bodies, {attachments:?}");
            }
        }
    }

    #[test]
    fn the_noisy_test_still_decomposes_into_the_strip_it_was_made_with() {
        let sides = Sides::of(&two_blocks(), None).unwrap();
        let spectrum = decompose(&test_of_two_blocks(400), &sides, Relation::Exact).unwrap();
        let middle = &spectrum.solved[200];
        assert!((middle.stiffness.at(0, 0) / strip_stiffness() - 1.0).abs() < 0.05, "{middle:?}");
    }
}
