//! The tables against what is printed, and against what their text claims.
#![allow(clippy::unwrap_used, missing_docs)]

use jointscope_decomposition::{Averages, Relation, Sides, decompose};
use jointscope_fem::MeshOptions;
use jointscope_fixture::Fixture;
use jointscope_linalg::Matrix2;
use jointscope_lumped::{Instrument, synthesize};
use jointscope_spectra::{FrfPair, SpectralLines};
use jointscope_tables::paper::{DAMPING, MODELS_USED, RANKS, STIFFNESS, STIFFNESS_UNITS, compared};
use jointscope_tables::{Measured, ProgramRow, Tables, Witness, examples};
use serde_json::json;

fn tables() -> Tables {
    Tables::of(None, Vec::new(), |_, _, _| {}).unwrap()
}

/// The program's |K| by eq (7) in the printed units.
fn sim(tables: &Tables, example: &str, element: usize) -> f64 {
    ProgramRow::magnitudes(&tables.row(example).unwrap().sim.paper.stiffness)[element]
        / STIFFNESS_UNITS[element].1
}

#[test]
fn inferred_fixtures_give_the_cells_that_they_were_inferred_from() {
    let tables = tables();
    for (example, deviations) in [
        ("D0", [0.01, 0.02, 0.02]),
        ("E0", [0.09, 0.05, 0.05]),
        ("F01", [0.01; 3]),
        ("F02", [0.06, 0.02, 0.02]),
    ] {
        let printed = STIFFNESS.iter().find(|row| row.example == example).unwrap().sim.unwrap();
        for (element, allowed) in deviations.into_iter().enumerate() {
            let found = sim(&tables, example, element);
            assert!(
                (found / printed[element] - 1.0).abs() < allowed,
                "{example}: {found} for {}",
                printed[element]
            );
        }
    }
    for row in DAMPING.iter() {
        // Of E1, E5, F1 and F2 the cells of SIM C were not used.
        let program = tables.row(row.example).filter(|row| row.example.inference.numbers > 2);
        if let Some(program) = program {
            let found = ProgramRow::magnitudes(&program.sim.paper.damping)[0];
            assert!((found / row.sim[0] - 1.0).abs() < 0.05, "{}: {found} for {}", row.example, row.sim[0]);
            assert!((program.input[0] / row.input[0] - 1.0).abs() < 0.05, "{}", row.example);
        }
    }
}

#[test]
fn c_in_of_welded_and_glued_examples_is_that_of_two_damping_ratios_and_their_sim_is_not_met() {
    let tables = tables();
    for (example, out) in [("E1", 0.82), ("E5", 1.41), ("F1", 1.31), ("F2", 1.14)] {
        let printed = DAMPING.iter().find(|row| row.example == example).unwrap();
        let program = tables.row(example).unwrap();
        for (element, (found, printed)) in program.input.iter().zip(printed.input).enumerate() {
            // Of F2 0.01 is printed where its neighbour and its own C_IN(1,1) say 0.1.
            let printed = if printed == 0.01 { 0.1 } else { printed };
            let decimals = printed.to_string().split_once('.').map_or(0, |(_, after)| after.len());
            let half = 0.5 * 10f64.powi(-(decimals as i32));
            assert!((found - printed).abs() <= 1.001 * half, "{example} {element}: {found} for {printed}");
        }
        let found = ProgramRow::magnitudes(&program.sim.paper.damping)[0] / printed.sim[0];
        assert!((found - out).abs() < 0.01, "{example}: {found}");
        assert!(!program.example.own_stiffness());
    }
}

#[test]
fn layers_make_the_solids_of_welded_and_glued_examples_softer_in_the_ratio_of_the_printed_cells() {
    let mesh = MeshOptions { corner: 4, along: 8, across: 2, ..MeshOptions::default() };
    let all = examples().unwrap();
    let k11 = |name: &str| {
        let example = all.iter().find(|example| example.name == name).unwrap().clone();
        ProgramRow::of(example, Some(&mesh)).unwrap().fem_two.unwrap().paper.stiffness.at(0, 0)
    };
    let cells = |name: &str| STIFFNESS.iter().find(|row| row.example == name).unwrap();
    let [welded, glued] = [("E2", "E0"), ("F1", "F01")].map(|(joint, neighbour)| {
        let (own, other) = (cells(joint), cells(neighbour));
        let printed = own.fem.zip(other.fem).or(own.exp.zip(other.exp)).unwrap();
        k11(joint) / k11(neighbour) / (printed.0[0] / printed.1[0])
    });
    assert!((welded - 1.0).abs() < 0.003 && (glued - 1.0).abs() < 0.003, "{welded} {glued}");
}

#[test]
fn the_models_that_table_4_says_it_used_have_values_and_do_not_always_give_its_order() {
    let mut contradicted = Vec::new();
    for (group, elements) in RANKS.iter().enumerate() {
        for (element, order) in elements.iter().enumerate() {
            assert_eq!(MODELS_USED[group][element].len(), order.len());
            let spans: Vec<[f64; 2]> =
                (0..order.len()).map(|place| compared(group, element, place).unwrap()).collect();
            for (place, pair) in spans.windows(2).enumerate() {
                if pair[1][1] < pair[0][0] {
                    contradicted.push((element, order[place], order[place + 1]));
                }
            }
        }
    }
    println!("{contradicted:?}");
    // The measured 8.5 of E5 above the computed 8.0 of E0, itself below the 12.0 of D0.
    assert!(contradicted.len() <= 2, "{contradicted:?}");
}

