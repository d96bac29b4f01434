//! Fixtures and noise shared by the tests of this crate.

use jointscope_fixture::Fixture;
use jointscope_linalg::{Matrix2, RealMatrix2};
use jointscope_lumped::{Assembly, Instrument, synthesize};
use jointscope_spectra::{FrfPair, FrfSet, SpectralLines};
use num_complex::Complex64;

pub(crate) const FOUR: [(&str, &str); 4] = [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")];

/// Two blocks and a beam, SI units; blocks are bars of the given half-lengths with the joint at one end.
#[derive(Debug, Clone)]
pub(crate) struct TwoBlocks {
    pub mass: [f64; 2],
    pub half_length: [f64; 2],
    pub bending_stiffness: f64,
    pub length: f64,
    pub damping: String,
    pub extra: String,
}

impl Default for TwoBlocks {
    fn default() -> Self {
        TwoBlocks {
            mass: [1.10, 1.20],
            half_length: [0.05, 0.045],
            bending_stiffness: 76.0,
            length: 0.065,
            damping: r#"{"modal_ratios": [0.004, 0.006]}"#.into(),
            extra: String::new(),
        }
    }
}

impl TwoBlocks {
    pub(crate) fn inertia(&self, block: usize) -> f64 {
        self.mass[block] * self.half_length[block].powi(2) / 3.0
    }

    pub(crate) fn fixture(&self) -> Fixture {
        let [a, b] = self.half_length;
        let l = self.length;
        Fixture::from_json(&format!(
            r#"{{ "bodies": {{ "A": {{ "mass": {}, "inertia": {}, "x_cg": {} }}, "B": {{ "mass": {}, "inertia": {}, "x_cg": {} }} }},
                "points": {{ "1": {{ "body": "A", "x": {} }}, "2": {{ "body": "A", "x": 0 }},
                             "3": {{ "body": "B", "x": {l} }}, "4": {{ "body": "B", "x": {} }} }},
                "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": {}, "second_moment": 1e-10 }} }} }},
                "damping": {} {} }}"#,
            self.mass[0], self.inertia(0), -a, self.mass[1], self.inertia(1), l + b, -1.7 * a, l + 1.7 * b,
            self.bending_stiffness * 1e10, self.damping, self.extra
        ))
        .unwrap()
    }
}

pub(crate) fn lines() -> SpectralLines {
    SpectralLines::even(2.5, 2.5, 400).unwrap()
}

pub(crate) fn frfs(fixture: &Fixture, pairs: &[(&str, &str)], lines: &SpectralLines) -> FrfSet {
    let pairs: Vec<FrfPair> = pairs.iter().map(|(o, i)| FrfPair::transverse(o, i)).collect();
    synthesize(fixture, &pairs, lines, Instrument::AsRecorded).unwrap()
}

/// The 2×2 viscous matrix of the joint between bodies A and B at point 3, from the assembly's matrix.
pub(crate) fn joint_damping(fixture: &Fixture) -> RealMatrix2 {
    let assembly = Assembly::new(fixture, 1000.0).unwrap();
    let (c, n) = (assembly.viscous_damping(), assembly.order());
    let block = Matrix2::new(c[2 * n + 2], c[2 * n + 3], c[3 * n + 2], c[3 * n + 3]);
    let x_cg = match &fixture.bodies()[1].kind {
        jointscope_fixture::BodyKind::Rigid(rigid) => rigid.x_cg.unwrap().value,
        jointscope_fixture::BodyKind::Beam(_) => unreachable!(),
    };
    let arm = x_cg - fixture.point("3").unwrap().x.value;
    let back = Matrix2::new(1.0, arm, 0.0, 1.0);
    back.transpose() * block * back
}

/// A deterministic stream of circular complex normals.
pub(crate) struct Noise(u64);

impl Noise {
    pub(crate) fn new(seed: u64) -> Self {
        Noise(seed.wrapping_mul(0x9E3779B97F4A7C15) | 1)
    }

    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    pub(crate) fn complex(&mut self, variance: f64) -> Complex64 {
        let radius = (-variance * self.uniform().ln()).sqrt();
        Complex64::from_polar(radius, std::f64::consts::TAU * self.uniform())
    }

    /// The set with noise of `relative` times each FRF's rms accelerance, and the variances that go with it.
    pub(crate) fn on(&mut self, frfs: &FrfSet, relative: f64) -> FrfSet {
        let n = frfs.lines().len();
        let mut values = frfs.all_values().to_vec();
        let mut variance = Vec::new();
        for (index, block) in values.chunks_mut(n).enumerate() {
            let mean: f64 = frfs.values(index).iter().map(|v| v.norm_sqr()).sum::<f64>() / n as f64;
            let floor = relative * relative * mean;
            block.iter_mut().for_each(|v| *v += self.complex(floor));
            variance.extend(std::iter::repeat_n(floor, n));
        }
        FrfSet::new(frfs.lines().clone(), frfs.form(), frfs.pairs().to_vec(), values)
            .unwrap()
            .with_variance(variance)
            .unwrap()
    }
}
