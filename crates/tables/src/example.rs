use crate::TablesError;
use jointscope_averaging::Band;
use jointscope_fixture::Fixture;
use serde_json::{Value, json};

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
    /// Whether the stiffness of the fixture is the example's own. That of a welded or glued example is its integral neighbour's: the paper's SIM
    /// puts the measured damping ratios on it.
    pub own_stiffness: bool,
}

/// How much of a fixture was inferred, and from how many printed cells: the more of the first, the less the second are a test.
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
    let d0 = (include_str!("../../../fixtures/paper/D0.json"), Band { from: 474.0, to: 843.0 }, D0);
    let e0 = (include_str!("../../../fixtures/paper/E0.json"), Band { from: 718.7, to: 1000.0 }, E0);
    let f01 = (include_str!("../../../fixtures/paper/F01.json"), Band { from: 757.3, to: 1000.0 }, SYMMETRIC);
    let f02 = (include_str!("../../../fixtures/paper/F02.json"), Band { from: 263.5, to: 518.7 }, SYMMETRIC);
    // As the paper has it, the SIM of a welded or glued example is its integral neighbour's stiffness with the damping ratios measured on it.
    let on = |(text, band, _): (&'static str, Band, Inference)| (text, band, RATIOS);
    let all = [
        ("D0", d0, None),
        ("E0", e0, None),
        ("E1", on(e0), Some([0.00369516, 0.0017339])),
        ("E2", e0, Some([0.007676214, 0.0009004064])),
        ("E3", e0, Some([0.001043338, 0.00068259])),
        ("E4", e0, Some([0.005994163, 0.001198452])),
        ("E5", on(e0), Some([0.00653603, 0.00048766])),
        ("F01", f01, None),
        ("F1", on(f01), Some([0.02843571, 0.02879258])),
        ("F02", f02, None),
        ("F2", on(f02), Some([0.00133698, 0.01764739])),
    ];
    let example = |(name, (text, band, inference), ratios): (
        &'static str,
        (&str, Band, Inference),
        Option<[f64; 2]>,
    )| {
        Ok(Example {
            name,
            fixture: fixture(text, ratios)?,
            band,
            inference,
            own_stiffness: ratios.is_none(),
        })
    };
    all.into_iter().map(example).collect()
}

fn fixture(text: &str, ratios: Option<[f64; 2]>) -> Result<Fixture, TablesError> {
    let fixture = Fixture::from_json(text)?;
    let Some(ratios) = ratios else { return Ok(fixture) };
    let mut value: Value = fixture.to_value();
    value["damping"] = json!({ "modal_ratios": ratios });
    Ok(Fixture::from_value(&value)?)
}
