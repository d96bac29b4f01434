//! Derivatives from one solution, against central differences of many.

use jointscope_fixture::Fixture;
use jointscope_lumped::{Instrument, Tangent, accelerances};
use jointscope_spectra::{FrfPair, SpectralLines};
use num_complex::Complex64;
use proptest::prelude::*;

/// What a fixture is made of: its damping by the first, then effects.
#[derive(Debug, Clone, Copy)]
struct Made {
    damping: usize,
    supports: bool,
    effects: usize,
}

const NUMBERS: usize = 22;

/// Two blocks, a storey, a beam joint and one of given stiffness. The numbers are multiples of what is
/// written here.
fn fixture(made: Made, by: &[f64; NUMBERS]) -> Fixture {
    let damping = [
        format!(r#"{{ "modal_ratios": [{}, {}] }}"#, 0.02 * by[0], 0.01 * by[1]),
        format!(r#"{{ "modal_ratios": [{}, {}], "of": "free" }}"#, 0.02 * by[0], 0.01 * by[1]),
        format!(r#"{{ "rayleigh": {{ "mass": {}, "stiffness": {} }} }}"#, 9.0 * by[0], 1e-5 * by[1]),
        format!(r#"{{ "loss_factor": {} }}"#, 0.02 * by[0]),
    ];
    let supports = format!(
        r#", "supports": {{ "G": {{ "point": "1", "stiffness": {}, "damping": {}, "rotational_stiffness": {} }} }}"#,
        2e5 * by[2],
        3.0 * by[3],
        2e3 * by[4]
    );
    let effects = [
        String::new(),
        format!(
            r#"{{ "kind": "added_mass", "place": "B", "x": {}, "mass": {}, "height": {} }}"#,
            0.15 * by[18],
            0.1 * by[19],
            0.03 * by[20]
        ),
        format!(
            r#"{{ "kind": "attached_resonator", "place": "A", "x": {}, "mass": {}, "frequency": {}, "damping_ratio": {} }}"#,
            0.01 * by[18],
            0.05 * by[19],
            150.0 * by[20],
            0.03 * by[21]
        ),
        format!(
            r#"{{ "kind": "stiffness_change", "place": "J", "factor": {} }}, {{ "kind": "joint_mass", "place": "J", "mass": {} }}"#,
            0.8 * by[18],
            0.08 * by[19]
        ),
        format!(
            r#"{{ "kind": "body_flexibility", "place": "A", "frequency": {}, "damping_ratio": {} }}, {{ "kind": "channel_gain", "place": "response 3", "factor": 1.1 }},
               {{ "kind": "channel_delay", "place": "reference 1", "seconds": 1e-5 }}"#,
            900.0 * by[18],
            0.01 * by[19]
        ),
        format!(r#"{{ "kind": "joint_length", "place": "J", "dx": {} }}"#, 0.01 * by[18]),
    ];
    let text = format!(
        r#"{{ "bodies": {{
            "A": {{ "mass": {}, "inertia": {}, "x_cg": {} }},
            "B": {{ "mass": {}, "inertia": {}, "x_cg": 0.14, "masses": [{{ "x": {}, "mass": {} }}] }},
            "S": {{ "mass": {}, "rotates": false }} }},
          "points": {{ "1": {{ "body": "A", "x": {} }}, "2": {{ "body": "A", "x": 0.03 }}, "3": {{ "body": "B", "x": {} }},
                       "4": {{ "body": "B", "x": 0.2 }}, "5": {{ "body": "S", "x": 0.3 }} }},
          "joints": {{ "J": {{ "from": "2", "to": "3", "beam": {{ "youngs_modulus": 2e11, "second_moment": {} }} }},
                       "C": {{ "from": "4", "to": "5", "stiffness": [[{}, 10], [10, {}]] }} }},
          "damping": {}{}, "physics": [{}] }}"#,
        1.2 * by[5],
        1e-3 * by[6],
        -0.002 * by[7],
        0.9 * by[8],
        8e-4 * by[9],
        0.16 * by[10],
        0.2 * by[11],
        2.0 * by[12],
        -0.03 * by[13],
        0.1 * by[14],
        4e-10 * by[15],
        6e5 * by[16],
        900.0 * by[17],
        damping[made.damping],
        if made.supports { supports } else { String::new() },
        effects[made.effects]
    );
    Fixture::from_json(&text).unwrap()
}

fn pairs() -> Vec<FrfPair> {
    let pair = |(o, i): (&str, &str)| FrfPair::transverse(o, i);
    [("3", "1"), ("1", "1"), ("4", "2"), ("5", "3")].map(pair).to_vec()
}

fn lines() -> SpectralLines {
    SpectralLines::new((1..=30).map(|line| 13.7 * f64::from(line)).collect()).unwrap()
}

fn predicted(made: Made, numbers: &[f64; NUMBERS], by: usize, step: f64) -> Vec<Complex64> {
    let mut moved = *numbers;
    moved[by] += step;
    accelerances(&fixture(made, &moved), &pairs(), &lines(), Instrument::AsRecorded).unwrap()
}

/// Fourth-order differences: a resonance's width is a hundredth of its frequency.
fn difference(made: Made, numbers: &[f64; NUMBERS], by: usize) -> Vec<Complex64> {
    const STEP: f64 = 1e-4;
    let [near, far] = [1.0, 2.0].map(|width| {
        let [up, down] = [1.0, -1.0].map(|sign| predicted(made, numbers, by, sign * width * STEP));
        up.iter().zip(&down).map(|(u, d)| (u - d) / (2.0 * width * STEP)).collect::<Vec<_>>()
    });
    near.iter().zip(&far).map(|(near, far)| (near * 4.0 - far) / 3.0).collect()
}

fn made() -> impl Strategy<Value = Made> {
    (0usize..4, any::<bool>(), 0usize..6).prop_map(|(damping, supports, effects)| Made {
        damping,
        supports,
        effects,
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn derivatives_from_one_solution_are_those_that_differences_tend_to(made in made(), numbers in prop::array::uniform22(0.8f64..1.25)) {
        let (pairs, lines) = (pairs(), lines());
        let tangent = Tangent::new(fixture(made, &numbers), &pairs, &lines, Instrument::AsRecorded).unwrap();
        for by in 0..NUMBERS {
            // Either way, so that a step may be long enough for its rounding not to show: what fixtures curve
            // by cancels.
            const STEP: f64 = 5e-6;
            let toward = |step: f64, some: Option<&[usize]>| {
                let mut moved = numbers;
                moved[by] += step;
                tangent.toward(&fixture(made, &moved), step, some).unwrap()
            };
            let [up, down] = [STEP, -STEP].map(|step| toward(step, None));
            let found: Vec<Complex64> = up.iter().zip(&down).map(|(up, down)| (up + down) / 2.0).collect();
            let expected = difference(made, &numbers, by);
            for (frf, (found, expected)) in found.chunks(lines.len()).zip(expected.chunks(lines.len())).enumerate() {
                let size = expected.iter().map(|value| value.norm()).fold(0.0, f64::max);
                // What hardly changes is told to a share of the FRF: a joint that is taken out of the modes
                // and put back by stations loses digits.
                let level = predicted(made, &numbers, by, 0.0).iter().map(|value| value.norm()).fold(0.0, f64::max);
                for (line, (found, expected)) in found.iter().zip(expected).enumerate() {
                    prop_assert!(
                        (found - expected).norm() < 3e-5 * size + 1e-8 * level,
                        "number {by}, FRF {}, {} Hz: {found} and {expected}, at most {size:e}, FRF {level:e}", pairs[frf], lines.hz()[line]
                    );
                }
            }
            prop_assert_eq!(&toward(STEP, Some(&[2]))[..], &up[2 * lines.len()..3 * lines.len()]);
        }
    }
}

#[test]
fn what_changes_the_measuring_chain_or_adds_to_the_model_has_no_derivative_here() {
    let one = [1.0; NUMBERS];
    let made = |effects: usize| Made { damping: 0, supports: false, effects };
    let (pairs, lines) = (pairs(), lines());
    let tangent = Tangent::new(fixture(made(0), &one), &pairs, &lines, Instrument::AsRecorded).unwrap();
    assert!(tangent.toward(&fixture(made(1), &one), 1.0, None).is_none());
    assert!(tangent.toward(&fixture(made(4), &one), 1.0, None).is_none());
    assert!(
        tangent.toward(&fixture(made(0), &one), 1.0, None).unwrap().iter().all(|value| value.norm() == 0.0)
    );
}

#[test]
fn a_tangent_pays_where_a_change_is_of_low_rank() {
    let (pairs, lines) = (pairs(), lines());
    let pays = |supports: bool, effects: usize| {
        let fixture = fixture(Made { damping: 1, supports, effects }, &[1.0; NUMBERS]);
        Tangent::where_it_pays(fixture, &pairs, &lines, Instrument::AsRecorded).is_some()
    };
    assert!(pays(false, 0) && pays(false, 1) && pays(true, 0));
    assert!(!pays(true, 1) && !pays(false, 3));
}
