//! The paper's examples as fixtures whose dimensions were inferred from the cells that it prints.

use crate::TablesError;
use jointscope_averaging::Band;
use jointscope_fixture::Fixture;

/// An example of the paper as a fixture whose dimensions were inferred from the paper's own cells.
#[derive(Debug, Clone)]
pub struct Example {
    /// Its name in the tables.
    pub name: &'static str,
    /// The fixture.
    pub fixture: Fixture,
    /// The band of the averages (35) and (42), inferred with the dimensions.
    pub band: Band,
    /// What was inferred, and from what.
    pub inference: Inference,
    /// Of a welded or glued example, where the layers come from that its solid has at the ends of its strip.
    pub layer: Option<&'static str>,
}

impl Example {
    /// Whether the fixture's joint has the example's own stiffness. That of a welded or glued example is its
    /// integral neighbour's: the paper's SIM puts the measured damping ratios on it.
    pub fn own_stiffness(&self) -> bool {
        self.layer.is_none()
    }

    /// The solid that the finite-element cells are of.
    pub fn solid(&self) -> String {
        let geometry = self.fixture.geometry();
        let layer = geometry.and_then(|g| g.joints[0].interfaces[0].as_ref().map(|layer| (g, layer)));
        let (Some((geometry, layer)), Some(from)) = (layer, self.layer) else {
            return self.layer.unwrap_or("its own").to_owned();
        };
        let (name, material) = &geometry.materials[layer.material];
        let (thickness, modulus) = (1e3 * layer.thickness.value, 1e-9 * material.youngs_modulus.value);
        format!("{from}: {thickness} mm of {name} at either end of the strip, {modulus:.3} GPa")
    }
}

/// How much of a fixture was inferred, and from how many printed cells: the more of the first, the less the
/// second are a test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Inference {
    /// Numbers inferred: dimensions, masses, damping ratios, ends of the band.
    pub numbers: usize,
    /// Printed cells that they were inferred from.
    pub cells: usize,
    /// Which numbers and which cells.
    pub says: &'static str,
}

const D0: Inference = Inference {
    numbers: 12,
    cells: 12,
    says: "EI, L, two masses, two inertias, two centres of gravity, two damping ratios, two ends of the band, from 4 SIM cells of K, 4 cells of C_IN and 4 SIM cells of C",
};

const E0: Inference = Inference {
    numbers: 13,
    cells: 28,
    says: "EI, L, one mass, inertia and centre of gravity for both blocks, two ends of the band, and two damping ratios for each of E2, E3, E4, from E0's 4 SIM cells of K and the 8 cells of C_IN and SIM C of each of E2, E3, E4",
};

const RATIOS: Inference = Inference {
    numbers: 2,
    cells: 2,
    says: "two damping ratios on the fixture of its integral neighbour, from C_IN(1,1) and C_IN(2,2); the other cells of C_IN and SIM are predictions",
};

const SYMMETRIC: Inference = Inference {
    numbers: 9,
    cells: 12,
    says: "EI, L, one mass, inertia and centre of gravity for both blocks, two damping ratios, two ends of the band, from 4 SIM cells of K, 4 cells of C_IN and 4 SIM cells of C",
};

/// The examples of which a fixture could be inferred, in the order of the tables.
///
/// # Errors
/// A shipped fixture that is none: the crate's own tests exclude it.
pub fn examples() -> Result<Vec<Example>, TablesError> {
    macro_rules! file {
        ($name:literal) => {
            ($name, include_str!(concat!("../../../fixtures/paper/", $name, ".json")))
        };
    }
    let d0 = Band { from: 474.0, to: 843.0 };
    let e0 = Band { from: 718.7, to: 1000.0 };
    let f01 = Band { from: 757.3, to: 1000.0 };
    let f02 = Band { from: 263.5, to: 518.7 };
    // As the paper has it, the SIM of a welded or glued example is its integral neighbour's stiffness with
    // the damping ratios measured on it.
    let weld = Some("E0's, K11 in the ratio of their FEM cells");
    let glue = Some("F01's, K11 in the ratio of their EXP cells");
    let none = Some("F02's, without a layer: by the EXP cells K11 is the same");
    let all = [
        (file!("D0"), d0, D0, None),
        (file!("E0"), e0, E0, None),
        (file!("E1"), e0, RATIOS, weld),
        (file!("E2"), e0, E0, weld),
        (file!("E3"), e0, E0, weld),
        (file!("E4"), e0, E0, weld),
        (file!("E5"), e0, RATIOS, weld),
        (file!("F01"), f01, SYMMETRIC, None),
        (file!("F1"), f01, RATIOS, glue),
        (file!("F02"), f02, SYMMETRIC, None),
        (file!("F2"), f02, RATIOS, none),
    ];
    let example = |((name, text), band, inference, layer): ((&'static str, &str), _, _, Option<_>)| {
        let fixture = Fixture::from_json(text)?;
        Ok(Example { name, fixture, band, inference, layer })
    };
    all.into_iter().map(example).collect()
}
