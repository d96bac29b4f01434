//! What the fixture's own uncertainty does to the joint found.

use jointscope_averaging::Band;
use jointscope_decomposition::{Analysis, AnalysisOptions};
use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, synthesize};
use jointscope_spectra::{FrfPair, SpectralLines};

const MASSES: [f64; 2] = [2.0, 3.0];
const STIFFNESS: f64 = 5e6;
const BAND: Band = Band { from: 100.0, to: 300.0 };

/// Two storeys and a column, their masses known to these standard deviations.
fn storeys(std: [f64; 2]) -> Fixture {
    Fixture::from_json(&format!(
        r#"{{ "bodies": {{ "A": {{ "mass": {{ "value": {}, "std": {} }}, "rotates": false }},
                          "B": {{ "mass": {{ "value": {}, "std": {} }}, "rotates": false }} }},
             "points": {{ "1": {{ "body": "A", "x": 0 }}, "2": {{ "body": "B", "x": 0.1 }} }},
             "joints": {{ "J": {{ "from": "1", "to": "2", "stiffness": [[{STIFFNESS}, 0], [0, 0]] }} }} }}"#,
        MASSES[0], std[0], MASSES[1], std[1]
    ))
    .unwrap()
}

/// Standard deviation of the mean of K over the band, from the tolerances alone.
fn of_the_mean(std: [f64; 2]) -> f64 {
    let fixture = storeys(std);
    let lines = SpectralLines::even(50.0, 1.0, 300).unwrap();
    let frfs =
        synthesize(&fixture, &[FrfPair::transverse("2", "1")], &lines, Instrument::AsRecorded).unwrap();
    let options = AnalysisOptions { band: Some(BAND), exact: true, ..AnalysisOptions::default() };
    Analysis::of(&fixture, &frfs, &options).unwrap().tolerance_of_averages().0.at(0, 0)
}

/// Mean over the band of eq (5), 1/k = 1/(m_A m_B ω⁴ H) + (1/m_A + 1/m_B)/ω², with masses other than the true ones.
fn by_hand(masses: [f64; 2]) -> f64 {
    let k = |hz: f64| {
        let x = (std::f64::consts::TAU * hz).powi(2);
        let receptance = STIFFNESS / (x * (x * MASSES[0] * MASSES[1] - STIFFNESS * (MASSES[0] + MASSES[1])));
        let [a, b] = masses;
        1.0 / (1.0 / (a * b * x * x * receptance) + (1.0 / a + 1.0 / b) / x)
    };
    (100..=300).map(|hz| k(f64::from(hz))).sum::<f64>() / 201.0
}

#[test]
fn a_masss_tolerance_moves_the_mean_as_eq_5_says() {
    let std = 0.004;
    let expected = 0.5 * (by_hand([MASSES[0] + std, MASSES[1]]) - by_hand([MASSES[0] - std, MASSES[1]]));
    let found = of_the_mean([std, 0.0]);
    assert!((found / expected.abs() - 1.0).abs() < 1e-6, "{found} N/m, by hand {expected}");
}

#[test]
fn tolerances_are_independent_and_add_as_squares() {
    let (a, b) = (of_the_mean([0.004, 0.0]), of_the_mean([0.0, 0.006]));
    let both = of_the_mean([0.004, 0.006]);
    assert!((both / a.hypot(b) - 1.0).abs() < 1e-9, "{both} N/m from {a} and {b}");
}