#[test]
fn the_exact_relation_closes_the_round_trip_that_eq_7_does_not() {
    for row in tables().rows {
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let stated = row.stiffness.at(i, j);
            assert!((row.sim.exact.stiffness.at(i, j) / stated - 1.0).abs() < 1e-6);
            assert!((row.sim.paper.stiffness.at(i, j) / stated - 1.0).abs() > 0.1);
        }
        assert!(row.sim.paper.damping.at(0, 0) / row.input[0] > 1.3, "damping of {}", row.example.name);
    }
}

#[test]
fn table_4_s_first_element_is_the_order_of_the_measured_cells() {
    let exp = |name: &str| STIFFNESS.iter().find(|row| row.example == name).and_then(|row| row.exp);
    let order = Tables::rank(0, 0, exp);
    let printed: Vec<&str> = RANKS[0][0].iter().copied().filter(|name| *name != "E0").collect();
    assert_eq!(order, printed);
}

#[test]
fn every_example_has_its_row_and_every_row_its_finding() {
    let text = tables().to_text();
    for row in &STIFFNESS {
        assert!(
            text.contains(&format!("| {:<7} | {:<8} |", row.example, row.joint.name())),
            "{}",
            row.example
        );
    }
    for part in [
        "12               | 12 ",
        "between the poles only",
        "Table 6",
        "above the upper pole or below the lower pole",
        "E0, as printed, between the poles: EI",
    ] {
        assert!(text.contains(part), "`{part}` is missing");
    }
    let widths: Vec<usize> =
        text.lines().filter(|l| l.starts_with("| example")).map(|l| l.matches('|').count()).collect();
    assert!(widths.len() >= 9);
}

#[test]
fn e0_is_met_between_the_poles_by_two_equal_blocks_as_the_program_decomposes_them() {
    let cells = STIFFNESS.iter().find(|row| row.example == "E0").unwrap().sim.unwrap();
    let witness = Witness::between_the_poles(&cells).unwrap();
    let Witness { bending_stiffness, length, inertia, arm, band } = witness;
    // Of a size that two blocks and a strip have. Their masses enter no cell.
    assert!((0.03..0.3).contains(&length) && (0.02..0.3).contains(&arm), "{witness:?}");
    let block = |x: f64| json!({ "mass": 1.8, "inertia": inertia, "x_cg": x });
    let fixture = json!({
        "bodies": { "A": block(-arm), "B": block(length + arm) },
        "points": {
            "1": { "body": "A", "x": -arm }, "2": { "body": "A", "x": 0.0 },
            "3": { "body": "B", "x": length }, "4": { "body": "B", "x": length + arm },
        },
        "joints": { "J": { "from": "2", "to": "3", "beam": { "youngs_modulus": 2e11, "second_moment": bending_stiffness / 2e11 } } },
    });
    let fixture = Fixture::from_value(&fixture).unwrap();
    let lines = SpectralLines::even(2.5, 2.5, 400).unwrap();
    let pairs = [("4", "1"), ("3", "1"), ("4", "2"), ("3", "2")].map(|(o, i)| FrfPair::transverse(o, i));
    let frfs = synthesize(&fixture, &pairs, &lines, Instrument::Perfect).unwrap();
    let spectrum = decompose(&frfs, &Sides::of(&fixture, None).unwrap(), Relation::Paper).unwrap();
    let averages = Averages::of(&spectrum, Some(band), (Matrix2::zero(), Matrix2::zero())).unwrap();
    let found = ProgramRow::magnitudes(&averages.plain.stiffness);
    for (element, (found, printed)) in found.into_iter().zip(cells).enumerate() {
        assert!(
            (found / STIFFNESS_UNITS[element].1 - printed).abs() < 0.05,
            "{element}: {found} for {printed}"
        );
    }
    // All four signs turn round there.
    let signs = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| averages.plain.stiffness.at(i, j) > 0.0);
    assert_eq!(signs, [false, false, true, true]);
}

#[test]
fn a_user_s_own_decomposition_stands_in_its_row() {
    let file = json!({ "relation": "paper", "average": { "stiffness": [[0.71e6, -1.6e4], [9.8e3, -1.8e3]], "damping": [[1, 0], [0, 1]] } });
    let measured = Measured::of("E2", &file).unwrap();
    let tables = Tables::of(None, vec![measured], |_, _, _| {}).unwrap();
    assert!(tables.to_text().contains("0.710 (same)"));
    let error = Measured::of("E9", &file).unwrap_err().to_string();
    assert!(error.contains("`E9`") && error.contains("F02"), "{error}");
    assert!(Measured::of("E2", &json!({})).unwrap_err().to_string().contains("jointscope decompose"));
}

#[test]
fn the_json_holds_si_units_and_signs() {
    let value = tables().to_value();
    assert_eq!(value["D0"]["paper"]["stiffness"]["sim"][0], 3.3e6);
    assert!(value["D0"]["program"]["sim"]["eq7"]["stiffness"][1][1].as_f64().unwrap() < 0.0);
    for example in ["E1", "E2", "F1"] {
        assert_eq!(value[example]["program"]["own_stiffness"], false);
    }
}
