//! Fixtures shared by the tests of this crate.

use jointscope_fixture::Fixture;
use jointscope_linalg::{Matrix2, RealMatrix2};
use jointscope_lumped::{Assembly, Instrument, synthesize};
use jointscope_samples::transverse;
use jointscope_spectra::{FrfSet, SpectralLines};

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
    synthesize(fixture, &transverse(pairs), lines, Instrument::AsRecorded).unwrap()
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
