//! What the fixture's own uncertainty does to the joint found.

use crate::common::{TwoBlocks, frfs, lines};
use jointscope_averaging::Band;
use jointscope_decomposition::{Analysis, AnalysisOptions, Relation, Sides, decompose, maximum_likelihood};
use jointscope_fixture::{Fixture, Spread};
use jointscope_linalg::RealMatrix2;
use jointscope_lumped::{Instrument, synthesize};
use jointscope_samples::{ACROSS, Noise};
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

/// Mean over the band of eq (5), 1/k = 1/(m_A m_B ω⁴ H) + (1/m_A + 1/m_B)/ω², with masses other than the true
/// ones.
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
    let step = 1e-4 * std;
    let slope =
        (by_hand([MASSES[0] + step, MASSES[1]]) - by_hand([MASSES[0] - step, MASSES[1]])) / (2.0 * step);
    let expected = slope * std;
    let found = of_the_mean([std, 0.0]);
    assert!((found / expected.abs() - 1.0).abs() < 1e-4, "{found} N/m, by hand {expected}");
}

/// Share of a quantity that it moves by: small enough for the first order to be all, large enough for fits to
/// tell.
const MOVED: f64 = 2e-4;

/// Changes of a fit's six numbers when a quantity moves: as stated, and by the fit repeated on both sides of
/// it; their deviations; χ² per degree of freedom. The recording is of blocks with `left_out` besides.
fn changes_of_the_fit(left_out: &str, index: usize) -> ([[f64; 6]; 3], f64) {
    let blocks = |extra: &str| TwoBlocks {
        mass: [5.36, 5.11],
        half_length: [0.069, 0.066],
        bending_stiffness: 59.3,
        length: 0.0651,
        damping: r#"{"modal_ratios": [0.00716, 0.00172]}"#.into(),
        extra: extra.into(),
    };
    let frfs = Noise::new(5).on(&frfs(&blocks(left_out).fixture(), &ACROSS, &lines()), 1e-4);
    let mut stated = blocks("").fixture();
    let value = stated.quantities()[index].value;
    stated.quantities_mut()[index].quantity.spread = Spread::Stated(MOVED * value.abs());
    let moved = |sign: f64| {
        let mut other = stated.clone();
        other.set_quantities([(index, value + sign * MOVED * value.abs())]);
        let sides = Sides::of(&other, None).unwrap();
        let spectrum = decompose(&frfs, &sides, Relation::Exact).unwrap();
        let fit = maximum_likelihood(&frfs, &sides, &spectrum, None, None).unwrap();
        elements((fit.stiffness, fit.damping))
    };
    let (up, down) = (moved(1.0), moved(-1.0));
    let options = AnalysisOptions { exact: true, ..AnalysisOptions::default() };
    let analysis = Analysis::of(&stated, &frfs, &options).unwrap();
    let found = elements(analysis.tolerances[0].likelihood.unwrap());
    let repeated = std::array::from_fn(|e| 0.5 * (up[e] - down[e]));
    let fit = analysis.likelihood.unwrap();
    ([found, repeated, elements((fit.stiffness_std, fit.damping_std))], fit.chi2_per_dof)
}

fn elements((k, c): (RealMatrix2, RealMatrix2)) -> [f64; 6] {
    [k.at(0, 0), k.at(0, 1), k.at(1, 1), c.at(0, 0), c.at(0, 1), c.at(1, 1)]
}

#[test]
fn the_fits_change_by_a_quantity_is_that_of_the_fit_repeated() {
    let left_out = r#", "physics": [{ "kind": "added_mass", "place": "B", "x": 0.1, "mass": 0.02 }]"#;
    for (extra, explained) in [("", true), (left_out, false)] {
        // Masses and an inertia.
        for index in [0, 3, 4] {
            let ([found, repeated, std], chi2_per_dof) = changes_of_the_fit(extra, index);
            assert_eq!(chi2_per_dof < 1.2, explained, "{chi2_per_dof}");
            for element in 0..6 {
                let (a, b) = (found[element], repeated[element]);
                // Repeated fits end within a few hundredths of a standard deviation of their optima.
                let scale = 0.05 * b.abs() + 0.03 * std[element];
                assert!(
                    (a - b).abs() < scale,
                    "quantity {index}, element {element}: {a} for {b}, {explained}"
                );
            }
        }
    }
}

#[test]
fn tolerances_are_independent_and_add_as_squares() {
    let (a, b) = (of_the_mean([0.004, 0.0]), of_the_mean([0.0, 0.006]));
    let both = of_the_mean([0.004, 0.006]);
    assert!((both / a.hypot(b) - 1.0).abs() < 1e-9, "{both} N/m from {a} and {b}");
}

#[test]
fn points_that_no_frf_depends_on_have_no_share_and_change_nothing_else() {
    let plain =
        TwoBlocks { damping: r#"{"modal_ratios": [0.00716, 0.00172]}"#.into(), ..TwoBlocks::default() };
    let frfs = Noise::new(7).on(&frfs(&plain.fixture(), &ACROSS, &lines()), 1e-3);
    let stated = plain.fixture();
    // Before and between the points in use.
    let text = stated.to_json();
    let idle = |name: &str| format!(r#""idle-{name}": {{ "body": "A", "x": -0.01 }}, "{name}": {{"#);
    let text = text.replacen("\"1\": {", &idle("1"), 1).replacen("\"3\": {", &idle("3"), 1);
    let with_idle = Fixture::from_json(&text).unwrap();
    assert_eq!(with_idle.points().len(), 6);
    let options = AnalysisOptions { laws: false, ..AnalysisOptions::default() };
    let [without, with] =
        [&stated, &with_idle].map(|fixture| Analysis::of(fixture, &frfs, &options).unwrap());
    assert_eq!(with.tolerances.len(), without.tolerances.len() + 2);
    let is_idle = |path: &str| path.contains("idle");
    for share in with.tolerances.iter().filter(|share| is_idle(&share.path)) {
        let (k, c) = share.plain;
        let (fitted_k, fitted_c) = share.likelihood.unwrap();
        let largest = [k, c, fitted_k, fitted_c]
            .map(|m| elements((m, m)).into_iter().fold(0.0, |a: f64, b| a.max(b.abs())));
        assert!(largest.iter().all(|change| *change < 1e-9), "{}: {largest:?}", share.path);
    }
    let others = with.tolerances.iter().filter(|share| !is_idle(&share.path));
    assert!(others.eq(without.tolerances.iter()), "the shares of the others change");
    let (with, without) = (with.joint_fit.unwrap(), without.joint_fit.unwrap());
    assert_eq!(with.stiffness, without.stiffness);
    assert_eq!(with.quantities, without.quantities);
    // In the order of the file, as all that stays where it is.
    let idle: Vec<&str> =
        with.unmoved.iter().map(|own| own.path.as_str()).filter(|path| is_idle(path)).collect();
    assert_eq!(idle, ["points/idle-1/x", "points/idle-3/x"]);
}
